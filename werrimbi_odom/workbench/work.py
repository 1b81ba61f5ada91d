# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The long work: what is missing, and one more effect; what runs in a process of its own."""

from __future__ import annotations

import os
import signal
from collections.abc import Mapping
from multiprocessing.connection import Connection
from typing import Any

from werrimbi_odom.effects.collection import Collection, all_effects
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference.adding.adding import add_effect
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis, diagnose
from werrimbi_odom.inference.diagnosis.holdout import set_aside
from werrimbi_odom.inference.manoeuvres.drives import pace_of
from werrimbi_odom.inference.manoeuvres.proposal import Manoeuvre, next_manoeuvre
from werrimbi_odom.inference.manoeuvres.sight import sight_of
from werrimbi_odom.report.diagnosis_figures import (
    before_after,
    before_after_figure,
    ideal_of,
    manoeuvre_figure,
    set_up_figure,
)
from werrimbi_odom.workbench.crossing import packed, unpacked
from werrimbi_odom.workbench.opened import Given, Opened, Show, opened
from werrimbi_odom.workbench.steps import Diagnosed, Step
from werrimbi_odom.workbench.tasks import Add, Diagnose, Open, Task


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
    sights = tuple(sight_of(found, effects))
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
    fitted = add_effect(
        collection.find(task.effect),
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


def known_to_both(opened: Opened) -> Mapping[str, Any]:
    """What both processes cut alike, and need not send."""
    return {"train": opened.train.prepared, "holdout": opened.holdout.prepared}


def known_before(given: Given) -> Mapping[str, Any]:
    """What both have before anything is cut."""
    runs = (*given.runs, *given.holdout)
    return {"given": given, **{f"run {number}": run for number, run in enumerate(runs)}}


def left_there(opened: Opened) -> Mapping[str, Any]:
    """Most of what was cut: whoever compares cuts it himself, and the page does without."""
    return {
        "cuts": opened.train.prepared.cuts,
        "holdout cuts": opened.holdout.prepared.cuts,
        "fine": opened.train.fine,
        "holdout fine": opened.holdout.fine,
    }


NOT_SENT: Mapping[str, Any] = {"cuts": {}, "holdout cuts": {}, "fine": None, "holdout fine": None}
"""What the page has for `left_there`."""


def work(asked: Connection) -> None:
    """In the worker: do what is asked, tell how far it is, send back what came of it."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for who started us; he stops us
    try:
        import scipy.stats  # noqa: F401  # takes half a second: now, while the drives are read

        collection = all_effects(asked.recv())
        task, given = unpacked(asked.recv_bytes(), collection, {})

        def show(share: float, words: str) -> None:
            asked.send(("share", share, words))

        result = _done(task, given, collection, show)
        asked.send(("done", None, ""))
        asked.send_bytes(result)
    except InputError as error:
        asked.send(("refused", str(error), ""))
    except (BrokenPipeError, EOFError):
        pass  # nobody waits any more


def _done(task: Task, given: Given, collection: Collection, show: Show) -> bytes:
    """What came of it, packed."""
    if isinstance(task, Open):
        show(0.0, "matching ticks and reference")
        here = opened(given)
        look = here.look(given.robot, show)
        return packed((here, look), {**known_before(given), **left_there(here)})
    os.nice(5)  # the page stays quick
    if isinstance(task, Diagnose):
        return packed(diagnosed(task, given, collection, show), {})
    show(0.0, "opening")
    here = opened(given)
    return packed(added(task, here, collection, show), known_to_both(here))
