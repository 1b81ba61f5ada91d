# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Each law, with the true parameters, explains what the physics engine does.

The engine knows nothing of these laws: where it can, it makes the effect by geometry and forces.
Counters are exact and free of noise here, so what remains is the law's own want of truth.
"""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest

from test.effects.tracks import RADIUS, gone
from test.evidence import in_evidence

pytest.importorskip("mujoco")

from werrimbi_odom.effects import find
from werrimbi_odom.model.castor import PIVOT, TRAIL
from werrimbi_odom.model.effect import AppliedEffect, Effect
from werrimbi_odom.model.motion import WheelTravel
from werrimbi_odom.simulation import Peculiarity, Recording, TrueRobot, free, record
from werrimbi_odom.simulation.hidden.axle_and_reference import AskewAxle
from werrimbi_odom.simulation.hidden.counters import EncoderSkew, MissedTicks
from werrimbi_odom.simulation.hidden.creep import (
    CastorKick,
    CastorSwing,
    CoulombSlip,
    LateralSlip,
    LongitudinalSlip,
    TurnDependentTrack,
)
from werrimbi_odom.simulation.hidden.floor import FloorSlope, GrainedFloor
from werrimbi_odom.simulation.hidden.geometry import (
    TrackWidth,
    UnequalWheelRadii,
    WheelRadiusScale,
)
from werrimbi_odom.simulation.hidden.skid import LENGTH, SkidSteer
from werrimbi_odom.simulation.hidden.tyres import LoadTransfer, TyreSquash
from werrimbi_odom.simulation.hidden.wheels import (
    Backlash,
    EccentricWheel,
    OvalWheel,
    RadiusDrift,
    TreadBump,
)

PER_TURN = 2e5
BRISK, LONG = (
    free(seconds, seed=5, speed=0.7, yaw_rate=2.0, acceleration=1.2, backwards=0.4)
    for seconds in (12.0, 25.0)
)
"""The long one for what grows with time, and with the turns of a wheel."""
CALM = free(12.0, seed=6, speed=0.4, yaw_rate=1.0, backwards=0.4)
FAST = 0.35
"""Rim speed [m/s] that no wheel of either drive keeps to for long. Near its threshold no law can
know whether counts were lost: one counted speed is of a wheel just below it and of one above."""


def made(name: str, **values: float) -> AppliedEffect:
    return find(name).using(**values)


# What is hidden, the law with the same numbers, and how many times smaller both errors become.
CASES = [
    (TrackWidth(1.03), made("track_width", multiplier=1.03), 500),
    (UnequalWheelRadii(1.02), made("unequal_wheel_radii", ratio=1.02), 500),
    (WheelRadiusScale(0.98), made("wheel_radius_scale", multiplier=0.98), 500),
    (LongitudinalSlip(0.02), made("longitudinal_slip", coefficient=0.02), 5),
    (LongitudinalSlip(0.02, 0.4), made("longitudinal_slip", coefficient=0.02, turning=0.4), 5),
    (CoulombSlip(0.1, 0.3), made("coulomb_slip", coefficient=0.1, above=0.3), 3),
    (
        CoulombSlip(0.1, 0.3, 0.4),
        made("coulomb_slip", coefficient=0.1, above=0.3, turning=0.4),
        3,
    ),
    (LateralSlip(0.02), made("lateral_slip", creep=0.02), 50),
    (TurnDependentTrack(0.04, "sharpness"), made("turn_dependent_track", sharpness=0.04), 200),
    (TurnDependentTrack(0.04, "sense"), made("turn_dependent_track", sense=0.04), 100),
    (
        SkidSteer(1.7, 0.6, 0.45),
        made("skid_steer", multiplier=1.7, x=0.1 * LENGTH, y=0.05 * 0.35 * 0.7),
        100,
    ),
    (AskewAxle(0.03), made("sideways_drift", angle=0.03), 200),
    (
        FloorSlope(0.02, 1.0),
        made("floor_slope", x=0.02 * math.cos(1.0), y=0.02 * math.sin(1.0)),
        200,
    ),
    (
        GrainedFloor(0.02, 0.4),
        made("anisotropic_floor", along_x=0.02 * math.cos(0.8), diagonal=0.02 * math.sin(0.8)),
        200,
    ),
    (TyreSquash(0.05), made("tyre_squash", coefficient=0.05), 20),
    (TyreSquash(-0.05), made("tyre_squash", coefficient=-0.05), 20),
    (LoadTransfer(0.2, 1.0, 0.0), made("load_transfer", lateral=0.2 / 9.81), 20),
    (LoadTransfer(0.2, 0.0, 0.8), made("load_transfer", longitudinal=0.16 / 9.81), 5),
    (CastorKick(0.03, alternating=False), made("castor_kick", angle=0.03), 20),
    (CastorKick(0.03, alternating=True), made("castor_kick", alternating=0.03), 20),
    (CastorSwing(0.01, PIVOT, TRAIL, start=0.0), made("castor_swing", drag=0.01), 5),
    (RadiusDrift(1e-3, "metre"), made("radius_drift", per_metre=1e-3), 30),
    (RadiusDrift(3e-4, "second"), made("radius_drift", per_second=3e-4), 50),
    (EncoderSkew(0.02), made("encoder_skew", delay=0.02), 100),
    (MissedTicks("left", 0.05, FAST), made("left_missed_ticks", fraction=0.05, above=FAST), 50),
    (MissedTicks("right", 0.05, FAST), made("right_missed_ticks", fraction=0.05, above=FAST), 50),
]


@cache
def recorded(odd: Peculiarity | None, brisk: bool, *, keeps_zero: bool = False) -> Recording:
    robot = TrueRobot(
        left_ticks_per_revolution=PER_TURN,
        right_ticks_per_revolution=PER_TURN,
        counters_keep_zero=keeps_zero,
    )
    brisk_one = LONG if keeps_zero or isinstance(odd, RadiusDrift) else BRISK
    manoeuvre = brisk_one if brisk else CALM
    return record(robot, manoeuvre, seed=1, hidden=[odd] if odd else [])


def errors(recording: Recording, *effects: AppliedEffect) -> tuple[float, float]:
    """Largest distance [m] and angle [rad] of dead reckoning from the truth."""
    path, time = recording.true_path, recording.t_s
    x, y, yaw = (np.interp(time, path.t_s, v) for v in (path.x_m, path.y_m, path.yaw_rad))
    per_count = 2 * math.pi / PER_TURN * RADIUS
    left, right = recording.left_ticks * per_count, recording.right_ticks * per_count
    travel = WheelTravel(np.diff(left), np.diff(right))
    first = (left[0] / RADIUS, right[0] / RADIUS)
    counts = tuple(angle / (2 * math.pi) * 2000.0 for angle in first)
    reckoned = gone(np.diff(time), travel, effects, float(yaw[0]), counts)  # type: ignore[arg-type]
    far = np.hypot(reckoned.x - (x - x[0]), reckoned.y - (y - y[0]))
    return float(far.max()), float(np.abs(reckoned.yaw - yaw).max())


@pytest.mark.parametrize("brisk", [True, False], ids=["brisk", "calm"])
def test_without_anything_odd_dead_reckoning_is_true(brisk: bool) -> None:
    far, turned = errors(recorded(None, brisk))
    assert far < 3e-4
    assert turned < 1e-4


@pytest.mark.parametrize(
    "brisk",
    [True, in_evidence(False)],
    ids=["brisk", "calm"],
)
@pytest.mark.parametrize(("odd", "law", "times"), CASES, ids=lambda item: getattr(item, "name", ""))
def test_the_law_explains_the_engine(
    odd: Peculiarity, law: AppliedEffect, times: float, brisk: bool
) -> None:
    before, after = errors(recorded(odd, brisk)), errors(recorded(odd, brisk), law)
    floor = errors(recorded(None, brisk))
    assert before[0] > 1e-3
    for was, now, least in zip(before, after, floor, strict=True):
        assert now < was / times + 2 * least


@pytest.mark.parametrize("side", ["left", "right"])
def test_an_eccentric_wheel_by_geometry(side: str) -> None:
    """The hub's rise and fall pitches the body too, so half a millimetre of position remains."""
    odd = EccentricWheel(side, 1.5e-3, 0.7)  # type: ignore[arg-type]
    recording = recorded(odd, True, keeps_zero=True)
    law: Effect = find(f"eccentric_{side}_wheel")
    before = errors(recording)
    after = errors(recording, law.using(amplitude=1.5e-3, phase=-0.7))
    assert after[1] < before[1] / 20
    assert after[0] < before[0] / 5


@pytest.mark.parametrize("side", ["left", "right"])
def test_an_oval_wheel_by_geometry(side: str) -> None:
    """The engine's lies on its broad side at zero, so its largest radius is a quarter turn away."""
    odd = OvalWheel(side, 2e-3)  # type: ignore[arg-type]
    recording = recorded(odd, True, keeps_zero=True)
    law: Effect = find(f"oval_{side}_wheel")
    before = errors(recording)
    after = errors(recording, law.using(amplitude=2e-3, phase=math.pi))
    assert after[1] < before[1] / 10
    assert after[0] < before[0] / 3


@pytest.mark.parametrize(
    ("side", "thickness"),
    [("left", 2e-3), ("right", -1.5e-3), in_evidence("left", -1.5e-3), in_evidence("right", 2e-3)],
)
def test_a_bump_under_a_soft_tread(side: str, thickness: float) -> None:
    """The engine's has edges as soft as the tread, and covers as much as the law's."""
    odd = TreadBump(side, thickness, math.pi / 3, 0.9)  # type: ignore[arg-type]
    recording = recorded(odd, True, keeps_zero=True)
    law = find(f"{side}_tread_bump").using(height=thickness, place=-0.9)
    before, after = errors(recording), errors(recording, law)
    assert after[1] < before[1] / 50
    assert after[0] < before[0] / 50


@pytest.mark.parametrize("side", ["left", "right"])
def test_play_by_a_free_hinge(side: str) -> None:
    """Where the robot brakes gently; else its weight pushes the wheel through the play."""
    recording = recorded(Backlash(side, 4e-3), False)  # type: ignore[arg-type]
    before = errors(recording)
    after = errors(recording, find(f"{side}_backlash").using(travel=4e-3))
    assert after[0] < before[0] / 5
