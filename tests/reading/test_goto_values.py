# SPDX-License-Identifier: LGPL-2.1-or-later
"""GOTO statements with surface normals: read as the option says, and compensated by them."""

import argparse

import numpy as np
import pytest

from pkm_post.model.diagnostics import errors
from pkm_post.options.converters import goto_values
from pkm_post.reading.part_program import ReadingOptions, read_content

CL_DATA = b"UNITS/MM\nFEDRAT/60\nCUTTER/10,5\nLOADTL/1,LENGTH,60\nGOTO/0,0,9\nGOTO/1,2,3,0,0,1,.6,0,.8\nFINI\n"
NAMES = ("x", "y", "z", "i", "j", "k", "nx", "ny", "nz")


def test_normals_follow_the_axis_as_the_option_says():
    program, diagnostics = read_content(CL_DATA, "a.apt", ReadingOptions())
    assert (program, [fault.code for fault in errors(diagnostics)]) == (None, ["L402"])
    assert "--goto-values" in str(errors(diagnostics)[0])
    program, _ = read_content(CL_DATA, "a.apt", ReadingOptions(goto_values=NAMES))
    assert program.position[1].tolist() == [1, 2, 3]
    assert program.normal[1] == pytest.approx([0.6, 0, 0.8])
    assert np.isnan(program.normal[0]).all()


@pytest.mark.parametrize("text", ["x,y", "x,y,z,i", "i,j,k", "x,y,z,x,y,z", "x,y,z,w", "", "x,y,z,nx,ny"])
def test_names_are_of_whole_vectors(text):
    with pytest.raises(argparse.ArgumentTypeError, match="expected x,y,z"):
        goto_values(text)


@pytest.mark.parametrize("text", ["x,y,z", "i,j,k,x,y,z", "x,y,z,i,j,k,px,py,pz,nx,ny,nz", "x,i,y,j,z,k"])
def test_any_order_of_whole_vectors(text):
    assert goto_values(text) == tuple(text.split(","))
