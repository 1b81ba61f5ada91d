# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A fixed part of the proof, on short sessions made anew each time: what is hidden is found.

All of it, with shares over hundreds of sets, is `make evidence`.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import pytest

from test.hidden.judge import judged
from test.hidden.judged import Judged
from test.hidden.rest import at_the_truth, without_detour
from test.hidden.rules import named_mistake, plainly_calibration
from test.hidden.sets import HiddenSet

pytest.importorskip("mujoco", reason="hidden sets need the physics engine (pip install mujoco)")

EFFECTS = ("castor_kick=0.02",)
CLEAN = HiddenSet("clean", (), 11, "short")
CALIBRATION = HiddenSet("calibration", ("track_width=1.02",), 12, "short")
OUTSIDER = HiddenSet("outsider", ("radius_follows_payload=0.004",), 11, "short")
TWO = HiddenSet("pair", ("reference_delay=0.06", "castor_kick=0.025"), 13, "short")
MISTAKE = HiddenSet("mistake", ("right_wheel_reversed",), 14, "short")
SINGLE = tuple(
    HiddenSet("effect", (effect,), 21 + number, "short") for number, effect in enumerate(EFFECTS)
)
ALL = (*SINGLE, CLEAN, CALIBRATION, TWO, MISTAKE, OUTSIDER)
WITH_FLOORS = SINGLE
"""Sets of which the best that can be had is looked for too; it costs as much as the diagnosis."""


@pytest.fixture(scope="module")
def lines(tmp_path_factory: pytest.TempPathFactory) -> Iterator[dict[HiddenSet, Judged]]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("WERRIMBI_HIDDEN", str(tmp_path_factory.mktemp("hidden")))
        patch.setenv("OPENBLAS_NUM_THREADS", "1")
        # Spawned, not forked: other tests may have left threads here.
        with ProcessPoolExecutor(os.cpu_count(), mp_context=get_context("spawn")) as pool:
            jobs = {each: pool.submit(judged, each, floors=each in WITH_FLOORS) for each in ALL}
            yield {each: job.result() for each, job in jobs.items()}


@pytest.mark.parametrize("hidden", SINGLE, ids=EFFECTS)
def test_an_effect_is_named_and_adding_it_reaches_the_floor(
    lines: dict[HiddenSet, Judged], hidden: HiddenSet
) -> None:
    line = lines[hidden]
    assert line.verdict == "named", line
    assert line.effect == hidden.names[0]
    assert line.raised > 1.1, "else nothing is shown"
    assert line.added is not None
    assert line.floor is not None
    assert line.added < 1.25 * line.floor
    assert at_the_truth(line), "the printed commands, followed to the end"
    assert without_detour(line)
    assert line.mean_is_right, "compare agrees with the diagnosis"


def test_where_nothing_is_hidden_nothing_is_found(lines: dict[HiddenSet, Judged]) -> None:
    line = lines[CLEAN]
    assert (line.verdict, line.effect, line.found) == ("none", None, ())


def test_a_wrong_base_is_calibration_and_nothing_else(lines: dict[HiddenSet, Judged]) -> None:
    line = lines[CALIBRATION]
    assert line.verdict == "named"
    assert plainly_calibration(line), line


def test_two_effects_are_found_one_after_the_other(lines: dict[HiddenSet, Judged]) -> None:
    line = lines[TWO]
    assert set(line.found) == {"reference_delay", "castor_kick"}, line
    assert line.after is not None
    assert line.before is not None
    assert line.after < 0.2 * line.before


def test_a_set_up_mistake_leads(lines: dict[HiddenSet, Judged]) -> None:
    assert named_mistake(lines[MISTAKE]), lines[MISTAKE]


def test_what_the_library_does_not_hold_is_unknown_and_depends_on_the_load(
    lines: dict[HiddenSet, Judged],
) -> None:
    line = lines[OUTSIDER]
    assert line.verdict == "unknown", line
    assert line.depends_on[0][1] == "payload_kg"
