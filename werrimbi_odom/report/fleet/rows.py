# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What became of each robot of a fleet, as words, table, figure and JSON need it."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

ERROR = "error"
"""In place of a verdict, where a robot could not be diagnosed."""


@dataclass(frozen=True)
class Row:
    """One robot: its diagnosis as `report.diagnosis.as_json` tells it, or why there is none."""

    robot: str
    runs: int
    """Drives, those to judge on among them."""
    figures: Mapping[str, Any] | None = None
    error: str = ""

    @property
    def verdict(self) -> str:
        """One of the four, or `ERROR`."""
        return ERROR if self.figures is None else str(self.figures["verdict"])

    @property
    def missing(self) -> tuple[str, ...]:
        """Effects that were found and are told apart from others, the most important first."""
        if self.figures is None:
            return ()
        rivals = self.rivals
        return tuple(
            item["effect"] for item in self.figures["found"] if item["effect"] not in rivals
        )

    @property
    def rivals(self) -> tuple[str, ...]:
        """Effects that its drives cannot tell apart."""
        return () if self.figures is None else tuple(self.figures["rivals"])

    @property
    def errors(self) -> tuple[float, float]:
        """Position error of held-out legs as given and with everything found [m]; NaN: unknown."""
        if self.figures is None:
            return math.nan, math.nan
        sides = self.figures["holdout"]
        return _number(sides["before"]), _number(sides["after"])

    def values(self, effect: str) -> Mapping[str, Mapping[str, Any]]:
        """Fitted parameters of an effect by name: `value`, `std`, `unit`, `per_run`."""
        if self.figures is None:
            return {}
        for item in self.figures["found"]:
            if item["effect"] == effect:
                parameters: Mapping[str, Mapping[str, Any]] = item["parameters"]
                return parameters
        return {}


@dataclass(frozen=True)
class Fleet:
    """All robots that are done, in their order, and those that were left undone."""

    rows: tuple[Row, ...]
    left: tuple[str, ...] = ()
    same_file: frozenset[str] = frozenset()
    """Robots whose robot file is, byte for byte, that of another one."""

    @property
    def by_effect(self) -> dict[str, list[Row]]:
        """Robots that miss each effect; the effect that most of them miss first."""
        found: dict[str, list[Row]] = {}
        for row in self.rows:
            for effect in row.missing:
                found.setdefault(effect, []).append(row)
        return dict(sorted(found.items(), key=lambda item: (-len(item[1]), item[0])))


def fleet_json(fleet: Fleet) -> dict[str, Any]:
    """Everything, for programs."""
    verdicts: dict[str, int] = {}
    for row in fleet.rows:
        verdicts[row.verdict] = verdicts.get(row.verdict, 0) + 1
    return {
        "robots": [
            {"robot": row.robot, "error": row.error}
            if row.figures is None
            else {"robot": row.robot, **row.figures}
            for row in fleet.rows
        ],
        "missing": {
            effect: [row.robot for row in rows] for effect, rows in fleet.by_effect.items()
        },
        "verdicts": dict(sorted(verdicts.items())),
        "left": list(fleet.left),
    }


def believed(parameters: Mapping[str, Mapping[str, Any]]) -> dict[str, Mapping[str, Any]]:
    """Those of an effect's parameters that are worth a place in a table.

    Without those that each drive has anew, and those that noise alone could have made; all, where
    nothing would be left.
    """
    shared = {name: item for name, item in parameters.items() if not item["per_run"]}
    sure = {
        name: item
        for name, item in shared.items()
        if not abs(_number(item["value"])) < 2.0 * _number(item["std"])
    }
    return sure or shared


def ordered(rows: Sequence[Row], names: Sequence[str]) -> tuple[Row, ...]:
    """Rows in the order of names."""
    place = {name: number for number, name in enumerate(names)}
    return tuple(sorted(rows, key=lambda row: place[row.robot]))


def _number(value: float | None) -> float:
    """JSON has null for what does not exist."""
    return math.nan if value is None else float(value)
