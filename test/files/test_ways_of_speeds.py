# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The way of a drive of which only speeds were recorded is the way that was driven."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from werrimbi_odom.files.bags.ways_of_speeds import BEHIND, ways_of
from werrimbi_odom.files.read_run import read_run
from werrimbi_odom.model.pose import Floats

MESSAGES = 3000
INTERVAL = 0.02


def driven() -> tuple[Floats, Floats]:
    """Times of reading, and speeds and turn rates there: legs that begin and end at rest."""
    read = INTERVAL * np.arange(MESSAGES)
    return read, np.column_stack([0.4 * np.sin(0.3 * read) ** 2, 0.6 * np.sin(0.2 * read)])


def way(read: Floats) -> Floats:
    """The exact integrals of `driven`."""
    return np.column_stack(
        [0.2 * (read - np.sin(0.6 * read) / 0.6), 3.0 * (1.0 - np.cos(0.2 * read))]
    )


def published(read: Floats, stamp: Floats) -> Floats:
    """What a driver makes of it: the way since the last message over the time since."""
    speeds = np.diff(way(read), axis=0) / np.diff(stamp)[:, None]
    return np.concatenate([np.zeros((1, 2)), speeds])


def jitter() -> Floats:
    """Late stamps: a gamma latency, as of a loop that is not a real-time one."""
    return np.random.default_rng(4).gamma(2.0, 0.0008, MESSAGES)


def test_the_way_over_the_time_since_is_the_way_whatever_the_stamps() -> None:
    """By trapezia 0.5 % would be added, and the base and both wheels be found larger by it."""
    read, _ = driven()
    stamp = read + jitter()
    ways, words = ways_of(stamp, published(read, stamp))
    assert np.abs(ways - (way(read) - way(read)[0])).max() < 1e-9
    assert words == [BEHIND]


def test_counts_of_the_way_hide_neither_it_nor_the_moment() -> None:
    """Ways rounded to 0.5 mm of 4 mm a message, a gap of lost messages, and the same answer."""
    read, speeds = driven()
    stamp = read + jitter()
    counted = np.round(way(read) / 5e-4) * 5e-4
    kept = np.ones(MESSAGES, dtype=np.bool_)
    kept[1000:1010] = False
    made = np.concatenate([np.zeros((1, 2)), np.diff(counted, axis=0) / np.diff(stamp)[:, None]])
    ways, words = ways_of(stamp[kept], made[kept])
    assert words == [BEHIND]
    assert np.abs(ways - way(read)[kept])[:900].max() < 1e-3
    noisy = speeds + np.random.default_rng(1).normal(0.0, 0.02, speeds.shape)
    assert ways_of(stamp[kept], noisy[kept])[1] == []


@pytest.mark.parametrize(
    "kind", ["of the moment", "filtered", "by the nominal time", "even stamps"]
)
def test_speeds_that_do_not_follow_the_intervals_are_of_their_moment(kind: str) -> None:
    """Commanded, measured or filtered: trapezia are right, and half an interval would be added."""
    read, speeds = driven()
    stamp = read + jitter()
    if kind == "of the moment":  # of when it is stamped
        speeds = np.column_stack([0.4 * np.sin(0.3 * stamp) ** 2, 0.6 * np.sin(0.2 * stamp)])
    elif kind == "by the nominal time":
        speeds = published(read, read)
    elif kind == "filtered":
        made = published(read, stamp)
        for n in range(1, MESSAGES):
            speeds[n] = speeds[n - 1] + 0.1 * (made[n] - speeds[n - 1])
    else:
        stamp = read
        speeds = published(read, read)
    ways, words = ways_of(stamp, speeds)
    steps = 0.5 * (speeds[1:] + speeds[:-1]) * np.diff(stamp)[:, None]
    assert words == []
    assert np.abs(ways[1:] - np.cumsum(steps, axis=0)).max() < 1e-9


def test_the_twist_of_an_odometry_of_late_stamps_is_the_way_of_its_wheels(
    tmp_path: Path, ros: Any, robot: Any
) -> None:
    """Left and right wheel by the twists of /odom, whose poses stay at the origin."""
    read, _ = driven()
    stamp = np.round(1e9 * (read + jitter())).astype(np.int64)
    made = published(read, 1e-9 * stamp)
    entries = []
    for time, (speed, rate) in zip(stamp.tolist(), made, strict=True):
        kind, message = ros.odometry(time, 0.0, 0.0, 0.0)
        message.twist.twist.linear.x, message.twist.twist.angular.z = speed, rate
        entries.append(("/odom", time, (kind, message)))
    run = read_run(ros.write(tmp_path / "bag", entries), robot())
    around = 2.0 * math.pi * 0.1
    along = 0.5 * around * (run.ticks.left[-1] / 1000 + run.ticks.right[-1] / 2000)
    assert along == pytest.approx(way(read)[-1, 0], rel=1e-6)
    assert any("is taken for that interval" in note for note in run.notes)
