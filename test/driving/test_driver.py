# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Whatever comes, a driven robot keeps to its limits, and stands still once something is wrong."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

pytest.importorskip("hypothesis")

from hypothesis import Phase, given, settings
from hypothesis import strategies as st

from test.driving.plant import Plant
from werrimbi_odom.driving.driver import LATER, Driver
from werrimbi_odom.driving.limits import STILL, Area, Command, Limits, OdometryReading, Watch
from werrimbi_odom.driving.manoeuvres import plan_of
from werrimbi_odom.driving.plan import ManoeuvrePlan, Move, seen_from
from werrimbi_odom.errors import InputError
from werrimbi_odom.model.pose import Pose, compose

LIMITS = Limits(0.4, 1.2, 0.8, 2.5)
WIDE = Area(radius=30.0, robot_radius=0.3)
SQUARE = plan_of("umbmark_ccw", length=1.0)
Spoil = Callable[[OdometryReading], OdometryReading | None]


def driver(
    plan: ManoeuvrePlan = SQUARE,
    limits: Limits = LIMITS,
    area: Area = WIDE,
    watch: Watch | None = None,
) -> Driver:
    return Driver(plan, limits, area, watch or Watch())


def under_way(area: Area = WIDE, watch: Watch | None = None) -> tuple[Driver, Plant]:
    """A robot in the middle of its first side, at speed."""
    one, plant = driver(SQUARE, area=area, watch=watch), Plant()
    plant.rest(one)
    one.start(plant.time)
    while one.command.speed < 0.15:
        plant.step(one)
    return one, plant


@pytest.mark.parametrize("name", ["umbmark", "paper_out_and_back", "start_stop", "arcs"])
def test_a_robot_that_lags_and_scatters_ends_within_centimetres(name: str) -> None:
    plan = plan_of(name, length=1.0, size=0.4)
    one, plant = driver(plan), Plant(lag=4, noise=0.05, seed=1)
    goal = compose(plant.pose, plan.starts()[-1])
    plant.drive(one)
    assert one.state == "done"
    assert math.hypot(plant.pose.x - goal.x, plant.pose.y - goal.y) < 0.03
    assert abs(math.remainder(plant.pose.yaw - goal.yaw, 2.0 * math.pi)) < math.radians(3.0)


moves = st.builds(
    Move,
    st.floats(-1.0, 1.0),
    st.floats(-4.0, 4.0),
    st.floats(0.4, 1.0),
    st.booleans(),
    st.floats(0.0, 0.5),
)
limits = st.builds(
    Limits, st.floats(0.2, 1.0), st.floats(0.4, 2.0), st.floats(0.2, 2.0), st.floats(0.4, 4.0)
)


@settings(max_examples=60, deadline=None, phases=[Phase.explicit, Phase.reuse, Phase.generate])
@given(
    plan=st.lists(moves, min_size=1, max_size=3),
    limits=limits,
    lag=st.integers(1, 8),
    noise=st.floats(0.0, 0.3),
    fault=st.sampled_from(["none", "silent", "jump", "back", "late"]),
    when=st.integers(40, 300),
)
def test_no_command_is_ever_beyond_the_limits_and_every_drive_ends(
    plan: list[Move], limits: Limits, lag: int, noise: float, fault: str, when: int
) -> None:
    one = driver(ManoeuvrePlan("any", "any", tuple(plan)), limits)
    plant = Plant(lag=lag, noise=noise, seed=when)
    plant.rest(one)
    one.start(plant.time)
    begun = len(plant.sent)
    longest = 1.5 * one.plan.duration(limits) + LATER
    for step in range(round(longest / plant.period) + 2):
        spoilt = fault != "none" and step >= when
        plant.step(one, SPOILT[fault] if spoilt else None)
        if one.state != "driving":
            break
    else:
        raise AssertionError(f"it drives for ever: {one.words}")
    ended = len(plant.sent)
    for _ in range(20):
        plant.step(one)
    sent = np.array(plant.sent)
    assert np.abs(sent[:, 0]).max() <= limits.speed
    assert np.abs(sent[:, 1]).max() <= limits.yaw_rate
    steps = np.abs(np.diff(sent[begun - 1 : ended - 1], axis=0))  # a stop is a zero at once
    most = np.array([limits.acceleration, limits.yaw_acceleration]) * 0.1
    assert (steps <= most + 1e-12).all()
    assert not sent[ended - 1 :].any()
    assert one.state in ("done", "stopped")


SPOILT: dict[str, Spoil] = {
    "silent": lambda _: None,
    "jump": lambda each: each._replace(pose=Pose(each.pose.x + 5.0, each.pose.y, each.pose.yaw)),
    "back": lambda each: each._replace(stamp=each.stamp - 500.0),
    "late": lambda each: each._replace(age=each.age + 1.0),
}
WORDS = {
    "silent": "the odometry is silent for",
    "jump": "the odometry jumped by 5.0",
    "back": "stamps go back or stand",
    "late": "comes 1.00 s later than before",
}


@pytest.mark.parametrize("fault", WORDS)
def test_a_fault_of_the_odometry_stops_it_within_its_timeout(fault: str) -> None:
    one, plant = under_way()
    before, since = plant.pose, plant.time
    while one.state == "driving":
        plant.step(one, SPOILT[fault])
    assert one.state == "stopped"
    assert WORDS[fault] in one.words
    assert plant.time - since <= Watch().odom_timeout + 0.021
    for _ in range(50):
        plant.step(one)
        assert one.command == STILL
    assert math.hypot(plant.pose.x - before.x, plant.pose.y - before.y) < 0.1


def test_a_stamp_that_stands_is_told_without_a_sign() -> None:
    one, plant = under_way()
    last = one.last
    assert last is not None
    one.odometry(last, plant.time)
    assert one.words == "the odometry's stamps go back or stand, by 0.000 s"


def test_its_progress_counts_moves_and_no_rests() -> None:
    one, plant = under_way()
    assert one.progress == "0 of 8 moves"
    while one.state == "driving":
        plant.step(one)
    assert one.progress == "8 of 8 moves"


def test_what_came_while_a_recording_was_begun_is_neither_silent_nor_late() -> None:
    """A bag takes a busy machine a part of a second, in which messages queue."""
    one, plant = driver(), Plant()
    plant.rest(one)
    asked, busy = plant.time, 0.4
    now = asked + busy
    one.start(now, busy=busy)
    one.tick(now + 0.003)
    assert one.state == "driving", one.words
    for stamp in np.arange(asked + 0.02, now, 0.02).tolist():
        one.odometry(OdometryReading(stamp, now - stamp, plant.pose), now + 0.004)
    plant.time = now
    plant.rest(one, 5)
    assert one.state == "driving", one.words
    one.tick(plant.time + 0.3)
    assert "silent for 0.30 s" in one.words
    late = driver()
    plant.rest(late)
    late.start(plant.time + busy, busy=busy)
    late.odometry(OdometryReading(plant.time + 0.02, busy + 0.3, plant.pose), plant.time + busy)
    assert "later than before" in late.words


def test_a_stop_is_at_once_and_only_another_start_moves_it_on() -> None:
    one, plant = under_way()
    one.stop("asked to")
    assert (one.state, one.command, one.words) == ("stopped", STILL, "asked to")
    plant.rest(one, 50)
    assert one.command == STILL
    one.start(plant.time)
    plant.step(one)
    assert one.state == "driving"


def test_a_robot_that_goes_on_by_itself_is_stopped_at_the_border() -> None:
    """It does not obey: its odometry goes straight on, through the corner of the square."""
    area = Area(ahead=1.5, behind=1.0, left=1.5, right=1.0, robot_radius=0.3)
    one, plant = under_way(area=area, watch=Watch(deviation=9.0, turned_off=9.0))
    start = plant.pose
    while one.state == "driving":
        plant.sent[-2:] = [Command(0.4, 0.0)] * 2
        plant.step(one)
    assert "it left the area" in one.words
    assert seen_from(start, plant.pose).x < 1.2 + 0.1


def test_a_robot_that_does_not_follow_is_stopped() -> None:
    one, plant = under_way()
    stuck = plant.pose
    while one.state == "driving":
        plant.step(one, lambda each: each._replace(pose=stuck))
    assert "does not follow" in one.words


def test_a_near_scan_and_a_silent_one_stop_it() -> None:
    watch = Watch(scan_min_distance=0.5)
    one, plant = driver(watch=watch), Plant()
    plant.rest(one)
    with pytest.raises(InputError, match="no scan comes"):
        one.start(plant.time)
    one.scan(0.4, plant.time)
    with pytest.raises(InputError, match=r"sees something at 0.40 m"):
        one.start(plant.time)
    one.scan(2.0, plant.time)
    one.start(plant.time)
    plant.step(one)
    assert one.scan(0.45, plant.time) == STILL
    assert "sees something at 0.45 m" in one.words
    one.scan(2.0, plant.time)
    plant.rest(one, 20)  # shorter than the scan's timeout
    one.start(plant.time)
    while one.state == "driving":
        plant.step(one)
    assert one.words == "no scan comes"


def test_wheels_that_slip_in_a_turn_stop_it() -> None:
    """The odometry turns, the gyro says that the robot does not."""
    spin = ManoeuvrePlan("spin", "", (Move(0.0, 6.0),))
    for slips in (False, True):
        one, plant = driver(spin, watch=Watch(slip=0.06)), Plant()
        for _ in range(30):
            plant.step(one)
            one.gyro(plant.time, 0.0, plant.time)
        one.start(plant.time)
        begun = plant.time
        while one.state == "driving" and plant.time < begun + 20.0:
            before = plant.pose.yaw
            plant.step(one)
            rate = math.remainder(plant.pose.yaw - before, 2.0 * math.pi) / plant.period
            one.gyro(plant.time, 0.0 if slips else rate, plant.time)
        assert one.state == ("stopped" if slips else "done"), one.words
        assert ("the wheels slip" in one.words) == slips


def test_a_gyro_on_another_clock_watches_nothing_so_it_does_not_start() -> None:
    one, plant = driver(watch=Watch(slip=0.06)), Plant()
    for _ in range(60):
        plant.step(one)
        one.gyro(plant.time - 30.0, 0.0, plant.time)
    with pytest.raises(InputError, match=r"the gyro's stamps and the odometry's are of different"):
        one.start(plant.time)


@pytest.mark.parametrize(
    ("spoil", "says"),
    [
        (lambda each: None, "no odometry comes"),
        (lambda each: each._replace(age=3.0), "stamps are 3.00 s old"),
        (
            lambda each: each._replace(pose=Pose(0.1 * each.stamp, 0.0, 0.0)),
            "the robot moves, or has not been heard to stand",
        ),
    ],
)
def test_it_does_not_start(spoil: Spoil, says: str) -> None:
    one, plant = driver(), Plant()
    for _ in range(60):
        plant.step(one, spoil)
    with pytest.raises(InputError, match=says):
        one.start(plant.time)
    assert one.state == "waiting"


def test_a_path_that_leaves_the_area_is_refused_also_from_where_a_stop_left_it() -> None:
    area = Area(ahead=1.6, behind=0.6, left=1.6, right=0.6, robot_radius=0.3)
    one, plant = under_way(area=area)
    for _ in range(60):
        plant.step(one)
    one.stop("asked to")
    plant.rest(one, 50)
    with pytest.raises(InputError, match="the path leads"):
        one.start(plant.time)


def test_a_jump_while_it_waits_means_a_new_area() -> None:
    """The pose was set: where the first start was, is not known any more."""
    one, plant = under_way(area=Area(radius=2.0, robot_radius=0.3))
    one.stop("asked to")
    plant.pose = Pose(50.0, 50.0, 1.0)
    plant.rest(one, 50)
    one.start(plant.time)
    assert one.state == "driving"
