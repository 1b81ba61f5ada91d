# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Every set-up mistake, put into simulated drives, is found first; none where none is."""

from __future__ import annotations

import math
from collections.abc import Callable, Container, Iterable, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from test.evidence import in_evidence
from test.inference.driven import runs_of
from test.inference.set_up_mistakes import (
    DELAYS,
    ONE_SIDE,
    REFERENCE,
    SIZES,
    WIRING,
    Mistake,
    gyro,
    once_a_second,
    two_poses,
    without_yaw,
)
from test.model.drives import ROBOT
from test.white_noise_robot import WhiteNoiseRobot, drive, square
from werrimbi_odom.effects import find
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.run import Reference, Run, Ticks
from werrimbi_odom.files.run_folder import read_run_folder
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.calibration_parametrisation import effective_track
from werrimbi_odom.inference.comparison.leg_errors import errors_of, statistics
from werrimbi_odom.inference.diagnosis.splitting import set_aside
from werrimbi_odom.inference.diagnosis.step_jacobians import Amount
from werrimbi_odom.inference.drafting.candidate_law import loaded
from werrimbi_odom.inference.drafting.law_forms import Seen
from werrimbi_odom.inference.drafting.source import source_of
from werrimbi_odom.inference.drafting.spot import spot_form
from werrimbi_odom.inference.fitting.concatenated_runs import concatenated
from werrimbi_odom.inference.fitting.free_parameters import Model
from werrimbi_odom.inference.legs.cutting import match
from werrimbi_odom.inference.set_up.explanation import AS_ENTERED
from werrimbi_odom.inference.set_up.few_poses import _Drives, _settings
from werrimbi_odom.inference.set_up.findings import SetUpFinding
from werrimbi_odom.inference.set_up.records import cut, record_of
from werrimbi_odom.inference.set_up.search import SetUp, look_for_mistakes
from werrimbi_odom.model.effect import AppliedEffect
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.simulation import TrueRobot, drives, hide, record, write_run

NOMINAL = Robot(0.35, 0.05, 2000.0, 2000.0)
EVERY = {**WIRING, **SIZES, **ONE_SIDE, **REFERENCE, **DELAYS}
NAMES = ("train/square_ccw", "train/free_calm", "train/eights_and_spins")


def thinned(names: Iterable[Any], kept: Container[str]) -> list[Any]:
    """Names, of which those that are not kept are tried in `make evidence` alone."""
    return [
        in_evidence(name) if isinstance(name, str) and name not in kept else name for name in names
    ]


def sparse(names: Sequence[Any]) -> list[Any]:
    """Every other one of those that are not in `make evidence` already."""
    return thinned(names, [name for name in names if isinstance(name, str)][::2])


FACTORS_OF_ALL = [*SIZES, *ONE_SIDE]
THINNED = thinned(FACTORS_OF_ALL, FACTORS_OF_ALL[4::16])
"""Factors that poorer references are tried with."""
ALL = [*WIRING, *SIZES, *REFERENCE, *DELAYS, *ONE_SIDE]
EVERY_OTHER = thinned(
    ALL, [name for n, name in enumerate(ALL) if name not in FACTORS_OF_ALL or n % 4 < 1]
)
"""A quarter of all factors."""
MENDED = thinned(ALL, [*WIRING, *REFERENCE, *DELAYS, "base 2", "radius 1/2", "left counts 2 times"])
"""Mistakes whose mended robot is tried: one of each kind."""
WIRED = thinned(WIRING, ("swapped", "both reversed"))
MOUNT_90 = in_evidence("mount 90")
Search = Callable[[str], tuple[list[Run], SetUp]]


def recorded(folder: Path, *effects: str, names: Sequence[str] = NAMES) -> list[Run]:
    hidden = [hide(name, seed=3).peculiarity for name in effects]
    manoeuvres = drives(7)
    return [
        read_run_folder(
            write_run(
                record(TrueRobot(), manoeuvres[name], seed=40 + number, hidden=hidden),
                folder / Path(name).name,
            )
        )
        for number, name in enumerate(names)
    ]


@pytest.fixture(scope="module")
def session(tmp_path_factory: pytest.TempPathFactory) -> list[Run]:
    return recorded(tmp_path_factory.mktemp("session"))


def found(runs: list[Run], robot: Robot, mistake: Mistake) -> SetUp:
    tampered, wrong = mistake.made(runs, robot)
    return look_for_mistakes(tampered, wrong)


@pytest.fixture(scope="module")
def searched(session: list[Run]) -> Search:
    """What is found when a mistake is put into the session; searched for once."""

    @cache
    def search(name: str) -> tuple[list[Run], SetUp]:
        tampered, wrong = EVERY[name].made(session, NOMINAL)
        return tampered, look_for_mistakes(tampered, wrong)

    return search


def is_named(finding: SetUpFinding, mistake: Mistake) -> bool:
    return bool({finding.effect, *finding.twins} & set(mistake.names))


@pytest.mark.parametrize("name", EVERY_OTHER)
def test_a_mistake_is_found_first(searched: Search, name: str) -> None:
    mistake, first = EVERY[name], searched(name)[1].findings[0]
    assert is_named(first, mistake), first
    if mistake.factor is not None:
        assert first.factor == mistake.factor


@pytest.mark.parametrize("name", [name for name in MENDED if name != "degrees"])
def test_the_robot_that_comes_back_is_set_up_right(searched: Search, name: str) -> None:
    """What remains is for fits: some percent of a leg of half a metre."""
    tampered, result = searched(name)
    mended = result.robot
    metre = 1e3 if name == "millimetres" else 1.0
    for run in tampered:
        legs = concatenated([match(run, mended, 0.5 * metre)])
        errors = errors_of(Model(mended, ({},)), legs, 1e-3, 2e-3)
        assert statistics(errors).median_position_m < 0.02 * metre


def both(*mistakes: Mistake) -> Callable[[list[Run]], SetUp]:
    def look(runs: list[Run]) -> SetUp:
        robot = NOMINAL
        for mistake in mistakes:
            runs, robot = mistake.made(runs, robot)
        return look_for_mistakes(runs, robot)

    return look


def test_two_mistakes_at_once_are_both_found(session: list[Run]) -> None:
    mistakes = WIRING["left reversed"], SIZES["base 1/2"], REFERENCE["mount 90"]
    findings = both(*mistakes)(session).findings
    assert {each.effect for each in findings} == {
        "left_wheel_reversed",
        "track_width",
        "reference_yaw_offset",
    }


@pytest.mark.evidence
def test_millimetres_are_told_beside_half_a_base_and_swapped_wheels(session: list[Run]) -> None:
    mistakes = WIRING["swapped"], SIZES["base 2"], REFERENCE["millimetres"]
    found = both(*mistakes)([without_yaw(run) for run in session])
    assert found.to_convert is not None
    assert "millimetres" in found.to_convert
    assert both(*mistakes[:2])(session).to_convert is None


@pytest.mark.parametrize(
    ("unit", "size"),
    [
        ("centimetres", 100.0),
        in_evidence("inches", 39.3701),
        in_evidence("feet", 3.28084),
    ],
)
@pytest.mark.parametrize("poses", [in_evidence(True), False])
def test_positions_in_another_unit_are_to_be_converted(
    session: list[Run], unit: str, size: float, poses: bool
) -> None:
    made = Mistake((), reference=lambda r: replace(r, x=size * r.x, y=size * r.y))
    runs = session if poses else [without_yaw(run) for run in session]
    words = both(made)(runs).to_convert
    assert words is not None
    assert f"in {unit}" in words
    assert f"divide by {size:g}" in words


@pytest.mark.parametrize(
    ("unit", "counts"),
    [
        ("radians", 2.0 * math.pi),
        ("degrees", 360.0),
        ("millimetres", 100.0 * math.pi),
        ("metres", 0.1 * math.pi),
        ("turns", 1.0),
    ],
)
def test_counters_in_another_unit_are_told_with_their_counts_of_a_turn(
    session: list[Run], unit: str, counts: float
) -> None:
    per_count = counts / NOMINAL.left_ticks_per_revolution
    made = Mistake(
        (), ticks=lambda t: replace(t, left=per_count * t.left, right=per_count * t.right)
    )
    found = both(made)(session)
    words = f"left_ticks_per_revolution: {counts:.6g} ({unit})"
    assert words in found.findings[0].words
    # No fit starts from a wheel that is thousands of times too large.
    assert (found.to_convert is not None) == (unit in ("metres", "turns"))


def test_wiring_is_told_before_sizes(session: list[Run]) -> None:
    """Whichever of them makes the larger errors, for that hangs on how often there is a pose."""
    assert (
        both(WIRING["swapped"], SIZES["base 1/4"])(session).findings[0].effect == "wheels_swapped"
    )
    assert both(WIRING["swapped"], SIZES["base 2"])(session).findings[0].effect == "wheels_swapped"


def test_an_effect_that_the_file_holds_already_is_changed_not_doubled(session: list[Run]) -> None:
    held = Robot(
        0.35,
        0.05,
        2000.0,
        2000.0,
        effects=(
            find("reference_yaw_offset").using(angle=1.0),
            AppliedEffect(find("wheels_swapped")),
        ),
    )
    turned, _ = REFERENCE["mount 90"].made(session, held)
    mended = look_for_mistakes(turned, held).robot
    assert [each.name for each in mended.effects] == ["reference_yaw_offset"]
    assert mended.effects[0].values["angle"] == pytest.approx(math.pi / 2, abs=0.01)


# -- nothing wrong ------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "effect",
    [
        in_evidence("reference_lever_arm"),
        "reference_delay",
        in_evidence("reference_yaw_offset"),
        in_evidence("floor_slope"),
        in_evidence("turn_dependent_track"),
        in_evidence("track_width"),
        in_evidence("left_missed_ticks"),
        in_evidence("slippery_spot"),
    ],
)
def test_an_ordinary_effect_is_no_mistake(tmp_path: Path, effect: str) -> None:
    runs = recorded(tmp_path, effect, names=["train/free_calm"])
    for poorer in (list, without_yaw, gyro, once_a_second, two_poses):
        poor = runs if poorer is list else [poorer(run) for run in runs]
        assert look_for_mistakes(poor, NOMINAL).findings == ()


def test_a_set_up_that_is_right_comes_back_as_it_is(session: list[Run]) -> None:
    assert look_for_mistakes(session, NOMINAL) == SetUp((), NOMINAL)


@pytest.mark.parametrize("seed", range(2))
def test_stamps_of_one_slow_loop_are_no_other_clock(seed: int) -> None:
    """One loop reads wheels and lidar, and both come late together: the file's delay stays right.

    From one reading to the next the two have their lateness in common, at no lag at all.
    """
    runs = [of_one_loop(run, 0.35, number) for number, run in enumerate(runs_of(ROBOT, (seed, 9)))]
    robot = replace(ROBOT, effects=(find("reference_delay").using(delay=0.35),))
    assert look_for_mistakes(runs, robot).findings == ()


def of_one_loop(run: Run, late: float, seed: int) -> Run:
    """Counts and poses read every 0.15 s, stamped up to 0.25 s later, and the poses `late` [s]."""
    reference, random = run.reference, np.random.default_rng(seed)
    assert reference is not None
    read = np.arange(reference.time[0] + late, reference.time[-1], 0.15)
    stamps = np.sort(read + random.uniform(0.0, 0.25, read.size))
    poses = (reference.x, reference.y, np.unwrap(reference.yaw))
    seen = (np.interp(read - late, reference.time, each) for each in poses)
    counts = (np.interp(read, run.ticks.time, each) for each in (run.ticks.left, run.ticks.right))
    return replace(run, ticks=Ticks(stamps, *counts), reference=Reference(stamps, *seen))


def test_a_reference_of_something_else_claims_nothing(session: list[Run]) -> None:
    """Poses of another drive: no set-up makes these wheels go there."""
    first, second, third = (run.reference for run in session)
    wrong = [
        Run(run.name, run.path, run.ticks, reference)
        for run, reference in zip(session, (second, third, first), strict=True)
    ]
    assert look_for_mistakes(wrong, NOMINAL).findings == ()


# -- poorer references --------------------------------------------------------------------------


@pytest.mark.parametrize("name", [*WIRED, *THINNED, *sparse([*DELAYS]), "mount 90", "millimetres"])
def test_once_a_second_is_enough(session: list[Run], name: str) -> None:
    mistake = EVERY[name]
    first = found([once_a_second(run) for run in session], NOMINAL, mistake).findings[0]
    assert is_named(first, mistake), first


@pytest.mark.parametrize(
    "name",
    [*sparse([*WIRED, *THINNED]), in_evidence("clock 2.0 s late"), in_evidence("millimetres")],
)
def test_positions_alone_show_wiring_and_sizes(session: list[Run], name: str) -> None:
    mistake = EVERY[name]
    first = found([without_yaw(run) for run in session], NOMINAL, mistake).findings[0]
    assert is_named(first, mistake), first


@pytest.mark.parametrize("name", [*WIRED, *THINNED, "clock 2.0 s late"])
def test_a_gyro_shows_wiring_and_radius_over_base(session: list[Run], name: str) -> None:
    mistake = {**WIRING, **SIZES, **ONE_SIDE, **DELAYS}[name]
    findings = found([gyro(run) for run in session], NOMINAL, mistake).findings
    if name == "file in millimetres":  # radius over base is right
        assert findings == ()
    else:
        assert is_named(findings[0], mistake), findings


def test_a_gyro_does_not_show_a_mount(session: list[Run]) -> None:
    runs, robot = REFERENCE["mount 90"].made(session, NOMINAL)
    assert look_for_mistakes([gyro(run) for run in runs], robot).findings == ()


@pytest.mark.parametrize("name", [*sparse([*WIRED, *THINNED]), in_evidence("mount 180"), MOUNT_90])
def test_two_poses_a_drive_name_it_or_claim_nothing(session: list[Run], name: str) -> None:
    mistake = {**WIRING, **SIZES, **ONE_SIDE, **REFERENCE}[name]
    findings = found([two_poses(run) for run in session], NOMINAL, mistake).findings
    assert not findings or is_named(findings[0], mistake), findings


@pytest.mark.parametrize(
    "name", thinned(("swapped", "left reversed", "radius 2", "base 1/2"), ("swapped", "base 1/2"))
)
def test_two_poses_a_drive_name_the_commonest(session: list[Run], name: str) -> None:
    mistake = {**WIRING, **SIZES}[name]
    assert found([two_poses(run) for run in session], NOMINAL, mistake).findings


@pytest.mark.evidence
def test_drives_there_and_back_make_no_set_up_likelier(session: list[Run]) -> None:
    """They end where they began with any wheels; one that spins was told of lost counts."""
    random = np.random.default_rng(1046)

    def there_and_back(run: Run) -> Run:
        out = np.arange(run.ticks.time.size // 2)
        rows, ticks = np.concatenate([out, out[::-1]]), run.ticks
        time = ticks.time[: rows.size]
        ends = Reference(time[[0, -1]], *(0.002 * random.standard_normal((3, 2))))
        ticks = replace(ticks, time=time, left=ticks.left[rows], right=ticks.right[rows])
        return replace(run, ticks=ticks, reference=ends)

    runs = [there_and_back(run) for run in session]
    records = [
        each
        for run in runs
        if (each := record_of(run, NOMINAL, EvaluationOptions().limits)) is not None
    ]
    drives = _Drives(cut(records, NOMINAL, "pose"), effective_track(NOMINAL), True)
    likeliest = max(drives.fits(each) for each in _settings())
    assert likeliest < drives.fits(AS_ENTERED) + rules.SPARSE_MARGIN


def test_one_window_of_noisy_positions_shows_no_mistake() -> None:
    """A lap of a square by positions of 0.1 m: a base of four times, and one wheel of a quarter.

    Three sizes were fitted to the positions of one window, whose errors go together.
    """
    random = np.random.default_rng([1045, 11])
    drawn = random.uniform(size=6)
    noise = 1.5e-4 * (2e-3 / 1.5e-4) ** drawn[2]
    wheel, ratio = 0.02 + 0.08 * drawn[1], 0.7 + 0.7 * drawn[5]
    true = WhiteNoiseRobot(0.15 + 0.45 * drawn[0], wheel, wheel, noise, ratio * noise, 2520.0)
    random.choice(4), random.uniform(size=2)
    lap = square(random.uniform(0.6, 1.5), random.choice([-1, 1]))
    still = np.zeros(25)
    random.uniform(), random.choice(5), random.uniform()
    sigma = random.uniform(0.02, 0.3)
    commands = tuple(np.concatenate([still, part, still]) for part in lap)
    run = drive(true, (commands[0], commands[1]), random, sigma_xy=sigma, every=10)
    assert run.reference is not None
    run.reference.yaw[:] = np.nan
    fitted, _ = set_aside((run,))
    assert look_for_mistakes(fitted, true.entered(wheel)).findings == ()


def test_no_reference_no_findings(session: list[Run]) -> None:
    bare = [Run(run.name, run.path, run.ticks) for run in session]
    assert look_for_mistakes(bare, NOMINAL) == SetUp((), NOMINAL)
    blank = [without_yaw(run) for run in session]
    for run in blank:
        assert run.reference is not None
        run.reference.x[:] = np.nan
    assert look_for_mistakes(blank, NOMINAL) == SetUp((), NOMINAL)


def test_an_effect_of_the_file_that_looks_at_the_place_is_no_hindrance() -> None:
    """Nobody knows where the robot is before its set-up is known: the effect is left as it is."""
    form = spot_form([(0.2, 0.1)], (0.4,), -0.1, 0.175)
    seen = Seen("position", "m", lambda side: "")
    amount = Amount("along", "travel")
    spot = loaded(source_of("slippery_spot", amount, seen, form, 4, "p = 1e-9"))
    plain = Robot(0.35, 0.05, 2000.0, 2000.0)
    robot = replace(plain, effects=(spot.using(share=-0.1, x=0.2, y=0.1, radius=0.4),))
    assert look_for_mistakes(runs_of(robot, (1, 2)), robot).findings == ()


# -- headings in degrees ------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("base", "late"),
    [(0.35, 0.0), (0.175, 1.5), in_evidence(0.35, 1.5), in_evidence(0.175, 0.0)],
)
def test_headings_in_degrees_that_never_wrap(session: list[Run], base: float, late: float) -> None:
    """A gyro's rates are summed up, and nobody wraps the sum: it was told as a radius 57 times."""
    runs = [summed_in_degrees(gyro(run), late) for run in session]
    found = look_for_mistakes(runs, replace(NOMINAL, wheel_separation=base))
    assert found.findings[0].effect == "reference_yaw_in_degrees"
    assert found.to_convert is not None


def summed_in_degrees(run: Run, late: float) -> Run:
    assert run.reference is not None
    yaw = np.degrees(np.unwrap(run.reference.yaw))
    return replace(run, reference=replace(run.reference, yaw=yaw, time=run.reference.time + late))


@pytest.mark.parametrize("radius", [0.05, 0.05 / math.degrees(1.0), 0.05 * math.degrees(1.0)])
def test_headings_in_radians_that_never_wrap(session: list[Run], radius: float) -> None:
    runs = [summed_in_degrees(gyro(run), 0.0) for run in session]
    for run in runs:
        assert run.reference is not None
        run.reference.yaw[:] = np.radians(run.reference.yaw)
    found = look_for_mistakes(runs, replace(NOMINAL, wheel_radius=radius))
    assert [each.effect for each in found.findings] == ["wheel_radius_scale"] * (radius != 0.05)
