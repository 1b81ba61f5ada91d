# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What recordings hold, for programs."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from werrimbi_odom.files.bag_contents import Measured, Wheels
from werrimbi_odom.inference.recording_info import Held, Info, can_tell, measures_of
from werrimbi_odom.report.info import next_step
from werrimbi_odom.report.phrases import left_out_json


def info_json(found: Info) -> dict[str, Any]:
    """For programs; times in each run's own clock [s]."""
    robot = found.given or found.written
    return {
        "runs": [_json_of(each, found) for each in found.held],
        "robot": None if robot is None else str(robot),
        "first_robot": {
            "wheel_radius": found.first.radius,
            "wheel_separation": found.first.separation,
            "ticks_per_revolution": found.first.ticks,
            "left_wheel_names": list(found.first.left),
            "right_wheel_names": list(found.first.right),
        }
        if found.given is None
        else None,
        "next": next_step(found)[1] or None,
    }


def _json_of(held: Held, found: Info) -> dict[str, Any]:
    contents, drive = held.contents, held.driven
    can, cannot = can_tell(held, found.sizes)
    return {
        "run": str(held.path),
        "problem": held.problem or None,
        "wheels": []
        if contents is None
        else [
            {"topic": each.name, "type": each.kind, "gives": each.gives, "joints": each.joints}
            | {"messages": each.messages, "taken": each.name == _name(held.wheels)}
            for each in contents.wheels
        ],
        "wheel_joints": {"left": held.joints.left, "right": held.joints.right}
        | {"no_wheels": held.joints.others},
        "references": [_reference(each, held) for each in contents.references]
        if contents is not None
        else [{"topic": "reference.csv", "measures": measures_of(held), "taken": True}],
        "stamps": {
            name: asdict(each) | {"believed": each.believed} for name, each in held.stamps.items()
        },
        "spans": [
            {"from_s": span.begin, "to_s": span.end, "what": span.what} for span in drive.spans
        ]
        if drive is not None
        else [],
        "distance_m": drive.way if drive is not None and found.sizes else None,
        "turned_rad": drive.turned if drive is not None and found.sizes else None,
        "left_out": left_out_json(held.left_out),
        "restamped_s": held.restamped,
        "scans_restamped_s": held.scans_restamped,
        "gyro_bias_rad_per_s": held.gyro_bias,
        "can_show": can,
        "cannot_show": cannot,
    }


def _name(wheels: Wheels | None) -> str:
    return "" if wheels is None else wheels.name


def _reference(each: Measured, held: Held) -> dict[str, Any]:
    return {
        "topic": each.name,
        "type": each.kind,
        "measures": each.measures,
        "independent": each.independent,
        "why": each.why,
        "messages": each.messages,
        "taken": each == held.reference,
    }
