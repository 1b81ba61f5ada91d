# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What a held law leaves is no other effect, and no sign that another one is missing."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from werrimbi_odom.effects import find
from werrimbi_odom.files.read_run import read_run
from werrimbi_odom.files.robot_files.robot_file import read_robot_file
from werrimbi_odom.files.run import Ticks
from werrimbi_odom.inference.diagnosis import diagnosis, misfit
from werrimbi_odom.inference.diagnosis.effect_support import Support, is_even
from werrimbi_odom.inference.diagnosis.homogeneity import Lasting
from werrimbi_odom.inference.diagnosis.misfit import Misfit, misfit_of_held_law
from werrimbi_odom.inference.diagnosis.step_jacobians import Amount
from werrimbi_odom.inference.fitting.candidate import Candidate
from werrimbi_odom.inference.fitting.score_tests import Score
from werrimbi_odom.model.drive_of_run import drive_of_run
from werrimbi_odom.simulation import TrueRobot, free, hide, record, write_robot_file, write_run

RUNS: Any = SimpleNamespace(data=2600)
PLAY = SimpleNamespace(name="right_backlash")
STARTS = [
    find(name)
    for name in ("coulomb_slip", "longitudinal_slip", "reference_delay", "wheel_radius_scale")
]


def dependence(gain: float, of: str = "direction") -> Any:
    variable = SimpleNamespace(looks_at=(of,), even=True)
    amount = Amount("sideways", "travel")
    return SimpleNamespace(
        channel=amount.channel, amount=amount, gain=gain, variable=variable, degrees=1
    )


def left_beside(monkeypatch: pytest.MonkeyPatch, explained: float, beyond: Any) -> Misfit | None:
    support = Support(frozenset({"right_since_reversal"}), frozenset({"right", "sideways"}))

    def laws(*_: Any) -> Iterator[Any]:
        yield PLAY, support, explained

    monkeypatch.setattr(misfit, "_laws", laws)
    this: Any = SimpleNamespace(before=None, dependences=())
    return misfit_of_held_law(this, None, beyond, RUNS)


def test_what_is_little_of_a_law_and_of_the_errors_is_put_down_to_the_law(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A wheel that coasts through its play: 32 of 2600 beside 1155, and that was *unknown*."""
    little = dependence(32.0)
    rest = left_beside(monkeypatch, 1155.0, little)
    assert rest == Misfit(None, little, 32.0 / 2600.0)
    assert left_beside(monkeypatch, 200.0, little) is None, "it is much of what the law explains"
    assert left_beside(monkeypatch, 9e4, dependence(400.0)) is None, "it is much of the errors"


@pytest.mark.parametrize(
    ("both_even", "alone", "gains", "is_rest"),
    [
        # a slip 13 ms late, and a delay of 0.7 ms that was not there
        (True, 27.4, (148.0, 18.7), True),
        (True, 27.4, (30.0, 18.7), False),
        (False, 27.4, (148.0, 18.7), False),
        (False, 27.4, (148.0, 9.0), True),
        # a gyro's bias over time, and a base that differs by 4 % from left to right turns: beside
        # that the curve over time explains 0.6, and it was shadowed, 160 standard deviations large
        (False, 1376.6, (1047.0, 330.2), False),
        (True, 1376.6, (1047.0, 330.2), False),
        (False, 1376.6, (1147.0, 330.2), True),  # here the curve explains 101 beside it
        (False, 60.0, (40.0, 20.2), True),  # and here chance is the rest of the effect
    ],
)
def test_what_a_law_itself_explains_better_is_no_other_effect(
    monkeypatch: pytest.MonkeyPatch,
    gains: tuple[float, float],
    *,
    alone: float,
    both_even: bool,
    is_rest: bool,
) -> None:
    support = Support(frozenset({"direction"}), frozenset({"sideways"}), even=False)
    if both_even:
        support = support._replace(inputs=frozenset({"left_speed"}), even=True)
    law = SimpleNamespace(name="coulomb_slip")
    monkeypatch.setattr(misfit, "_laws", lambda *_: iter([(law, support, 1e5)]))
    monkeypatch.setattr(misfit, "_gains", lambda *_: gains)
    monkeypatch.setattr(misfit, "_may_be_even", lambda *_: True)
    cell = dependence(43.0, "left_speed" if both_even else "direction")
    cell.variable.even = not both_even
    delay = Score(Candidate(find("reference_delay"), {}), alone, 1, np.zeros(1))
    before = SimpleNamespace(point=None, numbers=(), squares=5e3, spare=np.inf)
    this: Any = SimpleNamespace(before=before, scores=[delay], dependences=[cell], number=60)
    best: Any = SimpleNamespace(names=("coulomb_slip", "reference_delay"))
    found = misfit_of_held_law(this, best, None, RUNS)
    assert (found is not None) == is_rest


def test_the_rest_of_a_law_is_no_sign_of_an_effect_that_the_parts_do_not_show(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A delay of a millisecond was named beside slip above a force: the curve of slip lasted."""
    rest = dependence(55.0, "right_since_reversal")
    delay: Any = SimpleNamespace(names=("coulomb_slip", "reference_delay"))
    this: Any = SimpleNamespace(before=None, number=60)
    monkeypatch.setattr(diagnosis, "_significant", lambda *_: delay)
    monkeypatch.setattr(diagnosis, "p_value_by_parts", lambda *_: 2e-3)
    monkeypatch.setattr(diagnosis, "disagreeing", lambda *_: False)
    speaks = 1e-4
    monkeypatch.setattr(diagnosis, "homogeneity_of_effect", lambda *_: speaks)
    monkeypatch.setattr(
        diagnosis, "_beyond_the_library", lambda _, best, *__: rest if best is None else None
    )
    held = Misfit("coulomb_slip", rest, 0.002)
    monkeypatch.setattr(diagnosis, "misfit_of_held_law", lambda *_: held)
    assert diagnosis._chosen(this, RUNS) == (None, rest)
    monkeypatch.setattr(diagnosis, "misfit_of_held_law", lambda *_: None)
    assert diagnosis._chosen(this, RUNS) == (delay, None)
    speaks = (
        0.02  # a floor that leans, in half of a room with a carpet; it doubled the fitted error
    )
    assert diagnosis._chosen(this, RUNS) == (None, rest)


def test_an_effect_that_few_parts_show_and_a_dependence_that_few_show_compete_alike(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A slope that scans saw was named a base that differs from left to right turns.

    The parts spoke for that base at 0.4 %, by the curve of turning, which lasted; and for a wave
    over the heading, eight times as large, at 0.11 %.
    """
    turning, slope = dependence(200.0, "yaw_rate"), dependence(1261.0, "heading")
    base = SimpleNamespace(names=("turn_dependent_track",), cost=-150.0, penalty=16.0)
    before = SimpleNamespace(
        point=None, numbers=(), squares=5e3, spare=np.inf, cost=0.0, penalty=0.0
    )
    before.penalty_of_one = before.penalty_of_own = 8.0
    score = Score(Candidate(find("turn_dependent_track"), {}), 177.0, 2, np.zeros(2))
    cells = [slope, turning]
    for cell in cells:
        cell.p_value, cell.variable.per_run = 1e-40, False
    this: Any = SimpleNamespace(before=before, scores=[score], dependences=cells, number=60)
    by_parts = {id(turning): 1.8e-4, id(slope): 1.1e-3}
    monkeypatch.setattr(before, "point", SimpleNamespace(model=SimpleNamespace(robot=None)))
    monkeypatch.setattr(diagnosis, "support_of", lambda *_: Support(frozenset(), frozenset()))
    monkeypatch.setattr(
        diagnosis, "lasting", lambda *asked: [Lasting(c, by_parts[id(c)], None) for c in asked[3]]
    )
    monkeypatch.setattr(diagnosis, "_significant", lambda *_: base)
    monkeypatch.setattr(diagnosis, "disagreeing", lambda *_: False)
    monkeypatch.setattr(diagnosis, "homogeneity_of_effect", lambda *_: 4e-4)
    monkeypatch.setattr(diagnosis, "misfit_of_held_law", lambda *_: None)
    runs: Any = SimpleNamespace(data=2600, drive=lambda _: None)
    monkeypatch.setattr(diagnosis, "p_value_by_parts", lambda *_: 4e-3)
    assert diagnosis._chosen(this, runs) == (None, slope)
    monkeypatch.setattr(diagnosis, "p_value_by_parts", lambda *_: 1e-5)
    assert diagnosis._chosen(this, runs) == (base, None), "proved by itself, it needs no rival's"
    by_parts[id(slope)] = 0.02
    monkeypatch.setattr(diagnosis, "p_value_by_parts", lambda *_: 4e-3)
    assert diagnosis._chosen(this, runs) == (base, None)


@pytest.mark.evidence
def test_a_force_of_starts_that_rare_messages_blur_is_no_second_effect(tmp_path: Path) -> None:
    """Ten messages a second know an acceleration half a message late: creep was named beside it."""
    pytest.importorskip("mujoco", reason="drives need the physics engine (pip install mujoco)")
    true = TrueRobot(left_wheel_noise=4e-4, right_wheel_noise=5.8e-4)
    file = read_robot_file(write_robot_file(true, tmp_path / "robot.yaml"))
    slip = hide("coulomb_slip", 0.08, seed=3).peculiarity
    drives = []
    for number in range(3):
        speed = 0.25 + 0.05 * number
        hard = free(80.0, seed=number, speed=speed, yaw_rate=2.5 * speed, acceleration=3 * speed)
        recording = record(true, hard, seed=100 + number, hidden=[slip])
        run = read_run(write_run(recording, tmp_path / str(number)), file)
        ticks = run.ticks
        rare = Ticks(ticks.time[::5], ticks.left[::5], ticks.right[::5])
        drives.append(replace(run, ticks=rare))
    found = diagnosis.diagnose(drives[:2], file.robot, STARTS, holdout=drives[2:])
    assert (found.verdict, found.found) == ("named", ("coulomb_slip",))
    assert found.robot.effects[-1].values["coefficient"] == pytest.approx(0.08, rel=0.15)


@pytest.mark.evidence
def test_a_law_of_both_tyres_alike_has_no_part_in_what_has_one_side(tmp_path: Path) -> None:
    """A counter that is read late was held for the form of a slip; errors stayed a fifth too high.

    As the robot speeds up it turns to the side of the late counter.
    """
    pytest.importorskip("mujoco", reason="drives need the physics engine (pip install mujoco)")
    true = TrueRobot(left_wheel_noise=4e-4, right_wheel_noise=5.8e-4)
    file = read_robot_file(write_robot_file(true, tmp_path / "robot.yaml"))
    hidden = [
        hide(name, size, seed=3, number=number).peculiarity
        for number, (name, size) in enumerate((("coulomb_slip", 0.1), ("encoder_skew", 0.0037)))
    ]
    drives = []
    for number in range(3):
        brisk = free(40.0, seed=number, speed=0.6, yaw_rate=1.5, acceleration=1.2)
        recording = record(true, brisk, seed=100 + number, hidden=hidden)
        drives.append(read_run(write_run(recording, tmp_path / str(number)), file))
    effects = [*STARTS, find("encoder_skew")]
    found = diagnosis.diagnose(drives[:2], file.robot, effects, holdout=drives[2:])
    assert (found.verdict, set(found.found)) == ("named", {"coulomb_slip", "encoder_skew"})


@pytest.mark.parametrize(
    ("name", "even"),
    [
        ("coulomb_slip", True),
        ("lateral_slip", True),
        ("radius_drift", True),
        ("encoder_skew", False),
        ("left_backlash", False),
        ("sideways_drift", False),
        ("reference_gyro_drift", False),
        ("turn_dependent_track", False),
        ("skid_steer", False),
        ("castor_swing", True),
    ],
)
def test_which_laws_are_the_same_in_a_mirror(name: str, *, even: bool) -> None:
    """Found by running them on the drive of a robot and on that of its mirror image."""
    random = np.random.default_rng(1)
    left, right = random.normal(0.01, 0.01, (2, 200))
    time = np.full(200, 0.02)
    turn = (right - left) / 0.3
    angles = left / 0.04, right / 0.04
    drive = drive_of_run(
        time, left, right, 0.5 * (left + right), turn, *angles, flicker=1e-4, track=0.3
    )
    law = find(name).using(**{item: each.typical for item, each in find(name).parameters.items()})
    assert is_even(law, drive) == even
