# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A column that holds something else than its name says is refused, with how to convert it."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from test.files.recorded import ROBOT, TRUE, driven
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.run import Reference, Run, Ticks
from werrimbi_odom.files.run_checks import refuse_unjudgeable
from werrimbi_odom.files.tables import mislabelled_columns
from werrimbi_odom.files.tables.compared_ways import ends_of_chords, words_about_ways
from werrimbi_odom.files.tables.units_of_time import words_about_one_clock_unit
from werrimbi_odom.model.pose import wrap_all
from werrimbi_odom.model.robot import Robot


def refuse_wrong_columns(run: Run, robot: Robot = ROBOT) -> None:
    mislabelled_columns.refuse_wrong_columns(run, robot)


def seen(run: Run, **columns: np.ndarray | Callable[[Reference], np.ndarray]) -> Run:
    """The run with some columns of its reference made otherwise."""
    assert run.reference is not None
    made = {name: each(run.reference) if callable(each) else each for name, each in columns.items()}
    return replace(run, reference=replace(run.reference, **made))


def timed(run: Run, factor: float) -> Run:
    """The run with all times multiplied."""
    assert run.reference is not None
    ticks = Ticks(factor * run.ticks.time, run.ticks.left, run.ticks.right)
    return seen(replace(run, ticks=ticks), time=factor * run.reference.time)


def counted(run: Run, of: Callable[[np.ndarray], np.ndarray]) -> Run:
    """The run with both counters made otherwise."""
    ticks = run.ticks
    return replace(run, ticks=Ticks(ticks.time, of(ticks.left), of(ticks.right)))


@pytest.mark.parametrize("seed", range(8))
def test_right_columns_are_taken(seed: int) -> None:
    run = driven(seed)
    refuse_wrong_columns(run)
    refuse_wrong_columns(seen(run, yaw=lambda it: np.full(it.yaw.shape, np.nan)))
    refuse_wrong_columns(
        seen(run, x=lambda it: np.full(it.x.shape, np.nan), y=lambda it: it.x * np.nan)
    )


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("angle", [np.pi / 2, np.pi, -2.0])
def test_a_marker_may_look_anywhere_and_wheels_may_be_wired_wrongly(
    seed: int, angle: float
) -> None:
    run = seen(driven(seed), yaw=lambda it: it.yaw + angle)
    refuse_wrong_columns(run)
    ticks = run.ticks
    refuse_wrong_columns(replace(run, ticks=Ticks(ticks.time, -ticks.left, ticks.right)))
    refuse_wrong_columns(replace(run, ticks=Ticks(ticks.time, ticks.right, ticks.left)))
    mirrored = seen(run, y=lambda it: -it.y, yaw=lambda it: -it.yaw)  # wholly: an effect has it
    refuse_wrong_columns(mirrored)


@pytest.mark.parametrize(
    ("factor", "unit"), [(1e3, "milliseconds"), (1e6, "microseconds"), (1e9, "nanoseconds")]
)
def test_times_in_another_unit(factor: float, unit: str) -> None:
    for run in (driven(1), seen(driven(1), x=lambda it: it.x * np.nan)):
        with pytest.raises(InputError, match=f"in {unit}, and t_s means seconds: divide"):
            refuse_wrong_columns(timed(run, factor))


def test_rows_that_are_counted_have_no_times() -> None:
    run = driven(1)
    assert run.reference is not None
    numbered = replace(run, ticks=replace(run.ticks, time=np.arange(float(run.ticks.rows))))
    numbered = seen(numbered, time=lambda it: np.arange(float(it.time.size)))
    slow = seen(numbered, x=lambda it: 0.1 * it.x, y=lambda it: 0.1 * it.y)
    with pytest.raises(InputError, match="t_s counts the rows"):
        refuse_wrong_columns(slow)


@pytest.mark.parametrize("unit", [0.1, 1.0])
def test_times_that_are_rounded(unit: float) -> None:
    run = driven(1)
    times = unit * np.floor(run.ticks.time / unit)
    often = replace(run, ticks=replace(run.ticks, time=times))
    with pytest.raises(InputError, match=f"t_s is rounded to {unit:g} s; write all its digits"):
        refuse_wrong_columns(often)
    bursts = run.ticks.time.copy()
    bursts[1::3] = bursts[::3][: bursts[1::3].size]
    bursts[2::3] = bursts[::3][: bursts[2::3].size]
    jitter = np.repeat(np.random.default_rng(1).uniform(0.0, 0.004, bursts.size), 3)
    refuse_wrong_columns(
        replace(run, ticks=replace(run.ticks, time=bursts + jitter[: bursts.size]))
    )
    bursts[-1] = (
        bursts[-2] + (bursts[-2] - bursts[-5]) / 3.0
    )  # on a grid, but for most of its times
    refuse_wrong_columns(replace(run, ticks=replace(run.ticks, time=bursts)))


@pytest.mark.parametrize("seed", range(4))
def test_increments_and_speeds_are_no_totals(seed: int) -> None:
    run = driven(seed)
    interval = float(np.median(np.diff(run.ticks.time)))

    def increments(total: np.ndarray) -> np.ndarray:
        return np.diff(total, prepend=total[0])

    for made in (increments, lambda total: increments(total) / interval):
        for wrong in (counted(run, made), seen(counted(run, made), x=lambda it: it.x * np.nan)):
            with pytest.raises(InputError, match="not running totals: write the sum"):
                refuse_wrong_columns(wrong)


def test_totals_of_a_robot_that_is_turned_by_hand_once_are_totals() -> None:
    """It drives straight to and fro, by a gyro: one window alone made the correlation."""
    time = np.arange(0.0, 60.0, 0.05)
    left = np.rint(500.0 * np.sin(0.3 * time))
    by_hand = (time >= 30.1) & (time < 30.4)
    random = np.random.default_rng(3)
    yaw = np.where(time < 30.2, 0.0, 1.5) + 1e-3 * random.standard_normal(time.size)
    nowhere = np.full(time.size, np.nan)
    ticks = Ticks(time, left, left + np.where(by_hand, 80.0, 0.0))
    refuse_wrong_columns(
        replace(driven(0), ticks=ticks, reference=Reference(time, nowhere, nowhere, yaw))
    )


def test_totals_of_a_robot_that_is_carried_round_a_corner_are_totals() -> None:
    """It drives straight to and fro; by chance one counter is a count ahead while it is carried."""
    time = np.arange(0.0, 60.0, 0.05)
    carried = (time >= 30.0) & (time < 35.0)
    left = np.rint(500.0 * np.sin(0.3 * np.where(carried, 30.0, time)))
    yaw = np.clip(0.5 * (time - 30.0), 0.0, 2.5)
    yaw += 1e-3 * np.random.default_rng(3).standard_normal(time.size)
    nowhere = np.full(time.size, np.nan)
    ticks = Ticks(time, left, left + carried)
    reference = Reference(time, nowhere, nowhere, yaw)
    refuse_wrong_columns(replace(driven(0), ticks=ticks, reference=reference))


def test_scans_of_a_robot_that_was_carried_are_no_mistake_of_columns() -> None:
    """A TurtleBot3's third bag, a metre ahead and then carried round, was refused."""
    carried = seen(driven(0), yaw=lambda it: -it.yaw)
    with pytest.raises(InputError, match="clockwise"):
        refuse_wrong_columns(carried)
    refuse_wrong_columns(replace(carried, reference=replace(carried.reference, own_axes=True)))


@pytest.mark.parametrize("seed", range(6))
def test_a_yaw_that_turns_against_its_path(seed: int) -> None:
    run = driven(seed)
    for wrong in (
        seen(run, yaw=lambda it: -it.yaw),
        seen(run, yaw=lambda it: np.pi / 2 - it.yaw),
        seen(run, y=lambda it: -it.y),
        seen(run, x=lambda it: it.y, y=lambda it: it.x),
    ):
        with pytest.raises(InputError, match="clockwise"):
            refuse_wrong_columns(wrong)


@pytest.mark.parametrize("sway", [0.65, 0.8])
def test_a_yaw_that_turns_against_a_path_that_hardly_turns(sway: float) -> None:
    """A drive that sways by 37 degrees to either side was told to be a law of its own."""
    time = np.arange(0.0, 60.0, 0.05)
    random = np.random.default_rng(7)
    yaw = sway * np.sin(0.7 * time) + 0.05 * random.standard_normal(time.size)
    place = np.cumsum(0.02 * np.exp(1j * sway * np.sin(0.7 * time)))
    ticks = Ticks(time, np.arange(time.size) * 10.0, np.arange(time.size) * 10.0)
    run = replace(driven(0), ticks=ticks, reference=Reference(time, place.real, place.imag, yaw))
    refuse_wrong_columns(run)
    with pytest.raises(InputError, match="clockwise"):
        refuse_wrong_columns(seen(run, yaw=lambda it: -it.yaw))


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("of_range", [wrap_all, lambda yaw: yaw % (2.0 * np.pi), np.unwrap])
@pytest.mark.parametrize("places", [True, False])
def test_a_yaw_in_degrees(
    seed: int, of_range: Callable[[np.ndarray], np.ndarray], places: bool
) -> None:
    """Of most of such a drive `info` said that the robot was carried or turned by hand."""
    run = driven(seed)
    if not places:
        run = seen(run, x=lambda it: it.x * np.nan, y=lambda it: it.x * np.nan)
    refuse_wrong_columns(seen(run, yaw=lambda it: of_range(it.yaw)))
    with pytest.raises(InputError, match=r"the reference's yaw is in degrees, and must be in rad"):
        refuse_wrong_columns(seen(run, yaw=lambda it: np.degrees(of_range(it.yaw))))


@pytest.mark.parametrize("seed", range(3))
def test_what_a_reference_holds_is_seen_beside_counters_that_wrap(seed: int) -> None:
    """Their leaps hid that the yaw is in degrees: the robot was said to be carried by hand."""
    bits = replace(ROBOT, encoder_bits=12)
    run = counted(driven(seed), lambda total: total % (1 << 12))
    refuse_wrong_columns(run, bits)
    assert not words_about_ways(run, bits)
    with pytest.raises(InputError, match=r"the reference's yaw is in degrees, and must be in rad"):
        refuse_wrong_columns(seen(run, yaw=lambda it: np.degrees(wrap_all(it.yaw))), bits)
    far = seen(run, x=lambda it: 1000.0 * it.x, y=lambda it: 1000.0 * it.y)
    assert "x_m and y_m are in millimetres, and mean metres" in words_about_ways(far, bits)


@pytest.mark.parametrize("seed", range(4))
def test_longitude_and_latitude_are_no_metres(seed: int) -> None:
    """`info` said that such drives can show base and radii."""
    run = driven(seed)
    fixes = seen(
        run, x=lambda it: 5.66 + it.x / 6.9e4, y=lambda it: 51.9 + it.y / 1.11e5,
        yaw=lambda it: it.yaw * np.nan,
    )  # fmt: skip
    with pytest.raises(InputError, match="as degrees of longitude and latitude do: write metres"):
        refuse_wrong_columns(fixes)
    still = seen(run, x=lambda it: it.x * 1e-9, y=lambda it: it.y * 0.0)
    refuse_wrong_columns(still)


def test_a_gyro_that_is_dead_measured_no_turn() -> None:
    """Of an IMU that gives its orientation alone: the robot "turned 99.99 % less"."""
    run = driven(2)
    assert run.reference is not None
    nowhere, zeros = np.full(run.reference.x.shape, np.nan), np.zeros(run.reference.x.shape)
    dead = seen(run, x=nowhere, y=nowhere, yaw=zeros)
    with pytest.raises(InputError, match="is 0 in all rows, while the wheels turn the robot"):
        refuse_wrong_columns(dead)
    ahead = Ticks(run.ticks.time, run.ticks.left, run.ticks.left)
    refuse_wrong_columns(replace(dead, ticks=ahead))  # a simulated gyro, straight on


def test_a_yaw_that_was_never_measured() -> None:
    wrong = seen(driven(2), yaw=lambda it: np.zeros(it.yaw.shape))
    with pytest.raises(InputError, match=r"is 0 in all rows, while the path turns.* leave that"):
        refuse_wrong_columns(wrong)


@pytest.mark.parametrize(("period", "told"), [(1 << 12, False), (2000, True)])
def test_of_a_bag_columns_are_not_to_be_converted(period: int, told: bool) -> None:
    """A line in the robot file can be written all the same."""
    wrong = counted(driven(0), lambda total: total % period)
    for of_bag in (False, True):
        with pytest.raises(InputError) as error:
            refuse_wrong_columns(replace(wrong, of_bag=of_bag))
        words = "a bag has no such columns: mend what its driver sends, or write the converted"
        assert (words in str(error.value)) == (told and of_bag)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("signed", [False, True])
@pytest.mark.parametrize(
    ("period", "words"),
    [
        (1 << 16, "wraps at 16 bits: write encoder_bits: 16 into"),
        (1 << 12, "wraps at 12 bits"),
        (2000, "begins anew after (19..|20..) counts: unwrap both"),
    ],
)
def test_a_counter_that_wraps(seed: int, signed: bool, period: int, words: str) -> None:
    run = driven(seed)
    shift = period // 2 if signed else 0
    # Ten times the counts of a turn, so that 16 bits are few.
    more = counted(run, lambda total: total * (10 if period > 4096 else 1))
    wrong = counted(more, lambda total: (total + shift) % period - shift)
    with pytest.raises(InputError, match=words):
        refuse_wrong_columns(wrong)
    refuse_wrong_columns(more)
    if period != 2000:
        bits = replace(ROBOT, encoder_bits=period.bit_length() - 1)
        refuse_wrong_columns(wrong, bits)


@pytest.mark.parametrize("seed", range(3))
def test_one_wrap_at_32_bits_is_no_longitude(seed: int) -> None:
    """The leap of 4 294 967 296 counts is as far as the globe is from degrees."""
    wrong = counted(driven(seed), lambda total: (total - total[0] - 200) % (1 << 32))
    with pytest.raises(InputError, match="wraps at 32 bits: write encoder_bits: 32 into"):
        refuse_wrong_columns(wrong)


@pytest.mark.parametrize("seed", range(6))
def test_counters_without_a_sign(seed: int) -> None:
    """Of an encoder with one channel."""
    run = driven(seed, 120.0)
    unsigned = counted(run, lambda total: np.cumsum(np.abs(np.diff(total, prepend=total[0]))))
    with pytest.raises(InputError, match="never decrease, also where the robot turns on the spot"):
        refuse_wrong_columns(unsigned)


def test_a_counter_that_is_reset_or_read_seldom_does_not_wrap() -> None:
    run = driven(1)
    middle = run.ticks.rows // 2
    reset = np.arange(run.ticks.rows) >= middle
    refuse_wrong_columns(counted(run, lambda total: np.where(reset, total - total[middle], total)))
    ends = np.tile([0, 900], 20)  # driven to and fro, and read where it turns round
    seldom = replace(run, ticks=Ticks(np.linspace(*run.ticks.time[[0, -1]], 40), ends, ends))
    refuse_wrong_columns(seldom)


@pytest.mark.parametrize("seed", range(4))
def test_a_tracker_that_writes_zeros_saw_nothing(seed: int) -> None:
    run = seen(driven(seed), x=lambda it: it.x + 2.0)
    assert mislabelled_columns.without_zeros(run) is run
    assert run.reference is not None
    lost = np.arange(run.reference.time.size) % 7 < 2
    zeros = {name: np.where(lost, 0.0, getattr(run.reference, name)) for name in ("x", "y", "yaw")}
    left = mislabelled_columns.without_zeros(seen(run, **zeros))
    assert left.reference is not None
    np.testing.assert_array_equal(left.reference.time, run.reference.time[~lost])
    assert f"{lost.sum()} of {lost.size} reference poses are zeros" in left.damage[-1]


def test_a_robot_that_starts_at_zero_was_there() -> None:
    run = driven(1)
    assert run.reference is not None
    start = seen(
        run, x=lambda it: it.x - it.x[0], y=lambda it: it.y - it.y[0], yaw=lambda it: 0.0 * it.yaw
    )
    assert mislabelled_columns.without_zeros(start) is start


@pytest.mark.parametrize(("factor", "unit"), [(1e3, "milliseconds"), (1e6, "microseconds")])
def test_times_of_one_file_in_another_unit(factor: float, unit: str) -> None:
    run = driven(1)
    assert run.reference is not None
    assert not words_about_one_clock_unit(run.ticks, run.reference)
    later = seen(run, time=lambda it: factor * it.time)
    with pytest.raises(InputError, match=f"the times of the reference are in {unit}, and t_s mea"):
        refuse_unjudgeable(later, ROBOT)
    ticks = replace(run.ticks, time=factor * run.ticks.time)
    with pytest.raises(InputError, match=f"the times of the ticks are in {unit}, and t_s means"):
        refuse_unjudgeable(replace(run, ticks=ticks), ROBOT)


def test_ways_of_the_wheels_in_metres_and_angles() -> None:
    run = driven(1)
    refuse_wrong_columns(run)
    with pytest.raises(InputError, match="they are metres, and no counts: write how many steps"):
        refuse_wrong_columns(counted(run, lambda total: total * ROBOT.left_tick))
    radians = counted(run, lambda total: total * ROBOT.left_tick / TRUE.left_radius)
    refuse_wrong_columns(radians)  # the diagnosis says how many of them are a turn
    assert "it went 0.0" in words_about_ways(radians, ROBOT)
    assert not words_about_ways(run, ROBOT)
    carried = counted(run, lambda total: np.where(run.ticks.time < 5.0, total, 0.0))
    assert not words_about_ways(carried, ROBOT), "wheels that stand tell no unit"


@pytest.mark.parametrize("seed", range(4))
def test_a_quaternions_z_is_no_yaw(seed: int) -> None:
    run = driven(seed)
    with pytest.raises(InputError, match="it is the z of a quaternion: write the angle, 2 atan2"):
        refuse_wrong_columns(seen(run, yaw=lambda it: np.sin(0.5 * wrap_all(it.yaw + 0.3))))


@pytest.mark.parametrize("seed", range(2))
def test_a_reading_that_failed_hides_no_increments(seed: int) -> None:
    """One nan among the first rows, and increments were taken for totals."""
    made = counted(driven(seed), lambda total: np.diff(total, prepend=total[0]).astype(float))
    made.ticks.left[3] = np.nan
    with pytest.raises(InputError, match="not running totals: write the sum"):
        refuse_wrong_columns(made)


@pytest.mark.parametrize("late", ["ticks", "reference"])
def test_a_message_that_came_late_hides_no_increments(late: str) -> None:
    """Its stamp lies before that of the row above, and nothing was looked at."""
    made = counted(driven(1), lambda total: np.diff(total, prepend=total[0]))
    assert made.reference is not None
    time = (made.ticks if late == "ticks" else made.reference).time
    time[40] = time[38] - 1e-3
    with pytest.raises(InputError, match="not running totals: write the sum"):
        refuse_wrong_columns(made)


def test_a_clock_that_is_set_forward_is_told() -> None:
    """A robot without a battery for its clock gets the date ten seconds after its start."""
    run = driven(1)
    assert run.reference is not None
    begun = (each.time + 100.0 for each in (run.ticks, run.reference))
    dated = [np.where(each > 110.0, each + 1.7e9, each) for each in begun]
    both = seen(replace(run, ticks=replace(run.ticks, time=dated[0])), time=dated[1])
    with pytest.raises(InputError, match=r"to 17000001\d\d: the clock was set forward"):
        refuse_unjudgeable(both, ROBOT)
    late = run.ticks.time + 1.7e9
    late[0] = 0.0  # before there was a clock, and before the reference
    sound = seen(replace(run, ticks=replace(run.ticks, time=late)), time=run.reference.time + 1.7e9)
    refuse_unjudgeable(sound, ROBOT)


def test_a_path_of_hours_is_cut_into_chords_in_no_time() -> None:
    """It took a time that grew with its length and with the number of its chords."""
    angle = 0.0005 * np.arange(600_000)
    place = 10.0 * np.exp(1j * angle)
    began = time.process_time()
    ends = ends_of_chords(place, 1.0)
    assert time.process_time() - began < 0.5
    assert np.diff(ends) == pytest.approx(2.0 * np.arcsin(0.05) / 0.0005, abs=1.0)
    lone = np.abs(place - place[ends[-1]])[ends[-1] :]
    assert lone.max() < 1.0, "the rest of the path is shorter than a chord"


@pytest.mark.parametrize("which", ["both", "ticks", "reference"])
def test_times_that_were_divided_once_too_often(which: str) -> None:
    """It drove at 300 m/s, and `info` said that it had hardly moved."""
    run = driven(3)
    assert run.reference is not None
    refuse_unjudgeable(run, ROBOT)
    fast = timed(run, 1e-3)
    assert fast.reference is not None
    if which == "ticks":
        fast = replace(fast, reference=run.reference)
    elif which == "reference":
        fast = replace(fast, ticks=run.ticks)
    where = "in both files" if which == "both" else f"the times of the {which}, whose rows"
    with pytest.raises(InputError, match=where) as told:
        refuse_unjudgeable(fast, ROBOT)
    assert "multiply that column" in str(told.value)
    assert "by 10^3" in str(told.value)


def test_all_wrong_columns_are_told_at_once() -> None:
    """Speeds under the counters' names, with a yaw in degrees, all on a clock in milliseconds."""
    run = driven(2)
    ticks = run.ticks
    speeds = [np.gradient(each.astype(float), ticks.time) for each in (ticks.left, ticks.right)]
    wrong = seen(
        timed(replace(run, ticks=Ticks(ticks.time, *speeds)), 1e3),
        yaw=lambda it: np.degrees(it.yaw),
    )
    with pytest.raises(InputError) as told:
        refuse_unjudgeable(wrong, ROBOT)
    for each in ("the times are in milliseconds", "not running totals", "yaw is in degrees"):
        assert each in str(told.value)
