# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Effects hidden in the wheels and in how they are mounted do what their physics says, no more."""

from __future__ import annotations

import math

import numpy as np
import pytest

from test.simulation.dead_reckoning import (
    BASE,
    BRISK,
    CALM,
    LINE,
    RADIUS,
    Floats,
    cumulated,
    drive,
    errors,
    far,
    rolled,
)
from werrimbi_odom import simulation as sim
from werrimbi_odom.simulation.chassis import SKID_BEHIND
from werrimbi_odom.simulation.hidden.axle_and_reference import AskewAxle
from werrimbi_odom.simulation.hidden.geometry import TrackWidth, UnequalWheelRadii, WheelRadiusScale
from werrimbi_odom.simulation.hidden.tyres import (
    RadiusFollowsPayload,
    RadiusFollowsTemperature,
    TyreSquash,
)
from werrimbi_odom.simulation.hidden.wheels import (
    Backlash,
    EccentricWheel,
    OvalWheel,
    RadiusDrift,
    TreadBump,
)


@pytest.mark.parametrize(
    ("odd", "left", "right", "base"),
    [
        (TrackWidth(1.03), 1.0, 1.0, 1.03),
        (WheelRadiusScale(0.98), 0.98, 0.98, 1.0),
        (UnequalWheelRadii(1.02), 2 / 2.02, 2.04 / 2.02, 1.0),
    ],
)
def test_wrong_geometry(odd: sim.Peculiarity, left: float, right: float, base: float) -> None:
    path = drive(odd, BRISK).true_path
    middle = (path.left_angle_rad * left + path.right_angle_rad * right) * RADIUS / 2
    half = (path.right_angle_rad * right - path.left_angle_rad * left) * RADIUS / 2 / base
    position, heading = errors(path, middle - half, middle + half)
    assert position.max() < 1e-4
    assert heading.max() < 5e-5


@pytest.mark.parametrize("manoeuvre", [CALM, BRISK], ids=["calm", "brisk"])
def test_an_eccentric_wheel_leads_and_lags_once_a_turn(manoeuvre: sim.Manoeuvre) -> None:
    """Its hub travels r dq - d(a cos(q - phase)).

    The heading follows to 3 % of the effect. The position is off by half a millimetre, since the
    hub's rise and fall also pitches the body, against which the encoders measure.
    """
    amplitude, phase = 1.5e-3, 0.7
    path = drive(EccentricWheel("left", amplitude, phase), manoeuvre).true_path
    left, right = rolled(path)
    _, plain = errors(path, left, right)
    position, heading = errors(path, left - amplitude * np.cos(path.left_angle_rad - phase), right)
    assert plain.max() > 5e-3
    assert heading.max() < 2e-4
    assert position.max() < amplitude


def test_the_phase_belongs_to_the_counter_only_where_that_keeps_its_zero() -> None:
    odd = EccentricWheel("right", 1e-3, 0.0)
    runs = [sim.record(sim.TrueRobot(), LINE, seed=s, hidden=[odd]) for s in (1, 2)]
    shown = [(r.right_ticks[0] / 2000 * 2 * math.pi, r.true_path.right_angle_rad[0]) for r in runs]
    apart = [math.remainder(counter - angle, 2 * math.pi) for counter, angle in shown]
    assert abs(apart[0] - apart[1]) > 0.1
    run = drive(odd, LINE, counters_keep_zero=True)
    angle = run.right_ticks[0] / 2000 * 2 * math.pi
    assert angle == pytest.approx(run.true_path.right_angle_rad[0], abs=0.01)


def test_an_oval_wheel_errs_twice_a_turn() -> None:
    path = drive(OvalWheel("left", 0.02 * RADIUS), BRISK).true_path
    left, right = rolled(path)
    _, plain = errors(path, left, right)
    # An ellipse's hub is above its contact but for ovality * r * sin(2 q), half of it each way;
    # its circumference is longer by the ovality squared over four.
    law = left * (1 + 0.02**2 / 4) - 0.5 * 0.02 * RADIUS * np.sin(2 * path.left_angle_rad)
    _, heading = errors(path, law, right)
    assert plain.max() > 0.02 * RADIUS / 2 / BASE
    assert heading.max() < 3e-4


def test_a_bump_carries_the_hub_higher_by_its_part_of_the_patch() -> None:
    """All of it on its middle, half of it at its edges, none a patch away; its area is its own."""
    bump = TreadBump("left", 2e-3, 1.2, 0.5, patch=0.25)
    for angle, share in ((0.0, 1.0), (4 * math.pi, 1.0), (0.6, 0.5), (-0.6, 0.5)):
        assert bump.higher(0.5 + angle) == pytest.approx(share * 2e-3)
    assert bump.higher(0.5 + 0.86) == bump.higher(0.5 + math.pi) == 0.0
    angles = np.linspace(0.0, 2 * math.pi, 10_001)
    area = np.mean([bump.higher(angle) for angle in angles[:-1]]) * 2 * math.pi
    assert area == pytest.approx(2e-3 * 1.2, rel=1e-6)


@pytest.mark.parametrize("thickness", [2e-3, -2e-3])
def test_a_wheel_goes_farther_while_it_stands_on_its_bump(thickness: float) -> None:
    odd = TreadBump("left", thickness, 1.2, 0.5)
    path = drive(odd, BRISK).true_path
    left, right = rolled(path)
    _, plain = errors(path, left, right)
    spun = np.diff(path.left_angle_rad)
    middle = path.left_angle_rad[:-1] + 0.5 * spun
    lever = np.array([odd.higher(angle) for angle in middle])
    _, heading = errors(path, left + cumulated(0.0, lever * spun), right)
    assert plain.max() > 5e-3
    assert heading.max() < 1e-4


def test_an_askew_axle_makes_a_crab() -> None:
    path = drive(AskewAxle(0.03), BRISK).true_path
    left, right = rolled(path)
    assert errors(path, left, right)[0].max() > 0.03
    position, heading = errors(path, left, right, crab=0.03)
    assert position.max() < 1e-4
    assert heading.max() < 5e-5


@pytest.mark.parametrize("side", ["left", "right"])
def test_play_is_lost_at_each_reversal(side: str) -> None:
    travel = 4e-3
    path = drive(Backlash(side, travel), sim.out_and_back(1.0, laps=2)).true_path  # type: ignore[arg-type]
    shafts = dict(zip(("left", "right"), rolled(path), strict=True))
    follower = shafts[side].copy()
    for i in range(1, len(follower)):
        shaft = shafts[side][i]
        follower[i] = min(max(follower[i - 1], shaft - travel / 2), shaft + travel / 2)
    # It begins in the middle of its play, so the heading is off by half of it to either side.
    assert errors(path, shafts["left"], shafts["right"])[1].max() > 0.98 * travel / 2 / BASE
    shafts[side] = follower
    _, heading = errors(path, shafts["left"], shafts["right"])
    assert heading[-1] < 0.02 * travel / BASE


def less_pitch(rise: float | Floats) -> float | Floats:
    """Travel [m] that the encoders miss when both hubs rise and the body pitches about its skid."""
    return RADIUS * rise / SKID_BEHIND


def test_radii_drift_with_the_way() -> None:
    path = drive(RadiusDrift(0.01, "metre"), LINE).true_path
    distance = 0.0
    for step in np.diff(path.left_angle_rad) * RADIUS:
        distance += step * (1 + 0.01 * distance)
    rise = RADIUS * 0.01 * distance
    assert far(path) == pytest.approx(distance - less_pitch(rise), rel=2e-5)


def test_radii_drift_with_time() -> None:
    path = drive(RadiusDrift(0.002, "second"), LINE).true_path
    spun = np.diff(path.left_angle_rad)
    steps = spun * RADIUS * (1 + 0.002 * path.t_s[:-1])
    began, ended = path.t_s[:-1][np.abs(spun) > 1e-6][[0, -1]]
    rise = RADIUS * 0.002 * (ended - began)
    assert far(path) == pytest.approx(steps.sum() - less_pitch(rise), rel=2e-5)


@pytest.mark.parametrize(
    ("odd", "name", "per_unit", "neutral"),
    [
        (RadiusFollowsTemperature(1e-3), "wheel_temperature_c", 1e-3, 20.0),
        (RadiusFollowsPayload(2e-3), "payload_kg", -2e-3, 0.0),
    ],
    ids=["temperature", "payload"],
)
def test_radii_follow_what_is_measured(
    odd: sim.Peculiarity, name: str, per_unit: float, neutral: float
) -> None:
    recording = drive(odd, CALM)
    path, measured = recording.true_path, recording.channels[name]
    assert len(measured) == len(recording.t_s)
    grown = 1 + per_unit * (np.interp(path.t_s[:-1], recording.t_s, measured) - neutral)
    left, right = (cumulated(s[0], np.diff(s) * grown) for s in rolled(path))
    plain, _ = errors(path, *rolled(path))
    position, _ = errors(path, left, right)
    assert position.max() < 0.05 * plain.max()


def test_radii_grow_with_the_square_of_speed() -> None:
    pace = sim.MoveLimits(speed=0.8, acceleration=1.0)
    path = drive(TyreSquash(-0.05), sim.moves("line", [(3.0, 0.0)], pace)).true_path
    spun = np.diff(path.left_angle_rad).max() / 5e-3
    fastest = np.hypot(np.diff(path.x_m), np.diff(path.y_m)).max() / 5e-3
    assert fastest == pytest.approx(spun * RADIUS * (1 + 0.05 * (spun * RADIUS) ** 2), rel=1e-3)


@pytest.mark.parametrize("loss", [-0.05, 0.05])
def test_a_tyre_that_changes_as_it_brakes_keeps_the_floor(loss: float) -> None:
    """It slipped: shrunk under a hub at rest it hung in the air, by 31 mm in half a minute."""
    path = drive(TyreSquash(loss), BRISK).true_path
    steps = np.diff(np.stack(rolled(path)))
    # A radius is set by the speed of the last period; both together tilt the body.
    lost = loss * (np.pad(steps, ((0, 0), (1, 0))) / 5e-3) ** 2
    pitched = less_pitch(RADIUS * -lost.mean(axis=0))
    sides = [cumulated(0.0, side) - pitched for side in steps * (1.0 - lost[:, :-1])]
    plain, _ = errors(path, *rolled(path))
    position, heading = errors(path, *sides)
    assert plain.max() > 0.4
    assert position.max() < 2e-4
    assert heading.max() < 5e-5


def test_two_effects_act_together() -> None:
    both = [TrackWidth(1.02), AskewAxle(0.02)]
    path = sim.record(sim.TrueRobot(), BRISK, seed=1, hidden=both).true_path
    left, right = rolled(path)
    middle, half = (left + right) / 2, (right - left) / 2 / 1.02
    position, heading = errors(path, middle - half, middle + half, crab=0.02)
    assert position.max() < 1e-4
    assert heading.max() < 5e-5
