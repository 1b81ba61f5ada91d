# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Two paths of one drive, by the odd beams and by the even ones: they differ as they say."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from test.evidence import in_evidence
from test.scans.drives import Matched, at_rest, in_circles
from werrimbi_odom.scans.sweep import sweep_of
from werrimbi_odom.scans.three_pass_odometry import ScanMatcher, ScanPath
from werrimbi_odom.simulation import rooms
from werrimbi_odom.simulation.engine import TruePath
from werrimbi_odom.simulation.lidar import Lidar, Room, Sweeps, scanned

FINE = Lidar(beams=436)
HOKUYO = Lidar(beams=682, noise=0.01, noise_share=0.0)


def by_every_other(sweeps: Sweeps, lidar: Lidar, first: int) -> ScanPath:
    """The path by half of the beams, from the first of them on."""
    angles, interval = lidar.increment * np.arange(lidar.beams), lidar.beam_interval
    matcher = ScanMatcher()
    for time, ranges in zip(sweeps.time, sweeps.ranges, strict=True):
        matcher.take(
            sweep_of(
                time + first * interval,
                ranges[first::2],
                angles[first::2],
                2.0 * interval,
                lidar.nearest,
                lidar.farthest,
            )
        )
    return matcher.path()


@pytest.mark.parametrize(
    ("path", "room", "lidar"),
    [
        pytest.param(in_circles(15.0), rooms.living_room(), FINE, id="room"),
        pytest.param(at_rest(10.0), rooms.living_room(), FINE, id="rest"),
        in_evidence(in_circles(25.0), rooms.living_room(), HOKUYO, id="682 beams"),
        in_evidence(in_circles(25.0, 0.12), rooms.arena(), FINE, id="arena"),
        in_evidence(at_rest(25.0), rooms.arena(), FINE, id="rest in the arena"),
    ],
)
def test_odd_beams_differ_from_even_ones_as_their_covariances_say(
    path: TruePath, room: Room, lidar: Lidar
) -> None:
    sweeps = scanned(path, room, lidar, seed=0)
    odd, even = (by_every_other(sweeps, lidar, first) for first in (1, 0))
    assert odd.time.size == even.time.size == odd.scans
    both = replace(odd, covariances=odd.covariances + even.covariances)
    _, nees = Matched(both, even.poses, sweeps).steps()
    assert 0.8 < nees.mean() < 1.5
