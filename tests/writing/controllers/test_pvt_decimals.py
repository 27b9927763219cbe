# SPDX-License-Identifier: LGPL-2.1-or-later
import re

import pytest
from hypothesis import given, settings, strategies

from pkm_post.writing.controllers.pvt.decimals import plain


@pytest.mark.slow
@settings(derandomize=True)
@given(strategies.floats(allow_nan=False, allow_infinity=False))
def test_a_plain_decimal_reads_back_as_the_same_number(value):
    text = plain(value)
    assert float(text) == value
    assert re.fullmatch(r"-?(0|[1-9][0-9]*)(\.[0-9]*[1-9])?", text)


@pytest.mark.parametrize(("value", "text"), [(-0.0, "0"), (10.0, "10"), (1e-7, "0.0000001"), (1e16, "1" + "0" * 16)])
def test_a_plain_decimal_has_no_exponent_no_padding_and_no_minus_zero(value, text):
    assert plain(value) == text


@pytest.mark.parametrize("value", [float("nan"), float("inf")])
def test_what_is_not_finite_is_refused(value):
    with pytest.raises(ValueError, match="expected a finite number"):
        plain(value)
