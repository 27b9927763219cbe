# SPDX-License-Identifier: LGPL-2.1-or-later
import dataclasses

import pytest

from pkm_post.machine import machine_named
from pkm_post.machine.description.fields import FIELDS
from pkm_post.machine.description.value_types import WrongValueError
from pkm_post.posting import SUFFIX
from pkm_post.writing.controllers import CONTROLLERS, TABLES, controller_of, part_names, part_siblings, pmac


@pytest.fixture(scope="module")
def machine():
    return machine_named("example_6tps")[0]


def test_the_machine_file_knows_the_same_kinds():
    (form,) = (field.form for field in FIELDS if field.entry == "controller.kind")
    assert form.words == f"one of {', '.join(CONTROLLERS)}"
    assert [form.read(kind, 1.0) for kind in CONTROLLERS] == list(CONTROLLERS)
    with pytest.raises(WrongValueError):
        form.read("siemens", 1.0)


@pytest.mark.parametrize("kind", CONTROLLERS)
def test_a_machine_has_the_controller_of_its_kind(machine, kind):
    other = dataclasses.replace(machine, controller=machine.controller | {"kind": kind})
    controller, faults = controller_of(other)
    assert faults == ()
    assert controller is CONTROLLERS[kind]
    settings, faults = controller.settings_of(other)
    assert faults == ()
    assert kind == settings.KIND


@pytest.mark.parametrize("kind", [None, "siemens"])
def test_a_machine_of_no_known_kind_is_reported(machine, kind):
    other = dataclasses.replace(machine, controller=machine.controller | {"kind": kind})
    controller, faults = controller_of(other)
    assert controller is None
    assert [fault.code for fault in faults] == ["M104"]


def test_names_of_parts():
    assert part_names("job.pmc", 1) == ["job.pmc"]
    assert part_names("a.b.pmc", 3) == ["a.b.pmc", "a.b-part2.pmc", "a.b-part3.pmc"]


def test_the_other_parts_of_a_program_are_those_it_states():
    assert part_siblings(pmac, "job.pmc", "; job\nCLOSE\n") == []
    assert part_siblings(pmac, "job.pmc", "; job\n; part 1 of 3: the first\n") == ["job-part2.pmc", "job-part3.pmc"]
    assert part_siblings(pmac, "job-part2.pmc", "; part 2 of 3: x\n") == []


def test_no_two_files_of_a_job_have_one_name():
    for controller in CONTROLLERS.values():
        suffixes = [SUFFIX, controller.SETUP_SUFFIX, *(table.SUFFIX for table in TABLES.values())]
        assert len(set(suffixes)) == len(suffixes)
