# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Effects hidden in tyres that slip and on the floor do what their physics says, and no more."""

from __future__ import annotations

import math

import numpy as np
import pytest

from test.simulation.dead_reckoning import BASE, CALM, drive, errors, rolled, turned
from werrimbi_odom import simulation as sim
from werrimbi_odom.simulation.hidden.creep import (
    CastorKick,
    CoulombSlip,
    LateralSlip,
    LongitudinalSlip,
    TurnDependentTrack,
)
from werrimbi_odom.simulation.hidden.floor import CablePull, FloorSlope, SlipperySpot


def to_half_way(path: sim.TruePath, metres: float) -> np.intp:
    """Row at which the left wheel has rolled so far."""
    left, _ = rolled(path)
    return np.searchsorted(np.abs(left - left[0]), metres)


def test_slip_loses_way_while_accelerating_and_gains_it_back_while_braking() -> None:
    """Over a ramp to speed v the loss is c v^2 / 2."""
    c, v = 0.02, 0.8
    pace = sim.MoveLimits(speed=v, acceleration=1.0, pause=1.0)
    path = drive(LongitudinalSlip(c), sim.moves("line", [(3.0, 0.0)], pace)).true_path
    position, heading = errors(path, *rolled(path))
    assert position[to_half_way(path, 1.5)] == pytest.approx(c * v**2 / 2, rel=0.02)
    assert position[-1] < 0.02 * c * v**2 / 2
    assert heading.max() < 1e-5


@pytest.mark.parametrize(("acceleration", "share"), [(0.4, 0.0), (1.0, 0.5)])
def test_friction_holds_below_a_force_and_gives_way_above(
    acceleration: float, share: float
) -> None:
    """Over a ramp to speed v the loss is c v^2 / 2, less the share that the threshold holds."""
    c, v = 0.1, 0.8
    pace = sim.MoveLimits(speed=v, acceleration=acceleration, pause=1.0)
    path = drive(CoulombSlip(c, above=0.5), sim.moves("line", [(4.0, 0.0)], pace)).true_path
    position, _ = errors(path, *rolled(path))
    assert position[to_half_way(path, 2.0)] == pytest.approx(
        share * c * v**2 / 2, rel=0.05, abs=1e-3
    )


def test_slip_does_not_care_which_way_is_forwards() -> None:
    c, v = 0.02, 0.8
    pace = sim.MoveLimits(speed=v, acceleration=1.0, pause=1.0)
    path = drive(LongitudinalSlip(c), sim.moves("line", [(-3.0, 0.0)], pace)).true_path
    reach = np.hypot(path.x_m - path.x_m[0], path.y_m - path.y_m[0])
    left, _ = rolled(path)
    half_way = to_half_way(path, 1.5)
    behind = left[0] - left[half_way] - reach[half_way]
    assert behind == pytest.approx(c * v**2 / 2, rel=0.02)


def test_curves_are_wider_by_the_lateral_creep() -> None:
    creep = 0.01
    path = drive(LateralSlip(creep), sim.figure_eight(0.8)).true_path
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
    path = drive(odd, sim.spin(2.0)).true_path
    assert turned(path) == pytest.approx(4 * math.pi / 1.03, rel=1e-4)
    path = drive(odd, sim.moves("arc", [(math.pi, 1.0)])).true_path  # sharpness: base/2 over radius
    expected = 1.0 / (1 + 0.03 * BASE / 2 / math.pi)
    assert turned(path) == pytest.approx(expected, rel=1e-4)


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_the_base_is_wider_in_left_turns(sense: float) -> None:
    path = drive(TurnDependentTrack(0.03, "sense"), sim.spin(2.0 * sense)).true_path
    assert turned(path) == pytest.approx(sense * 4 * math.pi / (1 + 0.03 * sense), rel=2e-4)


@pytest.mark.parametrize(("alternating", "kicks"), [(False, 3.0), (True, -1.0)])
def test_a_castor_kicks_at_reversals_alone(alternating: bool, kicks: float) -> None:
    """Two laps of out and back hold three reversals: back, forth and back again."""
    odd = CastorKick(0.02, alternating)
    path = drive(odd, sim.out_and_back(1.0, laps=2)).true_path
    assert turned(path) == pytest.approx(0.02 * kicks, rel=1e-3)
    path = drive(odd, sim.start_stop(3, laps=1)).true_path
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
    start = sim.AxlePose(0.3, 0.1, 0.0)
    path = sim.record(sim.TrueRobot(), CALM, seed=1, start=start, hidden=[odd]).true_path
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
