# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Twins are one and the same on every drive; whoever is not declared a twin shows on some drive."""

from __future__ import annotations

import math

import numpy as np
import pytest

from test.effects.tracks import TRACK, gone, line, plan, relative, shown, track, turn, wheels_of
from werrimbi_odom.effects import LIBRARY, find
from werrimbi_odom.effects.contract.sample_drive import Rehearsal
from werrimbi_odom.model.drive import Span
from werrimbi_odom.model.effect import AppliedEffect, Effect, wiring_of
from werrimbi_odom.model.motion import WheelTravel
from werrimbi_odom.model.pose import Floats

HARD = Rehearsal.of(("hub_temperature_c", "payload_kg"))
END = float(HARD.duration.sum())


def measured(*effects: AppliedEffect, every: float = 0.25) -> Floats:
    """Relative poses that a reference shows of a drive with everything in it."""
    raw = WheelTravel(*wiring_of(effects).wheels(HARD.left, HARD.right))
    time = np.arange(1.0, END - 1.0, every)
    there = gone(HARD.duration, raw, effects, channels=HARD.measured)
    return relative(*shown(there, effects, time))


def test_a_crab_is_a_marker_mounted_askew() -> None:
    crab = measured(find("sideways_drift").using(angle=0.2))
    askew = measured(find("reference_yaw_offset").using(angle=-0.2))
    np.testing.assert_allclose(crab, askew, atol=1e-12)
    assert np.abs(crab - measured()).max() > 1e-2


def test_a_crab_is_a_marker_mounted_askew_whatever_else_acts() -> None:
    """A lever arm is then the same one, seen from the turned frame."""
    slip, base = find("lateral_slip").using(creep=0.02), find("track_width").using(multiplier=1.1)
    arm = 0.1 * np.exp(-0.2j)
    crab = measured(
        slip,
        base,
        find("sideways_drift").using(angle=0.2),
        find("reference_lever_arm").using(x=0.1),
    )
    askew = measured(
        slip,
        base,
        find("reference_yaw_offset").using(angle=-0.2),
        find("reference_lever_arm").using(x=arm.real, y=arm.imag),
    )
    np.testing.assert_allclose(crab, askew, atol=1e-12)


def test_exchanged_wheels_are_a_mirrored_reference() -> None:
    swapped = measured(find("wheels_swapped").using())
    mirrored = measured(find("reference_mirrored").using())
    np.testing.assert_allclose(swapped, mirrored, atol=1e-12)
    unequal = find("unequal_wheel_radii")
    np.testing.assert_allclose(
        measured(find("wheels_swapped").using(), unequal.using(ratio=1.02)),
        measured(find("reference_mirrored").using(), unequal.using(ratio=1 / 1.02)),
        atol=1e-12,
    )


def test_stern_first_is_half_a_turn_of_the_reference() -> None:
    mistakes = ("wheels_swapped", "left_wheel_reversed", "right_wheel_reversed")
    stern_first = measured(*(find(name).using() for name in mistakes))
    turned = measured(find("reference_yaw_offset").using(angle=math.pi))
    np.testing.assert_allclose(stern_first, turned, atol=1e-12)


def test_a_false_metre_is_larger_wheels_on_a_wider_base() -> None:
    larger = measured(
        find("wheel_radius_scale").using(multiplier=1.01),
        find("track_width").using(multiplier=1.01),
    )
    np.testing.assert_allclose(larger, measured() * [1.01, 1.01, 1.0], atol=1e-12)
    own = measured(find("reference_scale").using(multiplier=1.01))
    np.testing.assert_allclose(larger, own, atol=1e-12)


def test_a_skidding_robot_is_a_wider_base_and_another_point_measured() -> None:
    skid = find("skid_steer").using(multiplier=1.7, x=0.04, y=-0.03)
    base = find("track_width").using(multiplier=1.7)
    arm = find("reference_lever_arm").using(x=-0.04, y=0.03)
    np.testing.assert_allclose(measured(skid), measured(base, arm), atol=3e-5)  # within steps
    np.testing.assert_allclose(measured(skid)[:, 2], measured(base)[:, 2], atol=1e-12)


def test_with_yaw_alone_the_base_is_the_inverse_of_the_radii() -> None:
    base = measured(find("track_width").using(multiplier=1.02))[:, 2]
    radii = measured(find("wheel_radius_scale").using(multiplier=1 / 1.02))[:, 2]
    np.testing.assert_allclose(base, radii, atol=1e-12)


@pytest.mark.parametrize(
    "name",
    [
        "sideways_drift",
        "floor_slope",
        "lateral_slip",
        "reference_lever_arm",
        "reference_yaw_offset",
    ],
)
def test_with_yaw_alone_these_do_not_show(name: str) -> None:
    effect = find(name)
    typical = effect.using(**{key: item.typical for key, item in effect.parameters.items()})
    np.testing.assert_allclose(measured(typical)[:, 2], measured()[:, 2], atol=1e-12)


# -- everybody else ---------------------------------------------------------------------------

CONTINUOUS = [
    effect
    for effect in LIBRARY
    if not effect.is_mistake and effect.name != "reference_scale"  # base and radii together
]
NOISE = np.array([1e-3, 1e-3, 2e-3])
"""Of a good reference [m, m, rad]: in its units two effects are alike, or not."""
CALIBRATION = ("track_width", "unequal_wheel_radii", "wheel_radius_scale")


def sensitivities(effect: Effect) -> Floats:
    """Change of all that is measured per parameter, at null; columns of length 1."""
    shapes = {name: item.typical for name, item in effect.parameters.items() if item.tries}
    start = effect.to_fit({**effect.nulls, **shapes})
    columns = []
    for name in start:
        if name in shapes or (name in effect.parameters and effect.parameters[name].as_base):
            continue
        item = effect.parameters.get(name) or effect.parameters[effect.quadrature[0]]  # type: ignore[index]
        step = 0.1 * item.scale
        ahead, behind = (
            AppliedEffect(effect, effect.from_fit({**start, name: start[name] + sign * step}))
            for sign in (1.0, -1.0)
        )
        columns.append(((measured(ahead) - measured(behind)) / NOISE).ravel())
    table = np.array(columns).T
    return np.asarray(table / np.linalg.norm(table, axis=0))


def test_no_other_pair_is_alike_on_a_drive_with_everything_in_it() -> None:
    """Even after recalibration: so what is declared above is all that algebra must be asked for."""
    table = {effect.name: sensitivities(effect) for effect in CONTINUOUS}
    known, _ = np.linalg.qr(np.hstack([table[name] for name in CALIBRATION]))
    rest = {
        name: np.linalg.qr(columns - known @ (known.T @ columns))[0]
        for name, columns in table.items()
        if name not in CALIBRATION
    }
    alike = {
        frozenset((one, other))
        for one, a in rest.items()
        for other, b in rest.items()
        if one < other and np.linalg.svd(a.T @ b, compute_uv=False)[0] > 0.99
    }
    declared = {frozenset((effect.name, twin)) for effect in CONTINUOUS for twin in effect.twins}
    nested = {frozenset((effect.name, effect.extends)) for effect in CONTINUOUS if effect.extends}
    assert alike == declared | nested


# -- what the pages say under "Alike" ---------------------------------------------------------


def end_of(effects: tuple[AppliedEffect, ...], speed: float) -> Floats:
    """Relative poses on a line at one speed, once it is reached."""
    gone_there = track(plan((0.5, speed, 0.0), (6.0, speed, 0.0)), *effects)
    return relative(*shown(gone_there, effects, np.array([0.2, 3.0, 4.0, 5.0])))


def test_on_lines_at_one_speed_a_delay_is_a_lever_arm() -> None:
    delay = find("reference_delay").using(delay=0.05)
    arm = find("reference_lever_arm").using(x=-0.05 * 0.4)
    late = end_of((delay,), 0.4) - end_of((), 0.4)
    assert late[0, 0] == pytest.approx(-0.05 * 0.4)
    np.testing.assert_allclose(late[1:], 0.0, atol=1e-12)
    np.testing.assert_allclose(end_of((arm,), 0.4), end_of((), 0.4), atol=1e-12)


def test_in_curves_at_one_speed_lateral_slip_is_a_lever_arm() -> None:
    way = plan((0.01, 0.5, 0.8), (3.0, 0.5, 0.8), (0.5, 0.5, -1.0), (3.0, 0.5, -1.0))
    times = np.linspace(1.0, 7.0, 20)

    def seen(*effects: AppliedEffect) -> Floats:
        return relative(*shown(track(way, *effects, rate=200.0), effects, times))

    creep = seen(find("lateral_slip").using(creep=0.02))
    arm = seen(find("reference_lever_arm").using(x=-0.02 * 0.5))
    np.testing.assert_allclose(creep, arm, atol=1e-4)
    assert np.abs(creep - seen()).max() > 2e-3


def test_a_reference_made_by_plain_euler_steps_creeps_by_half_its_interval() -> None:
    """Outwards: it goes straight on where the robot has begun to turn."""
    interval, speed, rate = 0.1, 0.5, 0.8
    turn = rate * interval
    euler = speed * interval * np.array([1.0, 0.0])  # a step as seen from where it began
    half = 0.5 * turn
    arc = speed * interval * np.sinc(half / np.pi) * np.array([np.cos(half), np.sin(half)])
    creep = (arc - euler)[1] / (speed * turn)
    assert creep == pytest.approx(interval / 2, rel=1e-3)


def test_play_of_one_wheel_is_no_castor() -> None:
    """Play turns by travel / base; it loses half the travel as well, and a castor does not."""
    way = plan(*line(1.0), *line(-1.0))
    play = track(way, find("left_backlash").using(travel=4e-3)).end
    assert play[2] == pytest.approx(-2e-3 / TRACK)


def test_forwards_alone_slip_is_load_that_moves_to_the_rear() -> None:
    slip = find("longitudinal_slip").using(coefficient=0.02)
    load = find("load_transfer").using(longitudinal=0.02)
    times = np.linspace(0.2, 6.0, 20)
    for sense, alike in ((1.0, True), (-1.0, False)):
        way = plan((0.5, 0.6 * sense, 0.0), (2.0, 0.2 * sense, 0.0), (3.0, 0.7 * sense, 0.0))
        one, other = (relative(*shown(track(way, law), (law,), times)) for law in (slip, load))
        assert np.allclose(one, other, atol=1e-12) == alike


def test_at_one_speed_a_squashed_tyre_is_a_smaller_one() -> None:
    squash = find("tyre_squash").using(coefficient=0.1)
    smaller = find("wheel_radius_scale").using(multiplier=1.0 - 0.1 * 0.4**2)
    np.testing.assert_allclose(end_of((squash,), 0.4)[1:], end_of((smaller,), 0.4)[1:], atol=1e-12)


def test_turning_at_one_rate_a_gyro_that_drifts_is_a_radius_that_does() -> None:
    """Of headings alone; a line, or a turn to the other side, tells them apart."""
    rate, spin = 1e-4, 0.8
    drift = find("reference_gyro_drift").using(rate=rate)
    radius = find("radius_drift").using(per_second=rate / spin)
    times = np.linspace(0.5, 11.0, 20)
    for way, alike in (((10.0, 0.0, spin),), True), (((5.0, 0.0, spin), (5.0, 0.0, -spin)), False):
        there = plan((0.001, 0.0, way[0][2]), *way)
        one, other = (
            relative(*shown(track(there, law, rate=200.0), (law,), times[times < 9.5]))[:, 2]
            for law in (drift, radius)
        )
        assert np.allclose(one, other, atol=5e-5) == alike


def test_an_axle_off_its_centre_does_nine_tenths_of_what_a_bump_does() -> None:
    """Their first harmonic: so a small bump is one to few drives; what is left tells them apart."""
    way = plan(*line(9.42), *line(-9.42))
    gone_there = track(way, rate=200.0)
    columns = [
        track(way, law, rate=200.0).left - gone_there.left
        for law in (
            find("left_tread_bump").using(height=1e-3, place=0.3),
            find("eccentric_left_wheel").using(amplitude=1e-3, phase=0.0),
            find("eccentric_left_wheel").using(amplitude=1e-3, phase=0.5 * math.pi),
            find("wheel_radius_scale").using(multiplier=1.001),
        )
    ]
    bump, *others = (column - column.mean() for column in columns)
    swings = np.stack(others, axis=-1)
    bump = bump - others[2] * (bump @ others[2]) / (others[2] @ others[2])
    left = bump - swings @ np.linalg.lstsq(swings, bump, rcond=None)[0]
    assert 1.0 - (left @ left) / (bump @ bump) == pytest.approx(0.8, abs=0.1)


def test_a_thermometer_that_rises_all_the_time_is_a_clock() -> None:
    duration, raw = wheels_of(plan(*line(3.0), *turn(2.0), *line(-2.0)), 50.0)
    time = np.concatenate([[0.0], np.cumsum(duration)])
    rising = {"hub_temperature_c": Span(20.0 + 0.1 * time[:-1], 20.0 + 0.1 * time[1:])}
    warm = gone(
        duration, raw, (find("radius_by_channel").using(temperature=1e-3),), channels=rising
    )
    drift = gone(duration, raw, (find("radius_drift").using(per_second=1e-4),))
    np.testing.assert_allclose(warm.x, drift.x, atol=1e-12)
    np.testing.assert_allclose(warm.yaw, drift.yaw, atol=1e-12)
