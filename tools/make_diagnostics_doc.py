# SPDX-License-Identifier: LGPL-2.1-or-later
"""Write docs/diagnostics.md from the tables of faults in pkm_post/model/rules.

    python3 tools/make_diagnostics_doc.py

Needs a Python with numpy. The page depends on the tables alone: the same tables give the same bytes.
"""

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
TARGET = ROOT / "docs" / "diagnostics.md"

FAMILIES = {
    "J": "The CAM job",
    "G": "G-code",
    "L": "CL data",
    "M": "The machine file",
    "K": "What the machine can reach",
    "N": "Cutter compensation, with normals of the surface and in a plane",
    "T": "The trajectory file",
    "C": "The controller's program",
    "V": "The certificate",
    "F": "Files",
    "U": "The command line",
}
"""For each first letter of a code what it is about, in the order of the page."""

HEAD = """# Diagnostics

Every fault of the input has a code. It is reported in one line:

    place: severity code: cause: what was found there; cure

An error stops the job and no file is written. A warning is shown, and the job goes on. A code never changes its
meaning; a code that is no longer needed is not used again.

This page is generated from the tables in `pkm_post/model/rules` by `tools/make_diagnostics_doc.py`: do not edit it.
"""


def page(rules):
    """The text of the page for a table of rules."""
    strangers = sorted(code for code in rules if code[0] not in FAMILIES)
    if strangers:
        raise ValueError(f"FAMILIES: expected the first letter of every code, got none for {', '.join(strangers)}")
    return HEAD + "".join(_section(letter, rules) for letter in FAMILIES if any(code[0] == letter for code in rules))


def _section(letter, rules):
    rows = [
        f"| {code} | {rule.severity.value} | {_cell(rule.cause)} | {_cell(rule.cure)} |\n"
        for code, rule in sorted(rules.items())
        if code[0] == letter
    ]
    head = f"\n## {letter}: {FAMILIES[letter]}\n\n| code | severity | cause | cure |\n|---|---|---|---|\n"
    return head + "".join(rows)


def _cell(text):
    return text.replace("|", "\\|")


if __name__ == "__main__":
    sys.path.insert(0, str(ROOT))
    from pkm_post.model.rules import RULES

    TARGET.write_text(page(RULES), encoding="utf-8", newline="\n")
    print(TARGET)
