# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What a fleet is told in, for every verdict; and that docs/fleet.md shows it so."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from test.evidence import in_evidence
from test.report.browser import visit
from werrimbi_odom.report.fleet import Fleet, Row, fleet_json, headline, words_of
from werrimbi_odom.report.fleet_document import (
    cells,
    fleet_figure,
    fleet_table,
    missing_words,
    next_words,
    write_fleet_page,
)
from werrimbi_odom.report.save import find_browser
from werrimbi_odom.report.terminal import as_text

PAGE = Path(__file__).parents[2] / "docs" / "fleet.md"


def fitted(value: float | None, std: float | None, unit: str, per_run: bool = False) -> Any:
    return {"value": value, "std": std, "unit": unit, "per_run": per_run}


def row(name: str, verdict: str, before: float, after: float, **more: Any) -> Row:
    """A robot of eleven drives; `found` maps effects to their parameters."""
    found: Mapping[str, Any] = more.pop("found", {})
    figures = {
        "verdict": verdict,
        "rivals": [],
        "found": [{"effect": effect, "parameters": found[effect]} for effect in found],
        "holdout": {"before": before, "after": after},
        "next_manoeuvre": None,
        "depends_on": [],
        "outdated": [],
        **more,
    }
    return Row(name, 11, figures)


def slips(name: str, before: float, after: float, creep: float, std: float = 1.1e-4) -> Row:
    values = {"lateral_slip": {"creep": fitted(creep, std, "s")}}
    return row(name, "named", before, after, found=values)


WIDE = row(
    "robot_3",
    "named",
    0.0037,
    0.0023,
    found={"track_width": {"multiplier": fitted(1.02003, 0.000117, "")}},
)
RIVALS = row(
    "robot_4",
    "ambiguous",
    0.004,
    0.003,
    found={"reference_delay": {"delay": fitted(0.02, 0.001, "s")}, "castor_kick": {}},
    rivals=["reference_delay", "reference_lever_arm"],
    next_manoeuvre={"name": "arcs", "why": "", "do": "", "minutes": 2.4},
)
BY_HAND = row(
    "robot_5",
    "ambiguous",
    0.004,
    0.003,
    rivals=["sideways_drift", "reference_yaw_offset"],
    next_manoeuvre={"name": "remount_reference", "why": "", "do": "", "minutes": 0.0},
)
WARM = row("robot_6", "unknown", 0.3, 0.3, depends_on=[{"words": "the left wheel goes with x"}])
GOOD = row("robot_7", "none", 0.002, 0.002)
BAD = Row("robot_8", 2, None, "robot_8/<train>: no ticks")
ALL = Fleet((slips("robot_1", 0.0075, 0.0025, 0.03), WIDE, RIVALS, BY_HAND, WARM, GOOD, BAD))


def test_a_value_that_the_file_has_wrong_is_to_be_fitted_anew() -> None:
    old = row("robot_9", "none", 0.008, 0.002, outdated=[{"effect": "castor_kick"}])
    assert cells(old)[3:] == ["nothing", "8.0 → 2.0", "add castor_kick"]


def test_all_that_is_missing_is_to_be_added_and_headings_err_in_degrees() -> None:
    turned = {"before": None, "after": None, "rmse_yaw_rad": {"before": 0.02, "after": 0.003}}
    both = {"unequal_wheel_radii": {}, "track_width": {}}
    late = row("robot_9", "named", math.nan, math.nan, holdout=turned, found=both)
    assert cells(late)[4:] == ["1.15° → 0.17°", "add unequal_wheel_radii,track_width"]


def test_the_page_of_the_docs_shows_what_is_printed() -> None:
    rows = (
        slips("robot_1", 0.0075, 0.0025, 0.0299448, 7.8e-5),
        slips("robot_2", 0.0082, 0.0024, 0.03011, 1.04e-4),
        WIDE,
    )
    fleet = Fleet(rows, (), frozenset(each.robot for each in rows))
    shown = PAGE.read_text(encoding="utf-8")
    assert as_text(words_of(fleet)) in shown
    assert fleet_table(fleet) in shown


def test_every_verdict_is_counted() -> None:
    assert headline(ALL) == (
        "7 robots: 1 misses nothing, 1 misses lateral_slip, 1 misses track_width, 2 ambiguous, "
        "1 unknown, 1 could not be diagnosed."
    )


def test_what_is_missing_and_what_to_do_fit_a_row() -> None:
    said = {each.robot: cells(each)[3:] for each in ALL.rows}
    assert said == {
        "robot_1": ["lateral_slip:\n  creep 0.03000 ± 0.00011 s", "7.5 → 2.5", "add lateral_slip"],
        "robot_3": ["track_width:\n  multiplier 1.02003 ± 0.00012", "3.7 → 2.3", "add track_width"],
        "robot_4": [
            "reference_delay or reference_lever_arm\ncastor_kick",
            "4.0 → 3.0",
            "drive arcs (2 min)",
        ],
        "robot_5": ["sideways_drift or reference_yaw_offset", "4.0 → 3.0", "remount reference"],
        "robot_6": ["the left wheel goes with x", "300 → 300", "draft"],
        "robot_7": ["nothing", "2.0 → 2.0", ""],
        "robot_8": ["could not be diagnosed", "", "see above"],
    }


def test_a_size_that_the_drives_do_not_tell_is_left_out() -> None:
    """A hard start has a threshold that soft drives do not show, and a ± may not be known."""
    hard = {"coefficient": fitted(0.03, None, "s^2/m"), "above": fitted(None, None, "m/s^2")}
    spun = row("robot_9", "named", 0.008, 0.002, found={"coulomb_slip": hard})
    assert missing_words(spun) == ["coulomb_slip:\n  coefficient 0.03 s^2/m"]
    untold = {"coulomb_slip": {"above": fitted(None, None, "m/s^2")}}
    assert missing_words(row("robot_9", "named", 0.008, 0.002, found=untold)) == ["coulomb_slip"]


def test_what_is_ambiguous_is_not_missing_for_certain() -> None:
    figures = fleet_json(ALL)
    assert figures["missing"] == {
        "castor_kick": ["robot_4"],
        "lateral_slip": ["robot_1"],
        "track_width": ["robot_3"],
    }
    assert figures["verdicts"] == {"ambiguous": 2, "error": 1, "named": 2, "none": 1, "unknown": 1}


def test_what_noise_could_have_made_and_what_each_drive_has_anew_is_left_out() -> None:
    values = {
        "amplitude": fitted(0.001, 0.0001, "m"),
        "drift": fitted(0.01, 0.02, "m"),
        "phase": fitted(None, None, "rad", per_run=True),
    }
    one = row("a", "named", 0.004, 0.002, found={"eccentric_left_wheel": values})
    assert cells(one)[3] == "eccentric_left_wheel:\n  amplitude 0.00100 ± 0.00010 m"


def test_a_value_that_one_robot_has_anew_in_each_drive_is_not_compared() -> None:
    shared = {"wheel": {"phase": fitted(0.3, 0.01, "rad")}}
    anew = {"wheel": {"phase": fitted(None, None, "rad", per_run=True)}}
    rows = [row(name, "named", 0.004, 0.002, found=shared) for name in "ab"]
    assert "Fitted phase: 0.3 rad." in as_text(words_of(Fleet(tuple(rows))))
    rows.append(row("c", "named", 0.004, 0.002, found=anew))
    said = as_text(words_of(Fleet(tuple(rows))))
    assert "wheel is missing in 3 of 3" in said
    assert "Fitted" not in said


def test_what_few_robots_share_is_said_of_none() -> None:
    said = as_text(words_of(ALL))
    assert "a matter of their design" not in said
    assert "Missing in one robot alone" in said
    assert "- robot_8 could not be diagnosed: robot_8/<train>: no ticks" in said


def test_hundreds_of_different_troubles_stay_readable() -> None:
    named = [
        row(f"n_{number}", "named", 0.004, 0.002, found={f"effect_{number}": {}})
        for number in range(40)
    ]
    bad = [Row(f"b_{number}", 1, None, "broken") for number in range(40)]
    said = as_text(words_of(Fleet((*named, *bad), tuple(f"l_{number}" for number in range(40)))))
    assert "34 miss something else" in said
    assert "and 30 more; --json has the reason" in said
    assert "40 of 120 are left, l_0, " in said
    assert len(said.splitlines()) < 30


@pytest.mark.parametrize("width", [80, 100, 140])
def test_the_table_fits_its_width(width: int) -> None:
    long = slips(f"robot_of_the_{'very_' * 8}long_name", 0.5, 0.01, 0.03)
    text = fleet_table(Fleet((*ALL.rows, long)), width)
    assert max(map(len, text.splitlines())) <= width
    column = "".join(line[:21].strip() for line in text.splitlines())
    assert long.robot in column  # over several lines, but whole


def test_errors_a_hundred_times_apart_are_drawn_on_a_logarithmic_axis() -> None:
    figure = fleet_figure(ALL)
    assert figure is not None
    assert figure.layout.xaxis.type == "log"
    near = fleet_figure(Fleet(ALL.rows[:2]))
    assert near is not None
    assert near.layout.xaxis.type is None
    assert near.layout.xaxis.range[0] == 0.0
    assert fleet_figure(Fleet((BAD,))) is None


@pytest.mark.parametrize("dark", [False, in_evidence(True)])
def test_the_page_draws_itself_without_a_complaint(tmp_path: Path, dark: bool) -> None:
    browser = find_browser()
    if browser is None:
        pytest.skip("no Chrome or Chromium is installed")
    pytest.importorskip("choreographer", reason="choreographer (kaleido's) drives the browser")
    (written,) = write_fleet_page(ALL, tmp_path / "fleet.html", {"fleet": "here"})
    rows = "[...document.querySelectorAll('#robots tbody tr')].map(row => row.cells[0].innerText)"
    names = (
        "[...document.querySelectorAll('#figure-errors g.ytick')].sort((one, other) => "
        "one.getBoundingClientRect().top - other.getBoundingClientRect().top)"
        ".map(tick => tick.textContent)"
    )
    seen = visit(written, [rows, names], browser=browser, dark=dark)
    assert (seen.complaints, seen.requests) == ([], [])
    assert seen.answers[0] == [each.robot for each in ALL.rows]
    assert seen.answers[1] == [each.robot for each in ALL.rows if each is not BAD]
    assert "&lt;train&gt;" in written.read_text(encoding="utf-8")


def test_a_wheel_that_errs_by_no_law_is_to_be_looked_at_and_no_law_is_drafted() -> None:
    """What the parts of the drives do not agree on, is no floor and no speed of theirs."""
    place = [{"words": "how far the left wheel rolls goes with the place on the floor"}]
    worn = row("robot_9", "unknown", 0.009, 0.009, depends_on=place)
    assert (missing_words(worn), next_words(worn)) == ([place[0]["words"]], "draft")
    worn = row(
        "robot_9", "unknown", 0.009, 0.009, depends_on=place, one_sided_noise={"side": "left"}
    )
    assert missing_words(worn) == ["the left wheel errs, by no law"]
    assert next_words(worn) == "look at the left wheel"


def test_what_comes_at_each_start_is_to_be_driven_and_no_law_is_drafted() -> None:
    ahead = {"name": "start_stop", "minutes": 8.0}
    kicked = row(
        "robot_9", "unknown", 0.003, 0.003, depends_on=[], by_events=True,
        events_alike={"what": "start or stop"}, next_manoeuvre=ahead,
    )  # fmt: skip
    assert missing_words(kicked) == ["something at each start or stop"]
    assert next_words(kicked) == "drive start stop (8 min)"


def test_what_a_floor_does_by_scans_is_measured_otherwise_and_no_law_is_drafted() -> None:
    wave = [{"words": "how far it slides sideways goes with its heading"}]
    tilted = row("robot_9", "unknown", 0.012, 0.012, depends_on=wave, as_a_floor=True)
    assert next_words(tilted) == "record with motion capture"


def test_of_a_robot_that_changed_the_drives_since_are_asked_and_no_law_is_drafted() -> None:
    place = [{"words": "how far both wheels roll goes with the place on the floor"}]
    loaded = row(
        "robot_9", "unknown", 0.002, 0.002, depends_on=place, drives_differ=True,
        next_manoeuvre=None,
    )  # fmt: skip
    assert missing_words(loaded) == ["not the same in all drives"], "no law of the mean of two"
    assert next_words(loaded) == "diagnose the drives since the change"
