# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""How displacements depend on wheel travel, by consensus: `agreement`, for places."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.legs.agreement import (
    CLEARLY,
    REFITS,
    TINY,
    Agreement,
    accepted,
    candidate_scales,
    inlier_nearness,
    inlier_weight,
    lags_to_try,
)
from werrimbi_odom.inference.legs.windows import Windows
from werrimbi_odom.model.pose import Floats

_Support = Callable[[Windows, Floats, Floats], tuple[Floats, Floats]]
_AtLag = tuple[float, float, Floats, Floats]
"""Share of the evidence for a law, lag [s], law, and wiring."""


def agreement_of_displacements(
    windows: Windows, turns: Agreement | None, base: float
) -> Agreement | None:
    """Estimate how displacements depend on wheel travel; None if too little is consistent.

    `windows`: windows of displacements. `turns`: result for the turns. Without it, the wiring of
    the robot file and that with one wheel reversed are tried. `base`: wheel base of the robot file,
    as the unit of turning [m].
    """
    if turns is not None:
        turned = np.interp(windows.time, turns.windows.time, turns.expected)
        windows = replace(windows, chord=np.maximum(np.sinc(turned / (2.0 * np.pi)), CLEARLY))
        windows = _of_size(windows, np.abs(turns.law) / max(float(np.abs(turns.law).max()), TINY))
        wirings, lags = [np.sign(turns.law)], [turns.lag]
    else:
        wirings, lags = [np.array([-1.0, 1.0]), np.array([1.0, 1.0])], lags_to_try(windows.step)
    best: _AtLag | None = None

    def kept_at(lag: float, wiring: Floats, support: _Support = inlier_weight) -> _AtLag | None:
        every = windows.later(lag).rolling()
        if every.time.size < rules.AGREE_FEWEST:
            return None
        law = _consensus_law(every, wiring, base, support)
        kept, asked = support(every, *_predicted(every, wiring, base, law[:, None]))
        return float(kept[0] / max(asked[0], TINY)), lag, law, wiring

    for lag in lags:
        for wiring in wirings:
            found = kept_at(lag, wiring)
            if found is not None and (best is None or found[0] > rules.AGREE_BETTER * best[0]):
                best = found
        if best is not None and best[0] > rules.AGREE_LAGS:
            break
    if best is None:
        return None
    if turns is None:  # a law fitted at a wrong lag is itself biased
        wiring = best[3]
        best = _at_the_best_lag(
            best[1], windows.step, lambda lag: kept_at(lag, wiring, inlier_nearness)
        )
        if best is None:
            return None
    _, lag, law, wiring = best
    late = windows.later(lag)
    shown, gross = _predicted(late, wiring, base, law[:, None])
    by_file = abs(float(np.sqrt(max(law[0], 0.0))) - 1.0) < rules.AGREE_WITHIN
    return accepted(Agreement(late, shown[:, 0], gross[:, 0], lag, law), by_file, rules.AGREE_WAY)


def _at_the_best_lag(
    lag: float, step: float, at: Callable[[float], _AtLag | None]
) -> _AtLag | None:
    """The law at the lag that no neighbour betters, from a lag on by steps either way.

    A tenth of a second more or less leaves nearly as many inliers, and another lever arm.
    """
    start = at(lag)
    if start is None:
        return None
    best = start
    for side in (-1.0, 1.0):
        here = start
        while abs(here[1]) < rules.AGREE_LATEST:
            further = at(here[1] + side * step)
            if further is None or further[0] <= here[0]:
                break
            here = further
        best = max(best, here, key=lambda each: each[0])
    return best


def _of_size(windows: Windows, sizes: Floats) -> Windows:
    """Scale the travel of both wheels by their sizes, which the robot file may have wrong."""
    left, right = sizes[0] * windows.left, sizes[1] * windows.right
    before = np.abs(windows.left) + np.abs(windows.right)
    grown = (np.abs(left) + np.abs(right)) / np.maximum(before, TINY)
    rolled = windows.rolled * np.where(before > TINY, grown, float(sizes.mean()))
    return replace(windows, left=left, right=right, rolled=rolled)


def _predicted(
    windows: Windows, wiring: Floats, base: float, laws: Floats
) -> tuple[Floats, Floats]:
    """Predicted displacement of each window under some laws, and its upper bound; (k, n) each.

    Laws (3, n) are of path squared, path times turn, and turn squared.
    """
    terms = _terms(windows, wiring, base)
    shown = np.sqrt(np.maximum(terms @ laws, 0.0)) * windows.chord[:, None]
    of_way = np.sqrt(np.maximum(laws[0], 0.0)) * float(np.abs(wiring).sum()) / 2.0
    return shown, np.maximum(windows.rolled[:, None] * of_way, shown)


def _terms(windows: Windows, wiring: Floats, base: float) -> Floats:
    left, right = wiring[0] * windows.left, wiring[1] * windows.right
    way, turn = 0.5 * (right - left), (right + left) / base
    return np.stack([way * way, way * turn, turn * turn], axis=1)


def _consensus_law(windows: Windows, wiring: Floats, base: float, support: _Support) -> Floats:
    """Estimate the scale of the path, and the lever arm at which the reference swings in turns."""
    seen = windows.measured / windows.chord
    terms, squares = _terms(windows, wiring, base), seen**2
    way, turn = np.sqrt(terms[:, 0]), np.sqrt(terms[:, 2])
    swings = way < rules.MOSTLY * windows.rolled
    scale = _consensus_scale(seen[~swings], way[~swings])
    arm = (
        _consensus_scale(seen[swings], turn[swings]) if swings.sum() >= rules.AGREE_FEWEST else 0.0
    )
    sideways = np.linspace(-1.0, 1.0, 9) * arm
    # With a lateral lever arm, a robot in arcs moves now farther and now less far than its wheels.
    # The commonest ratio is then no scale, so the file's scale and the least-squares fit are tried
    # too.
    every = np.linalg.lstsq(terms / np.maximum(squares, TINY)[:, None], squares > 0.0, rcond=1e-2)
    laws = np.stack(
        [
            every[0],
            *([size**2, -2.0 * size * each, arm**2] for size in (scale, 1.0) for each in sideways),
        ],
        axis=1,
    )
    kept = support(windows, *_predicted(windows, wiring, base, laws))[0]
    law = laws[:, int(np.argmax(kept))]
    for _ in range(REFITS):
        shown, gross = (part[:, 0] for part in _predicted(windows, wiring, base, law[:, None]))
        keeps = (np.abs(windows.measured - shown) <= rules.AGREE_WITHIN * gross) & (gross > 0.0)
        if keeps.sum() < rules.AGREE_FEWEST:
            break
        weight = 1.0 / gross[keeps] ** 2
        weighed = terms[keeps] * weight[:, None], squares[keeps] * weight
        better = np.asarray(np.linalg.lstsq(*weighed, rcond=1e-2)[0], dtype=np.float64)
        before, after = (
            support(windows, *_predicted(windows, wiring, base, each[:, None]))[0][0]
            for each in (law, better)
        )
        if after < before:
            break
        law = better
    return law


def _consensus_scale(measured: Floats, shown: Floats) -> float:
    """The scale factor with the most inliers; 1 if there are too few windows."""
    if measured.size < rules.AGREE_FEWEST:
        return 1.0
    sizes = candidate_scales(measured, shown)
    off = np.abs(measured[:, None] - shown[:, None] * sizes)
    keeps = off <= rules.AGREE_WITHIN * np.abs(shown[:, None] * sizes)
    return float(sizes[int(np.argmax(keeps.sum(axis=0)))])
