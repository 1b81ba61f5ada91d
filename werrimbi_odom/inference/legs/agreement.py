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
_REFINED = 3  # refits to the inliers
_RATIOS = np.linspace(0.02, 0.98, 49)
_TINY = 1e-12
_PARALLEL = 0.05  # sine of the angle below which two windows are collinear
_CLEARLY = 0.1  # ratios are formed only above this share of the largest value


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


def turns_agree(windows: Windows, base: float) -> Agreement | None:
    """Estimate how turns depend on wheel travel; None if too little of the drive is consistent.

    Drift at rest is subtracted first, unless it is as fast as turning.

    Parameters
    ----------
    windows : Windows
        Windows of turns.
    base : float
        Wheel base of the robot file [m]. Its law is preferred where part of the drive agrees with
        it: a held robot turns less than predicted, and rarely by just that law.
    """
    rest = windows.at_rest()
    rest = rest[np.abs(rest) < rules.NO_DRIVING_TURNS * windows.steps * windows.step]
    if rest.size >= rules.AGREE_FEWEST:
        windows = replace(windows, measured=windows.measured - float(np.median(rest)))
    best: tuple[float, float, Floats] | None = None
    for lag in _lags(windows.step):
        every = windows.later(lag).rolling()
        if every.time.size < rules.AGREE_FEWEST:
            continue
        law, kept, asked = _turn_law(every, base)
        if best is None or kept > rules.AGREE_BETTER * best[0]:
            best = kept, lag, law
        if kept > rules.AGREE_LAGS * asked:
            break
    if best is None:
        return None
    _, lag, law = best

    def kept_at(lag: float) -> float:
        every = windows.later(lag).rolling()
        return float(_kept(every, *_turn(every, law[:, None]))[0][0])

    lag = max((lag, lag - windows.step, lag + windows.step), key=kept_at)
    late = windows.later(lag)
    shown, gross = _turn(late, law[:, None])
    near = bool(np.abs(law * base - (-1.0, 1.0)).max() < rules.AGREE_WITHIN)
    return _plain(Agreement(late, shown[:, 0], gross[:, 0], lag, law), near, rules.AGREE_TURN)


def ways_agree(windows: Windows, turns: Agreement | None, base: float) -> Agreement | None:
    """Estimate how displacements depend on wheel travel; None if too little is consistent.

    Parameters
    ----------
    windows : Windows
        Windows of displacements.
    turns : Agreement or None
        Result for the turns. Without it, the wiring of the robot file and that with one wheel
        reversed are tried.
    base : float
        Wheel base of the robot file, as the unit of turning [m].
    """
    if turns is not None:
        turned = np.interp(windows.time, turns.windows.time, turns.expected)
        windows = replace(windows, chord=np.maximum(np.sinc(turned / (2.0 * np.pi)), _CLEARLY))
        windows = _of_size(windows, np.abs(turns.law) / max(float(np.abs(turns.law).max()), _TINY))
        wirings, lags = [np.sign(turns.law)], [turns.lag]
    else:
        wirings, lags = [np.array([-1.0, 1.0]), np.array([1.0, 1.0])], _lags(windows.step)
    best: tuple[float, float, Floats, Floats] | None = None

    def kept_at(lag: float, wiring: Floats) -> tuple[float, float, Floats, Floats] | None:
        every = windows.later(lag).rolling()
        if every.time.size < rules.AGREE_FEWEST:
            return None
        law = _way_law(every, wiring, base)
        kept, asked = _kept(every, *_way(every, wiring, base, law[:, None]))
        return float(kept[0] / max(asked[0], _TINY)), lag, law, wiring

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
        beside = [kept_at(best[1] + side * windows.step, best[3]) for side in (-1.0, 1.0)]
        best = max([best, *filter(None, beside)], key=lambda each: each[0])
    _, lag, law, wiring = best
    late = windows.later(lag)
    shown, gross = _way(late, wiring, base, law[:, None])
    by_file = abs(float(np.sqrt(max(law[0], 0.0))) - 1.0) < rules.AGREE_WITHIN
    return _plain(Agreement(late, shown[:, 0], gross[:, 0], lag, law), by_file, rules.AGREE_WAY)


def _of_size(windows: Windows, sizes: Floats) -> Windows:
    """Scale the travel of both wheels by their sizes, which the robot file may have wrong."""
    left, right = sizes[0] * windows.left, sizes[1] * windows.right
    before = np.abs(windows.left) + np.abs(windows.right)
    grown = (np.abs(left) + np.abs(right)) / np.maximum(before, _TINY)
    rolled = windows.rolled * np.where(before > _TINY, grown, float(sizes.mean()))
    return replace(windows, left=left, right=right, rolled=rolled)


def _lags(step: float) -> list[float]:
    """Lags to try: zero, then growing in both directions, at least two steps apart."""
    apart = max(2.0 * step, rules.AGREE_LAG_STEP)
    some = [number * apart for number in range(1, int(rules.AGREE_LATEST / apart) + 1)]
    return [0.0, *(sign * lag for lag in some for sign in (1.0, -1.0))]


def _turn(windows: Windows, laws: Floats) -> tuple[Floats, Floats]:
    """Predicted turn of each window under some laws (2, n), and its upper bound; (k, n) each."""
    shown = np.stack([windows.left, windows.right], axis=1) @ laws
    return shown, windows.rolled[:, None] * np.abs(laws).sum(axis=0)


def _turn_law(windows: Windows, base: float) -> tuple[Floats, float, float]:
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
    usable = np.abs(np.linalg.det(square)) > _PARALLEL * np.maximum(sizes, _TINY)
    laws = [np.linalg.solve(square[usable], windows.measured[picked][usable][..., None])[..., 0].T]
    for plain in ([-1.0, 1.0], [1.0, 1.0]):
        laws.append(np.array(plain)[:, None] * _sizes(windows.measured, terms @ np.array(plain)))
    every = np.concatenate(laws, axis=1)
    best = every[:, int(np.argmax(_kept(windows, *_turn(windows, every))[0]))]
    own, best = (_refined(windows, law, terms) for law in (np.array([-1.0, 1.0]) / base, best))
    kept, asked = _kept(windows, *_turn(windows, np.stack([own, best], axis=1)))
    # A law that nearly all of the drive fits is the robot's, whatever wiring the file has; the
    # file's first. (In wide arcs of one radius wheels that turn alike do more by another.)
    nearly_all = kept > rules.AGREE_LAGS * asked
    needed = rules.AGREE_LAGS if nearly_all[1] else rules.AGREE_OWN
    is_own = nearly_all[0] or kept[0] > needed * kept[1]
    return own if is_own else best, float(kept.max()), float(asked.max())


def _refined(windows: Windows, law: Floats, terms: Floats) -> Floats:
    """Least-squares refit of a turn law to its inliers."""
    for _ in range(_REFINED):
        shown, gross = _turn(windows, law[:, None])
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


def _sizes(measured: Floats, shown: Floats) -> Floats:
    """Candidate scale factors from prediction to measurement."""
    large = np.abs(shown) > _CLEARLY * np.abs(shown).max(initial=0.0)
    if not large.any():
        return np.ones(1)
    return np.unique(np.quantile(measured[large] / shown[large], _RATIOS))


def _way(windows: Windows, wiring: Floats, base: float, laws: Floats) -> tuple[Floats, Floats]:
    """As `_turn`, for displacements: laws (3, n) of path squared, path times turn, turn squared."""
    terms = _way_terms(windows, wiring, base)
    shown = np.sqrt(np.maximum(terms @ laws, 0.0)) * windows.chord[:, None]
    of_way = np.sqrt(np.maximum(laws[0], 0.0)) * float(np.abs(wiring).sum()) / 2.0
    return shown, np.maximum(windows.rolled[:, None] * of_way, shown)


def _way_terms(windows: Windows, wiring: Floats, base: float) -> Floats:
    left, right = wiring[0] * windows.left, wiring[1] * windows.right
    way, turn = 0.5 * (right - left), (right + left) / base
    return np.stack([way * way, way * turn, turn * turn], axis=1)


def _way_law(windows: Windows, wiring: Floats, base: float) -> Floats:
    """Estimate the scale of the path, and the lever arm at which the reference swings in turns."""
    seen = windows.measured / windows.chord
    terms, squares = _way_terms(windows, wiring, base), seen**2
    way, turn = np.sqrt(terms[:, 0]), np.sqrt(terms[:, 2])
    swings = way < rules.MOSTLY * windows.rolled
    scale = _usual_size(seen[~swings], way[~swings])
    arm = _usual_size(seen[swings], turn[swings]) if swings.sum() >= rules.AGREE_FEWEST else 0.0
    sideways = np.linspace(-1.0, 1.0, 9) * arm
    # With a lateral lever arm, a robot in arcs moves now farther and now less far than its wheels.
    # The commonest ratio is then no scale, so the file's scale and the least-squares fit are tried
    # too.
    every = np.linalg.lstsq(terms / np.maximum(squares, _TINY)[:, None], squares > 0.0, rcond=1e-2)
    laws = np.stack(
        [
            every[0],
            *([size**2, -2.0 * size * each, arm**2] for size in (scale, 1.0) for each in sideways),
        ],
        axis=1,
    )
    kept = _kept(windows, *_way(windows, wiring, base, laws))[0]
    law = laws[:, int(np.argmax(kept))]
    for _ in range(_REFINED):
        shown, gross = (part[:, 0] for part in _way(windows, wiring, base, law[:, None]))
        keeps = (np.abs(windows.measured - shown) <= rules.AGREE_WITHIN * gross) & (gross > 0.0)
        if keeps.sum() < rules.AGREE_FEWEST:
            break
        weight = 1.0 / gross[keeps] ** 2
        weighed = terms[keeps] * weight[:, None], squares[keeps] * weight
        better = np.asarray(np.linalg.lstsq(*weighed, rcond=1e-2)[0], dtype=np.float64)
        before, after = (
            _kept(windows, *_way(windows, wiring, base, each[:, None]))[0][0]
            for each in (law, better)
        )
        if after < before:
            break
        law = better
    return law


def _usual_size(measured: Floats, shown: Floats) -> float:
    """The scale factor with the most inliers; 1 if there are too few windows."""
    if measured.size < rules.AGREE_FEWEST:
        return 1.0
    sizes = _sizes(measured, shown)
    off = np.abs(measured[:, None] - shown[:, None] * sizes)
    keeps = off <= rules.AGREE_WITHIN * np.abs(shown[:, None] * sizes)
    return float(sizes[int(np.argmax(keeps.sum(axis=0)))])


def _kept(windows: Windows, shown: Floats, gross: Floats) -> tuple[Floats, Floats]:
    """Weight of the inliers of some laws (k, n), and of all windows; each (n,).

    A window weighs more the more of its travel goes into the measurement. A straight drive without
    turning, for example, agrees with any base.
    """
    share = np.abs(shown) / np.maximum(gross, _TINY)
    keeps = np.abs(windows.measured[:, None] - shown) <= rules.AGREE_WITHIN * gross
    said = share + 0.02
    return np.where(keeps, said, 0.0).sum(axis=0), said.sum(axis=0)


def _plain(found: Agreement, near: bool, least: float) -> Agreement | None:
    """Accept the result if a fair share of the informative windows are inliers.

    Parameters
    ----------
    near : bool
        Whether the law agrees with the robot file.
    least : float
        Least turn or path that the inliers must add up to.
    """
    windows = found.windows
    asked = (windows.rolled > windows.still) & np.isfinite(windows.measured)
    asked &= np.abs(found.expected) > rules.AGREE_WITHIN * found.gross
    keeps = asked & (found.off <= rules.AGREE_WITHIN * found.gross)
    share = rules.AGREE_SHARE_OF_FILE if near else rules.AGREE_SHARE
    enough = max(rules.AGREE_FEWEST, rules.AGREE_ENOUGH / windows.step, share * asked.sum())
    gone = float(np.abs(found.expected[keeps]).sum()) / windows.steps
    return found if keeps.sum() >= enough and gone >= least else None
