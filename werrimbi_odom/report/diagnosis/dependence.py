# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A cell of the evidence map in words: which error goes with what, how much, in what shape."""

from __future__ import annotations

import math

import numpy as np

from werrimbi_odom.inference.diagnosis.evidence import Dependence, place_of
from werrimbi_odom.inference.diagnosis.variables import CONSTANT, functions_of
from werrimbi_odom.model.pose import Floats

_VARIABLES = {
    "speed": "the robot's speed",
    "wheel_speed": "the speed of the wheel",
    "direction": "whether it drives forwards or backwards",
    "acceleration": "the acceleration",
    "yaw_rate": "the rate of turning",
    "yaw_rate_size": "the size of the rate of turning",
    "time": "the time since the start of the drive",
    "distance": "the distance driven since the start",
    "travel_since_reversal": "the travel since the last reversal",
    "heading": "the direction in the room that the robot faces",
    "left_wheel_angle": "the angle of the left wheel (once a turn)",
    "right_wheel_angle": "the angle of the right wheel (once a turn)",
    "left_wheel_angle_twice": "the angle of the left wheel (twice a turn)",
    "right_wheel_angle_twice": "the angle of the right wheel (twice a turn)",
    "position": "the place on the floor",
}

_AMOUNTS = {
    ("left", "travel"): "how far the left wheel rolls",
    ("right", "travel"): "how far the right wheel rolls",
    ("along", "travel"): "how far both wheels roll",
    ("along", "path"): "how far both wheels roll",
    ("along", "turn"): "how far the robot goes ahead while it turns",
    ("sideways", "travel"): "how far the robot goes sideways as it drives",
    ("sideways", "path"): "how far the robot goes sideways as it drives",
    ("sideways", "turn"): "how far the robot goes sideways as it turns",
    ("heading", "turn"): "how far the robot turns",
    ("heading", "travel"): "how far the robot turns as it drives",
    ("heading", "path"): "how far the robot turns as it drives",
    ("heading", "duration"): "how far the robot turns as time goes by",
}


def variable_words(cell: Dependence) -> str:
    """What the error goes with."""
    if cell.variable.name == CONSTANT:
        return {
            "travel": "the distance, forwards less backwards",
            "path": "the distance, forwards and backwards alike",
            "turn": "the angle turned",
            "duration": "the time",
        }[cell.amount.per]
    return _VARIABLES.get(cell.variable.name, f"the measured channel {cell.variable.name}")


def dependence_words(cell: Dependence) -> str:
    """The whole cell: "how far the left wheel rolls goes with ...: 0.4 % more ..."."""
    what = _AMOUNTS[cell.amount.channel, cell.amount.per]
    verb = "is wrong in proportion to" if cell.variable.name == CONSTANT else "goes with"
    return f"{what} {verb} {variable_words(cell)}: {strength_words(cell)}{_shape(cell)}"


def strength_words(cell: Dependence) -> str:
    """By how much, as half the range that it took on these drives."""
    values = _errors(cell)
    if cell.variable.name == CONSTANT:
        size = abs(float(values[0]))
    elif cell.form == "turns":
        size = float(np.median(np.hypot(*np.atleast_2d(cell.coefficients).T)))
    else:
        low, high = np.quantile(values, (0.02, 0.98))
        size = 0.5 * float(high - low)
    sign = "" if cell.variable.name == CONSTANT else "±"
    return f"{sign}{_in_unit(cell, size)}"


def _in_unit(cell: Dependence, size: float) -> str:
    channel, per = cell.amount.channel, cell.amount.per
    if channel == "heading":
        if per == "turn":
            return f"{_two_digits(100.0 * size)} %"
        each = "second" if per == "duration" else "metre"
        return f"{_two_digits(math.degrees(size))}° each {each}"
    if per == "turn":
        return f"{_two_digits(1e3 * size)} mm each radian"
    if channel == "sideways":
        return f"{_two_digits(1e3 * size)} mm each metre"
    return f"{_two_digits(100.0 * size)} %"


def _shape(cell: Dependence) -> str:
    """How it follows its variable."""
    variable = cell.variable
    if cell.form == "line":
        way = "growing" if float(cell.coefficients[0]) > 0.0 else "falling"
        return f", {way} with it in a line"
    if cell.form == "turns" and not variable.per_run:
        peak = math.degrees(math.atan2(float(cell.coefficients[1]), float(cell.coefficients[0])))
        return f", a wave that is highest at {peak:.0f}°"
    if cell.form == "turns":
        return ", a wave"
    if cell.form == "curve":
        at = np.quantile(variable.left, np.linspace(0.02, 0.98, 25))
        nearest = [int(np.argmin(np.abs(variable.left - value))) for value in at]
        values = _errors(cell)[nearest]
        bottom, top = (_round(float(at[index])) for index in (values.argmin(), values.argmax()))
        return f", a curve, lowest at {bottom} and highest at {top} {variable.unit}".rstrip()
    if cell.form == "place":
        x, y = place_of(cell)
        return f", most of it about x {x:.1f} m, y {y:.1f} m in the reference's frame"
    return ""


def _two_digits(value: float) -> str:
    return f"{value:.2g}" if abs(value) < 99.5 else f"{value:.0f}"


def _round(value: float) -> str:
    return "0" if abs(value) < 1e-6 else f"{value:.2g}"


def _errors(cell: Dependence) -> Floats:
    """The error by its amount at every step."""
    functions = functions_of(cell.variable)[cell.form]
    coefficients = np.atleast_2d(cell.coefficients)[0]
    sides = functions[:1] if cell.variable.shared or cell.form == "place" else functions
    return np.concatenate([side @ coefficients for side in sides])
