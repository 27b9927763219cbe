# SPDX-License-Identifier: LGPL-2.1-or-later
"""List feed: keeps the knot list of a controller filled, and tracks the motion along it.

A piece is written after the current end, read back and compared, and only then linked by one assignment. Until then the
list leads into the stop of the previous piece; if the assignment comes too late, the controller may already have taken
that stop. The variable of the current point shows which.

Every step may be repeated: after a lost link the same values are written to the same variables.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice

from pkm_post.control.link.errors import LinkLostError, OutcomeUnknownError, PmacError
from pkm_post.control.link.queries import parse_number
from pkm_post.control.link.session import Session
from pkm_post.control.link.status import AnySettings
from pkm_post.control.player.certified_motion import CertifiedMotion
from pkm_post.control.player.knot_list import Layout, assignment_lines, point_assignments, read_assignments
from pkm_post.control.player.pieces import PlayedPiece

_KEPT = 2
"""Points before the current one that are not overwritten."""
_READ_AT_ONCE = 448
"""Variables in one answer: about 6 KB."""
_SAME = 1e-9
"""Relative tolerance of a value read back: the controller stores 36 bits."""


@dataclass(frozen=True)
class ListPoint:
    """A point in the list.

    Attributes:
        place: its first variable.
        ms: interval to it.
        knot: its index in the motion.
    """

    place: int
    ms: int
    motion: CertifiedMotion
    knot: int


@dataclass(frozen=True)
class _Branch:
    """A stop in the list.

    Attributes:
        after: number of the point after which it starts.
    """

    after: int
    points: tuple[ListPoint, ...]


@dataclass(frozen=True)
class _Entry:
    """A piece being appended: its points, its stop, and the lines that write them."""

    points: tuple[ListPoint, ...]
    stop: tuple[ListPoint, ...]
    lines: tuple[str, ...]
    commit: str


class ListFeed:
    """The list of one run, from rest to rest.

    Attributes:
        current: the point whose move the controller computed last; None before the first one.
        stopped_at: the stop that the controller took instead of the planned motion; else None.
    """

    def __init__(self, session: Session, settings: AnySettings, layout: Layout) -> None:
        self._session, self._settings, self._layout = session, settings, layout
        self._free: deque[int] = deque()
        self._points: deque[ListPoint] = deque()
        self._branches: deque[_Branch] = deque()
        self._first = 0  # number of the first of _points
        self._entry: _Entry | None = None
        self._at = -1
        self._early: _Branch | None = None
        self._asked: list[CertifiedMotion] = []
        self.current: ListPoint | None = None
        self.stopped_at: CertifiedMotion | None = None

    def clear(self) -> None:
        """Empty the list; the resident program must not run."""
        self._set(f"P{self._layout.next}=0 P{self._layout.current}=0")
        self._free = deque(self._layout.points())
        self._points.clear()
        self._branches.clear()
        self._first, self._entry, self._at = 0, None, -1
        self._early, self.current, self.stopped_at = None, None, None
        self._asked.clear()

    @property
    def capacity(self) -> int:
        """Most points of a piece with its stop."""
        return len(self._layout.points())

    @property
    def ahead_ms(self) -> int:
        """Time from the end of the last computed move to the start of the last stop; 0 within a stop."""
        if self.stopped_at is not None:
            return 0
        return sum(point.ms for point in islice(self._points, self._at + 1 - self._first, None))

    @property
    def last(self) -> ListPoint | None:
        """The point where the last stop starts; within a stop the current one; None if the list is empty."""
        return self._points[-1] if self._points and self.stopped_at is None else self.current

    @property
    def is_taking_in(self) -> bool:
        """Whether it is unknown if a piece is in the list, as answers got lost."""
        return self._entry is not None

    def has_room(self, piece: PlayedPiece) -> bool:
        """Whether a piece fits, in addition to the points ahead."""
        return self._entry is not None or piece.size <= len(self._free)

    def append(self, piece: PlayedPiece) -> None:
        """Append a piece; after a lost link or a stop, call again with the same piece.

        Raises:
            LinkLostError: it may or may not be in the list.
            CancelledError: a stop is waiting; the piece is not in the list.
            PmacError: the values read back differ; the piece is not in the list.
        """
        entry = self._entry = self._entry or self._prepared(piece)
        for line in entry.lines:
            self._session.check_preemption()
            self._set(line)
        self._compare(entry)
        self._set(entry.commit)
        self._take_in(entry)

    @property
    def is_late(self) -> bool:
        """Whether the controller took a stop that no ``end_soon`` asked for, in time to be undone or not."""
        return self.stopped_at is not None and all(self.stopped_at is not each for each in self._asked)

    def end_soon(self) -> None:
        """Lead the list into its next stop; if the controller is already past it, call again for the one after.

        Raises:
            LinkLostError: it may or may not lead there.
        """
        branch = next((each for each in self._branches if each.after > self._at), None)
        if branch is not None and branch is not self._early and self.stopped_at is None:
            self._set(f"P{self._points[branch.after - self._first].place}={branch.points[0].place}")
            self._early = branch
            self._asked.append(branch.points[0].motion)

    def end_at_its_end(self) -> None:
        """Undo ``end_soon``, unless the controller is already in that stop.

        Raises:
            LinkLostError: it may or may not be undone.
        """
        if self._early is None or self.stopped_at is not None:
            return
        after = self._early.after - self._first
        if 0 <= after < len(self._points) - 1:
            self._set(f"P{self._points[after].place}={self._points[after + 1].place}")
        self._early = None

    def poll(self) -> Iterator[CertifiedMotion]:
        """Query the current point; yield the motions begun since.

        Raises:
            LinkLostError: no answer.
            PmacError: the controller is at a point that is not in the list.
        """
        (place,) = self._read(self._layout.current, 1)
        if place == 0 or (self.current is not None and place == self.current.place):
            return
        yield from self._arrived(int(place))

    def is_at_its_end(self) -> bool:
        """Whether the last computed point is at rest at the end of its motion."""
        return (
            self.current is not None
            and self.current.knot == len(self.current.motion.struts) - 1
            and not (self.current.motion.end.speed.any())
        )

    def _take_in(self, entry: _Entry) -> None:
        if entry.stop:
            self._branches.append(_Branch(self._first + len(self._points) + len(entry.points) - 1, entry.stop))
        self._points.extend(entry.points)
        self._entry = None

    def _prepared(self, piece: PlayedPiece) -> _Entry:
        points = self._placed(piece.motion)
        stop = self._placed(piece.stop) if piece.stop is not None else ()
        written = point_assignments(piece.motion.struts, [point.place for point in points], self._settings)
        if piece.stop is not None:
            written += point_assignments(piece.stop.struts, [point.place for point in stop], self._settings)
            written.append(f"P{points[-1].place}={stop[0].place}")
        before = self._points[-1].place if self._points else self._layout.next
        return _Entry(points, stop, tuple(assignment_lines(written)), f"P{before}={points[0].place}")

    def _placed(self, motion: CertifiedMotion) -> tuple[ListPoint, ...]:
        times = motion.struts.time_ms.tolist()
        return tuple(
            ListPoint(self._free.popleft(), times[knot] - times[knot - 1], motion, knot)
            for knot in range(1, len(times))
        )

    def _compare(self, entry: _Entry) -> None:
        """Read back and compare the written values."""
        wanted = read_assignments(entry.lines)
        numbers = sorted(wanted)
        begin = 0
        while begin < len(numbers):
            end = begin + 1
            while end < len(numbers) and numbers[end] == numbers[end - 1] + 1 and end - begin < _READ_AT_ONCE:
                end += 1
            found = self._read(numbers[begin], end - begin)
            for number, value in zip(numbers[begin:end], found, strict=True):
                if not abs(value - float(wanted[number])) <= _SAME * max(1.0, abs(value)):
                    raise PmacError(f"P{number}: expected {wanted[number]}, the controller has {value!r}")
            begin = end

    def _arrived(self, place: int) -> Iterator[CertifiedMotion]:
        entry = self._entry
        if entry is not None and any(point.place == place for point in (*entry.points, *entry.stop)):
            self._take_in(entry)  # it was linked, but the answer got lost
        for branch in self._branches:
            for point in branch.points:
                if point.place == place:
                    yield from self._passed(branch.after)
                    if self.stopped_at is None:
                        self.stopped_at = point.motion
                        yield point.motion
                    self.current = point
                    return
        for number in range(max(self._at, self._first), self._first + len(self._points)):
            if self._points[number - self._first].place == place:
                yield from self._passed(number)
                self._forget(number)
                return
        raise PmacError(f"P{self._layout.current}: the controller is at {place}, which is no point of the list")

    def _passed(self, number: int) -> Iterator[CertifiedMotion]:
        """The motions that start up to a point."""
        for at in range(self._at + 1, number + 1):
            point = self._points[at - self._first]
            if point.knot == 1:
                yield point.motion
        if number >= self._first:
            self._at, self.current = number, self._points[number - self._first]

    def _forget(self, number: int) -> None:
        """Free the variables of the points before a point."""
        while self._branches and self._branches[0].after < number:
            self._free.extend(point.place for point in self._branches.popleft().points)
        while self._first < number - _KEPT:
            self._free.append(self._points.popleft().place)
            self._first += 1

    def _read(self, first: int, count: int) -> list[float]:
        answer = self._session.query(f"P{first}..{first + count - 1}" if count > 1 else f"P{first}")
        try:
            values = [parse_number(line) for line in answer]
        except ValueError:
            values = []
        if len(values) != count:
            raise LinkLostError(f"P{first}: expected {count} numbers, got {len(answer)} lines")
        return values

    def _set(self, line: str) -> None:
        """Assign, retrying after a lost answer, which is harmless."""
        try:
            self._session.command(line)
        except OutcomeUnknownError:
            self._session.query(line)
