# SPDX-License-Identifier: LGPL-2.1-or-later
"""Probing: where a touch probe meets a surface, by moves by hand.

A controller that knows nothing of the tool cannot catch its pose in the instant of contact. So a touch has three parts.
A search goes along a line until the input of the probe is seen, and is held there: it passes the surface by less than
the probe allows, since its feed is that way divided by the longest time to standstill of a jog. A second, slower search
finds the place better. Then trials halve what is left between a place where the probe is free and one where it is
touched. Each trial starts where the probe is free and ends at rest, where the actual lengths of the struts have to show
it within the resolution, so neither the link nor the feed has a part in the result.

Input: numerical control, the input of the probe. Output: contacts, tips in {M} in mm.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np

from pkm_post.control.link.errors import DiagnosedError, LinkLostError, NotReadyError
from pkm_post.control.link.queries import read_number
from pkm_post.control.link.session import Session
from pkm_post.control.link.status import Array
from pkm_post.control.numerical_control.control import NumericalControl
from pkm_post.control.numerical_control.manual_moves import CartesianJog
from pkm_post.model import Diagnostic, Place, Refused

_INPUT = re.compile(r"([MP]\d{1,4})(?:=([01]))?", re.IGNORECASE)
_POLL_S = 0.05
_CLEAR_MM = 0.05
"""How far before the last free place the trials start: more than a probe needs to release."""
_SLOWER = 10.0
"""The second search is so much slower than the first, and what it leaves so much less."""
_PLACE = Place("touch probe")


@dataclass(frozen=True)
class ProbeInput:
    """The variable of the controller that has the state of the probe.

    Attributes:
        variable: an M- or P-variable, such as M1000.
        touched: its value while the probe is touched, 0 or 1; it is the other one while the probe is free.
    """

    variable: str
    touched: int = 1

    @classmethod
    def from_text(cls, text: str) -> ProbeInput:
        """The input that ``M1000`` or ``M1000=0`` states.

        Raises:
            ValueError: it states none.
        """
        found = _INPUT.fullmatch(text)
        if found is None:
            raise ValueError(f"expected an M- or P-variable and its value while touched, as M1000=1, got {text!r}")
        return cls(found[1].upper(), int(found[2] or 1))

    def is_touched(self, session: Session) -> bool:
        """Whether the probe is touched.

        Raises:
            NotReadyError: the value is neither 0 nor 1.
            PmacError: the controller does not answer.
        """
        value = read_number(session, self.variable)
        if value not in (0, 1):
            raise NotReadyError([f"{self.variable}: expected 0 or 1 from the input of the probe, got {value:g}"])
        return value == self.touched


@dataclass(frozen=True)
class ProbeSettings:
    """A touch probe.

    Attributes:
        input: where its state is read.
        ball: diameter of its ball, mm.
        overtravel: how far it may be pushed beyond a contact, mm.
        resolution: width within which a contact is found, mm.
    """

    input: ProbeInput
    ball: float
    overtravel: float = 2.0
    resolution: float = 0.001


@dataclass(frozen=True)
class Contact:
    """Where the probe was touched.

    Attributes:
        tip: (3,) centre of the ball in {M}, mm.
        half_width: how far along the touch the tip may be off by the width of the last trial, mm.
    """

    tip: Array
    half_width: float


@dataclass(frozen=True)
class _Line:
    """The line of a touch, by the way from its start in mm."""

    start: Array
    direction: Array

    def at(self, place: float) -> Array:
        """The tip at a place."""
        return self.start + place * self.direction

    def place(self, tip: Array) -> float:
        """The place of a tip."""
        return float((tip - self.start) @ self.direction)


@dataclass(frozen=True)
class _Found:
    """Tips of a search, (3,) each: the last that was free, the first that was touched, and where it rests."""

    free: Array
    touched: Array
    rest: Array


class Probe:
    """A touch probe in the spindle; the tip of the tool is the centre of its ball."""

    def __init__(self, session: Session, control: NumericalControl, settings: ProbeSettings, silence_s: float) -> None:
        """Create the probe.

        Args:
            session: that of the control.
            control: its ``tool_length`` is that to the centre of the ball.
            settings: of the probe.
            silence_s: longest time from silence to standstill of a jog, s, as ``control.longest_silence_s``.
        """
        self._session, self._control, self.settings = session, control, settings
        self.feed = settings.overtravel / silence_s

    @property
    def tip(self) -> Array:
        """(3,) commanded centre of the ball in {M}, mm, at standstill.

        Raises:
            NotReadyError: it moves, or its pose is unknown.
        """
        return self._control.standing_pose().tip

    def is_touched(self) -> bool:
        """Whether the probe is touched."""
        return self.settings.input.is_touched(self._session)

    def go(self, target: Array) -> None:
        """Move the ball to a place, (3,) in {M}, where nothing is expected.

        Raises:
            DiagnosedError: the probe was touched; it stands there.
            Refused: the way is not certified.
            PmacError: machine or link are not ready.
        """
        self._check_free()
        if self._search(target, self.feed) is not None:
            raise DiagnosedError(Diagnostic("C223", _PLACE, f"at {_text(self.tip)}"))

    def touch(self, direction: Array, within: float) -> Contact:
        """Touch what lies in a direction and come back to the start.

        Args:
            direction: (3,) unit vector in {M}.
            within: longest way to the contact, mm.

        Raises:
            DiagnosedError: the probe is touched at the start, touches nothing, or stays touched.
            Refused, PmacError: as ``go``.
        """
        self._check_free()
        line = _Line(self.tip, direction)
        found = self._search(line.at(within), self.feed)
        if found is None:
            raise DiagnosedError(Diagnostic("C221", _PLACE, f"from {_text(line.start)} to {_text(self.tip)}"))
        self._release(line, line.place(found.free) - _CLEAR_MM)
        found = self._search(found.rest, self.feed / _SLOWER) or found
        near = self._release(line, line.place(found.free) - self.settings.resolution)
        near, far = self._narrow(line, near, line.place(found.touched), line.place(found.rest))
        self._stop_at(line.start)
        return Contact(line.at((near + far) / 2), (far - near) / 2)

    def _release(self, line: _Line, near: float) -> float:
        """Back off to a place, and further until the probe is free; the place, mm from the start."""
        while True:
            near = max(near, 0.0)
            self._stop_at(line.at(near))
            if not self.is_touched():
                return near
            if near == 0.0:
                raise DiagnosedError(Diagnostic("C222", _PLACE, f"back at {_text(line.start)}"))
            near -= self.settings.overtravel

    def _narrow(self, line: _Line, near: float, guess: float, far: float) -> tuple[float, float]:
        """Places free and touched, mm from the start, no further apart than the resolution; a guess is tried first."""
        trial = guess if near < guess < far else (near + far) / 2
        while far - near > self.settings.resolution:
            self._stop_at(line.at(trial))
            if self.is_touched():
                far = trial
                self._stop_at(line.at(near))
            else:
                near = trial
            trial = (near + far) / 2
        return near, far

    def _check_free(self) -> None:
        if self.is_touched():
            raise DiagnosedError(Diagnostic("C220", _PLACE, f"{self.settings.input.variable} at {_text(self.tip)}"))

    def _stop_at(self, target: Array) -> None:
        """Move whatever the probe says; where it is already, do nothing."""
        here = self.tip
        if np.abs(target - here).max() > self.settings.resolution / 100:
            self._run(here, target, self.feed)
            while not self._is_at_rest()[1]:
                self._session.sleep(_POLL_S)
            self._check_arrived(target)

    def _search(self, target: Array, feed: float) -> _Found | None:
        """Move until the probe is touched, and rest; None if it is not."""
        free = self.tip
        self._run(free, target, feed)
        while True:
            tip, rests = self._is_at_rest()  # read before the input: free then, so free here
            if self.is_touched():
                touched = self._is_at_rest()[0]  # and after it: touched then, so touched here
                self._control.abort()
                return _Found(free, touched, self.tip)
            free = tip
            if rests:
                self._check_arrived(target)
                return None
            self._session.sleep(_POLL_S)

    def _check_arrived(self, target: Array) -> None:
        """Refuse a place that is not where the move led to, by the actual lengths of the struts."""
        off = float(np.abs(self._is_at_rest()[0] - target).max())
        if off > self.settings.resolution:
            reason = f"a move of the probe ended {off:.4f} mm from where it leads to: it was stopped, or the resolution"
            raise NotReadyError([f"{reason} of {self.settings.resolution:g} mm is finer than the drives"])

    def _run(self, here: Array, target: Array, feed: float) -> None:
        x, y, z = (target - here).tolist()
        plan, diagnostics = self._control.plan_jog(CartesianJog((x, y, z)), feed)
        if plan is None:
            raise Refused(diagnostics)
        self._control.execute(plan)

    def _is_at_rest(self) -> tuple[Array, bool]:
        """Where the ball is, (3,) in {M}, and whether the move has ended; renews the watchdog of the move."""
        state = self._control.poll()
        if state.lost or state.status is None:
            raise LinkLostError(state.lost)
        if state.pose is None:
            raise NotReadyError(["no pose of the platform near the last one has the lengths of the struts"])
        if state.status.held:
            raise NotReadyError(["the move is held; abort it, and probe again"])
        return state.pose.tip, state.status.standing and not state.status.running


def _text(tip: Array) -> str:
    return "X{:.3f} Y{:.3f} Z{:.3f} in {{M}}".format(*tip.tolist())
