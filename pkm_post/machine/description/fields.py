# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fields: every entry that a machine file may have, in the order of the documentation.

Each row has the name of an entry, its form, its dimension (the unit in the file), its default and its attribute in
``model.Machine``. The reader and docs/machine-file.md follow this table; a new entry is a new row. ``*`` stands for a
user-defined name.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from pkm_post.machine.description import units
from pkm_post.machine.description import value_types as forms
from pkm_post.machine.description import value_types as solids
from pkm_post.machine.description.units import Dimension
from pkm_post.machine.description.value_types import ValueType

Name = tuple[str, ...]
REQUIRED: Any = object()
ANY = "*"


class Field(NamedTuple):
    """One entry.

    Attributes:
        entry: its sections and its key, joined by dots.
        dimension: unit of its value.
        default: value if the file has none: None for no value, ``REQUIRED`` for a mandatory entry.
        attribute: the ``Machine`` attribute it is stored in unchanged, empty when it is processed first.
    """

    entry: str
    form: ValueType
    dimension: Dimension = units.PLAIN
    default: Any = REQUIRED
    attribute: str = ""

    @property
    def name(self) -> Name:
        """Sections and key as a tuple."""
        return tuple(self.entry.split("."))

    def entries(self, chosen: list[str]) -> list[str]:
        """Entries of this row for the user-defined names."""
        return [self.entry.replace(ANY, name) for name in chosen] if ANY in self.entry else [self.entry]


MOST_DECIMALS = 9
MOST_WORDS = 2**24
MOST_MOTORS = 32
"""Number of motors of a Turbo PMAC."""
LONGEST_SHORTEST = 50
"""ms: longer ones would leave intervals that cannot be split evenly."""
OPTIONAL_STOPS = ("written", "stop", "leave-out")
"""As in ``toolpath.OPTIONAL_STOPS``."""
JOINT_KIND = forms.choice("universal", "spherical")

FIELDS: tuple[Field, ...] = (
    Field("name", forms.NAME, attribute="name"),
    Field("description", forms.PROSE, default=""),
    *(Field(f"units.{quantity}", forms.choice(*sizes)) for quantity, sizes in units.UNITS.items()),
    Field("base.joints", forms.SIX_POINTS, units.LENGTH, attribute="base_joints"),
    Field("platform.joints", forms.SIX_POINTS, units.LENGTH, attribute="platform_joints"),
    Field("platform.spindle_nose", forms.NUMBER, units.LENGTH, attribute="spindle_nose"),
    Field("struts.stroke", forms.STROKE, units.LENGTH, attribute="strut_stroke"),
    Field("struts.speed", forms.POSITIVE, units.SPEED, attribute="strut_speed"),
    Field("struts.acceleration", forms.POSITIVE, units.ACCELERATION, attribute="strut_acceleration"),
    Field("struts.jerk", forms.POSITIVE, units.JERK, default=None, attribute="strut_jerk"),
    Field("struts.velocity_gain", forms.SIX_POSITIVE, units.RATE, default=None, attribute="velocity_gain"),
    Field("struts.length_offset", forms.SIX_NUMBERS, units.LENGTH, default=None, attribute="length_offset"),
    Field("struts.screw_lead", forms.NUMBER, units.LENGTH, default=0.0, attribute="screw_lead"),
    Field("struts.tube_radius", forms.POSITIVE, units.LENGTH, default=None, attribute="tube_radius"),
    Field("struts.tube_length", forms.POSITIVE, units.LENGTH, default=None, attribute="tube_length"),
    Field("struts.rod_radius", forms.POSITIVE, units.LENGTH, default=None, attribute="rod_radius"),
    Field("struts.rod_length", forms.POSITIVE, units.LENGTH, default=None, attribute="rod_length"),
    Field("struts.stiffness", forms.POSITIVE, units.STIFFNESS, default=None, attribute="strut_stiffness"),
    Field("struts.rigidity", forms.POSITIVE, units.FORCE, default=None, attribute="strut_rigidity"),
    Field("joints.base_kind", JOINT_KIND, default="universal", attribute="base_joint_kind"),
    Field("joints.platform_kind", JOINT_KIND, default="spherical", attribute="platform_joint_kind"),
    Field("joints.base_cone", forms.HALF_ANGLES, units.ANGLE, attribute="base_cone"),
    Field("joints.platform_cone", forms.HALF_ANGLES, units.ANGLE, attribute="platform_cone"),
    Field("joints.rest_pose", forms.POINT, units.LENGTH),
    Field("joints.rest_tool_length", forms.NOT_NEGATIVE, units.LENGTH, attribute="rest_tool_length"),
    Field("joints.base_rest", forms.SIX_DIRECTIONS, default=None),
    Field("joints.platform_rest", forms.SIX_DIRECTIONS, default=None),
    Field("joints.base_axes", forms.SIX_DIRECTIONS, default=None, attribute="base_axes"),
    Field("joints.platform_axes", forms.SIX_DIRECTIONS, default=None, attribute="platform_axes"),
    Field("interference.clearance", forms.NOT_NEGATIVE, units.LENGTH, default=0.0, attribute="clearance"),
    Field("interference.base_joint_radius", forms.NOT_NEGATIVE, units.LENGTH, 0.0, "base_joint_radius"),
    Field("interference.platform_joint_radius", forms.NOT_NEGATIVE, units.LENGTH, 0.0, "platform_joint_radius"),
    Field("interference.bodies", solids.BODIES, units.LENGTH, default=None, attribute="bodies"),
    Field("interference.fixtures", solids.FIXTURES, units.LENGTH, default=None, attribute="fixtures"),
    Field("singularity.characteristic_length", forms.POSITIVE, units.LENGTH, attribute="characteristic_length"),
    Field("singularity.least_singular_value", forms.POSITIVE, units.SINGULAR_VALUE, attribute="least_singular_value"),
    Field("tool_path.home_tip", forms.POINT, units.LENGTH, attribute="home_tip"),
    Field("tool_path.home_axis", forms.UPWARDS, default=[0.0, 0.0, 1.0], attribute="home_axis"),
    Field("tool_path.home_spin", forms.NUMBER, units.ANGLE, default=0.0, attribute="home_spin"),
    Field("tool_path.rapid_speed", forms.POSITIVE, units.SPEED, attribute="rapid_speed"),
    Field("tool_path.feed_speed", forms.POSITIVE, units.SPEED, attribute="feed_speed"),
    Field("tool_path.tip_acceleration", forms.POSITIVE, units.ACCELERATION, attribute="tip_acceleration"),
    Field("tool_path.tip_jerk", forms.POSITIVE, units.JERK, default=None, attribute="tip_jerk"),
    Field("tool_path.axis_speed", forms.POSITIVE, units.TURNING_RATE, attribute="axis_speed"),
    Field("spindle.speed", forms.POSITIVE, units.SPINDLE_SPEED, attribute="spindle_speed"),
    Field("spindle.least_speed", forms.NOT_NEGATIVE, units.SPINDLE_SPEED, default=0.0, attribute="spindle_least_speed"),
    Field("spindle.spin_up_time", forms.POSITIVE, units.TIME, default=None, attribute="spin_up_time"),
    Field("spindle.spin_down_time", forms.POSITIVE, units.TIME, default=None, attribute="spin_down_time"),
    Field("spindle.largest_tool_diameter", forms.POSITIVE, units.LENGTH, None, "largest_tool_diameter"),
    Field("spindle.longest_tool", forms.POSITIVE, units.LENGTH, default=None, attribute="longest_tool"),
    Field("spindle.axis.motor", forms.whole_number(7, MOST_MOTORS), default=None),
    Field("spindle.axis.letter", forms.choice(*forms.AXIS_LETTERS), default=None),
    Field("spindle.axis.counts_per_turn", forms.POSITIVE, units.COUNTS_OF_A_TURN, default=None),
    Field("spindle.axis.speed", forms.POSITIVE, units.SPINDLE_SPEED, default=None),
    Field("spindle.axis.acceleration", forms.POSITIVE, units.SPINDLE_ACCELERATION, default=None),
    Field("spindle.axis.lead_tolerance", forms.POSITIVE, units.LENGTH, default=None),
    Field("tool_change.nose", forms.POINT, units.LENGTH, default=None),
    Field("tool_change.axis", forms.UPWARDS, default=[0.0, 0.0, 1.0]),
    Field("tool_change.spin", forms.NUMBER, units.ANGLE, default=0.0),
    Field("tool_change.safe_height", forms.NUMBER, units.LENGTH, default=None),
    Field("work_offsets.*.origin", forms.POINT, units.LENGTH, default=None),
    Field("work_offsets.*.rotation_z", forms.NUMBER, units.ANGLE, default=0.0),
    Field("work_offsets.*.matrix", forms.POSE, units.LENGTH, default=None),
    Field("part_programs.machine_zero", forms.POINT, units.LENGTH, default=None, attribute="machine_zero"),
    Field("part_programs.leave_out", forms.LEFT_OUT, default=(), attribute="left_out"),
    Field("part_programs.tool_table", forms.NAME, default=None, attribute="tool_table"),
    Field("part_programs.optional_stops", forms.choice(*OPTIONAL_STOPS), default="written", attribute="optional_stops"),
    Field("controller.kind", forms.choice("turbo_pmac", "power_pmac")),
    Field("controller.letters", forms.LETTERS),
    Field("controller.coordinate_system", forms.whole_number(1, 16), default=1),
    Field("controller.program", forms.whole_number(1, 999), default=10),
    Field("controller.length_decimals", forms.whole_number(1, MOST_DECIMALS), default=6),
    Field("controller.speed_decimals", forms.whole_number(1, MOST_DECIMALS), default=4),
    Field("controller.counts_per_mm", forms.POSITIVE, units.COUNT_DENSITY),
    Field("controller.zero_length", forms.SIX_NUMBERS, units.LENGTH),
    Field("controller.approach_speed", forms.POSITIVE, units.SPEED),
    Field(
        "controller.shortest_interval",
        forms.whole_number(1, LONGEST_SHORTEST),
        units.MILLISECONDS,
        default=1,
        attribute="shortest_interval",
    ),
    Field("controller.block_rate", forms.POSITIVE, units.BLOCK_RATE, default=None, attribute="block_rate"),
    Field("controller.memory_words", forms.whole_number(1, MOST_WORDS), default=237568),
    Field("controller.line_limit", forms.whole_number(40, 65536), default=159),
    Field("controller.codes.tool_change", forms.CODE),
    Field("controller.codes.spindle_clockwise", forms.CODE),
    Field("controller.codes.spindle_counterclockwise", forms.CODE),
    Field("controller.codes.spindle_stop", forms.CODE),
    Field("controller.codes.coolant_flood", forms.CODE),
    Field("controller.codes.coolant_mist", forms.CODE),
    Field("controller.codes.coolant_off", forms.CODE),
    Field("controller.codes.stop", forms.CODE),
    Field("controller.codes.optional_stop", forms.CODE),
    Field("controller.codes.spindle_axis", forms.CODE, default=None),
    Field("controller.codes.spindle_speed", forms.CODE, default=None),
    Field("controller.codes.functions", forms.FUNCTIONS, default={}),
)


def section_tree() -> dict[str, Any]:
    """The table as nested sections: a dict is a section, a ``Field`` an entry."""
    tree: dict[str, Any] = {}
    for field in FIELDS:
        *sections, key = field.name
        section = tree
        for part in sections:
            section = section.setdefault(part, {})
        section[key] = field
    return tree
