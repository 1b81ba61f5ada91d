# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Stamps that say when a message came are put right; stamps that say when it was read are not."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from test.inference.driven import of_headings
from werrimbi_odom.files.run import Reference, Run, Ticks
from werrimbi_odom.inference.legs.count_interpolation import counters_of
from werrimbi_odom.inference.legs.even_stamps import (
    lost_messages,
    stamped_together,
    with_even_scan_stamps,
    with_even_stamps,
)
from werrimbi_odom.inference.legs.usable_run import with_no_driving
from werrimbi_odom.model.robot import Robot

PERIOD = 0.2


def driven(time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Counts of two wheels that turn with changing speed."""
    return tuple(
        np.floor(600.0 * time + 400.0 * np.sin(rate * time)).astype(np.int64) for rate in (0.4, 0.3)
    )


def scatter(off: np.ndarray) -> float:
    """About their mean: what all are late by is a delay, and no matter of these stamps."""
    return float(np.std(off))


@pytest.mark.parametrize("seed", range(5))
def test_messages_that_wait_are_put_back_to_when_they_were_read(seed: int) -> None:
    random = np.random.default_rng(seed)
    read = PERIOD * np.arange(400)
    came = np.sort(read + random.uniform(0.0, 0.1, 400))
    found = with_even_stamps(came, *driven(read))
    assert (np.diff(found) > 0.0).all()
    assert scatter(found - read) < 0.3 * scatter(came - read)


@pytest.mark.parametrize("seed", range(3))
def test_a_timer_that_keeps_its_pace_is_known_by_all_its_messages(seed: int) -> None:
    """By those of some seconds alone it wandered by 0.75 ms, at each start and stop another.

    By a lidar, whose stamps were even, a sound robot was told of a clock that drifts.
    """
    read = 0.05 * np.arange(1400)
    came = np.sort(read + np.random.default_rng(seed).normal(0.0, 4e-3, read.size))
    assert scatter(with_even_stamps(came, *driven(read)) - read) < 0.3e-3


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("changes", ["slowly", "at once"])
def test_a_timer_that_changes_its_pace_is_followed(changes: str, seed: int) -> None:
    """A clock that is set right on the way, and a timer that pauses for half a period."""
    even = 0.05 * np.arange(1400)
    slowly = changes == "slowly"
    read = even + (6e-3 * np.sin(0.2 * even) if slowly else 0.025 * (even > 30.0))
    came = np.sort(read + np.random.default_rng(seed).normal(0.0, 4e-3, read.size))
    found = with_even_stamps(came, *driven(read))
    assert found is not came
    assert scatter(found - read) < 0.4 * scatter(read - even)


def queueing(random: np.random.Generator, count: int = 1600) -> tuple[np.ndarray, np.ndarray]:
    """When messages of 40 Hz were read and came; from 15 s on ever more of them wait, then none."""
    read = 0.025 * np.arange(count)
    came = read + random.uniform(0.0, 0.01, count)
    busy = (read > 15.0) & (read < 21.0)
    came[busy] = 15.0 + 1.12 * (read[busy] - 15.0)
    apart = 0.003 * np.arange(count)
    return read, np.maximum.accumulate(came - apart) + apart


@pytest.mark.parametrize("seed", range(3))
def test_messages_that_queue_up_for_seconds_are_put_back(seed: int) -> None:
    """A busy recorder took 1.12 s for each second of messages, then 40 in a tenth of a second."""
    read, came = queueing(np.random.default_rng(seed))
    assert np.max(came - read) > 0.7
    assert (np.diff(came) < 0.005).sum() > 20
    found = with_even_stamps(came, *driven(read))
    assert (np.diff(found) > 0.0).all()
    off = found - read
    assert np.max(np.abs(off - np.median(off))) < 0.025


@pytest.mark.parametrize("seed", range(3))
def test_a_program_that_asks_again_and_again_has_no_timer(seed: int) -> None:
    """Over a poor radio answers come at once or late, and the next question waits for them.

    A Neato's drive of 46 s became one of 49 s, with stamps set back by 0.47 s (rms).
    """
    random = np.random.default_rng(seed)
    lost = np.repeat(random.uniform(size=20) < 0.3, 9)
    came = np.cumsum(np.where(lost, 0.65, 0.15) + random.uniform(-0.05, 0.05, 180))
    counts = np.floor(150.0 * np.arange(180.0)).astype(np.int64)  # as the numbers, by chance
    assert with_even_stamps(came, counts, counts) is came


def test_a_program_that_reads_more_often_to_catch_up_has_no_queue() -> None:
    """What it reads as it catches up it reads then, and finds next to no travel since the last."""
    read, came = queueing(np.random.default_rng(1), 4000)
    caught_up = (read > 15.0) & (read < 22.0)
    found = with_even_stamps(came, *driven(np.where(caught_up, came, read)))
    assert found is not came
    assert np.max(np.abs(found - came)) < 0.1


@pytest.mark.parametrize("together", [True, False])
def test_wheels_are_put_right_unless_one_queue_held_the_gyro_too(together: bool) -> None:
    random = np.random.default_rng(2)
    read, came = queueing(random)
    seen = np.sort((came if together else read) + random.uniform(0.0, 0.02, came.size))
    gyro = of_headings(seen, np.sin(0.2 * read))
    wheels = Ticks(came, *driven(read))
    assert stamped_together(Run("queue", Path("queue"), wheels, gyro)) == together


def test_two_that_come_together_were_not_read_together() -> None:
    read = PERIOD * np.arange(400)
    came = np.where(np.arange(400) % 3 == 0, np.append(read[1:], read[-1]), read)
    found = with_even_stamps(came, *driven(read))
    assert (np.diff(found) > 0.0).all()
    assert scatter(found - read) < 0.3 * scatter(came - read)


@pytest.mark.parametrize("seed", range(5))
def test_a_timer_that_is_uneven_but_told_truly_is_believed(seed: int) -> None:
    random = np.random.default_rng(seed)
    read = np.sort(PERIOD * np.arange(400) + random.uniform(0.0, 0.1, 400))
    assert with_even_stamps(read, *driven(read)) is read


def test_even_stamps_and_few_stay_as_they_are() -> None:
    read = PERIOD * np.arange(400)
    assert with_even_stamps(read, *driven(read)) is read
    few = read[:40] + np.tile([0.0, 0.05], 20)
    assert with_even_stamps(few, *driven(read[:40])) is few


def test_a_reading_that_failed_is_no_reason_to_believe_stamps() -> None:
    random = np.random.default_rng(4)
    read = PERIOD * np.arange(400)
    came = np.sort(read + random.uniform(0.0, 0.1, 400))
    left, right = (counts.astype(np.float64) for counts in driven(read))
    left[100] = np.nan
    assert scatter(with_even_stamps(came, left, right) - read) < 0.3 * scatter(came - read)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("rows", range(48, 56))
def test_of_few_rows_nothing_is_asked_that_they_do_not_hold(rows: int) -> None:
    read = PERIOD * np.arange(rows)
    came = np.sort(read + np.random.default_rng(5).uniform(0.0, 0.1, rows))
    assert np.isfinite(with_even_stamps(came, *driven(read))).all()


def test_a_pause_of_the_record_stays_where_it_was() -> None:
    random = np.random.default_rng(1)
    read = PERIOD * np.arange(400) + np.where(np.arange(400) < 200, 0.0, 30.0)
    came = np.sort(read + random.uniform(0.0, 0.1, 400))
    found = with_even_stamps(came, *driven(PERIOD * np.arange(400)))
    assert found is not came
    assert np.abs(found - came).max() < 0.1


@pytest.mark.parametrize("share", [0.005, 0.02, 0.1])
@pytest.mark.parametrize("off", [0.05, 0.2])
def test_lost_messages_are_counted(share: float, off: float) -> None:
    """Without them the stamps beside each hole were put right by half a period too much."""
    random = np.random.default_rng(6)
    read = PERIOD * np.arange(4000)
    read = read[random.random(4000) >= share]
    came = np.sort(read + random.normal(0.0, off * PERIOD, read.size))
    found = with_even_stamps(came, *driven(read))
    assert found is not came
    assert scatter(found - read) < 0.5 * scatter(came - read)


def test_a_timer_that_loses_its_pace_loses_no_messages() -> None:
    """It sleeps after each reading, and now and then for longer; no wheel turns further in that."""
    random = np.random.default_rng(8)
    waits = np.where(np.arange(4000) % 60 == 0, 0.6, 0.0)
    came = PERIOD * (np.arange(4000) + np.cumsum(waits) + random.normal(0.0, 0.1, 4000))
    assert not lost_messages(came, *driven(PERIOD * np.arange(4000))).any()


def test_a_gyro_that_comes_twice_as_often_in_the_same_packets_is_seen_to() -> None:
    """As a Kobuki's does, stamped a third of a millisecond after the counters."""
    random = np.random.default_rng(9)
    read = 0.02 * np.arange(2000)
    came = read + random.normal(0.0, 1e-3, 2000)
    seen = np.sort(np.concatenate([came, came + 9.7e-3])) + 3e-4 + random.normal(0.0, 1e-4, 4000)
    nothing = np.full(4000, np.nan)
    wheels = Ticks(came, *driven(read))
    assert stamped_together(
        Run("a", Path("a"), wheels, Reference(np.sort(seen), nothing, nothing, 0.0 * seen))
    )
    alone = np.arange(0.0, 40.0, 0.01) + random.normal(0.0, 1e-3, 4000)
    assert not stamped_together(
        Run("a", Path("a"), wheels, Reference(np.sort(alone), nothing, nothing, 0.0 * seen))
    )


def test_a_message_told_twice_was_read_once() -> None:
    random = np.random.default_rng(2)
    read = PERIOD * np.arange(400)
    came = np.sort(read + random.uniform(0.0, 0.1, 400))
    twice = np.sort(np.concatenate([np.arange(400), np.arange(0, 400, 4)]))
    counts = [part[twice] for part in driven(read)]
    found = with_even_stamps(came[twice], *counts)
    assert (np.diff(found) >= 0.0).all()
    assert scatter(found - read[twice]) < 0.3 * scatter(came - read)


def by_scans(seen: np.ndarray, stamps: np.ndarray, *, matched: bool = True) -> Reference:
    """Poses of a robot that drives curves at changing speed, to 2 mm and 2 mrad."""
    noise = np.random.default_rng(7).normal(0.0, 2e-3, (3, seen.size))
    fine = np.linspace(0.0, seen[-1], 50 * seen.size)
    yaw = 0.8 * np.sin(0.3 * fine)
    speed = (0.2 + 0.1 * np.sin(0.5 * fine)) * np.gradient(fine)
    x, y = np.cumsum(speed * np.cos(yaw)), np.cumsum(speed * np.sin(yaw))
    at = [np.interp(seen, fine, each) for each in (x, y, yaw)]
    return Reference(stamps, *(np.array(at) + noise), own_axes=matched)


@pytest.mark.parametrize("lost", [0, 4])
def test_a_lidar_turns_evenly_however_late_its_scans_come(lost: int) -> None:
    """Five turns a second over a network; some are matched with nothing."""
    random = np.random.default_rng(3)
    seen = np.delete(PERIOD * np.arange(300), random.integers(1, 299, lost))
    came = np.sort(seen + random.uniform(0.0, 0.2, seen.size))
    found = with_even_scan_stamps(by_scans(seen, came)).time
    assert (np.diff(found) > 0.0).all()
    assert scatter(found - seen) < 0.5 * scatter(came - seen)


@pytest.mark.parametrize("seed", range(4))
def test_where_scans_are_missing_by_the_dozen_stamps_get_no_worse(seed: int) -> None:
    random = np.random.default_rng(seed)
    seen = np.delete(PERIOD * np.arange(300), random.integers(1, 299, 30))
    came = np.sort(seen + random.uniform(0.0, 0.2, seen.size))
    found = with_even_scan_stamps(by_scans(seen, came)).time
    assert scatter(found - seen) <= scatter(came - seen)


def test_of_what_is_no_lidar_nobody_knows_whether_it_is_even() -> None:
    random = np.random.default_rng(3)
    seen = PERIOD * np.arange(300)
    came = np.sort(seen + random.uniform(0.0, 0.2, 300))
    reference = by_scans(seen, came, matched=False)
    assert with_even_scan_stamps(reference) is reference


def test_scans_that_are_stamped_truly_stay() -> None:
    random = np.random.default_rng(3)
    seen = np.sort(PERIOD * np.arange(300) + random.uniform(0.0, 0.1, 300))
    reference = by_scans(seen, seen)
    assert with_even_scan_stamps(reference) is reference


ROBOT = Robot(0.3, 0.05, 0.05, 1000.0, 1000.0)


@pytest.mark.parametrize("together", [True, False])
def test_wheels_are_put_right_unless_one_packet_brings_the_reference(together: bool) -> None:
    """4 ms of 50 late are a slip to who has a clock of its own, and nothing to who is as late."""
    random = np.random.default_rng(5)
    read = 0.05 * np.arange(800)
    stamps = np.sort(read + random.normal(0.0, 4e-3, read.size))
    seen = by_scans(read, stamps if together else read, matched=False)
    run = with_no_driving(Run("run", Path("run"), Ticks(stamps, *driven(read)), seen), ROBOT)
    found = counters_of(run, ROBOT, None).time
    if together:
        np.testing.assert_array_equal(found, stamps)
    else:
        assert scatter(found - read) < 0.3 * scatter(stamps - read)


def test_scans_in_one_packet_with_the_wheels_are_as_late_as_these() -> None:
    """A driver that asks for both in turn: too noisy scans show no evenness of their own."""
    random = np.random.default_rng(5)
    read = 0.2 * np.arange(300)
    stamps = np.sort(read + random.uniform(0.0, 0.2, read.size))
    matched = np.delete(np.arange(read.size), random.integers(1, 299, 40))
    seen = by_scans(read + 0.1, stamps + 0.1)
    noise = random.normal(0.0, 0.05, (3, read.size))
    seen = replace(seen, x=seen.x + noise[0], y=seen.y + noise[1], yaw=seen.yaw + noise[2])
    seen = seen.chosen(matched)
    assert with_even_scan_stamps(seen) is seen
    run = with_no_driving(Run("run", Path("run"), Ticks(stamps, *driven(read)), seen), ROBOT)
    wheels = counters_of(run, ROBOT, None).time
    assert scatter(wheels - read) < 0.5 * scatter(stamps - read)
    assert run.reference is not None
    middle = (read + 0.1)[matched]
    assert scatter(run.reference.time - middle) < 0.5 * scatter(seen.time - middle)


def test_hard_starts_are_no_reason_to_believe_stamps() -> None:
    """A wheel that speeds up is off the line of its neighbours too, whatever its stamps."""
    random = np.random.default_rng(6)
    read = 0.05 * np.arange(800)
    stamps = np.sort(read + random.normal(0.0, 4e-3, read.size))
    speed = np.clip(20.0 * np.abs((0.5 * read) % 2.0 - 1.0) - 5.0, 0.0, 8.0)  # rad/s
    counts = np.floor(160.0 * np.cumsum(speed) * 0.05).astype(np.int64)
    found = with_even_stamps(stamps, counts, counts)
    assert scatter(found - read) < 0.3 * scatter(stamps - read)


@pytest.mark.parametrize(("together", "apart"), [(2, 0.0), (4, 0.0), (3, 3e-4), (8, 2e-4)])
def test_of_messages_sent_together_the_last_is_as_old_as_their_stamp(
    together: int, apart: float
) -> None:
    """A driver reads at 100 Hz and sends several readings with the stamp of the last.

    Or a reader stamps them as they arrive, one after another.
    """
    read = 0.01 * np.arange(2000 // together * together)
    left, right = driven(read)
    stamps = np.repeat(read[together - 1 :: together], together)
    stamps += apart * (np.arange(stamps.size) % together - together + 1)
    found = counters_of(Run("run", Path("run"), Ticks(stamps, left, right), None), ROBOT, None)
    np.testing.assert_allclose(found.time, read[together - 1 :: together])
    np.testing.assert_allclose(found.left + found.first_left, left[together - 1 :: together])


def test_counters_that_tell_each_count_and_rest_now_and_then_send_no_packets() -> None:
    stamps = np.concatenate([30.0 * rest + 0.004 * np.arange(500) for rest in range(10)])
    counts = np.arange(stamps.size)
    found = counters_of(Run("run", Path("run"), Ticks(stamps, counts, counts), None), ROBOT, None)
    assert found.time.size == stamps.size
