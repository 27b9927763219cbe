# SPDX-License-Identifier: LGPL-2.1-or-later
"""System: files and processes: results that appear together, locks, documents on disk, threads, memory."""

from pkm_post.system.decimals import DecimalReader
from pkm_post.system.document import DocumentContent, Job, read_document
from pkm_post.system.document_archive import DamagedDocument
from pkm_post.system.lock import Lock, OwnerRecord, lock_owner, try_lock
from pkm_post.system.out_of_memory import MEMORY_FAULTS, memory_diagnostic, memory_guard
from pkm_post.system.staged import staged, write_fault
from pkm_post.system.workers import workers

__all__ = [
    "MEMORY_FAULTS",
    "DamagedDocument",
    "DecimalReader",
    "DocumentContent",
    "Job",
    "Lock",
    "OwnerRecord",
    "memory_diagnostic",
    "try_lock",
    "memory_guard",
    "read_document",
    "staged",
    "write_fault",
    "lock_owner",
    "workers",
]
