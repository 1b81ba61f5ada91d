# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A diagnosis as JSON with the names of the contract; angles in radians, lengths in metres."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.changes.between_drives import ParameterChange
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis
from werrimbi_odom.inference.diagnosis.estimated_values import best_sizes, values_of, widest
from werrimbi_odom.inference.diagnosis.evidence import Dependence
from werrimbi_odom.inference.diagnosis.mended_mount import mended_mount
from werrimbi_odom.inference.diagnosis.one_sided_noise import OneSidedNoise
from werrimbi_odom.inference.diagnosis.paired_comparison import Sides
from werrimbi_odom.inference.diagnosis.what_is_left import WhatIsLeft
from werrimbi_odom.inference.drafting.draft import as_a_floor
from werrimbi_odom.inference.manoeuvres.advice import beyond_chance, one_each, significant
from werrimbi_odom.inference.manoeuvres.detection_limits import DetectionLimit
from werrimbi_odom.inference.manoeuvres.for_unexplained_errors import ProposedManoeuvre
from werrimbi_odom.report.changes import changes_json
from werrimbi_odom.report.diagnosis.dependence import dependence_words
from werrimbi_odom.report.events import alike_json, events_json
from werrimbi_odom.report.number_format import or_else_json, picked
from werrimbi_odom.report.phrases import left_out_json, remarks_json

_WANDER = (
    "second_xy_m:place_in_a_second second_yaw_rad:heading_in_a_second xy_m:place yaw_rad:heading "
    "for_s:seconds"
)


def json_of(
    diagnosis: Diagnosis,
    manoeuvre: ProposedManoeuvre | None,
    sights: Sequence[DetectionLimit] = (),
    changes: Sequence[ParameterChange] = (),
) -> dict[str, Any]:
    """Complete result."""
    misfit = diagnosis.misfit
    return {
        **picked(
            diagnosis,
            "verdict effect rivals rivals_by_halves:torn ahead_or_behind needless_of_held",
        ),
        **{
            part: {name: list(each) for name, each in getattr(diagnosis, part).items()}
            for part in ("rivals_of_others", "rivals_of_held")
        },
        "ranking": [
            {
                **picked(item, "effect p_value"),
                "train": _sides(item.train),
                "holdout": _sides(item.holdout),
            }
            for item in diagnosis.ranking
        ],
        "depends_on": [_cell(cell) for cell in significant(diagnosis)],
        "next_manoeuvre": manoeuvre and asdict(manoeuvre),
        "found": [
            {"effect": name, "parameters": _values(diagnosis, name)} for name in diagnosis.found
        ],
        "outdated": [
            {"effect": name, "parameters": _values(diagnosis, name)} for name in diagnosis.outdated
        ],
        "transform_to_mend": _transform(diagnosis),
        "set_up": [
            picked(finding, "effect values factor words twins")
            for finding in diagnosis.set_up.wrong
        ],
        "recorded_otherwise": [
            {
                **picked(each, "run held_out effects"),
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
        "left": diagnosis.left and _left(diagnosis.left),
        "reference_remarks": remarks_json(diagnosis.remarks),
        "reference_wanders": diagnosis.wander and picked(diagnosis.wander, _WANDER),
        "one_sided_noise": diagnosis.one_sided and _one_sided(diagnosis.one_sided),
        "left_out": left_out_json(diagnosis.left_out),
        "remaining": [_cell(cell) for cell in one_each(beyond_chance(diagnosis.remaining))],
        "widened": widest(diagnosis),
        "misfit": misfit and {**picked(misfit, "effect share only_in"), **_cell(misfit.cell)},
        "changes": changes_json(changes, diagnosis.robot),
        "events": events_json(diagnosis.happened, diagnosis.robot.track),
        "events_alike": alike_json(diagnosis.happened, diagnosis.left_by),
        "by_events": diagnosis.by_events,
        "as_a_floor": diagnosis.verdict == "unknown" and as_a_floor(diagnosis),
        "could_have_been_seen": [_limit(sight) for sight in sights],
    }


def _transform(diagnosis: Diagnosis) -> dict[str, Any] | None:
    """What the transform of the reference's mount should be; None if nothing of it is wrong."""
    found = mended_mount(diagnosis)
    if found is None:
        return None
    return {
        **picked(found.entered, "base sensor"),
        "entered": {part: getattr(found.entered, part) for part in found.std},
        **{
            part: {"value": getattr(found.mended, part), "std": std}
            for part, std in found.std.items()
        },
        "effects": list(found.effects),
    }


def _one_sided(noise: OneSidedNoise) -> dict[str, Any]:
    """Noise of wheels of which one errs far more than the other [m^0.5]."""
    sides = {"left": noise.left, "right": noise.right}
    return {
        "side": noise.side,
        "along": noise.along,
        **{f"{name}_wheel_noise": picked(each, "value std") for name, each in sides.items()},
    }


def _calibration(diagnosis: Diagnosis) -> dict[str, Any]:
    """Wheel base and radii of the best model; no deviation for those kept from the robot file.

    No value of those that the drives tell less of than a tape does.
    """
    if diagnosis.of_another_drive:
        return {}
    return {
        name: {"value": None, "std": None}
        if (std or 0.0) > rules.CALIBRATION_KNOWN * value
        else {"value": value, "std": std or None}
        for name, (value, std) in best_sizes(diagnosis).items()
    }


def _cell(cell: Dependence) -> dict[str, Any]:
    names = "channel variable:name p_value per:amount.per form coefficients gain degrees"
    return {**picked(cell, names), "words": dependence_words(cell)}


def _sides(sides: Sides | None, headings: Sides | None = None) -> dict[str, Any]:
    """Position errors [m]; none if only headings are measured, with their errors beside."""
    if sides is not None and sides.unit != "m":
        sides, headings = None, sides
    found: dict[str, Any] = {"before": None, "after": None}
    if sides is not None:
        found = picked(sides, "before after")
    if headings is not None:
        found["rmse_yaw_rad"] = picked(headings, "before after")
    return found


def _left(left: WhatIsLeft) -> dict[str, Any]:
    sides = {
        side: picked(getattr(left, side), "error reference_noise:reference")
        for side in ("train", "holdout")
    }
    neighbours = {channel: asdict(each) for channel, each in left.neighbours.items()}
    return {**picked(left, "unit is_reference_noise:is_noise"), **sides, "neighbours": neighbours}


def _values(diagnosis: Diagnosis, name: str) -> dict[str, Any]:
    return {
        parameter: {
            **(picked(value, "value std") if value.determined else {"value": None, "std": None}),
            **picked(value, "unit per_run"),
            **({"of_runs": list(value.of_runs)} if value.of_runs else {}),
            **or_else_json(value.or_else),
        }
        for parameter, value in values_of(diagnosis, name).items()
    }


def _limit(limit: DetectionLimit) -> dict[str, Any]:
    values = asdict(limit)
    return {**values, "seen_from": values.pop("minimum_detectable"), "hidden": limit.hidden}
