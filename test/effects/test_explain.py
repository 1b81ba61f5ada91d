# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi explain` in the terminal, in JSON, without rich, and with effects of one's own."""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

import pytest

from test.command_line import Printed
from werrimbi_odom.cli import explain
from werrimbi_odom.effects import LIBRARY, Collection
from werrimbi_odom.errors import InputError

OWN = '''
from werrimbi_odom.model.effect import Parameter, body_effect

@body_effect(amount=Parameter("rad", 0.0, 0.01, (-1.0, 1.0), "how much"))
def wobble(motion, drive, amount):
    """It wobbles [a lot].

    Formula    turn += amount
    Signature  it wobbles
    Ruler      watch it wobble
    """
    return motion
'''


def run(*words: str) -> int:
    parser = argparse.ArgumentParser()
    explain.add_arguments(parser)
    return explain.run(parser.parse_args(words))


@pytest.fixture(params=["with rich", "without rich"])
def _rich_or_not(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    if request.param == "without rich":
        for name in ("rich", "rich.table", "rich.text", "rich.padding", "rich.console"):
            monkeypatch.setitem(sys.modules, name, None)


@pytest.mark.usefixtures("_rich_or_not")
def test_the_list_has_them_all(capsys: pytest.CaptureFixture[str]) -> None:
    assert run() == 0
    shown = capsys.readouterr().out
    assert all(effect.name in shown for effect in LIBRARY)


@pytest.mark.usefixtures("_rich_or_not")
@pytest.mark.parametrize("effect", LIBRARY, ids=lambda effect: effect.name)
def test_a_page_has_everything(effect: object, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(effect.name) == 0  # type: ignore[attr-defined]
    shown = capsys.readouterr().out
    for word in ("Formula", "Signature", "Ruler"):
        assert word in shown
    for name, item in effect.parameters.items():  # type: ignore[attr-defined]
        assert name in shown
        assert f"typical {item.typical:g}" in shown
    assert effect.summary.split(",")[0][:40] in shown  # type: ignore[attr-defined]


def test_twins_say_what_to_remount(printed: Printed) -> None:
    run("sideways_drift")
    shown = printed()
    assert "reference_yaw_offset (angle = -angle): no drive can tell" in shown
    assert "turned by 90 degrees" in shown


def test_json_of_one_and_of_all(tmp_path: Path) -> None:
    run("castor_kick", "--json", str(tmp_path / "one.json"))
    one = json.loads((tmp_path / "one.json").read_text())
    assert one["effect"] == "castor_kick"
    assert one["parameters"]["length"]["unit"] == "m"
    assert one["parameters"]["length"]["bounds"] == [0.001, 0.5]
    assert one["ruler"]
    run("--json", str(tmp_path / "all.json"))
    everything = json.loads((tmp_path / "all.json").read_text())
    assert [each["effect"] for each in everything["effects"]] == [e.name for e in LIBRARY]
    assert one in everything["effects"]


def test_an_unknown_name_is_told_the_nearest(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="nearest known one is castor_kick"):
        run("castor", "--json", str(tmp_path / "x.json"))
    assert not (tmp_path / "x.json").exists()


def test_effects_of_ones_own(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "own.py"
    file.write_text(OWN)
    run("wobble", "--effects", str(file))
    assert "It wobbles [a lot]." in capsys.readouterr().out
    run("--effects", str(file))
    assert "wobble" in capsys.readouterr().out
    with pytest.raises(InputError, match="there is no such file"):
        run("--effects", str(tmp_path / "none.py"))


def test_a_broken_package_is_a_warning(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    ruined = Collection(LIBRARY, ("effect ruin of someone is left out: it is broken",))
    monkeypatch.setattr("werrimbi_odom.effects.lookup.all_effects", lambda files: ruined)
    assert run("castor_kick") == 0
    assert capsys.readouterr().err == "warning: effect ruin of someone is left out: it is broken\n"
