# SPDX-License-Identifier: LGPL-2.1-or-later
"""Joint times: when a played program passes the ends of the programmed segments, found without a plan.

Input: the path of a program, a trajectory, and the knots at which both rest. Output: a time for each joint. Between
two rests the played path is as long as the programmed one, except for rounded corners: this gives an estimate for each
joint, near which the best-fitting time is searched for. Joints already found refine the estimates of their neighbours.
On a rounded corner between two feeds many times fit equally well; there the joint is passed where the tool is no faster
than the slower feed. The times need not be exact: the certificate measures the program with them, and wrong times can
only increase a deviation.
"""

from __future__ import annotations

import numpy as np

from pkm_post.certificate.played_path import PlayedPath
from pkm_post.geometry import Array, hermite_lengths, norm
from pkm_post.machine import forward
from pkm_post.model import Machine, Tolerances, Trajectory, pieces

_LOOKS = 4
"""Sampled instants of each interval."""
_REACHES = (12, 4, 48, 8, 192, 16, 768, 24)
"""Numbers of instants to search on either side of the estimate, tried in turn for joints not found yet."""
_WIDEST_FULL_SEARCH = 24
"""Beyond this reach, the search covers only joints without any match."""
_FITS = 1.5
"""Deviation by tolerance within which a joint counts as found; the certificate allows 1."""
_WELL = 0.6
"""Deviation by tolerance at which the search for a better time stops."""
_FOR_FEED = 0.95
"""Deviation by tolerance up to which a joint may be passed at another time for its feed."""
_SAVING = 8.0
"""Tolerances of way beyond which a longer segment saves no more of it by rounded corners."""
_UNSURE = 2.0
"""Tolerances by which the estimated way to a joint may be off beside short segments."""
_NEWTON_STEPS = 8
_TRIED, _TRIED_INSTANTS = 24, 12
"""Times tried on one side of a joint, closer together near it, and the sampled instants that they cover."""
_SPEEDS = 8
"""Parts of an interval at whose ends its speed is compared with a feed ..."""
_TOO_FAST = 1.005
"""... which it exceeds by more than plans do where one cubic has an even feed."""
_SPIN_COUNTS = 1e-3
"""Weight of the spin relative to the tool axis: in a pure turn about the tool axis, only the spin gives the time."""
_AT_ONCE = 1 << 18
"""Pairs of joints and instants, or times, in one pass."""


def joint_times(
    path: PlayedPath,
    trajectory: Trajectory,
    machine: Machine,
    tolerances: Tolerances,
    joints: Array,
    knots: Array,
) -> Array:
    """Times at which the end of each of the N segments is passed, (N,) s, never decreasing.

    Args:
        path: path of the program.
        trajectory: the programmed trajectory.
        machine: determines the weight of turns relative to distance.
        tolerances: the requested tolerances.
        joints: (R,) segments at whose ends both rest, ascending; the last is the last segment.
        knots: (R,) the knots of these rests.
    """
    search = _Search(path, trajectory, machine, tolerances)
    time, fit = np.full((2, len(trajectory)), np.nan)
    time[joints], fit[joints] = path.time[knots], 0.0
    for reach in _REACHES:
        rows = np.flatnonzero(~(fit <= (_WELL if reach <= _WIDEST_FULL_SEARCH else _FITS)))
        if not len(rows):
            continue
        found, by = search.look(rows, search.guess(rows, time), reach)
        better = (by <= _FITS) & ~(fit[rows] <= by)
        time[rows[better]], fit[rows[better]] = found[better], by[better]
        disorder = _disorder(time, joints)
        time[disorder] = fit[disorder] = np.nan
    missing = np.flatnonzero(np.isnan(time))
    time[missing] = search.time_of(search.guess(missing, time))
    moving = np.setdiff1d(np.arange(len(trajectory)), joints)
    time[moving] = search.settled(moving, np.maximum.accumulate(time)[moving])
    time = np.maximum.accumulate(np.clip(time, 0.0, path.time[-1]))
    time[moving] = search.balanced(moving, time)
    time[moving] = search.at_feed(moving, np.maximum.accumulate(time))
    return np.asarray(np.maximum.accumulate(time))


def _disorder(time: Array, joints: Array) -> Array:
    """Rows of times that are out of order, rests excluded."""
    known = np.flatnonzero(~np.isnan(time))
    there = time[known]
    wrong = (there < np.maximum.accumulate(there)) | (there > np.minimum.accumulate(there[::-1])[::-1])
    wrong[np.searchsorted(known, joints)] = False
    return known[wrong]


class _Search:
    """Search for joints on the path of a program."""

    def __init__(self, path: PlayedPath, trajectory: Trajectory, machine: Machine, tolerances: Tolerances) -> None:
        self._path, self._count, self._machine = path, len(path.time) - 1, machine
        turn = machine.characteristic_length
        self._sampled, self._travelled = _sampled_path(path, turn)
        turned = trajectory.angle + np.abs(np.diff(trajectory.spin, prepend=trajectory.start_spin))
        self._programmed = np.cumsum(trajectory.length + turn * turned)
        self._joint = np.vstack([trajectory.tip.T, trajectory.axis.T, trajectory.spin])
        by_tip = 1 / trajectory.tip_tolerances(tolerances.tip)
        by_axis = np.full(len(trajectory), 1 / tolerances.axis)
        way, saved = np.diff(self._programmed, prepend=0.0), np.minimum(tolerances.axis, turned)
        off = np.maximum(1 / by_tip, turn * saved)  # a segment that does not turn saves no turn
        self._way = np.maximum(way / 2, _UNSURE * off)
        self._corners = np.cumsum(np.minimum(way, _SAVING * off))  # a long line saves no more at its ends
        self._feed = trajectory.feed
        self._weight = np.vstack([by_tip, by_axis, _SPIN_COUNTS * by_axis])[[0, 0, 0, 1, 1, 1, 2]]

    def guess(self, rows: Array, time: Array) -> Array:
        """Estimated distances of joints from the start, (M,), interpolated between joints with known times."""
        known = np.flatnonzero(~np.isnan(time))
        saved = np.append(0.0, self._programmed[known] - self._length(time[known]))
        return np.asarray(
            self._programmed[rows] - np.interp(self._corners[rows], np.append(0.0, self._corners[known]), saved)
        )

    def _length(self, time: Array) -> Array:
        """Distances from the start at times."""
        return np.asarray(np.interp(self._instant_of(time), np.arange(len(self._travelled)), self._travelled))

    def _away(self, rows: Array, way: Array) -> Array:
        """Ways from joints by how far they may be off: the tool may pass there again."""
        return way / np.where(way < 0, self._way[rows], self._way[np.minimum(rows + 1, len(self._way) - 1)])

    def time_of(self, length: Array) -> Array:
        """Time at which a distance from the start is reached, s."""
        instant = np.interp(length, self._travelled, np.arange(len(self._travelled)))
        return self._time_at(*self._place(instant / _LOOKS))

    def look(self, rows: Array, guess: Array, reach: int) -> Array:
        """Times at which joints are passed, s, searched near a guess; and the deviation then by tolerance, (2, M)."""
        parts = pieces(len(rows), _AT_ONCE // (2 * reach + 1))
        return np.hstack([self._look(rows[part], guess[part], reach) for part in parts])

    def _look(self, rows: Array, guess: Array, reach: int) -> Array:
        middle = np.searchsorted(self._travelled, guess)
        shift = np.arange(-reach, reach + 1)[:, None]
        instants = np.clip(middle + shift, 0, len(self._travelled) - 1)
        off = (self._sampled[:, instants] - self._joint[:, None, rows]) * self._weight[:, None, rows]
        away = self._away(rows, self._travelled[instants] - guess)
        nearest = np.argmin(np.square(off).sum(axis=0) + np.square(away), axis=0)
        return self._closely(rows, instants[nearest, np.arange(len(rows))])

    def _closely(self, rows: Array, instant: Array) -> Array:
        """The same, refined from instants nearby by Newton's method, with steps no longer than one instant."""
        interval, share = self._place(instant / _LOOKS)
        time = self._time_at(interval, share)
        for _ in range(_NEWTON_STEPS):
            late = self._late(rows, interval, share, self._path.at(interval, share[None])[:, 0])
            longest = (self._path.time[interval + 1] - self._path.time[interval]) / _LOOKS
            time = np.clip(time - np.clip(late, -longest, longest), 0.0, self._path.time[-1])
            interval, share = self._place(self._instant_of(time) / _LOOKS)
        return np.stack([time, self._fit(rows, time)])

    def settled(self, rows: Array, time: Array) -> Array:
        """Times of joints, refined by one step to the best fit of the tool's exact poses."""
        if not len(rows):
            return time
        interval, share = self._place(self._instant_of(time) / _LOOKS)
        place = self._path.at(interval, share[None])[:, 0]
        length = hermite_lengths(*self._path.struts.cubics(interval), share[:, None])[:, 0]
        tool_length = self._path.tool_length[interval + 1]
        pose = forward(self._machine, length, tool_length, place[:3].T, place[3:6].T, place[6])
        place[:3], place[3:6] = pose.tip.T, pose.axis.T
        late = self._late(rows, interval, share, place)
        step = (self._path.time[interval + 1] - self._path.time[interval]) / _LOOKS
        return np.where(pose.converged & (np.abs(late) < step), time - late, time)

    def balanced(self, rows: Array, time: Array) -> Array:
        """Times of joints that fit badly, moved to the best of those around them.

        Newton's method takes tip and axis together; the certificate measures each by its own tolerance. And it does not
        leave a rest, which may be the instant nearest to a joint shortly before or after it: from the best time around
        it is tried again.

        Args:
            rows: (M,) segments that have a successor.
            time: (N,) times of all joints, never decreasing.
        """
        found = time[rows]
        bad = np.flatnonzero(self._fit(rows, found) > _WELL)
        if len(bad):
            tried = np.vstack([self._around(rows[bad], time, side) for side in (-1.0, 1.0)])
            away = self._away(rows[bad], self._length(tried) - self._length(found[bad]))
            best = np.argmin(np.square([self._fit(rows[bad], one) for one in tried]) + np.square(away), axis=0)
            found[bad] = tried[best, np.arange(len(bad))]
            again, fit = self._closely(rows[bad], self._instant_of(found[bad]))
            begin, end = _neighbours(rows[bad], time)
            better = (begin <= again) & (again <= end) & (fit < self._fit(rows[bad], found[bad]))
            found[bad] = np.where(better, again, found[bad])
        return found

    def _around(self, rows: Array, time: Array, side: Array | float) -> Array:
        """Times from joints onwards to a side, -1 or 1, up to their neighbours, (_TRIED + 1, M)."""
        away = _TRIED_INSTANTS * np.linspace(0.0, 1.0, _TRIED + 1)[:, None] ** 2
        instant = self._instant_of(time[rows]) + side * away
        return np.clip(self._time_at(*self._place(instant / _LOOKS)), *_neighbours(rows, time))

    def at_feed(self, rows: Array, time: Array) -> Array:
        """Times of joints, moved into the faster segment where the tool is too fast for the slower one.

        Args:
            rows: (M,) segments that have a successor.
            time: (N,) times of all joints, never decreasing.
        """
        found, changes = time[rows], np.flatnonzero(self._feed[rows] != self._feed[rows + 1])
        for part in pieces(len(changes), _AT_ONCE // _TRIED) if len(changes) else ():
            found[changes[part]] = self._at_slower_feed(rows[changes[part]], time)
        return found

    def _at_slower_feed(self, rows: Array, time: Array) -> Array:
        """The same for joints between two feeds."""
        before, after = self._feed[rows], self._feed[rows + 1]
        side, slower = np.where(before > after, 1.0, -1.0), np.minimum(before, after)
        tried = self._around(rows, time, side)
        fits = np.logical_and.accumulate([self._fit(rows, one) <= _FOR_FEED for one in tried])
        speed = np.stack([self._speed(*self._place(self._instant_of(one) / _LOOKS)) for one in tried])
        found = _last_crossing(tried, fits, speed, slower)
        knot = self._at_slower_interval(side, found, slower)
        begin, end = _neighbours(rows, time)
        return np.where((begin < knot) & (knot < end) & (self._fit(rows, knot) <= _FOR_FEED), knot, found)

    def _speed(self, interval: Array, share: Array) -> Array:
        """Speed of the tip, mm/s."""
        return norm(self._path.rates_at(interval, share)[0][:3].T)

    def _at_slower_interval(self, later: Array, time: Array, slower: Array) -> Array:
        """Times of changes of the feed, moved to the knot at which an interval begins that is too fast for the slower.

        With the change inside it, as in the plan, the certificate allows its one cubic more than with an even feed.
        """
        interval = self._place(self._instant_of(time) / _LOOKS)[0]
        beyond = np.clip(interval + later.astype(np.int64), 0, self._count - 1)
        shares = np.linspace(0.0, 1.0, _SPEEDS + 1)
        speeds = [self._speed(beyond, np.full(len(beyond), share)) for share in shares]
        too_fast = np.max(speeds, axis=0) > _TOO_FAST * slower
        knot = self._path.time[interval + (later > 0)]
        return np.where(too_fast & (beyond != interval), knot, time)

    def _fit(self, rows: Array, time: Array) -> Array:
        """Deviations of the tool from joints, by tolerance."""
        interval, share = self._place(self._instant_of(time) / _LOOKS)
        off = (self._path.at(interval, share[None])[:, 0] - self._joint[:, rows]) * self._weight[:, rows]
        return np.asarray(np.maximum(norm(off[:3].T), norm(off[3:6].T)))

    def _late(self, rows: Array, interval: Array, share: Array, place: Array) -> Array:
        """Delay, s, of a pose of an interval after the best fit to a joint, by Newton's method.

        In a sharp corner the tool turns away from the joint within a short distance, so its acceleration matters; it is
        omitted where it would lead to the farthest pose instead.
        """
        weight = self._weight[:, rows]
        off = (place - self._joint[:, rows]) * weight
        rate, bend = (one * weight for one in self._path.rates_at(interval, share))
        square = np.square(rate).sum(axis=0) + np.maximum((off * bend).sum(axis=0), 0.0)
        return np.divide((off * rate).sum(axis=0), square, out=np.zeros(len(rows)), where=square > 0)

    def _time_at(self, interval: Array, share: Array) -> Array:
        begin, end = self._path.time[interval], self._path.time[interval + 1]
        return np.asarray(begin + (end - begin) * share)

    def _place(self, at: Array) -> tuple[Array, Array]:
        interval = np.clip(np.floor(at).astype(np.int64), 0, self._count - 1)
        return interval, np.clip(at - interval, 0.0, 1.0)

    def _instant_of(self, time: Array) -> Array:
        interval = np.clip(np.searchsorted(self._path.time, time) - 1, 0, self._count - 1)
        begin, end = self._path.time[interval], self._path.time[interval + 1]
        return np.asarray(_LOOKS * (interval + (time - begin) / (end - begin)))


def _neighbours(rows: Array, time: Array) -> tuple[Array, Array]:
    """Times of the joints before and after some joints, (M,) each; before the first joint the start."""
    return time[rows - 1] * (rows > 0), time[rows + 1]


def _last_crossing(tried: Array, fits: Array, speed: Array, slower: Array) -> Array:
    """Where the tool comes down to the slower feed for the last time, or else the first time tried, (M,).

    ``tried``, ``fits`` and ``speed`` are (T, M), onwards from each joint. A crossing where the joint does not fit is
    moved back to the last time that fits.
    """
    fast, each, end = fits & (speed > slower), np.arange(len(slower)), len(tried) - 1
    last = np.where(fast.any(axis=0), end - np.argmax(fast[::-1], axis=0), 0)
    beyond = np.minimum(last + 1, end)
    drop = speed[last, each] - speed[beyond, each]
    crosses = fast[last, each] & fits[beyond, each] & (drop > 0)
    share = np.divide(speed[last, each] - slower, drop, out=np.zeros(len(slower)), where=crosses)
    return np.asarray(tried[last, each] + np.minimum(share, 1.0) * (tried[beyond, each] - tried[last, each]))


def _sampled_path(path: PlayedPath, turn: float) -> tuple[Array, Array]:
    """Even instants of all intervals, (7, S), and the way to each, (S,) mm; a radian of a turn counts as ``turn``."""
    count = len(path.time) - 1
    inside = path.at(np.arange(count), np.linspace(0.0, 1.0, _LOOKS + 1)[:, None])
    step = np.diff(inside, axis=1)  # within intervals: the tip's jump at a tool change is not distance travelled
    way = np.sqrt(np.square(step[:3]).sum(axis=0)) + turn * (
        np.sqrt(np.square(step[3:6]).sum(axis=0)) + np.abs(step[6])
    )
    place = np.hstack([inside[:, :-1].transpose(0, 2, 1).reshape(7, -1), path.place[:, -1:]])
    return place, np.append(0.0, np.cumsum(way.T))
