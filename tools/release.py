# SPDX-License-Identifier: LGPL-2.1-or-later
"""Release: bring version, date and project of release.toml into the files that state them, and check a release.

``python3 tools/release.py --write`` changes the files; ``--check`` says what a release still lacks.
"""

import argparse
import re
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PLACEHOLDERS = ("PLACEHOLDER", "example.invalid")


def values() -> dict[str, str]:
    """Version, date, maintainer, email, repository and branch."""
    read = tomllib.loads((ROOT / "release.toml").read_text(encoding="utf-8"))
    return {"version": read["version"], "date": read["date"], **read["project"]}


STATED: dict[str, tuple[tuple[str, str], ...]] = {
    "package.xml": (
        (r"<version>[^<]*</version>", "<version>{version}</version>"),
        (r"<date>[^<]*</date>", "<date>{date}</date>"),
        (r"<maintainer [^<]*</maintainer>", '<maintainer email="{email}">{maintainer}</maintainer>'),
        (
            r'<url type="repository"[^<]*</url>',
            '<url type="repository" branch="{branch}">{repository}</url>',
        ),
        (r'<url type="readme">[^<]*</url>', '<url type="readme">{repository}/blob/{branch}/README.md</url>'),
        (r'<url type="bugtracker">[^<]*</url>', '<url type="bugtracker">{repository}/issues</url>'),
        (
            r'<url type="documentation">[^<]*</url>',
            '<url type="documentation">{repository}/blob/{branch}/docs/README.md</url>',
        ),
    ),
    "pyproject.toml": (
        (r'(?m)^version = "[^"]*"', 'version = "{version}"'),
        (r"(?m)^maintainers = .*", 'maintainers = [{{ name = "{maintainer}", email = "{email}" }}]'),
        (r'(?m)^Homepage = ".*"', 'Homepage = "{repository}"'),
        (r'(?m)^Documentation = ".*"', 'Documentation = "{repository}/blob/{branch}/docs/README.md"'),
        (r'(?m)^Issues = ".*"', 'Issues = "{repository}/issues"'),
        (r'(?m)^Changelog = ".*"', 'Changelog = "{repository}/blob/{branch}/CHANGELOG.md"'),
        (r"(?m)^(replacement = ).*raw.*", r"\1'![\g<1>]({repository}/raw/{branch}/\g<2>)'"),
        (r"(?m)^(replacement = ).*/blob/.*", r"\1']({repository}/blob/{branch}/\g<1>)'"),
    ),
    "CITATION.cff": (
        (r"(?m)^version: .*", "version: {version}"),
        (r"(?m)^date-released: .*", "date-released: {date}"),
        (r"(?m)^repository-code: .*", "repository-code: {repository}"),
        (r"(?m)^  - name: .*", '  - name: "{maintainer}"'),
    ),
    "pkm_post/__init__.py": ((r'(?m)^__version__ = "[^"]*"', '__version__ = "{version}"'),),
}
"""By file: pattern and text of each statement."""


def stated(name: str, given: dict[str, str]) -> str:
    """The text of a file, with the values in their places.

    Raises:
        ValueError: a place is missing, or there are several.
    """
    text = (ROOT / name).read_text(encoding="utf-8")
    for pattern, template in STATED[name]:
        text, count = re.subn(pattern, lambda match, form=template: _filled(match, form, given), text)
        if count != 1:
            raise ValueError(f"{name}: {count} places match {pattern}, expected one")
    return text


def _filled(match: re.Match[str], template: str, given: dict[str, str]) -> str:
    first = match.group(1) if match.re.groups else ""
    return first.join(template.split(r"\1", 1)).format(**given)


def differences() -> list[str]:
    """Files that do not state what release.toml says."""
    return [name for name in STATED if stated(name, values()) != (ROOT / name).read_text(encoding="utf-8")]


def lacking() -> Iterator[str]:
    """Yield what a release lacks."""
    given = values()
    for name, value in given.items():
        if any(word in value for word in PLACEHOLDERS):
            yield f"release.toml: {name} is a placeholder: {value}"
    for name in differences():
        yield f"{name} does not say what release.toml says: python3 tools/release.py --write"
    heading = f"## [{given['version']}] - {given['date']}"
    if heading not in (ROOT / "CHANGELOG.md").read_text(encoding="utf-8").splitlines():
        yield f"CHANGELOG.md has no line {heading}"
    if has_changes():
        yield "the working copy has changes: commit them"


def has_changes() -> bool:
    """Whether the working copy differs from the last commit."""
    return bool(subprocess.run(["git", "status", "--porcelain"], cwd=ROOT, capture_output=True, check=True).stdout)


def main(arguments: list[str]) -> int:
    """Write or check; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("--write", action="store_true", help="bring the values of release.toml into the files")
    what.add_argument("--check", action="store_true", help="say what a release lacks")
    if parser.parse_args(arguments).write:
        for name in STATED:
            (ROOT / name).write_text(stated(name, values()), encoding="utf-8", newline="\n")
        return 0
    found = list(lacking())
    print(*found or [f"ready: tag v{values()['version']}"], sep="\n")
    return int(bool(found))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
