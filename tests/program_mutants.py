# SPDX-License-Identifier: LGPL-2.1-or-later
"""Motion programs with one thing wrong, by chance: a digit, a sign, lines swapped, dropped, doubled, a byte."""

import numpy as np


def _other_digit(random, lines):
    row, places = _with(random, lines, str.isdigit)
    place = places[random.integers(len(places))]
    digit = str((int(lines[row][place]) + random.integers(1, 10)) % 10)
    lines[row] = lines[row][:place] + digit + lines[row][place + 1 :]


def _other_sign(random, lines):
    row, places = _with(random, lines, lambda one: one == ":")
    place = places[random.integers(len(places))] + 1
    line = lines[row]
    lines[row] = line[:place] + (line[place + 1 :] if line[place] == "-" else "-" + line[place:])


def _swapped(random, lines):
    row = random.integers(len(lines) - 1)
    lines[row], lines[row + 1] = lines[row + 1], lines[row]


def _dropped(random, lines):
    del lines[random.integers(len(lines))]


def _doubled(random, lines):
    row = random.integers(len(lines))
    lines.insert(row, lines[row])


def _other_byte(random, lines):
    row, places = _with(random, lines, lambda one: one != "\n")
    place = places[random.integers(len(places))]
    lines[row] = lines[row][:place] + chr(random.integers(32, 127)) + lines[row][place + 1 :]


def _with(random, lines, wanted):
    while True:
        row = random.integers(len(lines))
        places = [place for place, one in enumerate(lines[row]) if wanted(one)]
        if places:
            return row, places


CHANGES = (_other_digit, _other_digit, _other_sign, _swapped, _dropped, _doubled, _other_byte)


def mutants(text, seed):
    """Texts that differ from a program, without end; the same for the same seed."""
    random = np.random.default_rng(seed)
    while True:
        lines = text.splitlines(keepends=True)
        CHANGES[random.integers(len(CHANGES))](random, lines)
        changed = "".join(lines)
        if changed != text:
            yield changed
