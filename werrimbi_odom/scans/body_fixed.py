# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Straight lines that a lidar sees at one place before it while the room turns.

A lidar that looks down sees the floor as a straight line in its own frame, whatever its heading. A
wall turns there as the lidar turns, the other way round; and past its ends, or as the lidar turns
from it, something farther away is seen. Behind the floor there is nothing to see.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.model.pose import Floats, wrap
from werrimbi_odom.scans.limits import (
    FIXED_BEHIND,
    FIXED_BENT,
    FIXED_ECHOES,
    FIXED_SCANS,
    FIXED_SHARE,
    FIXED_SHARP,
    FIXED_SURE,
    FIXED_TURNED,
)
from werrimbi_odom.scans.matching import MAD
from werrimbi_odom.scans.sweep import Sweep

_BESIDE, _FLAT = 4, 0.2
"""Echoes on each side of one that tell the direction of a line through it, and the largest ratio of
their standard deviations across and along it."""
_THINNED, _CANDIDATES = 4, 6
"""Candidates are sought in every fourth scan, and so many tried: before the floor come the walls
along a corridor, and the fronts of its cupboards."""
_TURN, _RATIO, _NEAREST = np.radians(5.0), 0.06, 0.05
"""Cells in which candidates are counted: of the direction [rad], and of the distance, a share of
it, from the nearest on [m]."""
_SIGMAS = 4.0
"""Of a line's echoes, that are counted as on it."""
_TAILS = 0.1
"""Share of a line's echoes at each end that tell nothing of it. With them the wall behind cupboards
along a corridor seemed to turn by 0.1 to 0.5 of what it did, without them by 0.75 to 1."""
_HOLE, _STEP = 3, 0.3
"""Scans without the line, and turn [rad] from one to the next, that end a run of scans."""


@dataclass(frozen=True)
class FixedLine:
    """A straight line at rest in the lidar's frame."""

    bearing: float
    """Direction from the lidar to its nearest point [rad]."""
    distance: float
    """To there [m]."""
    within: float
    """Distance from the line up to which an echo is one of it [m]."""

    def has(self, points: Floats) -> NDArray[np.bool_]:
        """Which of the echoes (k, 2) are of this line, shape (k,)."""
        beyond = points @ [np.cos(self.bearing), np.sin(self.bearing)] - self.distance
        return np.asarray(np.abs(beyond) < self.within)


def fixed_line(sweeps: Sequence[Sweep], yaw: Floats, piece: Floats) -> FixedLine | None:
    """The line that stays before the lidar while the room turns; None if none does for sure.

    Parameters
    ----------
    sweeps : sequence of Sweep
        Of a lidar that moves; n of them, in the order of time.
    yaw, piece : ndarray, shape (n,)
        Its headings [rad], and the number of the unbroken piece of each.
    """
    if len(sweeps) < FIXED_SCANS:
        return None
    points = np.concatenate([sweep.points for sweep in sweeps])
    scan = np.repeat(np.arange(len(sweeps)), [len(sweep.points) for sweep in sweeps])
    for bearing, distance in _candidates(points, scan):
        found = _Sharpened.about(points, bearing, distance)
        if found and found.nothing_behind(points) and found.stays(scan, yaw, piece):
            return found.line
    return None


def _candidates(points: Floats, scan: NDArray[np.intp]) -> Iterator[tuple[float, float]]:
    """Directions and distances of lines that many scans have, most first."""
    some = scan % _THINNED == 0
    (x, y), scan = points[some].T, scan[some]
    sums = np.cumsum([x, y, x * x, x * y, y * y], axis=1)
    sums = np.concatenate([np.zeros((5, 1)), sums], axis=1)
    at = np.arange(_BESIDE, x.size - _BESIDE)
    at = at[scan[at - _BESIDE] == scan[at + _BESIDE]]
    mean = (sums[:, at + _BESIDE + 1] - sums[:, at - _BESIDE]) / (2 * _BESIDE + 1)
    xx, xy, yy = mean[2:] - mean[[0, 0, 1]] * mean[[0, 1, 1]]
    apart, both = np.hypot(0.5 * (xx - yy), xy), 0.5 * (xx + yy)
    bearing = 0.5 * np.arctan2(2.0 * xy, xx - yy) + 0.5 * np.pi
    distance = np.cos(bearing) * mean[0] + np.sin(bearing) * mean[1]
    bearing = (bearing + np.pi * (distance < 0.0)) % (2.0 * np.pi)
    distance = np.abs(distance)
    kept = (both - apart < _FLAT**2 * (both + apart)) & (distance > _NEAREST)
    bearing, distance, scan = bearing[kept], distance[kept], scan[at][kept]
    if not scan.size:
        return
    around = round(2.0 * np.pi / _TURN)
    rows = (bearing / _TURN).astype(np.intp) % around
    columns = (np.log(distance / _NEAREST) / _RATIO).astype(np.intp)
    shape = int(scan.max()) + 1, around, int(columns.max()) + 2
    held = np.zeros(shape, dtype=bool)  # each scan has one vote for a cell
    held[scan, rows, columns] = True
    votes = held.sum(axis=0)
    votes = votes + np.roll(votes, -1, axis=0)  # a line may lie on a border
    votes[:, :-1] += votes[:, 1:].copy()
    for _ in range(_CANDIDATES):
        row, column = np.unravel_index(int(np.argmax(votes)), votes.shape)
        if votes[row, column] * _THINNED < FIXED_SCANS:
            return
        of = ((rows - row) % around < 2) & (columns >= column) & (columns < column + 2)
        whole = np.angle(np.exp(1j * (bearing[of] - row * _TURN)))
        yield row * _TURN + float(np.median(whole)), float(np.median(distance[of]))
        near = np.arange(-2, 3)
        votes[np.ix_((row + near) % around, np.clip(column + near, 0, shape[2] - 1))] = 0


@dataclass(frozen=True, eq=False)
class _Sharpened:
    """A line through all echoes near a candidate, without its ends."""

    line: FixedLine
    on: NDArray[np.intp]
    """Which echoes are on it."""
    along: Floats
    across: Floats
    """Where they are, along it, and beyond it [m]."""

    @classmethod
    def about(cls, points: Floats, bearing: float, distance: float) -> _Sharpened | None:
        """The line; None if its echoes are no line, but fill the space about it."""
        widest = within = max(_NEAREST, _RATIO * distance)
        for last in (False, False, True):
            cos, sin = np.cos(bearing), np.sin(bearing)
            beyond = points @ [cos, sin] - distance
            on = np.flatnonzero(np.abs(beyond) < within)
            if on.size < FIXED_SCANS * FIXED_ECHOES:
                return None
            along, across = points[on] @ [-sin, cos], beyond[on]
            if last:
                break
            weight = 1.0 / (1.0 + (across / (0.5 * within)) ** 2)
            slope, ahead = np.polyfit(along, across, 1, w=weight).tolist()
            off = float(np.median(np.abs(across - slope * along - ahead)))
            if off > FIXED_SHARP * widest:
                return None
            bearing, distance = bearing - np.arctan(slope), distance + ahead
            within = min(max(_SIGMAS * MAD * off, 0.2 * widest), widest)
        # Far along a wall that is askew a little, other things come near the line.
        inner = np.quantile(along, [_TAILS, 1.0 - _TAILS])
        kept = (along >= inner[0]) & (along <= inner[1])
        line = FixedLine(wrap(bearing), float(distance), within)
        return cls(line, on[kept], along[kept], across[kept])

    def nothing_behind(self, points: Floats) -> bool:
        """Whether the line is straight, and hides what is behind it."""
        line = self.line
        ends = self.along.min(), self.along.max()
        bent = np.polyfit(self.along, self.across, 2)[0] * (0.5 * (ends[1] - ends[0])) ** 2
        if abs(bent) > FIXED_BENT * line.within:
            return False
        cos, sin = np.cos(line.bearing), np.sin(line.bearing)
        ahead, aside = points @ [cos, sin], points @ [-sin, cos]
        behind = ahead > line.distance + line.within
        aside, ahead = aside[behind] * line.distance, ahead[behind]
        hidden = (aside > ends[0] * ahead) & (aside < ends[1] * ahead)
        return bool(np.count_nonzero(hidden) < FIXED_BEHIND * self.on.size)

    def stays(self, scan: NDArray[np.intp], yaw: Floats, piece: Floats) -> bool:
        """Whether its direction stays, for sure, while the heading changes."""
        of = scan[self.on]
        count, *sums = (
            np.bincount(of, weight, yaw.size)
            for weight in (None, self.along, self.across, self.along**2, self.along * self.across)
        )
        seen = count[count >= FIXED_ECHOES]
        if seen.size < FIXED_SCANS:
            return False
        rows = np.flatnonzero(count >= max(FIXED_ECHOES, FIXED_SHARE * float(np.median(seen))))
        if rows.size < FIXED_SCANS:
            return False
        count, (x, y, xx, xy) = count[rows], np.array(sums)[:, rows] / count[rows]
        length = xx - x * x
        turned, weight = (xy - x * y) / length, count * length
        heading, piece = yaw[rows], piece[rows]
        new = (np.diff(rows) > _HOLE) | (np.abs(np.diff(heading)) > _STEP) | (np.diff(piece) != 0)
        run = np.concatenate([[0], np.cumsum(new)])
        whole = np.bincount(run, weight)

        def about_mean(value: Floats) -> Floats:
            return np.asarray(value - (np.bincount(run, weight * value) / whole)[run])

        turned, heading = about_mean(turned), about_mean(heading)
        square = float((weight * heading**2).sum())
        free = rows.size - int(run[-1]) - 2
        if square < FIXED_TURNED**2 * weight.sum() or free < FIXED_SCANS // 2:
            return False
        share = float((weight * turned * heading).sum()) / square
        off = turned - share * heading
        sure = np.sqrt(float((weight * off**2).sum()) / free / square)
        return bool(share + FIXED_SURE * sure < 0.5)
