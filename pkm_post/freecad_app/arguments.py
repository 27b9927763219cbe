# SPDX-License-Identifier: LGPL-2.1-or-later
"""Arguments: the text a CAM job has for its post-processor, read as a command line.

A job enters; parsed arguments leave, for ``pkm_post.options``. What is wrong with them is a fault of the job.
"""

from __future__ import annotations

import argparse
import shlex
from typing import Any, NoReturn

from pkm_post.freecad_app.job import document_name
from pkm_post.model import Diagnostic, Place, Refused
from pkm_post.options import add_options

POST_PROCESSOR = "hexapod_pmac"


def job_arguments(job: Any, text: str) -> argparse.Namespace:
    """The arguments of a job.

    Args:
        job: the job, to name it in faults.
        text: its arguments, quoted as in a shell.

    Raises:
        Refused: they are not understood, J117.
    """
    try:
        return _parser().parse_args(shlex.split(text))
    except ValueError as fault:
        place = Place(document_name(job.Document), job.Label)
        raise Refused([Diagnostic("J117", place, f"{fault} in {text!r}")]) from fault


def arguments_help() -> str:
    """What the arguments are, as text."""
    return _parser().format_help()


class _Parser(argparse.ArgumentParser):
    """Raises a ``ValueError`` where a program of its own would print its usage and end."""

    def error(self, message: str) -> NoReturn:
        raise ValueError(message)


def _parser() -> argparse.ArgumentParser:
    parser = _Parser(prog=POST_PROCESSOR, add_help=False, allow_abbrev=False, usage=argparse.SUPPRESS)
    parser.color = False  # Python 3.14 would colour the help if there is a terminal
    add_options(parser)
    return parser
