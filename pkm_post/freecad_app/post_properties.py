# SPDX-License-Identifier: LGPL-2.1-or-later
"""Post properties: our arguments in the dialogs of FreeCAD newer than 1.1, and their entered values.

FreeCAD's machines store properties for their post-processor, a job overrides some of them, and CAM's Post Process
dialog shows and overrides them again [FreeCAD, Path/Post/Processor.py, build_configuration_bundle]. Input: these
properties. Output: the options they set, which override the arguments of the job.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from pkm_post.freecad_app.arguments import PMAC, parse_arguments, parser_of
from pkm_post.freecad_app.document import document_name
from pkm_post.model import Diagnostic, Place, Refused
from pkm_post.options import ArgumentField, ArgumentValues, argument_fields, explicit_values, text_of_fields

_PREFIX = "hexapod_"
"""Prefix: a FreeCAD machine keeps the properties of all post-processors it ever had in one namespace."""
_ONLY_PMAC = "also"

PropertySchema = list[dict[str, Any]]
Properties = Mapping[str, Any]


def property_schema(post_processor: str) -> PropertySchema:
    """The arguments of a post-processor, in the form of FreeCAD's dialogs."""
    return [_row(field) for field in _fields(post_processor)]


def _fields(post_processor: str) -> list[ArgumentField]:
    fields = argument_fields(parser_of(post_processor))
    return [each for each in fields if post_processor == PMAC or each.name != _ONLY_PMAC]


def _row(field: ArgumentField) -> dict[str, Any]:
    several = "; several values are separated by blanks" if field.is_repeated else ""
    row: dict[str, Any] = {
        "name": _PREFIX + field.name,
        "label": field.flag,
        "help": field.help + several,
        "runtime": True,
    }
    if field.is_switch:
        return row | {"type": "bool", "default": False}
    if field.choices:
        return row | {"type": "choice", "choices": ["", *field.choices], "default": ""}
    return row | {"type": "string", "default": ""}


def values_of_properties(job: Any, post_processor: str, machine: Any, entered: Properties) -> ArgumentValues:
    """The options set by properties of the machine, overridden by those of the job and by entered ones.

    Args:
        post_processor: one of ``POST_PROCESSORS``.
        machine: the machine of FreeCAD, or None.
        entered: values of the dialog by name of the property.

    Raises:
        Refused: a property is invalid, J117.
    """
    stored = getattr(machine, "postprocessor_properties", None) or {}
    place = Place(document_name(job.Document), job.Label)
    merged = {**stored, **_job_properties(job, place), **entered}
    filled = {name[len(_PREFIX) :]: value for name, value in merged.items() if name.startswith(_PREFIX)}
    try:
        text = text_of_fields(_fields(post_processor), filled)
    except ValueError as fault:
        raise Refused([Diagnostic("J117", place, f"{fault} in the properties of the machine or the dialog")]) from fault
    return explicit_values(parse_arguments(text, place, post_processor))


def _job_properties(job: Any, place: Place) -> dict[str, Any]:
    """The overrides that a job of FreeCAD newer than 1.1 stores as JSON."""
    text = getattr(job, "PostProcessorPropertyOverrides", "") or "{}"
    try:
        properties = json.loads(text)
        if not isinstance(properties, dict):
            raise ValueError("no object")
    except ValueError as fault:
        found = f"PostProcessorPropertyOverrides is not JSON of properties: {fault}"
        raise Refused([Diagnostic("J117", place, found)]) from fault
    return properties
