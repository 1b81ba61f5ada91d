# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""From counters to travel: nothing is lost, nothing counts twice, nothing makes the pose jump."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from test.model.drives import ROBOT
from test.model.records import Record, as_read, drives, records
from werrimbi_odom.model.encoder_online import (
    CLOCK_JUMP,
    Encoder,
    EncoderLimits,
    EncoderTally,
    WheelStep,
    wrapped,
)
from werrimbi_odom.model.encoder_recorded import wheel_steps
from werrimbi_odom.model.robot import Robot

TICK = ROBOT.left_tick
Message = tuple[float, float, float]


def steps_of(encoder: Encoder, *messages: Message) -> list[WheelStep]:
    return [step for step in (encoder.step(*message) for message in messages) if step is not None]


def driven(robot: Robot = ROBOT, limits: EncoderLimits | None = None) -> Encoder:
    """An encoder in the middle of a drive at 50 messages a second, 20 counts (3 mm) a message."""
    encoder = Encoder(robot, limits or EncoderLimits())
    for at in range(101):
        encoder.step(0.02 * at, 20 * at, 20 * at)
    return encoder


NOW, THERE = 2.0, 2000  # stamp and counts at the end of `driven`


def fates(tally: EncoderTally) -> int:
    return (
        tally.accepted
        + tally.duplicates
        + tally.out_of_order
        + tally.not_finite
        + tally.implausible
    )


# Travel.


def test_the_first_message_is_where_counting_starts() -> None:
    encoder = Encoder(ROBOT)
    assert encoder.step(5.0, 12_345, -77) is None
    assert encoder.step(5.1, 12_345, -77) == WheelStep(5.1, 5.1 - 5.0, 0.0, 0.0)


def test_counts_become_metres_by_each_wheels_own_radius_and_resolution() -> None:
    robot = Robot(
        0.4,
        0.1,
        1000,
        250,
        left_wheel_radius_multiplier=1.02,
        right_wheel_radius_multiplier=0.98,
    )
    (step,) = steps_of(Encoder(robot), (0.0, 0, 0), (1.0, 1000, -250))
    assert step.left == pytest.approx(2.0 * math.pi * 0.102)
    assert step.right == pytest.approx(-2.0 * math.pi * 0.098)


def test_no_reading_makes_no_step() -> None:
    none = np.zeros(0, dtype=np.int64)
    assert wheel_steps(ROBOT, np.zeros(0), none, none).time.size == 0


def test_positions_in_radians_are_counts_of_a_wheel_with_two_pi_to_the_turn() -> None:
    robot = Robot(0.35, 0.05, 2.0 * math.pi, 2.0 * math.pi)
    (step,) = steps_of(Encoder(robot), (0.0, 10.0, -3.0), (0.1, 10.25, -3.5))
    assert step.left == pytest.approx(0.05 * 0.25)
    assert step.right == pytest.approx(-0.05 * 0.5)


@pytest.mark.parametrize("far", [2**53, 2**60, -(2**62)])
def test_counters_far_from_zero_stay_exact_to_the_count(far: int) -> None:
    """A float would no longer see single counts out there."""
    counts = far + np.arange(0, 1000, 1, dtype=np.int64)
    steps = wheel_steps(ROBOT, np.arange(1000) * 0.02, counts, counts)
    assert (steps.left == TICK).all()
    (live,) = steps_of(Encoder(ROBOT), (0.0, far, far), (0.02, far + 1, far + 1))
    assert live.left == TICK


@given(drives(), st.randoms(use_true_random=False))
def test_lost_messages_lose_no_motion(
    counts: tuple[np.ndarray, np.ndarray], random: object
) -> None:
    left, right = counts
    keep = np.array([True, *(random.random() < 0.3 for _ in left[1:-1]), True][: left.size])
    time = 0.02 * np.arange(left.size)
    limits = EncoderLimits(max_wheel_speed=100.0)
    every = wheel_steps(ROBOT, time, left, right, limits)
    few = wheel_steps(ROBOT, time[keep], left[keep], right[keep], limits)
    assert few.left.sum() == pytest.approx(every.left.sum(), abs=1e-9)
    assert few.right.sum() == pytest.approx(every.right.sum(), abs=1e-9)


# Wraps.


@pytest.mark.parametrize("bits", [8, 16, 32])
@pytest.mark.parametrize("unsigned", [False, True])
@given(counts=drives())
def test_a_counter_that_wraps_measures_what_a_wider_one_does(
    bits: int, unsigned: bool, counts: tuple[np.ndarray, np.ndarray]
) -> None:
    shown = [as_read(count, bits) for count in counts]
    if unsigned:
        shown = [count & ((1 << bits) - 1) for count in shown]
    time = 0.02 * np.arange(counts[0].size)
    limits = EncoderLimits(max_wheel_speed=100.0)
    narrow = wheel_steps(replace(ROBOT, encoder_bits=bits), time, *shown, limits)
    wide = wheel_steps(ROBOT, time, *counts, limits)
    assert narrow.tally.resets == narrow.tally.jumps == 0
    assert np.array_equal(narrow.left, wide.left)
    assert np.array_equal(narrow.right, wide.right)
    crossed = sum(
        np.count_nonzero(np.diff(count) != np.diff(read))
        for count, read in zip(counts, shown, strict=True)
    )
    assert narrow.tally.wraps == crossed


@pytest.mark.parametrize(
    ("bits", "last", "first"),
    [(8, 127, -128), (16, 32767, -32768), (16, 65535, 0), (32, 2**31 - 1, -(2**31))],
)
def test_one_count_over_the_edge_is_one_count_both_ways(bits: int, last: int, first: int) -> None:
    encoder = Encoder(replace(ROBOT, encoder_bits=bits))
    over, back = steps_of(
        encoder,
        (0.0, last - 1, first),
        (0.02, last, first),
        (0.04, first, last),
        (0.06, last, first),
    )[1:]
    assert (over.left, over.right) == (TICK, -TICK)
    assert (back.left, back.right) == (-TICK, TICK)
    assert encoder.tally.wraps == 4
    assert encoder.tally.resets == 0


def test_a_wrap_during_a_gap_is_still_a_wrap() -> None:
    encoder = driven(replace(ROBOT, encoder_bits=16))
    shown = THERE + 32_000 - 2**16
    (step,) = steps_of(encoder, (NOW + 32.0, shown, shown))
    assert step.left == step.right == pytest.approx(32_000 * TICK)
    assert (encoder.tally.wraps, encoder.tally.gaps, encoder.tally.resets) == (2, 1, 0)


def test_wrapping_to_exactly_zero_on_both_sides_is_no_reset() -> None:
    encoder = Encoder(replace(ROBOT, encoder_bits=16))
    (step,) = steps_of(encoder, (0.0, 65535, 1), (0.02, 0, 0))
    assert (step.left, step.right) == (TICK, -TICK)
    assert (encoder.tally.wraps, encoder.tally.resets) == (1, 0)


def test_fractions_of_a_count_are_no_wrap() -> None:
    encoder = Encoder(replace(ROBOT, encoder_bits=16))
    (step,) = steps_of(encoder, (0.0, 0.1, 0.2), (0.02, 0.2, 0.4))
    assert step.left == (0.2 - 0.1) * TICK
    assert encoder.tally.wraps == 0


@given(st.integers(2, 64), st.integers(-(2**70), 2**70))
def test_wrapping_keeps_the_difference_and_brings_it_into_range(bits: int, count: int) -> None:
    result = wrapped(count, bits)
    assert (result - count) % 2**bits == 0
    assert -(2 ** (bits - 1)) <= result < 2 ** (bits - 1)
    assert wrapped(count, 0) == count


@pytest.mark.parametrize("bits", [62, 63, 64])
def test_the_widest_counters_wrap_without_overflowing(bits: int) -> None:
    robot = replace(ROBOT, encoder_bits=bits)
    top = 2 ** (bits - 1)
    counts = [top - 600 + at if at < 600 else -top + at - 600 for at in range(1200)]
    time = 0.02 * np.arange(1200)
    limits = EncoderLimits(max_wheel_speed=1.0)
    steps = wheel_steps(robot, time, np.array(counts), np.array(counts), limits)
    assert (steps.left == TICK).all()
    assert steps.tally.wraps == 2


# Resets.


def test_a_reset_never_jumps_and_costs_the_variance_of_the_travel_it_hides() -> None:
    encoder = driven()
    (step,) = steps_of(encoder, (NOW + 0.1, 3, 2))
    speed = 20 * TICK / 0.02
    assert (step.left, step.right) == (0.0, 0.0)
    assert step.left_lost == pytest.approx((speed * 0.1) ** 2)
    assert step.right_lost == pytest.approx((speed * 0.1) ** 2)
    assert encoder.tally.resets == 1
    (after,) = steps_of(encoder, (NOW + 0.12, 23, 22))
    assert (after.left, after.right) == (20 * TICK, 20 * TICK)
    assert after.left_lost == 0.0


def test_a_reset_at_rest_costs_nothing() -> None:
    encoder = driven()
    _, step = steps_of(encoder, (NOW + 0.02, THERE, THERE), (NOW + 0.04, 0, 0))
    assert encoder.tally.resets == 1
    assert step[2:] == (0.0, 0.0, 0.0, 0.0)


def test_one_counter_alone_can_be_reset() -> None:
    encoder = driven()
    (step,) = steps_of(encoder, (NOW + 0.02, THERE + 20, 4))
    assert encoder.tally.resets == 1
    assert (step.left, step.right) == (0.0, 0.0)


def test_a_reset_during_a_gap_is_seen_when_both_counters_are_exactly_zero() -> None:
    """After ten seconds the wheels could be anywhere; but not both exactly there, by chance."""
    encoder = driven()
    (step,) = steps_of(encoder, (NOW + 10.0, 0, 0))
    assert encoder.tally.resets == 1
    assert (step.left, step.right) == (0.0, 0.0)
    assert step.left_lost == pytest.approx((20 * TICK / 0.02 * 10.0) ** 2)


@pytest.mark.parametrize("rate", [5.0, 50.0, 1000.0])
@pytest.mark.parametrize("turns_a_second", [0.2, 1.0, 5.0])
def test_coming_home_through_zero_is_no_reset(rate: float, turns_a_second: float) -> None:
    """Out and back past the start at ordinary speed: the counters fall to zero and beyond."""
    counts = 2000.0 * turns_a_second / rate * np.arange(-200, 201)
    there_and_back = np.round(np.concatenate([counts[200:], counts[::-1]])).astype(np.int64)
    time = np.arange(there_and_back.size) / rate
    steps = wheel_steps(ROBOT, time, there_and_back, there_and_back)
    assert steps.tally.resets == 0
    assert steps.left.sum() == pytest.approx(there_and_back[-1] * TICK)


def test_starting_away_from_zero_is_no_reset() -> None:
    """Counters stand at zero, and then start."""
    messages = [(0.02 * at, max(0, 20 * (at - 5)), max(0, 20 * (at - 5))) for at in range(30)]
    encoder = Encoder(ROBOT)
    steps = steps_of(encoder, *messages)
    assert encoder.tally.resets == 0
    assert sum(step.left for step in steps) == pytest.approx(480 * TICK)


@pytest.mark.parametrize(("top_speed", "resets"), [(0.0, 0), (0.03, 1)])
def test_a_known_top_speed_tells_resets_from_motion_sharply(top_speed: float, resets: int) -> None:
    """From 30 counts to 2 in 20 ms: 0.2 m/s, which a wheel can do unless known to be slower."""
    encoder = Encoder(ROBOT, EncoderLimits(max_wheel_speed=top_speed))
    for at in range(31):
        encoder.step(0.02 * at, at, at)
    encoder.step(0.62, 2, 2)
    assert encoder.tally.resets == resets


# Stamps.


def test_a_message_sent_twice_counts_once() -> None:
    encoder = driven()
    again = encoder.step(NOW, THERE, THERE)
    (step,) = steps_of(encoder, (NOW + 0.02, THERE + 20, THERE + 20))
    assert again is None
    assert step.left == 20 * TICK
    assert encoder.tally.duplicates == 1


def test_a_late_message_is_left_out_and_nothing_is_lost() -> None:
    encoder = driven()
    late = encoder.step(NOW - 0.03, THERE - 30, THERE - 30)
    (step,) = steps_of(encoder, (NOW + 0.02, THERE + 20, THERE + 20))
    assert late is None
    assert step.left == 20 * TICK
    assert encoder.tally.out_of_order == 1


def test_a_clock_set_back_loses_no_motion_either() -> None:
    encoder = driven()
    back, after = steps_of(
        encoder, (NOW - 100.0, THERE + 20, THERE + 20), (NOW - 99.98, THERE + 40, THERE + 40)
    )
    assert back.left == after.left == 20 * TICK
    assert back.duration == pytest.approx(0.02)  # as the messages before
    assert encoder.tally.clock_jumps == 1


@pytest.mark.parametrize(("back", "late"), [(0.5, 1), (CLOCK_JUMP, 1), (1.001, 0), (1e9, 0)])
def test_a_second_back_is_late_and_more_is_another_clock(back: float, late: int) -> None:
    encoder = driven()
    encoder.step(NOW - back, THERE, THERE)
    assert (encoder.tally.out_of_order, encoder.tally.clock_jumps) == (late, 1 - late)


@pytest.mark.parametrize("gap", [1.001, 10.0, 3600.0])
def test_a_gap_keeps_its_motion_and_is_counted(gap: float) -> None:
    encoder = driven()
    ahead = THERE + round(1000 * gap)
    (step,) = steps_of(encoder, (NOW + gap, ahead, ahead))
    assert step.left == pytest.approx((ahead - THERE) * TICK)
    assert step.duration == pytest.approx(gap)
    assert encoder.tally.gaps == 1


# Values that cannot be.


@pytest.mark.parametrize("which", [0, 1, 2])
@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_what_is_not_a_number_is_refused_and_nothing_is_lost(which: int, value: float) -> None:
    encoder = driven()
    message = [NOW + 0.02, THERE + 20, THERE + 20]
    message[which] = value
    (step,) = steps_of(encoder, (*message,), (NOW + 0.04, THERE + 40, THERE + 40))
    assert step.left == 40 * TICK
    assert encoder.tally.not_finite == 1


FAST = EncoderLimits(max_wheel_speed=1.0)


def test_a_single_glitch_is_refused_and_nothing_is_lost() -> None:
    encoder = driven(limits=FAST)
    (step,) = steps_of(
        encoder, (NOW + 0.02, THERE + 99_999, THERE + 20), (NOW + 0.04, THERE + 40, THERE + 40)
    )
    assert (step.left, step.right) == (40 * TICK, 40 * TICK)
    assert (encoder.tally.implausible, encoder.tally.jumps) == (1, 0)


def test_a_jump_that_a_second_message_confirms_anchors_anew() -> None:
    encoder = driven(limits=FAST)
    (step,) = steps_of(encoder, (NOW + 0.02, 99_999, THERE + 20), (NOW + 0.04, 100_019, THERE + 40))
    assert (step.left, step.right) == (0.0, 0.0)
    assert step.left_lost == pytest.approx((20 * TICK / 0.02 * 0.04) ** 2)
    assert (encoder.tally.implausible, encoder.tally.jumps) == (1, 1)
    (after,) = steps_of(encoder, (NOW + 0.06, 100_039, THERE + 60))
    assert after.left == pytest.approx(20 * TICK)


def test_a_glitch_that_is_sent_twice_does_not_confirm_itself() -> None:
    encoder = driven(limits=FAST)
    glitch = (NOW + 0.02, THERE + 99_999, THERE + 20)
    (step,) = steps_of(encoder, glitch, glitch, (NOW + 0.04, THERE + 40, THERE + 40))
    assert (step.left, step.right) == (40 * TICK, 40 * TICK)
    assert (encoder.tally.implausible, encoder.tally.duplicates) == (1, 1)


def test_glitch_after_glitch_never_moves_the_robot() -> None:
    encoder = driven(limits=FAST)
    for at in range(1, 50):
        wild = (-1) ** at * 1_000_000 * at
        assert encoder.step(NOW + 0.02 * at, wild, THERE + 20 * at) is None
    (step,) = steps_of(encoder, (NOW + 1.0, THERE + 1000, THERE + 1000))
    assert step.left == pytest.approx(1000 * TICK)
    assert encoder.tally.implausible == 49


def test_without_a_top_speed_nothing_but_a_fall_to_zero_is_doubted() -> None:
    encoder = driven()
    (step,) = steps_of(encoder, (NOW + 0.02, THERE + 99_999, THERE))
    assert step.left == pytest.approx(99_999 * TICK)


# The books.


@settings(max_examples=100, deadline=None)
@given(records())
def test_every_message_has_one_fate(record: Record) -> None:
    robot, limits, ticks = record
    encoder = Encoder(robot, limits)
    given_back = 0
    for message in zip(*(column.tolist() for column in ticks), strict=True):
        given_back += encoder.step(*message) is not None
    tally = encoder.tally
    assert tally.messages == ticks.time.size == fates(tally)
    assert given_back == max(tally.accepted - 1, 0)
    assert tally.resets + tally.jumps <= given_back
    assert tally.as_dict()["messages"] == tally.messages


@settings(max_examples=30, deadline=None)
@given(records(), st.integers(1, 4))
def test_a_long_record_with_faults_here_and_there_is_read_as_row_by_row(
    record: Record, copies: int
) -> None:
    """Longer than the stretches that are read at once; the same steps, the same books."""
    robot, limits, ticks = record
    quiet = np.arange(300, 2300)
    time = np.concatenate([ticks.time, 1.8e9 + 0.02 * quiet])
    left, right = (
        np.concatenate([column, as_read(3 * quiet, robot.encoder_bits)])
        for column in (ticks.left, ticks.right)
    )
    time, left, right = (np.concatenate([column] * copies) for column in (time, left, right))
    together = wheel_steps(robot, time, left, right, limits)
    encoder = Encoder(robot, limits)
    steps, rows = [], []
    for row, message in enumerate(zip(time.tolist(), left.tolist(), right.tolist(), strict=True)):
        step = encoder.step(*message)
        if step is not None:
            steps.append(step)
            rows.append(row)
    assert together.row.tolist() == rows
    assert together.tally == encoder.tally
    columns = np.array(steps).reshape(-1, 6).T
    for name, column in zip(WheelStep._fields, columns, strict=True):
        assert np.array_equal(getattr(together, name), column), name


def test_counts_of_any_integer_width_are_read() -> None:
    time = 0.02 * np.arange(400)
    for kind in (np.int16, np.int32, np.uint16, np.uint32, np.uint64):
        counts = np.arange(400)[::-1].astype(kind)
        steps = wheel_steps(ROBOT, time, counts, counts)
        assert (steps.left == -TICK).all(), kind


def test_no_usable_row_is_said_by_a_first_row_of_minus_one() -> None:
    nothing = np.full(3, np.nan)
    steps = wheel_steps(ROBOT, nothing, nothing, nothing)
    assert steps.first_row == -1
    assert steps.row.size == 0
    assert steps.tally.not_finite == 3
