# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What recordings contain, and which parameters they can tell."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

import numpy as np

from werrimbi_odom.files.bags.bag_contents import Contents
from werrimbi_odom.files.bags.bag_wheels import Wheels
from werrimbi_odom.files.bags.measured_topic import Measured
from werrimbi_odom.files.bags.stamps import Stamps
from werrimbi_odom.files.robot_descriptions.first_robot import FirstRobot
from werrimbi_odom.files.robot_descriptions.wheel_joints import WheelJoints
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.comparison.reference_remark import ReferenceRemark
from werrimbi_odom.inference.fitting.prediction import tell_lengths
from werrimbi_odom.inference.legs.gaps import LeftOut
from werrimbi_odom.inference.legs.motion_states import DrivenAmount
from werrimbi_odom.inference.seldom_measured import tell_sizes
from werrimbi_odom.inference.set_up.findings import SetUpFinding


@dataclass(frozen=True)
class Held:
    """Contents of one recording."""

    path: Path
    contents: Contents | None
    """Topics of a bag; None for a folder."""
    wheels: Wheels | None
    reference: Measured | None
    """Topic proposed as the reference, in the bag or in `other`."""
    stamps: dict[str, Stamps]
    run: Run | None
    """The run as read with these topics; None if it cannot be read."""
    problem: str
    """Why it cannot be read."""
    joints: WheelJoints = field(default_factory=WheelJoints)
    """Joints of the wheels' topic: which of them are wheels."""
    at_fault: Literal["", "wheels", "names"] = ""
    """Set if `problem` is one of the wheels, which no other reference mends: the wheels themselves,
    or the names that the robot file gives to their joints."""
    mistakes: tuple[SetUpFinding, ...] = ()
    """Mistakes of wiring and mount that the reference shows; `driven` has them put right."""
    confirmed: bool = False
    """Whether the reference confirms which counter of an array is left."""
    driven: DrivenAmount | None = None
    seen: DrivenAmount | None = None
    """What of that the reference measured; None where there is none."""
    left_out: tuple[LeftOut, ...] = ()
    restamped: float = 0.0
    """Correction of the tick stamps (`legs.even_stamps`), rms [s]."""
    rare: float = 0.0
    """Usual interval of the wheels' messages where they are rare (`Counters.are_rare`), else 0
    [s]."""
    scans_restamped: float = 0.0
    """Correction of the scan stamps, rms [s]."""
    gyro_bias: float = 0.0
    """Rate of the headings at rest, which is removed (`legs.gyro_bias`) [rad/s]."""
    at_rest: ReferenceRemark | None = None
    """Speeds of the wheels where the reference stands (`comparison.speeds_at_rest`), if any."""
    beside: Measured | None = None
    """Gyro whose headings are taken with the positions of `reference`, a localiser."""

    other: Path | None = None
    """Recording that holds the reference, if it is not `path`."""

    @property
    def clock_rate(self) -> float:
        """What the reference's clock gains on the wheels', where that is much, in a second."""
        return 0.0 if self.run is None else self.run.clock_rate

    @property
    def topics(self) -> list[str]:
        """Topics of the references that are taken."""
        return [each.name for each in (self.reference, self.beside) if each is not None]

    @property
    def judged(self) -> DrivenAmount | None:
        """What of the driving can be judged: all of it, where it is not known what was measured."""
        return self.seen or self.driven


@dataclass(frozen=True)
class Info:
    """Contents of all recordings, and what can be done with them."""

    held: tuple[Held, ...]
    first: FirstRobot
    """What is known of the robot's wheels."""
    given: Path | None
    """The robot file passed by the user, if any."""
    written: Path | None = None
    """The robot file that was written, if any."""
    title: str = ""
    sizes: bool = False
    """Whether the metric scale is known."""
    parameters: Path | None = None
    """The controller's parameter file passed by the user, if any."""

    @property
    def robot_text(self) -> str:
        """Text of the first robot file."""
        return self.first.text(self.title)

    @property
    def legs(self) -> float:
        """Total driving that was measured, in legs of one metre or a quarter turn."""
        return self.legs_of(1.0)

    def legs_of(self, length: float) -> float:
        """The same in legs of another length [m]."""
        drives = [each.judged for each in self.held]
        return sum(
            each.way / length + each.turned / rules.QUARTER_TURN
            for each in drives
            if each is not None
        )

    @property
    def runs(self) -> list[Run]:
        """The drives that can be used."""
        return [each.run for each in self.held if each.run is not None and not each.problem]

    @property
    def intervals(self) -> int:
        """From pose to pose of all references: no leg is shorter than one."""
        references = [run.reference for run in self.runs if run.reference is not None]
        return sum(max(0, each.time.size - 1) for each in references)

    @property
    def leg(self) -> float:
        """Leg length that suits the amount of driving and the noise of the reference [m]."""
        longer = max((_needed(each) for each in self.held), default=0.0)
        if longer > 1.0:
            return longer
        few = self.sizes and self.legs < rules.LEGS_ENOUGH
        return max(rules.SHORT_LEG, longer) if few else 1.0


def leg_of_positions(noise: float) -> float:
    """Leg length whose chord gives a heading, for position noise `noise` [m]; to one digit."""
    least = rules.LEG_OF_POSITIONS * noise
    digit = 10.0 ** math.floor(math.log10(least))
    return float(f"{math.ceil(round(least / digit, 6)) * digit:g}")


def _needed(held: Held) -> float:
    """Leg length that a reference of positions alone needs, by its stated noise [m]."""
    reference = held.run.reference if held.run is not None else None
    if reference is None or reference.sigma_xy is None or measures_of(held) != "positions":
        return 0.0
    noise = float(np.nanmedian(reference.sigma_xy))
    return leg_of_positions(noise) if noise > 0.0 else 0.0


def measures_of(held: Held) -> Literal["poses", "positions", "yaw", "nothing"]:
    """Kind of measurement that the reference of a recording has."""
    reference = held.run.reference if held.run is not None else None
    if reference is None:
        return "nothing"
    places, headings = bool(reference.has_position.any()), bool(reference.has_yaw.any())
    if places:
        return "poses" if headings else "positions"
    return "yaw" if headings else "nothing"


def drove(held: Held, sizes: bool) -> bool:
    """Whether it was measured as it drove far enough for a leg; true if it is not known."""
    drive = held.judged
    if drive is None:
        return True
    far = drive.way + drive.turned / rules.QUARTER_TURN >= rules.SHORT_LEG if sizes else True
    return far and any(span.what == "drove" for span in drive.spans)


def can_tell(held: Held, sizes: bool) -> tuple[list[str], list[str]]:
    """What a recording can and cannot show, as ends of sentences; nothing if it is unusable."""
    if held.problem:
        return [], []
    measures = measures_of(held)
    drive = held.judged
    if measures == "nothing" or drive is None:
        return [], ["anything: nothing measured the robot beside its wheels"]
    if not drove(held, sizes):
        return [], [f"anything: the robot hardly moved{_while_measured(held)}"]
    can: list[str] = []
    cannot: list[str] = []

    def told(shown: bool, what: str, lacking: str) -> None:
        if shown:
            can.append(what)
        else:
            cannot.append(f"{what}: {lacking}")

    far = measures in ("poses", "positions")
    few = ""
    if measured_seldom(held):
        few = "alone it was measured at too few places for more than base and radii"
    if sizes:  # without it neither distance nor a wheel counting backwards is known
        while_so = _while_measured(held)
        turned = drive.turned >= rules.TURN_SHOWS
        if turned and drive.one_curve:
            apart = "the base apart from the ratio of the radii: it drove one curve"
            cannot.append(f"{apart}; drive straight too, or to the other side{while_so}")
        else:
            told(turned, "the base", f"too little turning{while_so}")
            long = turned or drive.way >= rules.WAY_SHOWS
            told(long, "the ratio of the radii", f"too little driving{while_so}")
    if sizes or not far:
        told(
            far and drive.way >= rules.WAY_SHOWS and not _came_back(held),
            "the size of the radii",
            "no heading tells a distance; tape one"
            if not far
            else "where it was measured it had come back; tape a distance"
            if _came_back(held)
            else f"the way is too short{_while_measured(held)}",
        )
    told(
        far and not few,
        "what goes sideways (slip, slope, how the reference is mounted)",
        few if far else "no heading shows it; a localiser or motion capture does",
    )
    seldom = "turned back only once" if drive.reversals else "never drove to and fro"
    told(
        drive.reversals > 1 and not few,
        "what happens at reversals (a castor's kick, backlash)",
        few or f"the robot {seldom}{_while_measured(held)}",
    )
    if (
        sizes
        and drive.way + drive.turned / rules.QUARTER_TURN < rules.SHORT_LEG * rules.FEWEST_LEGS
    ):
        cannot.append(f"much of anything: too little was driven{_while_measured(held)}")
    return can, cannot


def measured_seldom(held: Held) -> bool:
    """Whether a drive has no more measured numbers than base and radii are."""
    return held.run is not None and not tell_sizes([held.run])


def _came_back(held: Held) -> bool:
    """Whether the positions are near one another, for the way that the robot went between them."""
    if held.run is None or held.run.reference is None or held.judged is None:
        return False
    seen = held.run.reference.chosen(held.run.reference.has_position)
    return not tell_lengths(np.hypot(np.diff(seen.x), np.diff(seen.y)), held.judged.way)


def unseen_much(held: Held) -> bool:
    """Whether the reference did not see a part of the driving that is worth telling."""
    if held.seen is None or held.driven is None:
        return False
    seen, whole = (one.way + one.turned / rules.QUARTER_TURN for one in (held.seen, held.driven))
    return seen < rules.SEEN_IN_FULL * whole and whole >= rules.SHORT_LEG


def _while_measured(held: Held) -> str:
    return " while the reference measured it" if unseen_much(held) else ""
