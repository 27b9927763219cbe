# SPDX-License-Identifier: LGPL-2.1-or-later
"""Programs that were posted before are verified again; programs that were changed since are found out."""

import dataclasses
import re

import numpy as np
import pytest
from programs import ON_PALLET, cone
from series import cases
from verified_reports import agree

from pkm_post.certificate import certify, reconstruct
from pkm_post.cli import main
from pkm_post.machine import machine_named
from pkm_post.model import Refused
from pkm_post.model.certificate import Tolerances
from pkm_post.model.diagnostics import errors
from pkm_post.options.choices import Options
from pkm_post.posting.steps import post
from pkm_post.posting.verify import verify
from pkm_post.writing import trajectory_file
from pkm_post.writing.controllers import pmac

TOLERANCES = Tolerances(0.001, np.radians(0.001))
MUTANTS = cases(50)
LAST_DIGIT = 1e-6
"""mm, of a length in the program: the planned length was rounded to it."""
KNOT = re.compile(r"(?P<letter>[A-Z])(?P<length>-?\d+\.\d+):(?P<speed>-?\d+\.\d+)")


@pytest.fixture(scope="module")
def machine():
    return machine_named("example_6tps")[0]


@pytest.fixture(scope="module")
def posted(machine, tmp_path_factory):
    folder = tmp_path_factory.mktemp("posted")
    return post(cone(12, turns=0.1), machine, folder / "cone.pmc", Options(ON_PALLET, 0.001, TOLERANCES.axis))


@pytest.fixture(scope="module")
def judge(machine, posted):
    """Whether the text of a program is accepted by what it does alone, whatever SHA-256 its heading states."""
    trajectory, _ = trajectory_file.read(posted.program.with_suffix(".pkmt"))
    settings, _ = pmac.settings_of(machine)

    def accepted(text):
        struts, faults = pmac.read_program(text, settings, "cone.pmc")
        if struts is None or errors(faults):
            return False
        found, _ = reconstruct(struts, "cone.pmc", trajectory, machine, TOLERANCES)
        if found is None:
            return False
        measured = certify(
            struts, "cone.pmc", trajectory, machine, found.motion, TOLERANCES, spin_deviation=found.spin_deviation
        )
        return not errors(measured[1])

    return accepted


def test_a_posted_program_is_verified(machine, posted):
    _, report, warnings = verify(posted.program, posted.program.with_suffix(".pkmt"), machine)
    assert not warnings
    agree(report, posted.report)


def knots(text):
    """Lines of the program with a point, their numbers, and the milliseconds that lead to each."""
    return [(match.start(), match) for match in re.finditer(r"^.*:.*$", text, re.MULTILINE) if KNOT.search(match[0])]


def changed_digits(text, seed=7):
    """Texts in which one digit of one length or speed is another, and by more than the tolerance can hide."""
    random, lines = np.random.default_rng(seed), knots(text)
    # A speed that is wrong by dv moves the cubics beside it by up to 4/27 dv h; the intervals here are 2 ms and more.
    least = {"length": 0.001 + LAST_DIGIT, "speed": 0.001 / (0.002 * 4 / 27)}
    while True:
        begin, line = lines[random.integers(1, len(lines) - 1)]
        number = list(KNOT.finditer(line[0]))[random.integers(6)]
        kind = ("length", "speed")[random.integers(2)]
        digits = [place for place in range(*number.span(kind)) if line[0][place].isdigit()]
        place = digits[random.integers(len(digits))]
        made = line[0][:place] + str(random.integers(10)) + line[0][place + 1 :]
        before, after = (float(KNOT.match(one, number.start())[kind]) for one in (line[0], made))
        if abs(after - before) > least[kind]:
            yield text[:begin] + made + text[begin + len(line[0]) :]


@pytest.mark.slow
def test_every_changed_digit_is_found(posted, judge):
    text = posted.program.read_text()
    assert judge(text)
    changed = changed_digits(text)
    passed = [number for number in range(MUTANTS) if judge(next(changed))]
    assert not passed


@pytest.mark.slow
def test_a_dropped_or_doubled_line_is_found(posted, judge):
    text = posted.program.read_text()
    for begin, line in knots(text)[1:-1:3]:
        end = begin + len(line[0]) + 1
        assert not judge(text[:begin] + text[end:])
        assert not judge(text[:end] + text[begin:])


def test_speeds_in_another_unit_are_found(posted, judge):
    def per_minute(match):
        return f"{match['letter']}{match['length']}:{60 * float(match['speed']):.4f}"

    assert not judge(KNOT.sub(per_minute, posted.program.read_text()))


def test_swapped_struts_are_found(posted, judge):
    swapped = posted.program.read_text().translate(str.maketrans("AB", "BA"))
    assert not judge(swapped)


@pytest.mark.parametrize("change", [{"spindle_nose": 81.0}, {"fingerprint": "1" * 64}])
def test_another_machine_is_found(machine, posted, change):
    other = dataclasses.replace(machine, **change)
    with pytest.raises(Refused):
        verify(posted.program, posted.program.with_suffix(".pkmt"), other)


@pytest.mark.parametrize(
    ("program", "trajectory", "code"),
    [("cone.pmc", "cone-setup.pmc", "T101"), ("cone.pkmt", "cone.pkmt", "C108"), ("no.pmc", "cone.pkmt", "F103")],
)
def test_files_that_are_something_else_are_reported(machine, posted, program, trajectory, code):
    folder = posted.program.parent
    with pytest.raises(Refused) as refused:
        verify(folder / program, folder / trajectory, machine)
    assert code in [fault.code for fault in refused.value.diagnostics]


def test_line_ends_of_windows_are_verified(machine, posted, copied):
    program = copied / "cone.pmc"
    program.write_bytes(program.read_bytes().replace(b"\n", b"\r\n"))
    _, report, warnings = verify(program, copied / "cone.pkmt", machine)
    assert not warnings
    agree(report, posted.report)


def test_a_control_character_is_named(machine, posted, tmp_path):
    program = tmp_path / "cone.pmc"
    program.write_bytes(posted.program.read_bytes().replace(b"PKM", b"P\x0bKM", 1))
    with pytest.raises(Refused) as refused:
        verify(program, posted.program.with_suffix(".pkmt"), machine)
    assert [(one.code, one.place.line, one.place.column) for one in errors(refused.value.diagnostics)] == [
        ("C108", 1, 4)
    ]
    assert "0x0B, vertical tab" in str(refused.value)


def test_a_trajectory_without_tolerances_is_refused(machine, posted, tmp_path):
    trajectory, _ = trajectory_file.read(posted.program.with_suffix(".pkmt"))
    trajectory_file.write(dataclasses.replace(trajectory, tolerances=None), tmp_path / "bare.pkmt")
    with pytest.raises(Refused) as refused:
        verify(posted.program, tmp_path / "bare.pkmt", machine)
    assert [fault.code for fault in errors(refused.value.diagnostics)] == ["F106", "T105"]


def test_the_command(posted, capsys, tmp_path):
    arguments = [str(posted.program), "--against", str(posted.program.with_suffix(".pkmt"))]
    assert main(["verify", *arguments]) == 0
    assert "the certificate holds" in capsys.readouterr().out
    wrong = tmp_path / "wrong.pmc"
    wrong.write_text(next(changed_digits(posted.program.read_text())))
    assert main(["verify", str(wrong), *arguments[1:]]) == 1
    assert "error V1" in capsys.readouterr().err


def test_a_program_that_begins_at_a_line_may_have_another_tool_in_the_spindle(tmp_path, capsys):
    """Law: what is posted is verified. The platform starts at home; the tip of a shorter tool is higher there."""
    (tmp_path / "two.ngc").write_text("T1 M6\nG0 X0 Y0 Z20\nG1 X5 F900\nT2 M6\nG0 X0 Y0 Z20\nG1 X5 F900\nM2\n", "ascii")
    lengths = ["--tool-length", "1=120", "--tool-length", "2=95.5"]
    assert main(["post", str(tmp_path / "two.ngc"), "--from-line", "6", *lengths, "--out", str(tmp_path)]) == 0
    assert main(["verify", str(tmp_path / "two.pmc"), "--against", str(tmp_path / "two.pkmt")]) == 0
    assert "the certificate holds" in capsys.readouterr().out


@pytest.fixture
def copied(posted, tmp_path):
    """The files of the posting, to be changed."""
    for file in posted.files:
        (tmp_path / file.name).write_bytes(file.read_bytes())
    return tmp_path


def refused_command(folder, capsys):
    """What the command writes to the standard error when it ends with 1."""
    assert main(["verify", str(folder / "cone.pmc"), "--against", str(folder / "cone.pkmt")]) == 1
    printed = capsys.readouterr()
    assert "holds" not in printed.out
    return printed.err


def test_files_of_two_postings_are_refused_by_name(copied, capsys):
    (copied / "cone-report.json").write_text("{}")
    assert "error F106" in (reported := refused_command(copied, capsys)) and "cone-report.json has changed" in reported


@pytest.mark.parametrize("manifests", [True, False], ids=["listed", "unlisted"])
def test_the_trajectory_of_another_posting_is_refused_though_the_program_follows_it(
    machine, posted, tmp_path, manifests
):
    """The same path with wide tolerances and a feed twice as high: nothing that is measured is above its limit."""
    faster = dataclasses.replace(cone(12, turns=0.1), feed=2 * cone(12, turns=0.1).feed)
    wide = Options(ON_PALLET, 0.2, np.radians(2.0))
    other = post(faster, machine, tmp_path / "cone.pmc", wide).program.with_suffix(".pkmt")
    if not manifests:
        (tmp_path / "cone-manifest.json").unlink()
    with pytest.raises(Refused) as refused:
        verify(posted.program, other, machine)
    assert [(one.code, one.place.file) for one in errors(refused.value.diagnostics)] == [("F106", "cone.pmc")]


def test_what_is_measured_is_reported_beside_what_has_changed(posted, copied, capsys):
    (copied / "cone.pmc").write_text(next(changed_digits(posted.program.read_text())))
    reported = refused_command(copied, capsys)
    assert "cone.pmc has changed" in reported and "error V1" in reported


def test_results_of_earlier_versions_have_no_manifest_and_are_measured(copied, capsys):
    (copied / "cone-manifest.json").unlink()
    assert main(["verify", str(copied / "cone.pmc"), "--against", str(copied / "cone.pkmt"), "--json"]) == 0
    reported = capsys.readouterr().err
    assert reported.count("warning F107") == 2


def test_a_missing_trajectory_is_one_fault_and_no_manifest_is_missed_for_it(copied, capsys):
    (copied / "cone-manifest.json").unlink()
    assert main(["verify", str(copied / "cone.pmc"), "--against", str(copied / "gone.pkmt")]) == 1
    reported = capsys.readouterr().err
    assert "gone.pkmt: error T101" in reported and "gone.pkmt: warning" not in reported
