# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Parts of a document as text and on a page, what draws it, and files that cannot be made."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

import pytest
from plotly.offline import get_plotlyjs_version

from test.evidence import in_evidence
from werrimbi_odom.errors import InputError
from werrimbi_odom.report import save
from werrimbi_odom.report.document import Document, Paragraph, Shown, Table, paragraphs
from werrimbi_odom.report.html_page import as_html, drawing_program, page_html
from werrimbi_odom.report.save import save_report
from werrimbi_odom.report.terminal import as_text


def document(shown: Sequence[Shown]) -> Document:
    return Document(title="T", words=[Paragraph("W")], draw=lambda: shown)


def test_paragraphs_stay_apart_however_long_their_lines_are() -> None:
    """A line that is full to the last column was once taken to go on in the next paragraph."""
    sure = Paragraph("How sure: " + "s" * 60 + ".", hanging=True)
    costs = Paragraph("What-it-costs: little.", hanging=True)
    assert as_text([sure, costs]) == f"{sure.text}\n{costs.text}"
    assert as_html([sure, costs]) == f"<p>{sure.text}</p>\n<p>{costs.text}</p>"


def test_commands_stay_as_they_are() -> None:
    text = "    werrimbi add x \\\n      train/* \\\n      --out NEW.yaml"
    parts = paragraphs(["Next: add it:", text])
    assert as_text(parts) == f"Next: add it:\n{text}"
    assert "<pre>werrimbi add x \\\n  train/* \\\n  --out NEW.yaml</pre>" in as_html(parts)


def test_points_are_a_list_and_names_are_no_html() -> None:
    words = paragraphs(["Head <b>.", "- one", "", "- two `cmd`", "End."])
    found = page_html(Document(title="T", words=words))
    assert '<p class="headline">Head &lt;b&gt;.</p>' in found
    assert "<ul><li>one</li><li>two <code>cmd</code></li></ul>" in found


def test_a_command_with_a_thousand_drives_is_folded_and_whole() -> None:
    """Below the figures of a year of drives came 15,000 pixels of their paths."""
    few, many = (" ".join(f"drive_{number}" for number in range(count)) for count in (20, 1000))
    words = [Paragraph("W")]
    found = page_html(Document(title="T", words=words, made={"few": few, "many": many}))
    assert f"<dd>{few}</dd>" in found
    assert f"<dd><details><summary>{many[:200]} ...</summary>{many}</details></dd>" in found


def test_a_table_is_a_table_though_cells_are_empty() -> None:
    rows = [["a", "", "2 mm"], ["b", "1", ""]]
    table = Table("Title", ("effect", "chance", "with it"), rows, rest="and 1 more")
    found = as_html([table])
    assert "<caption><span>Title</span></caption>" in found
    assert '<th scope="col">with it</th>' in found
    assert '<tr><th scope="row">a</th><td></td><td>2 mm</td></tr>' in found
    assert as_text([Paragraph("Above."), table, Paragraph("Below.")]).splitlines() == [
        "Above.",
        "",
        "Title",
        "  effect  chance  with it",
        "  a                  2 mm",
        "  b            1",
        "  and 1 more",
        "",
        "Below.",
    ]


def test_names_and_their_words_have_no_heads() -> None:
    long = " ".join(["words"] * 20)
    found = as_html([Table("Title", (), [["name", long]])])
    assert "<thead>" not in found
    assert f'<th scope="row">name</th><td class="words">{long}</td>' in found


def test_no_text_of_a_page_ends_its_script() -> None:
    import plotly.graph_objects as go

    figure = go.Figure().add_scatter(x=[1], y=[1], name="</script><script>alert(1)</script>")
    text = page_html(document([Shown("a", "A", "See.", {"": figure})]))
    assert "alert(1)</script>" not in text
    assert 'http-equiv="Content-Security-Policy"' in text


def test_another_ending_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"ends in \.html, \.pdf or \.png"):
        save_report(document([]), tmp_path / "page.docx")


def test_pictures_without_a_browser_say_what_to_install(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    import plotly.graph_objects as go

    monkeypatch.setattr(save, "find_browser", lambda: None)
    page = document([Shown("a", "A", "See.", {"": go.Figure()})])
    with pytest.raises(InputError, match=r"apt install chromium.*\.html needs none"):
        save_report(page, tmp_path / "page.pdf")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("kind", [in_evidence("pdf"), "png"])
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
    files = save_report(document(shown), tmp_path / f"page.{kind}")
    assert [file.name for file in files] == [f"page.{kind}", f"page-two.{kind}"]
    head = {"pdf": b"%PDF-", "png": b"\x89PNG"}[kind]
    assert all(file.read_bytes().startswith(head) for file in files)
    assert sorted(tmp_path.iterdir()) == sorted(files)


def test_it_is_of_the_version_that_plotly_makes_figures_for() -> None:
    head = drawing_program().read_text(encoding="utf-8")[:200]
    found = re.search(r"plotly\.js \(cartesian - minified\) v([\d.]+)", head)
    assert found is not None, head
    assert found[1] == get_plotlyjs_version(), "see werrimbi_odom/report/plotly_js/README.md"
