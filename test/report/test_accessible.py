# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Every report by axe-core's rules, in light and dark, on a wide screen and on a telephone."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from browser import Visit

from test.axe import COUNT, RUN, axe_script
from werrimbi_odom.inference.adding.added import Added
from werrimbi_odom.inference.comparison.compare import Comparison
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis
from werrimbi_odom.inference.manoeuvres.advice import AdvisedDiagnosis
from werrimbi_odom.report.adding.document import document_of as document_of_added
from werrimbi_odom.report.calibration.document import calibration_document, leg_figure
from werrimbi_odom.report.comparison.document import document_of as document_of_comparison
from werrimbi_odom.report.diagnosis.document import document_of as document_of_diagnosis
from werrimbi_odom.report.document import Paragraph, Table
from werrimbi_odom.report.page import write_page
from werrimbi_odom.report.save import save_report

TOO_WIDE = "Math.max(0, document.documentElement.scrollWidth - window.innerWidth)"
ALL_OPEN = "document.querySelectorAll('details').forEach(item => { item.open = true; })"


@pytest.fixture(scope="module")
def pages(
    comparison: Comparison,
    diagnosis: Diagnosis,
    added: Added,
    tmp_path_factory: pytest.TempPathFactory,
) -> dict[str, Path]:
    folder = tmp_path_factory.mktemp("pages")
    found = {name: folder / f"{name}.html" for name in ("compare", "diagnose", "add", "fit")}
    save_report(document_of_comparison(comparison), found["compare"])
    save_report(document_of_diagnosis(AdvisedDiagnosis(diagnosis, None, ())), found["diagnose"])
    save_report(document_of_added(added), found["add"])
    errors = np.random.default_rng(1).normal(0.0, 0.01, (3000, 2))
    figure = leg_figure(errors, 0.5 * errors)
    numbers = {"wheel_separation_multiplier": (1.0, 1.01)}
    table = Table("Found", ["parameter", "before", "after"], [["k", "1", "1.01"]])
    words = [Paragraph("All is well."), table]
    fit = calibration_document("Fit", words, "Legs", "See.", lambda: figure, numbers)
    write_page(fit, found["fit"])
    return found


def rules() -> list[str]:
    """Scripts that ask for them, with all of a page open; their answers are for `assert_obeyed`."""
    return [ALL_OPEN, axe_script(), COUNT, RUN, TOO_WIDE]


def assert_obeyed(answers: Sequence[Any]) -> None:
    _, _, passed, broken, too_wide = answers
    assert passed > 10
    assert broken == []
    assert too_wide == 0


@pytest.mark.evidence
@pytest.mark.parametrize(("dark", "width"), [(False, 1280), (True, 390)])
@pytest.mark.parametrize("name", ["compare", "diagnose", "add", "fit"])
def test_no_rule_is_broken_and_nothing_is_too_wide(
    pages: dict[str, Path], look: Callable[..., Visit], name: str, dark: bool, width: int
) -> None:
    """A comparison in the light and a diagnosis in the dark are asked in `test_pages` too."""
    visit = look(pages[name], *rules(), dark=dark, width=width)
    assert_obeyed(visit.answers)
    assert visit.complaints == []
