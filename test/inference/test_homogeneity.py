# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A reference that wanders is no effect; what really is there lasts from drive to drive."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from test.evidence import in_evidence
from test.inference.driven import COMMON, common, run_of
from test.white_noise_robot import WhiteNoiseRobot, drive, wandering
from werrimbi_odom.api.draft import _known
from werrimbi_odom.effects import LIBRARY, find
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.run import Reference, Run, Ticks
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.diagnosis.diagnosis import diagnose
from werrimbi_odom.inference.diagnosis.evidence import dependences
from werrimbi_odom.inference.diagnosis.forward_selection import fit_calibration, search_round
from werrimbi_odom.inference.diagnosis.homogeneity import (
    Lasting,
    _chance,
    homogeneity_of_effect,
    lasting,
)
from werrimbi_odom.inference.diagnosis.step_jacobians import Amount
from werrimbi_odom.inference.fitting.concatenated_runs import concatenated
from werrimbi_odom.inference.fitting.fit import start_point
from werrimbi_odom.inference.fitting.free_parameters import CALIBRATION
from werrimbi_odom.inference.legs.cutting import match_for_fit
from werrimbi_odom.inference.manoeuvres.advice import AdvisedDiagnosis
from werrimbi_odom.inference.manoeuvres.detection_limits import detection_limits
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.report.diagnosis.as_json import json_of
from werrimbi_odom.report.diagnosis.next_steps import NextSteps
from werrimbi_odom.report.diagnosis.reference_remarks import not_shown
from werrimbi_odom.report.diagnosis.unknown import unknown_words

TRUE = WhiteNoiseRobot()
ROBOT = TRUE.entered(0.05)
PLAIN = Robot(0.35, 0.05, 2000.0, 2000.0, left_wheel_noise=4e-4, right_wheel_noise=4e-4)
LASTING = 5.0
"""For how long the wandering reference errs alike [s]."""

Spoil = Callable[[np.ndarray, np.random.Generator], np.ndarray]
"""Errors of x, y and yaw (m, 3) by the poses' times."""


def wanders(time: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """4 mm and 8 mrad, alike for some seconds, as a camera's map is."""
    keeps = np.exp(-np.diff(time, prepend=time[0] - LASTING) / LASTING)
    new = random.normal(size=(time.size, 3)) * np.sqrt(1.0 - keeps**2)[:, None]
    error = np.zeros((time.size, 3))
    for row in range(time.size):
        error[row] = keeps[row] * error[row - 1] + new[row] if row else new[row]
    return error * [0.004, 0.004, 0.008]


def driven(seed: int, spoil: Spoil, name: str, hotter: float = 0.0, seconds: float = 60.0) -> Run:
    """A drive of a minute; `hotter` lets both wheels shrink as a channel grows."""
    random = np.random.default_rng(seed)
    seen = drive(TRUE, wandering(random, seconds, 25.0), random, every=2, hertz=25.0)
    ticks, poses = seen.ticks, seen.reference
    channel = np.sin(ticks.time / 9.0 + seed)
    counted = 1.0 + hotter * channel
    left, right = (
        np.cumsum(np.diff(side.astype(np.float64), prepend=side[0]) * counted)
        for side in (ticks.left, ticks.right)
    )
    error = spoil(poses.time, random)
    reference = Reference(
        poses.time, poses.x + error[:, 0], poses.y + error[:, 1], poses.yaw + error[:, 2]
    )
    counts = Ticks(
        ticks.time, np.rint(left).astype(np.int64), np.rint(right).astype(np.int64),
        {"warmth": channel},
    )  # fmt: skip
    return Run(name, Path(name), counts, reference)


def chances(seeds: range, spoil: Spoil, hotter: float = 0.0) -> list[tuple[str, float, float]]:
    """The most certain cells: what they go with, chance by the map, chance by the quarters."""
    runs = [driven(seed, spoil, f"drive_{seed}", hotter) for seed in seeds]
    laid = concatenated(match_for_fit(runs, ROBOT, 1.0, None))
    fit = fit_calibration(laid, ROBOT)
    numbers = (*CALIBRATION, *fit.numbers)
    cells = dependences(laid, fit.point, numbers)[:8]
    return [
        (each.cell.variable.name, each.cell.p_value, each.p_value)
        for each in lasting(laid, fit.point, numbers, cells)
    ]


def nothing(time: np.ndarray, random: np.random.Generator) -> np.ndarray:
    return np.zeros((time.size, 3))


@pytest.mark.parametrize("first", [30, *(in_evidence(first) for first in (10, 20))])
def test_what_a_wandering_reference_shows_does_not_last(first: int) -> None:
    found = chances(range(first, first + 5), wanders)
    assert found[0][1] < 1e-5, "by the map alone it would be beyond any chance"
    assert found[0][2] > 1e-3


def test_what_goes_with_a_measured_channel_lasts() -> None:
    name, by_map, by_quarters = chances(range(40, 44), nothing, hotter=0.01)[0]
    assert name == "warmth"
    assert max(by_map, by_quarters) < 1e-5


def test_it_lasts_beside_a_reference_that_wanders() -> None:
    found = chances(range(50, 55), wanders, hotter=0.02)
    assert min(p_value for name, _, p_value in found if name == "warmth") < 1e-3


@pytest.mark.evidence
def test_a_right_robot_by_a_wandering_reference_misses_nothing() -> None:
    *train, held = [driven(seed, wanders, f"drive_{seed}") for seed in range(60, 64)]
    effects = common("floor_slope", "anisotropic_floor", "reference_gyro_drift", "oval_left_wheel")
    found = diagnose(train, ROBOT, effects, holdout=[held])
    assert found.wander is not None
    assert (found.verdict, found.found) == ("none", ())


@pytest.mark.evidence
def test_what_one_drive_alone_shows_is_no_law_of_the_robot() -> None:
    hot = [driven(seed, nothing, f"drive_{seed}") for seed in range(71, 74)]
    hot.append(driven(74, nothing, "hot", hotter=0.02))
    found = diagnose(hot, ROBOT, COMMON, holdout=[driven(75, nothing, "apart")])
    assert (found.verdict, found.found) == ("none", ())
    assert found.misfit is not None
    assert (found.misfit.only_in, found.misfit.cell.variable.name) == ("hot", "warmth")


@pytest.mark.evidence
def test_what_every_drive_shows_is_told_of_the_robot() -> None:
    hot = [driven(seed, nothing, f"drive_{seed}", hotter=0.01) for seed in range(80, 84)]
    found = diagnose(hot, ROBOT, COMMON, holdout=[driven(85, nothing, "apart", hotter=0.01)])
    assert (found.verdict, found.depends_on[0].variable.name) == ("unknown", "warmth")


def lasts(runs: list[Run], of: str) -> Lasting:
    """The most certain dependence on a variable, and whether it lasts."""
    laid = concatenated(match_for_fit(runs, PLAIN, 1.0, None))
    point = start_point(laid, PLAIN)
    cells = [each for each in dependences(laid, point, CALIBRATION) if each.variable.name == of]
    assert cells[0].p_value < 1e-5
    return next(lasting(laid, point, CALIBRATION, cells[:1]))


@pytest.mark.parametrize("everywhere", [True, False])
def test_a_wheels_wave_has_one_height_in_all_drives(everywhere: bool) -> None:
    """What two drives show of seven and the others do not, was told as the shape of a wheel."""
    wheel = find("eccentric_right_wheel")
    heights = [1e-3] * 7 if everywhere else [3e-3] * 2 + [0.0] * 5
    runs = [
        run_of(replace(PLAIN, effects=(wheel.using(amplitude=height, phase=seed - 3.0),)), seed, 40)
        for seed, height in enumerate(heights)
    ]
    assert (lasts(runs, "right_wheel_angle").p_value < 1e-3) is everywhere


def test_of_a_place_where_one_drive_alone_was_the_others_tell_nothing() -> None:
    """They drove much, but elsewhere: "they hold as much, and do not show it", it was said."""
    runs = [run_of(PLAIN, seed, 40) for seed in range(6)]
    steps = 50 * 80
    lap = (np.full(steps, 0.4), np.full(steps, 0.4))
    true = WhiteNoiseRobot(0.35, 0.05, 0.05, 4e-4, 4e-4)
    laps = drive(true, lap, np.random.default_rng(5), every=10)
    seen = laps.reference
    path = seen.x + 1j * seen.y
    slips = path[0] + np.cumsum(
        np.diff(path, prepend=path[0]) * (1.0 - 0.004 * (np.abs(path - path[0]) < 0.4))
    )
    moved = replace(seen, x=slips.real + 5.0, y=slips.imag + 5.0)
    found = lasts([*runs, replace(laps, reference=moved)], "position")
    assert found.only_in is None
    assert found.p_value < 1e-3


@pytest.mark.parametrize("drives", [7, 25, 60, 200])
def test_what_all_drives_agree_on_lasts_however_many_they_are(drives: int) -> None:
    random = np.random.default_rng(drives)
    parts = np.repeat(np.arange(4 * drives), 12)
    free = random.normal(size=(parts.size, 1))
    free /= np.sqrt(np.sum(free**2))
    noise = random.normal(size=parts.size)
    rest = noise + 12.0 * free[:, 0]
    gain = float((free[:, 0] @ rest) ** 2)
    assert _chance(gain, 1, free, free, rest, parts) < 1e-6
    # A tenth of the parts has all of it: no two parts agree.
    few = np.where(parts % 10 == 0, free[:, 0], 0.0)
    rest = noise + 120.0 * np.where(parts % 20 == 0, few, -few)
    gain = float((free[:, 0] @ rest) ** 2)
    assert _chance(gain, 1, free, free, rest, parts) > 1e-3


@pytest.mark.evidence
@pytest.mark.parametrize("degrees", [1, 2])
def test_what_each_part_draws_anew_lasts_as_rarely_as_is_said(degrees: int) -> None:
    """Where three of nine parts know nearly all: once in a hundred was once in thirteen."""
    random = np.random.default_rng(degrees)
    shares = np.array([0.31, 0.25, 0.56, 0.36, 0.27, 0.13, 0.26, 0.58, 0.7])
    parts = np.repeat(np.arange(shares.size), 6)

    def chance(drawn: float) -> float:
        columns = random.normal(size=(parts.size, degrees)) * shares[parts, None]
        free = np.linalg.qr(columns)[0]
        drawn_anew = drawn * random.normal(size=(shares.size, degrees))
        rest = random.normal(size=parts.size) + np.sum(free * drawn_anew[parts], axis=1)
        return _chance(float(np.sum((free.T @ rest) ** 2)), degrees, free, free, rest, parts)

    found = [chance(drawn) for drawn in (30.0, 1000.0) for _ in range(200)]
    assert np.sum(np.array(found) < 0.01) <= 11
    assert np.sum(np.array(found) < 0.1) >= 20


def chance_of_wave(random: np.random.Generator, height: float, drawn: float) -> float:
    """Four drives of seven parts each: a wave of one height, a phase in each drive at its best.

    The drives know it more and less; each part adds a wave that it draws anew.
    """
    of_drive, parts = np.repeat(np.arange(4), 70), np.repeat(np.arange(28), 10)
    waves = random.normal(size=(parts.size, 2)) * np.sqrt([4.0, 3.0, 2.0, 1.0])[of_drive, None]
    waves /= np.linalg.norm(waves, axis=0)
    begins = random.uniform(-np.pi, np.pi, 4)
    each = height * np.stack([np.cos(begins), np.sin(begins)], axis=-1)[of_drive]
    each += drawn * random.normal(size=(28, 2))[parts]
    rest = random.normal(size=parts.size) + np.sum(waves * each, axis=1)
    told = [
        np.arctan2(*(waves[of_drive == run].T @ rest[of_drive == run])[::-1])
        for run in (0, 1, 2, 3)
    ]
    cosine, sine = np.cos(told)[of_drive], np.sin(told)[of_drive]
    size = waves[:, 0] * cosine + waves[:, 1] * sine
    phase = waves[:, 1] * cosine - waves[:, 0] * sine
    own = np.where(of_drive[:, None] == np.arange(4), phase[:, None], 0.0)
    free = np.column_stack([size, own])
    gain = float(np.sum((np.linalg.qr(free)[0].T @ rest) ** 2))
    return _chance(gain, 5, free, np.column_stack([size, phase]), rest, parts)


def test_a_wave_of_one_height_lasts_whatever_its_phase_is_in_each_drive() -> None:
    """Seen by 9 deviations, it was put down to noise in a tenth of cases."""
    random = np.random.default_rng(1)
    assert max(chance_of_wave(random, 9.0, 0.0) for _ in range(100)) < 1e-3


@pytest.mark.evidence
def test_waves_that_each_part_draws_anew_last_as_rarely_as_is_said() -> None:
    """One case in a hundred was one in five."""
    random = np.random.default_rng(2)
    found = [chance_of_wave(random, 0.0, 10.0) for _ in range(200)]
    assert np.sum(np.array(found) < 0.01) <= 16


def test_a_part_of_a_small_share_that_shows_the_pattern_by_itself_counts() -> None:
    """Two turns tell nearly all of a late clock, and two more show it: one by six deviations."""
    random = np.random.default_rng(1)
    parts = np.repeat(np.arange(4), 20)
    shares = np.array([0.84, 0.49, 0.2, 0.12])
    free = random.normal(size=parts.size)
    for part, share in enumerate(shares):
        free[parts == part] *= share / np.linalg.norm(free[parts == part])
    free /= np.linalg.norm(free)
    noise = random.normal(size=parts.size)

    def chance(of_others: float) -> float:
        rest = noise + 30.0 * free * np.where(parts < 2, 1.0, of_others)
        gain = float((free @ rest) ** 2)
        return _chance(gain, 1, free[:, None], free[:, None], rest, parts, rules.LASTING_NOISE - 4)

    assert 79 * chance(1.0) < 1e-3
    assert 79 * chance(0.0) > 1e-3


def late(seed: int, delay: float) -> Run:
    """Twelve slow seconds, seen to 6 mm and 12 mrad ten times a second by a clock that is off."""
    random = np.random.default_rng(seed)
    speed, rate = wandering(random, 12.0)
    commands = (0.5 * speed, 0.5 * rate)
    seen = drive(TRUE, commands, random, sigma_xy=0.006, sigma_yaw=0.012, every=5)
    poses = seen.reference
    late = Reference(poses.time + delay, poses.x, poses.y, poses.yaw)
    return replace(seen, name=f"drive_{seed}", reference=late)


@pytest.mark.parametrize("seed", [0, 40, *(in_evidence(10 * n) for n in (1, 2, 3, 5, 6, 7))])
def test_parts_of_a_short_drive_agree_on_a_delay_by_the_law_at_the_fit(seed: int) -> None:
    """At every start and stop a tenth of a second is more than its derivative at none says."""
    laid = concatenated(match_for_fit([late(seed, 0.1)], ROBOT, 0.25, None))
    before = fit_calibration(laid, ROBOT)
    delay = [effect for effect in LIBRARY if effect.name == "reference_delay"]
    (fit,) = search_round(laid, before, delay, ROBOT).tried
    assert fit.point.model.robot.effects[-1].values["delay"] == pytest.approx(0.1, abs=0.03)
    # By the derivative at no delay, 1.3e-3 and 1.1e-3 of seeds 0 and 20: left to chance.
    assert homogeneity_of_effect(laid, fit, fit.names[-1]) < 1e-4


@pytest.mark.parametrize("seed", [0, in_evidence(20)])
def test_a_delay_is_named_of_one_short_drive(seed: int) -> None:
    found = diagnose(
        [late(seed, 0.1)],
        ROBOT,
        COMMON,
        EvaluationOptions(leg=0.25),
        holdout=[late(seed + 1, 0.1)],
    )
    assert "reference_delay" in found.found


def regular(seed: int) -> Run:
    """Drives to and fro with spins, wheels as regular as a simulator's; a gyro finer than counts.

    A count of 0.7 mm is 1.4 mrad, and the gyro tells 0.3 mrad.
    """
    random = np.random.default_rng(seed)
    time = np.arange(0.0, 60.0, 0.02)
    spins = (time % 12.0) > 10.5
    window = np.convolve(np.ones(21), np.ones(21)) / 21**2
    ahead, about = (
        np.convolve(np.pad(speed, 20, mode="edge"), window, "valid")
        for speed in (
            np.where(spins, 0.0, np.clip(3.0 * np.sin(0.7 * time), -0.8, 0.8)),
            1.0 * spins,
        )
    )
    ways = [0.02 * (ahead + side * REGULAR.track * about) for side in (-1.0, 1.0)]
    true = [way + 4e-4 * np.sqrt(np.abs(way)) * random.normal(size=way.size) for way in ways]
    counts = [
        np.floor(np.cumsum(way) / REGULAR.left_tick + random.uniform()).astype(np.int64)
        for way in ways
    ]
    yaw = np.cumsum(true[1] - true[0]) / REGULAR.track
    seen = np.arange(2, time.size - 2, 5)
    wander = np.cumsum(1e-4 * random.normal(size=seen.size))
    told = np.interp(time[seen] + 0.004, time, yaw) + wander
    told += 2e-4 * random.normal(size=seen.size)
    nowhere = np.full(seen.size, np.nan)
    reference = Reference(time[seen] + 0.004, nowhere, nowhere, told)
    return Run(str(seed), Path(str(seed)), Ticks(time, *counts), reference)


REGULAR = Robot(0.53, 0.0825, 720.0, 720.0, left_wheel_noise=4e-4, right_wheel_noise=4e-4)


@pytest.mark.evidence
@pytest.mark.parametrize(
    ("seed", "amount", "variable"),
    [
        pytest.param(20, Amount("heading", "turn"), "yaw_rate_size", id="several times it"),
        pytest.param(44, Amount("along", "travel"), "speed", id="most of it"),
    ],
)
def test_a_law_of_the_turn_on_straight_drives_is_the_rounding_of_the_counts(
    seed: int, amount: Amount, variable: str
) -> None:
    """There counted turns and heading errors are the same roundings, and make no law."""
    options = EvaluationOptions(reference_kind="incremental")
    runs = concatenated(match_for_fit([regular(seed + each) for each in range(4)], REGULAR, 1.0))
    point = fit_calibration(runs, REGULAR, options).point
    cells = [
        cell
        for cell in dependences(runs, point, CALIBRATION)
        if (cell.amount, cell.variable.name) == (amount, variable)
    ]
    for told in lasting(runs, point, CALIBRATION, cells):
        assert told.p_value > rules.SURE, "it is nothing that a wheel does"


@pytest.mark.evidence
def test_axes_that_begin_anew_have_no_common_direction() -> None:
    """A path by scans begins at its first scan: a slope is none that two drives could show.

    It goes with the heading of each drive by itself. Where that was not looked at, the base, the
    castor and the turns of the wheels stood in for a slope.
    """

    def slopes(time: np.ndarray, random: np.random.Generator) -> np.ndarray:
        return np.outer(time, [0.004, 0.0, 0.0])

    runs = [driven(seed, slopes, f"drive_{seed}") for seed in range(90, 93)]
    effects = common("floor_slope", "anisotropic_floor")
    found = diagnose(runs[:2], ROBOT, effects, holdout=runs[2:])
    assert found.found == ("floor_slope",)
    anew = [replace(run, reference=replace(run.reference, own_axes=True)) for run in runs]
    found = diagnose(anew[:2], ROBOT, effects, holdout=anew[2:])
    assert "floor_slope" not in [item.effect for item in found.ranking]
    assert "position" not in [cell.variable.name for cell in found.depends_on]
    assert found.verdict == "unknown"
    strongest = found.depends_on[0]
    assert (strongest.channel, strongest.variable.name) == ("sideways", "heading")
    assert strongest.variable.per_run
    told = " ".join(unknown_words(AdvisedDiagnosis(found, None, ()), NextSteps()))
    assert "Motion capture or a localiser's map shows it." in told
    assert "werrimbi draft" not in told, "its law was worth 12.2 to 11.5 mm"
    given: Any = SimpleNamespace()
    assert "goes most with the heading, in each drive by a wave" in _known(found, given, "--force")
    assert json_of(found, None)["as_a_floor"]
    limits = {limit.effect: limit for limit in detection_limits(found, effects)}
    assert limits["floor_slope"].minimum_detectable == np.inf
    assert limits["lateral_slip"].minimum_detectable < 1.0
    said = " ".join(not_shown(AdvisedDiagnosis(found, None, tuple(limits.values()))))
    assert (
        "floor_slope and anisotropic_floor with such a reference; one that measures finely, in axes"
        in said
    )
