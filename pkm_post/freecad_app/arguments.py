# SPDX-License-Identifier: LGPL-2.1-or-later
"""Arguments: the post-processor arguments of a CAM job, parsed as a command line.

Takes a job; returns parsed arguments, for ``pkm_post.options``. Errors in them are faults of the job. All
post-processors of PKM Post accept the same arguments, so a job can switch between them; some accept additional ones.
"""

from __future__ import annotations

import argparse
import shlex
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import Path.Preferences

from pkm_post.freecad_app.document import document_name
from pkm_post.model import Diagnostic, Place, Refused
from pkm_post.options import (
    ArgumentValues,
    InputKind,
    TextParser,
    add_recorded,
    explicit_values,
    inapplicable_options,
    parse_text,
    text_parser,
)
from pkm_post.writing import GcodeDialect

PMAC, TRAJECTORY, LINUXCNC, GCODE = "hexapod_pmac", "hexapod_trajectory", "hexapod_linuxcnc", "hexapod_gcode"

POST_PROCESSORS: dict[str, str] = {
    PMAC: "Writes the motion program, with set-up file, trajectory and report in the same folder.",
    TRAJECTORY: "Writes the trajectory as NAME.pkmt; the text that CAM saves names it. Reach is checked, speed is not:"
    " nothing is certified. --also has no meaning here.",
    LINUXCNC: "Writes X Y Z A B C for LinuxCNC's hexapod, in the machine frame. Reach is checked, speed is left to the"
    " controller: nothing is certified. --also has no meaning here.",
    GCODE: "Writes the program of the job as it is, in the work frame: --form and --inch say how. Reach is not checked:"
    " what concerns the machine changes nothing. --also has no meaning here.",
}
"""Output of each post-processor, by name, for the help text."""

_EXTRA_ARGUMENTS: dict[str, dict[str, dict[str, Any]]] = {
    GCODE: {
        "--form": {
            "choices": tuple(form.value for form in GcodeDialect),
            "default": GcodeDialect.VECTOR.value,
            "help": "how the tool axis is written: I J K after G43.5, rotary words of a head after G43.4, A B C of"
            " LinuxCNC's hexapod, or not at all (default: %(default)s)",
        },
        "--inch": {"action": "store_true", "help": "write inches (G20)"},
    },
}
"""Additional arguments of some post-processors."""


def values_of(arguments: str | ArgumentValues) -> ArgumentValues:
    """Parse a text into the options it sets, without defaults; parsed options are returned unchanged.

    Raises:
        Refused: as ``job_arguments``.
    """
    return explicit_values(parse_arguments(arguments, Place("arguments"))) if isinstance(arguments, str) else arguments


def job_arguments(job: Any, text: str, post_processor: str = PMAC) -> argparse.Namespace:
    """Parse the arguments of a job.

    Args:
        job: the job, named in faults.
        text: its arguments, quoted as in a shell.
        post_processor: one of ``POST_PROCESSORS``.

    Raises:
        Refused: the arguments are invalid, J117.
    """
    place = Place(document_name(job.Document), job.Label)
    chosen = parse_arguments(text, place, post_processor)
    misplaced = inapplicable_options(explicit_values(chosen), {InputKind.JOB})
    if misplaced:
        raise Refused([Diagnostic("J117", place, each) for each in misplaced])
    return chosen


def parse_arguments(text: str, place: Place, post_processor: str = PMAC) -> argparse.Namespace:
    """Parse arguments as typed by the user; ``place`` states their origin.

    Raises:
        Refused: as ``job_arguments``.
    """
    try:
        chosen = parse_text(text, parser_of(post_processor))
        if chosen.also and post_processor != PMAC:
            raise ValueError(f"--also is only for {PMAC} in {text!r}")
    except ValueError as fault:
        raise Refused([Diagnostic("J117", place, fault.args[0])]) from fault
    return chosen


def own_arguments(job: Any, post_processor: str = "") -> argparse.Namespace:
    """Parse the arguments of a job for a post-processor of PKM Post; arguments for any other one are ignored.

    Args:
        post_processor: one of ``POST_PROCESSORS``; empty for that of the job.

    Raises:
        Refused: as ``job_arguments``.
    """
    named = post_processor or job.PostProcessor
    if named in POST_PROCESSORS:
        return job_arguments(job, job.PostProcessorArgs, named)
    return job_arguments(job, "")


def own_text(job: Any) -> str:
    """The argument text for ``hexapod_pmac``, unchanged if its quotes do not close; empty if there is none."""
    if job.PostProcessor not in POST_PROCESSORS:
        return ""
    try:
        return replace_arguments(job.PostProcessorArgs, dict.fromkeys(_EXTRA_ARGUMENTS.get(job.PostProcessor, {})))
    except ValueError:  # the parser reports the error
        return str(job.PostProcessorArgs)


def replace_arguments(text: str, chosen: Mapping[str, str | Sequence[str] | None]) -> str:
    """Replace some arguments; all others stay unchanged.

    Args:
        text: the arguments, quoted as in a shell.
        chosen: values by flag, several for a flag that may be repeated; None removes it, so that its default applies.

    Raises:
        ValueError: the quotes of the text do not close.
    """
    kept = [word for flag, words in _by_flag(shlex.split(text)) if flag not in chosen for word in words]
    values = {flag: [value] if isinstance(value, str) else value or () for flag, value in chosen.items()}
    return shlex.join([*kept, *(f"{flag}={value}" for flag, each in values.items() for value in each)])


def flags_in(text: str) -> set[str]:
    """The flags of some arguments.

    Raises:
        ValueError: the quotes of the text do not close.
    """
    return {flag for flag, _ in _by_flag(shlex.split(text))}


def _by_flag(words: list[str]) -> Iterator[tuple[str, list[str]]]:
    """Yield each flag with its words: one word with ``=`` or without a value, else two."""
    while words:
        flag, equals, _ = words[0].partition("=")
        with_value = not equals and len(words) > 1 and not words[1].startswith("--")
        size = 2 if flag.startswith("--") and with_value else 1
        yield flag, words[:size]
        words = words[size:]


def store_in_job(job: Any, text: str, program: str) -> None:
    """Store arguments and output file in the job, so that CAM's own post command gives the same result.

    Args:
        job: the job; its post-processor is set to ``hexapod_pmac``.
        text: the arguments.
        program: path of the motion program.
    """
    if PMAC not in job.getEnumerationsOfProperty("PostProcessor"):  # created without PKM Post installed
        job.PostProcessor = Path.Preferences.allEnabledPostProcessors([PMAC])
    for name, value in (("PostProcessor", PMAC), ("PostProcessorArgs", text), ("PostProcessorOutputFile", program)):
        if getattr(job, name) != value:
            setattr(job, name, value)


def arguments_help(post_processor: str = PMAC) -> str:
    """Help text of the arguments."""
    return parser_of(post_processor).format_help()


def parser_of(post_processor: str) -> TextParser:
    """The parser of a post-processor's arguments."""
    parser = text_parser(post_processor, POST_PROCESSORS[post_processor])
    for flag, words in _EXTRA_ARGUMENTS.get(post_processor, {}).items():
        add_recorded(parser, flag, **words)
    return parser
