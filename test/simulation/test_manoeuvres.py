# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What is commanded: paths that close, and limits that hold."""

from __future__ import annotations

import math

import numpy as np
import pytest

from werrimbi_odom import simulation as sim

CLOSED = [sim.square(), sim.square(sense="cw"), sim.out_and_back(3.0),
          sim.out_and_back(3.0, turn_round=True),
          sim.spins(), sim.figure_eight(), sim.arcs(), sim.pivots(), sim.start_stop()]  # fmt: skip


def commanded_path(manoeuvre: sim.Manoeuvre) -> np.ndarray:
    step = 0.001
    times = np.arange(0.0, manoeuvre.duration + step, step)
    speed, yaw_rate = manoeuvre.commands(times)
    yaw = np.concatenate(([0.0], np.cumsum(yaw_rate * step)))
    chord = speed * step * np.sinc(yaw_rate * step / (2 * np.pi))
    heading = (yaw[1:] + yaw[:-1]) / 2
    xy = np.cumsum(np.column_stack((chord * np.cos(heading), chord * np.sin(heading))), axis=0)
    return np.column_stack((np.vstack(([0.0, 0.0], xy)), yaw))


@pytest.mark.parametrize("manoeuvre", CLOSED, ids=lambda m: m.name)
def test_closed_manoeuvres_come_home(manoeuvre: sim.Manoeuvre) -> None:
    x, y, yaw = commanded_path(manoeuvre)[-1]
    assert math.hypot(x, y) < 1e-4
    assert math.remainder(yaw, 2 * math.pi) == pytest.approx(0.0, abs=1e-9)


def test_a_square_has_its_corners_where_they_belong() -> None:
    path = commanded_path(sim.square(2.0, "cw"))
    assert path[:, 0].max() == pytest.approx(2.0, abs=1e-6)
    assert path[:, 1].min() == pytest.approx(-2.0, abs=1e-6)


@pytest.mark.parametrize("step", [0.005, 0.0173, 0.4])
def test_commands_keep_the_way_on_any_time_grid(step: float) -> None:
    manoeuvre = sim.moves("one", [(1.0, 0.5)])
    times = np.arange(-1.0, manoeuvre.duration + 1.0 + step, step)
    speed, yaw_rate = manoeuvre.commands(times)
    assert speed.sum() * step == pytest.approx(1.0, abs=1e-12)
    assert yaw_rate.sum() * step == pytest.approx(0.5, abs=1e-12)


@pytest.mark.parametrize("step", [(0.05, 0.0), (5.0, 0.0), (0.0, 3.0), (2.0, -4.0)])
def test_a_move_keeps_to_its_pace_and_reaches_it(step: tuple[float, float]) -> None:
    pace = sim.MoveLimits()
    knots = np.array(sim.moves("one", [step], pace).knots)
    t, speed, yaw_rate = knots[np.diff(knots[:, 0], prepend=-1) > 0].T
    used = [
        np.abs(speed).max() / pace.speed,
        np.abs(yaw_rate).max() / pace.yaw_rate,
        np.abs(np.diff(speed) / np.diff(t)).max() / pace.acceleration,
        np.abs(np.diff(yaw_rate) / np.diff(t)).max() / pace.yaw_acceleration,
    ]
    assert max(used) == pytest.approx(1.0)


def test_a_step_of_no_length_and_no_turn_is_a_rest() -> None:
    """Its times were no numbers, and so were those of all moves after it."""
    still, on = (0.0, 0.0), (1.0, 0.0)
    rest = sim.MoveLimits().pause
    times = [sim.moves("some", steps).knots[-1][0] for steps in ([on, on], [on, still, on])]
    assert times[1] == pytest.approx(times[0] + rest)
    assert commanded_path(sim.spin(0.0))[-1].tolist() == [0.0, 0.0, 0.0]


def test_spin_turns_on_the_spot() -> None:
    path = commanded_path(sim.spin(-2.0))
    assert np.abs(path[:, :2]).max() == 0.0
    assert path[-1, 2] == pytest.approx(-4 * math.pi)


def test_free_driving_differs_by_its_seed_alone() -> None:
    assert sim.free(seed=1) == sim.free(seed=1)
    assert sim.free(seed=1) != sim.free(seed=2)


def test_free_driving_goes_every_way() -> None:
    speed, yaw_rate = sim.free(120.0, seed=3).commands(np.arange(0.0, 120.0, 0.01))
    assert (speed < -0.05).mean() > 0.05
    assert (speed > 0.05).mean() > 0.4
    assert (yaw_rate > 0.1).mean() > 0.2
    assert (yaw_rate < -0.1).mean() > 0.2


def test_a_chain_is_its_parts_in_turn() -> None:
    both = sim.chain("both", sim.spin(1.0), sim.square(1.0))
    assert both.duration == pytest.approx(sim.spin(1.0).duration + sim.square(1.0).duration)
    assert math.hypot(*commanded_path(both)[-1, :2]) < 1e-4


def test_a_step_of_the_command_is_allowed() -> None:
    manoeuvre = sim.Manoeuvre("step", ((0.0, 0.0, 0.0), (0.0, 1.0, 0.0), (2.0, 1.0, 0.0)))
    speed, _ = manoeuvre.commands(np.array([-1.0, 0.0, 1.0, 2.0, 3.0]))
    np.testing.assert_allclose(speed, [0.0, 1.0, 1.0, 0.0])
