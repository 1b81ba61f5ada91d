# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Results of a fleet, robot by robot, in words and as JSON."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from werrimbi_odom.report.document import Paragraph, paragraphs
from werrimbi_odom.report.number_format import error_words as leg_error
from werrimbi_odom.report.number_format import listed

ERROR = "error"
"""Shown in place of a verdict if a robot could not be diagnosed."""
_NOT_DIAGNOSED = {"found": (), "rivals": (), "holdout": {"before": None, "after": None}}


@dataclass(frozen=True)
class Row:
    """One robot: its diagnosis as JSON (`report.diagnosis.as_json`), or the error."""

    robot: str
    runs: int
    """Number of drives, including held-out ones."""
    figures: Mapping[str, Any] | None = None
    error: str = ""

    @property
    def verdict(self) -> str:
        """One of the four verdicts, or `ERROR`."""
        return ERROR if self.figures is None else str(self.figures["verdict"])

    @property
    def told(self) -> Mapping[str, Any]:
        """Its figures; of a robot that could not be diagnosed, that nothing was found."""
        return self.figures or _NOT_DIAGNOSED

    @property
    def missing(self) -> tuple[str, ...]:
        """Effects found without rivals, the most important first."""
        found = (item["effect"] for item in self.told["found"])
        return tuple(effect for effect in found if effect not in self.rivals)

    @property
    def rivals(self) -> tuple[str, ...]:
        """Effects that the drives cannot separate."""
        return tuple(self.told["rivals"])

    @property
    def errors(self) -> tuple[float, float]:
        """Position error of held-out legs, as given and with all found effects [m], or NaN."""
        sides = self.told["holdout"]
        return number(sides["before"]), number(sides["after"])

    def values(self, effect: str) -> Mapping[str, Mapping[str, Any]]:
        """Fitted parameters of an effect by name: `value`, `std`, `unit`, `per_run`."""
        found: dict[str, Mapping[str, Mapping[str, Any]]] = {
            item["effect"]: item["parameters"] for item in self.told["found"]
        }
        return found.get(effect, {})


@dataclass(frozen=True)
class Fleet:
    """All finished robots in order, and those not done."""

    rows: tuple[Row, ...]
    left: tuple[str, ...] = ()
    same_file: frozenset[str] = frozenset()
    """Robots with a robot file identical to that of another one."""

    @property
    def by_effect(self) -> dict[str, list[Row]]:
        """Robots by missing effect; the most frequent effect first."""
        found: dict[str, list[Row]] = {}
        for row in self.rows:
            for effect in row.missing:
                found.setdefault(effect, []).append(row)
        return dict(sorted(found.items(), key=lambda item: (-len(item[1]), item[0])))


def fleet_json(fleet: Fleet) -> dict[str, Any]:
    """Complete result as JSON."""
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
        "verdicts": dict(sorted(Counter(row.verdict for row in fleet.rows).items())),
        "left": list(fleet.left),
    }


def believed(parameters: Mapping[str, Mapping[str, Any]]) -> dict[str, Mapping[str, Any]]:
    """Parameters of an effect that a table shows.

    Without those that are per-run, not determined, or not significant; if none is significant, with
    all that are shared and determined.
    """
    shared = {
        name: item
        for name, item in parameters.items()
        if not item["per_run"] and item["value"] is not None
    }
    sure = {
        name: item
        for name, item in shared.items()
        if not abs(number(item["value"])) < 2.0 * number(item["std"])
    }
    return sure or shared


def ordered(rows: Sequence[Row], names: Sequence[str]) -> tuple[Row, ...]:
    """Rows in the order of names."""
    place = {name: number for number, name in enumerate(names)}
    return tuple(sorted(rows, key=lambda row: place[row.robot]))


def number(value: float | None) -> float:
    """A number from JSON; NaN for null."""
    return math.nan if value is None else float(value)


_GROUPS = 6
"""Number of combinations of missing effects that the headline counts."""
_NAMED = 8
"""Most robots that a sentence names."""
_TOLD = 10
"""Most robots with a printed error message; all are in the JSON."""


def words_of(fleet: Fleet) -> tuple[Paragraph, ...]:
    """All sentences."""
    lines = [headline(fleet), *_shared(fleet), *_alone(fleet), *_errors(fleet), *_left(fleet)]
    return paragraphs(lines)


def headline(fleet: Fleet) -> str:
    """Number of robots by result."""
    parts = []
    verdicts = [row.verdict for row in fleet.rows]
    if count := verdicts.count("none"):
        parts.append(f"{count} {_miss(count)} nothing")
    groups = Counter(row.missing for row in fleet.rows if row.verdict == "named")
    largest = sorted(groups.items(), key=lambda item: (-item[1], item[0]))
    for missing, count in largest[:_GROUPS]:
        parts.append(f"{count} {_miss(count)} {listed(missing)}")
    if count := sum(count for _, count in largest[_GROUPS:]):
        parts.append(f"{count} {_miss(count)} something else")
    for verdict in ("ambiguous", "unknown"):
        if count := verdicts.count(verdict):
            parts.append(f"{count} {verdict}")
    if count := verdicts.count(ERROR):
        parts.append(f"{count} could not be diagnosed")
    robots = len(fleet.rows)
    return f"{robots} robot{'s' if robots != 1 else ''}: {', '.join(parts)}."


def _miss(count: int) -> str:
    return "misses" if count == 1 else "miss"


def _shared(fleet: Fleet) -> list[str]:
    """Effects that most robots miss, which are therefore not specific to one of them."""
    judged = [row for row in fleet.rows if row.verdict != ERROR]
    lines = []
    for effect, rows in fleet.by_effect.items():
        if len(rows) < 2 or 2 * len(rows) <= len(judged):
            continue
        names = {row.robot for row in rows}
        cause = (
            "of their design, or of the robot file, which is the same, byte for byte, for all of "
            "them"
            if names <= fleet.same_file
            else "of their design, or of what their robot files have in common"
        )
        lines.append(
            f"{effect} is missing in {len(rows)} of {len(judged)}: what most robots of a fleet "
            f"have is a matter {cause}, not of one robot.{_agree(rows, effect)}"
        )
    return lines


def _agree(rows: Sequence[Row], effect: str) -> str:
    """Range of the robots' values of an effect, for its most significant parameter."""
    sure = believed(rows[0].values(effect))
    if not sure:
        return ""
    parameter = max(sure, key=lambda name: _certainty(sure[name]))
    values = [row.values(effect)[parameter]["value"] for row in rows]
    if not all(value is not None and math.isfinite(value) for value in values):
        return ""  # a per-run value of some robot
    low, high = f"{min(values):.4g}", f"{max(values):.4g}"
    unit = sure[parameter]["unit"]
    size = low if low == high else f"{low} to {high}"
    return f" Fitted {parameter}: {size} {unit}".rstrip() + "."


def _certainty(parameter: Mapping[str, Any]) -> float:
    """Size in standard deviations; 0 if either is unknown."""
    value, std = (parameter[part] or math.nan for part in ("value", "std"))
    return abs(value / std) if math.isfinite(value) and std > 0.0 else 0.0


def _alone(fleet: Fleet) -> list[str]:
    """Effects that only one robot misses."""
    judged = sum(row.verdict != ERROR for row in fleet.rows)
    found = [(effect, rows[0]) for effect, rows in fleet.by_effect.items() if len(rows) == 1]
    if judged < 3 or not found:
        return []
    said = [f"{effect} ({row.robot})" for effect, row in found[:_NAMED]]
    if len(found) > _NAMED:
        said.append(f"{len(found) - _NAMED} more")
    return [f"Missing in one robot alone, and so a matter of that robot: {listed(said)}."]


def _errors(fleet: Fleet) -> list[str]:
    failed = [row for row in fleet.rows if row.verdict == ERROR]
    lines = [f"- {row.robot} could not be diagnosed: {row.error}" for row in failed[:_TOLD]]
    if len(failed) > _TOLD:
        lines.append(f"- and {len(failed) - _TOLD} more; --json has the reason of each.")
    return lines


def _left(fleet: Fleet) -> list[str]:
    if not fleet.left:
        return []
    names = list(fleet.left[:_NAMED])
    if len(fleet.left) > _NAMED:
        names.append(f"{len(fleet.left) - _NAMED} more")
    everyone = len(fleet.rows) + len(fleet.left)
    return [f"Not done: {len(fleet.left)} of {everyone} are left, {listed(names)}."]


def error_words(row: Row) -> str:
    """Held-out error before and after in millimetres, by headings alone in degrees, or ""."""
    before, after = row.errors
    if not math.isnan(before):
        return f"{_millimetres(before)} → {_millimetres(after)}"
    turns = row.told["holdout"].get("rmse_yaw_rad", {})
    before, after = (number(turns.get(side)) for side in ("before", "after"))
    if math.isnan(before):
        return ""
    return f"{leg_error(before, 'rad')} → {leg_error(after, 'rad')}"


def _millimetres(value: float) -> str:
    if math.isnan(value):
        return "-"
    return f"{1e3 * value:.1f}" if value < 0.1 else f"{1e3 * value:.0f}"
