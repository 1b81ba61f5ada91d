# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Runs laid end to end: one array for the steps of all runs, one for their legs.

Effects work row by row, and legs only depend on their own start and end. So a session of many
drives costs as much as one long drive, without a round of numpy calls for each.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.files.mount import Mount
from werrimbi_odom.files.run import Reference
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.fitting.caches import Caches, keep_freed_memory, side_by_side
from werrimbi_odom.inference.fitting.drives_of_runs import counts_of, drive_of_runs, messages_of
from werrimbi_odom.inference.legs.gyro_bias import drifts_known
from werrimbi_odom.inference.legs.matched_run import MatchedRun, delayed, joined
from werrimbi_odom.model.drive import Drive
from werrimbi_odom.model.drive_of_run import DriveOfRun
from werrimbi_odom.model.effect import wiring_of
from werrimbi_odom.model.motion import WheelTravel
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.reference_view import View
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.model.wiring import Wiring

WORTH_COPIES = range(30_000, 250_000)
"""Numbers of steps for which whole fits are worth threads and caches of their own: an hour at 50 Hz
takes 1.4 GB so, and 1.0 GB without."""
Found = TypeVar("Found")
Values = TypeVar("Values", Floats, NDArray[np.intp])
Clocks = tuple[tuple[float, float], ...]
"""Delay [s] and clock drift [s/s] of the reference in each run."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Concatenated:
    """Several matched runs on common arrays: n steps, m legs."""

    runs: tuple[MatchedRun, ...]
    steps: NDArray[np.intp]
    """First step of each run, and the number of all steps; shape (runs + 1,)."""
    legs: NDArray[np.intp]
    """First leg of each run, and the number of all legs; shape (runs + 1,)."""
    begin: NDArray[np.intp]
    """First step of each leg, shape (m,)."""
    end: NDArray[np.intp]
    """One past the last step of each leg, shape (m,)."""
    run_of_leg: NDArray[np.intp]
    start: Floats
    """Measured pose at each leg's start, (m, 3); NaN where not measured."""
    finish: Floats
    """Measured pose at each leg's end, (m, 3)."""
    intervals: Floats
    """Reference intervals in each leg, shape (m,)."""
    duration: Floats
    """Duration of each leg, shape (m,) [s]."""
    gap: NDArray[np.bool_]
    """Legs that are gaps, as they overlap an excluded stretch; shape (m,)."""
    stepped: NDArray[np.bool_]
    """Legs with an abrupt event, whose end pose may be anything; shape (m,)."""
    finer: Concatenated | None = None
    """The same nodes in shorter legs, which these legs merge."""
    cache: Caches = field(default_factory=Caches)

    @property
    def count(self) -> int:
        """Number of legs."""
        return self.begin.size

    @property
    def step_count(self) -> int:
        """Number of steps."""
        return int(self.steps[-1])

    @property
    def data(self) -> int:
        """Number of measured coordinates at the ends of legs that are not gaps."""
        return int(np.isfinite(self.finish[~self.gap]).sum())

    @property
    def tells_noise(self) -> bool:
        """Whether there are data enough to estimate the noise; with fewer it is as given."""
        return self.data >= rules.NOISE_NUMBERS

    @property
    def channels(self) -> set[str]:
        """Extra channels that all runs have, with values and not as an empty column."""
        return set.intersection(*(set(run.channels) for run in self.runs))

    @property
    def headings_alone(self) -> bool:
        """Whether references measure headings only, as gyros do."""
        return self.cache.known("no place", lambda: not np.isfinite(self.finish[:, :2]).any())

    @property
    def positions_alone(self) -> bool:
        """Whether references measure no heading, as satellites and most cameras do."""
        return not np.isfinite(self.finish[:, 2]).any()

    @property
    def has_stamp_noise(self) -> bool:
        """Whether stamp noise is estimated: for gyros and for scans.

        A scan match states its own uncertainty, but not that of its stamp.
        """
        return self.headings_alone or self.own_axes

    @property
    def has_gyro_headings(self) -> bool:
        """Whether headings come from a gyro aligned with another reference."""
        return any(run.measured.gyro is not None for run in self.runs)

    @property
    def has_course_headings(self) -> bool:
        """Whether they were aligned with the direction of the path, so that it tells no crab."""
        return any(run.measured.by_course for run in self.runs)

    @property
    def has_coarse_counters(self) -> bool:
        """Whether the steps of a counter show from node to node."""
        return any(run.counters.are_coarse for run in self.runs)

    @property
    def own_axes(self) -> bool:
        """Whether references start in axes of their own, so that runs share no direction."""
        return any(run.measured.own_axes for run in self.runs)

    @property
    def mount(self) -> Mount | None:
        """Where transforms place the sensor; None if unknown, or not in one place in all runs."""
        places = {run.measured.mount for run in self.runs}
        return places.pop() if len(places) == 1 else None

    @property
    def of_one_rate(self) -> bool:
        """Whether no clock of a reference can gain on that of its wheels (`Reference.one_rate`)."""
        return all(run.measured.one_rate for run in self.runs)

    @property
    def shares(self) -> Floats | None:
        """Covariances of the poses at both ends of each leg, relative to usual.

        Shape (2, m, 3, 3), in the reference's axes. Stated for each pose; the unit is the largest
        typical value of a drive, which stands for all (`with_stated_noise`). Where any run states
        none, those of each run as a whole (`AlignedRun.noise_shares`); None if all are alike.
        """
        stated = [each for run in self.runs if (each := _stated(run.measured)) is not None]
        usual = [(run.sigma_xy, run.sigma_yaw) for run in self.runs]
        if len(stated) < len(self.runs) or any(None in each for each in usual):
            of_runs = np.array([run.record.noise_shares for run in self.runs])
            if (of_runs == 1.0).all():
                return None
            variance = np.square(of_runs[self.run_of_leg][:, [0, 0, 1]])[:, :, None] * np.eye(3)
            return np.stack([variance, variance])
        place, heading = np.array(usual).max(axis=0)
        unit = np.array([place, place, heading])
        return _at_both_ends(stated) / np.outer(unit, unit)

    @property
    def lost(self) -> NDArray[np.bool_]:
        """Gaps in which the reference may have lost the robot; shape (m,)."""
        return self.cache.known("lost", lambda: np.concatenate([run.lost for run in self.runs]))

    @property
    def map_growth(self) -> Floats:
        """Variances of position and heading that the map of scans walks over each leg, (m, 2).

        In the units of `shares`. Zero where a run does not state them.
        """
        walks = (
            np.zeros((run.legs + 1, 2)) if run.measured.walked is None else run.measured.walked
            for run in self.runs
        )
        growth = np.concatenate([np.diff(walk, axis=0) for walk in walks])
        growth = np.maximum(growth, 0.0)  # a new piece starts anew
        stated = [(run.sigma_xy, run.sigma_yaw) for run in self.runs]
        usual = np.array(stated, dtype=np.float64).max(axis=0)
        return np.where(np.isfinite(usual), growth / np.square(usual), 0.0)

    @property
    def drifts_known(self) -> Floats:
        """Drift of each run's gyro by its rests, and its standard deviation, (2, runs) [rad/s]."""
        rests = (run.record.at_rest for run in self.runs)
        return self.cache.known("drifts", lambda: drifts_known(list(rests)))

    @property
    def run_of_step(self) -> NDArray[np.intp]:
        """Index of the run of each step, shape (n,)."""
        return np.repeat(np.arange(len(self.runs)), np.diff(self.steps))

    @property
    def ends_at(self) -> Floats:
        """Stamp of the pose at each leg's end, shape (m,) [s]."""
        return np.concatenate([run.measured.time[1:] for run in self.runs])

    @property
    def rounding(self) -> Floats:
        """Variance of the counts' rounding at both ends of each leg, (2, m); 1 at a message."""
        return _at_both_ends([run.counters.rounding_at(run.time[run.ends]) for run in self.runs])

    @property
    def unseen(self) -> Floats:
        """What the counters did between messages, at both ends of each leg (`Counters.unseen_at`).

        Shape (2, m, 2). At the poses as they were stamped, whatever delay is tried: one for which
        it seems to be much would be preferred.
        """
        return self.cache.known(
            "unseen",
            lambda: _at_both_ends([run.counters.unseen_at(run.measured.time) for run in self.runs]),
        )

    @property
    def inside(self) -> NDArray[np.intp]:
        """Steps that belong to a leg."""
        both = zip(self.runs, self.steps, strict=False)
        return np.concatenate([np.arange(run.ends[0], run.ends[-1]) + first for run, first in both])

    def per_leg(self, values: Floats) -> Floats:
        """Sum values of all steps over each leg."""
        sums = np.concatenate([[0.0], np.cumsum(values)])
        return np.asarray(sums[self.end] - sums[self.begin])

    def seen_through(self, view: View) -> Concatenated:
        """Same legs with stamps as late as `view` says, whose values may be arrays (m,)."""
        first = self.legs[:-1]
        late = np.broadcast_arrays(view.delay, view.clock_drift, np.zeros(self.count))
        clocks = tuple(zip(late[0][first].tolist(), late[1][first].tolist(), strict=True))
        return self._by_clocks(clocks)

    def _by_clocks(self, clocks: Clocks) -> Concatenated:
        if clocks == tuple((run.delay, run.clock_drift) for run in self.runs):
            return self
        return self.cache.delayed(clocks, lambda: self._delayed(clocks))

    def _delayed(self, clocks: Clocks) -> Concatenated:
        if self.finer is None:
            both = zip(self.runs, clocks, strict=True)
            return concatenated([delayed(run, *clock) for run, clock in both])
        finer = self.finer._by_clocks(clocks)
        runs = zip(finer.runs, self.runs, strict=True)
        return concatenated([joined(fine, run.rows) for fine, run in runs], finer)

    def side_by_side(self, works: Sequence[Callable[[Concatenated], Found]]) -> list[Found]:
        """Results of independent functions of the runs, in their order.

        In threads each gets a copy of the caches, as these are of one model at a time.
        """
        if self.step_count not in WORTH_COPIES:
            return [work(self) for work in works]
        return side_by_side([partial(self._apart, work) for work in works], self.step_count)

    def _apart(self, work: Callable[[Concatenated], Found]) -> Found:
        return work(replace(self, cache=self.cache.copied()))

    def parts(self) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
        """First leg of `finer` in each leg, and one past the last; shape (m,) each."""
        assert self.finer is not None
        runs = zip(self.finer.runs, self.runs, self.finer.legs, strict=False)
        nodes = [np.searchsorted(fine.rows, run.rows) + first for fine, run, first in runs]
        begin, end = _at_both_ends(nodes)
        return begin, end

    def raw(self, robot: Robot) -> WheelTravel[Floats]:
        """Wheel travel of all steps before any effect."""
        left, right = wiring_of(robot.effects).wheels(
            *self.cache.known("counts", lambda: counts_of(self.runs))
        )
        return WheelTravel(left * robot.left_tick, right * robot.right_tick)

    def drive(self, robot: Robot) -> Drive[Floats]:
        """Inputs of the effects over the steps of all runs."""
        wiring = wiring_of(robot.effects)
        key = (*wiring, robot.left_tick, robot.right_tick, robot.track)
        return self.cache.drive(key, lambda: self._drive(robot, wiring))

    def _drive(self, robot: Robot, wiring: Wiring) -> DriveOfRun:
        messages = self.cache.known("messages", lambda: messages_of(self.runs))
        return drive_of_runs(self.runs, messages, robot, wiring)


def concatenated(runs: Sequence[MatchedRun], finer: Concatenated | None = None) -> Concatenated:
    """Lay runs end to end.

    `runs`: runs in order. `finer`: the same runs in shorter legs, from which these are `joined`.
    """
    keep_freed_memory()
    steps = np.cumsum([0, *(run.time.size - 1 for run in runs)], dtype=np.intp)
    legs = np.cumsum([0, *(run.legs for run in runs)], dtype=np.intp)
    poses = [np.stack([run.measured.x, run.measured.y, run.measured.yaw], axis=-1) for run in runs]
    nodes = [run.ends + first for run, first in zip(runs, steps, strict=False)]
    (begin, end), (start, finish) = _at_both_ends(nodes), _at_both_ends(poses)
    return Concatenated(
        runs=tuple(runs),
        steps=steps,
        legs=legs,
        begin=begin,
        end=end,
        run_of_leg=np.repeat(np.arange(len(runs)), np.diff(legs)),
        start=start,
        finish=finish,
        intervals=np.concatenate([run.intervals for run in runs]),
        duration=np.concatenate([np.diff(run.time[run.ends]) for run in runs]),
        gap=np.concatenate([run.gap for run in runs]),
        stepped=np.concatenate([run.stepped for run in runs]),
        finer=finer,
        # Inputs of effects depend only on the steps, the same in both.
        cache=Caches() if finer is None else Caches(drives=finer.cache.drives),
    )


def _stated(measured: Reference) -> Floats | None:
    """Stated covariances of poses (r, 3, 3) in the reference's axes; None if there are none."""
    if measured.covariance is not None:
        return measured.covariance
    if measured.sigma_xy is None or measured.sigma_yaw is None:
        return None
    sigmas = np.stack([measured.sigma_xy, measured.sigma_xy, measured.sigma_yaw], axis=-1)
    return np.asarray(sigmas[..., None] ** 2 * np.eye(3))


def _at_both_ends(nodes: Sequence[Values]) -> Values:
    """Values at the starts and ends of all legs, (2, m, ...), from those at each run's nodes."""
    sides = (slice(-1), slice(1, None))
    return np.stack([np.concatenate([each[side] for each in nodes]) for side in sides])
