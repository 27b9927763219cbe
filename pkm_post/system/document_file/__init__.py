# SPDX-License-Identifier: LGPL-2.1-or-later
"""Document file: read and check a FreeCAD document on disk without FreeCAD and without NumPy."""

from pkm_post.system.document_file.content import DocumentContent, Job
from pkm_post.system.document_file.damaged import Damaged
from pkm_post.system.document_file.read import read_document

__all__ = ["Damaged", "DocumentContent", "Job", "read_document"]
