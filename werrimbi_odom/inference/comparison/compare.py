# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Model against measurement, leg by leg: errors, dependences, consistency of the covariance."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.run import Run, by_hand
from werrimbi_odom.inference.comparison.consistency import AtLength
from werrimbi_odom.inference.comparison.dependence import ByVariable, Cell, by_variables, cells_of
from werrimbi_odom.inference.comparison.judged_legs import Legs, in_runs, judged_legs, paths
from werrimbi_odom.inference.comparison.leg_errors import (
    LegStatistics,
    root_mean_square,
    squared_deviation,
    statistics,
)
from werrimbi_odom.inference.comparison.prepared_runs import PreparedRuns, prepare, refuse_standing
from werrimbi_odom.inference.comparison.reference_checks import remarks_on
from werrimbi_odom.inference.comparison.reference_remark import ReferenceRemark
from werrimbi_odom.inference.comparison.residuals import Residual
from werrimbi_odom.inference.comparison.systematic import (
    NoiseFactor,
    Systematic,
    noise_factors,
    systematic_parts,
)
from werrimbi_odom.inference.fitting.free_parameters import Model
from werrimbi_odom.inference.legs.count_interpolation import Counters
from werrimbi_odom.inference.legs.gaps import LeftOut, touched
from werrimbi_odom.model.effect import wiring_of
from werrimbi_odom.model.pose import Floats, wrap
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.progress import Show, silent

KINDS = ("line", "arc", "spin")


@dataclass(frozen=True, slots=True)
class LegFigures:
    """Statistics over some legs; NaN where there are none."""

    figures: LegStatistics
    """Statistics without outliers, except for the median."""
    outliers: int
    rmse_all_position_m: float
    """Position RMSE including outliers."""
    dispersion_nees: float
    """NEES after removing the systematic part."""
    noise: NoiseFactor
    """Maximum-likelihood factor on the variance of the wheel noise, from this dispersion."""


@dataclass(frozen=True, slots=True)
class OfLength:
    """Statistics over all legs of one length."""

    leg: float
    """As asked for [m]."""
    median: float
    """Median path of the legs, longer than asked for where poses are rare [m]."""
    all: LegFigures
    by_motion: Mapping[str, LegFigures]
    systematic: tuple[Systematic, ...]

    @property
    def consistency(self) -> AtLength:
        """NEES of all legs of this length."""
        return self._consistency(self.all)

    def consistency_of(self, kind: str) -> AtLength:
        """NEES of the legs of one type of motion."""
        return self._consistency(self.by_motion[kind])

    def _consistency(self, of: LegFigures) -> AtLength:
        figures = of.figures
        return AtLength(self.leg, figures.count, figures.nees, figures.freedom, self.median)

    @property
    def consistency_of_dispersion(self) -> AtLength:
        """NEES after removing the systematic part of the errors."""
        return replace(self.consistency, nees=self.all.dispersion_nees)


@dataclass(frozen=True, slots=True)
class RunFigures:
    """Statistics of one run."""

    run: Run
    distance_m: float
    """Absolute travel of the axle's midpoint while the robot was neither held nor carried."""
    duration_s: float
    end_error_m: float
    """Error at the last reference pose, dead reckoning from the first; NaN where the robot was held
    or carried in between, or the path of a reference with axes of its own is in pieces."""
    end_error_rad: float
    """Heading error there, measured minus predicted."""
    rmse_path_m: float
    """RMSE over all reference poses."""
    legs: LegFigures


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Comparison:
    """Result of a comparison, with the legs themselves for plots."""

    prepared: PreparedRuns
    model: Model
    runs: tuple[RunFigures, ...]
    lengths: tuple[OfLength, ...]
    """One for each leg length, ascending."""
    variables: tuple[ByVariable, ...]
    cells: tuple[Cell, ...]
    legs: Legs
    """Legs of the requested length."""
    paths: tuple[Residual, ...]
    left_out: tuple[LeftOut, ...]
    """Stretches of the runs that are excluded."""
    remarks: tuple[ReferenceRemark, ...]
    """Anomalies of the reference."""

    @property
    def main(self) -> OfLength:
        """Statistics for the requested length."""
        return next(item for item in self.lengths if item.leg == self.prepared.options.leg)

    @property
    def median_length(self) -> float:
        """Median path of these legs, longer than requested where poses are rare [m]."""
        return self.main.median


def compare(
    runs: Sequence[Run],
    robot: Robot | Model,
    options: EvaluationOptions = EvaluationOptions(),
    *,
    show: Show = silent,
) -> Comparison:
    """Compare a model with recorded runs.

    `runs`: recorded runs. `robot`: a `Model` has its own per-run values (phases, start headings).
    Those missing from a robot file are estimated in each run. `options`: leg length and what is
    known of the reference. `show`: progress callback. InputError if a run has no usable reference
    or no ticks, or if neither it nor the wheels ever move.
    """
    own = robot.robot if isinstance(robot, Model) else robot
    refuse_standing(runs, carried=True)
    prepared = prepare(runs, own, options, show=lambda share, words: show(0.5 * share, words))
    return judged(prepared, robot, show=lambda share, words: show(0.5 + 0.5 * share, words))


def judged(prepared: PreparedRuns, robot: Robot | Model, *, show: Show = silent) -> Comparison:
    """Compare a model over prepared runs, so that two models are compared over the same legs."""
    model = robot if isinstance(robot, Model) else in_runs(prepared, robot)
    lengths, main = [], None
    for number, leg in enumerate(sorted(prepared.cuts)):
        show(number / (len(prepared.cuts) + 1), f"legs of {leg:g} m")
        legs = judged_legs(prepared, model, leg)
        systematic, left = systematic_parts(legs.errors.chosen(~legs.outlier))
        spread = np.full(legs.errors.error.shape, np.nan)
        spread[~legs.outlier] = left
        groups = [np.ones(legs.run.size, dtype=np.bool_)]
        groups += [legs.errors.kind == kind for kind in KINDS]
        if leg == prepared.options.leg:
            groups += [legs.run == index for index in range(len(prepared.runs))]
        whole, *others = _figures(legs, spread, np.array(groups))
        by_motion = dict(zip(KINDS, others, strict=False))
        length = legs.errors.length
        median = float(np.median(length)) if length.size else 0.0
        lengths.append(OfLength(leg, median, whole, by_motion, systematic))
        if leg == prepared.options.leg:
            main = legs, spread, others[len(KINDS) :]
    assert main is not None
    legs, spread, of_runs = main
    path, counters = paths(prepared, model), prepared.counters
    kept = ~legs.outlier
    chosen = legs.errors.chosen(kept)
    return Comparison(
        prepared=prepared,
        model=model,
        runs=tuple(
            _run_figures(run, counters[index], path[index], of_runs[index], model.of_run(index))
            for index, run in enumerate(prepared.runs)
        ),
        lengths=tuple(lengths),
        variables=by_variables(
            chosen, spread[kept], {name: part[kept] for name, part in legs.variables.items()}
        ),
        cells=cells_of(
            chosen,
            spread[kept],
            0.5 * (legs.x + legs.end_x)[kept],
            0.5 * (legs.y + legs.end_y)[kept],
            prepared.options.leg,
        ),
        legs=legs,
        paths=path,
        left_out=prepared.left_out,
        remarks=remarks_on(prepared),
    )


def _figures(legs: Legs, left: Floats, groups: NDArray[np.bool_]) -> list[LegFigures]:
    """Statistics of groups of legs, each a row of a mask (g, m)."""
    errors = legs.errors
    factors = noise_factors(left, errors.covariance, errors.wheels, groups & ~legs.outlier)
    return [
        _figures_of(legs, left, which, factor)
        for which, factor in zip(groups, factors, strict=True)
    ]


def _figures_of(
    legs: Legs, left: Floats, which: NDArray[np.bool_], noise: NoiseFactor
) -> LegFigures:
    kept = which & ~legs.outlier
    every, chosen = legs.errors.chosen(which), legs.errors.chosen(kept)
    figures, whole = statistics(chosen), statistics(every)
    spread = left[kept]
    freedom = int(np.isfinite(spread).sum())
    scatter = squared_deviation(spread, chosen.covariance).sum() / freedom if freedom else np.nan
    return LegFigures(
        replace(figures, median_position_m=whole.median_position_m),
        int((which & legs.outlier).sum()),
        root_mean_square(every.distance),
        float(scatter),
        noise,
    )


def _run_figures(
    run: Run, counters: Counters, path: Residual, legs: LegFigures, robot: Robot
) -> RunFigures:
    off = np.abs(path.measured - path.predicted)
    turned = np.flatnonzero(np.isfinite(path.measured_yaw))
    in_pieces = run.reference is not None and run.reference.own_axes and run.taken_out
    handled = by_hand(run.no_driving)
    # Each piece has axes of its own; a hand is no dead reckoning.
    if in_pieces or handled:
        off, turned = np.full_like(off, np.nan), turned[:0]
    known = np.flatnonzero(np.isfinite(off))
    last = int(turned[-1]) if turned.size > 1 else 0
    # The counters are unwrapped, and bridged where they leapt.
    left, right = wiring_of(robot.effects).wheels(counters.left, counters.right)
    travel = 0.5 * np.diff(left * robot.left_tick + right * robot.right_tick)
    no_driving = touched(counters.time, [(part.begin, part.end) for part in handled])
    return RunFigures(
        run,
        float(np.abs(travel[~no_driving]).sum()),
        float(np.ptp(run.ticks.time)),
        float(off[known[-1]]) if known.size else np.nan,
        wrap(float(path.measured_yaw[last] - path.predicted_yaw[last])) if last else np.nan,
        root_mean_square(off),
        legs,
    )
