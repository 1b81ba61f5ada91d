# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A reference of another drive tells nothing of the robot, and then nothing is told."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st

from test.evidence import in_evidence
from test.inference.driven import COMMON
from test.white_noise_robot import WhiteNoiseRobot, drive, wandering
from werrimbi_odom.api.drives import read_robot
from werrimbi_odom.effects import Collection
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.recordings import DriveOptions, Recordings
from werrimbi_odom.files.run import Reference, Run, Ticks
from werrimbi_odom.inference.comparison.compare import compare
from werrimbi_odom.inference.manoeuvres.advice import AdvisedDiagnosis, advised_diagnosis
from werrimbi_odom.report.diagnosis.next_steps import NextSteps
from werrimbi_odom.report.diagnosis.words import words_of

TRUE = WhiteNoiseRobot()
ROBOT = TRUE.entered(0.05)


def driven(seed: int) -> Run:
    """Half a minute with curves, as it was."""
    random = np.random.default_rng(seed)
    seen = drive(TRUE, wandering(random, 30.0, 25.0), random, every=2, hertz=25.0)
    return Run(f"drive_{seed}", Path(f"drive_{seed}"), seen.ticks, seen.reference)


def with_reference_of(run: Run, other: Run, keep: Callable[[Reference], Reference]) -> Run:
    assert other.reference is not None
    return replace(run, reference=keep(other.reference))


def poses(reference: Reference) -> Reference:
    return reference


def headings(reference: Reference) -> Reference:
    nowhere = np.full(reference.time.size, np.nan)
    return replace(reference, x=nowhere, y=nowhere)


def positions(reference: Reference) -> Reference:
    return replace(reference, yaw=np.full(reference.time.size, np.nan))


FILE = Path(__file__).parents[2] / "config" / "robot.yaml"


def diagnosed(*runs: Run, holdout: tuple[Run, ...] = ()) -> AdvisedDiagnosis:
    """By the robot above; the file stands for the one that was read."""
    return advised_diagnosis(
        Recordings(read_robot(FILE), Collection(COMMON), runs, holdout, DriveOptions(), ROBOT)
    )


def spoken(advised: AdvisedDiagnosis) -> str:
    return "\n".join(each.text for each in words_of(advised, NextSteps()))


MEASURED = pytest.mark.parametrize(
    "keep",
    [
        headings,
        in_evidence(poses),
        in_evidence(positions),
    ],
)


@MEASURED
def test_the_reference_of_another_drive_is_said_to_be_that(
    keep: Callable[[Reference], Reference],
) -> None:
    runs = [with_reference_of(driven(seed), driven(seed + 10), keep) for seed in (1, 2)]
    told = diagnosed(*runs, holdout=(driven(4),))
    assert (told.diagnosis.verdict, told.diagnosis.found) == ("unknown", ())
    assert told.diagnosis.of_another_drive
    words = spoken(told)
    assert "nothing in common" in words
    assert "On the robot" not in words


@pytest.mark.evidence
@pytest.mark.parametrize("noise", [0.0, 1e-5])
def test_a_gyro_that_is_dead_is_said_to_show_no_turn(noise: float) -> None:
    random = np.random.default_rng(5)

    def dead(reference: Reference) -> Reference:
        still = 5e-4 * (reference.time - reference.time[0]) * (noise > 0.0)
        drift = np.cumsum(random.normal(0.0, noise, still.size))
        return replace(headings(reference), yaw=still + drift, kind="incremental")

    runs = [with_reference_of(driven(seed), driven(seed), dead) for seed in (1, 2)]
    told = diagnosed(*runs, holdout=(driven(4),))
    assert told.diagnosis.of_another_drive
    words = spoken(told)
    assert "shows next to no turn" in words
    assert "turn the robot by hand" in words
    assert "another drive" not in words


@pytest.mark.evidence
@MEASURED
def test_that_of_this_drive_is_not(keep: Callable[[Reference], Reference]) -> None:
    runs = [with_reference_of(driven(seed), driven(seed), keep) for seed in (1, 2)]
    assert not diagnosed(*runs, holdout=(driven(4),)).diagnosis.of_another_drive


@pytest.mark.evidence
def test_where_only_the_turns_are_right_it_is_said_of_the_places() -> None:
    """A tracker that is lost and a lidar that slides still turn with the robot."""

    def lost(reference: Reference) -> Reference:
        random = np.random.default_rng(7)
        x, y = np.cumsum(random.normal(0.0, 0.3, (2, reference.time.size)), axis=1)
        return replace(reference, x=x, y=y)

    runs = [with_reference_of(driven(seed), driven(seed), lost) for seed in (1, 2)]
    told = diagnosed(*runs, holdout=(with_reference_of(driven(4), driven(4), lost),))
    assert (told.diagnosis.verdict, told.diagnosis.found) == ("unknown", ())
    words = spoken(told)
    assert "nothing in common" not in words
    assert "turns as the wheels do, but goes elsewhere" in words
    assert "of the same drive" not in words


def test_wheels_that_stand_are_told_before_any_work() -> None:
    run = driven(1)
    stood = replace(run.ticks, left=0 * run.ticks.left, right=0 * run.ticks.right)
    with pytest.raises(InputError, match="the wheels stood all the time"):
        diagnosed(replace(run, ticks=stood))
    # To a reference that is exact to the last digit, no leg has any variance.
    assert run.reference is not None
    nowhere = 0 * run.reference.x
    still = replace(run.reference, x=nowhere, y=nowhere, yaw=nowhere)
    with pytest.raises(InputError, match="the wheels stood all the time"):
        compare([replace(run, ticks=stood, reference=still)], ROBOT)


def straight(seed: int) -> Run:
    """A metre along a line, begun and ended standing, with a radius that is entered nine times."""
    random = np.random.default_rng(seed)
    time = np.arange(0.0, 17.0, 0.1)
    way = 0.1 * np.clip(time - 1.0, 0.0, 11.0)
    counts = np.rint(way / (0.11 * ROBOT.left_tick))
    along = way * np.exp(1j * (seed - 0.035))
    place = along + 5e-4 * (random.normal(size=time.size) + 1j * random.normal(size=time.size))
    yaw = seed + random.normal(0.0, 2e-3, way.size)
    ticks = Ticks(time, counts, counts + np.rint(0.01 * counts))
    reference = Reference(time, place.real, place.imag, yaw)
    return Run(f"line_{seed}", Path(f"line_{seed}"), ticks, reference)


@pytest.mark.evidence
def test_a_radius_nine_times_off_on_a_line_is_not_the_reference_of_another_drive() -> None:
    words = " ".join(spoken(diagnosed(*(straight(seed) for seed in (1, 2, 3)))).split())
    assert "nothing in common" not in words
    assert "wheel_radius is 0.11 times what is entered" in words
    assert "mend that in the robot file" in words


N = 300


def ways(random: np.random.Generator, kind: str) -> np.ndarray:
    """Three columns of anything, (N, 3), of the size of a drive of six seconds."""
    time = np.arange(N) * 0.02
    return {
        "walk": np.cumsum(random.normal(size=(N, 3)), axis=0) * 0.02,
        "white": random.normal(size=(N, 3)),
        "still": np.zeros((N, 3)),
        "steady": np.outer(time, random.normal(size=3)),
        "circle": np.stack([np.cos(time), np.sin(time), time], axis=1),
        "jumps": np.cumsum((random.random((N, 3)) < 0.02) * random.normal(size=(N, 3)), axis=0),
        "huge": np.cumsum(random.normal(size=(N, 3)), axis=0) * [1e4, 1e4, 1.0],
    }[kind]


ANYTHING = st.sampled_from(["walk", "white", "still", "steady", "circle", "jumps", "huge"])
LARGEST = 1e7
"""No number of the data above is larger: a reference of kilometres in mm."""


@pytest.mark.evidence
@settings(max_examples=3, deadline=None, phases=[Phase.generate])
@given(st.integers(0, 10**6), ANYTHING.filter(lambda kind: kind != "huge"), ANYTHING,
       st.sampled_from([poses, headings, positions]))  # fmt: skip
def test_of_nonsense_no_size_is_told_that_did_not_occur(
    seed: int, wheels: str, measured: str, keep: Callable[[Reference], Reference]
) -> None:
    random = np.random.default_rng(seed)
    counts = np.rint(ways(random, wheels) / ROBOT.left_tick).astype(np.int64)
    x, y, yaw = ways(random, measured)[::5].T
    time = np.arange(N) * 0.02
    run = Run(
        "nonsense", Path("nonsense"), Ticks(time, counts[:, 0], counts[:, 1]),
        keep(Reference(time[::5], x, y, yaw)),
    )  # fmt: skip
    try:
        words = spoken(diagnosed(run))
    except InputError as error:
        words = str(error)
    numbers = [float(each) for each in re.findall(r"\d+(?:\.\d+)?(?:e[+-]?\d+)?", words)]
    assert max(map(abs, numbers), default=0.0) < LARGEST, words
    assert not re.search(r"\b(nan|inf)\b", words), words
