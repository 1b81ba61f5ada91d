# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Changes between drives, in words and as JSON."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict
from itertools import groupby
from typing import Any

from werrimbi_odom.inference.changes.between_drives import ParameterChange
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.report.number_format import SMALL, chance_words, in_unit, listed, with_std

WHAT = {
    "left_wheel": "the left wheel",
    "right_wheel": "the right wheel",
    "both_wheels": "both wheels",
    "wheel_base": "the wheel base",
    "wheels_over_base": "the wheels over the base",
    "mount": "how the reference is mounted",
    "reference_delay": "the reference's clock",
}
"""Names of the changed parts."""


def changes_words(moves: Sequence[ParameterChange], robot: Robot) -> list[str]:
    """A sentence for each change, in the order of the drives; `robot` gives sizes in mm."""
    found = []
    for _, each in groupby(moves, key=lambda move: (move.group, move.from_run, move.kind)):
        together = list(each)
        chance = chance_words(together[0].p_value)
        found.append(f"{_when(together[0])} {_what(together, robot)} ({chance}).")
    return found


def changes_json(moves: Sequence[ParameterChange], robot: Robot) -> list[dict[str, Any]]:
    """Fields of each change, with its sentence."""
    return [{**asdict(move), "words": changes_words([move], robot)[0]} for move in moves]


def in_small_unit(value: float, std: float, unit: str) -> tuple[str, str]:
    """Value with standard deviation, and its unit; small angles are in mrad."""
    if unit == "rad" and abs(value) < SMALL:
        return with_std(1e3 * value, 1e3 * std), "mrad"
    return in_unit(value, std, unit)


def _when(move: ParameterChange) -> str:
    if move.kind == "alone":
        return f"In {move.from_run} alone"
    if move.kind == "trend":
        return f"Since {move.from_run}, steadily,"
    return f"Between {move.last_before} and {move.surely_from}"


def _what(moves: Sequence[ParameterChange], robot: Robot) -> str:
    group = moves[0].group
    if group in ("left_wheel", "right_wheel", "both_wheels"):
        share = _share(moves[0], "larger", "smaller")
        sizes = _sizes(moves[0], robot.wheel_radius)
        verb = _verb(moves[0], group)
        return f"{WHAT[group]} {verb} {share}: radius {sizes}"
    if group == "wheel_base":
        share = _share(moves[0], "wider", "narrower")
        sizes = _sizes(moves[0], robot.wheel_separation)
        return f"{WHAT[group]} {_verb(moves[0], group)} {share}: {sizes}"
    if group == "wheels_over_base":
        share = _share(moves[0], "smaller", "larger")
        return (
            f"{WHAT[group]} {_verb(moves[0], group)} {share}: both wheels, or the base, or the "
            "gyro's own scale, which headings alone do not tell apart"
        )
    numbers = listed([_from_to(move) for move in moves])
    if group == "mount":
        return f"the reference {_verb(moves[0], group)} mounted otherwise: {numbers}"
    if group == "reference_delay":
        return f"{WHAT[group]} stood otherwise: {numbers}"
    return f"{group} took another size: {numbers}"


def _verb(move: ParameterChange, group: str) -> str:
    if move.kind == "alone":
        return "were" if group in ("both_wheels", "wheels_over_base") else "was"
    if group == "mount":
        return "came to be"
    return "became"


def _share(move: ParameterChange, more: str, less: str) -> str:
    share = move.after / move.before - 1.0
    std = math.hypot(move.before_std, move.after_std) / abs(move.before)
    return f"{with_std(100.0 * abs(share), 100.0 * std)} % {more if share > 0.0 else less}"


def _sizes(move: ParameterChange, nominal: float) -> str:
    before, after = (1e3 * nominal * value for value in (move.before, move.after))
    return f"{before:.2f} mm before, {after:.2f} mm after"


_NAMES = {
    "reference_yaw_offset.angle": "its angle to the left",
    "reference_lever_arm.x": "its place ahead of the axle",
    "reference_lever_arm.y": "its place left of the middle",
}


def _from_to(move: ParameterChange) -> str:
    name = _NAMES.get(move.what, move.what.rpartition(".")[2])
    before, after = (
        " ".join(in_small_unit(value, std, move.unit)).rstrip()
        for value, std in ((move.before, move.before_std), (move.after, move.after_std))
    )
    return f"{name} {before} before, {after} after"
