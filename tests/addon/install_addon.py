# SPDX-License-Identifier: LGPL-2.1-or-later
"""Install an archive of the add-on with FreeCAD's Addon Manager; `make addon` runs it inside FreeCAD.

The Addon Manager asks a host for the archive of a branch, which has all files in one folder. Here it is a file.
"""

import re
import sys
import zipfile
from pathlib import Path

import FreeCAD as App

sys.path.insert(0, str(Path(App.getHomePath(), "Mod", "AddonManager")))

import addonmanager_installer
import addonmanager_utilities
from Addon import Addon

NAME, BRANCH = "pkm-post", "main"
URL = f"https://github.com/example/{NAME}"
_FILES, _BYTES = 700, 5_000_000
"""The most that an installed add-on may have."""


def install(archive: Path) -> Path:
    """Install, and return the folder of the add-on."""
    asked = []

    def from_the_host(url, *_):
        asked.append(url)
        return archive.read_bytes()

    addonmanager_utilities.blocking_get = from_the_host
    addon = Addon(NAME, URL, Addon.Status.NOT_INSTALLED, BRANCH)
    installer = addonmanager_installer.AddonInstaller(addon, allow_list=[])
    installer.git_manager = None  # an Addon Manager that finds git on its path clones
    done, failed = [], []
    installer.success.connect(done.append)
    installer.failure.connect(lambda _, why: failed.append(why))
    assert installer.run(), failed
    assert asked == [f"{URL}/archive/{BRANCH}.zip"], asked
    assert done == [addon] and not failed, failed
    assert str(addon.metadata.version).strip() == addon_version(archive), addon.metadata.version
    return Path(installer.installation_path) / NAME


def addon_version(archive: Path) -> str:
    """The version that the package.xml in the archive states."""
    with zipfile.ZipFile(archive) as opened:
        text = opened.read(f"{NAME}-{BRANCH}/package.xml").decode("utf-8")
    return re.search("<version>(.*)</version>", text).group(1)


def check(folder: Path) -> None:
    """Compare what was installed with what an add-on may be."""
    files = [path for path in folder.rglob("*") if path.is_file()]
    size = sum(path.stat().st_size for path in files)
    print(f"FreeCAD {'.'.join(App.Version()[:3])}: {len(files)} files, {size} bytes in {folder}")
    assert (folder / "Init.py").is_file() and (folder / "package.xml").is_file()
    assert len(files) <= _FILES and size <= _BYTES, (len(files), size)
    commands = (folder / "pkm_post/freecad_gui/commands.py").read_text(encoding="utf-8")
    pages = {"workbench.md", *re.findall(r'"([\w-]+\.md)"', commands)}
    missing = sorted(page for page in pages if not (folder / "docs" / page).is_file())
    assert len(pages) > 5 and not missing, f"F1 opens pages that are not there: {missing}"
    assert not [path for path in files if {"tests", "benchmarks", ".ci"} & set(path.relative_to(folder).parts)]
    macros = [path.name for path in Path(App.getUserMacroDir(True)).iterdir() if path.is_file()]
    assert macros == [], f"the Addon Manager copied macros: {macros}"


if __name__ == "__main__":
    check(install(Path(sys.argv[1])))
