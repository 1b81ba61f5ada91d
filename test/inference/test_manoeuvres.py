# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The next manoeuvre: it separates what the drives so far cannot, and says so beforehand."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest

import werrimbi_odom.simulation as simulation
from werrimbi_odom.effects import find
from werrimbi_odom.effects.library import LIBRARY
from werrimbi_odom.files.run import Reference, Run, Ticks
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis, diagnose
from werrimbi_odom.inference.fitting.candidate import Candidate
from werrimbi_odom.inference.fitting.concatenated_runs import concatenated
from werrimbi_odom.inference.fitting.fit import start_point
from werrimbi_odom.inference.fitting.prediction import predicted_legs
from werrimbi_odom.inference.legs.cutting import match
from werrimbi_odom.inference.linear import nuisance
from werrimbi_odom.inference.manoeuvres.expected_evidence import (
    Experiment,
    Sensitivities,
    Trace,
    best_alias,
    difference,
    sensitivities_of,
    separation,
    trace_at,
)
from werrimbi_odom.inference.manoeuvres.ideal_drives import DrivingLimits, ideal_run
from werrimbi_odom.inference.manoeuvres.library import MANOEUVRES, Ideal
from werrimbi_odom.inference.manoeuvres.next_manoeuvre import (
    Discrimination,
    next_manoeuvre,
    quickest,
)
from werrimbi_odom.model.effect import AppliedEffect
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.simulation.hidden.axle_and_reference import ReferenceDelay, ReferenceMount
from werrimbi_odom.simulation.hidden.hidden_effect import Peculiarity

ROBOT = Robot(0.35, 0.05, 2000.0, 2000.0)
PACE = DrivingLimits(speed=0.6, acceleration=1.5, base=0.35)
BY_NAME = {ideal.name: ideal for ideal in MANOEUVRES}


def driven(ideal: Ideal, robot: Robot = ROBOT, yaw: bool = True) -> Experiment:
    run = ideal_run(ideal, robot, PACE, ticks=0.02, poses=0.05, measures=(True, yaw))
    runs = concatenated([match(run, robot, 0.25, None, 0.4)])
    return Experiment(runs, start_point(runs, robot))


@pytest.mark.parametrize("name", BY_NAME)
@pytest.mark.parametrize("mistakes", [(), ("wheels_swapped", "left_wheel_reversed"),
                                      ("reference_mirrored",)])  # fmt: skip
def test_an_ideal_drive_is_what_its_robot_predicts(name: str, mistakes: tuple[str, ...]) -> None:
    robot = replace(ROBOT, effects=tuple(find(mistake).using() for mistake in mistakes))
    drives = driven(BY_NAME[name], robot)
    runs = drives.runs
    poses = np.array([1.0, -1.0, -1.0]) if "reference_mirrored" in mistakes else np.ones(3)
    start, finish = runs.start * poses, runs.finish * poses
    moved = (finish[:, 0] - start[:, 0]) + 1j * (finish[:, 1] - start[:, 1])
    ahead = moved * np.exp(-1j * start[:, 2])
    shown = predicted_legs(drives.point.model, runs)
    # Between two messages of the ticks a step is taken to be even: at each end of a leg it misses
    # acceleration * interval^2 / 8.
    even = 2.0 * 0.02**2 / 8.0
    turning = even * 0.4 * PACE.acceleration * PACE.yaw_rate / PACE.speed
    np.testing.assert_allclose(shown[:, :2], np.stack([ahead.real, ahead.imag], axis=-1), atol=
                               even * PACE.acceleration + 0.25 * turning)  # fmt: skip
    np.testing.assert_allclose(shown[:, 2], finish[:, 2] - start[:, 2], atol=turning)


def test_the_simulation_drives_what_is_named() -> None:
    for name in BY_NAME:
        assert name == "stand_still" or hasattr(simulation, name)


def rise(drive: str, truth: AppliedEffect, rival: str) -> float:
    """Of the cost, where the rival has to stand for the truth on one drive."""
    drives = driven(BY_NAME[drive])
    wrong = Candidate(find(rival), {})
    calibration = [Candidate(find(name), {}) for name in
                   ("track_width", "unequal_wheel_radii", "wheel_radius_scale")]  # fmt: skip
    look = sensitivities_of(drives, [wrong, *calibration], ())
    return separation([(look, trace_at(look, truth))], wrong)


@pytest.mark.parametrize("drive", BY_NAME)
def test_no_drive_tells_a_crab_from_a_marker_askew(drive: str) -> None:
    truth = find("sideways_drift").using(angle=0.01)
    assert rise(drive, truth, "reference_yaw_offset") < 0.1


def test_spins_tell_a_lever_arm_from_slip_in_curves_and_lines_do_not() -> None:
    truth = find("reference_lever_arm").using(x=0.02)
    assert rise("spins", truth, "lateral_slip") > 100.0
    assert rise("out_and_back", truth, "lateral_slip") < 1e-3


def test_a_rival_that_one_circle_cannot_tell_from_a_base_is_imagined_whole() -> None:
    """By positions alone it could be the base, a wheel, or a base that depends on the turning.

    Shared among them, it would be so small that no drive seemed to tell them apart.
    """
    circle = Ideal("circle", "", "", lambda size: [(6.0 * size, 6.0, 0.6)] * 4)
    drives = driven(circle, yaw=False)
    rival = Candidate(find("turn_dependent_track"), {})
    names = ("track_width", "unequal_wheel_radii", "wheel_radius_scale")
    look = sensitivities_of(drives, [rival, *(Candidate(find(n), {}) for n in names)], ())
    target = trace_at(look, find("track_width").using(multiplier=1.02))
    alone = look.white[rival.name] @ best_alias(look, target, rival)
    free = nuisance(look.own).residual(np.stack([alone, target.white], axis=-1))
    assert free[:, 0] @ free[:, 1] > 0.9 * free[:, 1] @ free[:, 1]


def test_what_rivals_differ_by_is_no_more_than_a_drive_allows() -> None:
    """Squares by tape at both ends: bases that know the turn rate, and one that does not, are one.

    Both grew against each other without limit, and a figure of eight told them "by 64 m".
    """
    rival = Candidate(find("turn_dependent_track"), {})
    names = ("track_width", "unequal_wheel_radii", "wheel_radius_scale")
    looked_at = [rival, *(Candidate(find(name), {}) for name in names)]

    def taped(*ideals: Ideal) -> tuple[Sensitivities, Trace]:
        runs = [
            ideal_run(ideal, ROBOT, PACE, ticks=0.02, poses=np.inf, measures=(True, True))
            for ideal in ideals
        ]
        laid = concatenated([match(run, ROBOT, 0.25, None, 0.4) for run in runs])
        look = sensitivities_of(Experiment(laid, start_point(laid, ROBOT)), looked_at, ())
        return look, trace_at(look, find("unequal_wheel_radii").using(ratio=0.996))

    squares = [
        Ideal("", "", "", lambda size, turn=turn: [(size, 0.0, 0.6), (0.0, turn, 0.6)] * 4)
        for turn in (0.5 * np.pi, -0.5 * np.pi)
    ]
    apart = difference(taped(*squares, *squares), taped(BY_NAME["figure_eight"]), rival)
    assert np.hypot(apart[:, 0], apart[:, 1]).max() < 0.1


def test_slow_and_fast_lines_tell_lost_counts_from_a_smaller_wheel() -> None:
    truth = find("left_missed_ticks").using(fraction=0.02, above=0.3)
    assert rise("out_and_back", truth, "unequal_wheel_radii") > 100.0
    every = find("left_missed_ticks").using(fraction=0.02, above=0.02)
    assert rise("out_and_back", every, "unequal_wheel_radii") < 0.1 * rise(
        "out_and_back", truth, "unequal_wheel_radii"
    )


def test_several_speeds_tell_slip_from_a_late_clock_and_a_standing_robot_does_not() -> None:
    truth = find("longitudinal_slip").using(coefficient=0.03)
    for drive in ("arcs", "out_and_back"):
        assert rise(drive, truth, "reference_delay") > 30.0
    for drive in ("figure_eight", "stand_still"):
        assert rise(drive, truth, "reference_delay") < 15.0


# --- rivals by construction: one speed, gentle bends, positions alone -----------------------------


def slalom(seed: int) -> simulation.Manoeuvre:
    """Bends to both sides at one speed."""
    rng = np.random.default_rng(seed)
    knots = [(0.0, 0.0, 0.0), (1.0, 0.4, 0.0)]
    side = 1.0
    while knots[-1][0] < 45.0:
        start, side = knots[-1][0] + 0.6, -side
        rate = side * rng.uniform(0.4, 0.9)
        knots += [(start, 0.4, rate), (start + rng.uniform(0.8, 2.0), 0.4, rate)]
    end = knots[-1][0]
    knots += [(end + 0.6, 0.4, 0.0), (end + 1.6, 0.0, 0.0)]
    return simulation.Manoeuvre("slalom", tuple(knots))


def recorded(manoeuvre: simulation.Manoeuvre, odd: Peculiarity, seed: int, less: float) -> Run:
    """A drive in the engine, measured by its positions alone, without its first and last seconds.

    The reference ends half a second within the counters: so a late clock stays within them too.
    """
    robot = simulation.TrueRobot(left_wheel_noise=4e-4, right_wheel_noise=5.8e-4)
    seen = simulation.record(robot, manoeuvre, seed=seed, hidden=[odd])
    low, high = seen.t_s[0] + less, seen.t_s[-1] - less
    ticks = (seen.t_s >= low) & (seen.t_s <= high)
    poses = (seen.reference_t_s >= low + 0.5) & (seen.reference_t_s <= high - 0.5)
    return Run(
        f"{manoeuvre.name}_{seed}",
        Path(manoeuvre.name),
        Ticks(seen.t_s[ticks], seen.left_ticks[ticks], seen.right_ticks[ticks]),
        Reference(
            seen.reference_t_s[poses],
            seen.reference_x_m[poses],
            seen.reference_y_m[poses],
            np.full(int(poses.sum()), np.nan),
        ),
    )


def at_one_speed(odd: Peculiarity) -> list[Run]:
    return [recorded(slalom(seed), odd, 100 + seed, 2.0) for seed in range(3)]


def diagnosed(runs: list[Run]) -> Diagnosis:
    return diagnose(runs, ROBOT, LIBRARY)


@pytest.mark.parametrize(
    ("truth", "odd"),
    [
        ("reference_lever_arm", ReferenceMount(x=-0.01)),
        ("reference_delay", ReferenceDelay(delay=0.025)),
    ],
)
@pytest.mark.evidence
def test_a_lever_arm_and_a_delay_at_one_speed_are_ambiguous_and_the_manoeuvre_resolves_it(
    truth: str, odd: Peculiarity
) -> None:
    runs = at_one_speed(odd)
    first = diagnosed(runs)
    assert first.verdict == "ambiguous"
    assert {"reference_lever_arm", "reference_delay"} <= set(first.rivals)
    proposed = next_manoeuvre(first)
    assert proposed is not None
    assert first.rivals[0] in proposed.why
    drive = getattr(simulation, proposed.name)()
    more = [recorded(drive, odd, 700 + number, 0.2) for number in range(2)]
    then = diagnosed([*runs, *more])
    assert (then.verdict, then.effect) == ("named", truth)
    assert next_manoeuvre(then) is None


def weighed(name: str, minutes: float, *rises: float) -> Discrimination:
    """Of the first rival against the others, then of these among themselves."""
    names = ("first", "other", "third")[: 2 if len(rises) == 1 else 3]
    pairs = dict(zip(combinations(names, 2), rises, strict=True))
    return Discrimination(BY_NAME[name], minutes, pairs, lambda pair: np.zeros((3, 3)))


def test_what_takes_longer_than_one_may_ask_for_is_begun_if_it_tells_as_likely_as_not() -> None:
    sure = quickest(("first", "other"), [weighed("spins", 1.5, 3.0)])
    assert sure is not None
    assert (sure.name, sure.minutes) == ("spins", 15.0)
    assert sure.chance == pytest.approx(0.966, abs=0.001)  # 30 are promised, and 10 needed
    begun = quickest(("first", "other"), [weighed("spins", 1.5, 0.7), weighed("arcs", 5.0, 1.2)])
    assert begun is not None
    assert (begun.name, begun.minutes) == ("spins", 30.0)
    assert begun.chance == pytest.approx(0.70, abs=0.01)  # of 14 +- 7.5
    assert quickest(("first", "other"), [weighed("spins", 1.5, 0.4)]) is None


def test_what_rivals_differ_by_is_told_in_words_that_people_use() -> None:
    leg = np.array([[0.012345, 0.0, np.radians(123.0)]])
    pairs = {("first", "other"): 100.0}
    for legs, where in ((np.tile(leg, (3, 1)), "on a short leg"), (leg, "at the end")):
        told = quickest(
            ("first", "other"),
            [Discrimination(BY_NAME["square"], 2.0, pairs, lambda _, legs=legs: legs)],
        )
        assert told is not None
        assert told.why == (
            "first and other look alike on these drives, but around squares in both senses they "
            f"differ by 12 mm and 120° {where}"
        )


def test_a_rival_that_no_drive_tells_keeps_none_from_telling_the_others() -> None:
    names = ("first", "other", "third")
    spins, arcs = weighed("spins", 1.5, 0.0, 0.0, 15.0), weighed("arcs", 5.0, 10.0, 0.0, 30.0)
    some = quickest(names, [spins, arcs])
    assert some is not None
    assert (some.name, some.minutes) == ("arcs", 15.0)  # for the first against the other
    assert some.why.startswith("first and other look alike")
    all_of_them = quickest(names, [spins, arcs, weighed("square", 2.0, 4.0, 4.0, 4.0)])
    assert all_of_them is not None
    assert (all_of_them.name, all_of_them.minutes) == ("square", 15.0)
