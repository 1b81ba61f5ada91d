# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Headings that a script computed from the positions are no measurements."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from werrimbi_odom.files.run_folder import read_reference

TIME = np.arange(0.0, 60.0, 0.1)
FORTH = np.where(TIME % 20.0 < 12.0, 0.3, np.where(TIME % 20.0 < 16.0, -0.2, 0.0))
YAW = np.cumsum(0.1 * np.where(FORTH != 0.0, 0.4 * np.sin(0.3 * TIME), 0.0))
PLACE = np.cumsum(0.1 * FORTH * np.exp(1j * YAW))
COURSES: dict[str, Callable[[np.ndarray], np.ndarray]] = {
    "np.gradient": lambda z: np.asarray(np.gradient(z)),
    "from the row before": lambda z: np.diff(z, prepend=z[0]),
    "to the row after": lambda z: np.diff(z, append=z[-1]),
}


def read(path: Path, place: np.ndarray, yaw: np.ndarray, digits: int) -> tuple[bool, str]:
    """Whether headings are judged, and the remarks."""
    table = np.stack([TIME, place.real, place.imag, (yaw + np.pi) % (2.0 * np.pi) - np.pi], axis=1)
    np.savetxt(path, table, f"%.{digits}f", ",", header="t_s,x_m,y_m,yaw_rad", comments="")
    reference, remarks = read_reference(path)
    assert reference.has_position.all()
    return bool(reference.has_yaw.any()), "\n".join(remarks)


def seen(noise: float) -> np.ndarray:
    x, y = np.random.default_rng(0).normal(0.0, noise, (2, TIME.size))
    return np.asarray(PLACE + x + 1j * y)


@pytest.mark.parametrize("course", COURSES)
@pytest.mark.parametrize("digits", [3, 5, 9])
@pytest.mark.parametrize("reversing", [False, True])
def test_a_course_over_ground_is_no_heading(
    tmp_path: Path, course: str, digits: int, *, reversing: bool
) -> None:
    """At rest and in reverse a sound robot was said to be lifted, or turned by hand."""
    place = np.round(seen(2e-3), digits)
    yaw = np.angle(COURSES[course](place)) + np.pi * (reversing & (FORTH < 0.0))
    headings, remarks = read(tmp_path / "reference.csv", place, yaw, digits)
    assert not headings
    assert "not measured" in remarks


@pytest.mark.parametrize("noise", [0.0, 2e-4, 2e-3, 2e-2])
@pytest.mark.parametrize("of_yaw", [0.0, 3e-3, 3e-2])
def test_measured_headings_stay_however_noisy(tmp_path: Path, noise: float, of_yaw: float) -> None:
    yaw = YAW + np.random.default_rng(1).normal(0.0, of_yaw, TIME.size)
    assert read(tmp_path / "reference.csv", seen(noise), yaw, 5)[0]


def test_a_pose_that_was_reckoned_from_wheels_keeps_its_headings(tmp_path: Path) -> None:
    """It goes along its headings as well; that it is no measurement is said as ever."""
    yaw = np.round(YAW / 0.003) * 0.003
    place = np.cumsum(np.concatenate([[0.0], (0.1 * FORTH * np.exp(1j * yaw))[:-1]]))
    headings, remarks = read(tmp_path / "reference.csv", place, yaw, 5)
    assert headings
    assert "it goes along its own headings" in remarks
