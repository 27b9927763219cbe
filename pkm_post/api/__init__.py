# SPDX-License-Identifier: LGPL-2.1-or-later
"""The public API, for macros and scripts: each stage of posting as one function on the types of ``pkm_post.model``.

``import pkm_post as pkm`` gives all names of this module. Lengths are in mm, angles in rad, speeds in mm/s; options as
text are in the units of the command line. An error in the input raises ``Refused`` with all diagnostics, and a warning
is issued as ``DiagnosticWarning``, those of ``post`` are ``diagnostics`` of its results; an argument of another type
raises TypeError. docs/api.md shows every function with an example.
"""

from pkm_post.api.functions import certify, compensate, place, plan, post, reach, write
from pkm_post.api.in_freecad import add_machine, job, jobs, mirror, rotate, set_gauge_length, surface_points, symmetry
from pkm_post.api.inputs import DiagnosticWarning, find_machine, read, read_machine, read_options
from pkm_post.machine import ReachReport
from pkm_post.model import Certificate, EventKind, Machine, Program, Refused, Tool, Trajectory
from pkm_post.options import Options
from pkm_post.planning import Plan
from pkm_post.posting import Posted
from pkm_post.reading import ReadingOptions
from pkm_post.toolpath import Cutter, tip_from_contact
from pkm_post.writing import GcodeDialect
