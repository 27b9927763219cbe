# SPDX-License-Identifier: LGPL-2.1-or-later
"""The files for LinuxCNC: the configuration says the machine, and the gate lets a table begin where the struts are."""

import configparser
import re

import exported_machines as made
import numpy as np
import pytest

from pkm_post.machine import strut_lengths
from pkm_post.posting.machine_export import export_machine
from pkm_post.writing.kinematics import Export
from pkm_post.writing.kinematics.linuxcnc import DEPTH, START_TOLERANCE, stream_hal


@pytest.fixture(scope="module")
def exported(tmp_path_factory):
    """The machine, and the folder of its files."""
    folder = tmp_path_factory.mktemp("linuxcnc")
    machine = made.screwed()
    files, _ = export_machine(machine, "mine.toml", "linuxcnc", folder, Export(10, 120.0))
    endings = [".ini", "-kinematics.hal", "-simulated-drives.hal", "-stream.hal", ".tbl", "-sign-off.md"]
    assert [path.name for path in files] == [f"mine{ending}" for ending in endings]
    return machine, folder


def test_names_in_the_ini_are_those_of_the_files_and_have_no_blanks(tmp_path):
    # LinuxCNC 2.9, script linuxcnc, 4.3.6: what follows a blank in HALFILE are arguments
    files, _ = export_machine(made.screwed(), "my machine (2).toml", "linuxcnc", tmp_path, Export(10, 120.0))
    named = re.findall(r"(?m)^(?:HALFILE|TOOL_TABLE) = (.*)$", files[0].read_text(encoding="utf-8"))
    assert len(named) == 3 and {*named} <= {path.name for path in files}
    assert not any(" " in path.name for path in files)


def test_ini_has_the_limits_and_the_home_of_the_machine(exported):
    machine, folder = exported
    ini = configparser.ConfigParser(strict=False)
    ini.read(folder / "mine.ini")
    home = machine.home_tip[None], machine.home_axis[None], np.array([machine.home_spin]), np.array([120.0])
    lengths = strut_lengths(machine, *home)[0] + machine.length_offset
    for strut in range(6):
        joint = {key: float(value) for key, value in ini[f"JOINT_{strut}"].items() if key != "type"}
        assert joint["home"] == joint["home_offset"] == pytest.approx(lengths[strut], abs=1e-9)
        assert joint["min_limit"] == pytest.approx(750.0 + machine.length_offset[strut], abs=1e-9)
        assert joint["max_limit"] == pytest.approx(1250.0 + machine.length_offset[strut], abs=1e-9)
        assert (joint["max_velocity"], joint["max_acceleration"]) == (500.0, 5000.0)
    assert ini["KINS"]["kinematics"] == "genhexkins" and ini["TRAJ"]["home"] == "0 0 500 0 0 0"
    assert float(ini["AXIS_X"]["max_velocity"]) == 250.0 and float(ini["AXIS_A"]["max_velocity"]) == 60.0
    for file in (ini["EMCIO"]["tool_table"], ini["HAL"]["halfile"]):
        assert (folder / file).exists()


def test_pins_of_genhexkins_have_the_geometry(exported):
    machine, folder = exported
    text = (folder / "mine-kinematics.hal").read_text()
    pins = {name: float(value) for name, value in re.findall(r"^setp genhexkins\.(\S+) (\S+)$", text, re.M)}
    for pin, points in (
        ("base", machine.base_joints), ("platform", machine.platform_joints), ("base-n", machine.base_axes),
        ("platform-n", machine.platform_axes),
    ):  # fmt: skip
        found = [[pins[f"{pin}.{row}.{coordinate}"] for coordinate in "xyz"] for row in range(6)]
        np.testing.assert_allclose(found, points, rtol=0, atol=1e-9)
    assert pins["screw-lead"] == machine.screw_lead and pins["spindle-offset"] == 0.0
    assert "net tool-length motion.tooloffset.z => genhexkins.tool-offset" in text


def test_tool_table_counts_from_the_platform_joints(exported):
    _, folder = exported
    assert (folder / "mine.tbl").read_text().startswith("T1 P1 Z200 D0 ;")


def test_a_machine_without_a_screw_lead_needs_no_axes(tmp_path):
    export_machine(made.example(), "mine.toml", "linuxcnc", tmp_path, Export(10, 120.0))
    text = (tmp_path / "mine-kinematics.hal").read_text()
    assert "base-n" not in text and "setp genhexkins.screw-lead 0\n" in text


class Hal:
    """HAL as far as the gate needs it: one thread, components as their manual pages describe them."""

    def __init__(self, text, rows):
        self.rows, self.depth = [list(row) for row in rows], len(rows)
        self.pins, self.signals, self.kinds, self.order = {}, {}, {}, []
        for line in text.splitlines():
            word, *rest = line.split()
            if word == "loadrt":
                self.load(rest)
            elif word == "setp":
                self.pins[rest[0]] = float(rest[1])
            elif word == "addf":
                self.order.append(rest[0])
            elif word == "net":
                self.signals.setdefault(rest[0], set()).update(pin for pin in rest[1:] if pin != "=>")
            else:
                assert word.startswith("#"), line
        self.of_pin = {pin: name for name, pins in self.signals.items() for pin in pins}
        self.values = dict.fromkeys(self.signals, 0.0)
        assert sorted(self.order) == sorted([*self.kinds, "streamer.0"])

    def load(self, words):
        options = dict(word.split("=") for word in words[1:])
        names = options.get("names", "").split(",")
        if words[0] != "streamer":
            self.kinds |= dict.fromkeys(names, words[0])
        if words[0] == "logic":
            for name, kind in zip(names, options["personality"].split(","), strict=True):
                self.pins[f"{name}.count"] = int(kind, 16) & 0xFF

    def get(self, pin):
        return self.values[self.of_pin[pin]] if pin in self.of_pin else self.pins.get(pin, 0.0)

    def put(self, pin, value):
        if pin in self.of_pin:
            self.values[self.of_pin[pin]] = float(value)

    def period(self):
        for name in self.order:
            getattr(self, self.kinds.get(name, "streamer"))(name)
        return [self.values[f"strut-{strut}-cmd"] for strut in range(6)]

    def streamer(self, name):
        self.put("streamer.0.empty", not self.rows)
        if self.get("streamer.0.enable") and self.rows:
            for strut, value in enumerate(self.rows.pop(0)):
                self.put(f"streamer.0.pin.{strut}", value)

    def near(self, name):
        apart = abs(self.get(f"{name}.in1") - self.get(f"{name}.in2"))
        self.put(f"{name}.out", apart <= self.pins[f"{name}.difference"])

    def mux2(self, name):
        self.put(f"{name}.out", self.get(f"{name}.in1" if self.get(f"{name}.sel") else f"{name}.in0"))

    def and2(self, name):
        self.put(f"{name}.out", self.get(f"{name}.in0") and self.get(f"{name}.in1"))

    def logic(self, name):
        self.put(f"{name}.and", all(self.get(f"{name}.in-{row:02}") for row in range(self.pins[f"{name}.count"])))

    def flipflop(self, name):
        if self.get(f"{name}.set"):
            self.put(f"{name}.out", 1)
        if self.get(f"{name}.reset"):
            self.put(f"{name}.out", 0)


setattr(Hal, "not", lambda self, name: self.put(f"{name}.out", not self.get(f"{name}.in")))

START = np.array([900.0, 910.0, 920.0, 930.0, 940.0, 950.0])
ROWS = START + np.linspace(0, 5, 40)[:, None] * [1, -1, 1, -1, 1, -1]


def streamed(feedback, rows=ROWS, periods=60):
    """The gate with the drives switched on at ``feedback``, and what it commands after stream-start."""
    hal = Hal(stream_hal(), rows)
    for strut, value in enumerate(feedback):
        hal.values[f"strut-{strut}-fb"] = value
    hal.period()
    hal.values["drives-on"] = 1.0
    np.testing.assert_array_equal(hal.period(), feedback)
    for strut in range(6):
        hal.values[f"strut-{strut}-fb"] = 0.0  # what the drives say no longer moves them
    np.testing.assert_array_equal(hal.period(), feedback)
    hal.values["stream-start"] = 1.0
    return hal, np.array([hal.period() for _ in range(periods)])


@pytest.mark.parametrize("beside", [0.0, 0.9 * START_TOLERANCE, -0.9 * START_TOLERANCE])
def test_a_table_that_begins_where_the_struts_are_is_followed_row_by_row(beside):
    hal, commands = streamed(START + beside)
    assert hal.values["stream-accepted"] and not hal.values["stream-refused"]
    first = int(np.argmax((commands == ROWS[1]).all(axis=1))) - 1
    np.testing.assert_array_equal(commands[first : first + len(ROWS)], ROWS)
    np.testing.assert_array_equal(commands[:first], np.tile(START + beside, (first, 1)))
    np.testing.assert_array_equal(commands[-1], ROWS[-1])


@pytest.mark.parametrize("strut", range(6))
@pytest.mark.parametrize("beside", [1.1 * START_TOLERANCE, -1.1 * START_TOLERANCE, 100.0])
def test_a_table_that_begins_elsewhere_moves_no_strut(strut, beside):
    feedback = START + beside * np.eye(6)[strut]
    hal, commands = streamed(feedback)
    assert hal.values["stream-refused"] and not hal.values["stream-accepted"]
    np.testing.assert_array_equal(commands, np.tile(feedback, (len(commands), 1)))
    assert len(hal.rows) >= len(ROWS) - 2, "rows were taken after the first one was refused"


def test_struts_stand_where_they_are_when_the_start_is_taken_back():
    hal, commands = streamed(START, periods=20)
    hal.values["stream-start"] = 0.0
    after = np.array([hal.period() for _ in range(5)])
    np.testing.assert_array_equal(after[1:], np.tile(after[0], (4, 1)))
    assert np.abs(after[0] - commands[-1]).max() <= 2 * np.abs(np.diff(ROWS, axis=0)).max()


def test_an_empty_streamer_moves_no_strut():
    hal, commands = streamed(START, rows=[])
    np.testing.assert_array_equal(commands, np.tile(START, (len(commands), 1)))
    assert not hal.values["stream-accepted"] and not hal.values["stream-refused"] and DEPTH > 0
