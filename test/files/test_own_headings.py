# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A reference that goes along its own headings exactly was added up, and is told."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from werrimbi_odom.files.references.own_headings import words_about_own_headings
from werrimbi_odom.files.run import Reference, Ticks
from werrimbi_odom.files.run_folder import read_reference, write_run_folder

RANDOM = np.random.default_rng(5)


def reckoned(*, share: float = 0.5, rate: float = 0.4, seconds: float = 20.0) -> Reference:
    """As a robot's program adds up: steps along the heading before, midway or after."""
    time = np.arange(0.0, seconds, 0.015)
    speed = 0.4 * np.sin(0.5 * time)  # to and fro
    turn = rate * np.cos(0.3 * time) * 0.015
    yaw = np.cumsum(turn)
    steps = speed * 0.015 * np.exp(1j * (yaw - (1.0 - share) * turn))
    place = np.cumsum(steps)
    return Reference(time, np.round(place.real, 4), np.round(place.imag, 4), np.round(yaw, 6))


@pytest.mark.parametrize("share", [0.0, 0.5, 1.0])
def test_poses_that_were_added_up_are_told(share: float, tmp_path: Path) -> None:
    reference = reckoned(share=share)
    ticks = Ticks(reference.time, np.arange(reference.time.size), np.arange(reference.time.size))
    folder = write_run_folder(tmp_path / "run", ticks, reference)
    (told,) = read_reference(folder / "reference.csv")[1]
    assert told.startswith("reference.csv: it goes along its own headings to 0.")
    assert "If the robot computed it from its wheels, it shows none of their errors" in told


@pytest.mark.parametrize(
    ("noise", "ahead", "aside"), [(5e-4, 0.0, 0.0), (0.0, 0.01, 0.0), (0.0, 0.0, 2e-3)]
)
def test_what_was_measured_goes_sideways(noise: float, ahead: float, aside: float) -> None:
    """By its noise, by where its marker sits, or by where the marker looks."""
    true = reckoned()
    place = true.x + 1j * true.y + ahead * np.exp(1j * true.yaw)
    place += noise * (RANDOM.normal(size=place.size) + 1j * RANDOM.normal(size=place.size))
    assert not words_about_own_headings(
        Reference(true.time, place.real, place.imag, true.yaw + aside)
    )


def test_nothing_is_told_by_positions_too_coarse_a_line_or_a_short_way() -> None:
    coarse = reckoned()
    x, y = np.round(coarse.x, 3), np.round(coarse.y, 3)
    assert not words_about_own_headings(Reference(coarse.time, x, y, coarse.yaw))
    assert not words_about_own_headings(reckoned(rate=0.0))
    assert not words_about_own_headings(reckoned(seconds=3.0))
