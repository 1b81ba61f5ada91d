# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Where the innovations of a model jump: the generalised likelihood ratio of a step of the pose.

Willsky and Jones, "A generalized likelihood ratio approach to the detection and estimation of jumps
in linear systems", IEEE Trans. Autom. Control 21, 1976. Each instant is asked three things: whether
the robot's pose stepped there and stayed; whether the reference erred in that pose alone; and of a
reference whose error wanders, whether that error stepped. All instants cost one pass of the filter
backwards; what the best of them explain is taken off, and the rest is asked again.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.inference.chances import chi2_above, chi2_median
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.design import Point
from werrimbi_odom.inference.fitting.filtering import Shocks
from werrimbi_odom.inference.fitting.likelihood import Innovations, innovations
from werrimbi_odom.inference.fitting.prediction import predict_all
from werrimbi_odom.inference.rules import EVENT_SLOW, MOST_EVENTS, SURE_OF_EVENT
from werrimbi_odom.model.effect import view_of
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.reference_view import View

Shape = Literal["robot", "spike", "reference"]

STRETCH = 1000
"""Legs after which the filter may start anew: a step near a stretch's end is hardly seen in it, and
a leg is one interval of the reference here."""

_HEARD = 1e-4
"""Share of a direction's information below which a step holds nothing of it."""


class Step(NamedTuple):
    """A step of the pose, along, sideways and in heading, at one leg."""

    shape: Shape
    """"robot": its pose stepped, and stayed; "spike": the reference erred in the pose at the leg's
    end alone; "reference": a reference's error that wanders stepped."""
    leg: int


@dataclass(frozen=True, slots=True)
class Steps:
    """All steps that innovations hold, fitted together."""

    runs: Concatenated
    """With a leg from each pose that was looked at to the next."""
    found: tuple[Step, ...]
    columns: Floats
    """What unit steps do to the whitened innovations, (3 m, 3 q)."""
    white: Floats
    """Innovations of unit variance, (3 m,)."""
    noise: Floats
    """Standard deviation of what each leg's end was expected at, (m, 3) [m, m, rad]."""
    scatter: Floats
    """Factor by which squares are too large in each run, (runs,)."""
    axes: Floats
    """From steps of the robot to the filter's pose, in each leg, (m, 3, 3)."""
    told: Innovations
    p_values: tuple[float, ...]
    """Of each, all that was looked at counted."""
    many: bool
    """Whether there are more than were looked for."""

    def creeping(self, leg: int) -> Floats:
        """A step that takes all the time about a leg (`EVENT_SLOW`), (3 m, 3)."""
        runs = self.runs
        own = np.flatnonzero((runs.run_of_leg == runs.run_of_leg[leg]) & ~runs.gap)
        since = np.abs(runs.ends_at[own] - runs.ends_at[leg])
        near = own[since <= max(EVENT_SLOW, 3.0 * runs.duration[leg])]
        column = self.spread(near, np.full(near.size, leg)) / near.size
        return np.asarray(column * self.told.known[leg])

    def about(self, legs: Sequence[int]) -> Floats:
        """Steps in some legs and in those next to them, each of its own size, (3 m, 3 k).

        In the axes of the first. However the step parts between them, they hold all of it. (A
        heading that nobody measures parts between none: it would be a way to one side.)
        """
        runs = self.runs
        first, last = min(legs) - 1, max(legs) + 1
        seen = self.told.known[legs[0]]
        near = [
            self.spread(np.array([leg]), np.array([legs[0]])) * (seen | (leg in legs))
            for leg in range(max(first, 0), min(last + 1, runs.count))
            if runs.run_of_leg[leg] == runs.run_of_leg[legs[0]] and not runs.gap[leg]
        ]
        return np.concatenate(near, axis=-1)

    def spread(self, legs: NDArray[np.intp], axes_of: NDArray[np.intp]) -> Floats:
        """The same unit steps in several legs, in the axes of other legs, (3 m, 3)."""
        states = 3 if self.told.ways is None else self.told.ways.carry.shape[-1]
        change = np.zeros((self.runs.count, states, 3))
        change[legs, :3] = self.axes[axes_of if self.told.ways is not None else legs]
        return np.asarray(self.told.shown(change).reshape(self.white.size, 3))


def steps_of(runs: Concatenated, point: Point) -> Steps:
    """Find the steps that a model, with its noise, does not explain.

    Parameters
    ----------
    runs
        With a leg from each pose to the next.
    """
    model = point.model
    prediction = predict_all(model, runs)
    told = innovations(
        model.robot,
        runs,
        prediction,
        point.variances,
        point.options.reference_kind,
        start_yaws=model.start_yaws,
        stretch=STRETCH,
    )
    white = told.whitened()
    shocks = told.shocks(white)
    view = _of_view(view_of(model.robot.effects), headings=runs.headings_alone)
    axes = shocks.enter[:, :3] @ view
    # The reference errs in what it measures: positions alone have no heading to err in.
    measured = axes * told.known[:, :, None]
    of_shape: dict[Shape, Floats] = {"robot": axes, "spike": measured, "reference": measured}
    shapes: tuple[Shape, ...] = ("robot",)
    if told.ways is not None and not runs.headings_alone:
        shapes += ("reference",) if point.options.reference_kind == "local_map" else ("spike",)
    tests = len(shapes) * int(told.known.any(axis=-1).sum())
    steps: list[Step] = []
    chances: list[float] = []
    columns = np.zeros((white.size, 0))
    scatter = np.ones(len(runs.runs))
    left = white
    while True:
        gains = {shape: _gain(*_asked(shape, shocks, of_shape[shape])) for shape in shapes}
        # An error in one pose alone, wherever that can be asked, is what noise makes.
        local: Shape = "spike" if shocks.both.any() else "robot"
        gain = gains.get(local) or _gain(*_asked(local, shocks, of_shape[local]))
        scatter = _scatter(runs, gain, told)
        new = _peaks(runs, gains, scatter, tests)
        if not new or len(steps) + len(new) > MOST_EVENTS:
            break
        steps += [step for step, _ in new]
        chances += [chance for _, chance in new]
        change = np.concatenate(
            [_change(step, of_shape[step.shape], shocks.enter.shape[1]) for step, _ in new],
            axis=-1,
        )
        columns = np.concatenate([columns, told.shown(change).reshape(white.size, -1)], axis=-1)
        solution = np.linalg.lstsq(columns, white.ravel(), rcond=None)[0]
        left = (white.ravel() - columns @ solution).reshape(white.shape)
        shocks = told.shocks(left)
    # What wanders shows in the rest alone: a step that is not taken off yet sways all that follows.
    scatter = np.maximum(scatter, _scatter(runs, gains["robot"], told))
    kept = _kept(runs, steps, columns, white.ravel(), scatter, tests)
    columns = columns[:, [3 * step + axis for step in kept for axis in range(3)]]
    many = bool(new) and 2 * len(kept) > MOST_EVENTS
    steps, chances = [steps[step] for step in kept], [chances[step] for step in kept]
    spread = np.diagonal(told.covariance[0], axis1=1, axis2=2)
    return Steps(
        runs,
        tuple(steps),
        columns,
        white.ravel(),
        np.sqrt(spread),
        scatter,
        axes,
        told,
        tuple(chances),
        many,
    )


def _kept(
    runs: Concatenated,
    steps: Sequence[Step],
    columns: Floats,
    white: Floats,
    scatter: Floats,
    tests: int,
) -> list[int]:
    """Indices of the steps that chance does not make, each beside all others."""
    kept = []
    covariance = np.linalg.inv(columns.T @ columns + np.eye(columns.shape[1]))
    solution = covariance @ (columns.T @ white)
    for index, step in enumerate(steps):
        own = slice(3 * index, 3 * index + 3)
        size = solution[own]
        gain = float(size @ np.linalg.solve(covariance[own, own], size))
        degrees = int((np.diag(covariance)[own] < 1.0).sum())
        gain /= scatter[runs.run_of_leg[step.leg]]
        if degrees and tests * chi2_above(gain, degrees) < SURE_OF_EVENT:
            kept.append(index)
    return kept


def _asked(shape: Shape, shocks: Shocks, axes: Floats) -> tuple[Floats, Floats]:
    """Score and information of one shape's steps in each leg, (m, 3) and (m, 3, 3)."""
    own = slice(3, 6) if shape == "reference" else slice(0, 3)
    score, known = shocks.score[:, own], shocks.known[:, own, own]
    if shape == "spike":
        both = shocks.both[:, own, own]
        follows = np.any(both != 0.0, axis=(1, 2), keepdims=True)[:, :, 0]
        score = np.where(follows, score - np.roll(score, -1, axis=0), 0.0)
        after = np.roll(known, -1, axis=0)
        known = (known + after - both - both.swapaxes(-1, -2)) * follows[..., None]
    turned = axes.swapaxes(-1, -2)
    return (turned @ score[..., None])[..., 0], turned @ known @ axes


def _gain(score: Floats, known: Floats) -> tuple[Floats, Floats]:
    """Fall of the squared innovations and its degrees of freedom, (m,) each."""
    size = np.sqrt(np.maximum(np.diagonal(known, axis1=1, axis2=2), 0.0))
    heard = size > 0.0
    unit = np.where(heard, size, 1.0)
    values, vectors = np.linalg.eigh(known / (unit[:, :, None] * unit[:, None, :]))
    kept = values > _HEARD
    shares = (vectors.swapaxes(-1, -2) @ (score / unit)[..., None])[..., 0]
    gain = np.sum(np.where(kept, shares**2 / np.where(kept, values, 1.0), 0.0), axis=-1)
    return gain, kept.sum(axis=-1).astype(np.float64)


def _scatter(runs: Concatenated, gain: tuple[Floats, Floats], told: Innovations) -> Floats:
    """By how much squares are too large in each run: by the median, which no few steps move."""
    found = np.ones(len(runs.runs))
    looked = told.known.any(axis=-1) & (gain[1] > 0)
    for index in range(found.size):
        own = looked & (runs.run_of_leg == index)
        if own.any():
            usual = gain[0][own] / chi2_median(gain[1][own])
            found[index] = max(1.0, float(np.median(usual)))
    return found


def _peaks(
    runs: Concatenated, gains: dict[Shape, tuple[Floats, Floats]], scatter: Floats, tests: int
) -> list[tuple[Step, float]]:
    """Steps better than all about them, each with how often chance makes one as good."""
    own = scatter[runs.run_of_leg]
    names = list(gains)
    every = np.stack([(gain - degrees) / own for gain, degrees in gains.values()])
    shape = np.argmax(every, axis=0)
    end = runs.ends_at
    found: list[tuple[Step, float]] = []
    for run in range(len(runs.runs)):
        legs = np.arange(runs.legs[run], runs.legs[run + 1])
        best = every[:, legs].max(axis=0)
        for leg in legs[np.argsort(-best)].tolist():
            gain, degrees = (float(part[leg]) for part in gains[names[shape[leg]]])
            chance = tests * chi2_above(gain / own[leg], degrees) if degrees else 1.0
            if chance >= SURE_OF_EVENT:
                break
            near = legs[np.abs(end[legs] - end[leg]) < 2.0 * EVENT_SLOW]
            if every[:, near].max() <= every[shape[leg], leg]:
                found.append((Step(names[shape[leg]], leg), chance))
    return found


def _change(step: Step, axes: Floats, states: int) -> Floats:
    """What a unit step does to the filter's states, (m, s, 3)."""
    change = np.zeros((axes.shape[0], states, 3))
    first = 3 if step.shape == "reference" else 0
    change[step.leg, first : first + 3] = axes[step.leg]
    if step.shape == "spike":
        change[step.leg + 1, :3] = -axes[step.leg]
    return change


def _of_view(view: View, *, headings: bool) -> Floats:
    """What the reference shows of a step of the robot (along, sideways, heading), (3, 3)."""
    cos, sin = np.cos(view.yaw), np.sin(view.yaw)
    turned = np.array([[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]])
    arm = np.array([[1.0, 0.0, -view.left], [0.0, 1.0, view.ahead], [0.0, 0.0, 1.0]])
    scale = (1.0, 1.0, view.scale) if headings else (view.scale, view.scale, 1.0)
    return np.asarray(np.diag(scale) @ turned @ arm)
