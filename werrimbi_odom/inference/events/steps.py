# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Detection of steps in the innovations of a model, by the generalised likelihood ratio.

Each instant is tested for three hypotheses: the robot's pose stepped there and stayed; the
reference erred in that pose alone; or, for a reference with correlated errors, its error stepped.
All instants together cost one backward pass of the filter. The best steps are subtracted, and the
search is repeated on the remainder.

Source: Willsky and Jones, "A generalized likelihood ratio approach to the detection and estimation
of jumps in linear systems", IEEE Trans. Autom. Control 21, 1976.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.distributions import chi2_median, chi2_survival
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.filtering import Shocks
from werrimbi_odom.inference.fitting.leg_loop import lever_of
from werrimbi_odom.inference.fitting.likelihood import Innovations, innovations
from werrimbi_odom.inference.fitting.prediction import predict_all
from werrimbi_odom.inference.fitting.whitened_innovations import Point
from werrimbi_odom.model.effect import view_of
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.reference_view import View

Shape = Literal["robot", "spike", "reference"]

STRETCH = 1000
"""Legs after which the filter may restart: a step near the end of a block is hardly observable in
it, and a leg is one interval of the reference here."""

_HEARD = 1e-4
"""Share of a direction's information below which a step does not determine it."""


class PoseStep(NamedTuple):
    """A step of the pose, along, sideways and in heading, at one leg."""

    shape: Shape
    """"robot": the robot's pose stepped, and stayed; "spike": the reference erred in the pose at
    the leg's end alone; "reference": the correlated error of the reference stepped."""
    leg: int


@dataclass(frozen=True, slots=True)
class Steps:
    """All steps found in the innovations, fitted together."""

    runs: Concatenated
    """The runs, with a leg from each examined pose to the next."""
    found: tuple[PoseStep, ...]
    columns: Floats
    """Change of the whitened innovations for unit steps, (3 m, 3 q)."""
    white: Floats
    """Whitened innovations, (3 m,)."""
    noise: Floats
    """Standard deviation of the predicted end of each leg, (m, 3) [m, m, rad]."""
    scatter: Floats
    """Dispersion of the innovations in each run, (runs,)."""
    axes: Floats
    """Map from steps of the robot to the filter's pose, for each leg, (m, 3, 3)."""
    innovations: Innovations
    p_values: tuple[float, ...]
    """P-value of each step, corrected for all steps tested (Bonferroni)."""
    many: bool
    """Whether there are more than the search allows."""

    def creeping(self, leg: int) -> Floats:
        """A slow drift about a leg (over `EVENT_SLOW`) in place of a step, (3 m, 3)."""
        runs = self.runs
        own = np.flatnonzero((runs.run_of_leg == runs.run_of_leg[leg]) & ~runs.gap)
        since = np.abs(runs.ends_at[own] - runs.ends_at[leg])
        near = own[since <= max(rules.EVENT_SLOW, 3.0 * runs.duration[leg])]
        column = self.spread(near, np.full(near.size, leg)) / near.size
        return np.asarray(column * self.innovations.known[leg])

    def about(self, legs: Sequence[int]) -> Floats:
        """Steps in some legs and their neighbours, each of its own size, (3 m, 3 k).

        In the axes of the first leg. However the error is divided between them, their sum is all of
        it. (An unmeasured heading is not divided: that would be a sideways motion.) A neighbour in
        which the robot stepped by itself, as it may between rare poses, is left to that step.
        """
        runs = self.runs
        first, last = min(legs) - 1, max(legs) + 1
        seen = self.innovations.known[legs[0]]
        others = {step.leg for step in self.found if step.shape == "robot"}.difference(legs)
        near = [
            self.spread(np.array([leg]), np.array([legs[0]])) * (seen | (leg in legs))
            for leg in range(max(first, 0), min(last + 1, runs.count))
            if runs.run_of_leg[leg] == runs.run_of_leg[legs[0]]
            and not runs.gap[leg]
            and leg not in others
        ]
        return np.concatenate(near, axis=-1)

    def spread(self, legs: NDArray[np.intp], axes_of: NDArray[np.intp]) -> Floats:
        """Equal unit steps in several legs, in the axes of other legs, (3 m, 3)."""
        states = 3 if self.innovations.ways is None else self.innovations.ways.carry.shape[-1]
        change = np.zeros((self.runs.count, states, 3))
        change[legs, :3] = self.axes[axes_of if self.innovations.ways is not None else legs]
        return np.asarray(self.innovations.shown(change).reshape(self.white.size, 3))


def steps_of(runs: Concatenated, point: Point) -> Steps:
    """Find the steps that a model, with its noise, does not explain.

    `runs`: runs with a leg from each pose to the next. `point`: the model with its noise.
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
    moves = (shocks.enter[:, :3] @ prediction.relative[..., None])[..., 0]
    onward = np.roll(lever_of(moves), -1, axis=0)  # over the leg after each
    # The reference errs only in what it measures: positions alone have no heading error.
    measured = axes * told.known[:, :, None]
    of_shape: dict[Shape, Floats] = {"robot": axes, "spike": measured, "reference": measured}
    shapes: tuple[Shape, ...] = ("robot",)
    if told.ways is not None and not runs.headings_alone:
        shapes += ("reference",) if point.options.reference_kind == "local_map" else ("spike",)
    tests = len(shapes) * int(told.known.any(axis=-1).sum())
    steps: list[PoseStep] = []
    chances: list[float] = []
    columns = np.zeros((white.size, 0))
    scatter = np.ones(len(runs.runs))
    left = white
    while True:
        gains = {shape: _gain(*_asked(shape, shocks, of_shape[shape], onward)) for shape in shapes}
        # The noise is that of an error in one pose alone, wherever that can be tested.
        local: Shape = "spike" if shocks.both.any() else "robot"
        gain = gains.get(local) or _gain(*_asked(local, shocks, of_shape[local], onward))
        scatter = _scatter(runs, gain, told)
        new = _peaks(runs, gains, scatter, tests)
        if not new or len(steps) + len(new) > rules.MOST_EVENTS:
            break
        steps += [step for step, _ in new]
        chances += [chance for _, chance in new]
        change = np.concatenate(
            [_change(step, of_shape[step.shape], onward, shocks.enter.shape[1]) for step, _ in new],
            axis=-1,
        )
        columns = np.concatenate([columns, told.shown(change).reshape(white.size, -1)], axis=-1)
        solution = np.linalg.lstsq(columns, white.ravel(), rcond=None)[0]
        left = (white.ravel() - columns @ solution).reshape(white.shape)
        shocks = told.shocks(left)
    # The dispersion comes from the remainder: a step not yet subtracted affects all that follows.
    scatter = np.maximum(scatter, _scatter(runs, gains["robot"], told))
    kept = _kept(runs, steps, columns, white.ravel(), scatter, tests)
    columns = columns[:, [3 * step + axis for step in kept for axis in range(3)]]
    # More at once than are looked for at all: none of them was taken.
    many = bool(new) and (not steps or 2 * len(kept) > rules.MOST_EVENTS)
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
    steps: Sequence[PoseStep],
    columns: Floats,
    white: Floats,
    scatter: Floats,
    tests: int,
) -> list[int]:
    """Indices of the steps that are significant beside all others."""
    kept = []
    covariance = np.linalg.inv(columns.T @ columns + np.eye(columns.shape[1]))
    solution = covariance @ (columns.T @ white)
    for index, step in enumerate(steps):
        own = slice(3 * index, 3 * index + 3)
        size = solution[own]
        gain = float(size @ np.linalg.solve(covariance[own, own], size))
        degrees = int((np.diag(covariance)[own] < 1.0).sum())
        gain /= scatter[runs.run_of_leg[step.leg]]
        if degrees and tests * chi2_survival(gain, degrees) < rules.SURE_OF_EVENT:
            kept.append(index)
    return kept


def _asked(shape: Shape, shocks: Shocks, axes: Floats, onward: Floats) -> tuple[Floats, Floats]:
    """Score and information of the steps of one shape in each leg, (m, 3) and (m, 3, 3)."""
    own = slice(3, 6) if shape == "reference" else slice(0, 3)
    score, known = shocks.score[:, own], shocks.known[:, own, own]
    if shape == "spike":
        # What the robot would have carried on of it is taken back: nothing but the reference erred.
        back = onward.swapaxes(-1, -2)
        both = shocks.both[:, own, own] @ onward
        follows = np.any(both != 0.0, axis=(1, 2), keepdims=True)[:, :, 0]
        score = score - (back @ np.roll(score, -1, axis=0)[..., None])[..., 0]
        score = np.where(follows, score, 0.0)
        after = back @ np.roll(known, -1, axis=0) @ onward
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
    """Dispersion of the innovations in each run, by the median, which a few steps do not move."""
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
) -> list[tuple[PoseStep, float]]:
    """Local maxima of the significant steps, each with its corrected p-value."""
    own = scatter[runs.run_of_leg]
    names = list(gains)
    every = np.stack([(gain - degrees) / own for gain, degrees in gains.values()])
    shape = np.argmax(every, axis=0)
    end = runs.ends_at
    found: list[tuple[PoseStep, float]] = []
    for run in range(len(runs.runs)):
        legs = np.arange(runs.legs[run], runs.legs[run + 1])
        best = every[:, legs].max(axis=0)
        for leg in legs[np.argsort(-best)].tolist():
            gain, degrees = (float(part[leg]) for part in gains[names[shape[leg]]])
            chance = tests * chi2_survival(gain / own[leg], degrees) if degrees else 1.0
            if chance >= rules.SURE_OF_EVENT:
                break
            near = legs[np.abs(end[legs] - end[leg]) < 2.0 * rules.EVENT_SLOW]
            if every[:, near].max() <= every[shape[leg], leg]:
                found.append((PoseStep(names[shape[leg]], leg), chance))
    return found


def _change(step: PoseStep, axes: Floats, onward: Floats, states: int) -> Floats:
    """Change of the filter's states for a unit step, (m, s, 3)."""
    change = np.zeros((axes.shape[0], states, 3))
    first = 3 if step.shape == "reference" else 0
    change[step.leg, first : first + 3] = axes[step.leg]
    if step.shape == "spike":
        change[step.leg + 1, :3] = -onward[step.leg] @ axes[step.leg]
    return change


def _of_view(view: View, *, headings: bool) -> Floats:
    """Map from a step of the robot (along, sideways, heading) to the reference, (3, 3)."""
    cos, sin = np.cos(view.yaw), np.sin(view.yaw)
    turned = np.array([[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]])
    arm = np.array([[1.0, 0.0, -view.left], [0.0, 1.0, view.ahead], [0.0, 0.0, 1.0]])
    scale = (1.0, 1.0, view.scale) if headings else (view.scale, view.scale, 1.0)
    return np.asarray(np.diag(scale) @ turned @ arm)
