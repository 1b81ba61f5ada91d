# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What the docs show is what the tool does."""

from __future__ import annotations

import importlib.util
import re
import shlex
import sys
from pathlib import Path
from typing import Any

import pytest

from test.command_line import ROOT, Werrimbi
from test.recorded_robots import with_recordings
from werrimbi_odom.cli.main import _parser

README = (ROOT / "README.md").read_text()
PAGES = [
    *(ROOT / name for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md")),
    *sorted((ROOT / "docs").glob("*.md")),
    *sorted((ROOT / "example").rglob("*.md")),
]


def script(name: str) -> Any:
    """One of the scripts of docs/, as a module."""
    spec = importlib.util.spec_from_file_location(name, ROOT / "docs" / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    return module


def test_the_readme_is_short() -> None:
    assert len(README.splitlines()) < 200


def anchors(page: Path) -> set[str]:
    """What its headings are called in links, as GitHub and `make docs` make it of their words."""
    text = re.sub(r"^```.*?^```", "", page.read_text(), flags=re.M | re.S)
    found: dict[str, int] = {}
    for heading in re.findall(r"^#+ +(.+?) *$", text, flags=re.M):
        slug = re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")
        found[slug] = found.get(slug, -1) + 1
        if found[slug]:
            found[f"{slug}-{found[slug]}"] = 0
    return set(found)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_every_link_leads_somewhere(page: Path) -> None:
    text = re.sub(r"^```.*?^```", "", page.read_text(), flags=re.M | re.S)
    for link, anchor in re.findall(r"\]\(([^)#:\s]*)(?:#([^)\s]*))?\)", text):
        target = page.parent / link if link else page
        assert target.exists(), link
        if anchor:
            assert anchor in anchors(target), f"{link}#{anchor}"


def test_the_commands_that_pages_show_have_options_that_there_are() -> None:
    shown = [
        line
        for page in PAGES
        for block in re.findall(r"^```bash\n(.*?)^```", page.read_text(), flags=re.M | re.S)
        for line in block.replace("\\\n", " ").splitlines()
        if line.startswith("werrimbi ")
    ]
    assert len(shown) > 30
    for line in shown:
        words = shlex.split(line, comments=True)[1:]
        assert _parser(words).parse_args(words).verb == words[0], line


def test_the_index_holds_every_page_once() -> None:
    index = (ROOT / "docs" / "index.rst").read_text()
    listed = re.findall(r"^   (\w+)$", index, re.M)
    assert sorted(listed) == sorted(page.stem for page in (ROOT / "docs").glob("*.md"))


def test_source_files_that_pages_name_are_there() -> None:
    there = [path.as_posix() for folder in ("werrimbi_odom", "test", "docs", "benchmark", "example")
             for path in (ROOT / folder).rglob("*.py")]  # fmt: skip
    own = {"my_effect/NAME.py"}  # what a command writes
    named = {
        (page.name, name)
        for page in PAGES
        if page.name != "CHANGELOG.md"  # it tells of what was
        for name in re.findall(r"`([\w./]+\.py)`", page.read_text())
    }
    assert len(named) > 20
    assert {each for each in named if not any(path.endswith(f"/{each[1]}") for path in there)} == {
        ("draft.md", name) for name in own
    }


def test_pages_name_no_place_that_a_stranger_lacks() -> None:
    for page in PAGES:
        assert not re.search(r"\.\./shared|/work\b", page.read_text()), page


@with_recordings
def test_the_table_of_real_robots_is_what_its_command_prints() -> None:
    module = script("real_robots")
    shown = (ROOT / "docs" / "real_robots.md").read_text()
    numbers = re.compile(r"[\d.]+(?:e-?\d+)?")
    for printed in module.table().splitlines()[2:]:
        robot, method = (cell.strip() for cell in printed.split("|")[1:3])
        kept = next(line for line in shown.splitlines() if f"| {robot} | {method} |" in line)
        pairs = zip(numbers.findall(kept), numbers.findall(printed), strict=True)
        for before, now in pairs:
            assert float(now) == pytest.approx(float(before), rel=0.02, abs=0.11)


def test_the_readmes_commands_run(
    tmp_path: Path, werrimbi: Werrimbi, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each `werrimbi` command of the README, on the shipped recording and small tables."""
    monkeypatch.chdir(tmp_path)
    recording = ROOT / "werrimbi_odom" / "recordings" / "square"
    (tmp_path / "my_robot.yaml").write_text((recording / "robot.yaml").read_text())
    offsets = [("ccw", 0.097, -0.094), ("ccw", 0.095, -0.090), ("cw", 0.032, 0.031)]
    offsets.append(("cw", 0.030, 0.034))
    squares = "\n".join(f"{sense},{x},{y}" for sense, x, y in offsets)
    (tmp_path / "UMBMARK.csv").write_text(f"sense,x_m,y_m\n{squares}\n")
    noise = "\n".join(
        f"{0.002 * (-1) ** i},{0.03 * (i % 5 - 2)},{0.004 * (i % 4 - 1.5)}" for i in range(20)
    )
    (tmp_path / "NOISE.csv").write_text(f"ex_m,ey_m,eyaw_rad\n{noise}\n")
    commands = re.findall(r"`(werrimbi calibrate [^`]+)`", README)
    commands += re.findall(r"^(werrimbi (?:odom|explain)[^#\n]*)", README, flags=re.M)
    assert len(commands) >= 4
    for number, command in enumerate(commands):
        table = "UMBMARK.csv" if "umbmark" in command else "NOISE.csv"
        words = command.replace("RESULTS.csv", table).replace("calibrated.yaml", f"{number}.yaml")
        words = words.replace("RUN...", str(recording)).replace("RUN", str(recording))
        werrimbi(*words.split()[1:])


def test_what_is_shown_was_printed_by_commands_that_there_are() -> None:
    """docs/shown.md is whole, and its commands name what exists."""
    module = script("make_shown")
    kept = module.known()
    assert module.page(kept) == module.PAGE.read_text()
    commands = {entry.command for entries in module.SECTIONS.values() for entry in entries}
    assert set(kept) == commands
    for command, output in kept.items():
        assert output != "not run yet", command
        for word in command.split():
            if word.endswith(".py") or word.startswith("test/"):
                assert (ROOT / word).exists(), command
            if word.endswith(".py") and "not evidence" in command:
                tests = (ROOT / word).read_text()
                marked = tests.count("@pytest.mark.evidence")
                assert tests.count("\ndef test_") > marked, f"{command} runs nothing of {word}"
        assert "(ended with" not in output, f"{command}: {output}"
        assert " failed" not in output, f"{command}: {output}"
