# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What recordings allow: the length of legs that is proposed, and what is said that they lack."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from test.inference.driven import run_of
from test.model.drives import ROBOT
from werrimbi_odom.files.robot_descriptions.first_robot import FirstRobot
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.legs.motion_states import DrivenAmount, TimeSpan
from werrimbi_odom.inference.recording_info import Held, Info, can_tell

RUN = run_of(ROBOT, 3, 20)


def held(noise: float, way: float, reversals: int = 0) -> Held:
    """A drive of which positions were measured."""
    reference = RUN.reference
    assert reference is not None
    nothing = np.full(reference.time.size, np.nan)
    seen = replace(reference, yaw=nothing, sigma_xy=np.full(nothing.size, noise))
    return Held(
        path=Path("drive"),
        contents=None,
        wheels=None,
        reference=None,
        stamps={},
        run=replace(RUN, reference=seen),
        problem="",
        driven=DrivenAmount((TimeSpan(0.0, 60.0, "drove"),), way, 6.0, reversals),
    )


@pytest.mark.parametrize(
    ("noise", "way", "leg"),
    [
        *((0.01, 12.0, 0.25), (0.05, 12.0, 0.5), (0.08, 12.0, 0.8), (0.1, 12.0, 1.0)),
        *((0.2, 12.0, 2.0), (0.05, 60.0, 1.0), (0.2, 60.0, 2.0)),
    ],
)
def test_short_legs_are_no_shorter_than_the_noise_of_positions_allows(
    noise: float, way: float, leg: float
) -> None:
    """Legs of 0.25 m were proposed for positions of 8 cm, which tell nothing in less than 0.4 m."""
    assert Info((held(noise, way),), FirstRobot(), None, sizes=True).leg == leg
    assert leg >= rules.SHORTEST_OF_POSITIONS * noise


@pytest.mark.parametrize(
    ("reversals", "says"), [(0, "never drove to and fro"), (1, "turned back only once"), (2, None)]
)
def test_a_drive_out_and_back_is_not_told_as_one_without_a_reversal(
    reversals: int, says: str | None
) -> None:
    can, cannot = can_tell(held(0.01, 12.0, reversals), sizes=True)
    lacks = [each for each in cannot if "reversals" in each]
    assert len(lacks) == (says is not None)
    assert all(each.endswith(f"the robot {says}") for each in lacks)
    assert (says is None) == any("reversals" in each for each in can)


def test_a_drive_that_was_measured_where_it_began_and_ended_in_one_place_shows_no_size() -> None:
    """A square by tape: half the wheels, on half the base, end there too."""
    drive = held(1e-3, 12.0)
    assert drive.run is not None
    seen = drive.run.reference
    assert seen is not None
    ends = seen.chosen(np.array([0, seen.time.size - 1]))
    for apart, told in ((0.1, False), (3.0, True)):
        moved = replace(ends, x=np.array([0.0, apart]), y=np.zeros(2))
        can, _ = can_tell(replace(drive, run=replace(drive.run, reference=moved)), sizes=True)
        assert ("the size of the radii" in can) is told
        assert "the base" in can
