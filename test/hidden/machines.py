# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Engine set-ups for hidden sets: which robot, which reference, which drives.

`own` is what `werrimbi simulate` makes. `other` is what somebody else might make: sizes, encoders,
rates, reference and drives drawn anew for each seed. The rest are drives that hide something on
purpose.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from unittest import mock

import numpy as np

from werrimbi_odom.simulation import (
    Manoeuvre,
    MoveLimits,
    Nominal,
    ReferenceSensor,
    TrueRobot,
    arcs,
    chain,
    drives,
    figure_eight,
    free,
    moves,
    out_and_back,
    pivots,
    spins,
    square,
    start_stop,
)
from werrimbi_odom.simulation.chassis import SKID_BEHIND

OWN = TrueRobot(left_wheel_noise=4.0e-4, right_wheel_noise=5.8e-4)
"""The robot of `werrimbi simulate`."""

SHORT = (
    "train/free_calm",
    "train/free_brisk",
    "train/start_stop",
    "train/eights_and_spins",
    "holdout/free_brisk",
    "holdout/to_and_fro",
)
"""Of the session's eleven drives, what the small part of the proof takes."""


@dataclass(frozen=True)
class Machine:
    """All that a session needs beside what is hidden."""

    drives: dict[str, Manoeuvre]
    """By the names of their run folders."""
    robot: TrueRobot = OWN
    reference: ReferenceSensor = field(default_factory=ReferenceSensor)
    ticks_rate_hz: float = 50.0
    skid_behind: float = SKID_BEHIND
    """From the axle back to the castor [m]."""
    steady: bool = False
    """Keep of each record only the part at the highest speed."""

    @contextmanager
    def built(self) -> Iterator[None]:
        """While the engine is to build this machine's body."""
        with mock.patch("werrimbi_odom.simulation.chassis.SKID_BEHIND", self.skid_behind):
            yield


def machine(setup: str, seed: int) -> Machine:
    """The set-up of a name, for a seed.

    Parameters
    ----------
    setup : "own", "short", "other", "one_speed_line", "one_speed_curves" or "drive:NAME:MINUTES",
        several with a + between them
    """
    if setup == "own":
        return Machine(drives(seed))
    if setup == "short":
        return Machine({name: each for name, each in drives(seed).items() if name in SHORT})
    if setup == "other":
        return _other(seed)
    if setup == "one_speed_line":
        return Machine({name: _line() for name in ("train/a", "train/b", "train/c", "holdout/d")})
    if setup == "one_speed_curves":
        return Machine(
            {
                f"{part}/{number}": _curves(10 * seed + number)
                for number, part in enumerate(("train", "train", "train", "holdout"))
            },
            steady=True,
        )
    found = {}
    for place, asked in enumerate(setup.removeprefix("drive:").split("+")):
        name, minutes = asked.split(":")
        drive = manoeuvre(name, seed)
        times = math.ceil(60.0 * float(minutes) / drive.duration)
        found |= {f"train/{place}_{name}_{number}": drive for number in range(times)}
    return Machine(found)


def _line() -> Manoeuvre:
    """Straight at one speed, forwards, with gentle starts and stops."""
    return moves("line", [(3.0, 0.0)] * 3, MoveLimits(speed=0.4, acceleration=0.5))


def _curves(seed: int) -> Manoeuvre:
    """Forwards at one speed all the time, along curves to both sides."""
    chance = np.random.default_rng(seed)
    knots = [(0.0, 0.0, 0.0), (0.8, 0.4, 0.0)]
    while knots[-1][0] < 60.0:
        now = knots[-1][0]
        turn = float(chance.uniform(-1.0, 1.0))
        knots += [(now + 0.3, 0.4, turn), (now + float(chance.uniform(1.0, 3.0)), 0.4, turn)]
    last = knots[-1][0]
    return Manoeuvre("curves", (*knots, (last + 0.8, 0.0, 0.0)))


def manoeuvre(name: str, seed: int) -> Manoeuvre:
    """What a person would drive who is told a manoeuvre's name.

    Raises
    ------
    KeyError
        When nobody knows how to drive that.
    """
    words = name.lower().replace(" ", "_")
    brisk = MoveLimits(speed=0.7, acceleration=1.2, yaw_rate=2.0, yaw_acceleration=4.0)
    known = {
        "square": chain("square", square(1.5), square(1.5, "cw")),
        "out_and_back": chain(
            "to_and_fro", out_and_back(2.0, laps=2), out_and_back(2.0, pace=brisk)
        ),
        "start_stop": start_stop(3, laps=4),
        "hard": start_stop(3, laps=4),
        "figure_eight": chain("eights", figure_eight(0.6, pace=brisk), figure_eight(0.6)),
        "eight": chain("eights", figure_eight(0.6, pace=brisk), figure_eight(0.6)),
        "pivot": pivots(),
        "spin": spins(1.0, pairs=2),
        "arc": chain("arcs", arcs((0.4, 0.8), angle=math.pi / 2), arcs((0.4, 0.8), pace=brisk)),
        "circle": chain("arcs", arcs((0.4, 0.8), angle=math.pi / 2), arcs((0.4, 0.8), pace=brisk)),
        "speed": free(60.0, seed=seed, speed=0.8, yaw_rate=2.0, acceleration=1.5),
        "still": moves("stand_still", [(0.3, 0.0), (-0.3, 0.0)] * 2, MoveLimits(pause=20.0)),
        "free": free(60.0, seed=seed, speed=0.8, yaw_rate=2.0, acceleration=1.5),
    }
    for word, found in known.items():
        if word in words:
            return found
    raise KeyError(name)


def _other(seed: int) -> Machine:
    """A robot, a reference and drives of another kind, with noise to match."""
    chance = np.random.default_rng([seed, 77])

    def between(low: float, high: float) -> float:
        """Evenly in its logarithm."""
        return float(math.exp(chance.uniform(math.log(low), math.log(high))))

    base, radius = between(0.2, 0.6), between(0.03, 0.1)
    ticks = float(round(between(500.0, 8192.0)))
    noise = between(2.0e-4, 1.0e-3)
    sigma = between(3.0e-4, 5.0e-3)
    top = between(0.4, 0.9)
    spin_rate = min(2.0, 2.0 * top / base)
    pace = MoveLimits(
        speed=top, acceleration=1.5 * top, yaw_rate=spin_rate, yaw_acceleration=2.0 * spin_rate
    )

    def about(number: int, speed: float) -> Manoeuvre:
        return free(
            between(40.0, 90.0),
            seed=100 * seed + number,
            speed=speed,
            yaw_rate=0.8 * spin_rate,
            acceleration=1.5 * speed,
            backwards=0.3,
        )

    side = between(1.0, 2.5)
    there = {
        "train/a": about(1, 0.5 * top),
        "train/b": about(2, top),
        "train/c": about(3, top),
        "train/d": chain("d", square(side, pace=pace), square(side, "cw")),
        "train/e": chain("e", out_and_back(side, laps=2, pace=pace), spins(1.0, pairs=1)),
        "train/f": chain("f", figure_eight(0.4 * side, pace=pace), arcs((0.4, 0.8), pace=pace)),
        "holdout/g": about(4, 0.7 * top),
        "holdout/h": about(5, top),
        "holdout/i": chain("i", square(1.0, pace=pace), out_and_back(1.0, laps=2)),
    }
    return Machine(
        there,
        TrueRobot(
            wheel_separation=base,
            left_wheel_radius=radius,
            right_wheel_radius=radius,
            left_ticks_per_revolution=ticks,
            right_ticks_per_revolution=ticks,
            left_wheel_noise=noise,
            right_wheel_noise=noise * between(0.7, 1.4),
            mass=between(4.0, 25.0),
            nominal=Nominal(base, radius),
        ),
        ReferenceSensor(
            rate_hz=between(10.0, 100.0), sigma_xy=sigma, sigma_yaw=sigma * between(1.0, 4.0)
        ),
        between(20.0, 100.0),
        between(0.1, 0.25),
    )
