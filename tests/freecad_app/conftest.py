# SPDX-License-Identifier: LGPL-2.1-or-later
"""A fresh document for each test, and none left open."""

import FreeCAD as App
import pytest
from cam_jobs import new_job


@pytest.fixture
def document():
    made = App.newDocument("part")
    yield made
    for name in App.listDocuments():
        App.closeDocument(name)


@pytest.fixture
def job(document):
    return new_job(document)
