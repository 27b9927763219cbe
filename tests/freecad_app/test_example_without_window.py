# SPDX-License-Identifier: LGPL-2.1-or-later
"""The example document is made without a window as well."""

import FreeCAD
import pytest

from pkm_post.freecad_app.example import create_example


@pytest.fixture
def example():
    document = create_example()
    yield document
    FreeCAD.closeDocument(document.Name)


def test_the_example_needs_no_window(example):
    job = example.getObject("Job")
    (operation,) = job.Operations.Group
    assert operation.isValid()
    assert operation.Path.Size > 100
    assert operation.MaximumGouge < 0.05  # its ChordTolerance
