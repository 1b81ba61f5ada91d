# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""How a reference goes with the wheels in a drive, whatever a robot file says: by consensus.

A turn is a linear function of both wheels' travel, a squared displacement a quadratic one of turn
and way; so neither wiring nor sizes, nor where the reference is mounted, nor which way its axes
point, need be known. Which function it is, most of the drive says: of many that a few windows of
time propose, the one that most windows keep to (Fischler and Bolles, Commun. ACM 24, 1981). A
window in which the robot was held or carried keeps to none that a driven one does.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from werrimbi_odom.inference.legs.windows import Windows
from werrimbi_odom.inference.rules import (
    AGREE_BETTER,
    AGREE_ENOUGH,
    AGREE_FEWEST,
    AGREE_LAG_STEP,
    AGREE_LAGS,
    AGREE_LATEST,
    AGREE_OWN,
    AGREE_SHARE,
    AGREE_SHARE_OF_FILE,
    AGREE_TURN,
    AGREE_WAY,
    AGREE_WITHIN,
    MOSTLY,
    NO_DRIVING_TURNS,
)
from werrimbi_odom.model.pose import Floats

_TRIES = 200  # laws of two windows each: 50 of them of driven ones alone, where half are driven
_REFINED = 3  # times a law is fitted to the windows that keep to it
_RATIOS = np.linspace(0.02, 0.98, 49)
_TINY = 1e-12
_PARALLEL = 0.05  # sine of an angle, below which two windows hold one number
_CLEARLY = 0.1  # share of the largest, from which on a ratio is worth something


@dataclass(frozen=True, slots=True)
class Agreement:
    """What the reference should show in each window, (k,), and how far it is from that."""

    windows: Windows
    """With the reference as early as the wheels."""
    expected: Floats
    gross: Floats
    """What would be shown if all travel of both wheels went into it."""
    lag: float
    """By which the reference is late [s]."""
    law: Floats
    """Of a turn: by travel of each wheel [rad/m]; of a way: by the squares' coefficients."""

    @property
    def off(self) -> Floats:
        """By how much it is not as expected."""
        return np.abs(self.windows.measured - self.expected)


def turns_agree(windows: Windows, base: float) -> Agreement | None:
    """How turns follow the wheels; None where too little of the drive says so.

    A drift at rest is taken off; what is as fast as turning is none.

    Parameters
    ----------
    base : float
        The robot file's [m]. Its law is taken where some of the drive keeps to it: a robot that is
        held turns less than it should, and seldom just as much.
    """
    rest = windows.at_rest()
    rest = rest[np.abs(rest) < NO_DRIVING_TURNS * windows.steps * windows.step]
    if rest.size >= AGREE_FEWEST:
        windows = replace(windows, measured=windows.measured - float(np.median(rest)))
    best: tuple[float, float, Floats] | None = None
    for lag in _lags(windows.step):
        every = windows.later(lag).rolling()
        if every.time.size < AGREE_FEWEST:
            continue
        law = _turn_law(every, base)
        kept, asked = _kept(every, *_turn(every, law[:, None]))
        if best is None or kept[0] > AGREE_BETTER * best[0]:
            best = float(kept[0]), lag, law
        if kept[0] > AGREE_LAGS * asked[0]:
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
    near = bool(np.abs(law * base - (-1.0, 1.0)).max() < AGREE_WITHIN)
    return _plain(Agreement(late, shown[:, 0], gross[:, 0], lag, law), near, AGREE_TURN)


def ways_agree(windows: Windows, turns: Agreement | None, base: float) -> Agreement | None:
    """How displacements follow the wheels; None where too little of the drive says so.

    Parameters
    ----------
    turns
        What headings said of the wheels; without them the robot file's wiring is asked, and that
        with one wheel reversed.
    base : float
        The robot file's, for a unit of turning [m].
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
        if every.time.size < AGREE_FEWEST:
            return None
        law = _way_law(every, wiring, base)
        kept, asked = _kept(every, *_way(every, wiring, base, law[:, None]))
        return float(kept[0] / max(asked[0], _TINY)), lag, law, wiring

    for lag in lags:
        for wiring in wirings:
            found = kept_at(lag, wiring)
            if found is not None and (best is None or found[0] > AGREE_BETTER * best[0]):
                best = found
        if best is not None and best[0] > AGREE_LAGS:
            break
    if best is None:
        return None
    if turns is None:  # a law that is learnt at a wrong lag is off itself
        beside = [kept_at(best[1] + side * windows.step, best[3]) for side in (-1.0, 1.0)]
        best = max([best, *filter(None, beside)], key=lambda each: each[0])
    _, lag, law, wiring = best
    late = windows.later(lag)
    shown, gross = _way(late, wiring, base, law[:, None])
    by_file = abs(float(np.sqrt(max(law[0], 0.0))) - 1.0) < AGREE_WITHIN
    return _plain(Agreement(late, shown[:, 0], gross[:, 0], lag, law), by_file, AGREE_WAY)


def _of_size(windows: Windows, sizes: Floats) -> Windows:
    """With the travel of both wheels by their sizes, which the robot file may have wrong."""
    left, right = sizes[0] * windows.left, sizes[1] * windows.right
    before = np.abs(windows.left) + np.abs(windows.right)
    grown = (np.abs(left) + np.abs(right)) / np.maximum(before, _TINY)
    rolled = windows.rolled * np.where(before > _TINY, grown, float(sizes.mean()))
    return replace(windows, left=left, right=right, rolled=rolled)


def _lags(step: float) -> list[float]:
    """None first, then ever later and earlier ones; two steps apart at the least."""
    apart = max(2.0 * step, AGREE_LAG_STEP)
    some = [number * apart for number in range(1, int(AGREE_LATEST / apart) + 1)]
    return [0.0, *(sign * lag for lag in some for sign in (1.0, -1.0))]


def _turn(windows: Windows, laws: Floats) -> tuple[Floats, Floats]:
    """What some laws (2, n) expect of each window, and what at most, (k, n)."""
    shown = np.stack([windows.left, windows.right], axis=1) @ laws
    return shown, windows.rolled[:, None] * np.abs(laws).sum(axis=0)


def _turn_law(windows: Windows, base: float) -> Floats:
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
    # What nearly all of the drive keeps to is the robot's law, whatever the file says of wiring.
    needed = AGREE_LAGS if kept[1] > AGREE_LAGS * asked[1] else AGREE_OWN
    return own if kept[0] > needed * kept[1] else best


def _refined(windows: Windows, law: Floats, terms: Floats) -> Floats:
    for _ in range(_REFINED):
        shown, gross = _turn(windows, law[:, None])
        keeps = (np.abs(windows.measured - shown[:, 0]) <= AGREE_WITHIN * gross[:, 0]) & (
            gross[:, 0] > 0.0
        )
        if keeps.sum() < AGREE_FEWEST:
            break
        scale = 1.0 / gross[keeps, 0]  # a fast window is worth no more than a slow one
        law = np.linalg.lstsq(
            terms[keeps] * scale[:, None], windows.measured[keeps] * scale, rcond=1e-2
        )[0]
    return law


def _sizes(measured: Floats, shown: Floats) -> Floats:
    """Factors between what is shown and what is measured, of which one may be right."""
    large = np.abs(shown) > _CLEARLY * np.abs(shown).max(initial=0.0)
    if not large.any():
        return np.ones(1)
    return np.unique(np.quantile(measured[large] / shown[large], _RATIOS))


def _way(windows: Windows, wiring: Floats, base: float, laws: Floats) -> tuple[Floats, Floats]:
    """As `_turn`, of displacements: laws (3, n) of squared way, way times turn, squared turn."""
    terms = _way_terms(windows, wiring, base)
    shown = np.sqrt(np.maximum(terms @ laws, 0.0)) * windows.chord[:, None]
    of_way = np.sqrt(np.maximum(laws[0], 0.0)) * float(np.abs(wiring).sum()) / 2.0
    return shown, np.maximum(windows.rolled[:, None] * of_way, shown)


def _way_terms(windows: Windows, wiring: Floats, base: float) -> Floats:
    left, right = wiring[0] * windows.left, wiring[1] * windows.right
    way, turn = 0.5 * (right - left), (right + left) / base
    return np.stack([way * way, way * turn, turn * turn], axis=1)


def _way_law(windows: Windows, wiring: Floats, base: float) -> Floats:
    """A scale, and the arm at which the reference is seen to swing."""
    seen = windows.measured / windows.chord
    terms, squares = _way_terms(windows, wiring, base), seen**2
    way, turn = np.sqrt(terms[:, 0]), np.sqrt(terms[:, 2])
    swings = way < MOSTLY * windows.rolled
    scale = _usual_size(seen[~swings], way[~swings])
    arm = _usual_size(seen[swings], turn[swings]) if swings.sum() >= AGREE_FEWEST else 0.0
    sideways = np.linspace(-1.0, 1.0, 9) * arm
    # Seen from beside the axle a robot in arcs goes now farther and now less far than its wheels:
    # the commonest of both is no scale, and the file's or what suits all on the average is.
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
        keeps = (np.abs(windows.measured - shown) <= AGREE_WITHIN * gross) & (gross > 0.0)
        if keeps.sum() < AGREE_FEWEST:
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
    """The factor that most have; 1 where there are none."""
    if measured.size < AGREE_FEWEST:
        return 1.0
    sizes = _sizes(measured, shown)
    off = np.abs(measured[:, None] - shown[:, None] * sizes)
    keeps = off <= AGREE_WITHIN * np.abs(shown[:, None] * sizes)
    return float(sizes[int(np.argmax(keeps.sum(axis=0)))])


def _kept(windows: Windows, shown: Floats, gross: Floats) -> tuple[Floats, Floats]:
    """How much of a drive keeps to each of some laws (k, n), and how much could; (n,) each.

    A window says the more the more its travel goes into what is measured: that a robot drives
    straight and does not turn speaks for every size of its base.
    """
    share = np.abs(shown) / np.maximum(gross, _TINY)
    keeps = np.abs(windows.measured[:, None] - shown) <= AGREE_WITHIN * gross
    said = share + 0.02
    return np.where(keeps, said, 0.0).sum(axis=0), said.sum(axis=0)


def _plain(found: Agreement, near: bool, least: float) -> Agreement | None:
    """What was found, if a fair share of what speaks of it keeps to it.

    Parameters
    ----------
    near
        Whether the robot file says the same.
    least
        What must have been turned, or gone, in accord.
    """
    windows = found.windows
    asked = (windows.rolled > windows.still) & np.isfinite(windows.measured)
    asked &= np.abs(found.expected) > AGREE_WITHIN * found.gross
    keeps = asked & (found.off <= AGREE_WITHIN * found.gross)
    share = AGREE_SHARE_OF_FILE if near else AGREE_SHARE
    enough = max(AGREE_FEWEST, AGREE_ENOUGH / windows.step, share * asked.sum())
    gone = float(np.abs(found.expected[keeps]).sum()) / windows.steps
    return found if keeps.sum() >= enough and gone >= least else None
