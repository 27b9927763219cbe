# SPDX-License-Identifier: LGPL-2.1-or-later
"""Packages: find missing optional Python packages, and install them for the running Python.

Input: names of modules, and a folder with wheels if there is no network. Output: installed packages, or the line
that installs them here. FreeCAD has its own folder for packages, by Python version;
``freecad_app.startup`` sets it. Nothing is downloaded before ``install`` is called.
"""

from __future__ import annotations

import importlib
import importlib.util
import os
import re
import shlex
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

OPTIONAL: dict[str, str] = {"lark": "lark", "serial": "pyserial", "paramiko": "paramiko", "matplotlib": "matplotlib"}
"""Packages by the module that needs them."""
PURPOSES: dict[str, str] = {
    "lark": "G-code and CL data",
    "serial": "serial lines to a controller",
    "paramiko": "ssh to a Power PMAC",
    "matplotlib": "pictures of reports and reach maps",
}
_OF_DEBIAN = {"serial": "python3-serial"}
_NO_WINDOW = getattr(subprocess, "CREATE_NO_WINDOW", 0)


@dataclass
class _Place:
    """Target of packages; None for that of the running Python."""

    folder: Path | None = None


_PLACE = _Place()


class NotInstalledError(Exception):
    """A package could not be installed: the reason as a literal pattern, which windows translate, and its values."""

    def __init__(self, pattern: str, *values: object) -> None:
        super().__init__(pattern.format(*values))
        self.pattern, self.values = pattern, values


def use_folder(folder: Path) -> None:
    """Set the folder of FreeCAD's packages and put it on the path of this process."""
    _PLACE.folder = folder


def missing() -> list[str]:
    """Optional modules that are not installed."""
    importlib.invalidate_caches()
    return [module for module in OPTIONAL if module not in sys.modules and importlib.util.find_spec(module) is None]


def needs(purpose: str, module: str) -> ImportError:
    """The exception for a missing package, which names the command that installs it here.

    Args:
        purpose: the task that needs it, with a verb.
        module: key of ``OPTIONAL``.
    """
    return ImportError(f"{purpose} {OPTIONAL[module]}: {cure(module)}", name=module)


def cure(module: str) -> str:
    """The command that installs a package here."""
    if _PLACE.folder is not None:
        return f"choose Install packages in the workbench PKM Post, or type: {_line(module)}"
    if _belongs_to_debian():
        return f"type: sudo apt-get install {_OF_DEBIAN.get(module, f'python3-{module}')}"
    return f"type: {_line(module)}"


def _line(module: str) -> str:
    words = _pip([OPTIONAL.get(module, module)], None)
    return subprocess.list2cmdline(words) if os.name == "nt" else shlex.join(words)


def _belongs_to_debian() -> bool:
    """Whether the distribution manages the packages of this Python, so pip refuses to [PEP 668]."""
    import sysconfig

    marker = Path(sysconfig.get_path("stdlib")) / "EXTERNALLY-MANAGED"
    return sys.prefix == sys.base_prefix and marker.exists() and Path("/etc/debian_version").exists()


def python_words() -> tuple[str, ...]:
    """The command of this Python: in FreeCAD the running program is FreeCAD itself."""
    program = Path(sys.executable or "")
    is_python = program.name.lower().startswith("python")
    if _PLACE.folder is not None:
        if os.environ.get("APPIMAGE"):
            return (os.environ["APPIMAGE"], "python")
        version = f"{sys.version_info.major}.{sys.version_info.minor}"
        names = (f"python{version}", "python.exe", "python3", "python")
        folders = (program.parent, Path(sys.prefix), Path(sys.prefix) / "bin")
        found = [folder / name for folder in folders for name in names if (folder / name).is_file()]
        if found and not is_python:
            return (str(found[0]),)
    return (str(program),) if is_python else ("python3",)


def _pip(packages: Sequence[str], wheels: Path | None) -> list[str]:
    where = [] if _PLACE.folder is None else ["--target", str(_PLACE.folder)]
    source = [] if wheels is None else ["--no-index", "--find-links", str(wheels)]
    return [*python_words(), "-m", "pip", "install", *where, *source, *packages]


def install(modules: Sequence[str], wheels: Path | None = None) -> str:
    """Install packages for this Python; return the result as text.

    Args:
        modules: keys of ``OPTIONAL``.
        wheels: folder with wheels, instead of the package index.

    Raises:
        NotInstalledError: a package could not be installed.
    """
    packages = [OPTIONAL[module] for module in modules]
    if _PLACE.folder is not None:
        _PLACE.folder.mkdir(parents=True, exist_ok=True)
    if _has_pip():
        ran = subprocess.run(
            [*_pip(packages, wheels), "--disable-pip-version-check", "--no-input"],
            stdin=subprocess.DEVNULL,
            capture_output=True,
            encoding="utf-8",
            errors="replace",
            creationflags=_NO_WINDOW,
            check=False,
        )
        if ran.returncode:
            raise NotInstalledError(
                "{}", ran.stderr.strip() or ran.stdout.strip() or f"pip ended with {ran.returncode}"
            )
    elif wheels is not None and _PLACE.folder is not None:
        for package in packages:
            _unpack(_wheel(package, wheels), _PLACE.folder)
    else:
        raise NotInstalledError("{} has no pip: install pip, or name a folder with wheels", " ".join(python_words()))
    _make_importable()
    return f"installed: {', '.join(packages)}"


def _has_pip() -> bool:
    return not subprocess.run(
        [*python_words(), "-m", "pip", "--version"],
        stdin=subprocess.DEVNULL,
        capture_output=True,
        creationflags=_NO_WINDOW,
        check=False,
    ).returncode


def _make_importable() -> None:
    folder = _PLACE.folder
    if folder is not None and str(folder) not in sys.path:
        sys.path.append(str(folder))
    importlib.invalidate_caches()


def _wheel(package: str, wheels: Path) -> Path:
    """The newest pure-Python wheel of a package; only such wheels are installed without pip."""
    found = [file for file in wheels.glob("*-none-any.whl") if file.name.lower().startswith(f"{package}-")]
    if not found:
        raise NotInstalledError("{} has no {}-*-none-any.whl, and there is no pip for other wheels", wheels, package)
    return max(found, key=_version)


def _version(wheel: Path) -> list[int]:
    """The numbers of a wheel's version, for comparison: 1.10 is above 1.9."""
    return [int(digits) for digits in re.findall(r"\d+", wheel.name.split("-")[1])]


def _unpack(wheel: Path, folder: Path) -> None:
    import zipfile

    try:
        with zipfile.ZipFile(wheel) as archive:
            for name in archive.namelist():
                if not (folder / name).resolve().is_relative_to(folder.resolve()) or ".data/" in name:
                    raise NotInstalledError("{} has {}, which is no module: install pip for it", wheel.name, name)
            archive.extractall(folder)
    except (OSError, zipfile.BadZipFile) as fault:
        raise NotInstalledError("{}: {}", wheel.name, fault) from fault
