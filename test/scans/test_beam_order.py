# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""When each beam was seen is told by the walls, whatever the driver states."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from test.evidence import in_evidence
from test.scans.drives import Matched, in_circles, rms, seen
from werrimbi_odom.scans.beam_order import AnyOrder, Order
from werrimbi_odom.scans.sweep import Sweep
from werrimbi_odom.scans.three_pass_odometry import ScanMatcher, ScanPath
from werrimbi_odom.simulation import rooms
from werrimbi_odom.simulation.lidar import Lidar, Sweeps

POOR = Lidar(noise=0.015, noise_share=0.01)


@cache
def driven(lidar: Lidar, people: bool = False) -> tuple[Sweeps, tuple[Sweep, ...]]:
    """What a lidar saw on one drive, as its driver should state it; to be read alone."""
    sweeps, given = seen(in_circles(20.0), rooms.living_room(people=people), lidar)
    return sweeps, tuple(given)


@cache
def rightly_matched(lidar: Lidar) -> ScanPath:
    """The path by scans that are stated as they were seen."""
    return matched(driven(lidar, people=True)[1], ScanMatcher()).path()


def backwards(sweeps: Iterable[Sweep]) -> list[Sweep]:
    """As a driver states them that fills its arrays from the end."""
    return [replace(sweep, share=-sweep.share) for sweep in sweeps]


def backwards_in_time(sweeps: Iterable[Sweep]) -> list[Sweep]:
    """As a driver states them that fills its arrays from the end, and says so."""
    return [replace(sweep, duration=-sweep.duration) for sweep in backwards(sweeps)]


def at_once(sweeps: Iterable[Sweep]) -> list[Sweep]:
    """As a driver states them that knows of no time between beams: all at that of the first."""
    return [
        replace(sweep, time=sweep.time - 0.5 * sweep.duration, duration=0.0) for sweep in sweeps
    ]


def matched(sweeps: Iterable[Sweep], matcher: AnyOrder | ScanMatcher) -> AnyOrder | ScanMatcher:
    for sweep in sweeps:
        matcher.take(sweep)
    return matcher


@pytest.mark.parametrize(
    "lidar",
    [in_evidence(Lidar()), POOR],
    ids=["ordinary", "poor"],
)
@pytest.mark.parametrize(
    ("stated", "order"),
    [
        in_evidence(list, "stated"),
        in_evidence(backwards, "last to first"),
        in_evidence(backwards_in_time, "stated"),
        (at_once, "first to last"),
    ],
)
def test_the_walls_tell_which_way(lidar: Lidar, stated: object, order: Order) -> None:
    sweeps, given = driven(lidar, people=True)
    matcher = matched(stated(given), AnyOrder())  # type: ignore[operator]
    path = matcher.path()
    assert matcher.order == order
    rows = np.searchsorted([sweep.time for sweep in given], path.time - 1e-6)
    found = Matched(path, sweeps.truth[rows], sweeps)
    # How long a turn takes is read off the stamps, to a rounding error, which must not grow.
    np.testing.assert_allclose(path.poses, rightly_matched(lidar).poses, atol=1e-9)
    np.testing.assert_allclose(path.time, rightly_matched(lidar).time, atol=1e-6)
    assert max(rms(found.legs()[0])) < (2.5 if lidar is not POOR else 5.0)


@pytest.mark.evidence
def test_a_clockwise_lidar_of_no_times_is_found_too() -> None:
    _, given = driven(Lidar(), people=True)
    matcher = AnyOrder()
    mirrored = [
        replace(each, share=-each.share, points=each.points * [1.0, -1.0]) for each in given
    ]
    matched(at_once(mirrored), matcher)
    assert matcher.order == "last to first"


@pytest.mark.evidence
def test_one_short_turn_overrules_no_driver() -> None:
    """Its scans share one swing of the map; a carried robot's have reversed a correct lidar so."""
    _, given = driven(Lidar())
    first = given[0].time
    once = [each for each in backwards(given) if each.time - first < 9.0]
    matcher = matched(once, AnyOrder())
    assert matcher.order == "stated"


@pytest.mark.evidence
def test_deskewed_the_wrong_way_legs_are_several_times_as_far_off() -> None:
    """What is at stake: more than not to deskew at all."""
    sweeps, given = driven(Lidar())
    path = matched(backwards(given), ScanMatcher()).path()
    rows = np.searchsorted([sweep.time for sweep in given], path.time - 1e-6)
    assert max(rms(Matched(path, sweeps.truth[rows], sweeps).legs()[0])) > 10.0


@pytest.mark.evidence
def test_where_all_beams_are_seen_at_once_so_it_stays() -> None:
    _, given = driven(Lidar(rotates=False))
    matcher = matched(given, AnyOrder())
    assert matcher.order == "stated"
    assert not matcher._others, "and both other ways are known to be wrong"
    assert matcher.path().time.size > 100
