# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""docs/effects.md is current, and the effects that it tells users to write keep the laws."""

from __future__ import annotations

import re
from pathlib import Path
from runpy import run_path

import pytest

from werrimbi_odom.effects import LIBRARY, load_file
from werrimbi_odom.effects.contract import check_effect
from werrimbi_odom.effects.effect_docstring import as_json, as_text, page_of

PAGE = Path(__file__).parents[2] / "docs" / "effects.md"
with_chapter = run_path(str(PAGE.with_name("make_effects.py")))["with_chapter"]


def test_the_page_is_current() -> None:
    text = PAGE.read_text(encoding="utf-8")
    assert with_chapter(text) == text, "python docs/make_effects.py"


def test_it_needs_its_two_marks() -> None:
    with pytest.raises(ValueError, match="needs the two lines"):
        with_chapter("no marks here")


def examples() -> list[str]:
    return re.findall(r"```python\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)


def test_the_whole_example_is_a_file_of_25_lines_that_keeps_the_laws(tmp_path: Path) -> None:
    whole = examples()[0]
    assert len([line for line in whole.splitlines() if line.strip()]) <= 25
    file = tmp_path / "my_robot_effects.py"
    file.write_text(whole)
    (effect,) = load_file(file)
    assert effect.name == "tread_lies_down"
    check_effect(effect)


def test_its_test_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "my_robot_effects.py").write_text(examples()[0])
    monkeypatch.syspath_prepend(str(tmp_path))
    names: dict[str, object] = {}
    exec(examples()[1], names)
    names["test_my_effect_has_the_properties"]()  # type: ignore[operator]


def test_the_example_with_a_twin_keeps_them_too(tmp_path: Path) -> None:
    file = tmp_path / "with_twin.py"
    file.write_text(examples()[3])
    (effect,) = load_file(file)
    check_effect(effect)
    assert "hang a plumb line" in page_of(effect).sections["Twins"]


def test_the_example_with_a_channel_keeps_them_too(tmp_path: Path) -> None:
    head = examples()[0].split("@wheel_effect")[0]
    file = tmp_path / "with_payload.py"
    file.write_text(head + examples()[2])
    (effect,) = load_file(file)
    assert effect.channels == ("payload_kg",)
    check_effect(effect)


@pytest.mark.parametrize("effect", LIBRARY, ids=lambda effect: effect.name)
def test_every_effect_has_a_page(effect: object) -> None:
    page = page_of(effect)  # type: ignore[arg-type]
    assert len(page.physics) > 1, "a summary, and some sentences of physics"
    assert all(page.sections.values())
    text, figures = as_text(effect), as_json(effect)  # type: ignore[arg-type]
    assert page.sections["Ruler"].split()[0] in text
    assert figures["formula"] == page.sections["Formula"]
