# SPDX-License-Identifier: LGPL-2.1-or-later
"""Names of NumPy that are used are in the oldest NumPy that is allowed, 1.26, and in the one that runs this.

FreeCAD's bundles have NumPy 1.26, those of distributions a newer one: this finds in either what the other one lacks.
What NumPy computes otherwise is found by `make oldest`, which runs a part of the tests with 1.26.
"""

import ast
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).parents[1]
USERS = ("pkm_post", "examples", "postprocessors", "tests", "benchmarks")

NEWER = {
    "np": "acos acosh asin asinh astype atan atan2 atanh bitwise_count bitwise_invert bitwise_left_shift "
    "bitwise_right_shift bool concat cumulative_prod cumulative_sum isdtype long matrix_transpose matvec permute_dims "
    "pow strings trapezoid ulong unique_all unique_counts unique_inverse unique_values unstack vecdot vecmat",
    "np.linalg": "cross diagonal matmul matrix_norm matrix_transpose outer svdvals tensordot trace vecdot vector_norm",
    "np.lib": "array_utils introspect",
    "np.exceptions": "RankWarning",
    "np.dtypes": "StringDType",
}
"""What NumPy 2.4 has and 1.26 has not, by module; and of arrays:"""
NEWER_OF_ARRAYS = {"mT", "to_device"}
NEWER_NAMES = {f"{module}.{name}" for module, names in NEWER.items() for name in names.split()}


def names_in(source):
    """The names in a source that begin with ``np.``, with the lines, and attributes that only newer arrays have."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Attribute):
            if name := dotted(node):
                yield node.lineno, name
            elif node.attr in NEWER_OF_ARRAYS:
                yield node.lineno, f"np.ndarray.{node.attr}"


def dotted(node):
    """The name in NumPy of an attribute, such as np.linalg.norm; None for one of another thing."""
    parts = []
    while isinstance(node, ast.Attribute):
        parts.append(node.attr)
        node = node.value
    return ".".join(["np", *reversed(parts)]) if isinstance(node, ast.Name) and node.id == "np" else None


def lacking(name):
    """Whether one of both NumPys lacks a name."""
    return name in NEWER_NAMES or name.startswith("np.ndarray.") or not is_there(name)


def is_there(name):
    """Whether the NumPy that runs has a name."""
    found = np
    for part in name.split(".")[1:]:
        if not hasattr(found, part):
            return False
        found = getattr(found, part)
    return True


@pytest.mark.parametrize("folder", USERS)
def test_both_have_all_names(folder):
    files = sorted(ROOT.joinpath(folder).rglob("*.py"))
    used = [(file, *found) for file in files for found in names_in(file.read_text(encoding="utf-8"))]
    assert len(used) > 10 or folder == "postprocessors"
    missing = [f"{file.relative_to(ROOT)}:{line}: {name}" for file, line, name in used if lacking(name)]
    assert missing == []


@pytest.mark.parametrize(
    ("source", "names"),
    [
        ("np.concat([a, b])", ["np.concat"]),
        ("matrix.mT @ np.linalg.norm(x)", ["np.ndarray.mT"]),
        ("np.linalg.vector_norm(np.no_such_name)", ["np.linalg.vector_norm", "np.no_such_name"]),
        ("np.linalg.solve(np.concatenate(a), b).T", []),
    ],
)
def test_these_would_be_found(source, names):
    assert sorted(name for _, name in names_in(source) if lacking(name)) == names


@pytest.mark.filterwarnings("ignore:In the future `np.:FutureWarning")
def test_the_list_is_that_of_this_numpy():
    """With 1.26 none of them is there; which ones newer versions have depends on the version."""
    there = {name for name in NEWER_NAMES if is_there(name)}
    assert there == set() if np.lib.NumpyVersion(np.__version__) < "2.0.0" else "np.concat" in there
