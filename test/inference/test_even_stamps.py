# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Stamps that say when a message came are put right; stamps that say when it was read are not."""

from __future__ import annotations

import numpy as np
import pytest

from werrimbi_odom.inference.legs.even_stamps import evened

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
    found = evened(came, *driven(read))
    assert (np.diff(found) > 0.0).all()
    assert scatter(found - read) < 0.3 * scatter(came - read)


def test_two_that_come_together_were_not_read_together() -> None:
    read = PERIOD * np.arange(400)
    came = np.where(np.arange(400) % 3 == 0, np.append(read[1:], read[-1]), read)
    found = evened(came, *driven(read))
    assert (np.diff(found) > 0.0).all()
    assert scatter(found - read) < 0.3 * scatter(came - read)


@pytest.mark.parametrize("seed", range(5))
def test_a_timer_that_is_uneven_but_told_truly_is_believed(seed: int) -> None:
    random = np.random.default_rng(seed)
    read = np.sort(PERIOD * np.arange(400) + random.uniform(0.0, 0.1, 400))
    assert evened(read, *driven(read)) is read


def test_even_stamps_and_few_stay_as_they_are() -> None:
    read = PERIOD * np.arange(400)
    assert evened(read, *driven(read)) is read
    few = read[:40] + np.tile([0.0, 0.05], 20)
    assert evened(few, *driven(read[:40])) is few


def test_a_pause_of_the_record_stays_where_it_was() -> None:
    random = np.random.default_rng(1)
    read = PERIOD * np.arange(400) + np.where(np.arange(400) < 200, 0.0, 30.0)
    came = np.sort(read + random.uniform(0.0, 0.1, 400))
    found = evened(came, *driven(PERIOD * np.arange(400)))
    assert found is not came
    assert np.abs(found - came).max() < 0.1


def test_a_message_told_twice_was_read_once() -> None:
    random = np.random.default_rng(2)
    read = PERIOD * np.arange(400)
    came = np.sort(read + random.uniform(0.0, 0.1, 400))
    twice = np.sort(np.concatenate([np.arange(400), np.arange(0, 400, 4)]))
    counts = [part[twice] for part in driven(read)]
    found = evened(came[twice], *counts)
    assert (np.diff(found) >= 0.0).all()
    assert scatter(found - read[twice]) < 0.3 * scatter(came - read)
