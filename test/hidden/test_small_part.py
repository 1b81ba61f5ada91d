# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A fixed part of the proof, on short sessions made anew each time: what is hidden is found.

Long, as is all of it, with shares over hundreds of sets: `make evidence`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cache, partial

import pytest

from test.hidden.followed_to_rest import at_the_truth, without_detour
from test.hidden.result_line import Judged
from test.hidden.rules import named_mistake, plainly_calibration
from test.hidden.set_judging import judged
from test.hidden.sets import HiddenSet

pytest.importorskip("mujoco", reason="hidden sets need the physics engine (pip install mujoco)")

EFFECT = HiddenSet("effect", ("castor_kick=0.02",), 21, "short")
CLEAN = HiddenSet("clean", (), 11, "short")
CALIBRATION = HiddenSet("calibration", ("track_width=1.02",), 12, "short")
OUTSIDER = HiddenSet("outsider", ("base_by_payload=0.006",), 11, "short")
TWO = HiddenSet("pair", ("reference_delay=0.06", "castor_kick=0.025"), 13, "short")
MISTAKE = HiddenSet("mistake", ("right_wheel_reversed",), 14, "short")

Judge = Callable[..., Judged]


@pytest.fixture(scope="module")
def judge(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Judge]:
    """Makes a set and judges it, once."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("WERRIMBI_HIDDEN", str(tmp_path_factory.mktemp("hidden")))
        yield cache(partial(judged, floors=False))


@pytest.mark.evidence
def test_an_effect_is_named_and_adding_it_reaches_the_floor(judge: Judge) -> None:
    """What is printed is followed to its end; test_command_line does so in `make test`."""
    line = judge(EFFECT, floors=True)
    assert line.verdict == "named", line
    assert line.effect == EFFECT.names[0]
    assert line.raised > 1.1, "else nothing is shown"
    assert line.added is not None
    assert line.floor is not None
    assert line.added < 1.25 * line.floor
    assert at_the_truth(line), "the printed commands, followed to the end"
    assert without_detour(line)
    assert line.mean_is_right, "compare agrees with the diagnosis"


@pytest.mark.evidence
def test_where_nothing_is_hidden_nothing_is_found(judge: Judge) -> None:
    line = judge(CLEAN)
    assert (line.verdict, line.effect, line.found) == ("none", None, ())


@pytest.mark.evidence
def test_a_wrong_base_is_calibration_and_nothing_else(judge: Judge) -> None:
    line = judge(CALIBRATION)
    assert line.verdict == "named"
    assert plainly_calibration(line), line


@pytest.mark.evidence
def test_two_effects_are_found_one_after_the_other(judge: Judge) -> None:
    line = judge(TWO)
    assert set(line.found) == {"reference_delay", "castor_kick"}, line
    assert line.after is not None
    assert line.before is not None
    assert line.after < 0.2 * line.before


@pytest.mark.evidence
def test_a_set_up_mistake_leads(judge: Judge) -> None:
    assert named_mistake(judge(MISTAKE)), judge(MISTAKE)


@pytest.mark.evidence
def test_what_the_library_does_not_hold_is_unknown_and_depends_on_the_load(
    judge: Judge,
) -> None:
    line = judge(OUTSIDER)
    assert line.verdict == "unknown", line
    assert line.depends_on[0][1] == "payload_kg"
