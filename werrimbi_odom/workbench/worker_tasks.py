# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Long work of the page: diagnosis and adding effects, on its fitted and held-out drives."""

from __future__ import annotations

from dataclasses import replace

from werrimbi_odom.api.compare_diagnose_add import added as added_by
from werrimbi_odom.api.compare_diagnose_add import diagnosed as diagnosis_of
from werrimbi_odom.files.recordings import Recordings
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis
from werrimbi_odom.inference.manoeuvres.advice import AdvisedDiagnosis
from werrimbi_odom.inference.manoeuvres.ideal_drives import pace_of
from werrimbi_odom.progress import Show
from werrimbi_odom.report.diagnosis.document import shown_before_and_after
from werrimbi_odom.report.diagnosis.figures import ideal_of, manoeuvre_figure
from werrimbi_odom.workbench.loaded_input import Opened, split
from werrimbi_odom.workbench.session import Diagnosed, Drawn, ModelVersion
from werrimbi_odom.workbench.task import Add, Diagnose


def diagnosed(task: Diagnose, given: Recordings, show: Show) -> Diagnosed:
    """Diagnose, with the same held-out drives as the page.

    InputError if it fails on these drives; the message says why.
    """
    told = diagnosis_of(split(replace(given, fitted=task.robot)), show).found
    show(0.99, "figures")
    told = replace(told, held_out=bool(given.holdout))
    return Diagnosed(told, _before_after(told.diagnosis), _manoeuvre(told))


def _before_after(found: Diagnosis) -> Drawn | None:
    section = shown_before_and_after(found)
    if section is None:
        return None
    (drawing,) = section.figures.values()
    return Drawn(section.title, section.see, str(drawing.to_json()))


def _manoeuvre(advised: AdvisedDiagnosis) -> str | None:
    found, manoeuvre = advised.diagnosis, advised.manoeuvre
    ideal = None if manoeuvre is None else ideal_of(manoeuvre.name)
    if ideal is None:
        return None
    return str(manoeuvre_figure(ideal, found.robot, pace_of(found.runs, found.robot)).to_json())


def added(task: Add, opened: Opened, show: Show) -> ModelVersion:
    """Fit effects, and compare over the same legs as before.

    InputError if it fails on these drives; the message says why.
    """
    given = split(replace(opened.given, fitted=task.robot))
    effects = [given.collection.find(name) for name in task.effects]
    fitted = added_by(given, effects, lambda share, words: show(0.8 * share, words)).found
    show(0.8, "comparing")
    return ModelVersion(opened.look(fitted.robot), fitted)
