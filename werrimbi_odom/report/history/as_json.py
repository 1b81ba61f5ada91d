# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A history as JSON: the drives with all numbers, the changes, the alarms."""

from __future__ import annotations

from dataclasses import asdict
from datetime import datetime, timezone
from typing import Any

from werrimbi_odom.inference.changes.dated import Dated, History
from werrimbi_odom.report.changes import changes_json
from werrimbi_odom.report.history.words import against, alarms, told_as


def json_of(history: History) -> dict[str, Any]:
    """Everything that was found."""
    course = history.course
    paths = [str(drive.run) for drive in history.drives]
    return {
        "drives": [
            {
                "run": str(drive.run),
                "date": _date(drive),
                "date_from": drive.date_from,
                "way_m": drive.told.way,
                "numbers": {
                    number.name: {
                        "value": float(number.own[index]),
                        "std": float(number.own_std[index]),
                        "pooled": float(number.pooled[index]),
                        "pooled_std": float(number.pooled_std[index]),
                    }
                    for number in course.numbers
                },
            }
            for index, drive in enumerate(history.drives)
        ],
        "numbers": {
            number.name: {
                "unit": number.unit,
                "now": float(number.level[-1]),
                "std": float(number.level_std[-1]),
                "robot_file": number.given,
                "scatter": number.scatter,
            }
            for number in course.numbers
        },
        "changes": [
            {**each, "date": _date(history.drives[int(move.from_run)])}
            for move, each in zip(
                course.changes, changes_json(told_as(history, paths), history.robot), strict=True
            )
        ],
        "alarms": [asdict(alarm) for alarm in alarms(history)],
        "like": [asdict(each) for each in against(history)],
        "unusable": [{"run": str(each.run), "why": each.why} for each in history.unusable],
    }


def _date(drive: Dated) -> str | None:
    if drive.date_from == "order":
        return None
    return datetime.fromtimestamp(drive.date, timezone.utc).isoformat(timespec="seconds")
