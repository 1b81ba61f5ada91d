# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What comes at once at each start is a law of the robot, though none that a file could hold."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from test.white_noise_robot import RATE, WhiteNoiseRobot, drive
from werrimbi_odom.effects import find
from werrimbi_odom.files.run import Reference, Run
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis, diagnose
from werrimbi_odom.inference.diagnosis.no_noise import with_what_is_no_noise
from werrimbi_odom.inference.manoeuvres.advice import AdvisedDiagnosis
from werrimbi_odom.inference.manoeuvres.next_manoeuvre import next_manoeuvre
from werrimbi_odom.report.diagnosis.as_json import json_of
from werrimbi_odom.report.diagnosis.next_steps import NextSteps
from werrimbi_odom.report.diagnosis.words import words_of
from werrimbi_odom.report.events import events_words
from werrimbi_odom.report.terminal import as_text

TRUE = WhiteNoiseRobot(0.35, 0.05, 0.05, 3e-4, 3e-4)
EFFECTS = [find("unequal_wheel_radii"), find("longitudinal_slip")]
"""None turns a robot as it sets off."""
KICK = 0.008
"""By how much the robot is turned as it sets off [rad]: to the one side or the other."""


def setting_off(seed: int) -> Run:
    """Hops of some seconds with rests between; as each begins the robot is turned."""
    random = np.random.default_rng(seed)
    speeds, rates, starts = [], [], []
    for _ in range(7):
        way = random.choice([-1.0, 1.0])
        hop, rest = int(random.uniform(3.0, 6.0) * RATE), int(2.0 * RATE)
        side = random.choice([-1.0, 1.0])
        starts.append((sum(part.size for part in speeds) + rest, side))
        ramp = np.minimum(1.0, np.arange(hop) / 15.0) * np.minimum(1.0, np.arange(hop)[::-1] / 15.0)
        speeds += [np.zeros(rest), way * random.uniform(0.25, 0.4) * ramp]
        rates += [np.zeros(rest), random.choice([-0.5, 0.0, 0.5]) * ramp]
    commands = (np.concatenate(speeds), np.concatenate(rates))
    seen = drive(TRUE, commands, random, sigma_xy=4e-4, sigma_yaw=1e-3, every=2)
    assert seen.reference is not None
    for row, side in starts:
        seen = replace(seen, reference=_turned(seen.reference, (row + 8) / RATE, side * KICK))
    return replace(seen, name=f"{seed}", path=Path(f"{seed}"))


def _turned(seen: Reference, at: float, turn: float) -> Reference:
    """As if the robot had been turned within a tenth of a second."""
    after = np.clip((seen.time - at) / 0.1, 0.0, 1.0)
    place = seen.x + 1j * seen.y
    pivot = place[int(np.argmax(after > 0.0))]
    place = pivot + np.exp(1j * turn * after) * (place - pivot)
    return replace(seen, x=place.real, y=place.imag, yaw=seen.yaw + turn * after)


@pytest.fixture(scope="module")
def found() -> Diagnosis:
    return diagnose([setting_off(seed) for seed in range(3)], TRUE.entered(0.05), EFFECTS)


def test_what_comes_at_each_start_is_no_noise(found: Diagnosis) -> None:
    """It was "nothing is missing", below it "a law that the model does not hold"."""
    assert found.happened.alike is not None
    assert found.happened.alike.what == "start or stop"
    assert (found.verdict, found.found, found.by_events) == ("unknown", (), True)


def test_its_words_and_its_next_step_say_the_same(found: Diagnosis) -> None:
    move = next_manoeuvre(found)
    assert move is not None
    assert move.name == "start_stop"
    told = " ".join(as_text(words_of(AdvisedDiagnosis(found, move, ()), NextSteps())).split())
    assert "with a start or a stop, and turns the robot by 0." in told
    assert "of a castor, of free play" in told
    assert "longitudinal_slip" not in told  # which turns no robot
    assert "(start_stop)" in told
    assert "nothing to add" not in told
    assert "Nothing is missing" not in told
    assert "werrimbi draft --" not in told
    written = json_of(found, move)
    assert (written["verdict"], written["by_events"]) == ("unknown", True)
    assert written["next_manoeuvre"]["name"] == "start_stop"


def test_what_may_be_the_reference_s_or_the_floor_s_proves_no_law(found: Diagnosis) -> None:
    nothing = replace(found, verdict="none", by_events=False)
    events = found.happened
    assert events.alike is not None
    jumps = tuple(replace(event, channel="reference") for event in events.events)
    place = replace(events.alike, what="place", at=(1.0, math.pi))
    for other in (
        replace(events, kind="local_map"),  # corrects itself as the robot sets off
        replace(events, events=jumps),
        replace(events, alike=place),
    ):
        assert with_what_is_no_noise(nothing, other).verdict == "none"
        told = " ".join(events_words(other, found.robot.track))
        assert "is a law that" not in told  # "there is nothing to add" stands below it
    assert with_what_is_no_noise(nothing, events).verdict == "unknown"
