# SPDX-License-Identifier: LGPL-2.1-or-later
"""Make tests/data/gcode_execution.json: what LinuxCNC's interpreter makes of parameters, expressions and O words.

    python3 tests/oracles/make_gcode_execution.py

Needs rs274 of the Debian package linuxcnc-uspace (the numbers in the repository are from 2.9.0~pre1). Every program
moves in absolute coordinates by G0; the file has for each of them its text, and either the positions X Y Z A B C after
each move, with four decimals, or null where rs274 refuses the program. No program has a ``break`` and a ``continue``
in a ``do`` loop: on its way from ``continue`` to the condition this version obeys a ``break`` that it comes by, or that
another loop has left behind, and ends the loop.
"""

import json
import re
import subprocess
import tempfile
from pathlib import Path

TARGET = Path(__file__).resolve().parents[1] / "data" / "gcode_execution.json"

SUB_SCOPE = """#1=9 #2=8 #3=7 #31=5
o<s> sub
G0 X#1 Y#2 Z#3 A#31
#3=22
#31=6
#<_g>=4
#<l>=3
o<s> endsub [#1*2]
o<s> call [1]
G0 X#1 Y#2 Z#3 A#31 B#<_value> C#<_value_returned>
G0 X#<_g> Yexists[#<l>] Zexists[#<_g>]
M2
"""
IF_CHAIN = """#1=0
o1 while [#1 lt 5]
#1=[#1+1]
o2 if [#1 eq 1]
G0 X10
o2 elseif [#1 eq 2]
G0 X20
o2 elseif [#1 eq 2]
G0 X99
o2 elseif [#1 eq 4]
o3 if [1]
G0 X40
o3 else
G0 X98
o3 endif
o2 else
G0 X[#1*100]
o2 endif
o1 endwhile
M2
"""
WHILE = """#1=0
o1 while [#1 lt 5]
#1=[#1+1]
o2 if [#1 eq 2]
o1 continue
o2 endif
o3 if [#1 eq 4]
o1 break
o3 endif
G0 X#1
o1 endwhile
G0 Y#1
M2
"""
DO_CONTINUE = """#1=0
o4 do
#1=[#1+1]
o5 if [#1 eq 2]
o4 continue
o5 endif
G0 Y#1
o4 while [#1 lt 4]
G0 Z#1
M2
"""
DO_BREAK = """#1=0
o4 do
#1=[#1+1]
o6 if [#1 eq 3]
o4 break
o6 endif
G0 Y#1
o4 while [#1 lt 9]
G0 Z#1
M2
"""
REPEAT = """#1=0
o6 repeat [2.6]
#1=[#1+1]
G0 Z#1
o6 endrepeat
o7 repeat [-2]
G0 A1
o7 endrepeat
o8 repeat [0.5]
G0 A2
o8 endrepeat
#2=0
o9 repeat [2.5]
#2=[#2+1]
G0 B#2
o9 endrepeat
M2
"""
NEST = """o1 sub
o2 repeat [2]
o3 repeat [#1]
G0 X[#1*10]
#2=[#2+1]
G0 Y#2
o3 endrepeat
o2 endrepeat
o1 endsub
o1 call [2]
o1 call [1] [50]
M2
"""
RECURSION = """o<a> sub
G0 X#1 Y#<_call_level>
o1 if [#1 gt 0]
o<a> call [#1-1]
o1 endif
G0 Z#1
o<a> endsub
o<a> call [%d]
M2
"""
RETURNS = """o1 sub
o2 while [1]
o3 if [#1 gt 2]
o1 return [#1*10]
o3 endif
#1=[#1+1]
o2 endwhile
o1 endsub [99]
o1 call [1]
G0 X#<_value> Y#<_value_returned>
o4 sub
o4 endsub
o4 call
G0 X#<_value> Y#<_value_returned>
M2
"""
M98 = """#1=5 #31=1 #<l>=9
M98 P1001 L2
G0 X#1 Y#31
M98 P1002 L0
M98 P[1000+2]
G0 X0
M2
o1001
G0 X#1 Yexists[#<l>]
#1=[#1+2]
#31=8
M98 P1002
M99
o1002
G0 Z#1
M99
"""
FAULTS = """G0 X[1/0]|G0 X[5 mod 0]|G0 Xsqrt[-1]|G0 Xln[0]|G0 Xacos[2]|G0 X[[-8]**[1/3]]|G0 X[-2**0.5]|G0 X[0**-1]
G0 Xexp[1000]|G0 X#0|G0 X#5603|#5603=1|G0 X#1.5|G0 X#<nope>|G0 X#<_nope>|#<_value>=3|#<_x>=3|#1=1.04/G#1 X1|M[2+0.3]
o1 endif|o1 else|o1 endwhile|o1 break|o1 return|o1 call|o<nosuch> call|M98|M98 P7|o1 sub/o2 sub/o2 endsub/o1 endsub"""

PROGRAMS = {
    "power": "G0 X[2**3**2] Y[-2**2] Z[2 ** -1] A[4 ** 0.5] B[[-2]**3] C[-sin[90]**2]",
    "product": "G0 X[1+2*3] Y[2 * 3 / 4 * 2] Z[16/4/2] A[2*3 mod 4] B[7 - 4 mod 3] C[10-2-3]",
    "modulo": "G0 X[7 mod 3] Y[-7 mod 3] Z[7 mod -3] A[-5.5 mod 2] B[5.5 mod -2] C[5 mod 2.5]",
    "comparison": "G0 X[1 LT 2 + 3] Y[2 GT 1 GT 0] Z[1 LE 1] A[1 GE 1.00001] B[1 GT 1] C[1 LT 1.00005]",
    "equality": "G0 X[1 EQ 1.000099] Y[1 EQ 1.000101] Z[1 NE 1.00005] A[1 NE 1.001] B[1 + 1 eq 2]",
    "logic": "G0 X[1 and 0 or 1] Y[1 or 1 and 0] Z[1 xor 1] A[2 xor 0] B[0.0 or 0] C[1 gt 0 and 2 gt 1]",
    "rounding": "G0 X[round[-0.5]] Y[round[2.5]] Z[fix[-2.5]] A[fup[-2.5]] B[fix[2.5]] C[fup[2.5]]",
    "angles": "G0 Xatan[1]/[-1] Yatan[0]/[0] Z[atan[1]/[1]*2] Asin[30] Bacos[0.5] Ctan[45]",
    "functions": "G0 Xabs[-3] Yexp[1] Zln[10] Asqrt[2] Basin[0.5] Ccos[60]",
    "signs": "#1=1\nG0 X##1 Y-#1 Z+#1 A-[3] B-sin[90] C-[1+2]",
    "numbers": "G0 X[1 eq 1] Y[.5+.25] Z+.5 A[-3 + 2] B#[5] C[2-#1]",
    "names": "#<A b>=3\nG0 X#<ab> Y#<AB>",
    "exists": "#<_zz>=0\nG0 Xexists[#5] Yexists[#<_zz>] Zexists[#31] Aexists[#<q>] Bexists[#<_x>]",
    "assignment after the block": "#3=3\n#3=4 #4=#3 #4=[#4+#3]\nG0 X#3 Y#4\nG0 X1 #1=5 Y#1\nG0 Z#1",
    "indirect assignment": "#[1+1]=4\nG0 X#2\n#2=1\n##2=6\nG0 X#1",
    "nearly whole": "#1=7 #2=0.99999\nG#2 F9 X#[1.00005]\nG0 Y#[0.99995]",
    "condition is anything but zero": "o1 if [0.00005]\nG0 X1\no1 endif",
    "labels": "o1 sub\nG0 X[#31]\n#31=[#31+1]\no1 endsub\n#7=1\no01 call\no1.0 call\no[0+1] call\no#7 call",
    "sub in a loop": "o1 while [1]\no2 sub\nG0 X1\no2 endsub\no1 break\no1 endwhile\no2 call",
    "labels of two subs": "o1 sub\no2 if [1]\nG0 X1\no2 endif\no1 endsub\no3 sub\no2 if [1]\nG0 X2\no2 endif\n"
    "o3 endsub\no1 call\no3 call",
    "end in a sub": "o1 sub\nM2\no1 endsub\no1 call\nG0 X3",
    "end of the program": "#1=1\nG0 X1\nM30\nG0 X2",
    "sub behind the call": "o<s> call [1]\nG0 X[#<_value>+5]\nM2\no<s> sub\nG0 X#1\no<s> return\nG0 X9\no<s> endsub",
    "end in a subprogram": "M98 P1001\nG0 X3\nM2\no1001\nG0 X1\nM30",
    "scope of a sub": SUB_SCOPE,
    "branches": IF_CHAIN,
    "while": WHILE,
    "do with continue": DO_CONTINUE,
    "do with break": DO_BREAK,
    "repeat": REPEAT,
    "nested repeats": NEST,
    "nine calls deep": RECURSION % 8,
    "ten calls deep": RECURSION % 9,
    "returned values": RETURNS,
    "M98": M98,
    **{
        f"fault {text}": text.replace("/", "\n") if text.startswith(("o", "#1=1.04")) else text
        for line in FAULTS.splitlines()
        for text in line.split("|")
    },
}


def positions(program):
    """Where rs274 goes, or None if it refuses the program."""
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "part.ngc").write_text(program)
        Path(folder, "part.var").touch()
        done = subprocess.run(
            ["rs274", "-v", "part.var", "-g", "part.ngc"], cwd=folder, capture_output=True, text=True, check=False
        )
    if done.returncode:
        if len(done.stderr.splitlines()) < 3:  # "executing", the reason, the block
            raise RuntimeError(f"rs274: expected the reason of a refusal, got {done.stderr!r}")
        return None
    moves = re.findall(r"STRAIGHT_\w+\((.*)\)", done.stdout)
    return [[float(number) for number in move.split(",")] for move in moves]


def main():
    """Write the file."""
    programs = {name: text.rstrip("\n") + "\nM2\n" for name, text in PROGRAMS.items()}
    rows = [
        f"{json.dumps(name)}: {json.dumps({'program': text, 'positions': positions(text)})}"
        for name, text in programs.items()
    ]
    TARGET.write_text("{\n" + ",\n".join(rows) + "\n}\n")


if __name__ == "__main__":
    main()
