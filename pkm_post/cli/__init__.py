# SPDX-License-Identifier: LGPL-2.1-or-later
"""Command line: ``python3 -m pkm_post post part.FCStd --machine example_6tps --out DIR`` and other commands.

Exit code 0 on success, 1 when the input was refused, memory ran out, or the output was closed or full, 2 for arguments
that are not valid, 130 after Ctrl-C or a signal that ends the process. Each module adds its commands to the parser and
runs them; only the module of the named command is imported.
"""

from __future__ import annotations

import argparse
import importlib
import io
import os
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NoReturn

import pkm_post
from pkm_post import at_first_use
from pkm_post.cli.processes import INTERRUPTED, diagnostic_text
from pkm_post.cli.terminal import interrupt_on_end
from pkm_post.options import UsageParser
from pkm_post.system import MEMORY_FAULTS, THREADS, ThreadCountError, memory_diagnostic

if TYPE_CHECKING:
    from pkm_post.cli.batch import run_batch
else:
    __getattr__ = at_first_use(__name__, {"batch": "run_batch"})

_COMMANDS = {
    "post": ("post",),
    "reach": ("reach", "reach-map", "stiffness"),
    "programs": ("check", "convert", "verify", "cartesian"),
    "machine": ("machine",),
    "pmac": ("pmac", "play"),
    "batch": ("batch",),
    "install": ("install",),
}
"""Commands by module, in the order of the help text."""


def main(arguments: Sequence[str]) -> int:
    """Run one command and return its exit code."""
    try:
        _prepare_streams()
        interrupt_on_end()
        namespace = _parser(arguments[:1]).parse_args(arguments)
        code: int = namespace.run(namespace, arguments)
        sys.stdout.flush()
    except KeyboardInterrupt:
        return INTERRUPTED
    except ThreadCountError as fault:
        print(diagnostic_text("F115", THREADS, str(fault)), file=sys.stderr)
        return 1
    except MEMORY_FAULTS as fault:
        message = memory_diagnostic(fault, "pkm_post") or _not_installed(fault) or _output_fault(fault)
        if message is None:
            raise
        print(message, end="\n" if message else "", file=sys.stderr)
        return 1
    except _refused() as fault:
        print(fault, file=sys.stderr)
        return 1
    return code


def _refused() -> tuple[type[Exception], ...]:
    """The exception of a refused input; none before the import of the model, which needs NumPy."""
    model = sys.modules.get("pkm_post.model")
    return () if model is None else (model.Refused,)


def _not_installed(fault: BaseException) -> str | None:
    from pkm_post.system import packages

    if isinstance(fault, ImportError) and fault.name == "numpy":
        return f"PKM Post needs NumPy: {packages.cure('numpy')}"
    return str(fault) if isinstance(fault, ImportError) and fault.name in packages.OPTIONAL else None


def _prepare_streams() -> None:
    """Open null streams for a service, which has none; make streams escape what their encoding does not have.

    Otherwise one byte on the standard input that is no character would end the reading of an operator's orders.
    """
    for name, mode in (("stdin", "r"), ("stdout", "w"), ("stderr", "w")):
        stream = getattr(sys, name)
        if stream is None:
            setattr(sys, name, open(os.devnull, mode, encoding="utf-8"))  # noqa: SIM115 - it lasts as long as Python
        elif isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")


def _output_fault(fault: BaseException) -> str | None:
    """Why nothing can be printed: the disk is full; empty if the pipe was closed, as by ``| head``; None if it can."""
    if not isinstance(fault, OSError):
        return None
    try:
        print(flush=True)
    except OSError as unprinted:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # Python flushes once more at exit
        closed = isinstance(unprinted, BrokenPipeError)
        return "" if closed else diagnostic_text("F101", "standard output", unprinted.strerror or str(unprinted))
    return None


class _Commands(argparse._SubParsersAction):  # type: ignore[type-arg]
    """Commands whose line in the list of all is the beginning of their own help as well."""

    def add_parser(self, name: str, **keywords: Any) -> Any:
        """Add the parser of a command."""
        text = keywords["help"]
        return super().add_parser(name, **{"description": f"{text[0].upper()}{text[1:]}."} | keywords)


class CommandParser(UsageParser):
    """A parser that prints the diagnostic of a fault and exits."""

    def __init__(self, **keywords: Any) -> None:
        super().__init__(**keywords)
        self.register("action", "parsers", _Commands)

    def refuse(self, code: str, found: str) -> NoReturn:
        """Exit with code 2."""
        self.exit(2, f"{diagnostic_text(code, self.prog, found)}\n")


def _parser(first: Sequence[str] = ()) -> argparse.ArgumentParser:
    """The parser of the command that the first argument names, or of all commands if it names none."""
    program = "pkm-post" if os.path.basename(sys.argv[0]) == "pkm-post" else "python3 -m pkm_post"
    parser = CommandParser(prog=program, description=pkm_post.__doc__)
    parser.add_argument("--version", action="version", version=f"PKM Post {pkm_post.__version__}")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    named = [module for module, names in _COMMANDS.items() if set(first) & set(names)]
    for module in named or _COMMANDS:
        importlib.import_module(f"pkm_post.cli.{module}").add_commands(commands)
    return parser
