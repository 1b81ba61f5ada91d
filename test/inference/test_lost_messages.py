# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Messages that are late, lost or held back are told apart; stamps get no worse by it."""

from __future__ import annotations

import numpy as np
import pytest

from test.inference.test_even_stamps import driven, scatter
from werrimbi_odom.inference.legs.even_stamps import with_even_stamps
from werrimbi_odom.inference.legs.lost_messages import lost_messages
from werrimbi_odom.inference.legs.queued_messages import queued_messages

PERIOD = 0.02


def lossy(random: np.random.Generator, rows: int, share: float, burst: int) -> np.ndarray:
    """When the messages that come were read; the others are lost, `burst` at a time."""
    kept = np.ones(rows, dtype=bool)
    for first in np.flatnonzero(random.random(rows) < share / burst):
        kept[first : first + burst] = False
    return PERIOD * np.flatnonzero(kept)


def late(random: np.random.Generator, read: np.ndarray, delay: float) -> np.ndarray:
    """When messages come, in order: most soon, some late."""
    return np.maximum.accumulate(read + random.exponential(delay, read.size))


@pytest.mark.parametrize("share", [0.005, 0.02])
@pytest.mark.parametrize("delay", [2e-3, 5e-3])
@pytest.mark.parametrize("seed", range(2))
def test_where_some_come_late_the_lost_are_counted(seed: int, delay: float, share: float) -> None:
    """Three late ones of five were a lost one for seconds, and stamps worse than they came."""
    random = np.random.default_rng([seed, 1])
    read = lossy(random, 7500, share, 1)
    came = late(random, read, delay)
    off = with_even_stamps(came, *driven(read)) - read
    assert scatter(off) < 0.25 * scatter(came - read)
    assert np.mean(np.abs(off - np.median(off)) > 0.5 * PERIOD) < 1e-3


@pytest.mark.parametrize("burst", [5, 50])
def test_bursts_of_lost_messages_are_counted(burst: int) -> None:
    random = np.random.default_rng(2)
    read = lossy(random, 7500, 0.04, burst)
    came = late(random, read, 3e-3)
    found = with_even_stamps(came, *driven(read))
    assert scatter(found - read) < 0.25 * scatter(came - read)


def test_all_numbers_of_a_long_drive_are_right() -> None:
    """Parts that are gone through side by side fit together."""
    random = np.random.default_rng(3)
    read = lossy(random, 100_000, 0.005, 1)
    missing = np.rint(np.diff(read) / PERIOD).astype(int) - 1
    found = lost_messages(late(random, read, 2e-3), *driven(read))
    np.testing.assert_array_equal(found, missing)


@pytest.mark.parametrize("share", [0.0, 0.005])
@pytest.mark.parametrize("longest", [0.3, 2.0])
def test_a_driver_that_blocks_and_sends_all_at_once_is_put_back(
    longest: float, share: float
) -> None:
    random = np.random.default_rng(4)
    read = lossy(random, 5000, share, 1)
    came = late(random, read, 1e-3)
    for begin in (20.0, 40.0, 60.0):
        held = (came > begin) & (came < begin + longest * random.uniform(0.5, 1.0))
        came[held] = came[held][-1] + 2e-4 * np.arange(held.sum())
    came = np.maximum.accumulate(came)
    assert np.max(came - read) > 0.1
    off = with_even_stamps(came, *driven(read)) - read
    assert np.max(np.abs(off - np.median(off))) < PERIOD
    assert scatter(off) < 0.1 * PERIOD


def test_a_loss_that_is_counted_too_early_is_no_queue() -> None:
    """All that came before would be a period late, and none came at once to make up for it."""
    random = np.random.default_rng(5)
    read = PERIOD * np.delete(np.arange(4000.0), 2000)
    number = np.arange(3999.0) + (np.arange(3999) >= 1900)
    assert not queued_messages(read + random.uniform(0.0, 3e-3, read.size), number).any()


def test_stamps_stay_where_lost_messages_are_counted_wrong() -> None:
    """Each a third of a second early: what would be put right is more than what was late."""
    random = np.random.default_rng(6)
    read = lossy(random, 5000, 0.01, 1)
    came = late(random, read, 2e-3)
    missing = np.rint(np.diff(read) / PERIOD).astype(np.intp) - 1
    assert with_even_stamps(came, *driven(read), missing) is not came
    assert with_even_stamps(came, *driven(read), np.roll(missing, -16)) is came


@pytest.mark.parametrize("burst", [1, 20])
def test_stamps_without_jitter_stay_to_the_last_digit(burst: int) -> None:
    read = lossy(np.random.default_rng(7), 5000, 0.02, burst)
    assert with_even_stamps(read, *driven(read)) is read
