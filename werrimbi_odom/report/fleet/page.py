# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The report of a fleet: words, one figure, and the table of robots."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from werrimbi_odom.errors import InputError
from werrimbi_odom.report.fleet.figure import fleet_figure
from werrimbi_odom.report.fleet.rows import Fleet
from werrimbi_odom.report.fleet.tables import fleet_table_html
from werrimbi_odom.report.fleet.words import words_of
from werrimbi_odom.report.page import Page, Shown
from werrimbi_odom.report.save import save_report


def write_fleet_page(fleet: Fleet, path: Path, made: Mapping[str, str]) -> list[Path]:
    """Write the report; returns the files.

    Parameters
    ----------
    path
        .html for a page, .pdf or .png for the figure alone.
    made
        How it was made: command, files, options.

    Raises
    ------
    InputError
        When it cannot be written, or a picture was asked for and there is nothing to draw.
    """
    page = fleet_page(fleet, made)
    if path.suffix.lower() in (".pdf", ".png") and not any(each.figures for each in page.shown):
        raise InputError(f"--report {path}: no robot has a held-out error to draw; try .html")
    return save_report(page, path)


def fleet_page(fleet: Fleet, made: Mapping[str, str]) -> Page:
    """The report as a page."""
    figure = fleet_figure(fleet)
    shown = []
    if figure is not None:
        shown.append(
            Shown(
                "errors",
                "What each robot would gain",
                "From the hollow mark, as given, to the filled one, with what is missing put in: "
                "the error of drives that took no part in the fit. Colour and mark say what is "
                "missing.",
                {"": figure},
            )
        )
    shown.append(
        Shown(
            "robots",
            "The robots",
            "What each of them is missing, how large that is (± one standard deviation), and what "
            "to do next.",
            html=fleet_table_html(fleet),
        )
    )
    return Page(_title(fleet), words_of(fleet), shown, "", made)


def _title(fleet: Fleet) -> str:
    count = len(fleet.rows)
    return f"What {count} robots are missing" if count != 1 else "What one robot is missing"
