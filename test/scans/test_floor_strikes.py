# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A lidar that looks at the floor ahead: mounted with a pitch, or as the robot nods."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from test.evidence import in_evidence
from test.scans.drives import in_circles, of_sweeps, rms
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.simulation import rooms
from werrimbi_odom.simulation.lidar import Lidar, Sweeps, scanned

HEIGHT = 0.17
"""Of the lidar above the floor [m], as a TurtleBot3's."""
LIDAR = Lidar()


def pitched(sweeps: Sweeps, pitch: Callable[[Floats], Floats]) -> tuple[Sweeps, float]:
    """Scans of a lidar that looks down ahead by an angle [rad], by time; and the floor's share."""
    angle = LIDAR.increment * np.arange(LIDAR.beams)
    down = pitch(sweeps.time[:, None] + LIDAR.beam_interval * np.arange(LIDAR.beams))
    slant = sweeps.ranges / np.hypot(np.cos(angle) * np.cos(down), np.sin(angle))
    falls = np.cos(angle) * np.sin(down)
    floor = np.where(falls > 1e-6, HEIGHT / np.maximum(falls, 1e-6), np.inf)
    noise = LIDAR.noise * np.random.default_rng(0).standard_normal(floor.shape)
    ranges = np.minimum(slant, floor + noise)
    ranges[ranges > LIDAR.farthest] = np.inf
    return replace(sweeps, ranges=ranges), float((floor < slant).mean())


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
