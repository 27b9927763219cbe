# SPDX-License-Identifier: LGPL-2.1-or-later
"""System: files and processes: results written together, locks, documents on disk, threads, parsing of numbers.

The command line starts in a Python without NumPy: modules that need it are imported on first use.
"""

from typing import TYPE_CHECKING

from pkm_post import at_first_use
from pkm_post.system import result_files
from pkm_post.system.file_names import require_other, require_usable, unusable_name
from pkm_post.system.freecad_command import VARIABLE as FREECADCMD
from pkm_post.system.freecad_command import FreeCADCommand, freecad_command
from pkm_post.system.lock import Lock, OwnerRecord, lock_owner, try_lock
from pkm_post.system.out_of_memory import MEMORY_FAULTS, memory_diagnostic, memory_guard
from pkm_post.system.reasons import read_fault, reason_of
from pkm_post.system.staged import staged, staged_folder, write_fault
from pkm_post.system.thread_count import VARIABLE as THREADS
from pkm_post.system.thread_count import ThreadCountError, threads
from pkm_post.system.thread_count import share as thread_share
from pkm_post.system.workers import columns_in_workers, in_background, in_workers, workers

if TYPE_CHECKING:
    from pkm_post.system import packages
    from pkm_post.system.decimals import DecimalReader
    from pkm_post.system.document import DocumentContent, Job, read_document
    from pkm_post.system.document_archive import DamagedDocument
else:
    __getattr__ = at_first_use(
        __name__,
        {
            "": "packages",
            "document": "DocumentContent Job read_document",
            "document_archive": "DamagedDocument",
            "decimals": "DecimalReader",
        },
    )
