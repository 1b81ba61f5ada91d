# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What is missing, and more effects: the long work of the page, on the drives it judges on."""

from __future__ import annotations

from werrimbi_odom.effects.collection import Collection
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference.adding.adding import add_effects
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis, diagnose
from werrimbi_odom.inference.diagnosis.splitting import set_aside
from werrimbi_odom.inference.manoeuvres.detection_limits import detection_limits
from werrimbi_odom.inference.manoeuvres.drives import pace_of
from werrimbi_odom.inference.manoeuvres.proposal import Manoeuvre, next_manoeuvre
from werrimbi_odom.report.diagnosis.figures import (
    before_after,
    before_after_figure,
    ideal_of,
    manoeuvre_figure,
    set_up_figure,
)
from werrimbi_odom.workbench.opened import Given, Opened, Show
from werrimbi_odom.workbench.steps import Diagnosed, Step
from werrimbi_odom.workbench.tasks import Add, Diagnose


def diagnosed(task: Diagnose, given: Given, collection: Collection, show: Show) -> Diagnosed:
    """Diagnose, on the very drives that the page judges on.

    Raises
    ------
    InputError
        When the drives do not allow it; the message says why.
    """
    effects = collection.effects
    runs, holdout = _split(given)
    found = diagnose(runs, task.robot, effects, holdout=holdout, show=show, **given.judging)
    show(0.97, "the next step")
    manoeuvre = next_manoeuvre(found)
    sights = tuple(detection_limits(found, effects))
    show(0.99, "figures")
    return Diagnosed(found, manoeuvre, sights, _figures(found, manoeuvre))


def _figures(found: Diagnosis, manoeuvre: Manoeuvre | None) -> dict[str, str]:
    figures = {}
    if found.set_up.findings:
        figures["set_up"] = set_up_figure(found)
    elif (response := before_after(found)) is not None:
        figures["response"] = before_after_figure(response)
    ideal = None if manoeuvre is None else ideal_of(manoeuvre.name)
    if ideal is not None:
        figures["manoeuvre"] = manoeuvre_figure(
            ideal, found.robot, pace_of(found.runs, found.robot)
        )
    return {name: str(figure.to_json()) for name, figure in figures.items()}


def added(task: Add, opened: Opened, collection: Collection, show: Show) -> Step:
    """Fit, and compare over the same legs as before.

    Raises
    ------
    InputError
        When the drives do not allow it; the message says why.
    """
    runs, holdout = _split(opened.given)
    fitted = add_effects(
        [collection.find(name) for name in task.effects],
        runs,
        task.robot,
        holdout=holdout,
        show=lambda share, words: show(0.8 * share, words),
        **opened.given.judging,
    )
    show(0.8, "comparing")
    return Step(opened.look(fitted.robot), fitted)


def _split(given: Given) -> tuple[tuple[Run, ...], tuple[Run, ...]]:
    """Runs to learn from, and runs to judge on."""
    return (given.runs, given.holdout) if given.holdout else set_aside(given.runs)
