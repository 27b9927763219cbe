# SPDX-License-Identifier: LGPL-2.1-or-later
"""CAM finds the post-processor in the add-on's own folder, whatever that is called, and makes it without a job."""

import shutil
from pathlib import Path as FilePath

import Path
import Path.Preferences
import pytest
from another_freecad import ROOT, printed_by
from Path.Post.Processor import PostProcessor, PostProcessorFactory

from pkm_post.freecad_app import startup

NAME = "hexapod_pmac"
NAMES = ["hexapod_pmac", "hexapod_trajectory", "hexapod_linuxcnc", "hexapod_gcode"]


@pytest.mark.parametrize("name", NAMES)
def test_cam_lists_each_post_processor_once(name):
    assert Path.Preferences.allAvailablePostProcessors().count(name) == 1
    assert name in Path.Preferences.allEnabledPostProcessors()
    assert PostProcessor.exists(name)


def test_installing_again_changes_nothing():
    search = Path.Preferences.searchPathsPost
    startup.install_post_processors()
    startup.install_post_processors()
    assert Path.Preferences.searchPathsPost is search
    assert search().count(startup.FOLDER) == 1


def test_folder_of_the_add_on_comes_first():
    assert FilePath(Path.Preferences.searchPathsPost()[0]) == ROOT / "postprocessors"


def test_stock_post_processors_are_still_there():
    assert {"linuxcnc", "grbl"} <= set(Path.Preferences.allAvailablePostProcessors())


def test_no_file_in_the_folder_hides_the_package():
    names = [path.name for path in (ROOT / "postprocessors").glob("*.py")]
    assert sorted(names) == sorted(f"{name}_post.py" for name in NAMES)


@pytest.mark.parametrize("name", NAMES)
def test_factory_makes_it_without_a_job(name):
    post = PostProcessorFactory.get_post_processor(None, name)
    assert "hexapod" in post.tooltip
    assert ("--form" in post.tooltipArgs) == (name == "hexapod_gcode")
    for flag in ("--machine", "--work-offset", "--tip-tolerance", "--axis-tolerance", "--tool-length"):
        assert flag in post.tooltipArgs
    assert "\x1b" not in post.tooltipArgs
    assert post.units == "G21"


def test_job_can_be_set_to_it(job):
    job.PostProcessor = NAME
    assert job.PostProcessor == NAME


_LIST = """
import sys
before = "Path" in sys.modules
import Path.Preferences
finders = [finder for finder in sys.meta_path if getattr(finder, "awaited", "") == "Path.Preferences"]
print("posts:", before, Path.Preferences.allAvailablePostProcessors().count("hexapod_pmac"), len(finders))
import Path.Post.Processor
post = Path.Post.Processor.PostProcessorFactory.get_post_processor(None, "hexapod_pmac")
print("made:", type(post).__name__, sys.modules["pkm_post"].__file__)
"""


@pytest.mark.parametrize("folder", ["PKM Post (1)", "pkm_post"])
def test_installed_in_a_folder_of_any_name(tmp_path, folder):
    # In a FreeCAD of its own, which shows as well that CAM is not loaded when FreeCAD starts.
    addon = tmp_path / folder
    addon.mkdir()
    for name in ("pkm_post", "postprocessors"):
        shutil.copytree(ROOT / name, addon / name, ignore=shutil.ignore_patterns("__pycache__"))
    for name in ("Init.py", "package.xml"):
        shutil.copy(ROOT / name, addon / name)
    script = tmp_path / "list.py"
    script.write_text(_LIST)
    printed = printed_by(script, addon=addon)
    assert "posts: False 1 0" in printed
    assert f"made: HexapodPmac {addon}" in printed
