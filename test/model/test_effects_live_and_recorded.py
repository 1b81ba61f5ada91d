# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Effects act alike live and recorded; a change of values in mid-drive forgets nothing."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from test.model.drives import ROBOT, Ticks, read
from werrimbi_odom.effects import LIBRARY, find
from werrimbi_odom.errors import InputError
from werrimbi_odom.model.effect import Effect, Parameter
from werrimbi_odom.model.motion import WheelTravel
from werrimbi_odom.model.odometer import Estimate, Odometer
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.model.trajectory import Trajectory, trajectory

TYPICAL = {
    effect.name: effect.using(
        **{
            name: item.tries[0] if item.tries else item.typical
            for name, item in effect.parameters.items()
        }
    )
    for effect in LIBRARY
    if not effect.lacks(())
}
"""Those that the counters alone can run; for the others see the channels below."""
TOGETHER = (
    "wheels_swapped",
    "right_missed_ticks",
    "eccentric_right_wheel",
    "left_backlash",
    "radius_drift",
    "turn_dependent_track",
    "castor_kick",
    "lateral_slip",
    "floor_slope",
    "reference_lever_arm",
)


def drive(seed: int = 4) -> Ticks:
    """Reversals, stops and turns; counters that start anywhere, as on any robot."""
    chance = np.random.default_rng(seed)
    speed, yaw_rate = (
        np.repeat(chance.uniform(-top, top, 20) * (chance.random(20) > 0.15), 20)
        for top in (0.6, 1.5)
    )
    ticks = read(ROBOT, 20.0, speed[:-1], yaw_rate[:-1])
    return Ticks(ticks.time, ticks.left + 12_345, ticks.right - 777)


def estimates(odometer: Odometer, ticks: Ticks) -> list[Estimate]:
    rows = zip(*(column.tolist() for column in ticks), strict=True)
    return [estimate for row in rows if (estimate := odometer.update(*row)) is not None]


def assert_alike(live: list[Estimate], recorded: Trajectory) -> None:
    poses = np.array([estimate.pose for estimate in live])
    path = np.stack([recorded.x, recorded.y, recorded.yaw], axis=-1)[1:]
    np.testing.assert_allclose(poses, path, rtol=0.0, atol=1e-9)
    covariance = np.array([estimate.covariance for estimate in live])
    np.testing.assert_allclose(
        covariance, np.stack(recorded.covariance, axis=-1)[1:], rtol=1e-9, atol=1e-15
    )


@pytest.mark.parametrize("effects", [*((name,) for name in TYPICAL), TOGETHER], ids="+".join)
def test_live_and_recorded_agree(effects: tuple[str, ...]) -> None:
    robot = replace(ROBOT, effects=tuple(TYPICAL[name] for name in effects))
    assert_alike(estimates(Odometer(robot), drive()), trajectory(robot, *drive()))


@pytest.mark.parametrize("effects", [*((name,) for name in TYPICAL), TOGETHER], ids="+".join)
def test_a_driver_that_sends_several_at_once_throws_no_robot(effects: tuple[str, ...]) -> None:
    """Once two messages 20 microseconds apart, and once a queue of them: as the even drive."""
    robot = replace(ROBOT, effects=tuple(TYPICAL[name] for name in effects))
    even = drive()
    time = even.time.copy()
    time[100] = time[101] - 2e-5
    time[200:230] = time[230] - 2e-5 * np.arange(30, 0, -1)
    burst = even._replace(time=time)
    live, recorded = estimates(Odometer(robot), burst), trajectory(robot, *burst)
    assert_alike(live, recorded)
    away = np.subtract(live[-1].pose, estimates(Odometer(robot), even)[-1].pose)
    assert np.abs(away).max() < 0.02


@pytest.mark.parametrize("name", TYPICAL)
def test_a_record_of_one_row_has_its_start_alone(name: str) -> None:
    one = Ticks(*(column[:1] for column in drive()))
    found = trajectory(replace(ROBOT, effects=(TYPICAL[name],)), *one)
    assert (found.x.size, found.x[0]) == (1, 0.0)


@pytest.mark.parametrize(
    "name", [e.effect.name for e in TYPICAL.values() if e.effect.stage in ("wheels", "body")]
)
def test_every_effect_moves_the_robot_elsewhere(name: str) -> None:
    """Else the test above would say nothing."""
    plain, with_it = (
        trajectory(replace(ROBOT, effects=effects), *drive()) for effects in ((), (TYPICAL[name],))
    )
    end = [np.array([path.x[-1], path.y[-1], path.yaw[-1]]) for path in (plain, with_it)]
    assert np.abs(end[0] - end[1]).max() > 1e-6


@pytest.mark.parametrize("name", [e.name for e in LIBRARY if e.stage == "reference"])
def test_what_the_measurement_does_never_moves_the_robot(name: str) -> None:
    plain, with_it = (
        trajectory(replace(ROBOT, effects=effects), *drive()) for effects in ((), (TYPICAL[name],))
    )
    assert (plain.x == with_it.x).all()
    assert (plain.yaw == with_it.yaw).all()


# ------------------------------------------------------------------------ what is unknown


@pytest.mark.parametrize("side", ["left", "right"])
def test_an_effect_with_an_unknown_phase_is_left_out(side: str) -> None:
    unknown = find(f"eccentric_{side}_wheel").using(amplitude=2e-3)
    robot = replace(ROBOT, effects=(unknown,))
    path, plain = trajectory(robot, *drive()), trajectory(ROBOT, *drive())
    np.testing.assert_array_equal(path.x, plain.x)
    assert_alike(estimates(Odometer(robot), drive()), plain)


def test_the_wrong_phase_doubles_the_error_that_it_is_for() -> None:
    """Why an effect with an unknown phase is left out, and not run with any."""
    wheel = find("eccentric_left_wheel")
    true, wrong = (
        trajectory(replace(ROBOT, effects=(wheel.using(amplitude=2e-3, phase=p),)), *drive())
        for p in (0.5, 0.5 - np.pi)
    )
    plain = trajectory(ROBOT, *drive())
    off, off_wrong = (np.abs(each.yaw - true.yaw).max() for each in (plain, wrong))
    assert off_wrong == pytest.approx(2.0 * off, rel=0.05)


# ------------------------------------------------------------------------ retuning


def all_effects(order: str = "first") -> Robot:
    effects = tuple(TYPICAL[name] for name in TOGETHER)
    return replace(ROBOT, effects=effects, covariance_order=order)  # type: ignore[arg-type]


@pytest.mark.parametrize("order", ["first", "exact"])
def test_a_change_to_the_same_values_changes_nothing(order: str) -> None:
    robot = all_effects(order)
    left_alone, retuned = Odometer(robot), Odometer(robot)
    for row, message in enumerate(zip(*(column.tolist() for column in drive()), strict=True)):
        one, other = left_alone.update(*message), retuned.update(*message)
        if row % 7 == 0:
            assert retuned.retune(all_effects(order)) is None
        if one is not None and other is not None:
            np.testing.assert_allclose(other.pose, one.pose, rtol=0.0, atol=1e-12)
            np.testing.assert_allclose(other.covariance, one.covariance, rtol=1e-12, atol=0.0)
            assert other.mean_shift == one.mean_shift
    assert retuned.tally == left_alone.tally
    assert retuned.distance == left_alone.distance


def test_a_change_of_an_effect_keeps_what_the_others_remember() -> None:
    """Wheel angles, travel since reversal and distance go on; so does the open piece."""
    before = all_effects()
    slip = TYPICAL["lateral_slip"].learnt(creep=0.02)
    after = replace(
        before, effects=tuple(slip if e.name == slip.name else e for e in before.effects)
    )
    first, second = Ticks(*(c[:200] for c in drive())), Ticks(*(c[200:] for c in drive()))
    odometer, whole = Odometer(before), trajectory(after, *drive())
    estimates(odometer, first)
    assert odometer.retune(after) is None
    turns = np.diff([estimate.pose.yaw for estimate in estimates(odometer, second)])
    np.testing.assert_allclose(turns, np.diff(whole.yaw[200:]), rtol=0.0, atol=1e-12)


def test_a_change_of_noise_ends_the_piece_and_leaves_its_covariance() -> None:
    odometer = Odometer(all_effects())
    last = estimates(odometer, drive())[-1]
    piece = odometer.retune(replace(all_effects(), left_wheel_noise=1.0))
    assert piece is not None
    np.testing.assert_allclose(odometer.covariance(), last.covariance, rtol=1e-12)
    assert odometer.piece.length == 0.0


def test_an_effect_that_is_learnt_knows_where_the_wheels_are() -> None:
    wheel = find("eccentric_left_wheel")
    unknown = replace(ROBOT, effects=(wheel.using(amplitude=2e-3),))
    known = replace(ROBOT, effects=(wheel.using(amplitude=2e-3, phase=0.5),))
    for first_robot in (unknown, ROBOT):
        odometer = Odometer(first_robot)
        estimates(odometer, Ticks(*(c[:200] for c in drive())))
        odometer.retune(known)
        live = estimates(odometer, Ticks(*(c[200:] for c in drive())))
        turns = np.diff([estimate.pose.yaw for estimate in live])
        whole = np.diff(trajectory(known, *drive()).yaw[200:])
        np.testing.assert_allclose(turns, whole, rtol=0.0, atol=1e-12)


@pytest.mark.parametrize("change", [{"encoder_bits": 16}, {"left_ticks_per_revolution": 7.0}])
def test_what_counts_mean_cannot_change(change: dict[str, float]) -> None:
    with pytest.raises(ValueError, match="cannot change in a drive"):
        Odometer(ROBOT).retune(replace(ROBOT, **change))  # type: ignore[arg-type]


# ------------------------------------------------------------------------ channels


def _lighter(travel: WheelTravel, drive: object, loss: float) -> WheelTravel:
    share = 1.0 - loss * drive.channels["payload_kg"].mean  # type: ignore[attr-defined]
    return WheelTravel(travel.left * share, travel.right * share)


LADEN = Effect(
    "laden",
    "wheels",
    {"loss": Parameter("1/kg", 0.0, 2e-3, (0.0, 0.05), "loss of radius per kilogram")},
    _lighter,
    "Tyres give way under a load.",
    channels=("payload_kg",),
)


OWN, OURS = LADEN.using(loss=2e-3), find("radius_by_channel").using(payload=-2e-3)
MISSING = {
    "laden": "needs the measured channel payload_kg, a column",
    "radius_by_channel": "channel whose name has one of temperature, payload in it, a column",
}


@pytest.fixture(params=[OWN, OURS], ids=MISSING)
def laden(request: pytest.FixtureRequest) -> Robot:
    return replace(ROBOT, effects=(request.param,))


def test_an_effect_sees_its_channel_live_and_recorded(laden: Robot) -> None:
    ticks = drive()
    payload = np.interp(ticks.time, [ticks.time[100], ticks.time[200]], [0.0, 20.0])
    recorded = trajectory(laden, *ticks, channels={"payload_kg": payload})
    odometer = Odometer(laden)
    live = []
    for row, kilograms in enumerate(payload.tolist()):
        message = (float(column[row]) for column in ticks)
        live.append(odometer.update(*message, channels={"payload_kg": kilograms}))
    assert_alike([estimate for estimate in live if estimate is not None], recorded)
    plain = trajectory(ROBOT, *ticks)
    step = np.hypot(np.diff(recorded.x)[-50:], np.diff(recorded.y)[-50:])
    np.testing.assert_allclose(
        step, 0.96 * np.hypot(np.diff(plain.x)[-50:], np.diff(plain.y)[-50:]), rtol=1e-4
    )


def test_a_message_without_its_channel_loses_no_travel(laden: Robot) -> None:
    """Its counts were taken and its travel was not, so one who went on was that much short."""
    odometer = Odometer(laden)
    odometer.update(0.0, 0.0, 0.0)
    for channels in ({}, {"payload_kg": math.nan}):
        with pytest.raises(InputError, match="needs the measured channel"):
            odometer.update(0.1, 100.0, 100.0, channels)
    estimate = odometer.update(0.2, 200.0, 200.0, {"payload_kg": 0.0})
    assert estimate is not None
    assert estimate.pose.x == pytest.approx(200.0 * laden.left_tick)
    assert odometer.tally.accepted == 2


def test_a_gap_in_a_channel_is_interpolated(laden: Robot) -> None:
    ticks = drive()
    payload = np.linspace(0.0, 20.0, ticks.time.size)
    gaps = np.where(np.arange(payload.size) % 5 == 0, payload, np.nan)
    full, holed = (trajectory(laden, *ticks, channels={"payload_kg": p}) for p in (payload, gaps))
    np.testing.assert_allclose(holed.x, full.x, atol=1e-3)
    assert np.isfinite(holed.x).all()


def test_a_gap_in_a_channel_is_interpolated_where_the_clock_was_set_back(laden: Robot) -> None:
    """The robot carries what it was measured to, whatever time its computer thinks it is."""
    ticks = drive()
    payload = np.linspace(0.0, 20.0, ticks.time.size)
    payload[300:350:7] = np.nan
    set_back = Ticks(np.where(np.arange(400) < 200, ticks.time, ticks.time - 15.0), *ticks[1:])
    alike, other = (
        trajectory(laden, *each, channels={"payload_kg": payload}) for each in (ticks, set_back)
    )
    np.testing.assert_allclose(other.x, alike.x, atol=1e-6)
    np.testing.assert_allclose(other.y, alike.y, atol=1e-6)


@pytest.mark.parametrize("channels", [{}, {"payload_kg": np.full(400, np.nan)}])
def test_a_channel_that_was_not_measured_is_an_error(
    laden: Robot, channels: dict[str, np.ndarray]
) -> None:
    missing = MISSING[laden.effects[0].name]
    with pytest.raises(InputError, match=missing):
        trajectory(laden, *drive(), channels=channels)
    with pytest.raises(InputError, match=missing):
        estimates(Odometer(laden), drive())
