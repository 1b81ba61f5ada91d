# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A user's effect: what its declaration refuses; what it raises is one line, in a fleet a row."""

from __future__ import annotations

import builtins
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from test.cli.commands import RECORDING
from test.command_line import Werrimbi
from test.evidence import in_evidence
from werrimbi_odom.effects import LIBRARY, all_effects, find
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.recordings import Asked, DriveOptions
from werrimbi_odom.fleet.robot_task import Task, row_of
from werrimbi_odom.model.effect import Parameter, wheel_effect
from werrimbi_odom.model.motion import WheelTravel

EFFECT = '''
import sys
import numpy as np
from werrimbi_odom.model.effect import Parameter, wheel_effect
from werrimbi_odom.model.motion import WheelTravel

class Dumb(BaseException):
    def __str__(self):
        raise RuntimeError("not even that")

@wheel_effect(size=Parameter("", 0.0, 0.1, (-1.0, 1.0), "how much"))
def of_my_own(travel, drive, size):
    """Something that goes wrong."""
    {law}
'''
RAISED = sorted(
    {
        kind.__name__
        for kind in vars(builtins).values()
        if isinstance(kind, type)
        and issubclass(kind, BaseException)
        and kind.__module__ == "builtins"
    }
    - {"KeyboardInterrupt", "MemoryError"}
)
MADE = {
    "UnicodeDecodeError": "'utf-8', b'', 0, 1, ''",
    "UnicodeEncodeError": "'utf-8', '', 0, 1, ''",
}
MADE |= {"UnicodeTranslateError": "'', 0, 1, ''", "BaseExceptionGroup": "'', [GeneratorExit()]"}
MADE |= {"ExceptionGroup": "'', [ValueError()]"}
RESULTS = {
    "None": "gives a NoneType",
    "(travel.left, travel.right)": "gives a tuple",
    "WheelTravel(None, travel.right)": "its left is a NoneType",
    "WheelTravel(travel.left, 'far')": "its right is a str",
    "WheelTravel(np.zeros(3), travel.right)": "its left has the shape (3,)",
    "WheelTravel(travel.left.astype(object), travel.right)": "its left holds object",
}


def place(folder: Path, law: str) -> Path:
    (folder / "mine.py").write_text(EFFECT.format(law=law))
    text = (RECORDING / "robot.yaml").read_text().rstrip()
    text += "\n    effects: [of_my_own]\n    of_my_own:\n      size: 0.01\n"
    (folder / "robot.yaml").write_text(text)
    return folder


def words(folder: Path, verb: str, *more: str) -> list[str]:
    given = ["--robot", str(folder / "robot.yaml"), str(RECORDING)]
    return [*verb.split(), *given, "--effects", str(folder / "mine.py"), *more]


@pytest.mark.parametrize(
    "name",
    [each if each in MADE or not n % 3 else in_evidence(each) for n, each in enumerate(RAISED)],
)
def test_any_exception_of_a_law_is_one_line(tmp_path: Path, name: str, werrimbi: Werrimbi) -> None:
    law = f"raise {name}({MADE.get(name, '')})"
    folder = place(tmp_path, law)
    out = tmp_path / "odom.csv"
    said = werrimbi(*words(folder, "odom", "--out", str(out)), code=2)
    assert said.err.count("\n") == 1
    line = EFFECT.format(law=law).splitlines().index(f"    {law}") + 1
    assert f"mine.py:{line}: the law of of_my_own(size=0.01) fails: {name}" in said.err
    assert not out.exists()


@pytest.mark.parametrize("result", RESULTS)
def test_any_result_that_is_none_is_one_line(
    tmp_path: Path, result: str, werrimbi: Werrimbi
) -> None:
    folder = place(tmp_path, f"return {result}")
    said = werrimbi(*words(folder, "compare"), code=2)
    assert said.err.count("\n") == 1
    assert RESULTS[result] in said.err


@pytest.mark.parametrize(
    ("verb", "law"),
    [
        pytest.param(verb, law, marks=[pytest.mark.evidence] * (bool(row) and bool(column)))
        for row, verb in enumerate(["diagnose", "add track_width", "draft", "calibrate fit"])
        for column, law in enumerate(
            ["sys.exit(0)", "raise Dumb", "return 1.0 / 0.0", "return nowhere"]
        )
    ],
)
def test_no_verb_ends_as_if_all_were_well(
    tmp_path: Path, verb: str, law: str, werrimbi: Werrimbi
) -> None:
    folder = place(tmp_path, law)
    more = [] if verb == "diagnose" else ["--out", str(tmp_path / "new")]
    said = werrimbi(*words(folder, verb, *more), code=2)
    assert said.err.count("\n") == 1
    assert "the law of of_my_own" in said.err
    assert not (tmp_path / "new").exists()


@pytest.mark.parametrize("law", ["raise Dumb", "sys.exit(0)", "raise KeyboardInterrupt"])
def test_in_a_fleet_it_is_a_row(tmp_path: Path, law: str) -> None:
    folder = place(tmp_path, law)
    how = DriveOptions(effects=(folder / "mine.py",))
    row = row_of(Task("robot_1", Asked(folder / "robot.yaml", (RECORDING,), (), how)))
    assert row.verdict == "error"
    assert "of_my_own" in row.error or "KeyboardInterrupt" in row.error


@pytest.mark.parametrize("name", ["SystemExit", "Dumb", "GeneratorExit"])
def test_a_file_that_raises_as_it_is_read_is_one_line(
    tmp_path: Path, name: str, werrimbi: Werrimbi
) -> None:
    folder = place(tmp_path, "return travel")
    text = (folder / "mine.py").read_text()
    (folder / "mine.py").write_text(f"{text}\n\nraise {name}\n")
    said = werrimbi(*words(folder, "diagnose"), code=2)
    assert said.err.count("\n") == 1
    assert f"mine.py:{text.count(chr(10)) + 3}: {name}" in said.err


def test_a_guarded_law_is_the_law(tmp_path: Path) -> None:
    file = place(tmp_path, "return WheelTravel(travel.left * (1.0 + size), travel.right)")
    one, other = (all_effects([file / "mine.py"]).find("of_my_own") for _ in range(2))
    assert one.parameters.keys() == {"size"}
    for steps in (np.ones(3), 1.0):
        after = one.apply(WheelTravel(steps, steps), None, size=0.5)
        assert np.all(after.left == 1.5)
        assert np.all(other.apply(WheelTravel(steps, steps), None, size=0.5).left == after.left)
    assert all(item is known for item, known in zip(all_effects().effects, LIBRARY, strict=False))


def test_a_law_with_a_number_of_each_drive_that_fails_is_one_line(tmp_path: Path) -> None:
    """Over several drives at once such a number is an array, of a value for each step."""
    broken = all_effects([place(tmp_path, "return nowhere") / "mine.py"]).find("of_my_own")
    for size, told in ((np.array([0.1, 0.1, 0.3]), "0.1 to 0.3"), (np.full(3, 0.1), "0.1")):
        with pytest.raises(InputError, match=rf"of_my_own\(size={told}\) fails: NameError"):
            broken.apply(WheelTravel(np.ones(3), np.ones(3)), None, size=size)


AMOUNT = Parameter("m", 0.0, 0.01, (0.0, 0.1), "how much")


def test_function_and_declaration_must_name_the_same_parameters() -> None:
    def creep(travel: Any, drive: Any, much: float) -> Any:
        """Creep."""
        return travel

    with pytest.raises(TypeError, match=r"declares the parameters \(amount\).*takes \(much\)"):
        wheel_effect(amount=AMOUNT)(creep)


def test_it_needs_a_docstring() -> None:
    with pytest.raises(TypeError, match="docstring"):
        wheel_effect()(lambda travel, drive: travel)


def test_a_quadrature_is_of_its_own_parameters() -> None:
    def creep(travel: Any, drive: Any, amount: float) -> Any:
        """Creep."""
        return travel

    with pytest.raises(TypeError, match="quadrature"):
        wheel_effect(quadrature=("amount", "phase"), amount=AMOUNT)(creep)


def test_values_are_checked_and_the_rest_is_null() -> None:
    slip = find("floor_slope")
    assert slip.using(y=0.01).values == {"x": 0.0, "y": 0.01, "x_rate": 0.0, "y_rate": 0.0}
    with pytest.raises(ValueError, match="no parameter z; it has x, y"):
        slip.using(z=1.0)
    for impossible in (1.0, math.nan, math.inf):
        with pytest.raises(ValueError, match="must lie between"):
            slip.using(x=impossible)


def test_a_phase_that_each_run_has_anew_stays_unknown_until_given() -> None:
    wheel = find("eccentric_left_wheel")
    assert wheel.using(amplitude=1e-3).unknown == ("phase",)
    assert wheel.using(amplitude=1e-3, phase=0.4).unknown == ()


@pytest.mark.parametrize("phase", [0.3, -2.5, math.pi])
def test_amplitude_and_phase_are_fitted_as_two_parts(phase: float) -> None:
    wheel = find("eccentric_left_wheel")
    parts = wheel.to_fit({"amplitude": 2e-3, "phase": phase})
    assert parts == pytest.approx(
        {"amplitude_cos": 2e-3 * math.cos(phase), "amplitude_sin": 2e-3 * math.sin(phase)}
    )
    assert wheel.from_fit(parts) == pytest.approx({"amplitude": 2e-3, "phase": phase})


def test_without_a_quadrature_the_parameters_are_fitted_themselves() -> None:
    kick = find("castor_kick")
    values = {"angle": 0.1, "alternating": -0.2, "length": 0.05}
    assert kick.from_fit(kick.to_fit(values)) == values
