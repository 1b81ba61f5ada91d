# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Reports in a real browser: they draw themselves, ask for nothing, and answer to clicks and keys.

Skipped where no Chrome or Chromium is installed.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from itertools import chain
from pathlib import Path
from typing import Any

import pytest
from browser import Visit

from test.axe import RUN
from test.report.test_accessible import assert_obeyed, rules

Look = Callable[..., Visit]
Page = Callable[[str], Path]

UNDRAWN = "[...document.querySelectorAll('[data-figure]')].filter(f => !f.dataset.drawn).length"
FIGURES = "document.querySelectorAll('.figure .main-svg').length"
PAPER = "getComputedStyle(document.body).backgroundColor"
FIGURE_PAPER = "document.querySelector('.figure')._fullLayout.paper_bgcolor"


def assert_well_drawn(visit: Visit) -> None:
    assert visit.complaints == []
    assert visit.requests == []
    undrawn, figures = visit.answers[:2]
    assert undrawn == 0
    assert figures > 0


LABELS = (
    "[...document.querySelectorAll('.figure, svg.sketch')]"
    ".filter(f => !(f.getAttribute('aria-label') || '').length).length",
    "[...document.querySelectorAll('select')].filter(s => !s.labels.length).length",
    "[...document.querySelectorAll('.figure')].filter(f => f.tabIndex !== 0).length",
    "document.documentElement.lang",
)
"""Figures and choices without a label, figures that Tab misses, and the language."""
ALL_LABELLED = [0, 0, 0, "en"]

ASKED = {
    "colours": (PAPER, FIGURE_PAPER),
    "labels": LABELS,
    "uploads": (
        "[...document.querySelectorAll('.modebar-btn')].map(item => item.dataset.title)",
        "[...document.querySelectorAll('.figure')].map(item => item._context.plotlyServerURL)",
    ),
    "names": (
        "[...document.querySelectorAll('select[data-for=path] option')].map(o => o.textContent)",
        "werrimbi.choose('against', 5).then(() => document.querySelectorAll('b').length)",
        "document.getElementById('figure-against').data.map(t => t.name)",
    ),
}


NAMELESS = "document.querySelector('main').append(document.createElement('button')), true"


@pytest.fixture(scope="module")
def seen(page: Page, look: Look) -> dict[str, list[Any]]:
    """What one visit to the comparison saw, in the light."""
    asked = {**ASKED, "rules": rules(), "nameless": (NAMELESS, RUN)}
    visit = look(page("compare"), UNDRAWN, FIGURES, *chain(*asked.values()))
    assert_well_drawn(visit)
    answers = iter(visit.answers[2:])
    return {name: [next(answers) for _ in group] for name, group in asked.items()}


def test_no_rule_of_axe_is_broken_and_one_that_were_would_be_seen(
    seen: dict[str, list[Any]],
) -> None:
    assert_obeyed(seen["rules"])
    _, broken = seen["nameless"]
    assert any(words.startswith("button-name") for words in broken), "the rules are really asked"


@pytest.mark.evidence
def test_no_rule_is_broken_by_a_diagnosis_in_the_dark_on_a_telephone(
    page: Page, look: Look
) -> None:
    visit = look(page("diagnose"), *rules(), dark=True, width=390)
    assert_obeyed(visit.answers)
    assert visit.complaints == []


def test_a_comparison_draws_itself_in_the_light(seen: dict[str, list[Any]]) -> None:
    assert [colour.upper() for colour in seen["colours"]] == ["RGB(255, 255, 255)", "#FFFFFF"]


@pytest.mark.evidence
def test_a_comparison_draws_itself_in_the_dark(page: Page, look: Look) -> None:
    visit = look(page("compare"), UNDRAWN, FIGURES, PAPER, FIGURE_PAPER, dark=True)
    assert_well_drawn(visit)
    assert [colour.upper() for colour in visit.answers[2:]] == ["RGB(21, 24, 28)", "#15181C"]


@pytest.mark.evidence
def test_the_switch_turns_page_and_figures_dark(page: Page, look: Look) -> None:
    visit = look(
        page("compare"),
        UNDRAWN,
        FIGURES,
        "document.getElementById('theme').click(), new Promise(done => setTimeout(done, 3000))",
        "document.documentElement.dataset.theme",
        "[...document.querySelectorAll('[data-figure]')].map(f => f.dataset.drawn)",
    )
    assert_well_drawn(visit)
    assert visit.answers[3] == "dark"
    assert set(visit.answers[4]) == {"dark"}


def test_a_name_from_a_record_is_text_and_not_html(seen: dict[str, list[Any]]) -> None:
    options, bold, names = seen["names"]
    assert options == ["all 3 drives", "first", "second", "<b>third</b> & last"]
    assert bold == 0
    assert any(name and name.startswith("&lt;b&gt;third&lt;/b&gt; &amp; last:") for name in names)


def test_no_figure_offers_to_be_uploaded(seen: dict[str, list[Any]]) -> None:
    """Plotly 4 does so, if it is not told otherwise."""
    buttons, addresses = seen["uploads"]
    assert "Zoom" in buttons
    assert not [title for title in buttons if re.search("share|upload|cloud|edit", title, re.I)]
    assert set(addresses) == {""}


def test_every_figure_has_a_label_and_every_choice_too(seen: dict[str, list[Any]]) -> None:
    assert seen["labels"] == ALL_LABELLED


@pytest.mark.evidence
def test_what_is_looked_at_is_drawn_first(page: Page, look: Look) -> None:
    """A link to the last figure does not wait for the others; in the end all are drawn."""
    visit = look(
        page("compare"),
        UNDRAWN,
        FIGURES,
        "(() => { location.hash = '#against'; const order = []; "
        "new MutationObserver(all => all.forEach(one => order.push(one.target.dataset.figure)))"
        ".observe(document.querySelector('main'), {subtree: true, attributeFilter: "
        "['data-drawn']}); return werrimbi.show(true).then(() => order); })()",
    )
    assert_well_drawn(visit)
    order = list(dict.fromkeys(visit.answers[2]))
    assert order.index("against") < order.index("path")
    assert set(order) == {"path", "motion", "nees", "against"}


def test_paper_has_every_figure_on_white(page: Page, look: Look) -> None:
    """Printed the moment it opens, in the dark, before anything else is drawn."""
    visit = look(
        page("compare"),
        UNDRAWN,
        FIGURES,
        "(() => { werrimbi.show(true); dispatchEvent(new Event('beforeprint')); "
        "return new Promise(done => setTimeout(() => done("
        "[...document.querySelectorAll('[data-figure]')].map("
        "f => [f.dataset.drawn, f._fullLayout.width])), 2000)); })()",
        "(() => { dispatchEvent(new Event('afterprint')); "
        "return new Promise(done => setTimeout(() => done("
        "[...document.querySelectorAll('[data-figure]')].map(f => f.dataset.drawn)), 3000)); })()",
        dark=True,
    )
    assert_well_drawn(visit)
    assert visit.answers[2] == [["light", 690]] * 4
    assert set(visit.answers[3]) == {"dark"}


def test_keys_move_and_zoom_a_figure(page: Page, look: Look) -> None:
    press = (
        "(() => {{ const f = document.getElementById('figure-path'); f.focus(); "
        "f.dispatchEvent(new KeyboardEvent('keydown', {{key: '{}'}})); "
        "return new Promise(done => setTimeout(() => done(f._fullLayout.xaxis.range), 500)); }})()"
    )
    visit = look(
        page("compare"),
        UNDRAWN,
        FIGURES,
        "document.getElementById('figure-path')._fullLayout.xaxis.range",
        press.format("ArrowRight"),
        press.format("+"),
        "document.activeElement.id",
    )
    assert_well_drawn(visit)
    first, moved, near, focus = visit.answers[2:]
    assert moved[0] > first[0]
    assert moved[1] > first[1]
    assert near[1] - near[0] < 0.8 * (moved[1] - moved[0])
    assert focus == "figure-path"


def test_the_evidence_map_is_there_and_a_click_opens_the_dependence(page: Page, look: Look) -> None:
    strongest = (
        "(() => { const f = document.getElementById('figure-evidence'), t = f.data[0]; "
        "let best = [-1]; f.calcdata[0][0].z.forEach((row, i) => row.forEach((v, j) => "
        "{ if (v !== null && v > best[0]) best = [v, i, j]; })); "
        "return [t.y[best[1]], t.x[best[2]]]; })()"
    )
    visit = look(
        page("diagnose"),
        UNDRAWN,
        FIGURES,
        strongest,
        "document.querySelectorAll('#evidence [data-open]').length",
        "document.querySelector('[data-open=\"cell:3\"]').click(), "
        "new Promise(done => setTimeout(done, 1500))",
        "document.querySelector('select[data-for=cell]').value",
        "(() => { const f = document.getElementById('figure-evidence'); "
        "const custom = f.data[0].customdata[0][1]; "
        "f.emit('plotly_click', {points: [{customdata: custom}]}); "
        "return new Promise(done => setTimeout(() => done("
        "[String(custom[3]), document.querySelector('select[data-for=cell]').value]), 1500)); })()",
        *LABELS,
    )
    assert_well_drawn(visit)
    assert visit.answers[2] == ["left", "left wheel's angle"]
    assert visit.answers[3] > 0
    assert visit.answers[5] == "3"
    asked, shown = visit.answers[6]
    assert asked == shown
    assert visit.answers[7:] == ALL_LABELLED


@pytest.mark.evidence
@pytest.mark.parametrize("verb", ["add", "fit"])
def test_the_reports_of_other_verbs_draw_themselves(verb: str, page: Page, look: Look) -> None:
    visit = look(page(verb), UNDRAWN, FIGURES, FIGURE_PAPER, dark=True)
    assert_well_drawn(visit)
    assert visit.answers[2].upper() == "#15181C"
