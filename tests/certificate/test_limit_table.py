# SPDX-License-Identifier: LGPL-2.1-or-later
"""Every entry of a machine file is certified, checked elsewhere, or no limit: a new one has to be put somewhere."""

import dataclasses

import numpy as np
from posted_jobs import NARROW, of, preset
from programs import random_job

from pkm_post.certificate.limit_table import CERTIFIED, CHECKED_ELSEWHERE
from pkm_post.machine.description.fields import FIELDS

NO_LIMITS = {
    "name", "description", "units.length", "units.angle", "units.time", "base.joints", "platform.joints",
    "platform.spindle_nose", "struts.length_offset", "struts.screw_lead", "struts.tube_radius", "struts.tube_length",
    "struts.rod_radius", "struts.rod_length", "struts.stiffness", "struts.rigidity", "joints.base_kind",
    "joints.platform_kind", "joints.rest_pose", "joints.rest_tool_length", "joints.base_rest", "joints.platform_rest",
    "joints.base_axes", "joints.platform_axes", "interference.base_joint_radius",
    "interference.platform_joint_radius", "interference.bodies", "interference.fixtures",
    "singularity.characteristic_length", "tool_path.home_tip", "tool_path.home_axis", "tool_path.home_spin",
    "struts.velocity_gain", "tool_change.nose", "tool_change.axis", "tool_change.spin",
    "work_offsets.*.origin", "work_offsets.*.rotation_z", "work_offsets.*.matrix", "controller.kind",
    "controller.letters", "controller.coordinate_system", "controller.program", "controller.length_decimals",
    "controller.speed_decimals", "controller.counts_per_mm", "controller.zero_length", "controller.codes.tool_change",
    "controller.codes.spindle_clockwise", "controller.codes.spindle_counterclockwise",
    "controller.codes.spindle_stop", "controller.codes.coolant_flood", "controller.codes.coolant_mist",
    "controller.codes.coolant_off", "controller.codes.stop", "controller.codes.optional_stop",
}  # fmt: skip
"""Entries that say what the machine is, where things are and what its controller is told."""


def all_stated():
    """The example machine with every limit that a file can state."""
    return dataclasses.replace(preset("example_6tps"), strut_jerk=1e6, tip_jerk=1e6)


def test_every_entry_stands_in_one_place():
    placed = [*CERTIFIED, *CHECKED_ELSEWHERE, *NO_LIMITS]
    assert sorted(placed) == sorted(field.entry for field in FIELDS)


def test_certified_limits_are_findings_of_a_certificate():
    *_, certificate, faults = of(all_stated(), random_job(np.random.default_rng(3)), NARROW)
    assert faults == ()
    names = {row.name for row in certificate.findings}
    assert {name for rows in CERTIFIED.values() for name in rows} <= names


def test_rows_without_an_entry_are_about_the_job():
    *_, certificate, _ = of(all_stated(), random_job(np.random.default_rng(3)), NARROW)
    of_machine = {name for rows in CERTIFIED.values() for name in rows}
    assert {row.code for row in certificate.findings if row.name not in of_machine} == {
        "V101", "V102", "V107", "V110", "V111",
    }  # fmt: skip
