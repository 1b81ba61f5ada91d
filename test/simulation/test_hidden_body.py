# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Effects hidden in the body and on the floor do what their physics says, and no more."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from werrimbi_odom.simulation import (
    AxlePose,
    Manoeuvre,
    MoveLimits,
    Peculiarity,
    Recording,
    TruePath,
    TrueRobot,
    figure_eight,
    free,
    moves,
    out_and_back,
    record,
    spin,
    start_stop,
)
from werrimbi_odom.simulation.chassis import SKID_BEHIND
from werrimbi_odom.simulation.hidden.creep import (
    CastorKick,
    CoulombSlip,
    LateralSlip,
    LongitudinalSlip,
    TurnDependentTrack,
)
from werrimbi_odom.simulation.hidden.floor import CablePull, FloorSlope, SlipperySpot
from werrimbi_odom.simulation.hidden.geometry import (
    TrackWidth,
    UnequalWheelRadii,
    WheelRadiusScale,
)
from werrimbi_odom.simulation.hidden.mount import AskewAxle
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

Floats = NDArray[np.float64]
BASE, RADIUS = 0.35, 0.05
CALM = free(30.0, seed=1, speed=0.4, yaw_rate=1.0)
BRISK = free(30.0, seed=2, speed=0.8, yaw_rate=2.0, acceleration=1.5)
LINE = moves("line", [(3.0, 0.0)])


def drive(odd: Peculiarity, manoeuvre: Manoeuvre, **robot: bool) -> Recording:
    return record(TrueRobot(**robot), manoeuvre, seed=1, hidden=[odd])


def rolled(path: TruePath) -> tuple[Floats, Floats]:
    """Travel of both wheels as plain odometry has it [m]."""
    return path.left_angle_rad * RADIUS, path.right_angle_rad * RADIUS


def errors(path: TruePath, left: Floats, right: Floats, crab: float = 0.0) -> tuple[Floats, Floats]:
    """Of dead reckoning: distance [m] and heading [rad] from the truth, row by row."""
    dl, dr = np.diff(left), np.diff(right)
    turn = (dr - dl) / BASE
    yaw = path.yaw_rad[0] + crab + np.concatenate(([0.0], np.cumsum(turn)))
    chord = (dl + dr) / 2 * np.sinc(turn / (2 * np.pi))
    heading = yaw[:-1] + turn / 2
    x = path.x_m[0] + np.concatenate(([0.0], np.cumsum(chord * np.cos(heading))))
    y = path.y_m[0] + np.concatenate(([0.0], np.cumsum(chord * np.sin(heading))))
    return np.hypot(x - path.x_m, y - path.y_m), np.abs(yaw - crab - path.yaw_rad)


def far(path: TruePath) -> float:
    return math.hypot(path.x_m[-1] - path.x_m[0], path.y_m[-1] - path.y_m[0])


def cumulated(first: float, steps: Floats) -> Floats:
    return first + np.concatenate(([0.0], np.cumsum(steps)))


@pytest.mark.parametrize(
    ("odd", "left", "right", "base"),
    [
        (TrackWidth(1.03), 1.0, 1.0, 1.03),
        (WheelRadiusScale(0.98), 0.98, 0.98, 1.0),
        (UnequalWheelRadii(1.02), 2 / 2.02, 2.04 / 2.02, 1.0),
    ],
)
def test_wrong_geometry(odd: Peculiarity, left: float, right: float, base: float) -> None:
    path = drive(odd, BRISK).true_path
    middle = (path.left_angle_rad * left + path.right_angle_rad * right) * RADIUS / 2
    half = (path.right_angle_rad * right - path.left_angle_rad * left) * RADIUS / 2 / base
    position, heading = errors(path, middle - half, middle + half)
    assert position.max() < 1e-4
    assert heading.max() < 5e-5


@pytest.mark.parametrize("manoeuvre", [CALM, BRISK], ids=["calm", "brisk"])
def test_an_eccentric_wheel_leads_and_lags_once_a_turn(manoeuvre: Manoeuvre) -> None:
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
    runs = [record(TrueRobot(), LINE, seed=s, hidden=[odd]) for s in (1, 2)]
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
    turned = np.diff(path.left_angle_rad)
    middle = path.left_angle_rad[:-1] + 0.5 * turned
    lever = np.array([odd.higher(angle) for angle in middle])
    farther = np.concatenate([[0.0], np.cumsum(lever * turned)])
    _, heading = errors(path, left + farther, right)
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
    path = drive(Backlash(side, travel), out_and_back(1.0, laps=2)).true_path  # type: ignore[arg-type]
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


def test_slip_loses_way_while_accelerating_and_gains_it_back_while_braking() -> None:
    """Over a ramp to speed v the loss is c v^2 / 2."""
    c, v = 0.02, 0.8
    pace = MoveLimits(speed=v, acceleration=1.0, pause=1.0)
    path = drive(LongitudinalSlip(c), moves("line", [(3.0, 0.0)], pace)).true_path
    left, right = rolled(path)
    position, heading = errors(path, left, right)
    half_way = np.searchsorted(left - left[0], 1.5)
    assert position[half_way] == pytest.approx(c * v**2 / 2, rel=0.02)
    assert position[-1] < 0.02 * c * v**2 / 2
    assert heading.max() < 1e-5


@pytest.mark.parametrize(("acceleration", "share"), [(0.4, 0.0), (1.0, 0.5)])
def test_friction_holds_below_a_force_and_gives_way_above(
    acceleration: float, share: float
) -> None:
    """Over a ramp to speed v the loss is c v^2 / 2, less the share that the threshold holds."""
    c, v = 0.1, 0.8
    pace = MoveLimits(speed=v, acceleration=acceleration, pause=1.0)
    path = drive(CoulombSlip(c, above=0.5), moves("line", [(4.0, 0.0)], pace)).true_path
    left, right = rolled(path)
    position, _ = errors(path, left, right)
    half_way = np.searchsorted(left - left[0], 2.0)
    assert position[half_way] == pytest.approx(share * c * v**2 / 2, rel=0.05, abs=1e-3)


def test_slip_does_not_care_which_way_is_forwards() -> None:
    c, v = 0.02, 0.8
    pace = MoveLimits(speed=v, acceleration=1.0, pause=1.0)
    path = drive(LongitudinalSlip(c), moves("line", [(-3.0, 0.0)], pace)).true_path
    reach = np.hypot(path.x_m - path.x_m[0], path.y_m - path.y_m[0])
    left, _ = rolled(path)
    half_way = np.searchsorted(left[0] - left, 1.5)
    behind = left[0] - left[half_way] - reach[half_way]
    assert behind == pytest.approx(c * v**2 / 2, rel=0.02)


def test_curves_are_wider_by_the_lateral_creep() -> None:
    creep = 0.01
    path = drive(LateralSlip(creep), figure_eight(0.8)).true_path
    dx, dy, turn = np.diff(path.x_m), np.diff(path.y_m), np.diff(path.yaw_rad)
    ahead = path.yaw_rad[:-1] + turn / 2
    sideways = np.cos(ahead) * dy - np.sin(ahead) * dx
    along = np.cos(ahead) * dx + np.sin(ahead) * dy
    speed = along / np.diff(path.t_s)
    assert -sideways @ (speed * turn) / np.sum((speed * turn) ** 2) == pytest.approx(
        creep, rel=0.01
    )
    assert errors(path, *rolled(path))[1].max() < 1e-4


def test_the_base_is_wider_in_sharp_turns() -> None:
    odd = TurnDependentTrack(0.03, "sharpness")
    path = drive(odd, spin(2.0)).true_path
    assert path.yaw_rad[-1] - path.yaw_rad[0] == pytest.approx(4 * math.pi / 1.03, rel=1e-4)
    path = drive(odd, moves("arc", [(math.pi, 1.0)])).true_path  # sharpness: base/2 over radius
    expected = 1.0 / (1 + 0.03 * BASE / 2 / math.pi)
    assert path.yaw_rad[-1] - path.yaw_rad[0] == pytest.approx(expected, rel=1e-4)


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_the_base_is_wider_in_left_turns(sense: float) -> None:
    path = drive(TurnDependentTrack(0.03, "sense"), spin(2.0 * sense)).true_path
    turned = path.yaw_rad[-1] - path.yaw_rad[0]
    assert turned == pytest.approx(sense * 4 * math.pi / (1 + 0.03 * sense), rel=2e-4)


@pytest.mark.parametrize(("alternating", "kicks"), [(False, 3.0), (True, -1.0)])
def test_a_castor_kicks_at_reversals_alone(alternating: bool, kicks: float) -> None:
    """Two laps of out and back hold three reversals: back, forth and back again."""
    odd = CastorKick(0.02, alternating)
    path = drive(odd, out_and_back(1.0, laps=2)).true_path
    assert path.yaw_rad[-1] - path.yaw_rad[0] == pytest.approx(0.02 * kicks, rel=1e-3)
    path = drive(odd, start_stop(3, laps=1)).true_path
    kicked = np.abs(np.diff(path.yaw_rad)) > 1e-6
    turned_back = np.argmax(path.left_angle_rad)
    assert not kicked[: turned_back - 100].any(), "stop and go in one direction is no reversal"


def test_a_slope_carries_downhill_with_the_way() -> None:
    path = drive(FloorSlope(0.01, 0.5), CALM).true_path
    dl, dr = (np.diff(side) for side in rolled(path))
    way = np.abs(dl + dr).sum() / 2
    turn = (dr - dl) / BASE
    yaw = path.yaw_rad[:-1] + turn / 2
    chord = (dl + dr) / 2
    drift_x = path.x_m[-1] - path.x_m[0] - (chord * np.cos(yaw)).sum()
    drift_y = path.y_m[-1] - path.y_m[0] - (chord * np.sin(yaw)).sum()
    assert drift_x == pytest.approx(0.01 * way * math.cos(0.5), abs=2e-4)
    assert drift_y == pytest.approx(0.01 * way * math.sin(0.5), abs=2e-4)
    assert errors(path, *rolled(path))[1].max() < 1e-4


def test_a_spot_is_slippery_where_it_lies_and_nowhere_else() -> None:
    odd = SlipperySpot(loss=0.2, x=0.3, y=0.1, radius=0.5)
    start = AxlePose(0.3, 0.1, 0.0)
    path = record(TrueRobot(), CALM, seed=1, start=start, hidden=[odd]).true_path
    dl, dr = (np.diff(side) for side in rolled(path))
    turn = np.diff(path.yaw_rad)
    ahead = path.yaw_rad[:-1] + turn / 2
    along = np.cos(ahead) * np.diff(path.x_m) + np.sin(ahead) * np.diff(path.y_m)
    away = np.hypot(path.x_m[1:] - 0.3, path.y_m[1:] - 0.1)
    lost = (dl + dr) / 2 - along
    outside, inside = away > 0.5 + BASE / 2 + 0.01, away < 0.5 - BASE / 2 - 0.01
    assert np.abs(lost[outside]).max() < 1e-6
    assert inside.sum() > 100
    assert outside.sum() > 100
    np.testing.assert_allclose(lost[inside], 0.2 * ((dl + dr) / 2)[inside], atol=1e-6)


def test_a_cable_turns_the_robot_towards_one_direction() -> None:
    path = drive(CablePull(0.03, 1.0), CALM).true_path
    dl, dr = (np.diff(side) for side in rolled(path))
    residual_innovations = np.diff(path.yaw_rad) - (dr - dl) / BASE
    expected = 0.03 * np.abs(dl + dr) / 2 * np.sin(1.0 - path.yaw_rad[1:])
    assert np.abs(residual_innovations.cumsum() - expected.cumsum()).max() < 5e-5
    assert np.abs(expected.cumsum()).max() > 0.01


def test_radii_follow_the_measured_temperature() -> None:
    recording = drive(RadiusFollowsTemperature(1e-3), CALM)
    warmth = recording.channels["wheel_temperature_c"]
    assert len(warmth) == len(recording.t_s)
    path = recording.true_path
    grown = 1 + 1e-3 * (np.interp(path.t_s[:-1], recording.t_s, warmth) - 20.0)
    left, right = (cumulated(s[0], np.diff(s) * grown) for s in rolled(path))
    plain, _ = errors(path, *rolled(path))
    position, _ = errors(path, left, right)
    assert position.max() < 0.05 * plain.max()


def test_radii_follow_the_measured_payload() -> None:
    recording = drive(RadiusFollowsPayload(2e-3), CALM)
    load = recording.channels["payload_kg"]
    path = recording.true_path
    shrunk = 1 - 2e-3 * np.interp(path.t_s[:-1], recording.t_s, load)
    left, right = (cumulated(s[0], np.diff(s) * shrunk) for s in rolled(path))
    plain, _ = errors(path, *rolled(path))
    position, _ = errors(path, left, right)
    assert position.max() < 0.05 * plain.max()


def test_radii_grow_with_the_square_of_speed() -> None:
    pace = MoveLimits(speed=0.8, acceleration=1.0)
    path = drive(TyreSquash(-0.05), moves("line", [(3.0, 0.0)], pace)).true_path
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
    path = record(TrueRobot(), BRISK, seed=1, hidden=both).true_path
    left, right = rolled(path)
    middle, half = (left + right) / 2, (right - left) / 2 / 1.02
    position, heading = errors(path, middle - half, middle + half, crab=0.02)
    assert position.max() < 1e-4
    assert heading.max() < 5e-5
