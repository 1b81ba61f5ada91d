# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What recordings hold, and what can be told with them."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

import numpy as np

from werrimbi_odom.files.bag_contents import Contents, Measured, Wheels
from werrimbi_odom.files.first_robot import FirstRobot
from werrimbi_odom.files.run import Run
from werrimbi_odom.files.stamps import Stamps
from werrimbi_odom.files.wheel_joints import WheelJoints
from werrimbi_odom.inference.legs.gaps import LeftOut
from werrimbi_odom.inference.legs.spans import Driven
from werrimbi_odom.inference.rules import (
    FEWEST_LEGS,
    LEG_OF_POSITIONS,
    LEGS_ENOUGH,
    QUARTER_TURN,
    SHORT_LEG,
    TURN_SHOWS,
    WAY_SHOWS,
)


@dataclass(frozen=True)
class Held:
    """What one recording holds."""

    path: Path
    contents: Contents | None
    """Of a bag; None of a folder."""
    wheels: Wheels | None
    reference: Measured | None
    """What is proposed as the reference of a bag."""
    stamps: dict[str, Stamps]
    run: Run | None
    """Read by these; None where it cannot be."""
    problem: str
    """Why not."""
    joints: WheelJoints = field(default_factory=WheelJoints)
    """Of the wheels' topic: which of them are wheels."""
    driven: Driven | None = None
    left_out: tuple[LeftOut, ...] = ()
    restamped: float = 0.0
    """By how much the ticks' stamps are put right (`legs.even_stamps`), rms [s]."""
    scans_restamped: float = 0.0
    """The same of scans."""
    gyro_bias: float = 0.0
    """Rate of headings at rest that is taken off (`legs.gyro_bias`) [rad/s]."""


@dataclass(frozen=True)
class Info:
    """What recordings hold, and what to do with them."""

    held: tuple[Held, ...]
    first: FirstRobot
    """What is known of the robot's wheels."""
    given: Path | None
    """The robot file that was given, if it is one."""
    written: Path | None = None
    """The robot file that was written."""
    title: str = ""
    sizes: bool = False
    """Whether metres are known."""

    @property
    def robot_text(self) -> str:
        """The first robot file."""
        return self.first.text(self.title)

    @property
    def legs(self) -> float:
        """How many legs of a metre or a quarter turn were driven."""
        drives = [each.driven for each in self.held if each.driven is not None]
        return sum(each.way + each.turned / QUARTER_TURN for each in drives)

    @property
    def leg(self) -> float:
        """Length of a leg that the drives are long enough for, and the reference good [m]."""
        longer = max((_needed(each) for each in self.held), default=0.0)
        if longer > 1.0:
            return longer
        return SHORT_LEG if self.sizes and self.legs < LEGS_ENOUGH else 1.0


def leg_of_positions(noise: float) -> float:
    """Length of a leg whose chord is a heading, by positions of some noise [m], to one digit."""
    least = LEG_OF_POSITIONS * noise
    digit = 10.0 ** math.floor(math.log10(least))
    return float(f"{math.ceil(round(least / digit, 6)) * digit:g}")


def _needed(held: Held) -> float:
    """Length of a leg that positions alone need, by the noise that they state [m]."""
    reference = held.run.reference if held.run is not None else None
    if reference is None or reference.sigma_xy is None or measures_of(held) != "positions":
        return 0.0
    noise = float(np.nanmedian(reference.sigma_xy))
    return leg_of_positions(noise) if noise > 0.0 else 0.0


def measures_of(held: Held) -> Literal["poses", "positions", "yaw", "nothing"]:
    """What the reference of a recording measures."""
    reference = held.run.reference if held.run is not None else None
    if reference is None:
        return "nothing"
    places, headings = bool(reference.has_position.any()), bool(reference.has_yaw.any())
    if places:
        return "poses" if headings else "positions"
    return "yaw" if headings else "nothing"


def can_tell(held: Held, sizes: bool) -> tuple[list[str], list[str]]:
    """What a recording can show, and what not: ends of sentences."""
    measures = measures_of(held)
    if measures == "nothing" or held.driven is None:
        return [], ["anything: nothing measured the robot beside its wheels"]
    drive = held.driven
    can: list[str] = []
    cannot: list[str] = []

    def told(shown: bool, what: str, lacking: str) -> None:
        if shown:
            can.append(what)
        else:
            cannot.append(f"{what}: {lacking}")

    far = measures in ("poses", "positions")
    if sizes:  # else nobody knows how far it went, nor whether both wheels count forwards
        told(drive.turned >= TURN_SHOWS, "the base", "too little turning")
        long = drive.turned >= TURN_SHOWS or drive.way >= WAY_SHOWS
        told(long, "the ratio of the radii", "too little driving")
    if sizes or not far:
        told(
            far and drive.way >= WAY_SHOWS,
            "the size of the radii",
            "the way is too short" if far else "no heading tells a distance; tape one",
        )
    told(
        far,
        "what goes sideways (slip, slope, how the reference is mounted)",
        "no heading shows it; a localiser or motion capture does",
    )
    told(
        drive.reversals > 1,
        "what happens at reversals (a castor's kick, backlash)",
        "the robot never drove to and fro",
    )
    if sizes and drive.way + drive.turned / QUARTER_TURN < SHORT_LEG * FEWEST_LEGS:
        cannot.append("much of anything: too little was driven")
    return can, cannot
