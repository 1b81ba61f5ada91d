# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Report of a diagnosis: what is missing, the evidence, and what to do next."""

from __future__ import annotations

import html

from werrimbi_odom.effects.effect_docstring import page_of
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis
from werrimbi_odom.inference.diagnosis.evidence import Dependence
from werrimbi_odom.inference.diagnosis.response_curve import before_after
from werrimbi_odom.inference.manoeuvres.advice import AdvisedDiagnosis
from werrimbi_odom.inference.manoeuvres.for_unexplained_errors import ProposedManoeuvre
from werrimbi_odom.inference.manoeuvres.ideal_drives import pace_of
from werrimbi_odom.model.effect import Effect
from werrimbi_odom.report.diagnosis.dependence import label_of
from werrimbi_odom.report.diagnosis.evidence_figures import (
    before_after_figure,
    dependence_figure,
    evidence_map_figure,
    ordered_cells,
)
from werrimbi_odom.report.diagnosis.figures import (
    ideal_of,
    manoeuvre_figure,
    ranking_figure,
    set_up_figure,
)
from werrimbi_odom.report.diagnosis.next_steps import NextSteps
from werrimbi_odom.report.diagnosis.tables import tables_of
from werrimbi_odom.report.diagnosis.words import words_of
from werrimbi_odom.report.document import Document, Shown
from werrimbi_odom.report.events import on_the_path, over_time
from werrimbi_odom.report.number_format import capital
from werrimbi_odom.report.sketches import effect_sketch

_LISTED = 8


def document_of(advised: AdvisedDiagnosis, steps: NextSteps | None = None) -> Document:
    """The complete report."""
    diagnosis = advised.diagnosis
    title = {
        "none": "Nothing is missing",
        "named": f"What is missing: {', '.join(diagnosis.found)}",
        "ambiguous": f"What is missing: {' or '.join(diagnosis.rivals)}",
        "unknown": "Something is missing that the library does not hold",
    }[diagnosis.verdict]
    if advised.drives_differ:
        title = "Not the same in all of these drives"
    if diagnosis.set_up.wrong:
        mistakes = ", ".join(item.effect for item in diagnosis.set_up.wrong)
        title = f"What is set up wrongly: {mistakes}"
    return Document(
        title=title,
        words=words_of(advised, steps or NextSteps()),
        tables=tables_of(diagnosis, advised.sights),
        draw=lambda: [
            *_effects(diagnosis),
            *filter(None, [shown_before_and_after(diagnosis)]),
            *_ranking(diagnosis),
            *_evidence(diagnosis),
            *_events(diagnosis),
            *_next(diagnosis, advised.manoeuvre),
            *_sketches(diagnosis),
        ],
    )


def _effects(diagnosis: Diagnosis) -> list[Shown]:
    """Sketches and descriptions of the named effect, or of its rivals."""
    names = list(dict.fromkeys([*diagnosis.rivals, *diagnosis.found]))
    cards = [effect_card(each) for name in names if (each := diagnosis.effect_named(name))]
    if not cards:
        return []
    many = len(diagnosis.rivals) > 1
    beside = [name for name in diagnosis.found if name not in diagnosis.rivals]
    apart = f"These drives cannot tell {' and '.join(diagnosis.rivals)} apart; the next step can."
    if beside:
        apart += f" Beside them there is {' and '.join(beside)}."
    return [
        Shown(
            "physics",
            "The rivals" if many else "What it is",
            apart
            if many
            else "The physics, what it does to the data, and how to check it on the robot.",
            html=f'<div class="cards">{"".join(cards)}</div>',
            main=False,
        )
    ]


def effect_card(effect: Effect) -> str:
    """An effect as a small panel: sketch, summary, how to check it."""
    page = page_of(effect)
    parts = [f"<h3>{html.escape(effect.name)}</h3>", effect_sketch(effect) or ""]
    if page.physics:
        parts.append(f"<p>{html.escape(page.physics[0])}</p>")
    for section, word in (("Signature", "In the data"), ("Ruler", "On the robot")):
        if section in page.sections:
            text = html.escape(" ".join(page.sections[section].split()))
            parts.append(f"<p><strong>{word}:</strong> {text}.</p>")
    return f'<div class="card">{"".join(parts)}</div>'


def shown_before_and_after(diagnosis: Diagnosis) -> Shown | None:
    """The set-up as given and put right, or the error over the variable of what is missing."""
    if diagnosis.set_up.findings:
        return Shown(
            "set-up",
            "Turn and travel, as given and put right",
            "Each mark is a short leg. What is right lies on the dashed line; a wrong sign or a "
            "wrong factor lies on another one.",
            {"": set_up_figure(diagnosis)},
        )
    found = before_after(diagnosis)
    if found is None:
        return None
    variable = label_of(found.cell.variable.name)
    if found.effect is None:
        title = f"What the error does over {variable}"
        see = (
            "No effect of the library explains it, so there is no name and no after; but this is "
            "how the error goes with it. Bars are 2 standard errors."
        )
    else:
        title = f"{found.effect}: its error before and after"
        see = (
            f"Over {variable}, the error before shows the effect's own pattern; with the effect in "
            "the model it should be flat on zero. Bars are 2 standard errors."
        )
    return Shown("before-after", title, see, {"": before_after_figure(found)})


def _ranking(diagnosis: Diagnosis) -> list[Shown]:
    if not any(item.holdout or item.train for item in diagnosis.ranking):
        return []
    count = len(diagnosis.ranking)
    return [
        Shown(
            "ranking",
            "What each effect would gain",
            f"The longer a filled bar, the more the effect lowers the error of drives that it was "
            f"not fitted to. Of {count} effects those that looked promising were fitted; bold is "
            "what the verdict names.",
            {"": ranking_figure(diagnosis)},
        )
    ]


def _evidence(diagnosis: Diagnosis) -> list[Shown]:
    cells = ordered_cells(diagnosis.depends_on)
    if not cells:
        return []
    names = [run.name for run in diagnosis.runs.runs]
    maps = {"with the robot as given": evidence_map_figure(diagnosis.depends_on, opens="cell")}
    if diagnosis.found:
        maps["with everything found put in"] = evidence_map_figure(diagnosis.remaining)
    return [
        Shown(
            "evidence",
            "Evidence map: which error goes with what",
            "The stronger a field, the more of the misfit goes with that variable; dots are beyond "
            "chance, the star is the strongest. Click a field to see the dependence below.",
            maps,
            "Map:",
            _strongest(cells),
        ),
        Shown(
            "cell",
            "The dependence behind a field",
            "How the chosen error follows its variable, as the map has fitted it.",
            {_cell_name(cell): dependence_figure(cell, names) for cell in cells},
            "Field:",
            main=False,
        ),
    ]


def _cell_name(cell: Dependence) -> str:
    return f"{cell.channel} with {html.unescape(label_of(cell.variable.name))}"


def _strongest(cells: list[Dependence]) -> str:
    """The strongest fields also as buttons, for keyboards and screen readers."""
    buttons = "".join(
        f'<li><button type="button" data-open="cell:{number}">{html.escape(_cell_name(cell))}'
        f"</button> χ² falls by {cell.gain:.0f}</li>"
        for number, cell in enumerate(cells[:_LISTED])
    )
    return (
        '<details class="toolbar"><summary>The strongest fields</summary>'
        f"<ol>{buttons}</ol></details>"
    )


def _events(diagnosis: Diagnosis) -> list[Shown]:
    happened, track = diagnosis.happened, diagnosis.robot.track
    if not happened.events:
        return []
    figures = {"over time": over_time(happened, track)}
    path = on_the_path(happened, track)
    if path is not None:
        figures = {"on the path": path, **figures}
    return [
        Shown(
            "events",
            "What happened at once",
            "Each mark is a jump of the errors within 0.2 s, that no law explains. Marks that line "
            "up, or that come at the same place, are no accidents.",
            figures,
            "Drawn:",
        )
    ]


def _next(diagnosis: Diagnosis, manoeuvre: ProposedManoeuvre | None) -> list[Shown]:
    if manoeuvre is None:
        return []
    ideal = ideal_of(manoeuvre.name)
    why = capital(manoeuvre.why)
    time = f" For about {manoeuvre.minutes:.0f} min." if manoeuvre.minutes else ""
    do = f"<p><strong>Do this:</strong> {html.escape(manoeuvre.do)}.{time}</p>"
    if ideal is None:
        return [Shown("next", "What to do next", f"{why}.", html=do, main=False)]
    robot = diagnosis.robot
    figure = manoeuvre_figure(ideal, robot, pace_of(diagnosis.runs, robot))
    return [Shown("next", "What to drive next, to scale", f"{why}.", {"": figure}, html=do)]


def _sketches(diagnosis: Diagnosis) -> list[Shown]:
    """All other effects that were considered, for reference."""
    said = {*diagnosis.found, *diagnosis.rivals}
    cards = [
        effect_card(effect)
        for item in diagnosis.ranking
        if item.effect not in said and (effect := diagnosis.effect_named(item.effect))
    ]
    if not cards:
        return []
    return [
        Shown(
            "others",
            "The other effects that were weighed",
            "What each of them is; none was needed, or none fits.",
            html=f'<details class="toolbar"><summary>Show {len(cards)} sketches</summary>'
            f'<div class="cards">{"".join(cards)}</div></details>',
            main=False,
        )
    ]
