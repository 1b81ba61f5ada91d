# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A gyro's headings laid upon the direction of positions that hold none."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from test.white_noise_robot import RATE, wandering
from werrimbi_odom.effects.lookup import find
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.references.half_turns import without_half_turns
from werrimbi_odom.files.references.merged_reference import as_mounted, merged, with_one_scale
from werrimbi_odom.files.run import Reference, Run, Ticks
from werrimbi_odom.model.effect import AppliedEffect
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot

ARM = 0.3 + 0.3j
"""Of the aerial: ahead and left of the middle of the axle [m]."""
MEMORY = 30.0


class Drive:
    """Lines, curves both ways, spins, stops and reversing, sped up by `factor`; 150 s."""

    def __init__(self, factor: float = 1.0, seed: int = 3, spin: bool = False) -> None:
        self.random = np.random.default_rng(seed)
        speed, rate = wandering(self.random, 150.0)
        speed = np.zeros_like(speed) if spin else factor * speed
        self.time = np.arange(speed.size + 1) / RATE
        self.yaw = 0.7 + np.concatenate([[0.0], np.cumsum(rate / RATE)])
        step = speed / RATE * np.exp(0.5j * (self.yaw[1:] + self.yaw[:-1]))
        self.axle = np.concatenate([[0j], np.cumsum(step)])

    def positions(self, noise: float, wander: float = 0.0, late: float = 0.15) -> Reference:
        """Those of an aerial at 5 Hz; an error that wanders is drawn to nothing."""
        time = np.arange(0.3, self.time[-1], 0.2)
        aerial = self.axle + ARM * np.exp(1j * self.yaw)
        seen = np.interp(time - late, self.time, aerial.real) + 1j * np.interp(
            time - late, self.time, aerial.imag
        )
        error, kept = wander * self._normal(1), math.exp(-0.2 / MEMORY)
        for row in range(time.size):
            seen[row] += error[0] + noise * self._normal(1)[0]
            error = kept * error + math.sqrt(1.0 - kept**2) * wander * self._normal(1)
        return Reference(time, seen.real, seen.imag, np.full(time.size, np.nan))

    def gyro(self, scale: float = 1.0, bias: float = 0.01, late: float = 0.03) -> Reference:
        rate = np.gradient(np.interp(self.time - late, self.time, self.yaw), self.time)
        rate = scale * rate + bias + 3e-3 * self.random.standard_normal(rate.size)
        nothing = np.full(rate.size, np.nan)
        return Reference(self.time, nothing, nothing, np.cumsum(rate) / RATE)

    def off(self, found: Reference, late: float = 0.03) -> Floats:
        """Error of headings, but for their delay [rad]."""
        true = np.interp(found.time - late, self.time, self.yaw)
        off = np.angle(np.exp(1j * (found.yaw - true)))
        return np.asarray(off[np.isfinite(off)])

    def _normal(self, count: int) -> Any:
        return self.random.standard_normal(count) + 1j * self.random.standard_normal(count)


def test_headings_are_those_of_the_path_however_the_aerial_sits() -> None:
    """Though a third goes backwards, and the aerial turns beside the axle and is late."""
    drive = Drive()
    places = drive.positions(0.02)
    for both in ((places, drive.gyro()), (drive.gyro(), places)):
        found, told = merged("bag", *both)
        np.testing.assert_array_equal(found.x, places.x)
        assert np.abs(drive.off(found)).max() < math.radians(2.0)
        assert abs(np.mean(drive.off(found))) < math.radians(0.7)
        assert found.kind == "local_map"
        assert found.gyro is not None
        assert found.gyro.by_course
        assert "laid upon the direction of the path" in told
        drift = float(told.split("steady drift of ")[1].split("°")[0])
        assert drift == pytest.approx(-math.degrees(0.6), abs=1.0)
        assert "neither an angle at which the robot drives nor" in told


@pytest.mark.parametrize("seed", range(3))
def test_satellites_that_wander_tell_the_heading_as_well_as_is_said(seed: int) -> None:
    drive = Drive(2.0, seed)
    found, told = merged("bag", drive.positions(0.02, wander=0.5), drive.gyro())
    said = math.radians(float(told.split("to ±")[1].split("°")[0]))
    assert 0.01 < said < 0.2
    assert np.abs(drive.off(found)).max() < 3.0 * said


def test_the_path_tells_a_gyros_scale_where_it_is_known_well() -> None:
    drive = Drive()
    found, _ = merged("bag", drive.positions(0.02), drive.gyro(0.96))
    assert found.gyro is not None
    assert abs(found.gyro.scale - 1.0 / 0.96) < 3.0 * found.gyro.std < 0.03
    (mended,) = with_one_scale([found], [found])
    assert np.abs(drive.off(mended)).max() < 0.5 * np.abs(drive.off(found)).max()
    vague, _ = merged("bag", drive.positions(0.02, wander=0.3), drive.gyro(0.96))
    assert with_one_scale([vague], [vague]) == [vague]


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: (Drive(spin=True).positions(1e-3), Drive(spin=True).gyro()), "turns on the spot"),
        (lambda: (Drive().positions(1.0), Drive().gyro()), "positions scatter by"),
        (lambda: (Drive().positions(0.02), Drive().gyro(-1.0)), "does not turn as it does"),
        (lambda: (Drive().positions(0.02), Drive().gyro(57.3)), "does not turn as it does"),
    ],
    ids=["on the spot", "noise", "upside down", "degrees"],
)
def test_a_path_that_does_not_tell_the_heading_is_refused(
    make: Callable[[], tuple[Reference, Reference]], said: str
) -> None:
    with pytest.raises(InputError, match=f"holds no headings, and .*{said}"):
        merged("bag", *make())


def test_the_wheels_tell_ahead_from_behind() -> None:
    """Of a robot that drove backwards for the most part; most of the way is no proof."""
    drive = Drive()
    drive.axle = -drive.axle
    found, _ = merged("bag", drive.positions(0.02), drive.gyro())
    assert np.abs(drive.off(found)).min() > 3.0
    along = np.diff(drive.axle) * np.exp(-1j * drive.yaw[:-1])
    rolled = np.concatenate([[0.0], np.cumsum(along.real)])
    turned = 0.175 * drive.yaw
    counts = np.rint(1e4 * (rolled - turned)), np.rint(1e4 * (rolled + turned))
    run = Run("one", Path("one"), Ticks(drive.time, *counts), found)
    right = without_half_turns(run, 0)
    assert right.reference is not None
    assert np.abs(drive.off(right.reference)).max() < 0.05
    assert "mostly backwards" in right.notes[-1]
    wired = Run("one", Path("one"), Ticks(drive.time, -counts[1], -counts[0]), right.reference)
    swapped = without_half_turns(wired, 0)
    assert swapped.reference is not None
    assert np.abs(drive.off(swapped.reference)).min() > 3.0, "they turn as it does, and roll back"
    reversed_both = replace(run, ticks=Ticks(drive.time, -counts[0], -counts[1]))
    assert without_half_turns(reversed_both, 0) is reversed_both, "a mistake that is to be named"


def test_an_angle_of_the_robot_file_is_kept_and_not_found_again() -> None:
    drive = Drive()
    found, _ = merged("bag", drive.positions(0.02), drive.gyro())
    effects = (
        AppliedEffect(find("reference_yaw_offset"), {"angle": 0.2}),
        AppliedEffect(find("sideways_drift"), {"angle": 0.05}),
    )
    robot = replace(Robot(0.35, 0.05, 2000.0, 2000.0), effects=effects)
    turned = as_mounted(found, robot)
    np.testing.assert_allclose(turned.yaw - found.yaw, 0.15)
    np.testing.assert_allclose(as_mounted(turned, robot).yaw, turned.yaw)
    assert as_mounted(drive.positions(0.02), robot).gyro is None
