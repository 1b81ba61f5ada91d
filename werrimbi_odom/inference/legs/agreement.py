# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Relation between reference and wheels in a drive, estimated by consensus without the robot file.

A turn is a linear function of both wheels' travel; a squared displacement is quadratic in path and
turn. So wiring, sizes, mounting of the reference and direction of its axes need not be known. The
function is found by RANSAC (Fischler and Bolles, Commun. ACM 24, 1981): pairs of time windows
propose candidates, and the one with the most inliers wins. Windows in which the robot was held or
carried are outliers.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.legs.windows import Windows
from werrimbi_odom.model.pose import Floats

_TRIES = 200  # minimal samples of two windows; 50 are of driven windows alone if half are driven
REFITS = 3  # refits to the inliers
_RATIOS = np.linspace(0.02, 0.98, 49)
TINY = 1e-12
_PARALLEL = 0.05  # sine of the angle below which two windows are collinear
CLEARLY = 0.1  # ratios are formed only above this share of the largest value


@dataclass(frozen=True, slots=True)
class Agreement:
    """Reference prediction for each window, (k,), and its deviation from the measurement."""

    windows: Windows
    """Windows, with the reference shifted by the lag."""
    expected: Floats
    gross: Floats
    """Value that would be measured if all travel of both wheels went into it."""
    lag: float
    """Delay of the reference behind the wheels [s]."""
    law: Floats
    """Coefficients: of a turn, per travel of each wheel [rad/m]; of a squared displacement, of its
    terms."""

    @property
    def off(self) -> Floats:
        """Absolute deviation of the measurement from the prediction."""
        return np.abs(self.windows.measured - self.expected)


def agreement_of_turns(windows: Windows, base: float) -> Agreement | None:
    """Estimate how turns depend on wheel travel; None if too little of the drive is consistent.

    Drift at rest is subtracted first, unless it is as fast as turning. `windows`: windows of turns.
    `base`: wheel base of the robot file [m]. Its law is preferred where part of the drive agrees
    with it: a held robot turns less than predicted, and rarely by just that law.
    """
    rest = windows.at_rest()
    rest = rest[np.abs(rest) < rules.NO_DRIVING_TURNS * windows.steps * windows.step]
    if rest.size >= rules.AGREE_FEWEST:
        windows = replace(windows, measured=windows.measured - float(np.median(rest)))
    best: tuple[float, float, Floats] | None = None
    for lag in lags_to_try(windows.step):
        every = windows.later(lag).rolling()
        if every.time.size < rules.AGREE_FEWEST:
            continue
        law, kept, asked = _consensus_law(every, base)
        if best is None or kept > rules.AGREE_BETTER * best[0]:
            best = kept, lag, law
        if kept > rules.AGREE_LAGS * asked:
            break
    if best is None:
        return None
    _, lag, law = best

    def kept_at(lag: float) -> float:
        every = windows.later(lag).rolling()
        return float(inlier_weight(every, *_predicted(every, law[:, None]))[0][0])

    lag = max((lag, lag - windows.step, lag + windows.step), key=kept_at)
    late = windows.later(lag)
    shown, gross = _predicted(late, law[:, None])
    near = bool(np.abs(law * base - (-1.0, 1.0)).max() < rules.AGREE_WITHIN)
    least = rules.AGREE_TURN_OF_FILE if near else rules.AGREE_TURN
    return accepted(Agreement(late, shown[:, 0], gross[:, 0], lag, law), near, least)


def lags_to_try(step: float) -> list[float]:
    """Lags to try: zero, then growing in both directions, at least two steps apart."""
    apart = max(2.0 * step, rules.AGREE_LAG_STEP)
    some = [number * apart for number in range(1, int(rules.AGREE_LATEST / apart) + 1)]
    return [0.0, *(sign * lag for lag in some for sign in (1.0, -1.0))]


def _predicted(windows: Windows, laws: Floats) -> tuple[Floats, Floats]:
    """Predicted turn of each window under some laws (2, n), and its upper bound; (k, n) each."""
    shown = np.stack([windows.left, windows.right], axis=1) @ laws
    return shown, windows.rolled[:, None] * np.abs(laws).sum(axis=0)


def _consensus_law(windows: Windows, base: float) -> tuple[Floats, float, float]:
    """Turn law with the most inliers, or the robot file's if it has enough.

    Returns
    -------
    law : ndarray, shape (2,)
    kept : float
        Weight of the inliers of the law with the most. By it lags are compared: at one of them the
        file's may have too few, and another law then many more.
    asked : float
        Weight of all windows.
    """
    terms = np.stack([windows.left, windows.right], axis=1)
    picked = np.random.default_rng(len(terms)).integers(0, len(terms), (_TRIES, 2))
    square = terms[picked]
    sizes = np.linalg.norm(square, axis=2).prod(axis=1)
    usable = np.abs(np.linalg.det(square)) > _PARALLEL * np.maximum(sizes, TINY)
    laws = [np.linalg.solve(square[usable], windows.measured[picked][usable][..., None])[..., 0].T]
    for plain in ([-1.0, 1.0], [1.0, 1.0]):
        laws.append(
            np.array(plain)[:, None] * candidate_scales(windows.measured, terms @ np.array(plain))
        )
    every = np.concatenate(laws, axis=1)
    best = every[:, int(np.argmax(inlier_weight(windows, *_predicted(windows, every))[0]))]
    own, best = (
        _least_squares(windows, law, terms) for law in (np.array([-1.0, 1.0]) / base, best)
    )
    kept, asked = inlier_weight(windows, *_predicted(windows, np.stack([own, best], axis=1)))
    # A law that nearly all of the drive fits is the robot's, whatever wiring the file has; the
    # file's first. (In wide arcs of one radius wheels that turn alike do more by another.)
    nearly_all = kept > rules.AGREE_LAGS * asked
    needed = rules.AGREE_LAGS if nearly_all[1] else rules.AGREE_OWN
    is_own = nearly_all[0] or kept[0] > needed * kept[1]
    return own if is_own else best, float(kept.max()), float(asked.max())


def _least_squares(windows: Windows, law: Floats, terms: Floats) -> Floats:
    """Least-squares refit of a turn law to its inliers."""
    for _ in range(REFITS):
        shown, gross = _predicted(windows, law[:, None])
        keeps = (np.abs(windows.measured - shown[:, 0]) <= rules.AGREE_WITHIN * gross[:, 0]) & (
            gross[:, 0] > 0.0
        )
        if keeps.sum() < rules.AGREE_FEWEST:
            break
        scale = 1.0 / gross[keeps, 0]  # weights fast and slow windows alike
        law = np.linalg.lstsq(
            terms[keeps] * scale[:, None], windows.measured[keeps] * scale, rcond=1e-2
        )[0]
    return law


def candidate_scales(measured: Floats, shown: Floats) -> Floats:
    """Candidate scale factors from prediction to measurement."""
    large = np.abs(shown) > CLEARLY * np.abs(shown).max(initial=0.0)
    if not large.any():
        return np.ones(1)
    return np.unique(np.quantile(measured[large] / shown[large], _RATIOS))


def inlier_weight(windows: Windows, shown: Floats, gross: Floats) -> tuple[Floats, Floats]:
    """Weight of the inliers of some laws (k, n), and of all windows; each (n,).

    A window weighs more the more of its travel goes into the measurement. A straight drive without
    turning, for example, agrees with any base.
    """
    keeps = np.abs(windows.measured[:, None] - shown) <= rules.AGREE_WITHIN * gross
    said = _evidence(shown, gross)
    return np.where(keeps, said, 0.0).sum(axis=0), said.sum(axis=0)


def inlier_nearness(windows: Windows, shown: Floats, gross: Floats) -> tuple[Floats, Floats]:
    """`inlier_weight` with a truncated square instead of a count: how near the windows are, too.

    MSAC (Torr and Zisserman, Comput. Vis. Image Underst. 78, 2000). Within a limit that is wide
    enough for slips as many windows agree with one lever arm, or lag, as with half of it.
    """
    off = np.abs(windows.measured[:, None] - shown) / np.maximum(rules.AGREE_WITHIN * gross, TINY)
    said = _evidence(shown, gross)
    return (said * np.maximum(1.0 - off**2, 0.0)).sum(axis=0), said.sum(axis=0)


def _evidence(shown: Floats, gross: Floats) -> Floats:
    return np.asarray(np.abs(shown) / np.maximum(gross, TINY) + 0.02)


def accepted(found: Agreement, near: bool, least: float) -> Agreement | None:
    """Accept the result if a fair share of the informative windows are inliers.

    `near`: whether the law agrees with the robot file. `least`: least turn or path that the inliers
    must add up to.
    """
    windows = found.windows
    asked = (windows.rolled > windows.still) & np.isfinite(windows.measured)
    asked &= np.abs(found.expected) > rules.AGREE_WITHIN * found.gross
    keeps = asked & (found.off <= rules.AGREE_WITHIN * found.gross)
    share = rules.AGREE_SHARE_OF_FILE if near else rules.AGREE_SHARE
    enough = max(rules.AGREE_FEWEST, rules.AGREE_ENOUGH / windows.step, share * asked.sum())
    gone = float(np.abs(found.expected[keeps]).sum()) / windows.steps
    return found if keeps.sum() >= enough and gone >= least else None
