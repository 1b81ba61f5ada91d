# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Ticks and reference poses brought onto common nodes, and the run cut into legs.

A reference pose falls between two tick messages. The steps are split there, in counts, in
proportion to time: splitting a step of constant twist changes neither its motion nor its noise.
Everything that is fitted later (radii, separation, effects, noise) acts on these counts, so this is
done once for a run, and again only where the reference's clock is shifted.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.run import Reference, Run
from werrimbi_odom.model.drive import Span
from werrimbi_odom.model.encoder import EncoderLimits
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.recorded_counts import wheel_steps
from werrimbi_odom.model.robot import Robot

FEW = 10
"""Reference poses: of fewer, those count too that lie just outside the ticks' time."""

MOMENT = 1.0
"""How far outside [s]."""

PARTS_OF_A_LEG = 4
"""Fits use legs this much shorter than those that are judged: they tell noise from drift."""

QUARTER_TURN = 0.5 * np.pi
"""Turning [rad] that is worth a leg of path, whatever the leg's length."""


@dataclass(frozen=True, slots=True)
class Counters:
    """What the encoders counted up to each accepted message; arrays of shape (k,)."""

    time: Floats
    """[s]"""
    left: Floats
    """Counts since the first message."""
    right: Floats
    first_left: float
    """The counter itself at the first message."""
    first_right: float
    channels: Mapping[str, Floats] = field(default_factory=dict)
    """Extra measured channels at each message."""
    _curve: list[Any] = field(default_factory=list, repr=False, compare=False)
    """What `at` has laid through the counts, once somebody asked."""

    def at(self, time: Floats) -> Floats:
        """Counts at any times, (n, 2): left and right.

        Between two messages the wheels follow a monotone cubic: a straight line would cut the
        corners of every start and stop, by a millimetre where a robot that brakes at 1 m/s² is read
        at 10 Hz, while a smoother curve would swing beyond what was counted. Before the first
        message and after the last the robot stands.
        """
        if not self._curve:
            from scipy.interpolate import PchipInterpolator

            counts = np.stack([self.left, self.right], axis=-1)
            self._curve.append(PchipInterpolator(self.time, counts))
        within = np.clip(time, self.time[0], self.time[-1])
        return np.asarray(self._curve[0](within))


@dataclass(frozen=True, slots=True)
class MatchedRun:
    """One run on common nodes: n steps, m legs."""

    name: str
    counters: Counters
    measured: Reference
    """Reference poses at the legs' ends, shape (m + 1,)."""
    intervals: Floats
    """Reference intervals in each leg, shape (m,): an incremental reference errs at each."""
    sigma_xy: float | None
    """Noise of the reference's position as the record states it [m]."""
    sigma_yaw: float | None
    """Noise of the reference's heading as the record states it [rad]."""
    delay: float
    """What the reference stamps t is taken to have been seen at t - delay [s]."""
    time: Floats
    """Stamps of the nodes, shape (n + 1,), [s]."""
    left: Floats
    """Counts of the left wheel in each step, shape (n,)."""
    right: Floats
    """Counts of the right wheel in each step, shape (n,)."""
    ends: NDArray[np.intp]
    """Nodes at which legs begin and end, shape (m + 1,)."""
    channels: Mapping[str, Span[Floats]]
    """Extra measured channels, at the start and end of each step."""

    @property
    def legs(self) -> int:
        """Number of legs."""
        return self.ends.size - 1


def match(
    run: Run,
    robot: Robot,
    leg: float = 1.0,
    limits: EncoderLimits | None = None,
    turn: float = QUARTER_TURN,
) -> MatchedRun:
    """Split the steps of a run at its reference poses and cut it into legs.

    Parameters
    ----------
    robot : Robot
        Its travel decides where legs end; they stay there whatever is fitted later.
    leg : float
        Length of a leg [m]. A leg is at least one interval of the reference.
    turn : float
        Turning on the spot that makes a leg too [rad]; path and turning add up.

    Raises
    ------
    InputError
        When the run has no reference, or none while the ticks were recorded.
    """
    counters, usable, reference = _common(run, robot, limits)
    chosen = _leg_ends(robot, counters, reference.time[usable], leg, turn)
    return _matched(run, counters, reference, usable[chosen], np.diff(chosen))


def match_finely(
    runs: Sequence[Run], robot: Robot, leg: float, limits: EncoderLimits | None = None
) -> list[MatchedRun]:
    """Runs in the short legs of a fit, `leg` [m] being the length that is judged by."""
    turn = QUARTER_TURN / PARTS_OF_A_LEG
    return [match(run, robot, leg / PARTS_OF_A_LEG, limits, turn) for run in runs]


def cut_finely(every: MatchedRun, robot: Robot, leg: float) -> MatchedRun:
    """A run from `every_pose` in the same short legs."""
    return cut(every, robot, leg / PARTS_OF_A_LEG, QUARTER_TURN / PARTS_OF_A_LEG)


def stated(runs: Sequence[MatchedRun], name: str) -> float | None:
    """The reference's noise (`sigma_xy` or `sigma_yaw`) as the records state it, if all do."""
    values = [getattr(run, name) for run in runs]
    return None if any(value is None for value in values) else float(max(values))


def every_pose(run: Run, robot: Robot, limits: EncoderLimits | None = None) -> MatchedRun:
    """A run with a leg from each usable reference pose to the next, to be `cut` to any length.

    Raises
    ------
    InputError
        As `match`.
    """
    counters, usable, reference = _common(run, robot, limits)
    return _matched(run, counters, reference, usable, np.ones(usable.size - 1))


def cut(
    every: MatchedRun, robot: Robot, leg: float = 1.0, turn: float = QUARTER_TURN
) -> MatchedRun:
    """The same run in legs of a length; `match` does both at once."""
    measured = every.measured
    chosen = _leg_ends(robot, every.counters, measured.time, leg, turn)
    time, left, right, ends, channels = _nodes(every.counters, measured.time[chosen])
    return replace(
        every,
        measured=Reference(
            measured.time[chosen], measured.x[chosen], measured.y[chosen], measured.yaw[chosen]
        ),
        intervals=np.diff(chosen).astype(np.float64),
        time=time,
        left=left,
        right=right,
        ends=ends,
        channels=channels,
    )


def delayed(run: MatchedRun, delay: float) -> MatchedRun:
    """The same legs, when the reference saw at t - `delay` [s] what it stamps t."""
    if delay == run.delay:
        return run
    counters = run.counters
    seen = np.clip(run.measured.time - delay, counters.time[0], counters.time[-1])
    time, left, right, ends, channels = _nodes(counters, np.maximum.accumulate(seen))
    return replace(
        run, delay=delay, time=time, left=left, right=right, ends=ends, channels=channels
    )


def _matched(
    run: Run,
    counters: Counters,
    reference: Reference,
    rows: NDArray[np.intp],
    intervals: NDArray[np.generic],
) -> MatchedRun:
    """The run with a leg from each of the reference's chosen rows to the next."""
    measured = Reference(
        reference.time[rows], reference.x[rows], reference.y[rows], reference.yaw[rows]
    )
    time, left, right, ends, channels = _nodes(counters, measured.time)
    return MatchedRun(
        run.name,
        counters,
        measured,
        intervals.astype(np.float64),
        _typical(reference.sigma_xy),
        _typical(reference.sigma_yaw),
        0.0,
        time,
        left,
        right,
        ends,
        channels,
    )


def _common(
    run: Run, robot: Robot, limits: EncoderLimits | None
) -> tuple[Counters, NDArray[np.intp], Reference]:
    """What the encoders counted, and the rows of the reference within that time."""
    reference = run.reference
    if reference is None:
        raise InputError(
            f"{run.path}: there is no reference to compare with "
            "(reference.csv: t_s,x_m,y_m,yaw_rad)"
        )
    counters = _counters(run, robot, limits)
    usable = _usable(reference, float(counters.time[0]), float(counters.time[-1]))
    if usable.size < 2:
        raise InputError(
            f"{run.path}: fewer than two reference poses between the first tick "
            f"(t_s {counters.time[0]:g}) and the last ({counters.time[-1]:g}); "
            "are both clocks the same?"
        )
    return counters, usable, reference


def _counters(run: Run, robot: Robot, limits: EncoderLimits | None) -> Counters:
    ticks = run.ticks
    steps = wheel_steps(robot, ticks.time, ticks.left, ticks.right, limits)
    if steps.first_row < 0 or steps.time.size == 0:
        raise InputError(f"{run.path}: fewer than two usable rows of ticks")
    time = np.concatenate([ticks.time[[steps.first_row]], steps.time])
    if not (np.diff(time) > 0.0).all():
        raise InputError(
            f"{run.path}: the ticks' clock was set back in mid-run; cut the run there into two"
        )
    rows = np.concatenate([[steps.first_row], steps.row])
    return Counters(
        time,
        _summed(steps.left / robot.left_tick),
        _summed(steps.right / robot.right_tick),
        float(ticks.left[steps.first_row]),
        float(ticks.right[steps.first_row]),
        {name: np.asarray(values)[rows] for name, values in ticks.channels.items()},
    )


def _nodes(
    counters: Counters, at: Floats
) -> tuple[Floats, Floats, Floats, NDArray[np.intp], Mapping[str, Span[Floats]]]:
    """Nodes at every message and at the times `at`, and the counts between them."""
    time = np.union1d(counters.time, at)
    left, right = np.diff(counters.at(time), axis=0).T
    channels = {}
    for name, values in counters.channels.items():
        known = np.isfinite(values)
        if known.any():
            there = np.interp(time, counters.time[known], values[known])
            channels[name] = Span(there[:-1], there[1:])
    return time, left, right, np.searchsorted(time, at), channels


def _summed(steps: Floats) -> Floats:
    return np.concatenate([[0.0], np.cumsum(steps)])


def _usable(reference: Reference, first: float, last: float) -> NDArray[np.intp]:
    """Rows with something measured, in the ticks' time, each later than the one before."""
    known = (np.isfinite(reference.x) & np.isfinite(reference.y)) | np.isfinite(reference.yaw)
    within = known & (reference.time >= first) & (reference.time <= last)
    if within.sum() < FEW:
        # Where a robot was put down and where it was found, by tape: it stood a moment before the
        # first tick and after the last.
        within = known & (reference.time >= first - MOMENT) & (reference.time <= last + MOMENT)
    rows = np.flatnonzero(within)
    if rows.size == 0:
        return rows
    latest = np.maximum.accumulate(reference.time[rows])
    later = np.concatenate([[True], reference.time[rows][1:] > latest[:-1]])
    return np.asarray(rows[later])


def _leg_ends(
    robot: Robot, counters: Counters, at: Floats, leg: float, turn: float
) -> NDArray[np.intp]:
    """Indices into `at` at which legs end: every time a leg's worth of travel has gone by."""
    left, right = (
        np.diff(counters.left) * robot.left_tick,
        np.diff(counters.right) * robot.right_tick,
    )
    path = np.abs(0.5 * (left + right)) / leg
    turned = np.abs(right - left) / robot.track / turn
    progress = np.interp(at, counters.time, _summed(path + turned))
    progress -= progress[0]
    rounding = 1e-12 * max(float(progress[-1]), 1.0)
    done = np.floor(progress + rounding)  # whole legs so far: no list of them, were they a billion
    ends = np.concatenate([[0], np.flatnonzero(np.diff(done) > 0.0) + 1])
    if ends.size == 1:  # a run shorter than a leg is one leg
        ends = np.array([0, at.size - 1])
    return ends


def _typical(sigma: Floats | None) -> float | None:
    """Root mean square of a stated noise, or None where there is none."""
    if sigma is None or not np.isfinite(sigma).any():
        return None
    return float(np.sqrt(np.nanmean(np.square(sigma))))
