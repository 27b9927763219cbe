# SPDX-License-Identifier: LGPL-2.1-or-later
"""Documents that versions of PKM Post saved are opened by this one: same classes, same properties, same results.

tests/data/saved keeps one for each version, written by save_all_kinds.py. The words of reports may get better from
version to version, so they are not compared; numbers, choices, links and paths are.
"""

import copy
import re
import shutil
import zipfile
from pathlib import Path

import FreeCAD as App
import numpy as np
import pytest
from save_all_kinds import PROGRAM, all_kinds

SAVED = Path(__file__).parents[1] / "data" / "saved"
VERSIONS = sorted(SAVED.glob("*.FCStd"))
ROUNDING = 1e-9
"""mm, or of the unit that a property has."""
SIXTH_DECIMAL = 0.51e-6
"""mm, and of components of unit vectors: FreeCAD saves the words of a path with six decimals."""
COMPUTED = {"Simulation": 1e-5, "Reach": 1e-3}
"""mm, degrees, s, mm/s: by how much what is computed of a path may differ, by object: another version may plan it
otherwise, and 0.1.0 took the numbers in memory; the sixth decimal of an axis moves some margins by 3e-4."""
LIFTED = {("pkm_post-0.1.0", "SurfaceFinish"): {25, 26}, ("pkm_post-0.1.0", "PkmMirror"): {24, 25}}
"""Rows of paths where the tool is lifted higher than it was, by version and object: as far as it came down."""
CHANGED = {
    ("pkm_post-0.1.0", "Reach"): {"Margins": (0.998, 1 + 1e-6)},
    ("pkm_post-0.1.0", "Simulation"): {
        "WayLength": (1.0, 1.0005),
        "Duration": (0.8, 1.0045),
        "OperationTimes": (0.6, 1.01),
        "GreatestStrutSpeed": (0.94, 1.06),
        "LongestStrut": (1 - 1e-5, 1 + 1e-5),
        "ShortestStrut": (1 - 1e-5, 1 + 1e-5),
    },
}
"""Results that changed on purpose, by version and object, and in which range they are now by what they were: motions of
0.1.0 could turn the tool axis by a third faster than the machine file allows, were slow on short moves and used 60 % of
the acceleration; the tool is lifted higher at two passes."""
WORDS = {"Report", "Violations", "Problems", "Found", "OutOfLimits", "ProvenMargins", "ExpressionEngine"}
ADDED = {
    ("pkm_post-0.1.0", "Reach"): ("ViolationOperations", "ViolationLines", "ViolationPoints"),
    ("pkm_post-0.1.0", "SurfaceFinish"): ("UnseenGouge",),
}
"""Results that a version did not have yet, by file and object."""
CLASSES = {
    "PkmMirror": "pkm_post.freecad_app.symmetry.MirroredOperation",
    "PkmMirror001": "pkm_post.freecad_app.symmetry.MirroredOperation",
    "PkmRotation": "pkm_post.freecad_app.symmetry.RotatedOperation",
    "PkmRotation001": "pkm_post.freecad_app.symmetry.RotatedOperation",
    "DressupPkmNormals": "pkm_post.freecad_app.normal_compensation.NormalCompensation",
    "SurfaceFinish": "pkm_post.freecad_app.surface_finish.SurfaceFinish",
    "Machine": "pkm_post.freecad_app.machine_object.MachineObject",
    "Reach": "pkm_post.freecad_app.reach_object.ReachObject",
    "Simulation": "pkm_post.freecad_app.simulation_object.SimulationObject",
    "PkmProgram": "pkm_post.freecad_app.program_object.PartProgram",
}
"""A file format: names of classes in documents of users."""


def computed_again(document):
    """The properties of all kinds of objects, when everything was computed."""
    for obj in document.Objects:
        obj.touch()
    document.recompute()
    assert [obj.Label for obj in document.Objects if not obj.isValid()] == []
    return all_properties(document)


def all_properties(document):
    return {name: properties(document.getObject(name)) for name in CLASSES}


@pytest.fixture(autouse=True, scope="module")
def no_document_is_left():
    yield
    for name in App.listDocuments():
        App.closeDocument(name)


def opened(file, folder):
    """A copy of a saved document and of its part program, opened where the program is found."""
    for each in (file, SAVED / PROGRAM):
        shutil.copy(each, folder)
    return App.openDocument(str(folder / file.name))


class Saved:
    """A saved document that was opened and computed again: its classes and properties before, and properties after."""

    def __init__(self, file, folder):
        self.version, self.document = file.stem, opened(file, folder)
        self.classes = {name: class_of(self.document.getObject(name)) for name in CLASSES}
        self.kept = all_properties(self.document)
        self.again = computed_again(self.document)


@pytest.fixture(scope="module", params=VERSIONS, ids=lambda file: file.stem)
def saved(request, tmp_path_factory):
    """Computed once; tests may change a document, and what was read of it stays."""
    folder = tmp_path_factory.mktemp("saved")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        yield Saved(request.param, folder)


def class_of(obj):
    kind = type(obj.Proxy)
    return f"{kind.__module__}.{kind.__qualname__}"


def plain(value):
    """A value of a property as texts and numbers."""
    if hasattr(value, "Commands"):
        return [[each.Name, dict(each.Parameters)] for each in value.Commands]
    if hasattr(value, "Matrix"):
        return list(value.Matrix.A)
    if isinstance(value, App.Vector):
        return list(value)
    if isinstance(value, list | tuple):
        return [plain(each) for each in value]
    return getattr(value, "Value", getattr(value, "Name", value))


def properties(obj):
    """By name, what the object holds; without words, and without what each CAM names or guesses in its own way."""
    held = [name for name in obj.PropertiesList if name not in WORDS | {"Proxy", "CycleTime", "ToolController"}]
    return {name: plain(getattr(obj, name)) for name in held}


def different(one, other, rounding=ROUNDING):
    """Where two plain values differ, as texts; numbers may differ by rounding."""
    if isinstance(one, dict) and isinstance(other, dict) and one.keys() == other.keys():
        return [f"{key}: {each}" for key in one for each in different(one[key], other[key], rounding)]
    if isinstance(one, list) and isinstance(other, list) and len(one) == len(other):
        pairs = enumerate(zip(one, other, strict=True))
        return [f"{index}: {each}" for index, pair in pairs for each in different(*pair, rounding)]
    if isinstance(one, float) and isinstance(other, float | int):
        return [] if np.isclose(one, other, rtol=0.0, atol=rounding) else [f"{one!r}, {other!r}"]
    return [] if one == other else [f"{one!r}, {other!r}"]


def test_a_difference_is_seen():
    path = [["G1", {"X": 1.0}], ["G0", {}]]
    assert different(path, [["G1", {"X": 1.0 + 2e-9}], ["G0", {}]]) == ["0: 1: X: 1.0, 1.000000002"]
    assert different(path, [["G1", {"X": 1.0 + 1e-10}], ["G0", {}]]) == []
    assert different(path, path[:1]) and different({"A": 1}, {"B": 1}) and different("Climb", "Both")


def test_the_first_version_is_kept():
    assert "pkm_post-0.1.0.FCStd" in [file.name for file in VERSIONS]


@pytest.mark.parametrize("file", VERSIONS, ids=lambda file: file.stem)
def test_it_is_small_and_names_no_folder_of_a_computer(file):
    assert file.stat().st_size < 100_000
    with zipfile.ZipFile(file) as packed:
        text = packed.read("Document.xml").decode("utf-8")
    named = re.findall(r'"(?:/\w|[A-Z]:[/\\])[^"]*"', text)
    assert [each for each in named if "Mod/CAM/Tools/Shape" not in each] == []  # CAM 1.0 names its own tool shapes


def test_it_opens_with_its_classes_and_recomputed_it_is_as_it_was(saved):
    assert saved.classes == CLASSES
    again = copy.deepcopy(saved.again)
    for name, before in copy.deepcopy(saved.kept).items():
        path, path_again = before.pop("Path", []), again[name].pop("Path", [])
        rows = {int(each.split(":")[0]) for each in different(path, path_again, SIXTH_DECIMAL)}
        assert rows == LIFTED.get((saved.version, name), set()), name
        assert all(path_again[row][1]["Z"] > path[row][1]["Z"] for row in rows), name
        if before.get("MaximumGouge", ROUNDING) < ROUNDING:  # the cutter touches, anywhere
            assert again[name]["MaximumGouge"] == 0
            del before["GougePoint"], again[name]["GougePoint"]
        # later versions may plan a motion with fewer points, and not with more; a reach has those of the lifted path
        points, points_again = before.pop("Points", 0), again[name].pop("Points", 0)
        assert points_again <= points if isinstance(points, int) else len(points_again) == len(points), name
        for added in ADDED.get((saved.version, name), ()):  # none until it is computed again
            assert before.pop(added) in ([], -1.0) and again[name].pop(added) not in ([], -1.0), added
        for changed, (least, most) in CHANGED.get((saved.version, name), {}).items():
            share = np.array(again[name].pop(changed)) / np.array(before.pop(changed))
            assert ((least <= share) & (share <= most)).all(), f"{changed}: {share}"
        assert different(before, again[name], COMPUTED.get(name, SIXTH_DECIMAL)) == [], name


def test_the_same_steps_give_the_same_today(saved):
    reach = saved.document.getObject("Reach")
    reach.ColourBy = "worst check"  # a new object begins with it, an old one keeps its choice
    saved.document.recompute()
    assert reach.isValid()
    made = all_properties(all_kinds(Path.cwd() / PROGRAM))
    for name, before in (saved.again | {"Reach": properties(reach)}).items():
        assert different(before, made[name]) == [], name


def test_every_kind_of_object_is_kept_with_results(tmp_path):
    document = opened(SAVED / "pkm_post-0.1.0.FCStd", tmp_path)
    held = {name: document.getObject(name) for name in CLASSES}
    assert held["PkmMirror001"].KeepClimb and held["PkmMirror001"].ReversedPasses == 1
    assert held["PkmRotation"].Base == held["PkmMirror001"] and held["PkmRotation"].Copies == 3
    assert list(held["PkmRotation001"].Angles) == [30.0, 60.0]
    assert held["SurfaceFinish"].PassCount == 5 and held["SurfaceFinish"].MaximumGouge >= 0.0
    assert held["SurfaceFinish"].ToolController == document.getObject("Job").Tools.Group[0]
    assert held["Reach"].Reachable and len(held["Reach"].LeastMargins) == len(held["Reach"].Checks) > 5
    assert held["Simulation"].Followable and held["Simulation"].Duration.Value > 1.0
    assert held["Machine"].Strut1.Value > 0.0
    for name in ("PkmMirror", "PkmRotation", "PkmRotation001", "DressupPkmNormals", "SurfaceFinish", "PkmProgram"):
        assert len(held[name].Path.Commands) >= 4, name
