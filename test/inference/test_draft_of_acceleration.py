# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A law of the acceleration that is the same speeding up and braking."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from test.inference.driven import COMMON, run_of, runs_of
from test.model.drives import ROBOT
from werrimbi_odom.effects.user_effects import load_file
from werrimbi_odom.errors import InputError
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis, diagnose
from werrimbi_odom.inference.drafting import draft
from werrimbi_odom.inference.drafting.draft import draft_effect

GROWTH = -0.05

LAW = '''"""Both wheels, by the square of the acceleration."""

from werrimbi_odom.effects.shapes import mean_square, steady
from werrimbi_odom.model.effect import Parameter, wheel_effect
from werrimbi_odom.model.motion import WheelTravel


@wheel_effect(growth=Parameter("", null=0.0, typical=0.1, bounds=(-1.0, 1.0), says="a share"))
def settles(travel, drive, growth):
    """Both tyres are pressed flat whenever the speed changes.

    Formula    left and right *= 1 + growth * acceleration^2
    Signature  as a scale, in each start and stop
    Ruler      a taped line in short hops, and in one go
    """
    seen = steady(0.5 * (drive.left_acceleration + drive.right_acceleration))
    share = 1.0 + growth * mean_square(seen)
    return WheelTravel(travel.left * share, travel.right * share)
'''


@pytest.fixture(scope="module")
def diagnosis(tmp_path_factory: pytest.TempPathFactory) -> Diagnosis:
    file: Path = tmp_path_factory.mktemp("law") / "settles.py"
    file.write_text(LAW)
    (settles,) = load_file(file)
    truth = replace(ROBOT, effects=(settles.using(growth=GROWTH),))
    library = [effect for effect in COMMON if not effect.name.startswith("reference")]
    return diagnose(runs_of(truth, [1], 60), ROBOT, library, holdout=[run_of(truth, 2, 60)])


@pytest.mark.evidence
def test_an_even_law_of_the_acceleration_is_drafted_as_a_square(diagnosis: Diagnosis) -> None:
    """Only a line was tried: a slope of -0.0003 ± 0.0035, where radii fell by 0.05 a^2."""
    found = draft_effect(diagnosis)
    assert (found.claim.variable, found.form) == ("acceleration", "square")
    fitted = found.fit.point.model.robot.effects[-1].values["growth"]
    assert fitted == pytest.approx(GROWTH, rel=0.1)


@pytest.mark.evidence
def test_a_law_that_is_nothing_beside_its_error_is_not_written(
    diagnosis: Diagnosis, monkeypatch: pytest.MonkeyPatch
) -> None:
    forms = draft.forms_of
    monkeypatch.setattr(
        draft, "forms_of", lambda *given: [form for form in forms(*given) if form.kind == "line"]
    )
    with pytest.raises(InputError, match="no simple law of acceleration explains the errors"):
        draft_effect(diagnosis)
