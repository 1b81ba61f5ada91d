# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A reference that a script brought to the times of the counters: what was measured is judged."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from werrimbi_odom.files.run_folder import read_reference
from werrimbi_odom.model.pose import wrap_all

RATE = 50.0


def path_at(time: np.ndarray, noise: float) -> np.ndarray:
    """A robot that goes straight and in bends: x, y, yaw (3, n)."""
    fine = np.arange(0.0, 61.0, 0.002)
    yaw = np.cumsum(0.002 * np.where(fine % 8.0 < 4.0, 0.5 * np.sin(fine), 0.0))
    way = np.cumsum(0.002 * 0.3 * np.exp(1j * yaw))
    true = np.stack([np.interp(time, fine, each) for each in (way.real, way.imag, yaw)])
    return true + np.random.default_rng(0).normal(0.0, noise, true.shape)


def written(
    path: Path, time: np.ndarray, poses: np.ndarray, names: str = "x_m,y_m,yaw_rad"
) -> Path:
    columns = [
        wrap_all(values) if name == "yaw_rad" else values
        for name, values in zip(("x_m", "y_m", "yaw_rad"), poses, strict=True)
        if name in names
    ]
    np.savetxt(
        path, np.stack([time, *columns], axis=1), "%.5f", ",", header=f"t_s,{names}", comments=""
    )
    return path


@pytest.mark.parametrize("names", ["x_m,y_m,yaw_rad", "x_m,y_m", "yaw_rad"])
@pytest.mark.parametrize("carried_on", [False, True])
@pytest.mark.parametrize("first", [0.0, 0.007])
def test_of_a_resampled_reference_what_was_measured_is_judged(
    tmp_path: Path, names: str, first: float, *, carried_on: bool
) -> None:
    """Two poses a second at 50 Hz: each bend was cut short, and the base came out 4 sigma wide."""
    measured = np.arange(first, 60.0, 0.5)
    poses = path_at(measured, 2e-3)
    time = np.arange(1.0, 59.0, 1.0 / RATE)
    last = np.searchsorted(measured, time + 1e-9) - 1
    if carried_on:
        speed = (poses[:, last] - poses[:, last - 1]) / 0.5
        resampled = poses[:, last] + speed * (time - measured[last])
    else:
        resampled = np.stack([np.interp(time, measured, each) for each in poses])
    reference, told = read_reference(written(tmp_path / "reference.csv", time, resampled, names))
    kept = np.searchsorted(time, reference.time - 1e-6)
    off = [np.min(np.abs(measured - each)) for each in reference.time[1:-1]]
    assert 110 < reference.time.size < 130
    assert max(off) < 1.0 / RATE
    assert any(
        f"{time.size - kept.size} of its {time.size} rows lie on the line" in each for each in told
    )


@pytest.mark.parametrize("noise", [0.0, 1e-5, 1e-3])
def test_measured_poses_stay_also_those_of_a_simulator_without_noise(
    tmp_path: Path, noise: float
) -> None:
    """Its straight lines are straight to the last digit, and its bends are all corners."""
    time = np.arange(0.0, 60.0, 1.0 / RATE)
    reference, told = read_reference(
        written(tmp_path / "reference.csv", time, path_at(time, noise))
    )
    assert reference.time.size == time.size
    assert not any("on the line" in each for each in told)
