# SPDX-License-Identifier: LGPL-2.1-or-later
"""LinuxCNC's streamer: a HAL file that lets a halstreamer table move the struts only from their current position.

halstreamer puts the first row of a table on the pins at once. Here each strut's command passes two switches: it follows
the feedback until ``drives-on``, then holds its position, and takes the streamer's pins once the first row is within
``START_TOLERANCE`` of the command of all six struts. With any other first row ``stream-refused`` turns on, no further
row is taken, and no strut moves. Lengths are counted lengths in mm.

Sources: LinuxCNC 2.9, manual pages streamer(9), near(9), logic(9), flipflop(9), mux2(9), and2(9), not(9).
"""

from __future__ import annotations

START_TOLERANCE = 0.05
"""mm; posted programs start at a pose to the same length."""
DEPTH = 4000
"""Rows in the streamer's buffer: four seconds at a servo period of 1 ms."""
_STRUTS = range(6)


def stream_hal() -> str:
    """The HAL file, for a thread named servo-thread and signals strut-N-fb written by the drives."""
    return "\n".join([*_components(), *_start_interlock(), *_commands(), *_functions()]) + "\n"


def _components() -> list[str]:
    names = {
        "near": _each("near"),
        "mux2": [*_each("still"), *_each("command")],
        "and2": ["go", "row-there", "enable"],
        "not": ["filled", "far", "stop", "not-accepted", "not-refused"],
        "flipflop": ["accepted", "refused"],
    }
    return [
        "# A table for halstreamer moves the struts from where they are, or not at all.",
        "# The drives write strut-N-fb and drives-on, and take strut-N-cmd: counted lengths in mm, strut 1 is N = 0.",
        "# stream-start begins; stream-refused says that the first row is not where the struts are.",
        f"loadrt streamer depth={DEPTH} cfg=ffffff",
        *(f"loadrt {module} names={','.join(those)}" for module, those in names.items()),
        "# of six inputs, of three and of three: all of them",
        "loadrt logic names=all-near,accept,refuse personality=0x106,0x103,0x103",
        *(f"setp near-{strut}.difference {START_TOLERANCE}" for strut in _STRUTS),
    ]


def _each(name: str) -> list[str]:
    return [f"{name}-{strut}" for strut in _STRUTS]


def _start_interlock() -> list[str]:
    """Accept or refuse the first row; the result is latched until stream-start or drives-on goes off."""
    return [
        "# a row is on the pins when the streamer was enabled and had one; its enable is set at the period's end",
        "net stream-empty streamer.0.empty => filled.in",
        "net stream-filled filled.out => row-there.in0",
        "net stream-enable => row-there.in1",
        "net row-there row-there.out => accept.in-00 refuse.in-00",
        "net first-near all-near.and => far.in accept.in-01",
        "net first-far far.out => refuse.in-01",
        "net not-refused not-refused.out => accept.in-02 enable.in1",
        "net not-accepted not-accepted.out => refuse.in-02",
        "net stream-accept accept.and => accepted.set",
        "net stream-refuse refuse.and => refused.set",
        "net stream-accepted accepted.out => not-accepted.in",
        "net stream-refused refused.out => not-refused.in",
        "# begins with stream-start while drives-on, and begins again after either was off",
        "net stream-start => go.in0",
        "net drives-on => go.in1",
        "net stream-go go.out => stop.in enable.in0",
        "net stream-stop stop.out => accepted.reset refused.reset",
        "net stream-enable enable.out => streamer.0.enable",
    ]


def _commands() -> list[str]:
    """Feedback until the drives are on, then the last command, then the streamer's pins."""
    lines = ["# feedback while the drives are off, else the last command; the streamer's pins once the row is accepted"]
    lines.append("net drives-on => " + " ".join(f"still-{strut}.sel" for strut in _STRUTS))
    lines.append("net stream-accepted => " + " ".join(f"command-{strut}.sel" for strut in _STRUTS))
    for strut in _STRUTS:
        lines += [
            f"net strut-{strut}-fb => still-{strut}.in0",
            f"net strut-{strut}-cmd command-{strut}.out => still-{strut}.in1",
            f"net strut-{strut}-still still-{strut}.out => command-{strut}.in0 near-{strut}.in2",
            f"net strut-{strut}-row streamer.0.pin.{strut} => command-{strut}.in1 near-{strut}.in1",
            f"net strut-{strut}-near near-{strut}.out => all-near.in-{strut:02}",
        ]
    return lines


def _functions() -> list[str]:
    """In signal order, so that the result for the first row takes effect in the period in which it arrives."""
    order = [
        "go", "stop", *_each("still"), "streamer.0", *_each("near"), "all-near", "far", "filled", "row-there", "accept",
        "accepted", "not-accepted", "refuse", "refused", "not-refused", "enable", *_each("command"),
    ]  # fmt: skip
    return [f"addf {name} servo-thread" for name in order]
