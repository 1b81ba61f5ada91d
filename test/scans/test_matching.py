# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""One scan on line elements: what it was guessed to be does not matter."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from test.scans.drives import in_circles, seen
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.scans.line_features import REACH, line_elements
from werrimbi_odom.scans.matching import match
from werrimbi_odom.scans.scan_odometry import motion_between
from werrimbi_odom.scans.sweep import (
    Sweep,
    SweepMotion,
    deskewed,
    own_course,
    range_noise,
    sweep_of,
)
from werrimbi_odom.scans.three_pass_odometry import ScanMatcher, ScanPath
from werrimbi_odom.simulation import rooms
from werrimbi_odom.simulation.engine import PERIOD, TruePath
from werrimbi_odom.simulation.lidar import Lidar


def test_a_guess_that_is_a_fifth_wrong_moves_nothing() -> None:
    """The robot went 0.1 m and turned by 0.1 rad; a guess of that, or of 20 % more."""
    _, sweeps = seen(in_circles(8.0), rooms.living_room(), Lidar(rotates=False))
    first, second = sweeps[60], sweeps[66]
    elements = line_elements(first.points, first.reach, np.ones(len(first.points)))
    assert elements is not None
    poses = [
        match(second.points, elements, factor * np.array([0.1, 0.0, 0.1])).pose
        for factor in (1.0, 1.2, 0.8)
    ]
    assert np.ptp(poses, axis=0)[:2].max() < 5e-4
    assert np.ptp(poses, axis=0)[2] < 5e-4


class Misjudging(ScanMatcher):
    """Its first pass takes its own last motion for some times what it was."""

    times = 1.0

    @property
    def _motion(self) -> Floats:
        return self._taken_for

    @_motion.setter
    def _motion(self, measured: Floats) -> None:
        self._taken_for = self.times * measured


def test_a_first_pass_that_guesses_a_fifth_wrong_moves_no_leg() -> None:
    """Scans are deskewed by it too: legs of a metre by that pass alone are moved by 10 mm."""
    _, sweeps = seen(in_circles(25.0), rooms.living_room(), Lidar(rate_hz=5.0))

    def path(times: float) -> ScanPath:
        matcher = Misjudging()
        matcher.times = times
        for sweep in sweeps:
            matcher.take(sweep)
        return matcher.path()

    right, wrong = path(1.0), path(1.2)
    assert right.time.size == wrong.time.size == len(sweeps)
    apart = [
        motion_between(*(motion_between(*found.poses[[row, row + 20]]) for found in (right, wrong)))
        for row in range(right.time.size - 20)
    ]
    assert np.abs(apart).max() < 5e-4


def test_deskewed_echoes_are_those_of_a_lidar_that_stands() -> None:
    """At constant speeds, 0.4 m/s ahead and 1 rad/s, what is left is beyond the second order."""
    t = np.arange(0.0, 1.0, PERIOD)
    yaw = 1.0 * t
    path = TruePath(t, 0.4 * np.sin(yaw), 0.4 * (1.0 - np.cos(yaw)), yaw, 0 * t, 0 * t)
    clean = Lidar(noise=0.0, noise_share=0.0, lost=0.0)
    sweeps, echoes = seen(path, rooms.arena(), clean)
    sweep, (x, y, heading) = echoes[2], sweeps.truth[2]
    course = own_course(np.array([0.04, 0.0, 0.1]), 0.1)
    points = deskewed(sweep, course)
    cos, sin = np.cos(heading), np.sin(heading)
    placed = points @ np.array([[cos, sin], [-sin, cos]]) + (x, y)
    on_walls = np.abs(np.abs(placed).max(axis=1) - 1.3) < 1e-4
    inside = np.abs(placed).max(axis=1) < 1.2  # the bar
    assert on_walls.sum() > 150
    assert (on_walls | inside).all()
    raw = sweep.points @ np.array([[cos, sin], [-sin, cos]]) + (x, y)
    assert np.abs(np.abs(raw[on_walls]).max(axis=1) - 1.3).max() > 0.02


@given(st.floats(0.2, 3.0), st.floats(-0.6, 0.6), st.floats(1e-4, 0.02), st.integers(0, 10**6))
def test_noise_of_ranges_is_told_whatever_the_angle_of_a_wall(
    away: float, askew: float, noise: float, seed: int
) -> None:
    """Of 200 beams over 1.5 rad; a cupboard before it has two edges."""
    angles = np.linspace(-0.75, 0.75, 200)
    wall = away / np.cos(angles - askew)
    wall[80:120] *= 0.9
    ranges = wall + noise * np.random.default_rng(seed).standard_normal(200)
    told = range_noise(ranges, np.arange(200), angles[1] - angles[0])
    assert 0.5 * noise < np.median(told) < 2.0 * noise


def test_a_match_is_as_sure_as_it_says_where_neighbouring_echoes_err_alike() -> None:
    """As a real LD08's do. By differences of neighbours the NEES was 5.4."""
    clean = Lidar(noise=0.0, noise_share=0.0, lost=0.0, rotates=False)
    still = TruePath(np.arange(0.0, 1.0, PERIOD), *np.zeros((5, round(1.0 / PERIOD))))
    sweep = seen(still, rooms.arena(), clean)[1][2]
    rng = np.random.default_rng(6)
    distance = np.hypot(*sweep.points.T)
    alike = 3e-3 * np.array([0.1, 0.35, 0.75, 1.0])  # correlations of 0.6, 0.25 and 0.06

    def measured() -> np.ndarray:
        noise = np.convolve(rng.standard_normal(distance.size + 3), alike, "valid")
        return np.asarray(sweep.points * (1.0 + noise / distance)[:, None])

    elements = line_elements(sweep.points, sweep.reach, np.ones(distance.size))
    assert elements is not None
    true = match(sweep.points, elements, np.zeros(3)).pose
    nees = []
    for _ in range(150):
        found = match(measured(), elements, np.zeros(3))
        off = found.pose - true
        nees.append(off @ np.linalg.solve(found.covariance, off) / 3.0)
    assert 0.8 < np.mean(nees) < 1.5


def test_a_line_through_echoes_has_less_noise_than_they() -> None:
    rng = np.random.default_rng(1)
    x = rng.uniform(0.0, 2.0, 2000)
    points = np.column_stack([x, 0.01 * rng.standard_normal(x.size)])
    elements = line_elements(points, np.full(x.size, REACH), np.ones(x.size))
    assert elements is not None
    assert np.abs(elements.centres[:, 1]).max() < 3e-3
    assert np.abs(elements.normals[:, 1]).min() > 0.995


def test_a_line_is_worth_what_its_echoes_scatter() -> None:
    """A wall; one of thrice the noise; and a step of 4 cm, too flat for a corner."""
    rng = np.random.default_rng(4)
    x = rng.uniform(0.0, 6.0, 6000)
    noise = np.where(x < 4.5, 0.004, 0.012) * rng.standard_normal(x.size)
    points = np.column_stack([x, noise + np.where(x < 1.5, 0.0, 0.04)])
    elements = line_elements(points, np.full(x.size, REACH), np.ones(x.size))
    assert elements is not None
    at = elements.centres[:, 0]
    step, far = np.abs(at - 1.5) < 0.03, at > 4.7
    near = (at < 1.2) | ((at > 1.8) & (at < 4.3))
    usual = np.median(elements.worth[near])
    assert np.median(elements.worth[far]) == pytest.approx(usual / 3.0, rel=0.1)
    assert elements.worth[step].max() < 0.45 * usual
    tilts = np.arctan2(-elements.normals[:, 0], elements.normals[:, 1])
    seen = np.std((tilts + 0.5 * np.pi) % np.pi - 0.5 * np.pi, where=far)
    assert seen == pytest.approx(np.median(elements.tilt[far]), rel=0.3)


def test_a_corner_and_a_cloud_are_no_lines() -> None:
    rng = np.random.default_rng(2)
    cloud = rng.uniform(-0.1, 0.1, (300, 2))
    assert line_elements(cloud, np.full(300, REACH), np.ones(300)) is None
    assert line_elements(cloud[:2], np.full(2, REACH), np.ones(2)) is None


def test_what_is_no_echo_is_left_out() -> None:
    ranges = np.array([0.0, np.inf, np.nan, 0.05, 1.0, 9.0, -1.0, 2.0])
    sweep = sweep_of(10.0, ranges, 0.1 * np.arange(8), 0.01, nearest=0.12, farthest=8.0)
    assert np.hypot(*sweep.points.T) == pytest.approx([1.0, 2.0])
    assert sweep.duration * sweep.share == pytest.approx([0.005, 0.035])
    assert sweep.time == pytest.approx(10.035)
    assert isinstance(sweep, Sweep)
    assert deskewed(sweep, SweepMotion()) == pytest.approx(sweep.points)
