# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Variables that an error may depend on, measured at every step, and functions of them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.distributions import MEDIAN_TO_SIGMA
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.free_parameters import Model
from werrimbi_odom.inference.fitting.prediction import (
    anchors,
    extrinsics_of,
    headings_of,
    path_of,
    right_handed,
)
from werrimbi_odom.model.pose import Floats

CONSTANT = "constant"
"""Name of the variable that is 1 everywhere: for an error proportional to its amount alone."""

_TURNING = ("yaw_rate", "left_speed", "right_speed", "castor_angle")
"""What an effect reads that knows how quickly the robot turns."""

Form = Literal["constant", "line", "curve", "turns", "place"]


@dataclass(frozen=True, slots=True)
class Variable:
    """A measured quantity at every step of all runs."""

    name: str
    unit: str
    left: Floats
    """Values of the left wheel, or of the robot, (n,)."""
    right: Floats
    """Values of the right wheel; the same array for a quantity of the robot."""
    form: Form = "curve"
    looks_at: tuple[str, ...] = ()
    """Fields of `Drive` that an effect would read to know it."""
    per_run: bool = False
    """Whether its zero differs between runs (a wheel's angle, a heading by matched scans)."""
    harmonic: int = 1
    """Harmonic of an angle."""
    even: bool = False
    """Whether a robot seen in a mirror has the same."""
    scatter: float = 0.0
    """Standard deviation of its noise from message to message, where it is a speed; else 0."""

    @property
    def varied(self) -> bool:
        """Whether it had different values: by more than its noise, where it is a speed."""
        if not np.ptp(self.left) > 0.0:
            return False
        return self.scatter == 0.0 or self.spread > rules.VARIED * self.scatter

    @property
    def spread(self) -> float:
        """Standard deviation of a speed along the way, or turn, that was driven with it."""
        values = np.concatenate([self.left, self.right])
        weight = np.abs(values)
        mean = float(np.average(values, weights=weight))
        return math.sqrt(float(np.average((values - mean) ** 2, weights=weight)))

    @property
    def shared(self) -> bool:
        """Whether it is one quantity of the robot, not of each wheel."""
        return self.left is self.right


def variables_of(runs: Concatenated, model: Model) -> tuple[Variable, ...]:
    """All measured variables, including the extra channels."""
    robot = model.laid_out(runs.steps)
    drive = runs.drive(robot)
    path = path_of(model, runs)
    view = extrinsics_of(model, runs)
    heading = headings_of(path, runs, view, model.start_yaws)

    def own(name: str, unit: str, left: Floats, right: Floats, *fields: str) -> Variable:
        scatter = max(_scatter(left), _scatter(right))
        return Variable(name, unit, left, right, looks_at=fields, scatter=scatter)

    def robots(name: str, unit: str, values: Floats, *fields: str) -> Variable:
        scatter = _scatter(values) if name in _SPEEDS else 0.0
        even = name != "yaw_rate"
        return Variable(name, unit, values, values, looks_at=fields, even=even, scatter=scatter)

    acceleration = drive.speed.change / drive.duration
    ones = np.ones(heading.size)
    found = [
        Variable(CONSTANT, "", ones, ones, "constant", even=True),
        robots("speed", "m/s", np.abs(drive.speed.end), "speed", "left_speed", "right_speed"),
        own(
            "wheel_speed",
            "m/s",
            np.abs(drive.left_speed.end),
            np.abs(drive.right_speed.end),
            "left_speed",
            "right_speed",
            "speed",
        ),
        robots("direction", "", np.sign(drive.speed.end), "speed", "direction", "castor_angle"),
        robots(
            "acceleration",
            "m/s^2",
            acceleration,
            "speed",
            "left_speed",
            "right_speed",
            "left_acceleration",
            "right_acceleration",
        ),
        robots("yaw_rate", "rad/s", drive.yaw_rate.end, *_TURNING),
        robots("yaw_rate_size", "rad/s", np.abs(drive.yaw_rate.end), *_TURNING),
        robots("time", "s", drive.time.mean, "time"),
        robots("distance", "m", drive.distance.mean, "distance"),
        robots(
            "travel_since_reversal",
            "m",
            drive.since_reversal.mean,
            "since_reversal",
            "left_since_reversal",
            "right_since_reversal",
            "castor_angle",
        ),
        Variable("heading", "rad", heading, heading, "turns", ("heading",), runs.own_axes),
    ]
    for harmonic, times in ((1, ""), (2, "_twice")):
        for side, span in (("left", drive.left_angle), ("right", drive.right_angle)):
            name, angle, read = f"{side}_wheel_angle{times}", span.mean, (f"{side}_angle",)
            found.append(Variable(name, "rad", angle, angle, "turns", read, True, harmonic))
    place = _places(runs, path.position, heading, path.yaw, right_handed(runs.start, view))
    if place is not None and not runs.own_axes:
        found.append(Variable("position", "m", place[0], place[1], "place", ("x", "y")))
    for name, span in drive.channels.items():
        found.append(robots(name, "", np.asarray(span.mean), name))
    if np.mean(np.abs(acceleration) > rules.GRIP) > rules.SELDOM_BEYOND:
        found = [item for item in found if item.name != "acceleration"]
    way = np.abs(drive.distance.change)
    back = way[drive.speed.end < 0.0].sum() / max(way.sum(), 1e-9)
    if not rules.SELDOM_BACK < back < 1.0 - rules.SELDOM_BACK:
        found = [item for item in found if item.name != "direction"]
    return tuple(item for item in found if item.name == CONSTANT or item.varied)


_SPEEDS = ("speed", "yaw_rate", "yaw_rate_size")


def _scatter(values: Floats) -> float:
    """Standard deviation of white noise in values that change smoothly, by second differences."""
    bends = np.abs(np.diff(values, 2))
    return MEDIAN_TO_SIGMA * float(np.median(bends)) / math.sqrt(6.0) if bends.size else 0.0


def _places(
    runs: Concatenated,
    position: NDArray[np.complex128],
    heading: Floats,
    yaw: Floats,
    start: Floats,
) -> tuple[Floats, Floats] | None:
    """Position at the start of each step, in the reference's frame; None without positions."""
    known = np.isfinite(start[:, 0]) & np.isfinite(start[:, 1])
    if not known.any() or not known[runs.legs[:-1]].all():
        return None
    anchor = anchors(runs, known)
    first = runs.begin[anchor]
    moved = np.exp(1j * (heading - yaw[:-1])) * (position[:-1] - position[first])
    return start[anchor, 0] + moved.real, start[anchor, 1] + moved.imag


def functions_of(variable: Variable) -> dict[Form, tuple[Floats, Floats]]:
    """Basis functions of a variable, for left and right wheel, by form; arrays of shape (n, k)."""
    if variable.form == "constant":
        return {"constant": (variable.left[:, None],) * 2}
    if variable.form == "turns":
        waves = [function(variable.harmonic * variable.left) for function in (np.cos, np.sin)]
        both = np.stack(waves, axis=-1)
        return {"turns": (both, both)}
    if variable.form == "place":
        cells = floor_cells(variable.left, variable.right)
        return {"place": (cells, cells)} if cells.shape[-1] > 1 else {}
    pooled = np.concatenate([variable.left, variable.right])
    middle, scale = float(np.mean(pooled)), float(np.std(pooled))
    sides = (variable.left,) if variable.shared else (variable.left, variable.right)
    lines = [((side - middle) / scale)[:, None] for side in sides]
    knots = curve_knots(pooled, variable.scatter)
    found: dict[Form, tuple[Floats, Floats]] = {"line": (lines[0], lines[-1])}
    if knots.size > 2:
        curves = [hats(side, knots) for side in sides]
        found["curve"] = (curves[0], curves[-1])
    return found


def curve_knots(values: Floats, noise: float = 0.0) -> Floats:
    """Knots of a curve at quantiles, so that each piece has as many data.

    `noise`: standard deviation of the values' own noise. Inner knots are left out where a piece
    would hold no more than that: over a value that was held, a curve resolves noise alone.
    """
    knots = np.unique(np.quantile(values, np.linspace(0.0, 1.0, rules.CURVE_KNOTS))).tolist()
    piece = 0
    while noise > 0.0 and len(knots) > 2 and piece < len(knots) - 1:
        within = values[(values >= knots[piece]) & (values <= knots[piece + 1])]
        if within.size and float(np.std(within)) > rules.VARIED * noise:
            piece += 1
            continue
        del knots[piece + 1 if piece + 2 < len(knots) else piece]
        piece = max(piece - 1, 0)
    return np.array(knots)


def hats(values: Floats, knots: Floats) -> Floats:
    """Hat functions (linear B-splines): 1 at a knot, 0 at all others; (n, knots)."""
    numbers = np.arange(knots.size, dtype=np.float64)
    found = np.subtract.outer(np.interp(values, knots, numbers), numbers)
    np.subtract(1.0, np.abs(found, out=found), out=found)
    return np.maximum(found, 0.0, out=found)


def floor_cells(x: Floats, y: Floats) -> Floats:
    """Indicator of the floor cell of each step, (n, cells)."""
    width = rules.FLOOR_CELL
    while True:
        column = np.floor((x - x.min()) / width).astype(int)
        row = np.floor((y - y.min()) / width).astype(int)
        cell, counts = np.unique(column * (row.max() + 1) + row, return_inverse=True)
        if cell.size <= rules.FLOOR_CELLS:
            return np.asarray(counts[:, None] == np.arange(cell.size), dtype=np.float64)
        width *= 1.25
