# SPDX-License-Identifier: LGPL-2.1-or-later
"""The binary trajectory file ``.pkmt``: a ``model.Trajectory`` on disk [paper section 5.1]."""

from pkm_post.writing.trajectory_file.reader import decode, read
from pkm_post.writing.trajectory_file.writer import write, write_in_private
