# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A diagnosis as JSON, field for field as the contract says; NaN where a figure does not exist."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

import numpy as np

from werrimbi_odom.inference.changes.between_drives import Moved
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis
from werrimbi_odom.inference.diagnosis.estimated_values import best_sizes, values_of, widest
from werrimbi_odom.inference.diagnosis.evidence import Dependence
from werrimbi_odom.inference.diagnosis.paired_comparison import Sides
from werrimbi_odom.inference.manoeuvres.advice import beyond_chance, one_each, significant
from werrimbi_odom.inference.manoeuvres.detection_limits import DetectionLimit
from werrimbi_odom.inference.manoeuvres.proposal import Manoeuvre
from werrimbi_odom.report.changes import changes_json
from werrimbi_odom.report.diagnosis.dependence import dependence_words
from werrimbi_odom.report.events import alike_json, events_json
from werrimbi_odom.report.numbers import picked
from werrimbi_odom.report.phrases import left_out_json, remarks_json


def json_of(
    diagnosis: Diagnosis,
    manoeuvre: Manoeuvre | None,
    sights: Sequence[DetectionLimit] = (),
    changes: Sequence[Moved] = (),
) -> dict[str, Any]:
    """Everything that was found."""
    return {
        "verdict": diagnosis.verdict,
        "effect": diagnosis.effect,
        "ranking": [
            {
                "effect": item.effect,
                "p_value": item.p_value,
                "train": _sides(item.train),
                "holdout": _sides(item.holdout),
            }
            for item in diagnosis.ranking
        ],
        "rivals": list(diagnosis.rivals),
        "rivals_of_others": {name: list(each) for name, each in diagnosis.rivals_of_others.items()},
        "rivals_by_halves": list(diagnosis.torn),
        "rivals_of_held": {name: list(each) for name, each in diagnosis.rivals_of_held.items()},
        "depends_on": [_cell(cell) for cell in significant(diagnosis)],
        "next_manoeuvre": None if manoeuvre is None else asdict(manoeuvre),
        "found": [
            {"effect": name, "parameters": _parameters(diagnosis, name)} for name in diagnosis.found
        ],
        "set_up": [
            {
                **picked(finding, "effect values factor words"),
                "twins": list(finding.twins),
            }
            for finding in diagnosis.set_up.wrong
        ],
        "recorded_otherwise": [
            {
                "run": each.run,
                "held_out": each.held_out,
                "effects": list(each.effects),
                "words": [finding.words for finding in each.findings],
            }
            for each in diagnosis.otherwise
        ],
        "calibration": _calibration(diagnosis),
        "train": _sides(diagnosis.train, diagnosis.headings[0]),
        "holdout": _sides(diagnosis.holdout, diagnosis.headings[1]),
        "without_events": dict(zip(("train", "holdout"), map(_sides, diagnosis.quiet), strict=True))
        if diagnosis.happened.left_out
        else None,
        "reference_remarks": remarks_json(diagnosis.remarks),
        "left_out": left_out_json(diagnosis.left_out),
        "remaining": [_cell(cell) for cell in one_each(beyond_chance(diagnosis.remaining))],
        "widened": widest(diagnosis),
        "misfit": None
        if diagnosis.misfit is None
        else {
            "effect": diagnosis.misfit.effect,
            "share": diagnosis.misfit.share,
            "only_in": diagnosis.misfit.only_in,
            **_cell(diagnosis.misfit.cell),
        },
        "changes": changes_json(changes, diagnosis.robot),
        "events": events_json(diagnosis.happened, diagnosis.robot.track),
        "events_alike": alike_json(diagnosis.happened),
        "could_have_been_seen": [_limit(sight) for sight in sights],
    }


def _calibration(diagnosis: Diagnosis) -> dict[str, Any]:
    """Base and radii of the best model; no deviation where one stays as the robot file has it."""
    if diagnosis.of_another_drive:
        return {}
    return {
        name: {"value": value, "std": std or None}
        for name, (value, std) in best_sizes(diagnosis).items()
    }


def _cell(cell: Dependence) -> dict[str, Any]:
    return {
        "channel": cell.channel,
        "variable": cell.name,
        "p_value": cell.p_value,
        "per": cell.amount.per,
        "form": cell.form,
        "coefficients": np.asarray(cell.coefficients).tolist(),
        "gain": cell.gain,
        "degrees": cell.degrees,
        "words": dependence_words(cell),
    }


def _sides(sides: Sides | None, headings: Sides | None = None) -> dict[str, Any]:
    """Position errors [m]; of headings alone there are none, and theirs stand beside."""
    found: dict[str, Any] = {"before": None, "after": None}
    if sides is not None:
        both = {"before": sides.before, "after": sides.after}
        if sides.unit == "m":
            found = both
        else:
            headings = sides
    if headings is not None:
        found["rmse_yaw_rad"] = {"before": headings.before, "after": headings.after}
    return found


def _parameters(diagnosis: Diagnosis, name: str) -> dict[str, Any]:
    return {
        parameter: {
            "value": value.value if value.determined else None,
            "std": value.std if value.determined else None,
            "unit": value.unit,
            "per_run": value.per_run,
        }
        for parameter, value in values_of(diagnosis, name).items()
    }


def _limit(limit: DetectionLimit) -> dict[str, Any]:
    values = asdict(limit)
    return {**values, "seen_from": values.pop("minimum_detectable"), "hidden": limit.hidden}
