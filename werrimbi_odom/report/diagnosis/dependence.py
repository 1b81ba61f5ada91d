# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A cell of the evidence map in words: which error depends on what, its size and shape."""

from __future__ import annotations

import math

import numpy as np

from werrimbi_odom.inference.diagnosis.evidence import Dependence, place_of
from werrimbi_odom.inference.diagnosis.quarter_turns import Turning
from werrimbi_odom.inference.diagnosis.step_jacobians import Amount
from werrimbi_odom.inference.diagnosis.variables import CONSTANT, functions_of
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.report.number_format import length
from werrimbi_odom.report.style import escaped

VARIABLES = {
    "speed": "the robot's speed",
    "wheel_speed": "the speed of the wheel",
    "direction": "whether it drives forwards or backwards",
    "acceleration": "the acceleration",
    "yaw_rate": "the rate of turning",
    "yaw_rate_size": "the size of the rate of turning",
    "travel_since_reversal": "the travel since the last reversal",
    "left_wheel_angle": "the angle of the left wheel (once a turn)",
    "right_wheel_angle": "the angle of the right wheel (once a turn)",
    "left_wheel_angle_twice": "the angle of the left wheel (twice a turn)",
    "right_wheel_angle_twice": "the angle of the right wheel (twice a turn)",
    "heading": "the direction in the room that the robot faces",
    "position": "the place on the floor",
    "time": "the time since the start of the drive",
    "distance": "the distance driven since the start",
}
"""Names of variables, in the order of figures."""

_SHORT = {
    CONSTANT: "always",
    "wheel_speed": "wheel's speed",
    "yaw_rate": "turn rate",
    "yaw_rate_size": "turn rate, size",
    "travel_since_reversal": "travel since reversal",
    "left_wheel_angle": "left wheel's angle",
    "right_wheel_angle": "right wheel's angle",
    "left_wheel_angle_twice": "left wheel's angle, twice",
    "right_wheel_angle_twice": "right wheel's angle, twice",
    "position": "place on the floor",
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

_RARE = 0.02
"""Share of the path at both ends of a variable's range that is too rare to report."""

_UNTOLD = "by more than wheels can do, for hardly any of it was driven"


def short_name(variable: str) -> str:
    """Short name of a variable for tables and figures."""
    return _SHORT.get(variable, variable.replace("_", " "))


def short_words(cell: Dependence) -> str:
    """Short name of a cell; a constant error has its amount in the name."""
    name = short_name(cell.variable.name)
    return f"{name}, per {cell.amount.per}" if cell.variable.name == CONSTANT else name


def label_of(name: str) -> str:
    """Short name of a variable for a figure, escaped."""
    return escaped(short_name(name))


def error_of(amount: Amount) -> str:
    """Name of an error, for a figure."""
    wheel = f"error of the {amount.channel} wheel's travel"
    named = {"along": "error along", "sideways": "sideways error", "heading": "heading error"}
    return named.get(amount.channel, wheel)


def unit_of(amount: Amount) -> tuple[str, float]:
    """Unit of an error per unit of its amount, and the conversion factor."""
    degree = math.degrees(1.0)
    if amount.channel == "heading":
        return {"turn": ("% of the turn", 100.0), "duration": ("° per s", degree)}.get(
            amount.per, ("° per m", degree)
        )
    return ("mm per radian turned", 1e3) if amount.per == "turn" else ("mm per m", 1e3)


def variable_words(cell: Dependence) -> str:
    """The variable of a dependence, in words."""
    if cell.variable.name == CONSTANT:
        return {
            "travel": "the distance, forwards less backwards",
            "path": "the distance, forwards and backwards alike",
            "turn": "the angle turned",
            "duration": "the time",
        }[cell.amount.per]
    return VARIABLES.get(cell.variable.name, f"the measured channel {cell.variable.name}")


def amount_words(cell: Dependence) -> str:
    """The error of a dependence, in words."""
    return _AMOUNTS[cell.amount.channel, cell.amount.per]


def dependence_words(cell: Dependence) -> str:
    """The whole cell: "how far the left wheel rolls goes with ...: 0.4 % more ..."."""
    what = amount_words(cell)
    verb = "is wrong in proportion to" if cell.variable.name == CONSTANT else "goes with"
    strength = strength_words(cell)
    shape = "" if strength == _UNTOLD else _shape(cell)
    return f"{what} {verb} {variable_words(cell)}: {strength}{shape}"


def strength_words(cell: Dependence) -> str:
    """Size of the dependence: half the range of the error on these drives.

    Of a place that is wrong by so much per radian, which no tape tells: what it comes to.
    """
    if cell.turning is not None:
        return _over_turns(cell, cell.turning)
    values = _errors(cell)
    if cell.variable.name == CONSTANT:
        size = abs(float(values[0]))
    elif cell.form == "turns":
        size = float(np.median(np.hypot(*np.atleast_2d(cell.coefficients).T)))
    else:
        low, high = _quantiles(values, _weights(cell), np.array([_RARE, 1.0 - _RARE]))
        size = 0.5 * float(high - low)
    if size > cell.amount.most:
        return _UNTOLD
    sign = "" if cell.variable.name == CONSTANT else "±"
    return f"{sign}{_in_unit(cell, size)}"


def _over_turns(cell: Dependence, turning: Turning) -> str:
    """What an error per radian comes to over a quarter turn of the drives: usually, and at most.

    Of one that goes with a variable, what it differs from its mean: a constant one is another cell.
    """
    side, size = functions_of(cell.variable)[cell.form][0], np.abs(turning.turn)
    coefficients = np.atleast_2d(cell.coefficients)
    errors = np.sum(side * coefficients[turning.run if cell.variable.per_run else 0], axis=-1)
    constant = cell.variable.name == CONSTANT
    moved = turning.moved(errors if constant else errors - np.average(errors, weights=size))
    usual, most = (length(float(each)) for each in (np.sqrt(np.mean(moved**2)), moved.max()))
    whole = turning.quarters() == turning.stretches
    over = "an unbroken part" if whole else "a quarter turn"
    up_to = "" if constant or usual == most else f", up to {most}"
    return f"{'' if constant else '±'}{usual} over {over} of these drives{up_to}"


def _in_unit(cell: Dependence, size: float) -> str:
    channel, per = cell.amount.channel, cell.amount.per
    if channel == "heading":
        if per == "turn":
            return f"{_two_digits(100.0 * size)} %"
        each = "second" if per == "duration" else "metre"
        return f"{_two_digits(math.degrees(size))}° each {each}"
    if channel == "sideways":
        return f"{_two_digits(1e3 * size)} mm each metre"
    return f"{_two_digits(100.0 * size)} %"


def _shape(cell: Dependence) -> str:
    """Shape of the dependence on its variable."""
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
        went = _values(cell)
        at = _quantiles(went, _weights(cell), np.linspace(_RARE, 1.0 - _RARE, 25))
        nearest = [int(np.argmin(np.abs(went - value))) for value in at]
        values = _errors(cell)[nearest]
        bottom, top = _apart(float(at[values.argmin()]), float(at[values.argmax()]))
        return f", a curve, lowest at {bottom} and highest at {top} {variable.unit}".rstrip()
    if cell.form == "place":
        x, y = place_of(cell)
        return f", most of it about x {x:.1f} m, y {y:.1f} m in the reference's frame"
    return ""


def _two_digits(value: float) -> str:
    return f"{value:.2g}" if abs(value) < 99.5 else f"{value:.0f}"


def _apart(*values: float) -> list[str]:
    """Values in two digits, or in as many more as tell them apart."""
    for digits in range(2, 6):
        told = ["0" if abs(value) < 1e-6 else f"{value:.{digits}g}" for value in values]
        if len(set(told)) == len(told):
            break
    return told


def _sides(cell: Dependence) -> slice:
    """Wheels that are reported: one side if both are alike, or if only one has the error."""
    if cell.variable.shared or cell.form == "place":
        return slice(0, 1)
    only = {"left": slice(0, 1), "right": slice(1, 2)}
    return only.get(cell.channel, slice(0, 2))


def _errors(cell: Dependence) -> Floats:
    """Error per amount at every step."""
    functions = functions_of(cell.variable)[cell.form]
    coefficients = np.atleast_2d(cell.coefficients)[0]
    return np.concatenate([side @ coefficients for side in functions[_sides(cell)]])


def _values(cell: Dependence) -> Floats:
    """The variable at the same steps."""
    return np.concatenate([cell.variable.left, cell.variable.right][_sides(cell)])


def _weights(cell: Dependence) -> Floats:
    """Weight of each of these steps: its share of the amount that the error is proportional to.

    An error per metre at values where the robot hardly moved has no evidence.
    """
    size = _errors(cell).size
    if cell.shares is None:
        return np.ones(size)
    known = [side for side in cell.shares if side.size]
    if cell.variable.shared or cell.form == "place":
        return np.asarray(sum(known))
    return np.concatenate(known)


def _quantiles(values: Floats, weights: Floats, shares: Floats) -> Floats:
    """Weighted quantiles."""
    order = np.argsort(values)
    up_to = np.cumsum(weights[order])
    if not up_to[-1] > 0.0:
        return np.quantile(values, shares)
    return np.asarray(values[order][np.searchsorted(up_to, shares * up_to[-1])])
