# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Test for circularity: a reference that follows the wheels too closely to be a measurement.

Odometry that is judged by odometry is always right. Most such references are recognised by name and
frame (`Run.circle`). Here all references are tested by their distance to the wheels' path length
between two instants. Headings refuse only what has the counts' own rounding in them, as those of a
robot's own odometry often come from a gyro. A reference that differs from the wheels by less than
any wheels' own noise is suspect.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.run import Reference, Run
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.distributions import MEDIAN_TO_SIGMA
from werrimbi_odom.inference.legs.count_interpolation import Counters, counters_of
from werrimbi_odom.inference.legs.windows import later_than_all_before
from werrimbi_odom.model.encoder_online import Counts, EncoderLimits
from werrimbi_odom.model.pose import Floats, wrap_all
from werrimbi_odom.model.robot import Robot


class Closeness(NamedTuple):
    """Agreement of path lengths between reference and wheels."""

    apart: float
    """Typical difference of path length after fitting both wheel sizes and the delay [m]."""
    way: float
    """Typical path length [m]."""
    rounding: float
    """Standard deviation of such a path length from the quantisation of the counters [m]; 0 if they
    are not quantised."""
    turns_apart: float
    """Typical difference of the turn over such a path, after fitting both wheels and the delay
    [rad]; infinite where headings are not measured."""
    turns_rounding: float
    """Standard deviation of such a turn from the quantisation of the counters [rad]; 0 if they are
    not quantised."""


def require_independent(run: Run, robot: Robot, limits: EncoderLimits | None = None) -> str:
    """Check that a run's reference is an independent measurement.

    Result: a note if its name says that it is odometry while its numbers say that it is
    independent, or if it differs from the wheels by less than any wheels' own noise; else empty.
    InputError if it is computed from the wheels.
    """
    found = None if run.reference is None else closeness(run, robot, limits)
    if found is not None and (closer := _closer_than_measured(found)):
        what = run.circle or "the reference"
        raise InputError(
            f"{run.path}: {what}: {closer}, and cannot judge them (--force takes it all the same)"
        )
    if not run.circle:
        return _words_about_closeness(run, robot, found)
    if found is not None and found.apart > rules.CIRCLE_APART:
        what = run.circle.partition(":")[0]
        return (
            f"{run.path}: {what} is called as odometry is, but is {_small(found.apart)} from the "
            f"wheels in {found.way:.2g} m: it is taken for a measurement"
        )
    close = (
        "" if found is None else f" (it is {_small(found.apart)} from them in {found.way:.2g} m)"
    )
    raise InputError(
        f"{run.path}: {run.circle}. A reference that is made from the wheels always agrees with "
        f"them{close} and shows none of their errors (--force takes it all the same)"
    )


def _words_about_closeness(run: Run, robot: Robot, found: Closeness | None) -> str:
    """Suspicion about a reference that differs from the wheels by less than wheels' own noise.

    It is no proof: a simulator's robot without noise agrees as well.
    """
    if found is None or not found.rounding:
        return ""
    along = rules.CIRCLE_WHEELS * float(np.sqrt(found.way / 2.0))
    turn = rules.CIRCLE_WHEELS * float(np.sqrt(2.0 * found.way)) / robot.track
    if found.apart >= along or (found.turns_apart >= turn and np.isfinite(found.turns_apart)):
        return ""
    turns = f" and {found.turns_apart:.2g} rad" if np.isfinite(found.turns_apart) else ""
    return (
        f"{run.path}: the reference agrees with the wheels to {_small(found.apart)}{turns} in "
        f"{found.way:.2g} m, closer than any wheels follow the floor: one was made from the other, "
        "or both from one filter (or it is a simulator's robot without noise); then it shows none "
        "of their errors"
    )


def _closer_than_measured(found: Closeness) -> str:
    """How a reference agrees with the wheels more closely than any measurement; "" if not."""
    within = f"in {found.way:.2g} m, closer than"
    if found.apart < rules.CIRCLE_EXACT * found.rounding:
        return (
            f"it agrees with the wheels to {_small(found.apart)} {within} their counts tell the "
            f"way themselves ({_small(found.rounding)}): it was made from the same counts"
        )
    if found.turns_apart < rules.CIRCLE_EXACT * found.turns_rounding:
        return (
            f"its headings agree with the wheels to {1e3 * found.turns_apart:.2g} mrad {within} "
            f"their counts tell the turn themselves ({1e3 * found.turns_rounding:.2g} mrad): it "
            "was made from the same counts"
        )
    if not found.rounding and found.apart < rules.CIRCLE_FINEST * found.way:
        return (
            f"it agrees with the wheels to {_small(found.apart)} {within} anything measures: it "
            "was made from the same angles (or is a simulator's pose without noise)"
        )
    return ""


def closeness(run: Run, robot: Robot, limits: EncoderLimits | None = None) -> Closeness | None:
    """Agreement of a reference with the wheels; None if there is too little motion to tell."""
    assert run.reference is not None
    # A reference made from the wheels has their stamps, right or wrong.
    reference = replace(run.reference, stamped_together=True)
    try:
        counters = counters_of(replace(run, reference=reference), robot, limits)
    except InputError:
        return None
    rows = _rows(reference, counters, robot)
    if rows.size <= rules.CIRCLE_FEWEST:
        return None
    ways, known = _ways(reference, rows)
    turns = wrap_all(np.diff(reference.yaw[rows]))
    turning = np.isfinite(turns)
    ticks = [robot.left_tick, robot.right_tick]
    moments = [reference.time[rows] - delay for delay in rules.CIRCLE_DELAYS]
    wheels = np.stack([np.diff(counters.at(times), axis=0) * ticks for times in moments])
    # Where it is not known, the sign of the motion is taken from the wheels.
    sign = 1.0 if known else np.where(wheels.sum(axis=-1) < 0.0, -1.0, 1.0)
    steps = _roundings(run, robot)
    # A count is as long as the reference says: the radius that was entered may be 1000 times off.
    rolled = 0.5 * float(np.abs(wheels[-1]).sum())
    half = 0.5 * float(np.abs(ways[0]).sum()) / rolled if rolled > 0.0 else 0.5
    apart, rounding = min(_residual(sign * each, wheels, steps, half) for each in ways)
    # On lines wheels in step round off the same, so only bends tell.
    rolled_apart = np.abs(np.diff(wheels[-1], axis=-1))[:, 0]
    bends, a_metre = turning & (rolled_apart > max(ticks)), 0.0
    if bends.sum() > rules.CIRCLE_FEWEST:
        turning = bends
        a_metre = float(np.abs(turns[bends]).mean() / rolled_apart[bends].mean())
    turned = np.inf, 0.0
    if turning.sum() > rules.CIRCLE_FEWEST:
        turned = _residual(turns[turning], wheels[:, turning], steps, a_metre)
    return Closeness(apart, float(np.median(np.abs(ways[0]))), rounding, *turned)


def _rows(reference: Reference, counters: Counters, robot: Robot) -> NDArray[np.intp]:
    """Reference rows at uneven intervals of some `CIRCLE_WAY`, within the ticks' time span."""
    inside = (reference.time >= counters.time[0]) & (reference.time <= counters.time[-1])
    rows: NDArray[np.intp] = np.flatnonzero(reference.has_position & inside)
    if rows.size == 0:
        return rows
    rows = rows[later_than_all_before(reference.time[rows])]
    gone = np.interp(reference.time[rows], counters.time, counters.way(robot, 1.0, np.inf))
    gone -= gone[0]
    way = min(rules.CIRCLE_WAY, float(gone[-1]) / (rules.CIRCLE_FEWEST + 2))
    if way <= 0.0:
        return rows[:1]
    # Apart by half to three halves of it: what equal parts of a steady drive round off is the same.
    number, golden = np.arange(int(gone[-1] / way) + 1), 0.5 * (math.sqrt(5.0) - 1.0)
    marks = way * (number + 0.5 * np.modf(golden * number**2)[0])  # by no period
    new = np.concatenate([[True], np.diff(np.searchsorted(marks, gone, side="right")) > 0])
    return np.asarray(rows[new])


def _ways(reference: Reference, rows: NDArray[np.intp]) -> tuple[list[Floats], bool]:
    """Path lengths from each row to the next through all poses between, and whether signed.

    Where headings are known along arcs, and in any case along chords: odometry adds up either.
    """
    every = np.flatnonzero(reference.has_position)
    x, y, yaw = (part[every] for part in (reference.x, reference.y, reference.yaw))
    steps = np.diff(x) + 1j * np.diff(y)
    chord = np.abs(steps)
    known = bool(np.isfinite(yaw).all())
    if known:
        turns = wrap_all(np.diff(yaw))
        ahead = (steps * np.exp(-1j * (yaw[:-1] + 0.5 * turns))).real
        chord = np.where(ahead < 0.0, -chord, chord)
    steps_by = [chord / np.sinc(0.5 * turns / np.pi), chord] if known else [chord]
    at = np.searchsorted(every, rows)
    return [np.diff(np.concatenate([[0.0], np.cumsum(each)])[at]) for each in steps_by], known


def _residual(ways: Floats, wheels: Floats, steps: Floats, size: float) -> tuple[float, float]:
    """Typical residual of the best wheel sizes at the best of d delays, and its rounding.

    Least absolute deviations by reweighting, of paths (n,) or (d, n) over wheels (d, n, 2). The
    rounding is that of two readings of both counters, whose steps are `steps` (2,) [m], by these
    sizes, or by `size` of both where it is less: turns of a circle go with the sum of both wheels,
    and its path with their difference as well.
    """
    ways = np.broadcast_to(ways, wheels.shape[:-1])
    weight = np.ones(ways.shape)
    digits = wheels.shape[1] * float(np.finfo(float).eps)
    for _ in range(8):
        root = np.sqrt(weight)
        sizes = np.linalg.pinv(wheels * root[..., None], rcond=digits) @ (ways * root)[..., None]
        left = np.abs(ways - (wheels @ sizes)[..., 0])
        middle = np.median(left, axis=-1, keepdims=True)
        weight = 1.0 / np.maximum(left, 1e-12 + 1e-3 * middle)
    best = int(np.argmin(middle))
    largest = [np.linalg.norm(each * steps) for each in (sizes[best, :, 0], size)]
    return float(middle[best, 0]) * MEDIAN_TO_SIGMA, float(min(largest)) / math.sqrt(6.0)


def _roundings(run: Run, robot: Robot) -> Floats:
    """Steps of both counters [m]; zero if one is not quantised."""
    found = []
    for counts, tick in ((run.ticks.left, robot.left_tick), (run.ticks.right, robot.right_tick)):
        steps = np.abs(np.diff(counts[np.isfinite(counts)]))
        found.append(_quantum(steps[steps > 0]) * tick)
    return np.array(found) if all(found) else np.zeros(2)


def _quantum(steps: Counts) -> float:
    """Common divisor of all steps of a counter; 0 if there is none."""
    if steps.size == 0:
        return 0.0
    if steps.dtype.kind == "i":
        return float(np.gcd.reduce(steps))
    sizes = np.unique(steps)
    apart = np.diff(sizes)
    apart = apart[apart > rules.CIRCLE_WHOLE * sizes[0]]  # less is the rounding of 32-bit angles
    quantum = float(min(sizes[0], apart.min(initial=np.inf)))
    few = sizes[sizes <= rules.CIRCLE_STEPS * quantum] / quantum
    whole = np.abs(few - np.rint(few)) < rules.CIRCLE_WHOLE * rules.CIRCLE_STEPS
    return quantum if few.size and whole.all() else 0.0


def _small(length: float) -> str:
    millimetres = float(f"{1e3 * length:.2g}")
    return f"{millimetres:g} mm" if length < 1.0 else f"{length:.2g} m"
