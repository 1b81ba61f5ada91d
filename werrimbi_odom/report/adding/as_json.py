# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Added effects as JSON with the names of the contract: values, errors, and what remains."""

from __future__ import annotations

from typing import Any

from werrimbi_odom.inference.adding.added import Added, JudgedSide
from werrimbi_odom.inference.fitting.free_parameters import MULTIPLIERS
from werrimbi_odom.report.events import events_json
from werrimbi_odom.report.number_format import or_else_json, picked
from werrimbi_odom.report.phrases import left_out_json


def json_of(added: Added) -> dict[str, Any]:
    """JSON with the names of the contract, and more."""
    return {
        "effect": added.name,
        "effects": [effect.name for effect in added.effects],
        "parameters": {
            name: {
                **picked(item, "value std remark of_runs"),
                **picked(item.declared, "unit null says"),
                **or_else_json(item.or_else),
            }
            for name, item in added.parameters.items()
        },
        "moved": {
            each.name: {"before": each.before, **picked(each.now, "value std")}
            for each in added.moved
        },
        "train": _side(added, added.train),
        "holdout": {
            **_side(added, added.holdout),
            "without": dict(added.without),
            "set_aside": list(added.set_aside),
        },
        "calibration": {
            name: {"value": getattr(added.robot, name), "std": added.multiplier_stds[name]}
            for name in MULTIPLIERS
        },
        "noise": {
            "written": added.explained,
            **{
                name: {
                    **picked(item, "value determined"),
                    "std": item.std if added.explained else None,
                }
                for name, item in added.noises.items()
            },
        },
        **picked(added, "put_right_with_it:also per_run fitted_on_all:written_from_all"),
        "remaining": [picked(cell, "channel variable:name p_value") for cell in added.remaining],
        "p_value": max((p for p in added.chances.values() if p is not None), default=None),
        **picked(added, "p_values:chances objection objections covariance explains:verdict.good"),
        "ahead_or_behind": added.ahead_or_behind,
        "left_out": left_out_json(added.left_out),
        "events": events_json(added.happened, added.robot.track),
    }


def _side(added: Added, side: JudgedSide) -> dict[str, Any]:
    before, after = side.figures("before"), side.figures("after")
    return {
        **picked(before, "before:rmse_position_m median_before:median_position_m"),
        **picked(after, "after:rmse_position_m median_after:median_position_m"),
        "rmse_yaw_rad": {"before": before.rmse_yaw_rad, "after": after.rmse_yaw_rad},
        "calibrated": side.figures("calibrated").rmse_position_m,
        "noise_alone": added.noise_alone(side),
        **picked(after, "nees coverage_95 legs:count"),
        "outliers": int(side.after.outlier.sum()),
    }
