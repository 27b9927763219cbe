# SPDX-License-Identifier: LGPL-2.1-or-later
"""Files: final names of results, and locks between processes."""

from pkm_post.system.decimals import DecimalReader
from pkm_post.system.document_file.content import DocumentContent, Job
from pkm_post.system.document_file.damaged import Damaged
from pkm_post.system.document_file.read import read_document
from pkm_post.system.lock import Lock, Words, locked, words_of
from pkm_post.system.out_of_memory import FAULTS, lack_of_memory, memory_or_refused
from pkm_post.system.staged import staged
from pkm_post.system.unwritten import unwritten
from pkm_post.system.workers import workers

__all__ = [
    "FAULTS",
    "Damaged",
    "DecimalReader",
    "DocumentContent",
    "Job",
    "Lock",
    "Words",
    "lack_of_memory",
    "locked",
    "memory_or_refused",
    "read_document",
    "staged",
    "unwritten",
    "words_of",
    "workers",
]
