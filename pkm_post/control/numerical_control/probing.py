# SPDX-License-Identifier: LGPL-2.1-or-later
"""Probing: find the contact of a touch probe with a surface, by manual moves.

A controller without kinematics cannot latch the tool pose at the instant of contact. So a touch has three parts. A
search moves along a line until the probe input is seen, and is held: it overshoots the surface by less than the probe
allows, since its feed is that overtravel divided by the longest time to standstill of a jog. A second, slower search
refines the position. Then trials bisect between a free and a touched position. Each trial starts where the probe is
free and ends at rest, where the actual strut lengths must confirm it within the resolution, so neither link nor feed
affects the result.

Input: numerical control, the input of the probe. Output: contacts, tips in {M} in mm.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np

from pkm_post.control.link.errors import DiagnosedError, LinkLostError, NotReadyError
from pkm_post.control.link.queries import read_number
from pkm_post.control.link.session import Session
from pkm_post.control.numerical_control.control import NumericalControl
from pkm_post.control.numerical_control.manual_moves import CartesianJog
from pkm_post.model import Array, Diagnostic, Place, required

_INPUT = re.compile(r"([MP]\d{1,4})(?:=([01]))?", re.IGNORECASE)
_POLL_S = 0.05
_CLEAR_MM = 0.05
"""Distance of the start of trials from the last free position: more than a probe needs to release."""
_SLOWER = 10.0
"""Ratio of the feeds of the first and the second search, and of their uncertainties."""
_PLACE = Place("touch probe")


@dataclass(frozen=True)
class ProbeInput:
    """The controller variable with the state of the probe.

    Attributes:
        variable: an M- or P-variable, such as M1000.
        touched: its value while the probe is touched, 0 or 1.
    """

    variable: str
    touched: int = 1

    @classmethod
    def from_text(cls, text: str) -> ProbeInput:
        """Parse ``M1000`` or ``M1000=0``.

        Raises:
            ValueError: the text has another form.
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
        input: source of its state.
        ball: diameter of its ball, mm.
        overtravel: travel allowed beyond a contact, mm.
        resolution: resolution of a contact, mm.
    """

    input: ProbeInput
    ball: float
    overtravel: float = 2.0
    resolution: float = 0.001


@dataclass(frozen=True)
class Contact:
    """A contact of the probe.

    Attributes:
        tip: (3,) centre of the ball in {M}, mm.
        half_width: uncertainty along the touch due to the width of the last trial, mm.
    """

    tip: Array
    half_width: float


@dataclass(frozen=True)
class _Line:
    """The line of a touch, by the distance from its start in mm."""

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
    """Tips of a search, (3,) each: the last free one, the first touched one, and the final one at rest."""

    free: Array
    touched: Array
    rest: Array


class Probe:
    """A touch probe in the spindle; the tip of the tool is the centre of its ball."""

    def __init__(self, session: Session, control: NumericalControl, settings: ProbeSettings, silence_s: float) -> None:
        """Create the probe.

        Args:
            session: that of the control.
            control: its ``tool_length`` extends to the centre of the ball.
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
        """Move the ball to a position, (3,) in {M}, without expecting contact.

        Raises:
            DiagnosedError: the probe was touched; it stays there.
            Refused: the move is not certified.
            PmacError: machine or link are not ready.
        """
        self._check_free()
        if self._search(target, self.feed) is not None:
            raise DiagnosedError(Diagnostic("C223", _PLACE, f"at {_text(self.tip)}"))

    def touch(self, direction: Array, within: float) -> Contact:
        """Touch a surface in a direction and return to the start.

        Args:
            direction: (3,) unit vector in {M}.
            within: longest travel to the contact, mm.

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
        """Back off to a position, and further until the probe is free; return it, mm from the start."""
        while True:
            near = max(near, 0.0)
            self._stop_at(line.at(near))
            if not self.is_touched():
                return near
            if near == 0.0:
                raise DiagnosedError(Diagnostic("C222", _PLACE, f"back at {_text(line.start)}"))
            near -= self.settings.overtravel

    def _narrow(self, line: _Line, near: float, guess: float, far: float) -> tuple[float, float]:
        """A free and a touched position, mm from the start, within the resolution; a guess is tried first."""
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
        """Move regardless of the probe; do nothing if already there."""
        here = self.tip
        if np.abs(target - here).max() > self.settings.resolution / 100:
            self._run(here, target, self.feed)
            while not self._observe()[1]:
                self._session.sleep(_POLL_S)
            self._check_arrived(target)

    def _search(self, target: Array, feed: float) -> _Found | None:
        """Move until the probe is touched, then stop; None if it is not."""
        free = self.tip
        self._run(free, target, feed)
        while True:
            tip, rests = self._observe()  # read before the input: if free then, free here
            if self.is_touched():
                touched = self._observe()[0]  # read after it: if touched then, touched here
                self._control.abort()
                return _Found(free, touched, self.tip)
            free = tip
            if rests:
                self._check_arrived(target)
                return None
            self._session.sleep(_POLL_S)

    def _check_arrived(self, target: Array) -> None:
        """Check by the actual strut lengths that the move arrived."""
        off = float(np.abs(self._observe()[0] - target).max())
        if off > self.settings.resolution:
            reason = f"a move of the probe ended {off:.4f} mm from where it leads to: it was stopped, or the resolution"
            raise NotReadyError([f"{reason} of {self.settings.resolution:g} mm is finer than the drives"])

    def _run(self, here: Array, target: Array, feed: float) -> None:
        x, y, z = (target - here).tolist()
        plan = required(*self._control.plan_jog(CartesianJog((x, y, z)), feed))
        self._control.execute(plan)

    def _observe(self) -> tuple[Array, bool]:
        """Position of the ball, (3,) in {M}, and whether the move has ended; renews its watchdog."""
        state = self._control.poll()
        if state.lost or state.status is None:
            raise LinkLostError(state.lost)
        if state.pose is None:
            raise NotReadyError(["no pose of the platform near the last one has the lengths of the struts"])
        if state.status.held:
            raise NotReadyError(["the move is held; abort it, and probe again"])
        return state.pose.tip, state.status.standing and not state.status.running


def _text(tip: Array) -> str:
    return "X{:z.3f} Y{:z.3f} Z{:z.3f} in {{M}}".format(*tip.tolist())
