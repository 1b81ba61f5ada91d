# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What goes to the worker and back is what was sent; effects go by name, a user's own too."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from werrimbi_odom.effects.lookup import all_effects
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.workbench.pickling import packed, unpacked

OWN = '''
from dataclasses import replace
from werrimbi_odom.model.effect import Parameter, body_effect

@body_effect(rate=Parameter("1/m", 0.0, 1e-3, (-0.1, 0.1), "what it is"))
def my_own(motion, drive, rate):
    """Something of mine.

    Formula    sideways += rate * along
    Signature  none
    Ruler      none
    """
    return replace(motion, sideways=motion.sideways + rate * motion.along)
'''


def test_a_robot_with_effects_arrives_as_it_was(tmp_path: Path) -> None:
    file = tmp_path / "own.py"
    file.write_text(OWN)
    here, there = all_effects([file]), all_effects([file])
    robot = Robot(0.35, 0.05, 2000.0, 2000.0)
    effects = (here.find("my_own").using(rate=0.01), here.find("lateral_slip").using(creep=0.002))
    robot = replace(robot, effects=effects)
    arrived = unpacked(packed(robot, {}), there, {})
    assert [item.name for item in arrived.effects] == ["my_own", "lateral_slip"]
    assert arrived.effects[0].effect is there.find("my_own"), "the code of the other side"
    assert arrived.effects[0].values == {"rate": 0.01}
    assert replace(arrived, effects=()) == replace(robot, effects=())


def test_what_both_have_is_not_sent() -> None:
    collection = all_effects([])
    mine, theirs = np.zeros(100_000), np.ones(100_000)
    data = packed(("result", mine), {"drives": mine})
    assert len(data) < 1000
    assert unpacked(data, collection, {"drives": theirs})[1] is theirs


def test_what_is_remembered_of_laws_stays_behind() -> None:
    """A diagnosis with a candidate's prediction in memory could not be sent: no verdict came."""
    collection = all_effects([])
    whole, few = np.zeros(2, dtype=np.intp), np.zeros((1, 3))
    runs = Concatenated(
        runs=(), steps=whole, legs=whole, begin=whole[:1], end=whole[:1], run_of_leg=whole[:1],
        start=few, finish=few, intervals=few[0, :1], duration=few[0, :1],
        gap=np.zeros(1, dtype=np.bool_), stepped=np.zeros(1, dtype=np.bool_),
    )  # fmt: skip
    law = collection.find("castor_kick").apply
    assert runs.cache.of_model(runs, (law, 0.1), lambda: 1.0) == 1.0
    arrived = unpacked(packed(runs, {}), collection, {})
    np.testing.assert_array_equal(arrived.finish, runs.finish)
    assert arrived.cache.of_model(arrived, (law, 0.1), lambda: 2.0) == 2.0
