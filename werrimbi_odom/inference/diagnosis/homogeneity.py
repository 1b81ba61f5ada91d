# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Test of homogeneity: whether the parts of the drives agree on a dependence of the errors.

Score tests and the evidence map assume independent innovations. The innovations of a reference with
correlated errors (a camera, a matched map) are not, and show far stronger chance dependences. So
runs are cut into parts. What a pattern explains in all of them is compared with how much more it
would explain with separate coefficients for each part, by Fisher's F. A real effect is the same in
all parts, to within the noise. What only one drive shows, where the others could as well, was
specific to that drive.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.diagnosis.evidence import Dependence, summed_over_legs
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted
from werrimbi_odom.inference.diagnosis.step_jacobians import step_jacobians
from werrimbi_odom.inference.diagnosis.variables import functions_of
from werrimbi_odom.inference.distributions import chi2_survival, fisher_survival
from werrimbi_odom.inference.fitting.clusters import few_parts, parts_of_innovations
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.free_parameters import FreeParameter
from werrimbi_odom.inference.fitting.prediction import path_of, predict_all
from werrimbi_odom.inference.fitting.score_tests import of_each_run, residual_innovations
from werrimbi_odom.inference.fitting.whitened_innovations import Point, unexpected
from werrimbi_odom.inference.linear import DETERMINED, Nuisance, nuisance, score_test
from werrimbi_odom.model.effect import applied_of
from werrimbi_odom.model.pose import Floats


class Lasting(NamedTuple):
    """A dependence, and the result of its homogeneity test."""

    cell: Dependence
    p_value: float
    """P-value by the disagreement between the parts."""
    only_in: str | None
    """The one drive that shows the dependence where the others could and do not."""


def homogeneity_of_effect(
    runs: Concatenated, fit: Fitted, name: str, beyond: Collection[str] = ()
) -> float:
    """P-value of an effect in the model, by the disagreement between the parts.

    Of an effect that extends another, of what it has `beyond` that other's parameters.

    The size of the effect in each part comes from the derivatives *at the fit*. For a law that is
    not linear, derivatives at the null would not do: half of what a late reference causes (a tenth
    of a second, at every start and stop) lies beyond the derivative at zero delay, and would pass
    for a disagreement of the parts.
    """
    white, flat = fit.design.flat()
    parts = parts_of_innovations(runs, white)
    if parts is None:
        return 0.0
    model = fit.point.model
    applied = applied_of(model.robot.effects, name)
    whose = [number.name.rpartition(".") for number, _ in fit.design.columns]
    declared = applied.effect.parameters
    asked = {key for key, item in declared.items() if not item.tries and key not in beyond}
    own, away, of = [], [], []
    for column, (number, run) in enumerate(fit.design.columns):
        effect, _, parameter = whose[column]
        if effect == name and parameter in asked:
            null = declared[parameter].null
            is_phase = parameter in (applied.effect.quadrature or ())[1:]
            own.append(column)
            of.append(parameter)
            away.append(0.0 if is_phase else model.value(number, max(run, 0)) - null)
    mine = [effect == name and parameter not in beyond for effect, _, parameter in whose]
    # Directions that the data do not determine were not fitted, and explain nothing of the effect.
    others = nuisance(flat @ fit.moves[:, ~fit.moves[mine].any(axis=0)])
    free = others.residual(flat[:, own])
    rest = others.residual(white) - free @ np.array(away)
    test = score_test(flat[:, own], free, rest)
    if test is None:
        return 1.0
    known = noise_known(runs, parts)
    return _chance(test.gain, test.degrees, free, _added_up(free, of), rest, parts, known)


def lasting(
    runs: Concatenated, point: Point, numbers: Sequence[FreeParameter], cells: Iterable[Dependence]
) -> Iterator[Lasting]:
    """Homogeneity test of some cells of a model's evidence map.

    `numbers` are the nuisance parameters of the map.
    """
    prediction = predict_all(point.model, runs)
    frame, rest = residual_innovations(runs, point, numbers, prediction)
    parts = parts_of_innovations(runs, rest)
    for cell in cells:
        p_value, alone = 0.0, None
        if parts is not None:
            free = frame.residual(pattern_of(runs, point, cell))
            by_run = free.reshape(rest.size, len(runs.runs) if cell.variable.per_run else 1, -1)
            gain = _of_one_height(by_run, rest) if cell.variable.per_run else cell.gain
            of_all, known = by_run.sum(axis=1), noise_known(runs, parts)
            p_value = _chance(gain, cell.degrees, free, of_all, rest, parts, known)
            alone = _drive_alone(free, rest, np.repeat(runs.run_of_leg, 3), of_all)
        if p_value < rules.SURE and not _shown_by_the_robot(runs, point, cell, frame, rest):
            p_value = 1.0
        yield Lasting(cell, p_value, None if alone is None else runs.runs[alone].name)


def _shown_by_the_robot(
    runs: Concatenated, point: Point, cell: Dependence, frame: Nuisance, rest: Floats
) -> bool:
    """Whether most of what a cell does is no rounding of the counts.

    On straight drives that rounding is the counted turn, and the heading error with the opposite
    sign (errors in variables; Fuller 1987): a law of the turn explains it, often one of several
    times the turn. So errors that wheels can have must explain it, and in legs that turned by more.
    """
    if cell.variable.per_run:
        return True
    most, robot = cell.amount.most, point.model.robot
    errors = [side @ cell.coefficients for side in functions_of(cell.variable)[cell.form]]
    limited = [np.clip(side, -most, most)[:, None] for side in errors]
    left_by = rest + frame.residual(pattern_of(runs, point, cell, limited))[:, 0]
    gain = np.reshape(rest**2 - left_by**2, (runs.count, 3)).sum(axis=1)
    if cell.amount.per == "turn" or (runs.headings_alone and cell.amount.channel == "along"):
        rounding = 2.0 * (robot.left_tick + robot.right_tick) / robot.track
        gain = gain[np.abs(predict_all(point.model, runs).turn) > rounding]
    return float(gain.sum()) > rules.SHOWN_BY_THE_ROBOT * cell.gain


def _added_up(columns: Floats, of: Sequence[str]) -> Floats:
    """Columns (n, k) of each parameter, those of all drives added up: (n, parameters)."""
    names = list(dict.fromkeys(of))
    return np.stack([columns[:, [name == each for each in of]].sum(axis=1) for name in names], 1)


def pattern_of(
    runs: Concatenated, point: Point, cell: Dependence, functions: Sequence[Floats] | None = None
) -> Floats:
    """Change of the whitened innovations for a dependence of a cell's form, (3 m, k).

    `functions`: in place of the form's, those of the left and of the right wheel, (n, k) each.
    """
    own = unexpected(runs, point).marks(change_of(runs, point, cell, functions))[..., :-1]
    if cell.variable.per_run:
        own = of_each_run(runs, own)
    return np.asarray(own.reshape(3 * runs.count, -1))


def change_of(
    runs: Concatenated, point: Point, cell: Dependence, functions: Sequence[Floats] | None = None
) -> Floats:
    """Change of the legs for a dependence of a cell's form, (m, 3, k), the same in all runs."""
    path = path_of(point.model, runs)
    sides = zip(
        functions or functions_of(cell.variable)[cell.form],
        step_jacobians(runs, path, [cell.amount], point),
        strict=True,
    )
    return np.asarray(sum(summed_over_legs(runs, *side) for side in sides))


def lasting_columns(
    runs: Concatenated, gain: float, degrees: int, free: Floats, rest: Floats
) -> float:
    """P-value of what some columns explain, by the disagreement between the parts.

    `free` (3 m, d): columns with all other fitted parameters projected out. `rest` (3 m,):
    innovations with them projected out.
    """
    parts = parts_of_innovations(runs, rest)
    if parts is None:
        return 0.0
    return _chance(gain, degrees, free, free, rest, parts, noise_known(runs, parts))


def _of_one_height(by_run: Floats, rest: Floats) -> float:
    """Gain of waves (n, runs, 2) with a phase of their own in each run, and one height in all.

    A wheel's shape is the robot's; only the zero of its counter is another one in each run.
    """
    heights, sizes = [], []
    for run in range(by_run.shape[1]):
        wave = np.linalg.lstsq(by_run[:, run], rest, rcond=None)[0]
        heights.append(np.linalg.norm(wave))
        sizes.append(np.linalg.norm(by_run[:, run] @ wave))
    # Each run knows its own height h by (size / h)^2: the mean, weighted by that.
    known = np.divide(sizes, heights, out=np.zeros(len(sizes)), where=np.array(heights) > 0.0) ** 2
    return float((known @ heights) ** 2 / np.sum(known)) if known.any() else 0.0


def _drive_alone(free: Floats, rest: Floats, run: NDArray[np.intp], seen: Floats) -> int | None:
    """Index of the drive without which a pattern vanishes, though the others could show it.

    A law belongs to the robot, so it must remain when any one drive is left out (a jackknife over
    drives). `free` (n, k): the pattern's columns with the nuisances projected out. `rest` (n,):
    whitened innovations with the nuisances projected out. `run` (n,): drive of each innovation.
    `seen` (n, p): the pattern's functions, of all drives alike.
    """
    if np.unique(run).size < rules.DRIVES_TO_LEAVE_ONE:
        return None
    size = np.sqrt(np.sum(free**2, axis=0))
    scaled = free[:, size > 0.0] / size[size > 0.0]
    explained = scaled @ np.linalg.lstsq(scaled, rest, rcond=None)[0]
    first = int(np.argmax(np.bincount(run, rest**2 - (rest - explained) ** 2)))
    others = run != first
    size = np.sqrt(np.sum(seen**2, axis=0))
    unit = seen[:, size > 0.0] / size[size > 0.0]
    # Functions weigh as what that drive shows by them: of a floor, the places where it errs.
    weight = (unit[~others].T @ rest[~others]) ** 2
    if weight @ np.sum(unit[others] ** 2, axis=0) < rules.OTHER_DRIVES * np.sum(weight):
        return None
    basis, values, _ = np.linalg.svd(scaled[others], full_matrices=False)
    own = basis[:, values > rules.LASTING_HEARD]
    gain = float(np.sum((own.T @ rest[others]) ** 2))
    return None if chi2_survival(gain, own.shape[1]) < rules.SURE_WHEN_ASKED else first


def noise_known(runs: Concatenated, parts: NDArray[np.intp]) -> int:
    """Number of parts for which the likelihood's noise stands, where short drives have few."""
    return max(rules.LASTING_NOISE - int(parts.max()) - 1, 0) if few_parts(runs, parts) else 0


def _chance(
    gain: float,
    degrees: int,
    free: Floats,
    anew: Floats,
    rest: Floats,
    parts: NDArray[np.intp],
    known: int = 0,
) -> float:
    """P-value of a pattern's gain, relative to the disagreement between the parts.

    The null hypothesis is a pattern that each part draws anew, without a common mean: coefficients
    N(0, t^2) beside noise of N(0, 1) or more (drives whose reference errs more than others'), in
    units in which all parts together know each coefficient to 1. A part that knows them to 1 / v
    shows them with the variance 1 + t^2 v^2. The ratio of the likelihoods with and without a common
    mean, each at its best t and noise, is referred to Fisher's F with the effective number of
    witnesses (Satterthwaite): a part is one as far as what it would show, s^2, stands out of the
    stated noise, q = 1 - 1 / s^2. Where all parts know as much, that is the F test of an analysis
    of variance. That test itself, with one variance for all parts, takes the silence of those that
    know little for agreement: with the shares of the Kobuki's nine parts a chance of one in a
    thousand was one in sixty, and of three parts among nine one in forty. `free` (n, k): the
    pattern's columns. Of what each drive has of its own (a phase) there is one a drive, and the
    mean has as many. `anew` (n, j): the columns of which each part draws its own: those of the
    drives added up, since no drive knows the others' phases, and all know each phase as well as the
    size. `known`: parts that are added, which know as much as others and show the noise alone.
    """
    basis, drawn = _orthonormal(free), _orthonormal(anew)
    shares, seen, means = [], [], []
    for part in range(parts.max() + 1):
        here = parts == part
        left, values, _ = np.linalg.svd(drawn[here], full_matrices=False)
        shares.append(values**2)
        seen.append(left.T @ rest[here])
        means.append(left.T @ basis[here])
    mean_share = drawn.shape[1] / len(shares)
    share = np.concatenate([*shares, np.full(known, mean_share)])
    shown = np.concatenate([*seen, np.ones(known)])
    way = np.concatenate([*means, np.zeros((known, basis.shape[1]))])
    # Waves with one height in all drives, and a phase in each, gain less than they could.
    part_gained = min(gain / max(float(np.sum((basis.T @ rest) ** 2)), 1e-300), 1.0)
    alone, common, spread_alone = math.inf, math.inf, np.ones(share.size)
    for spread in (0.0, *np.geomspace(*rules.LASTING_SPREADS)):
        wide = 1.0 + spread * share
        pull = way.T @ (shown / wide)
        mean = np.linalg.lstsq((way.T / wide) @ way, pull, rcond=None)[0]
        squares = float(np.sum(shown**2 / wide))
        volume = float(np.sum(np.log(wide)))
        noise, cost = _of_noise(squares, share.size)
        if volume + cost < alone:
            alone, spread_alone = volume + cost, noise * wide
        unexplained = squares - part_gained * float(pull @ mean)
        common = min(common, volume + _of_noise(unexplained, share.size)[1])
    witness = 1.0 - 1.0 / spread_alone
    if not witness.any():  # no more than the noise alone shows
        return 1.0
    witnesses = float(np.sum(witness) ** 2 / np.sum(witness**2))
    freedom = max(witnesses - degrees, 1.0)
    ratio = math.expm1(min((alone - common) / witnesses, math.log(1e40)))
    return fisher_survival(ratio * freedom / degrees, degrees, freedom)


def _of_noise(squares: float, count: int) -> tuple[float, float]:
    """Variance, no less than stated, of that many numbers, and minus twice the log-likelihood."""
    variance = max(squares / count, 1.0)
    return variance, count * math.log(variance) + squares / variance


def _orthonormal(free: Floats) -> Floats:
    """Orthonormal basis (n, r) of what the columns (n, k) determine."""
    size = np.sqrt(np.sum(free**2, axis=0))
    basis, values, _ = np.linalg.svd(free[:, size > 0.0] / size[size > 0.0], full_matrices=False)
    return np.asarray(basis[:, values > DETERMINED * values.max(initial=0.0)])
