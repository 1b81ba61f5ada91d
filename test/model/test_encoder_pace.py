# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""How fast wheels turn is learnt from stamps that may lie: no stamp may blind the encoder."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from test.model.drives import ROBOT, Ticks
from test.model.records import Record, as_read, records
from test.model.test_odometer_and_trajectory import Live
from werrimbi_odom.model.encoder_online import Encoder, EncoderLimits, WheelStep
from werrimbi_odom.model.encoder_recorded import wheel_steps
from werrimbi_odom.model.odometer import Odometer
from werrimbi_odom.model.pace import REMEMBERED
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.model.trajectory import trajectory

TICK = ROBOT.left_tick
PERIOD, COUNTS = 0.02, 60  # a wheel at 0.47 m/s, read 50 times a second


def hiccups(pattern: str, messages: int = 500) -> np.ndarray:
    """Stamps [s] of a driver that publishes some of its messages too late, at once."""
    even = PERIOD * np.arange(messages)
    if pattern == "one":
        even[400] = even[401] - 2e-5
    elif pattern == "the second message":
        even[1] = even[0] + 2e-5
    elif pattern == "two at a time":
        even[1::2] = even[0::2] + 2e-5
    elif pattern == "five at a time":
        even = 0.1 * (np.arange(messages) // 5) + 2e-5 * (np.arange(messages) % 5)
    elif pattern == "a queue let go":
        even[300:400] = even[400] - 2e-5 * np.arange(100, 0, -1)
    return even


def driven_then_reset(time: np.ndarray) -> Ticks:
    """A straight drive; the counters begin anew 50 messages before its end, still rolling."""
    counts = COUNTS * np.arange(time.size + 50)
    counts[time.size :] -= counts[time.size]
    later = time[-1] + PERIOD * np.arange(1, 51)
    return Ticks(np.append(time, later), counts, counts.copy())


PATTERNS = [
    "none",
    "one",
    "the second message",
    "two at a time",
    "five at a time",
    "a queue let go",
]


@pytest.mark.parametrize("pattern", PATTERNS)
def test_close_stamps_do_not_turn_reset_detection_off(pattern: str) -> None:
    ticks = driven_then_reset(hiccups(pattern))
    live = Live(odometer := Odometer(ROBOT), ticks)
    recorded = trajectory(ROBOT, *ticks)
    assert odometer.tally.resets == recorded.tally.resets == 1
    whole = COUNTS * TICK * (499 + 49)
    assert live.pose[-1, 0] == recorded.x[-1] == pytest.approx(whole, abs=1e-9)


@pytest.mark.parametrize("pattern", PATTERNS)
def test_what_a_reset_hid_is_told_by_the_pace_of_the_drive_not_by_one_stamp(pattern: str) -> None:
    """The travel of one message, 9 mm, to within what stamps leave open."""
    time = hiccups(pattern)
    steps = [step for step in map(Encoder(ROBOT).step, *driven_then_reset(time)) if step]
    (lost,) = [step for step in steps if step.left_lost > 0.0]
    assert 0.1 < np.sqrt(lost.left_lost) / (COUNTS * TICK) < 10.0
    assert lost.left_lost == lost.right_lost


@pytest.mark.parametrize("pattern", PATTERNS)
def test_close_stamps_make_no_reset_of_coming_slowly_home(pattern: str) -> None:
    """Both counters come to exactly zero, two counts a message: no reset, whatever the stamps."""
    time = hiccups(pattern)
    counts = 2 * np.abs(np.arange(time.size) - 401)
    steps = wheel_steps(ROBOT, time, counts, counts)
    assert steps.tally.resets == 0
    assert steps.left.sum() == pytest.approx((counts[-1] - counts[0]) * TICK)


@pytest.mark.parametrize("pattern", PATTERNS)
def test_close_stamps_are_no_speed_that_no_wheel_can_have(pattern: str) -> None:
    """Nothing is refused: not where the usual interval, after two silent seconds, is a guess."""
    time = hiccups(pattern)
    counts = COUNTS * np.arange(time.size)
    limits = EncoderLimits(max_wheel_speed=2.5 * COUNTS * TICK / PERIOD)
    live = Live(odometer := Odometer(ROBOT, limits=limits), Ticks(time, counts, counts.copy()))
    recorded = trajectory(ROBOT, time, counts, counts, limits=limits)
    assert odometer.tally == recorded.tally
    assert odometer.tally.accepted == time.size
    assert live.pose[-1, 0] == recorded.x[-1] == pytest.approx(counts[-1] * TICK, abs=1e-9)


def test_a_fast_drive_is_forgotten_after_some_thousand_messages() -> None:
    """Ten turns a second, then hours of a slow drive: a fall is judged by what is usual now."""
    encoder = Encoder(ROBOT)
    steps = np.concatenate([np.full(100, 400), np.full(2 * REMEMBERED, 2)])
    counts = np.append(0, np.cumsum(steps))
    for at, count in enumerate(counts.tolist()):
        encoder.step(PERIOD * at, count, count)
    assert encoder.pace.fastest == pytest.approx(2 / 2000 / PERIOD)
    encoder = Encoder(ROBOT)
    for at, count in enumerate(counts[: 100 + REMEMBERED // 2].tolist()):
        encoder.step(PERIOD * at, count, count)
    assert encoder.pace.fastest == pytest.approx(400 / 2000 / PERIOD)


@settings(max_examples=30, deadline=None)
@given(
    records(),
    st.lists(st.sampled_from([0.0, 1e-12, 1e-9, 2e-5, 1e-3, 0.02, 3.0]), min_size=1, max_size=40),
    st.sampled_from([0.004, 0.02, 0.5]),
)
def test_whatever_came_before_a_later_reset_is_seen(
    record: Record, intervals: list[float], period: float
) -> None:
    """After any record, with any stamps, and then a quiet drive: live and recorded alike."""
    robot, limits, ticks = record
    usable = np.isfinite(ticks.time) & np.isfinite(ticks.left) & np.isfinite(ticks.right)
    if not usable.any():
        return
    robot = replace(robot, encoder_bits=0)
    lying = np.cumsum(np.resize(intervals, ticks.time.size))
    quiet = 2 * REMEMBERED
    start = np.nanmax(np.append(lying, 0.0)) + period
    rolling = 20 * np.arange(quiet + 1) + 1_000_000
    after = np.append(rolling, 20 * np.arange(1, 21))
    time = np.concatenate([lying, start + period * np.arange(after.size)])
    left = np.concatenate([np.asarray(ticks.left, dtype=float), after])
    right = np.concatenate([np.asarray(ticks.right, dtype=float), after])
    if limits.max_wheel_speed:
        limits = replace(limits, max_wheel_speed=40 * robot.left_tick / period)
    before = slice(0, time.size - 20)
    encoder = Encoder(robot, limits)
    for message in zip(*(part[before].tolist() for part in (time, left, right)), strict=True):
        encoder.step(*message)
    resets = encoder.tally.resets
    for message in zip(*(part[-20:].tolist() for part in (time, left, right)), strict=True):
        encoder.step(*message)
    assert encoder.tally.resets == resets + 1
    recorded = trajectory(robot, time, left, right, limits=limits)
    assert recorded.tally == encoder.tally
    assert_sound(recorded.covariance.matrix())


@settings(max_examples=60, deadline=None)
@given(
    st.lists(
        st.tuples(
            st.floats(-1e9, 1e9) | st.sampled_from([0.0, 5e-324, 1e-170, 1e-12, 1e-9, 0.02, 1e9]),
            st.integers(-(2**24), 2**24) | st.just(0),
            st.integers(-(2**24), 2**24) | st.just(0),
        ),
        max_size=60,
    ),
    st.sampled_from([0.0, 1.0]),
)
def test_any_stamps_and_counters_leave_the_covariance_sound(
    messages: list[tuple[float, int, int]], limit: float
) -> None:
    odometer = Odometer(ROBOT, limits=EncoderLimits(max_wheel_speed=limit))
    time = 0.0
    covariances = []
    for elapsed, left, right in messages:
        time += elapsed
        estimate = odometer.update(time, left, right)
        if estimate is None:
            continue
        covariances.append(estimate.covariance)
        assert np.isfinite(estimate.pose).all()
        assert np.isfinite(estimate.twist).all()
        speed, cross, yaw_rate = estimate.twist_covariance
        assert np.isfinite([speed, cross, yaw_rate]).all()
        assert abs(cross) <= np.sqrt(speed * yaw_rate) * (1.0 + 1e-9)
    if covariances:
        assert_sound(np.array([entry.matrix() for entry in covariances]))


def assert_sound(matrices: np.ndarray) -> None:
    """Finite, symmetric and positive semi-definite, each in its own units, (n, 3, 3) in order.

    But for rounding: on the way back over a bend a sideways variance cancels, and what is left of
    it, of either sign, is as large as the rounding of the largest there was.
    """
    assert np.isfinite(matrices).all()
    assert (matrices == np.swapaxes(matrices, -1, -2)).all()
    largest = np.maximum.accumulate(np.einsum("nii->ni", matrices), axis=0)
    largest[:, :2] = largest[:, :2].max(axis=-1, keepdims=True)
    rounded = 64.0 * np.finfo(float).eps * largest[:, :, None] * np.eye(3)
    whole = matrices + rounded
    deviation = np.sqrt(np.einsum("nii->ni", whole))
    scale = deviation[:, :, None] * deviation[:, None, :]
    scaled = np.divide(whole, scale, out=np.zeros_like(whole), where=scale > 0.0)
    assert np.linalg.eigvalsh(scaled).min(initial=0.0) >= -1e-6


@pytest.mark.parametrize("pattern", PATTERNS)
@pytest.mark.parametrize("robot", [ROBOT, replace(ROBOT, encoder_bits=16)], ids=["wide", "16 bits"])
def test_a_record_with_close_stamps_is_read_as_row_by_row(pattern: str, robot: Robot) -> None:
    """Long enough that most rows are taken together, and old paces forgotten on the way."""
    parts = [driven_then_reset(hiccups(pattern, 700)) for _ in range(8)]
    time = np.concatenate([1e3 * at + part.time for at, part in enumerate(parts)])
    counts = as_read(np.concatenate([part.left for part in parts]), robot.encoder_bits)
    encoder = Encoder(robot)
    rows = zip(time.tolist(), counts.tolist(), counts.tolist(), strict=True)
    steps = [step for step in (encoder.step(*row) for row in rows) if step is not None]
    together = wheel_steps(robot, time, counts, counts)
    assert together.tally == encoder.tally
    for name, column in zip(WheelStep._fields, np.array(steps).T, strict=True):
        assert np.array_equal(getattr(together, name), column), name
    assert all(earlier < later for earlier, later in pairwise(together.row.tolist()))
