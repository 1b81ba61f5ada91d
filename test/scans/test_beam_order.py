# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Which way the beams were seen is told by the walls, whatever the driver states."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from test.scans.drives import Matched, in_circles, rms, seen
from werrimbi_odom.scans.beam_order import EitherOrder
from werrimbi_odom.scans.path import ScanMatcher
from werrimbi_odom.scans.sweep import Sweep
from werrimbi_odom.simulation import rooms
from werrimbi_odom.simulation.lidar import Lidar

POOR = Lidar(noise=0.015, noise_share=0.01)


def backwards(sweeps: list[Sweep]) -> list[Sweep]:
    """As a driver states them that fills its arrays from the end."""
    return [replace(sweep, after=-sweep.after) for sweep in sweeps]


@pytest.mark.parametrize("lidar", [Lidar(), POOR], ids=["ordinary", "poor"])
@pytest.mark.parametrize("stated", ["rightly", "the other way"])
def test_the_walls_tell_which_way(lidar: Lidar, stated: str) -> None:
    sweeps, given = seen(in_circles(20.0), rooms.living_room(people=True), lidar)
    matcher = EitherOrder()
    for sweep in given if stated == "rightly" else backwards(given):
        matcher.take(sweep)
    path = matcher.path()
    assert matcher.backwards == (stated != "rightly")
    rows = np.searchsorted([sweep.time for sweep in given], path.time - 1e-6)
    found = Matched(path, sweeps.truth[rows], sweeps)
    plain = ScanMatcher()
    for sweep in given:
        plain.take(sweep)
    np.testing.assert_allclose(path.poses, plain.path().poses, atol=1e-12)
    assert max(rms(found.legs()[0])) < (2.5 if lidar is not POOR else 5.0)


def test_deskewed_the_wrong_way_legs_are_several_times_as_far_off() -> None:
    """What is at stake: more than not to deskew at all."""
    sweeps, given = seen(in_circles(20.0), rooms.living_room(), Lidar())
    wrong = ScanMatcher()
    for sweep in backwards(given):
        wrong.take(sweep)
    path = wrong.path()
    rows = np.searchsorted([sweep.time for sweep in given], path.time - 1e-6)
    assert max(rms(Matched(path, sweeps.truth[rows], sweeps).legs()[0])) > 10.0


def test_where_all_beams_are_seen_at_once_both_ways_are_one() -> None:
    lidar = Lidar(rotates=False)
    _, given = seen(in_circles(12.0), rooms.living_room(), lidar)
    matcher = EitherOrder()
    for sweep in given:
        matcher.take(sweep)
    assert not matcher.backwards
    assert matcher.path().time.size > 100
