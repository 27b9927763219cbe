# SPDX-License-Identifier: LGPL-2.1-or-later
"""List the texts of the core that windows translate, as calls that lupdate reads.

    python3 tools/core_texts.py FILE

The core knows no Qt, so its texts are not marked: causes and cures of the tables of faults, topics and extents of the
certificate, states of numerical control, and the patterns of phrases, which are literals in the sources. Needs a
Python with numpy.
"""

import ast
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
CONTEXT = "Core"
"""The context in which ``freecad_app.core_texts`` looks them up."""
PHRASES = {"Phrase": 0, "Pattern": 0, "NotInstalledError": 0}
EXPECTED = PHRASES | {"UnexpectedError": 0, "validated": 2, "whole_from": 1}
"""Calls with a pattern, and which of their arguments it is; those of options anywhere else are the command line's."""


def phrases():
    """Patterns of phrases in the sources, in the order of files and lines."""
    for file in sorted((ROOT / "pkm_post").rglob("*.py")):
        text = file.read_text(encoding="utf-8")
        calls = EXPECTED if file.parent.name == "options" else PHRASES
        if not any(name in text for name in calls):  # most files; to parse them all takes seconds
            continue
        for node in ast.walk(ast.parse(text)):
            at = calls.get(getattr(node.func, "id", "")) if isinstance(node, ast.Call) else None
            if at is not None and len(node.args) > at:
                pattern = node.args[at]
                if isinstance(pattern, ast.Constant) and isinstance(pattern.value, str):
                    yield pattern.value
                elif isinstance(pattern, ast.JoinedStr):
                    raise ValueError(f"{file}:{node.lineno}: expected a literal pattern, got an f-string")


def core_texts():
    """All texts, each once, in a fixed order."""
    from pkm_post.control.link import EMERGENCY_STEPS, NOT_AT_REST
    from pkm_post.control.link.status import MotorBits, PowerMotorBits, PowerSystemBits, SystemBits
    from pkm_post.control.numerical_control import HomingPhase, Interlock
    from pkm_post.model import RULES, Extent, Topic

    rules = (text for code in sorted(RULES) for text in (RULES[code].cause, RULES[code].cure))
    words = (word.value for table in (Topic, Extent, Interlock, HomingPhase) for word in table)
    bits = (MotorBits, PowerMotorBits, SystemBits, PowerSystemBits)
    states = (text for each in bits for text in each.FAULT_TEXTS.values())
    return list(dict.fromkeys([*rules, *words, *states, *EMERGENCY_STEPS, *NOT_AT_REST, *phrases()]))


def main():
    """Write the file."""
    sys.path.insert(0, str(ROOT))
    lines = [f"QT_TRANSLATE_NOOP({CONTEXT!r}, {text!r})\n" for text in core_texts()]
    Path(sys.argv[1]).write_text("".join(lines), encoding="utf-8")


if __name__ == "__main__":
    main()
