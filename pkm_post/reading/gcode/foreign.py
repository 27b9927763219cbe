# SPDX-License-Identifier: LGPL-2.1-or-later
"""Foreign languages: part programs that are not G-code of RS274NGC or ISO, recognised by their unique constructs.

Input: the text of a program. Output: the name of its language and the place of the evidence, or nothing. Two kinds of
evidence are needed, as one may be a typing error.
"""

from __future__ import annotations

import re

_LEAST = 2
_MOST_SHOWN = 3
_BLOCK = r"^[ \t]*(?:N?\d+[ \t]+)?"

LANGUAGES: dict[str, dict[str, str]] = {
    "Heidenhain klartext": {
        "BEGIN PGM": _BLOCK + r"BEGIN[ \t]+PGM\b",
        "TOOL CALL": _BLOCK + r"TOOL[ \t]+(?:CALL|DEF)\b",
        "CYCL DEF": _BLOCK + r"CYCL[ \t]+(?:DEF|CALL)\b",
        "BLK FORM": _BLOCK + r"BLK[ \t]+FORM\b",
        "L X+": _BLOCK + r"L[ \t]+[XYZABC][+-]",
        "CC X+": _BLOCK + r"(?:CC|CR|CT|CP)[ \t]+[XYZI][+-]",
        "FMAX": r"\bFMAX\b",
    },
    "Heidenhain DIN/ISO": {
        "% with G71": r"^[ \t]*%[^\n;(]*[ \t]G7[01]\b",
        "N99999999 %": r"^[ \t]*N9{6,8}[ \t]*%",
        "* at the end of a block": r"^[ \t]*N\d+[ \t][^\n;(]*\*[ \t]*$",
    },
    "Siemens's language (Sinumerik)": {
        'MSG("")': r"\bMSG[ \t]*\([ \t]*\"",
        "CYCLE": r"\bCYCLE\d{2,4}[ \t]*\(",
        'T=""': r"\bT[ \t]*=[ \t]*\"",
        "R parameters": _BLOCK + r"R\d+[ \t]*=",
        "=IC()": r"=[ \t]*(?:IC|AC|DC|ACP|ACN)[ \t]*\(",
        "CR=": r"\bCR[ \t]*=",
        "%_N_": r"^%_N_",
        "system variables": r"\$(?:P|TC|AA|MN|MA)_",
        "DEF REAL": _BLOCK + r"DEF[ \t]+(?:REAL|INT|BOOL|AXIS|STRING)\b",
        "names such as ORIWKS": r"\b(?:ORIWKS|ORIAXES|ORIMKS|STOPRE|SUPA|FFWON|SOFT|COMPCAD|CUT2D|WORKPIECE)\b",
    },
}
"""By language, regular expressions of constructs unique to it."""

_COMPILED = {
    name: {what: re.compile(pattern.encode(), re.MULTILINE | re.IGNORECASE) for what, pattern in evidence.items()}
    for name, evidence in LANGUAGES.items()
}


def foreign_language(text: bytes) -> tuple[str, int] | None:
    """The foreign language of a program with its evidence, and the first line of that; None if it is G-code."""
    shown = shown_by_language(text)
    name = max(shown, key=lambda each: len(shown[each]))
    if len(shown[name]) < _LEAST:
        return None
    evidence = sorted(shown[name], key=lambda each: each[1])[:_MOST_SHOWN]
    return f"{name}: {', '.join(f'{what} in line {line}' for what, line in evidence)}", evidence[0][1]


def shown_by_language(text: bytes) -> dict[str, list[tuple[str, int]]]:
    """By language, the kinds of its evidence in a text with line feeds, each with the line of the first."""
    return {
        name: [(what, text.count(b"\n", 0, found.start()) + 1) for what, found in _found(text, patterns)]
        for name, patterns in _COMPILED.items()
    }


def _found(text: bytes, patterns: dict[str, re.Pattern[bytes]]) -> list[tuple[str, re.Match[bytes]]]:
    return [(what, found) for what, pattern in patterns.items() if (found := pattern.search(text))]
