# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A lidar that looks at the floor: mounted with a tilt, or as the robot nods."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from test.evidence import in_evidence
from test.scans.drives import ahead, at_rest, in_circles, of_sweeps, rms, taken
from test.scans.pitching import HEIGHT, LIDAR, pitched
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.scans.body_fixed import FixedLine, fixed_line
from werrimbi_odom.scans.room_odometry import RoomOdometry
from werrimbi_odom.scans.sweep import Sweep
from werrimbi_odom.simulation import rooms
from werrimbi_odom.simulation.engine import TruePath
from werrimbi_odom.simulation.lidar import Lidar, Room, Sweeps, scanned

LARGE = Room(1.6 * rooms.living_room().walls)
"""10 m by 8 m."""


def over_thresholds(time: Floats) -> Floats:
    """5 degrees down and up again within 0.6 s, every two seconds."""
    return np.asarray(0.087 * np.sin(2.0 * np.pi * np.clip(time % 2.0 / 0.6, 0.0, 1.0)))


def askew(time: Floats) -> Floats:
    """3 degrees all the time."""
    return np.full(time.shape, 0.052)


@pytest.mark.parametrize(
    ("pitch", "least"), [(over_thresholds, 0.02), in_evidence(askew, 0.03)], ids=["nods", "askew"]
)
def test_a_little_of_the_floor_costs_little(
    pitch: Callable[[Floats], Floats], least: float
) -> None:
    """In a room, whose walls are mostly nearer than the floor is struck."""
    sweeps, share = pitched(scanned(in_circles(16.0), rooms.living_room(), LIDAR, 0), pitch)
    assert share > least
    found = of_sweeps(sweeps, LIDAR)
    assert found.path.cuts == []
    errors, nees = found.legs()
    assert rms(errors)[0] < 3.0
    assert found.steps()[1].mean() < 1.5
    assert nees.mean() < 1.5


def tilted(degrees: float) -> Callable[[Floats], Floats]:
    """All the time."""
    return lambda time: np.full(time.shape, np.radians(degrees))


def line_of(sweeps: Sweeps, lidar: Lidar = LIDAR) -> FixedLine | None:
    """What goes with the robot, by true headings with the noise of a match."""
    yaw = sweeps.truth[:, 2] + 1e-3 * np.random.default_rng(0).standard_normal(len(sweeps.truth))
    return fixed_line(taken(sweeps, lidar), yaw, np.zeros(len(yaw)))


@pytest.mark.parametrize("noise", [5e-3, 1e-2])
@pytest.mark.parametrize(
    ("path", "room", "degrees", "aside"),
    [
        (ahead(20.0), rooms.corridor(), 3.0, 0.0),
        (ahead(20.0), rooms.corridor(), 4.0, 0.0),
        (in_circles(20.0), rooms.corridor(), 3.0, 0.0),
        (in_circles(20.0), LARGE, 2.0, 0.0),
        (in_circles(20.0), LARGE, 3.0, 2.0),
        (in_circles(20.0), rooms.living_room(True), 4.0, 0.5 * np.pi),
    ],
)
def test_the_floor_is_told_from_walls(
    path: TruePath, room: Room, degrees: float, aside: float, noise: float
) -> None:
    lidar = Lidar(noise=noise, noise_share=noise)
    found = line_of(pitched(scanned(path, room, lidar, 0), tilted(degrees), aside)[0])
    assert found is not None
    assert found.distance == pytest.approx(HEIGHT / np.tan(np.radians(degrees)), rel=0.01)
    assert found.bearing == pytest.approx(aside, abs=0.02)


def in_the_middle(duration: float, turning: Callable[[Floats], Floats]) -> TruePath:
    """Of a room, on the spot, by headings over time."""
    rest = at_rest(duration)
    return replace(rest, yaw_rad=turning(rest.t_s))


def round_wall(radius: float) -> Floats:
    """Of 180 pieces."""
    angle = np.linspace(0.0, 2.0 * np.pi, 181)
    corners = radius * np.column_stack([np.cos(angle), np.sin(angle)])
    return np.hstack([corners[:-1], corners[1:]])


SQUARE = Room(rooms.box(-2.0, -2.0, 2.0, 2.0))


@pytest.mark.parametrize(
    ("path", "room"),
    [
        (at_rest(15.0), rooms.living_room()),
        (ahead(20.0), rooms.corridor()),
        (ahead(20.0, 0.0), rooms.corridor()),
        (ahead(20.0), rooms.corridor_with_cupboards()),
        (in_circles(20.0), rooms.living_room(True)),
        (in_circles(20.0), rooms.living_room_with_glass()),
        (in_the_middle(20.0, lambda t: 0.6 * t), Room(round_wall(3.0))),
        (in_the_middle(20.0, lambda t: 1.57 * (t // 5 + np.clip(t % 5 - 4, 0, 1))), SQUARE),
        (in_the_middle(20.0, lambda t: 0.03 * np.sin(t)), SQUARE),
    ],
    ids=[
        "at rest",
        "corridor",
        "looks about in it",
        "cupboards",
        "people",
        "glass",
        "round",
        "quarter turns",
        "looks about in a room",
    ],
)
def test_walls_are_not_taken_for_the_floor(path: TruePath, room: Room) -> None:
    """Where many scans have them in one place before the lidar."""
    assert line_of(scanned(path, room, LIDAR, 0)) is None


def test_a_wall_that_it_turns_from_is_no_floor_for_what_else_crosses_its_line() -> None:
    """It drove along the wall for six seconds, and then saw other things at that place."""
    random = np.random.default_rng(0)
    yaw = np.concatenate([np.zeros(40), -0.17 * np.arange(1, 5)])
    sweeps = []
    for number, turned in enumerate(yaw):
        count, noise = (41, 0.02) if turned == 0.0 else (12, 0.04)
        along = np.sort(random.uniform(-2.0, 2.0, count))
        across = 2.8 + noise * random.standard_normal(count)
        points = np.column_stack([along, across])
        sweeps.append(Sweep(0.2 * number, points, 0.0 * along, 0.0, np.full(count, 0.3)))
    assert fixed_line(sweeps, yaw, np.zeros(yaw.size)) is None


def test_without_turning_the_floor_is_not_told() -> None:
    straight = replace(ahead(15.0), y_m=0.0 * ahead(15.0).t_s, yaw_rad=0.0 * ahead(15.0).t_s)
    assert line_of(pitched(scanned(straight, rooms.corridor(), LIDAR, 0), tilted(4.0))[0]) is None


def test_along_a_bare_corridor_the_floor_does_not_let_the_robot_stand() -> None:
    """A metre was none, give or take a millimetre (NEES 3637)."""
    lidar = Lidar(beams=160, rate_hz=5.0, lost=0.0)
    sweeps = pitched(scanned(ahead(14.0), rooms.corridor(), lidar, 0), tilted(5.0))[0]
    matcher = RoomOdometry()
    for sweep in taken(sweeps, lidar):
        matcher.take(sweep)
    assert len(matcher.matcher.headings(100)) > 40
    assert matcher.path().time.size == 0
    assert len(matcher.lines) == 1
    assert matcher.share == pytest.approx(0.14, abs=0.03)
