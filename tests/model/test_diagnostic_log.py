# SPDX-License-Identifier: LGPL-2.1-or-later
"""The log of diagnostics: what it keeps, what it counts, and in which order it gives them back."""

from collections import Counter

from hypothesis import given
from hypothesis import strategies as st

from pkm_post.model import Diagnostic, DiagnosticLog, Place


def fault(line, code="G102", found="X1..5"):
    return Diagnostic(code, Place("part.ngc", line=line), found)


def by_line(diagnostic):
    return diagnostic.place.line, diagnostic.code


@given(st.lists(st.tuples(st.integers(1, 9), st.sampled_from(["G101", "G102", "G199"]))), st.integers(1, 4))
def test_every_fault_is_kept_or_counted(faults, most):
    log, asked = DiagnosticLog(most), []
    for line, code in faults:
        asked.append(log.keeps(code))
        log.add(fault(line, code), code)
    number = Counter(code for _, code in faults)
    kept = Counter(each.code for each in log.kept)
    assert asked.count(True) == len(log.kept)
    assert all(kept[code] == min(number[code], most) for code in number)
    assert all(kept[code] + log.more(code) == number[code] for code in number)


def test_the_last_of_a_group_in_order_says_how_many_more_there_are():
    log = DiagnosticLog(2)
    for line in (7, 3, 5, 4):
        log.add(fault(line), "G102")
    log.add(fault(6, "G101", "@"), "G101")
    log.count(10, "G102")
    found = [(each.place.line, each.found) for each in log.in_order(by_line)]
    assert found == [(3, "X1..5"), (6, "@"), (7, "X1..5, and 12 more like it")]
    assert [each.found for each in log.kept] == ["X1..5", "X1..5", "@"]


def test_a_log_has_errors_when_one_of_its_rules_is_an_error():
    log = DiagnosticLog(5)
    log.add(fault(1, "V131", "25 mm lower"))  # a warning
    assert not log.has_errors()
    log.add(fault(2))
    assert log.has_errors()


def test_counting_nothing_changes_nothing():
    log = DiagnosticLog(1)
    log.add(fault(1))
    log.count(0)
    assert log.more() == 0 and log.in_order(by_line) == (fault(1),)


def test_a_name_of_several_lines_leaves_a_diagnostic_in_one():
    place = Place("part\n.ngc", "Profile\r\nof\u2028the \u00e4u\u00dfere edge \u5916", 3)
    text = str(Diagnostic("G102", place, "T1 \x1b[31m\tend mill\x85"))
    assert len(text.splitlines()) == 1 and text.isprintable()
    assert text.startswith("part\\n.ngc: Profile\\r\\nof\\u2028the \u00e4u\u00dfere edge \u5916: line 3: error G102: ")
    assert "T1 \\x1b[31m\\tend mill\\x85; " in text
