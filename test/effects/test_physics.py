# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Each law says what physics says, and each ruler check gives the number that its page promises."""

from __future__ import annotations

import math

import numpy as np
import pytest

from test.effects.tracks import RADIUS, REST, TRACK, Plan, line, plan, track, turn
from werrimbi_odom.effects import find
from werrimbi_odom.effects.contract.sample_drive import Rehearsal
from werrimbi_odom.model.effect import view_of, wiring_of
from werrimbi_odom.model.reference_measurement import shown
from werrimbi_odom.model.reference_view import View
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.model.trajectory import Trajectory, trajectory
from werrimbi_odom.model.wiring import Wiring

TO_AND_FRO = plan(*line(1.0), *line(-1.0), *line(1.0), *line(-1.0))


def circle(speed: float, radius: float, angle: float) -> Plan:
    """Begun in full motion: what comes before it is not of interest."""
    time = radius * angle / speed
    return Plan(np.array([0.0, time]), np.full(2, speed), np.full(2, speed / radius))


# -- geometry ---------------------------------------------------------------------------------


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_ten_turns_fall_short_by_the_wider_base(sense: float) -> None:
    end = track(plan(*turn(sense * 20 * math.pi)), find("track_width").using(multiplier=1.001))
    missing = 20 * math.pi - sense * end.end[2]
    assert missing == pytest.approx(20 * math.pi * 0.001, rel=2e-3)


@pytest.mark.parametrize("multiplier", [1.3, 1.7, 2.4])
def test_ten_turns_of_a_skidding_robot_fall_short_exactly(multiplier: float) -> None:
    law = find("skid_steer").using(multiplier=multiplier)
    missing = 20 * math.pi - track(plan(*turn(20 * math.pi)), law).end[2]
    assert missing == pytest.approx(20 * math.pi * (1 - 1 / multiplier), rel=1e-9)


def test_a_skidding_robot_spins_about_its_own_point() -> None:
    """The point of the body that lies x ahead and y left stays over one place of the floor."""
    x, y = 0.04, -0.03
    law = find("skid_steer").using(multiplier=1.7, x=x, y=y)
    gone = track(plan(*turn(12.0)), law, rate=200.0)
    cos, sin = np.cos(gone.yaw), np.sin(gone.yaw)
    over_x, over_y = gone.x + cos * x - sin * y, gone.y + sin * x + cos * y
    assert np.ptp(over_x) < 1e-9
    assert np.ptp(over_y) < 1e-9
    assert np.ptp(gone.x) > 0.05
    assert track(plan(*line(5.0)), law).end == pytest.approx((5.0, 0.0, 0.0), abs=1e-12)


def test_a_larger_right_wheel_bends_the_way_to_the_left() -> None:
    end = track(plan(*line(10.0)), find("unequal_wheel_radii").using(ratio=1.001)).end
    assert 2 * TRACK * end[1] / 10.0**2 == pytest.approx(0.001, rel=1e-3)
    back = track(plan(*line(10.0), *line(-10.0)), find("unequal_wheel_radii").using(ratio=1.001))
    assert back.end == pytest.approx((0.0, 0.0, 0.0), abs=1e-9)


def test_larger_wheels_go_farther() -> None:
    end = track(plan(*line(5.0)), find("wheel_radius_scale").using(multiplier=1.02)).end
    assert end[0] / 5.0 == pytest.approx(1.02)


def test_a_spin_in_another_base_than_a_wide_curve() -> None:
    law = find("turn_dependent_track").using(sharpness=0.01)
    spin = 20 * math.pi - track(plan(*turn(20 * math.pi)), law).end[2]
    curve = 20 * math.pi - track(circle(0.5, 2.0, 20 * math.pi), law).end[2]
    assert spin == pytest.approx(20 * math.pi * 0.01, rel=0.02)
    assert spin - curve == pytest.approx(20 * math.pi * 0.01, rel=0.1)


def test_left_turns_in_another_base_than_right_ones() -> None:
    law = find("turn_dependent_track").using(sense=0.01)
    left = 20 * math.pi - track(plan(*turn(20 * math.pi)), law).end[2]
    right = 20 * math.pi + track(plan(*turn(-20 * math.pi)), law).end[2]
    assert left - right == pytest.approx(40 * math.pi * 0.01, rel=1e-3)
    assert track(plan(*line(5.0)), law).end == pytest.approx((5.0, 0.0, 0.0), abs=1e-9)


def test_radii_drift_from_the_beginning_to_the_end() -> None:
    by_way = track(plan(*line(10.0)), find("radius_drift").using(per_metre=1e-3)).end[0]
    assert by_way == pytest.approx(10.0 + 1e-3 * 10.0**2 / 2, rel=1e-9)
    waited = plan((100.0, 0.0, 0.0), *line(10.0))  # half of the way is done after 110.75 s
    law = find("radius_drift").using(per_second=1e-4)
    assert track(waited, law).end[0] == pytest.approx(10.0 * (1 + 1e-4 * 110.75), rel=1e-6)
    assert track(plan(*turn(9.0)), find("radius_drift").using(per_metre=1e-3)).end[2] == (
        pytest.approx(9.0)
    )


def test_no_radius_drifts_by_more_than_tyres_do() -> None:
    """Of a rate that makes 13 % of 20 m a base that is 14 % too wide is hidden by such a drift."""
    for parameter, drive in (("per_metre", 20.0), ("per_second", 60.0)):
        low, high = find("radius_drift").parameters[parameter].bounds
        assert -0.1 <= low * drive < -0.03
        assert 0.03 < high * drive <= 0.1


# -- eccentric wheels -------------------------------------------------------------------------


@pytest.mark.parametrize("side", ["left", "right"])
def test_an_eccentric_wheel_errs_nothing_over_whole_turns(side: str) -> None:
    law = find(f"eccentric_{side}_wheel").using(amplitude=1e-3, phase=0.4)
    once = 2 * math.pi * RADIUS
    for turns in (1, 2, 7):
        end = track(plan(*line(turns * once, 0.1)), law)
        assert getattr(end, side)[-1] == pytest.approx(turns * once, abs=1e-12)
    half = getattr(track(plan(*line(once / 2, 0.1)), law), side)[-1] - once / 2
    assert half == pytest.approx(2e-3 * math.cos(0.4))


def test_at_counter_zero_and_phase_zero_the_centre_is_ahead_and_going_down() -> None:
    """Rolling on, the axle stands above the centre: it gains until it is ahead by a half turn."""
    law = find("eccentric_left_wheel").using(amplitude=1e-3, phase=0.0)
    for turned, gained in [(math.pi / 2, 1e-3), (math.pi, 2e-3), (3 * math.pi / 2, 1e-3)]:
        way = track(plan(*line(turned * RADIUS, 0.05)), law).left[-1]
        assert way - turned * RADIUS == pytest.approx(gained)


def test_the_phase_belongs_to_the_counter() -> None:
    way = plan(*line(0.1, 0.1))
    turned = 0.7 / (2 * math.pi) * 2000.0
    one = track(way, find("eccentric_left_wheel").using(amplitude=1e-3, phase=0.7)).left
    other = track(
        way,
        find("eccentric_left_wheel").using(amplitude=1e-3, phase=0.0),
        first_counts=(turned, 0.0),
    ).left
    np.testing.assert_allclose(one, other, atol=1e-12)


@pytest.mark.parametrize("rate", [3.0, 10.0, 200.0])
def test_results_do_not_depend_on_the_logging_rate(rate: float) -> None:
    """An eccentric wheel turns half round in a step at 3 Hz, and nothing is lost."""
    way = plan(*line(2.0, 0.5), *turn(2.0), *line(-1.0, 0.3))
    law = find("eccentric_left_wheel").using(amplitude=1e-3, phase=0.4)
    assert track(way, law, rate=rate).left[-1] == pytest.approx(
        track(way, law, rate=50.0).left[-1], abs=1e-9
    )


# -- tyres ------------------------------------------------------------------------------------


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_slip_is_behind_at_speed_and_not_at_rest(sense: float) -> None:
    c, v = 0.02, 0.8
    law = find("longitudinal_slip").using(coefficient=c)
    gone = track(plan(*line(sense * 4.0, v)), law, rate=200.0)
    plain = track(plan(*line(sense * 4.0, v)), rate=200.0)
    assert sense * (plain.at(3.0)[0] - gone.at(3.0)[0]) == pytest.approx(c * v**2 / 2)
    assert gone.end[0] == pytest.approx(plain.end[0], abs=1e-9)


@pytest.mark.parametrize("rate", [50.0, 200.0])
def test_friction_gives_way_in_hard_starts_alone(rate: float) -> None:
    c, above, v = 0.1, 0.5, 0.8
    law = find("coulomb_slip").using(coefficient=c, above=above)
    for speed, share in ((0.15, 0.0), (v, 1.0 - above / (v / 0.5))):
        way = plan(*line(4.0, speed))
        behind = track(way, rate=rate).at(3.0)[0] - track(way, law, rate=rate).at(3.0)[0]
        assert behind == pytest.approx(share * c * v**2 / 2, rel=0.05, abs=1e-4)


@pytest.mark.parametrize("turning", [0.0, 0.4, 1.0])
@pytest.mark.parametrize(("name", "above"), [("longitudinal_slip", 0.0), ("coulomb_slip", 0.1)])
def test_a_start_of_a_turn_slips_by_the_moment_of_inertia_alone(
    name: str, above: float, turning: float
) -> None:
    c, turned, u = 0.1, 2.0, TRACK
    shape = {"above": above} if above else {}
    law = find(name).using(coefficient=c, turning=turning, **shape)
    way = plan(*turn(6.0, turned))
    behind = track(way, rate=200.0).at(2.0)[2] - track(way, law, rate=200.0).at(2.0)[2]
    share = max(turning - above / (u / 0.5), 0.0)
    assert behind == pytest.approx(2.0 * share * c * u**2 / 2 / TRACK, rel=0.05, abs=1e-4)
    ahead = plan(*line(4.0, 0.8))
    usual = track(ahead, find(name).using(coefficient=c, **shape), rate=200.0)
    assert np.max(np.abs(track(ahead, law, rate=200.0).x - usual.x)) < 1e-12


def test_lateral_slip_vanishes_on_lines_and_spins() -> None:
    law = find("lateral_slip").using(creep=0.05)
    way = plan(*line(3.0), *turn(4.0), *line(-1.0))
    assert track(way, law).end == pytest.approx(track(way).end, abs=1e-12)


def test_fast_half_circles_end_farther_ahead_and_whole_ones_close() -> None:
    creep, slow, fast = 0.01, 0.2, 0.8
    law = find("lateral_slip").using(creep=creep)
    halves = [track(circle(v, 1.0, math.pi), law, rate=200.0).end for v in (slow, fast)]
    assert halves[1][0] - halves[0][0] == pytest.approx(2 * creep * (fast - slow), rel=1e-3)
    assert halves[1][1] == pytest.approx(2.0, abs=1e-6)
    whole = track(circle(fast, 1.0, 2 * math.pi), law, rate=200.0).end
    assert whole == pytest.approx((0.0, 0.0, 2 * math.pi), abs=1e-6)


@pytest.mark.parametrize("side", ["left", "right"])
def test_an_oval_wheel_swings_twice_a_turn_by_half_its_amplitude(side: str) -> None:
    """Largest at zero: most is gained an eighth of a turn on, and all given back at a quarter.

    An ellipse is longer round than the circle of its mean radius, by a quarter of its ovality's
    square.
    """
    law = find(f"oval_{side}_wheel").using(amplitude=2e-3, phase=0.0)
    there, plain = track(plan(*line(5.0)), law, rate=500.0), track(plan(*line(5.0)), rate=500.0)
    gained = getattr(there, side) - getattr(plain, side)
    turned = getattr(plain, side) / RADIUS
    for angle, lead in ((math.pi / 4, 1e-3), (math.pi / 2, 0.0), (3 * math.pi / 4, -1e-3)):
        for halves in (0, 3):
            at = angle + halves * math.pi
            longer = at * RADIUS * (2e-3 / RADIUS) ** 2 / 4.0
            assert np.interp(at, turned, gained) == pytest.approx(lead + longer, abs=2e-5)


@pytest.mark.parametrize("side", ["left", "right"])
def test_an_oval_wheel_stands_still_in_the_play_of_its_backlash(side: str) -> None:
    """What rounding leaves of the travel there was taken for the travel of a tiny wheel."""
    drive = Rehearsal.of().split((0.2, 0.5, 0.3))
    play = find(f"{side}_backlash").using(travel=4e-3)
    oval = find(f"oval_{side}_wheel").using(amplitude=1e-3, phase=0.3)
    left = play.effect.apply(drive.travel, drive.drive, **play.values)
    after = oval.effect.apply(left, drive.drive, **oval.values)
    change, counted = (getattr(each, side) for each in (after, drive.travel))
    assert np.all(np.abs(change - getattr(left, side)) <= 1.3e-3 * np.abs(counted) / RADIUS + 1e-12)


@pytest.mark.parametrize("height", [2e-3, -2e-3])
@pytest.mark.parametrize("side", ["left", "right"])
def test_a_bump_is_gained_on_a_sixth_of_each_turn_and_nowhere_else(
    side: str, height: float
) -> None:
    """Stood on at a third of a turn: place says how far it has gone on since, at counter zero."""
    law = find(f"{side}_tread_bump").using(height=height, place=-2 * math.pi / 3)
    there, plain = track(plan(*line(5.0)), law, rate=500.0), track(plan(*line(5.0)), rate=500.0)
    gained = getattr(there, side) - getattr(plain, side)
    turned = getattr(plain, side) / RADIUS
    sixth = math.pi / 3
    for angle, share in ((0.0, 0.0), (1.5 * sixth, 0.0), (2 * sixth, 0.5), (2.5 * sixth, 1.0)):
        assert np.interp(angle, turned, gained) == pytest.approx(share * height * sixth, abs=3e-5)
        later = np.interp(angle + 6 * math.pi, turned, gained)
        assert later == pytest.approx((3.0 + share) * height * sixth, abs=3e-5)
    other = "right" if side == "left" else "left"
    np.testing.assert_array_equal(getattr(there, other), getattr(plain, other))


def test_the_lever_of_a_bump_goes_back_over_the_same_places() -> None:
    law = find("left_tread_bump").using(height=2e-3, place=0.4)
    there = track(plan(*line(1.3), *line(-1.3)), law)
    assert there.end == pytest.approx((0.0, 0.0, 0.0), abs=1e-4)


@pytest.mark.parametrize("coefficient", [0.02, -0.02])
def test_a_fast_drive_ends_short_by_the_squash(coefficient: float) -> None:
    law = find("tyre_squash").using(coefficient=coefficient)
    for way in (10.0, -10.0):
        slow, fast = (
            track(Plan(np.array([0.0, 10.0 / v]), np.full(2, way * v / 10.0), np.zeros(2)), law)
            for v in (0.1, 0.7)
        )
        short = abs(slow.end[0]) - abs(fast.end[0])
        assert short == pytest.approx(10.0 * coefficient * (0.7**2 - 0.1**2), rel=1e-6)


def test_ten_fast_laps_turn_less_by_the_load_that_moved() -> None:
    lateral, laps = 0.01, 20 * math.pi
    law = find("load_transfer").using(lateral=lateral)
    crawl, fast = (track(circle(v, 1.0, laps), law).end[2] for v in (0.1, 0.8))
    turned = laps * 2 * lateral * (0.8**2 - 0.1**2) / TRACK
    assert crawl - fast == pytest.approx(turned, rel=1e-3)
    assert track(plan(*turn(4.0)), law).end[2] == pytest.approx(4.0, abs=1e-9)


def test_what_a_start_costs_forwards_it_gives_backwards() -> None:
    """Unlike slip, which costs way both ways: the load goes to the rear wherever the robot goes."""
    load, slip = (
        find("load_transfer").using(longitudinal=0.02),
        find("longitudinal_slip").using(coefficient=0.02),
    )
    for way, law, gained in (
        (1.0, load, -1.0),
        (1.0, slip, -1.0),
        (-1.0, load, 1.0),
        (-1.0, slip, -1.0),
    ):
        there = track(plan(*line(3.0 * way, 0.6)), law).at(3.0)[0]
        plain = track(plan(*line(3.0 * way, 0.6))).at(3.0)[0]
        assert abs(there) - abs(plain) == pytest.approx(gained * 0.02 * 0.6**2 / 2, rel=1e-6)


# -- body and floor ---------------------------------------------------------------------------


def test_a_crab_travels_at_an_angle_to_where_it_looks() -> None:
    law = find("sideways_drift").using(angle=0.1)
    assert track(plan(*line(5.0)), law).end == pytest.approx(
        (5.0 * math.cos(0.1), 5.0 * math.sin(0.1), 0.0)
    )
    assert track(plan(*line(5.0), *line(-5.0)), law).end == pytest.approx((0, 0, 0), abs=1e-9)
    assert track(plan(*turn(5.0)), law).end == pytest.approx((0.0, 0.0, 5.0), abs=1e-9)


@pytest.mark.parametrize("rate", [5.0, 50.0])
@pytest.mark.parametrize("start_yaw", [0.0, 2.0])
def test_a_slope_carries_to_one_side_of_the_room(rate: float, start_yaw: float) -> None:
    way = plan(*line(2.0), (0.5, 0.4, 1.5), (3.0, 0.4, 1.5), (0.5, 0.0, 0.0), REST, *line(-2.0))
    law = find("floor_slope").using(x=0.01, y=-0.02, x_rate=1e-3)
    there = track(way, law, rate=rate, start_yaw=start_yaw)
    plain = track(way, rate=rate, start_yaw=start_yaw)
    path = 4.0 + 0.4 * 3.5
    assert there.end[0] - plain.end[0] == pytest.approx(0.01 * path + 1e-3 * plain.time[-1])
    assert there.end[1] - plain.end[1] == pytest.approx(-0.02 * path)
    assert there.end[2] == plain.end[2]


def test_lines_along_the_grain_are_longer_than_across() -> None:
    along_x, diagonal = 0.003, 0.004
    law = find("anisotropic_floor").using(along_x=along_x, diagonal=diagonal)
    grain = 0.5 * math.atan2(diagonal, along_x)
    for way in (5.0, -5.0):
        longer, shorter = (
            math.hypot(*track(plan(*line(way)), law, start_yaw=yaw).end[:2])
            for yaw in (grain, grain + math.pi / 2)
        )
        assert longer - shorter == pytest.approx(10.0 * math.hypot(along_x, diagonal))
    there = track(plan(*turn(4.0)), law)
    assert there.end == pytest.approx((0.0, 0.0, 4.0), abs=1e-12)


def test_radii_follow_the_columns_that_are_there() -> None:
    law = find("radius_by_channel").apply
    rehearsal = Rehearsal.of(("Hub_Temperature_C", "payload_kg", "motor_a"))
    drive, travel = rehearsal.drive, rehearsal.travel
    warm, load = (drive.channels[name].mean for name in ("Hub_Temperature_C", "payload_kg"))
    swollen = law(travel, drive, temperature=1e-3, payload=-2e-3)
    grown = 1 + 1e-3 * (warm - 20.0) - 2e-3 * load
    np.testing.assert_allclose(swollen.left, travel.left * grown, rtol=1e-14)
    np.testing.assert_allclose(swollen.right, travel.right * grown, rtol=1e-14)
    bare = Rehearsal.of(("motor_a",))
    kept = law(bare.travel, bare.drive, temperature=1e-3, payload=-2e-3)
    np.testing.assert_array_equal(kept.left, bare.travel.left)


def test_two_thermometers_count_by_their_mean() -> None:
    law = find("radius_by_channel").apply
    rehearsal = Rehearsal.of(("left_temperature_c", "right_temperature_c"))
    drive, travel = rehearsal.drive, rehearsal.travel
    mean = 0.5 * sum(drive.channels[name].mean for name in drive.channels)
    swollen = law(travel, drive, temperature=1e-3, payload=0.0)
    np.testing.assert_allclose(swollen.left, travel.left * (1 + 1e-3 * (mean - 20.0)), rtol=1e-14)


@pytest.mark.parametrize(("values", "kicks"), [({"angle": 0.01}, 3), ({"alternating": 0.01}, -1)])
def test_a_castor_kicks_at_reversals_alone(values: dict[str, float], kicks: int) -> None:
    """Forwards, backwards, forwards, backwards: three reversals, two of them to backwards."""
    law = find("castor_kick").using(**values)
    there = track(TO_AND_FRO, law)
    assert there.end[2] == pytest.approx(kicks * 0.01, rel=1e-6)
    assert there.at(3.4)[2] == 0.0
    back = np.flatnonzero(there.time > 3.5)[:50]  # from the first reversal on
    gone = there.x.max() - there.x[back]
    kick = math.copysign(0.01, values.get("angle", -1.0))
    half_a_length = np.interp(0.02, gone, there.yaw[back])
    assert half_a_length == pytest.approx(kick * (1 - math.exp(-0.5)), rel=0.02)


def test_a_castor_drags_the_robot_round_where_it_swings() -> None:
    """Into a spin, and by half a turn at a reversal; in lines and in spins it does not."""
    law = find("castor_swing").using(drag=0.01)
    there = track(plan(*line(1.0), *turn(6.0), *line(1.0), *line(-1.0)), law)
    plain = track(plan(*line(1.0), *turn(6.0), *line(1.0), *line(-1.0)))
    dragged = there.yaw - plain.yaw
    assert dragged[np.searchsorted(there.time, 2.0)] == pytest.approx(0.0, abs=1e-6)
    steps = np.abs(np.diff(dragged)) > 1e-5
    assert steps.sum() < 0.5 * steps.size
    assert abs(dragged[-1]) == pytest.approx(0.01 * math.pi, rel=0.01)


def test_stop_and_go_is_no_reversal_and_neither_is_settling() -> None:
    law = find("castor_kick").using(angle=0.01)
    settling = [(0.05, -0.02, 0.0), (0.05, 0.0, 0.0), (0.5, 0.0, 0.0)]  # rolls back by 1 mm
    assert track(plan(*line(1.0), *settling, *line(1.0), *settling), law).end[2] == 0.0
    play = find("left_backlash").using(travel=5e-3)
    gone = track(plan(*line(1.0), *settling, *line(1.0)), play)
    assert gone.left[-1] == pytest.approx(2.0 - 0.001 - 0.0025)  # half of it in the first motion


@pytest.mark.parametrize("side", ["left", "right"])
def test_play_is_lost_at_each_reversal(side: str) -> None:
    law = find(f"{side}_backlash").using(travel=4e-3)
    there, plain = track(TO_AND_FRO, law), track(TO_AND_FRO)
    lost = getattr(there, side) - getattr(plain, side)
    middles = [lost[np.searchsorted(there.time, t)] for t in (2.0, 5.0, 8.0, 11.0)]
    assert middles == pytest.approx([-2e-3, 2e-3, -2e-3, 2e-3])
    other = "right" if side == "left" else "left"
    np.testing.assert_array_equal(getattr(there, other), getattr(plain, other))


def test_spins_take_play_up_too() -> None:
    law = find("left_backlash").using(travel=4e-3)
    way = plan(*line(1.0), *turn(2.0), *line(1.0))
    assert track(way, law).left[-1] - track(way).left[-1] == pytest.approx(-2e-3)


# -- encoders ---------------------------------------------------------------------------------


def test_ticks_are_missed_above_a_speed_and_not_below_it() -> None:
    law = find("right_missed_ticks").using(fraction=0.05, above=0.3)
    slow, fast = (track(plan((5.0, v, 0.0), (10.0, v, 0.0)), law) for v in (0.25, 0.5))
    assert slow.right[-1] == pytest.approx(slow.left[-1])
    late = slice(len(fast.right) // 2, None)
    gained = np.ptp(fast.right[late]) / np.ptp(fast.left[late])
    assert gained == pytest.approx(1 / 0.95)


def test_skew_turns_the_robot_while_it_moves() -> None:
    law = find("encoder_skew").using(delay=0.01)
    there = track(plan(*line(3.0, 0.7)), law)
    assert there.at(2.0)[2] == pytest.approx(-0.01 * 0.7 / TRACK)
    assert there.end[2] == pytest.approx(0.0, abs=1e-12)


def test_a_record_that_begins_in_full_motion_is_not_turned_by_skew() -> None:
    law = find("encoder_skew").using(delay=0.01)
    way = Plan(np.array([0.0, 3.0]), np.full(2, 0.7), np.zeros(2))
    assert track(way, law).end[2] == pytest.approx(0.0, abs=1e-12)


# -- measurement and wiring -------------------------------------------------------------------


def test_views_add_up() -> None:
    seen = view_of(
        (
            find("reference_lever_arm").using(x=0.1, y=-0.2),
            find("reference_yaw_offset").using(angle=0.3),
            find("reference_delay").using(delay=0.04),
            find("reference_heading_delay").using(delay=0.05),
            find("reference_lever_arm").using(x=0.1),
            find("reference_mirrored").using(),
        )
    )
    assert seen == View(0.2, -0.2, 0.3, 0.04, 0.05, True)


@pytest.mark.parametrize(
    ("mistakes", "read"),
    [
        ((), (3.0, 7.0)),
        (("wheels_swapped",), (7.0, 3.0)),
        (("left_wheel_reversed",), (-3.0, 7.0)),
        (("right_wheel_reversed",), (3.0, -7.0)),
        (("left_wheel_reversed", "wheels_swapped"), (-7.0, 3.0)),
        (("wheels_swapped", "wheels_swapped"), (3.0, 7.0)),
    ],
)
def test_mistakes_of_wiring(mistakes: tuple[str, ...], read: tuple[float, float]) -> None:
    wiring = wiring_of(tuple(find(name).using() for name in mistakes))
    assert wiring.wheels(3.0, 7.0) == read
    assert Wiring().wheels(3.0, 7.0) == (3.0, 7.0)


def stood(*time: float) -> Trajectory:
    """A robot that stands."""
    rows = np.array(time)
    return trajectory(Robot(TRACK, RADIUS, 2000.0, 2000.0), rows, 0.0 * rows, 0.0 * rows)


def test_a_gyro_that_drifts_turns_with_the_square_of_time_standing_or_not() -> None:
    """And two minutes at rest show what its page says, whatever the clock says."""
    view = view_of((find("reference_gyro_drift").using(rate=2e-5),))
    for begin in (0.0, 500.0):
        seen = shown(stood(begin, begin + 60.0, begin + 120.0), view)
        expected = [0.0, 1e-5 * 60.0**2, 1e-5 * 120.0**2]
        np.testing.assert_allclose(seen.yaw, expected, atol=1e-12)
        np.testing.assert_array_equal(seen.x, 0.0)


def test_a_clock_that_gains_shows_the_same_later_and_later() -> None:
    """And two minutes after it began a jolt comes as much later as its page says."""
    view = view_of((find("reference_clock_drift").using(delay=0.5, rate=1e-2),))
    rows = np.linspace(0.0, 200.0, 2001)
    for begin in (0.0, 500.0):
        robot = Robot(TRACK, RADIUS, 2000.0, 2000.0)
        driven = trajectory(robot, begin + rows, 1000.0 * rows, 900.0 * rows)
        seen = shown(driven, view)
        for stamp in (1.0, 120.0, 200.0):
            true = begin + stamp - (0.5 + 1e-2 * stamp)
            assert np.interp(begin + stamp, seen.time, seen.yaw) == pytest.approx(
                np.interp(true, driven.time, driven.yaw), abs=1e-9
            )
