# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Printed text on a page, and files that cannot be made."""

from __future__ import annotations

import textwrap
from pathlib import Path

import pytest

from werrimbi_odom.errors import InputError
from werrimbi_odom.report import save
from werrimbi_odom.report.page import Page, Shown, page_html
from werrimbi_odom.report.save import save_report
from werrimbi_odom.report.text import paragraphs, table, tables, unwrapped

LONG = "One sentence that is longer than a line of eighty columns can hold, so it is wrapped."


def test_wrapped_sentences_are_unwrapped_and_kept_apart() -> None:
    text = "\n".join([textwrap.fill(LONG, 80), textwrap.fill(LONG, 80), "- a point", "Next: this."])
    assert unwrapped(text) == [LONG, LONG, "- a point", "Next: this."]


def test_commands_stay_as_they_are() -> None:
    text = "Next: add it:\n    werrimbi add x \\\n      train/* \\\n      --out NEW.yaml"
    assert unwrapped(text)[1].splitlines() == text.splitlines()[1:]
    assert "<pre>werrimbi add x \\\n  train/* \\\n  --out NEW.yaml</pre>" in paragraphs(text)


def test_points_are_a_list_and_names_are_no_html() -> None:
    found = paragraphs("Head <b>.\n- one\n- two `cmd`\nEnd.")
    assert '<p class="headline">Head &lt;b&gt;.</p>' in found
    assert "<ul><li>one</li><li>two <code>cmd</code></li></ul>" in found


def test_a_printed_table_is_a_table_though_cells_are_empty() -> None:
    printed = table("Title", ("effect", "chance", "with it"), [["a", "", "2 mm"], ["b", "1", ""]])
    found = tables(printed)
    assert "<caption><span>Title</span></caption>" in found
    assert '<th scope="col">with it</th>' in found
    assert '<tr><th scope="row">a</th><td></td><td>2 mm</td></tr>' in found


def test_no_text_of_a_page_ends_its_script() -> None:
    import plotly.graph_objects as go

    figure = go.Figure().add_scatter(x=[1], y=[1], name="</script><script>alert(1)</script>")
    text = page_html(Page("T", "W", [Shown("a", "A", "See.", {"": figure})]))
    assert "alert(1)</script>" not in text
    assert 'http-equiv="Content-Security-Policy"' in text


def test_another_ending_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"ends in \.html, \.pdf or \.png"):
        save_report(Page("T", "W", []), tmp_path / "page.docx")


def test_pictures_without_a_browser_say_what_to_install(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    import plotly.graph_objects as go

    monkeypatch.setattr(save, "find_browser", lambda: None)
    page = Page("T", "W", [Shown("a", "A", "See.", {"": go.Figure()})])
    with pytest.raises(InputError, match=r"apt install chromium.*\.html needs none"):
        save_report(page, tmp_path / "page.pdf")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("kind", ["pdf", "png"])
def test_pictures_for_a_paper_are_a_file_a_figure(tmp_path: Path, kind: str) -> None:
    import plotly.graph_objects as go

    if save.find_browser() is None:
        pytest.skip("no Chrome or Chromium is installed")
    figure = go.Figure().add_scatter(x=[1, 2], y=[1, 2])
    shown = [
        Shown("one", "One", "", {"": figure}),
        Shown("two", "Two", "", {"": figure}),
        Shown("side", "Not for a paper", "", {"": figure}, main=False),
    ]
    files = save_report(Page("T", "W", shown), tmp_path / f"page.{kind}")
    assert [file.name for file in files] == [f"page.{kind}", f"page-two.{kind}"]
    head = {"pdf": b"%PDF-", "png": b"\x89PNG"}[kind]
    assert all(file.read_bytes().startswith(head) for file in files)
    assert sorted(tmp_path.iterdir()) == sorted(files)
