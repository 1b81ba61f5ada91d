# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Plausibility of a reference: whether it moves as a wheeled robot can.

A wheeled robot moves where it faces (nonholonomic constraint). So on straight stretches the
direction of the path is the heading, up to one constant mounting angle, and path length is that of
the wheels, up to one constant factor. What varies from stretch to stretch is not the robot's
geometry but the reference, or wheels that slipped there. Medians over short cuts are used, which
failed matches and jumps do not affect.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.files.run import Run
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.comparison.prepared_runs import PreparedRuns
from werrimbi_odom.inference.comparison.reference_remark import ReferenceRemark, Stretch
from werrimbi_odom.inference.comparison.residuals import Residual
from werrimbi_odom.inference.comparison.speeds_at_rest import speeds_at_rest
from werrimbi_odom.inference.distributions import MEDIAN_TO_SIGMA
from werrimbi_odom.inference.legs.cutting import leg_ends
from werrimbi_odom.model.effect import view_of
from werrimbi_odom.model.pose import Floats, wrap, wrap_all

_PAIRED = 100
"""Stretches of a drive whose pairwise slopes are used (Theil-Sen)."""


@dataclass(frozen=True, slots=True)
class _Stretches:
    """Stretches of all runs; arrays of shape (k,)."""

    run: NDArray[np.intp]
    begin: Floats
    end: Floats
    value: Floats
    sigma: Floats


def remarks_on(prepared: PreparedRuns) -> tuple[ReferenceRemark, ...]:
    """Anomalies of the references of some runs; none where only headings are measured.

    Uses the prepared legs and the path length by the given robot file. A wrong scale of that only
    affects the remark about the metric scale.
    """
    mount, leg = view_of(prepared.robot.effects).yaw, prepared.options.leg
    runs, cuts = list[Run](), list[_Cuts]()
    for group in prepared.groups:
        each = zip(group.index, group.plain, group.every.runs, group.own.sigma_xy, strict=True)
        for index, item, run, noise in each:
            if np.isfinite(item.measured).sum() > 1:
                length = max(rules.SUSPECT_CUT * leg, noise / rules.SUSPECT_NOISE)
                runs.append(prepared.runs[index])
                cuts.append(_cuts(item, run.gap, length, mount))
    if not runs:
        return ()
    at_rest = speeds_at_rest(prepared.runs, prepared.counters, prepared.robot)
    wander = min(rules.SUSPECT_WANDER, max(noise.wander[1] for _, noise in prepared.noises))
    return (
        *_lengths(runs, cuts, prepared.options.leg),
        *_angles(runs, cuts, prepared.options.leg, wander),
        *_metre(cuts),
        *([] if at_rest is None else [at_rest]),
    )


@dataclass(frozen=True, slots=True)
class _Cuts:
    """Nearly straight cuts of one run; arrays of shape (m,)."""

    begin: Floats
    end: Floats
    way: Floats
    """Path length by the wheels up to its end [m]."""
    share: Floats
    """Ratio of path length by reference to that by wheels, both as chords."""
    bend: Floats
    """Turn over forward travel [1/m]: a lever arm rotates and stretches the path in proportion to
    it."""
    surge: Floats
    """Gain of speed over forward travel [1/s]: a delay stretches the path in proportion to it."""
    angle: Floats
    """Angle from the measured heading to the path, reversed in backward driving [rad]; NaN if
    unknown."""
    turns: tuple[float, float]
    """Total turn over all cuts, turning ones too, by wheels and as measured, both times the sign of
    the wheels' turn."""


def _cuts(item: Residual, gap: NDArray[np.bool_], length: float, mount: float) -> _Cuts:
    """Cuts in the axes of the robot, from which the file says that the reference's are turned.

    `length`: of a cut, by the wheels [m].
    """
    rolled = np.nan_to_num(item.relative)
    forward = np.cos(mount) * rolled[:, 0] - np.sin(mount) * rolled[:, 1]
    along = np.concatenate([[0.0], np.cumsum(forward)])
    way = np.concatenate([[0.0], np.cumsum(np.hypot(rolled[:, 0], rolled[:, 1]))])
    ends = leg_ends(way, gap, length)
    way_of = np.diff(way[ends])
    ahead = np.diff(along[ends])
    speed = np.gradient(along, item.time)[ends]
    by_wheels = np.diff(np.concatenate([[0.0], np.cumsum(rolled[:, 2])])[ends])
    moved = np.diff(item.measured[ends])
    yaw = item.measured_yaw[ends] - mount
    turned = wrap_all(np.diff(yaw))
    whole = np.diff(np.concatenate([[0], np.cumsum(gap)])[ends]) == 0
    turn = np.where(np.isfinite(turned), turned, by_wheels)
    share = np.abs(moved) / np.maximum(np.abs(ahead), 1e-12)
    straight = whole & (np.abs(turn) < rules.SUSPECT_STRAIGHT) & (np.abs(ahead) > 0.5 * length)
    straight &= np.abs(ahead) > np.cos(rules.SUSPECT_STRAIGHT) * way_of  # not to and fro within it
    straight &= (share > rules.SUSPECT_STILL) & (share < 1.0 / rules.SUSPECT_STILL)
    facing = np.exp(-1j * (yaw[:-1] + 0.5 * turned))
    with np.errstate(invalid="ignore"):
        angle = np.angle(moved * np.sign(ahead) * facing)
    known = whole & np.isfinite(turned)
    sense = np.sign(by_wheels[known])
    return _Cuts(
        item.time[ends][:-1][straight],
        item.time[ends][1:][straight],
        way[ends][1:][straight],
        share[straight],
        turn[straight] / ahead[straight],
        np.diff(speed)[straight] / ahead[straight],
        angle[straight],
        (float(np.sum(sense * by_wheels[known])), float(np.sum(sense * turned[known]))),
    )


def _without(values: list[Floats], causes: list[Floats]) -> list[Floats]:
    """Values without their linear dependence on a cause, one slope by least absolute deviations."""
    cause, value = np.concatenate(causes), np.concatenate(values)
    acts = np.isfinite(value) & (np.abs(cause) > 0.0)
    if not acts.any():
        return values
    slopes = (value[acts] - np.nanmedian(value)) / cause[acts]
    order = np.argsort(slopes)
    weight = np.cumsum(np.abs(cause[acts])[order])
    slope = float(slopes[order][np.searchsorted(weight, 0.5 * weight[-1])])
    return [each - slope * own for own, each in zip(causes, values, strict=True)]


def _stretches(cuts: list[_Cuts], values: list[Floats], leg: float) -> _Stretches:
    """Medians of stretches, and their standard deviations from the dispersion of the cuts."""
    rows = []
    for causes in ([own.surge for own in cuts], [own.bend for own in cuts]):
        values = _without(values, causes)
    for run, (own, value) in enumerate(zip(cuts, values, strict=True)):
        number = np.floor(own.way / (rules.SUSPECT_STRETCH * leg)).astype(int)
        for stretch in np.unique(number):
            here = (number == stretch) & np.isfinite(value)
            count = int(here.sum())
            if count < rules.SUSPECT_CUTS:
                continue
            middle = float(np.median(value[here]))
            scatter = MEDIAN_TO_SIGMA * float(np.median(np.abs(value[here] - middle)))
            sigma = np.sqrt(0.5 * np.pi / count) * scatter  # of a median
            rows.append((run, own.begin[here][0], own.end[here][-1], middle, sigma))
    table = np.array(rows, dtype=np.float64).reshape(-1, 5)
    return _Stretches(table[:, 0].astype(np.intp), *table[:, 1:].T)


def _odd(looked: _Stretches, off: Floats, least: float) -> NDArray[np.intp]:
    """Stretches that are off by more than `least` and significantly."""
    sigma = np.maximum(looked.sigma, np.median(looked.sigma))
    return np.flatnonzero(np.abs(off) > np.maximum(least, rules.SUSPECT_SIGMA * sigma))


def _as_stretches(
    runs: list[Run], looked: _Stretches, size: Floats, rows: NDArray[np.intp]
) -> Iterator[Stretch]:
    for row in rows[np.argsort(-np.abs(size[rows]))]:
        run = runs[looked.run[row]]
        begin, end = float(looked.begin[row]), float(looked.end[row])
        yield Stretch(run.path, begin, end, float(size[row]), float(run.ticks.time[0]))


def _lengths(runs: list[Run], cuts: list[_Cuts], leg: float) -> Iterator[ReferenceRemark]:
    looked = _stretches(cuts, [own.share for own in cuts], leg)
    if looked.value.size <= rules.SUSPECT_STRETCHES:
        return
    usual = float(np.median(looked.value))
    off = looked.value / usual - 1.0
    odd = _odd(looked, off, rules.SUSPECT_SHARE)
    if odd.size >= rules.SUSPECT_STRETCHES:
        short = tuple(_as_stretches(runs, looked, off, odd))
        yield ReferenceRemark("short", float(np.median(off[odd])), usual - 1.0, short)


def _angles(
    runs: list[Run], cuts: list[_Cuts], leg: float, wander: float
) -> Iterator[ReferenceRemark]:
    """Anomalies of the headings, which are known to wander by `wander` [rad]."""
    known = [own.angle[np.isfinite(own.angle)] for own in cuts]
    if not sum(each.size for each in known):
        return
    axis = np.angle(np.mean(np.exp(1j * np.concatenate(known))))
    looked = _stretches(cuts, [wrap_all(own.angle - axis) for own in cuts], leg)
    looked = replace(looked, sigma=np.hypot(looked.sigma, wander))
    if looked.value.size <= rules.SUSPECT_STRETCHES:
        return
    usual = float(np.median(looked.value))
    off = looked.value - usual
    drift = _drifting(looked, off)
    odd = _odd(looked, off, rules.SUSPECT_ANGLE)
    if drift is not None:
        yield ReferenceRemark("apart", drift)
    elif odd.size >= rules.SUSPECT_STRETCHES:
        size = float(np.median(np.abs(off[odd])))
        yield ReferenceRemark(
            "sideways_by_place", size, 0.0, tuple(_as_stretches(runs, looked, off, odd))
        )
    mount = wrap(float(axis) + usual)
    sure = rules.SUSPECT_SIGMA * float(np.median(looked.sigma))
    if max(rules.SUSPECT_ANGLE, sure) < abs(mount) < rules.ASKEW and drift is None:
        yield ReferenceRemark("sideways", mount)


def _drifting(looked: _Stretches, off: Floats) -> float | None:
    """Largest drift of the angle over a drive [rad]; None if there is none."""
    found = []
    left = off.copy()
    for run in np.unique(looked.run):
        own = looked.run == run
        if own.sum() <= 2 * rules.SUSPECT_STRETCHES:
            continue
        time = 0.5 * (looked.begin + looked.end)[own]
        some = np.unique(np.linspace(0, time.size - 1, _PAIRED).astype(int))
        one, other = (some[index] for index in np.triu_indices(some.size, 1))
        slope = float(np.median((off[own][other] - off[own][one]) / (time[other] - time[one])))
        left[own] = off[own] - np.median(off[own]) - slope * (time - np.median(time))
        found.append(slope * float(np.ptp(time)))
    if not found:
        return None
    farthest = max(found, key=abs)
    spread, rest = (float(np.median(np.abs(each - np.median(each)))) for each in (off, left))
    sure = rules.SUSPECT_SIGMA * np.sqrt(2.0) * float(np.median(looked.sigma))
    steady = rest < rules.SUSPECT_DRIFT_LEFT * spread
    return farthest if steady and abs(farthest) > max(rules.SUSPECT_ANGLE, sure) else None


def _metre(cuts: list[_Cuts]) -> Iterator[ReferenceRemark]:
    """Radii and base off by the same factor: lengths are wrong, turns are not."""
    share = np.concatenate([own.share for own in cuts])
    by_wheels, measured = (sum(own.turns[side] for own in cuts) for side in (0, 1))
    few = share.size < rules.SUSPECT_CUTS * rules.SUSPECT_STRETCHES
    if few or by_wheels < rules.SUSPECT_TURNED:
        return
    usual = float(np.median(share))
    scatter = MEDIAN_TO_SIGMA * float(np.median(np.abs(share - usual)))
    sigma = np.sqrt(0.5 * np.pi / share.size) * scatter
    off = abs(usual - 1.0) > max(rules.SUSPECT_METRE, rules.SUSPECT_SIGMA * sigma)
    if off and abs(measured / by_wheels - 1.0) < rules.SUSPECT_TURNS_AGREE:
        yield ReferenceRemark("metre", usual - 1.0)
