# SPDX-License-Identifier: LGPL-2.1-or-later
"""Core texts: causes, cures and phrases of the core in the language and the units of the user.

The core is English and independent of Qt. Its messages are ``Phrase`` objects, or entries of its tables; FreeCAD
translates them in the context ``Core``, and amounts get the units of the user. Without a translation, as in FreeCAD's
console, all is English; written files are always English.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping

import FreeCAD as App

from pkm_post.freecad_app.user_units import amount_text
from pkm_post.model import RULES, Amount, Diagnostic, Extent, Phrase, Place, Refused, Severity, in_one_line

translate = App.Qt.translate
QT_TRANSLATE_NOOP = App.Qt.QT_TRANSLATE_NOOP

_SEVERITIES = {
    Severity.ERROR: QT_TRANSLATE_NOOP("CoreTexts", "error"),
    Severity.WARNING: QT_TRANSLATE_NOOP("CoreTexts", "warning"),
}
_STORED = re.compile(r"(?:(?P<place>.*?): )?(?:error|warning) (?P<code>[A-Z]\d{3}): (?P<rest>.*)", re.DOTALL)


def shown(text: str) -> str:
    """A text of the core: a phrase by its pattern and its values, any other text as a whole."""
    if not isinstance(text, Phrase):
        return str(translate("Core", text))
    named = {name: _shown_value(value) for name, value in text.named.items()}
    return str(translate("Core", text.pattern)).format(*map(_shown_value, text.values), **named)


def _shown_value(value: object) -> object:
    if isinstance(value, Phrase):
        return shown(value)
    if isinstance(value, Diagnostic):
        return fault_text(value)
    return amount_text(value.value, value.unit) if isinstance(value, Amount) else value


def cause_text(code: str) -> str:
    """The cause of a fault."""
    return shown(RULES[code].cause)


def cure_text(code: str) -> str:
    """The cure of a fault."""
    return shown(RULES[code].cure)


def place_text(place: Place) -> str:
    """File, operation and line; empty for none."""
    line = translate("CoreTexts", "line {}").format(place.position) if place.line else ""
    return ": ".join(filter(None, (place.file, place.operation, line)))


def finding_text(fault: Diagnostic) -> str:
    """Code, cause, finding and cure, without the place."""
    pattern = translate("CoreTexts", "{code} {cause}: {found}; {cure}")
    cause, cure = cause_text(fault.code), cure_text(fault.code)
    return str(pattern.format(code=fault.code, cause=cause, found=_found_text(fault.found), cure=cure))


def fault_text(fault: Diagnostic) -> str:
    """A diagnostic in one line, like its ``str``, in the language of the user."""
    severity = translate("CoreTexts", _SEVERITIES[fault.severity])
    pattern = translate("CoreTexts", "{place}: {severity} {code}: {cause}: {found}; {cure}")
    return in_one_line(
        pattern.format(
            place=place_text(fault.place),
            severity=severity,
            code=fault.code,
            cause=cause_text(fault.code),
            found=_found_text(fault.found),
            cure=cure_text(fault.code),
        )
    )


def _found_text(found: str) -> str:
    """The finding; only phrases are translated, since other text may come from the input."""
    return shown(found) if isinstance(found, Phrase) else found


def faults_text(faults: Iterable[Diagnostic]) -> str:
    """Diagnostics, one per line."""
    return "\n".join(map(fault_text, faults))


def exception_text(fault: BaseException) -> str:
    """The message of an exception; with diagnostics in the language of the user."""
    if isinstance(fault, Refused):
        return faults_text(fault.diagnostics)
    diagnostic = getattr(fault, "diagnostic", None)  # a DiagnosedError of the link
    if diagnostic is not None:
        return fault_text(diagnostic)
    first = fault.args[0] if fault.args else None
    return shown(first) if isinstance(first, Phrase) else str(fault)


def meaning_lines(coverage: Iterable[Mapping[str, str]]) -> list[str]:
    """The scope of the certificate, from the coverage of a report: a line per topic, with its hazards by extent."""
    rows, lines = list(coverage), []
    for topic in dict.fromkeys(row["topic"] for row in rows):
        by_extent: dict[str, list[str]] = {extent.value: [] for extent in Extent}
        for row in rows:
            if row["topic"] == topic:
                by_extent[row["extent"]].append(shown(row["what"]))
        parts = (f"{shown(extent)}: {', '.join(hazards)}" for extent, hazards in by_extent.items() if hazards)
        lines.append(f"{shown(topic)}: {'; '.join(parts)}")
    return lines


def stored_fault(text: str) -> Diagnostic | None:
    """The diagnostic of an English line stored in a document; None if its cause or cure has changed since."""
    match = _STORED.fullmatch(text)
    rule = RULES.get(match["code"]) if match else None
    if match is None or rule is None:
        return None
    head, tail, rest = f"{rule.cause}: ", f"; {rule.cure}", match["rest"]
    if not (rest.startswith(head) and rest.endswith(tail)):
        return None
    return Diagnostic(match["code"], Place(match["place"] or ""), rest[len(head) : -len(tail)])


class ShownRefused(Refused):
    """A refusal whose message is in the language of the user: FreeCAD shows it as the state of an object."""

    def __str__(self) -> str:
        return faults_text(self.diagnostics)
