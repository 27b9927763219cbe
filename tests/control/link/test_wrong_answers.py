# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whatever a controller answers: every action ends with an exit code and a line that says why, without a traceback."""

import random
import re

import pytest
from rig import SETTINGS, STROKE, Wire, controller, served

from pkm_post.cli import main
from pkm_post.control.link.errors import PmacError
from pkm_post.control.link.owner_record import read_record
from pkm_post.control.link.rotary_buffer import RotaryBuffer
from pkm_post.control.link.run import check_setup
from pkm_post.control.link.status import read_status
from pkm_post.control.simulator import Controller
from pkm_post.machine import machine_named
from pkm_post.writing.controllers.pmac import settings_of, setup_text

MACHINE = "example_6tps"
JUNK = (
    "",
    "nan",
    "inf",
    "-",
    "1e999",
    "1.2.3",
    "$",
    "$FFFFFFFFFFFFFFFFFFFF",
    "0",
    "-1",
    "X",
    "9" * 400,
    "1 2",
    ".",
    "+-3",
    "..X+1",
    "1.2.3X-4.5.6",
    "9" * 5000,
)
ACTIONS = {
    "probe": (),
    "status": (),
    "monitor": ("--seconds", "0.01"),
    "resume": (),
    "override": ("50",),
    "jog": ("--x", "1"),
    "mdi": ("G91 G1 X1 F100",),
    "home": ("--trigger", "#1HM"),
}


@pytest.fixture(scope="module")
def machine():
    return machine_named(MACHINE)[0]


def lying(made, choice, share):
    """Let a controller answer some questions with what makes no sense."""
    from pkm_post.control.simulator import serial_port as line

    execute = line.execute

    def reported(session, text):
        said = execute(session, text)
        if text == "SIZE" or re.match("I3", text):
            return said  # a false answer to these cannot be noticed
        lies = [choice.choice(JUNK) if choice.random() < share else each for each in said]
        return lies if choice.random() > share else lies[:-1]

    return reported


@pytest.mark.parametrize("action", ACTIONS)
def test_every_action_ends_in_words(action, machine, capsys, monkeypatch):
    choice = random.Random(action)
    made = Controller()
    made.load(setup_text(settings_of(machine)[0], "test", machine.strut_stroke).splitlines())
    made.load([f"#{motor}J/ #{motor}HMZ" for motor in range(1, 7)])
    with served(made) as port:
        for share in (0.02, 0.05, 0.2, 1.0, 1.0):
            monkeypatch.setattr("pkm_post.control.simulator.serial_port.execute", lying(made, choice, share))
            code = main(["pmac", action, "--port", port, "--machine", MACHINE, "--patience", "0.5", *ACTIONS[action]])
            reported = capsys.readouterr()
            monkeypatch.undo()
            assert code == 0 or (code == 1 and reported.err.strip()), (share, reported)
            assert "Traceback" not in reported.err


ASKING = {
    "set-up": lambda session: check_setup(session, SETTINGS, STROKE),
    "status": lambda session: read_status(session, SETTINGS),
    "record": read_record,
    "lines ahead": lambda session: RotaryBuffer(session, SETTINGS, ["A1:0"], 100).lines_ahead(),
}


@pytest.mark.parametrize("what", ASKING)
def test_every_question_ends_in_a_fault_of_the_link_or_of_the_machine(what):
    choice, wire = random.Random(what), Wire(controller(), "tcp")
    with wire.session() as session:
        honest = session.query
        for share in [0.05, 0.2, 0.5, 1.0] * 10:

            def ask(text, most=1 << 16, share=share):
                reported = tuple(
                    choice.choice(JUNK) if choice.random() < share else each for each in honest(text, most)
                )
                return (
                    reported if choice.random() > share / 4 else (reported[:-1], (*reported, "1"))[choice.randrange(2)]
                )

            session.query = ask
            try:
                ASKING[what](session)
            except PmacError as fault:
                assert str(fault)
        session.query = honest
        ASKING[what](session)
