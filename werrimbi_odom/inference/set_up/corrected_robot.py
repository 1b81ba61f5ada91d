# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Put set-up findings into the robot, close enough for fits to start from."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace

from werrimbi_odom.effects import LIBRARY, find
from werrimbi_odom.inference.calibration_parametrisation import Sizes, sizes_of
from werrimbi_odom.inference.set_up.explanation import Setting
from werrimbi_odom.inference.set_up.findings import IN_DEGREES, SetUpFinding
from werrimbi_odom.inference.set_up.misentered_values import is_ordinary
from werrimbi_odom.model.effect import AppliedEffect, view_of, wiring_of
from werrimbi_odom.model.reference_view import View
from werrimbi_odom.model.robot import Robot


def with_findings(
    robot: Robot, findings: Sequence[SetUpFinding], setting: Setting | None
) -> tuple[Robot, tuple[SetUpFinding, ...]]:
    """Robot with the findings' effects before its own, and the findings with their final values.

    An effect that the robot already has is changed in place, so a finding's values are the combined
    ones. The remaining few percent of the sizes go into the multipliers. `robot`: the robot as its
    file has it. `findings`: what is wrong. `setting`: the set-up, where sizes were measured.
    """
    exchanged = any(finding.effect == "wheels_swapped" for finding in findings)
    wiring = wiring_of(robot.effects)
    if exchanged and wiring.left_sign != wiring.right_sign:
        # A counter that the file reverses moves to the other side with its plug.
        for name in ("left_wheel_reversed", "right_wheel_reversed"):
            robot, _ = _with(robot, name, {})
    before, told = robot, []
    for finding in findings:
        values: Mapping[str, float] = {}
        if finding.effect != IN_DEGREES:
            robot, values = _with(robot, finding.effect, finding.values)
        told.append(replace(finding, values=values, words=finding.words + _in_all(finding, values)))
    if findings and setting is not None:
        robot = _calibrated(robot, before, setting)
    return robot, tuple(told)


def _in_all(finding: SetUpFinding, values: Mapping[str, float]) -> str:
    """What a mount or a clock is off by in all, where the robot file holds a part of it."""
    if values == finding.values or find(finding.effect).stage != "reference":
        return ""
    units = {name: item.unit for name, item in find(finding.effect).parameters.items()}
    total = ", ".join(f"{name} {value:.3g} {units[name]}" for name, value in values.items())
    return f"; with what the robot file holds, {finding.effect} is {total}"


def _with(robot: Robot, name: str, values: Mapping[str, float]) -> tuple[Robot, dict[str, float]]:
    effect = find(name)
    held = [each for each in robot.effects if each.name == name]
    others = tuple(each for each in robot.effects if each.name != name)
    if effect.is_mistake:
        effects = others if held else (effect.using(), *others)
        return replace(robot, effects=effects), {}
    if not held:
        applied = effect.using(**values)
        return replace(robot, effects=(applied, *robot.effects)), dict(applied.values)
    before = held[0].values
    joint = {
        key: item.combined(before[key], values.get(key, item.null))
        for key, item in effect.parameters.items()
    }
    changed = AppliedEffect(effect, joint)
    effects = tuple(changed if each is held[0] else each for each in robot.effects)
    return replace(robot, effects=effects), joint


def _calibrated(robot: Robot, before: Robot, setting: Setting) -> Robot:
    """Put what the findings leave of the measured sizes into the multipliers."""
    found = sizes_of(robot).over(sizes_of(before))
    base, left, right = Sizes(setting.base, setting.left, setting.right).over(found)
    common = math.sqrt(left * right)
    if abs(found.right / found.left - 1.0) > 1e-9 and not is_ordinary(common):
        # The ratio keeps the mean radius; here one radius was right and must stay.
        robot, _ = _with(robot, "wheel_radius_scale", {"multiplier": common})
        left, right = left / common, right / common
    if not (is_ordinary(left) and is_ordinary(right) and is_ordinary(base)):
        return robot
    return replace(
        robot,
        wheel_separation_multiplier=robot.wheel_separation_multiplier * base,
        left_wheel_radius_multiplier=robot.left_wheel_radius_multiplier * left,
        right_wheel_radius_multiplier=robot.right_wheel_radius_multiplier * right,
    )


def mount_of(robot: Robot) -> View:
    """Extrinsics of the reference, including body effects that are equivalent to them.

    A robot that moves at an angle, for example, looks like one with a rotated marker.
    """
    view = view_of(robot.effects)
    mounts = {effect.name: effect for effect in LIBRARY if effect.stage == "reference"}
    for applied in robot.effects:
        if applied.effect.stage == "body":
            for twin in applied.effect.indistinguishable_from:
                if twin.name in mounts and twin.values and not twin.of_headings:
                    view = mounts[twin.name].apply(view, **twin.same_as(applied.values))
    return view
