# SPDX-License-Identifier: LGPL-2.1-or-later
"""Kinematics in the controller: programs and set-up with which a controller converts tip and axis to struts itself.

``formulas`` and ``programs`` state the kinematics once, ``dialects`` writes them in the words of a PMAC, and
``controller_file`` adds axis definitions, limits and look-ahead. ``sign_off`` is the check sheet for commissioning.
"""

from pkm_post.writing.kinematics.controller_file import MOST_STEPS, TOLERANCE, Export
from pkm_post.writing.kinematics.sign_off import CheckPoses
from pkm_post.writing.kinematics.targets import PROJECT, TARGETS
