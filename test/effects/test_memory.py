# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What effects may look at is the same step by step and all at once, on any drive."""

from __future__ import annotations

from dataclasses import fields

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from werrimbi_odom.model.drive import ROLLBACK, Drive, RawStep, Span
from werrimbi_odom.model.drive_memory import DriveMemory
from werrimbi_odom.model.drive_of_run import drive_of_run
from werrimbi_odom.model.motion import BodyMotion, displacement
from werrimbi_odom.model.pose import Floats, Pose

TRACK, RADIUS = 0.35, 0.05


def steps(left: Floats, right: Floats, duration: Floats) -> list[RawStep]:
    along, turn = 0.5 * (left + right), (right - left) / TRACK
    table = (duration, left, right, along, turn, left / RADIUS, right / RADIUS)
    return [RawStep(*row) for row in zip(*(part.tolist() for part in table), strict=True)]


def flat(drive: Drive[Floats]) -> Floats:
    """All features in columns."""
    columns = []
    for item in fields(drive):
        value = getattr(drive, item.name)
        if isinstance(value, Span):
            columns += [value.start, value.end]
        elif item.name != "channels":
            columns.append(value)
    return np.array(columns).T


def straight(travel: Floats, duration: float) -> Drive[Floats]:
    """A drive in which both wheels travel the same [m], in steps of one duration [s]."""
    angle, turn = travel / RADIUS, np.zeros_like(travel)
    steps = np.full_like(travel, duration), travel, travel, travel, turn, angle, angle
    return drive_of_run(*steps, flicker=1e-4, track=TRACK)


def both_ways(
    left: Floats, right: Floats, duration: Floats, flicker: float, digits: float = 1e-12
) -> None:
    raw = steps(left, right, duration)
    memory, pose, live = DriveMemory(flicker, TRACK, 0.3, -0.4), Pose(), []
    for step in raw:
        live.append(flat(memory.step(step, pose)))
        dx, dy = displacement(BodyMotion(step.along, 0.0, step.turn), pose.yaw)
        pose = Pose(pose.x + dx, pose.y + dy, pose.yaw + step.turn)
    recorded = drive_of_run(
        *(np.array(part) for part in zip(*raw, strict=True)),
        flicker=flicker,
        track=TRACK,
        first_angles=(0.3, -0.4),
    )
    np.testing.assert_allclose(np.array(live), flat(recorded), rtol=digits, atol=digits)


@settings(max_examples=50, deadline=None)
@given(
    seed=st.integers(0, 2**32 - 1),
    count=st.integers(1, 700),
    size=st.sampled_from([1e-4, 5e-4, 2e-3, 2e-2]),
    memory=st.sampled_from([0.0, 0.9, 0.995]),
    flicker=st.sampled_from([0.0, 2.4e-4, 3e-3]),
)
def test_live_memory_is_the_recorded_one(
    seed: int, count: int, size: float, memory: float, flicker: float
) -> None:
    """Jitter, to and fro, long ways: wherever reversals are near their threshold."""
    random = np.random.default_rng(seed)
    travel = random.normal(0.0, size, (2, count))
    for i in range(1, count):
        travel[:, i] += memory * travel[:, i - 1]
    travel[:, random.random(count) < 0.2] = 0.0
    both_ways(*travel, random.uniform(0.005, 0.1, count), flicker)


@settings(max_examples=50, deadline=None)
@given(
    seed=st.integers(0, 2**32 - 1),
    count=st.integers(1, 1500),
    intervals=st.lists(
        st.sampled_from([2e-5, 3e-4, 1e-3, 4e-3, 0.019, 0.02, 0.5, 3.0]), min_size=1, max_size=40
    ),
)
def test_live_memory_is_the_recorded_one_whatever_the_stamps(
    seed: int, count: int, intervals: list[float]
) -> None:
    """Bursts, pauses and other rates; a fifth of the steps at rest.

    Accelerations are divided by intervals of 20 microseconds, and lose five digits.
    """
    random = np.random.default_rng(seed)
    travel = random.normal(0.005, 0.005, (2, count)) * (random.random(count) > 0.2)
    jitter = random.uniform(0.9, 1.1, count)
    both_ways(*travel, np.resize(intervals, count) * jitter, 1e-4, 1e-7)


STAMPS = {
    "two at a time": np.tile([0.04, 2e-5], 100),
    "five at a time": np.tile([2e-5, 2e-5, 2e-5, 2e-5, 0.1], 40),
    "a queue let go": np.repeat([0.02, 2.0, 2e-5, 0.02], [100, 1, 99, 100]),
    "silent for long, then a queue": np.repeat([0.02, 30.0, 2e-5, 0.02], [100, 1, 20, 100]),
    "from 50 Hz to 500": np.repeat([0.02, 0.002], [200, 600]),
}


@pytest.mark.parametrize("stamps", STAMPS)
def test_no_stamp_makes_a_speed_that_nothing_had(stamps: str) -> None:
    """At 0.5 m/s, read in time (or, at another rate, as stamped), and sent when the driver can.

    To a factor of two, as a long queue may pass for a quicker sender.
    """
    duration = STAMPS[stamps]
    travel = np.minimum(0.5 * duration, 0.01) if "Hz" in stamps else np.full(duration.size, 0.01)
    angle, turn = travel / RADIUS, np.zeros_like(travel)
    for message in (None, np.arange(travel.size)):
        drive = drive_of_run(
            duration, travel, travel, travel, turn, angle, angle,
            flicker=1e-4, track=TRACK, message=message,
        )  # fmt: skip
        begun = 0 if message is None else 5  # the first may be a part of a message
        for speed in (drive.speed, drive.left_speed, drive.right_smooth_speed):
            assert np.abs(speed.end[begun:]).max() < 1.5
        if "Hz" in stamps:
            np.testing.assert_allclose(drive.speed.end, 0.5)


def test_only_a_message_that_is_much_too_early_changes_the_speed_of_the_body() -> None:
    """Parts of messages, split where a pose was measured, have their own, however short."""
    random = np.random.default_rng(1)
    message = np.repeat(np.arange(100), 2)
    share = np.stack([random.uniform(0.001, 0.999, 100)] * 2, axis=-1)
    share[:, 1] = 1.0 - share[:, 0]
    whole = np.full(100, 0.02)
    whole[50] = 2e-5
    duration = (share * whole[:, None]).ravel()
    left, right = random.normal(0.01, 0.001, (2, 200))
    right, left = np.array([right, left]) * share.ravel()
    along, turn = 0.5 * (left + right), (right - left) / TRACK
    drive = drive_of_run(
        duration, left, right, along, turn, left, right,
        flicker=1e-4, track=TRACK, message=message,
    )  # fmt: skip
    usual = message != 50
    np.testing.assert_array_equal(drive.speed.end[usual], (along / duration)[usual])
    np.testing.assert_array_equal(drive.yaw_rate.end[usual], (turn / duration)[usual])
    assert np.abs(drive.speed.end[~usual]).max() < 1.5


def test_a_wheel_at_rest_has_no_direction() -> None:
    nothing = np.zeros(5)
    both_ways(nothing, nothing, np.ones(5), 1e-4)
    drive = drive_of_run(np.ones(5), *np.zeros((6, 5)), flicker=1e-4, track=TRACK)
    assert not drive.direction.any()
    assert not drive.left_direction.any()
    assert not drive.left_reversals.any()


@pytest.mark.parametrize(("back", "reversals"), [(0.9 * ROLLBACK, 0), (1.1 * ROLLBACK, 1)])
def test_rolling_back_a_little_is_no_reversal(back: float, reversals: int) -> None:
    left = np.concatenate([np.full(20, 0.01), [-back / 2, -back / 2, 0.0]])
    drive = straight(left, 1.0)
    assert drive.reversals[-1] == reversals
    since = drive.since_reversal
    assert since.end[-1] == pytest.approx(back if reversals else 0.2)
    # What was rolled back before it was called a reversal belongs to that step: nothing is lost.
    assert np.sum(since.end[20:] - since.start[20:]) == pytest.approx(back if reversals else 0.0)


def test_a_drive_that_begins_in_motion_has_no_acceleration_at_first() -> None:
    left = np.full(3, 0.01)
    drive = straight(left, 0.02)
    np.testing.assert_allclose(drive.speed.start, 0.5)
    np.testing.assert_allclose(drive.left_speed.change, 0.0)
