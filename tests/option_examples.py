# SPDX-License-Identifier: LGPL-2.1-or-later
"""Two values for every option, for tests that go through all of them at every door."""

from pkm_post.options.argument_table import ARGUMENTS

EXAMPLES = {
    "--machine": ("slow.toml", "slower.toml"),
    "--work-offset": ("5,0,250", "-3,4,260,30"),
    "--tip-tolerance": ("0.004", "0.02"),
    "--axis-tolerance": ("0.004", "0.02"),
    "--tool-length": ("1=110", "1=130"),
    "--corners": ("arc", "chord"),
    "--leads": ("B", "A"),
    "--swallowed": ("remove", "refuse"),
    "--tool": ("1=10,5", "1=12"),
    "--tool-table": ("tools.tbl,mm", "tools.csv,inch"),
    "--unit": ("inch", "mm"),
    "--feed": ("300", "450.5"),
    "--flavour": ("fanuc", "rs274"),
    "--machine-zero": ("0,0,300", "10,-20,400"),
    "--origin": ("G55=100,0,0", "G55=100,0,0,90"),
    "--subprograms": ("shop", "library"),
    "--leave-out": ("M21", "M21,G187"),
    "--delete-switches": ("2", "1,9"),
    "--optional-stops": ("stop", "leave-out"),
    "--contour-data": ("centre", "contour"),
    "--wear": ("1=0.02", "1=-0.01"),
    "--cl-dialect": ("nx", "catia"),
    "--cycle-values": ("depth,feed", "depth"),
    "--cycle-kinds": ("BORE=ream", "BORE=drill,DEEPHL=deep"),
    "--goto-values": ("x,y,z,i,j,k,nx,ny,nz", "i,j,k,x,y,z"),
    "--part": ("far.stl", "none"),
    "--stock": ("far.stl", "none"),
    "--fixture": ("far.stl", "farther.stl"),
    "--actual-tool": ("1=9.5,4.75", "1=9"),
    "--copies": ("xz,180", "yz"),
    "--surface-speed": ("120", "150.5"),
    "--side": ("1", "2"),
    "--from-line": ("Cut:5", "4"),
    "--spin": ("x-in-plane=20", "optimise=joints"),
    "--report-unit": ("inch", "mm"),
    "--report-date": ("2026-11-28", "the second clamping"),
    "--also": ("csv", "halstreamer,linuxcnc,cartesian"),
}
"""Each with an effect of its own, so that one is not mistaken for the other."""
SWITCHES = {
    flag: (flag, f"--no-{flag[2:]}")
    for flag in ("--keep-chip-load", "--keep-climb", "--allow-open-end", "--block-delete", "--repeat-codes")
}
"""On and off."""


ADDED = {"--fixture", "--subprograms"}
"""What comes to what is said before, and replaces nothing of it."""


def words(flag: str, which: int) -> list[str]:
    """The first (0) or second (1) value of an option, as it is typed."""
    return [SWITCHES[flag][which]] if flag in SWITCHES else [f"{flag}={EXAMPLES[flag][which]}"]


FLAGS = [*EXAMPLES, *SWITCHES]
assert set(FLAGS) == set(ARGUMENTS), "every option has a row"
