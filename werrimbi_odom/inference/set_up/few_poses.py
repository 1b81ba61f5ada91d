# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Set-up search with two poses per drive, or few more: enough to tell mistakes apart, not sizes.

Every set-up with at most one factor and one wiring predicts where each drive ends, with an error
of some share of each wheel's counts and the wheels' noise. A finding needs a wide likelihood
margin over all others.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.calibration_parametrisation import effective_track
from werrimbi_odom.inference.comparison.residuals import Measure
from werrimbi_odom.inference.fitting.prediction import tell_lengths
from werrimbi_odom.inference.set_up.explanation import (
    AS_ENTERED,
    Setting,
    SetUpEstimate,
    setting_of,
    wirings,
)
from werrimbi_odom.inference.set_up.findings import SetUpFinding, findings_of
from werrimbi_odom.inference.set_up.misentered_values import FACTORS
from werrimbi_odom.inference.set_up.records import Cuts, SetUpRecord, cut, ratio_of_ticks
from werrimbi_odom.inference.set_up.regression import errors, path_swept
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot

STEPS = 4000
"""Steps in all drives together, some tenths of a second each."""

SAME = 1e-6
"""Log-likelihoods that differ by rounding."""

NUDGE = 1e-6
"""Share by which a wheel is changed for a derivative."""


def is_sparse(records: Sequence[SetUpRecord], robot: Robot, measured: Measure) -> bool:
    """Whether the reference is too rare to follow the robot through its turns."""
    cuts = cut(records, robot, measured)
    return cuts.count < rules.SPARSE_CUTS * len(records) + rules.SPARSE_CUTS_MORE


def search_sparse(
    records: Sequence[SetUpRecord], robot: Robot, measured: Measure
) -> tuple[list[SetUpFinding], Setting | None]:
    """Findings; sizes are not measured, so the second value is always None."""
    cuts = _thinned(cut(records, robot, measured))
    track = effective_track(robot)
    if cuts.count == 0:
        return [], None
    drives = _Drives(cuts, track, measured == "pose")
    ticks = ratio_of_ticks(robot)
    tried = [(drives.fits(each), each) for each in _settings(ticks)]
    best = max(value for value, _ in tried)
    # Of those that predict the same, the first. Distances know sizes, and no left from right.
    setting = next(each for value, each in tried if value > best - SAME)
    more = drives.fit_of_each(setting) - drives.fit_of_each(AS_ENTERED)
    # One drive with a slip may end anywhere: without the one that says most, it must hold too.
    if more.sum() < rules.SPARSE_MARGIN or more.sum() - more.max() < rules.SPARSE_APART:
        return [], None
    if measured != "pose" and setting.wired.names():
        return [], None
    if setting.left == setting.right != 1.0 and not drives.tell_lengths():
        return [], None
    left, right, half_base, _ = setting.numbers(track)
    yaw = -float(np.angle(half_base)) if measured == "pose" else None
    estimate = SetUpEstimate(left, right, 2.0 * abs(half_base), yaw, ticks=ticks)
    ways = wirings(estimate)
    # With a mirrored reference the same signs predict something else.
    upright = [way for way in ways if not way.mirrored]
    same = [setting_of(estimate, way, track) for way in upright]
    near = (other for value, other in tried if value >= best - rules.SPARSE_APART)
    if not all(any(_alike(other, one, measured == "pose") for one in same) for other in near):
        return [], None

    def misfit(one: Setting) -> float:
        return math.exp(min((best - drives.fits(one)) / cuts.count, 50.0))

    found = findings_of(same[0], ways, misfit)
    return found, None


def _thinned(cuts: Cuts) -> Cuts:
    """Merge neighbouring steps: with so many set-ups, fine steps cost time."""
    together = max(1, cuts.left.size // STEPS)
    nodes = np.union1d(np.arange(0, cuts.left.size, together), cuts.left.size)
    nodes = np.union1d(nodes, np.concatenate([cuts.begin, cuts.end])).astype(np.intp)
    left, right = (
        np.diff(np.concatenate([[0.0], np.cumsum(side)])[nodes]) for side in (cuts.left, cuts.right)
    )
    begin, end = np.searchsorted(nodes, cuts.begin), np.searchsorted(nodes, cuts.end)
    return replace(cuts, left=left, right=right, begin=begin, end=end)


def _settings(ticks: float = 1.0) -> Iterator[Setting]:
    """All wirings, correct ones first, each with at most one factor."""
    for half_turn in (0.0, math.pi):
        for swapped in (False, True):
            for back in ((False, False), (True, False), (False, True), (True, True)):
                wired = replace(
                    AS_ENTERED.wired,
                    swapped=swapped,
                    left_reversed=back[0],
                    right_reversed=back[1],
                    yaw=half_turn,
                )
                if half_turn and swapped:
                    continue  # equals both reversed, by algebra, where the wheels count alike
                plain = replace(AS_ENTERED, wired=wired, ticks=ticks)
                yield plain
                for factor in FACTORS.values():
                    yield replace(plain, left=factor, right=factor)
                    yield replace(plain, base=factor)
                    yield replace(plain, left=factor, right=factor, base=factor)
                    if 1.0 / rules.ONE_WHEEL_FACTOR < factor < rules.ONE_WHEEL_FACTOR:
                        yield replace(plain, left=factor)
                        yield replace(plain, right=factor)


def _alike(a: Setting, b: Setting, facing: bool) -> bool:
    """Whether two set-ups have the same predictions."""
    one, other = a.numbers(1.0), b.numbers(1.0)
    if facing:
        return bool(np.allclose(one[:3], other[:3]))
    turned = np.allclose(one[:2], other[:2]) or np.allclose(one[:2], np.negative(other[:2]))
    return turned and bool(np.isclose(abs(one[2]), abs(other[2])))


@dataclass(frozen=True, slots=True)
class _Drives:
    cuts: Cuts
    track: float
    facing: bool

    def tell_lengths(self) -> bool:
        """Whether they tell both wheels' size: only if they end somewhere else."""
        cuts = self.cuts
        way = cuts.summed(0.5 * np.abs(cuts.left + cuts.right))
        return tell_lengths(np.abs(cuts.move), way)

    def fits(self, setting: Setting) -> float:
        """Log-likelihood of all drives under a set-up."""
        return float(self.fit_of_each(setting).sum())

    def fit_of_each(self, setting: Setting) -> Floats:
        """Log-likelihood of each cut: wheels off by some share, and noisy, under this set-up."""
        left, right, half_base, arm = setting.numbers(self.track)
        cuts = self.cuts
        off, of_heading = errors(cuts, left, right, half_base, arm)
        # What a share of each wheel's counts moves the end by. A robot that drives there and back
        # ends where it began with any wheels, but for noise, and tells nothing.
        turns = np.hypot(left * cuts.summed(cuts.left), right * cuts.summed(cuts.right))
        changes = [
            errors(cuts, *wheels, half_base, arm)[0] - off
            for wheels in ((left * (1.0 + NUDGE), right), (left, right * (1.0 + NUDGE)))
        ]
        moves = np.hypot(*np.abs(changes)) / NUDGE
        base = 2.0 * abs(half_base)
        ways = base * cuts.summed(np.abs(left * cuts.left) + np.abs(right * cuts.right))
        noise = rules.TYPICAL_WHEEL_NOISE * np.sqrt(ways)
        turn_noise = rules.SPARSE_TURN + noise / base
        extent = abs(half_base) * self._extent(left, right)
        move_noise = rules.SPARSE_MOVE + 0.5 * noise + turn_noise * extent
        values = []
        for share in rules.SPARSE_SHARES:
            of_turn = np.hypot(turn_noise, share * turns)
            of_move = np.hypot(move_noise, share * moves)
            if self.facing:
                value = -0.5 * np.abs(off / of_move) ** 2 - 2.0 * np.log(of_move)
                value += _log_wrapped(of_heading.real, of_turn)
            else:
                value = _log_radius(np.abs(cuts.move), np.abs(cuts.move - off), of_move)
            values.append(value)
        return max(values, key=np.sum)

    def _extent(self, left: float, right: float) -> Floats:
        """Root mean square distance of the path from each drive's start, in halves of the base."""
        path, _ = path_swept(self.cuts, left, right)
        spans = zip(self.cuts.begin.tolist(), self.cuts.end.tolist(), strict=True)
        return np.array(
            [np.sqrt(np.mean(np.abs(path[b : e + 1] - path[b]) ** 2)) for b, e in spans]
        )


def _log_radius(measured: Floats, expected: Floats, sigma: Floats) -> Floats:
    """Log-likelihood of distances, for a reference without headings."""
    return np.asarray(-0.5 * ((measured - expected) / sigma) ** 2 - np.log(sigma))


def _log_wrapped(off: Floats, sigma: Floats) -> Floats:
    """Log-likelihood of an angle: normal if narrow, uniform if wide."""
    wide = np.minimum(sigma, math.pi / math.sqrt(3.0))
    return np.asarray(-0.5 * (off / wide) ** 2 - np.log(wide))
