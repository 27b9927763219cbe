# SPDX-License-Identifier: LGPL-2.1-or-later
"""No result takes the place of another one or of a source; the names are those that posting writes."""

from pathlib import Path

import pytest

from pkm_post.cli import main, post
from pkm_post.cli.result_names import _ALSO, _ALWAYS, _IN_PARTS, lost_results, result_names
from pkm_post.controllers import TABLES, pmac, power_pmac
from pkm_post.options import ALSO
from pkm_post.pipeline import SUFFIX

PART = "G21 G90 G17\nT1 M6\nS5000 M3\nG0 X0 Y0 Z300\nG1 X10 F600\nM5\nM30\n"
OUT = Path("out")


@pytest.fixture
def part(tmp_path):
    file = tmp_path / "part.ngc"
    file.write_text(PART, encoding="ascii")
    return file


def test_everything_that_is_written_is_named(part, tmp_path):
    out = tmp_path / "out"
    assert main(["post", str(part), "--out", str(out), "--tool-length", "1=120", "--also", ",".join(ALSO)]) == 0
    written = {path.name for path in out.iterdir()}
    assert set(result_names(part, ALSO)) - written == {"part" + power_pmac.SETUP_SUFFIX}
    assert written <= set(result_names(part, ALSO))


def test_endings_are_those_of_controllers_and_tables():
    assert set(_ALSO) == set(ALSO)
    assert {pmac.SETUP_SUFFIX, power_pmac.SETUP_SUFFIX, SUFFIX} < set(_ALWAYS)
    assert {name: table.SUFFIX for name, table in TABLES.items()}.items() <= _ALSO.items()
    assert set(_IN_PARTS) <= {SUFFIX, *_ALSO.values()}


LOST = {
    "set-up": (["job.ngc", "job-setup.ngc"], "job.ngc and job-setup.ngc would both be posted as job-setup.pmc"),
    "document": (["my part.FCStd", "my_part.cls"], "my part.FCStd and my_part.cls would both be posted as my_part.pmc"),
    "part": (["j-part12.ngc", "j.ngc"], "j-part12.ngc would be posted as j-part12.pmc, as would a part of j.ngc"),
    "source": (["out/a.ngc", "out/a-linuxcnc.ngc"], "out/a-linuxcnc.ngc would be replaced by a result of out/a.ngc"),
}  # fmt: skip


@pytest.mark.parametrize(("files", "told"), LOST.values(), ids=LOST)
def test_what_would_be_lost_is_told(files, told):
    assert lost_results(list(map(Path, files)), OUT, ALSO) == [told]


@pytest.mark.parametrize(
    "files",
    [
        ["a.ngc", "b.cls", "c.FCStd"],
        ["job.ngc", "job-report.ngc", "job-linuxcnc.ngc", "job-halstreamer.ngc"],
        ["job-part2.ngc", "job-part3.ngc"],
        ["job.ngc", "job-partner.ngc", "job-setup-part2.ngc"],
    ],
)
def test_what_lies_beside_each_other_can_be_posted_together(files):
    assert lost_results(list(map(Path, files)), OUT, ALSO) == []


def test_a_source_is_replaced_by_what_is_asked_for_alone():
    files = [OUT / "a.ngc", OUT / "a-linuxcnc.ngc"]
    assert lost_results(files, OUT, ["csv"]) == []
    assert lost_results(files, Path("elsewhere"), ALSO) == []


def test_nothing_is_posted_when_something_would_be_lost(part, tmp_path, capsys):
    other = part.with_name("part-setup.ngc")
    other.write_text(PART, encoding="ascii")
    assert main(["post", str(part), str(other), "--out", str(tmp_path / "out")]) == 2
    assert "would both be posted as part-setup.pmc: post to different folders" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_a_process_of_its_own_has_one_file_also_after_two_dashes(part, monkeypatch, capsys):
    other = part.with_name("other.ngc")
    other.write_text(PART, encoding="ascii")
    started = []
    monkeypatch.setattr(post, "run_many", lambda commands, at_a_time, doing: started.extend(commands) or 0)
    assert main(["post", "--jobs", "2", "--", str(part), str(other)]) == 0
    for number, command in enumerate(started):
        assert command[command.index("post") :] == [
            "post", f"--only={number}", "--jobs", "2", "--", str(part), str(other),
        ]  # fmt: skip
    assert len(started) == 2
    assert main(["post", "--only=2", str(part), str(other)]) == 2
    assert "argument --only: expected a number below 2, got 2" in capsys.readouterr().err
    with pytest.raises(SystemExit) as ended:
        main(["post", "--only=-1", str(part)])
    assert ended.value.code == 2
