# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Step 2: the missing effect; ranking, explanation, and evidence map."""

from __future__ import annotations

from functools import partial

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis
from werrimbi_odom.inference.diagnosis.evidence import Dependence
from werrimbi_odom.inference.diagnosis.ranking import Ranked
from werrimbi_odom.inference.diagnosis.step_jacobians import CHANNELS
from werrimbi_odom.inference.manoeuvres.advice import AdvisedDiagnosis, beyond_chance
from werrimbi_odom.report.diagnosis.dependence import dependence_words, short_words
from werrimbi_odom.report.diagnosis.evidence_figures import best_by_name
from werrimbi_odom.report.diagnosis.next_steps import NextSteps
from werrimbi_odom.report.diagnosis.remarks import at_bounds_words
from werrimbi_odom.report.diagnosis.words import words_of
from werrimbi_odom.report.number_format import capital, chance_words, listed
from werrimbi_odom.workbench.html import box, button, figure, prose, text
from werrimbi_odom.workbench.leg_selection import CellPart
from werrimbi_odom.workbench.session import Diagnosed
from werrimbi_odom.workbench.tab import Tab, size_told
from werrimbi_odom.workbench.views.side_panels import floor, why

SHORT = 5
"""Paragraphs of the verdict that are shown at first."""

MOST_ROWS = 12
"""Most variables in the map."""

STEPS = NextSteps(
    add=lambda names: "press Add below" if len(names) == 1 else "press Add all below",
    again=lambda names: "",
    draft="werrimbi draft, on the command line",
    diagnose="step 2, Diagnose",
)


def diagnose_view(tab: Tab) -> None:
    """Before the diagnosis: what it does. After: verdict, ranking, map."""
    text("h2", "Which effect is missing?", tabindex="-1", data_key="title-diagnose")
    found = tab.session.diagnosis
    if found is None:
        _ask(tab)
        return
    with box("div", "columns"):
        with box("div", "left"):
            _verdict(found.advised)
            _add_all(tab, found.diagnosis)
            _ranking(tab, found.diagnosis)
            _before_after(tab, found)
        with box("div", "right"):
            if tab.why is not None:
                why(tab, tab.why)
            _following(tab, found)
    _map(tab, found.diagnosis)


def _ask(tab: Tab) -> None:
    count = len(tab.shared.collection.effects)
    drives = ", ".join(dict.fromkeys(tab.shared.opened.judged_on))
    text(
        "p",
        f"All {count} known physical effects are tried on the fitted drives, and judged on drives "
        f"that take no part in the fit ({drives}). It takes some seconds to a minute, and can be "
        "cancelled.",
    )
    if tab.job is None:
        button(tab, "Diagnose", tab.diagnose, key="diagnose", classes="primary")
    with box("div", "columns"):
        with box("div", "left"):
            text("h3", "The effects that are tried; press one to read about it")
            with box("ul", "library" if tab.why is not None else "library two"):
                for effect in tab.shared.collection.effects:
                    with box("li"):
                        button(
                            tab,
                            effect.name,
                            partial(_open, tab, effect.name),
                            key=f"why-{effect.name}",
                            aria_expanded="true" if tab.why == effect.name else "false",
                        )
                        text("span", effect.summary)
        if tab.why is not None:
            with box("div", "right"):
                why(tab, tab.why)


def _verdict(found: AdvisedDiagnosis) -> None:
    parts = words_of(found, STEPS)
    with box("div", "verdict"):
        text("p", parts[0].text, "headline", data_key="verdict")
        prose(parts[1:SHORT])
        if len(parts) > SHORT:
            with box("details"):
                text("summary", "More words")
                prose(parts[SHORT:])


def _add_all(tab: Tab, diagnosis: Diagnosis) -> None:
    """One button for all found effects, fitted together."""
    names = [name for name in diagnosis.found if _can(tab, name)]
    if diagnosis.verdict != "named" or len(names) < 2:
        return
    with box("p", "following"):
        button(
            tab,
            "Add all",
            lambda: tab.add(*names),
            key="add-all",
            classes="primary",
            disabled=tab.job is not None,
            aria_label=f"Add {listed(names)} together",
        )
        text("span", f"{listed(names)}, fitted together")


def _ranking(tab: Tab, diagnosis: Diagnosis) -> None:
    ranked = [item for item in diagnosis.ranking if item.holdout is not None]
    rest = [item for item in diagnosis.ranking if item.holdout is None]
    text("h3", "Effects, best first: held-out error without it and with it")
    with box("ol", "ranking"):
        for item in ranked:
            _ranked(tab, item, diagnosis)
    if rest:
        with box("details"):
            text("summary", f"{len(rest)} more, not worth a fit on these drives")
            with box("ol", "ranking"):
                for item in rest:
                    _ranked(tab, item, diagnosis)


def _ranked(tab: Tab, item: Ranked, diagnosis: Diagnosis) -> None:
    found = item.effect in diagnosis.found
    with box("li", "found" if found else ""):
        with box("div", "name"):
            text("strong", item.effect)
            text("span", _by_chance(item, diagnosis), "chance")
        if item.holdout is not None:
            _bars(item, diagnosis)
        with box("div", "do"):
            button(
                tab,
                "Why?",
                lambda: _open(tab, item.effect),
                key=f"why-{item.effect}",
                aria_label=f"Why {item.effect}?",
                aria_expanded="true" if tab.why == item.effect else "false",
            )
            button(
                tab,
                "Add",
                lambda: tab.add(item.effect),
                key=f"add-{item.effect}",
                classes="primary" if found else "",
                disabled=tab.job is not None or not _can(tab, item.effect),
                aria_label=f"Add {item.effect}",
            )


def _before_after(tab: Tab, found: Diagnosed) -> None:
    """The set-up, or the error over the effect's own variable, before and after."""
    drawn = found.before_after
    if drawn is not None:
        text("h3", drawn.title)
        text("p", drawn.see)
        figure(drawn.figure, tab.dark, "Figure: error before and after", "plot low")


def _following(tab: Tab, found: Diagnosed) -> None:
    """The manoeuvre to drive next."""
    manoeuvre = found.advised.manoeuvre
    if manoeuvre is None:
        return
    text("h3", "What to do next")
    minutes = f", for about {manoeuvre.minutes:.0f} min" if manoeuvre.minutes else ""
    text("p", f"{capital(manoeuvre.do)}{minutes}: {manoeuvre.why}.")
    if found.manoeuvre is not None:
        figure(found.manoeuvre, tab.dark, "Figure: the path to drive, to scale", "plot low")


def _by_chance(item: Ranked, diagnosis: Diagnosis) -> str:
    wild = at_bounds_words(diagnosis).get(item.effect)
    if wild is not None:
        return f"only with {wild}, the limit of what physics allows"
    if item.p_value is not None and item.p_value > rules.SURE:
        return "not seen in these drives"
    return chance_words(item.p_value)


def _can(tab: Tab, name: str) -> bool:
    return any(effect.name == name for effect in tab.shared.collection.effects)


def _open(tab: Tab, name: str) -> None:
    tab.why = name
    tab.changed(f"page-{name}")


def _bars(item: Ranked, diagnosis: Diagnosis) -> None:
    """Two bars for the held-out error before and after, on one scale for all effects."""
    assert item.holdout is not None
    sides = [one.holdout for one in diagnosis.ranking if one.holdout is not None]
    top = max(max(one.before, one.after) for one in sides)
    before, after = item.holdout.before, item.holdout.after
    unit = item.holdout.unit
    told = " → ".join(size_told(value, unit) for value in (before, after))
    with box("div", "beforeafter", role="img", aria_label=f"Held-out error {told}"):
        for value, kind in ((before, "before"), (after, "after")):
            share = 100.0 * value / top if top > 0.0 and value == value else 0.0
            box("div", f"bar {kind}").style(f"width: {min(share, 100.0):.1f}%")
    text("span", told, "told")


def _map(tab: Tab, diagnosis: Diagnosis) -> None:
    """Table of error channels and variables, with a button in each significant cell."""
    text("h3", "Evidence: which error goes with what", tabindex="-1", data_key="map")
    best = best_by_name(beyond_chance(diagnosis.depends_on))
    labels = {name: short_words(cell) for (name, _), cell in best.items()}
    names = list(labels)[:MOST_ROWS]
    if not names:
        text("p", "The errors go with nothing that was measured.")
        return
    text(
        "p",
        "Before any name is given to it, calibration apart. The more marks, the surer: ● beyond "
        "chance, ●● sure, ●●● very sure. Press a cell to see its legs on the floor.",
    )
    with box("div", "columns"):
        place = box("div", "left wide", tabindex="0", role="group", aria_label="Evidence map")
        with place, box("table", "map"):
            text("caption", "Evidence map", "unseen")
            with box("thead"), box("tr"):
                text("th", "goes with", scope="col")
                for channel in CHANNELS:
                    text("th", channel, scope="col")
            with box("tbody"):
                for name in names:
                    with box("tr"):
                        text("th", labels[name], scope="row")
                        for channel in CHANNELS:
                            with box("td"):
                                _cell(tab, name, channel, best.get((name, channel)))
        if isinstance(tab.part, CellPart):
            with box("div", "right"):
                pressed = best.get((tab.part.variable, tab.part.channel))
                if pressed is not None:
                    words = capital(dependence_words(pressed))
                    text("p", f"{words} ({chance_words(pressed.p_value)}).")
                floor(tab)


def _cell(tab: Tab, name: str, channel: str, cell: Dependence | None) -> None:
    if cell is None:
        text("span", "·", "nothing", aria_label="nothing")
        return
    marks = 1 + (cell.p_value < 1e-10) + (cell.p_value < 1e-40)
    part = CellPart(channel, name)
    key = f"cell-{name}-{channel}"
    sure = ("beyond chance", "sure", "very sure")[marks - 1]
    button(
        tab,
        "●" * marks,
        lambda: tab.point(part, key),
        key=key,
        classes=f"cell level{marks}",
        aria_label=f"{channel} error with {short_words(cell)}: {sure}",
        aria_pressed="true" if tab.part == part else "false",
        title=dependence_words(cell),
    )
