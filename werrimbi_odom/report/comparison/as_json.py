# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A comparison as JSON, field for field; angles in radians, lengths in metres."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

import numpy as np

from werrimbi_odom.inference.comparison.compare import (
    KINDS,
    Comparison,
    LegFigures,
    OfLength,
    RunFigures,
)
from werrimbi_odom.inference.comparison.dependence import ByVariable, Cell
from werrimbi_odom.inference.comparison.judged_legs import Legs
from werrimbi_odom.inference.comparison.systematic import Systematic
from werrimbi_odom.inference.comparison.verdict import verdict_of
from werrimbi_odom.report.number_format import picked
from werrimbi_odom.report.phrases import left_out_json, remarks_json


def json_of(comparison: Comparison) -> dict[str, Any]:
    """Complete result; NaN for what was not measured (null in the file)."""
    main, verdict = comparison.main, verdict_of(comparison)
    return {
        "runs": [_run(item) for item in comparison.runs],
        "legs": legs_json(main.all),
        "by_motion": {kind: legs_json(main.by_motion[kind]) for kind in KINDS},
        "leg_m": comparison.main.leg,
        "verdict": {
            **picked(verdict, "good enough mean_is_right gross covariance noise"),
            "noise_factor": list(picked(verdict.factor, "value low high").values()),
            "systematic": [_systematic(part) for part in verdict.systematic],
            "depends_on": [picked(item, "channel variable p_value") for item in verdict.depends],
        },
        "systematic": [_systematic(part) for part in main.systematic],
        "by_length": [_of_length(item) for item in comparison.lengths],
        "by_variable": {item.name: _variable(item) for item in comparison.variables},
        "floor": [_cell(cell) for cell in comparison.cells],
        "reference": [
            {"measures": measure, **asdict(noise)} for measure, noise in comparison.prepared.noises
        ],
        "reference_remarks": remarks_json(comparison.remarks),
        "left_out": left_out_json(comparison.left_out),
        "outliers": _outliers(comparison),
        "each_leg": _each_leg(comparison),
    }


def legs_json(figures: LegFigures) -> dict[str, Any]:
    """Statistics over some legs, with the names of the contract."""
    return {
        **picked(figures.figures, "count rmse_position_m median_position_m"),
        **picked(figures.figures, "rmse_yaw_rad nees coverage_95"),
        **picked(figures, "outliers rmse_all_position_m"),
        "nees_without_systematic": figures.dispersion_nees,
        "noise_factor": list(figures.noise),
    }


def _run(item: RunFigures) -> dict[str, Any]:
    return {
        **picked(item, "run:run.path distance_m duration_s end_error_m end_error_rad rmse_path_m"),
        "legs": legs_json(item.legs),
    }


def _of_length(item: OfLength) -> dict[str, Any]:
    return {
        "leg_m": item.leg,
        **legs_json(item.all),
        "by_motion": {kind: legs_json(item.by_motion[kind]) for kind in KINDS},
    }


def _systematic(part: Systematic) -> dict[str, Any]:
    return {**asdict(part), "finding": part.finding}


_MEANS = ("mean_along_m", "mean_sideways_m", "mean_heading_rad")


def _variable(item: ByVariable) -> dict[str, Any]:
    return {
        "p_values": dict(item.p_values),
        "bins": [
            {
                **picked(part, "low high"),
                **dict(zip(_MEANS, part.mean, strict=True)),
                **asdict(part.figures),
            }
            for part in item.bins
        ],
    }


def _cell(cell: Cell) -> dict[str, Any]:
    names = "x_m:x y_m:y side_m:side p_value stands_out"
    return {**picked(cell, names), **asdict(cell.figures)}


def _outliers(comparison: Comparison) -> list[dict[str, Any]]:
    """Legs on which the reference jumped."""
    legs = comparison.legs
    return [
        {
            "run": str(comparison.runs[legs.run[index]].run.path),
            "t_start_s": float(legs.start_time[index]),
            "t_end_s": float(legs.end_time[index]),
        }
        for index in np.flatnonzero(legs.outlier).tolist()
    ]


def _each_leg(comparison: Comparison) -> dict[str, Any]:
    """All legs of the requested length, as columns."""
    legs: Legs = comparison.legs
    errors = legs.errors
    sigmas = np.sqrt(np.maximum(np.diagonal(errors.covariance, axis1=1, axis2=2), 0.0))
    sigmas = np.where(np.isfinite(errors.error), sigmas, np.nan)
    channels = ("along_m", "sideways_m", "heading_rad")
    return {
        **picked(legs, "run t_start_s:start_time t_end_s:end_time x_m:x y_m:y"),
        **picked(legs, "motion:errors.kind outlier travel_m:errors.along turn_rad:errors.turn"),
        **{f"error_{name}": column for name, column in zip(channels, errors.error.T, strict=True)},
        **{f"sigma_{name}": column for name, column in zip(channels, sigmas.T, strict=True)},
        **legs.variables,
    }
