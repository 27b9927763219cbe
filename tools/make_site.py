# SPDX-License-Identifier: LGPL-2.1-or-later
"""Make site: gather the pages that mkdocs makes a site of, with their folders, so that links are as in the repository.

``python3 tools/make_site.py FOLDER``
"""

import shutil
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PAGES = ("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "SECURITY.md", "LICENSE", "docs", "examples", "resources")


def gather(folder: Path) -> None:
    """Copy the pages and what they link to into a new folder."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for name in PAGES:
        copied = shutil.copytree if (ROOT / name).is_dir() else shutil.copy
        copied(ROOT / name, folder / name)


if __name__ == "__main__":
    gather(Path(sys.argv[1]))
