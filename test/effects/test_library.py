# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Effects are found by name: in the library, in installed packages, in a file of one's own."""

from __future__ import annotations

import ast
import inspect
import re
import subprocess
import sys
from importlib.metadata import EntryPoint
from pathlib import Path
from textwrap import dedent

import pytest

from werrimbi_odom.effects import LIBRARY, all_effects, find, load_file, lookup
from werrimbi_odom.errors import InputError
from werrimbi_odom.model.effect import twin_of

# The contract's two tables, with the null value of each parameter that they name.
VOCABULARY = {
    "track_width": 1.0,
    "unequal_wheel_radii": 1.0,
    "wheel_radius_scale": 1.0,
    "eccentric_left_wheel": 0.0,
    "eccentric_right_wheel": 0.0,
    "oval_left_wheel": 0.0,
    "oval_right_wheel": 0.0,
    "left_tread_bump": 0.0,
    "right_tread_bump": 0.0,
    "tyre_squash": 0.0,
    "load_transfer": 0.0,
    "longitudinal_slip": 0.0,
    "coulomb_slip": 0.0,
    "lateral_slip": 0.0,
    "turn_dependent_track": 0.0,
    "skid_steer": 0.0,  # its offsets; its multiplier, being the base, is 1
    "sideways_drift": 0.0,
    "floor_slope": 0.0,
    "anisotropic_floor": 0.0,
    "castor_kick": 0.0,
    "castor_swing": 0.0,
    "left_backlash": 0.0,
    "right_backlash": 0.0,
    "left_missed_ticks": 0.0,
    "right_missed_ticks": 0.0,
    "radius_drift": 0.0,
    "radius_by_channel": 0.0,
    "reference_lever_arm": 0.0,
    "reference_yaw_offset": 0.0,
    "reference_delay": 0.0,
    "reference_heading_delay": 0.0,
    "reference_clock_drift": 0.0,
    "reference_scale": 1.0,
    "reference_gyro_drift": 0.0,
    "encoder_skew": 0.0,
}
MISTAKES = ["wheels_swapped", "left_wheel_reversed", "right_wheel_reversed", "reference_mirrored"]

OWN = """
    from werrimbi_odom.effects.lateral_slip import lateral_slip
    from werrimbi_odom.model.effect import Parameter, body_effect

    @body_effect(amount=Parameter("rad", 0.0, 0.01, (-1.0, 1.0), "how much"))
    def wobble(motion, drive, amount):
        '''It wobbles.'''
        return motion
"""


def written(folder: Path, text: str) -> Path:
    path = folder / "own.py"
    path.write_text(dedent(text), encoding="utf-8")
    return path


def test_the_library_is_the_contracts_vocabulary() -> None:
    assert [effect.name for effect in LIBRARY] == [*VOCABULARY, *MISTAKES]
    for effect in LIBRARY:
        assert effect.is_mistake == (effect.name in MISTAKES)
        for name, item in effect.parameters.items():
            is_shape = item.tries or (effect.quadrature and name == effect.quadrature[1])
            assert is_shape or item.null == (1.0 if item.as_base else VOCABULARY[effect.name])


def test_names_are_unique_and_are_their_functions_names() -> None:
    assert len({effect.name for effect in LIBRARY}) == len(LIBRARY)
    assert all(effect.apply.__name__ == effect.name for effect in LIBRARY)


def test_twins_are_mutual_and_say_what_tells_them_apart() -> None:
    for effect in LIBRARY:
        for twin in effect.indistinguishable_from:
            back = twin_of(find(twin.name), effect)
            assert back is not None
            assert (back.told_apart_by, back.do) == (twin.told_apart_by, twin.do)
            assert twin.told_apart_by
            assert twin.do


@pytest.mark.parametrize(
    "pair",
    ["eccentric_{}_wheel", "oval_{}_wheel", "{}_tread_bump", "{}_backlash", "{}_missed_ticks"],
)
def test_mirror_pairs_say_the_same_of_both_sides(pair: str) -> None:
    left, right = find(pair.format("left")), find(pair.format("right"))
    assert left.parameters == right.parameters
    said = [
        re.sub("left|right", "side", effect.doc, flags=re.IGNORECASE) for effect in (left, right)
    ]
    assert said[0].split() == said[1].split()


def test_an_unknown_name_is_told_the_nearest() -> None:
    assert find("lateral_slip").name == "lateral_slip"
    with pytest.raises(
        InputError, match=r"unknown effect lateral_slp; the nearest.* lateral_slip "
    ):
        find("lateral_slp")
    with pytest.raises(InputError, match="nearest known one is"):
        find("")


def test_a_file_of_ones_own(tmp_path: Path) -> None:
    path = written(tmp_path, OWN)
    assert [effect.name for effect in load_file(path)] == ["wobble"]
    found = all_effects([path])
    assert found.find("wobble").stage == "body"
    assert found.effects[: len(LIBRARY)] == LIBRARY
    with pytest.raises(InputError, match="wobble"):
        found.find("wobbel")


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("x = 1\n", "defines no effect"),
        ("x = 1\ndef f(:\n", "own.py:2: SyntaxError"),
        ("x = 1\n\nx / 0\n", "own.py:3: ZeroDivisionError"),
        ("import no_such_package\n", "own.py:1: ModuleNotFoundError.*no_such_package"),
        ("def f():\n    raise KeyError('x')\n\nf()\n", "own.py:2: KeyError"),
        ("raise SystemExit\n", "SystemExit"),
        (OWN.replace("wobble", "lateral_slip"), "name lateral_slip is taken"),
    ],
)  # fmt: skip
def test_a_file_that_cannot_be_used_is_one_clear_line(tmp_path: Path, text: str, told: str) -> None:
    path = written(tmp_path, text)
    with pytest.raises(InputError, match=f"(?s){told}"):
        all_effects([path])


def test_two_names_for_two_effects_called_alike(tmp_path: Path) -> None:
    text = dedent(OWN) + "first = wobble\n" + dedent(OWN)
    with pytest.raises(InputError, match="two effects are called wobble"):
        load_file(written(tmp_path, text))


def test_no_such_file(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="there is no such file"):
        load_file(tmp_path / "none.py")
    with pytest.raises(InputError, match="there is no such file"):
        load_file(tmp_path)


def test_installed_effects_and_broken_packages(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "someones_robot.py").write_text(
        dedent(OWN) + "number = 3\nfrom werrimbi_odom.effects import find\ntaken = lateral_slip\n"
    )
    (tmp_path / "someones_ruin.py").write_text("1 / 0\n")
    (tmp_path / "someones_exit.py").write_text("raise SystemExit(3)\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    points = [
        EntryPoint(name, value, lookup.GROUP)
        for name, value in [
            ("wobble", "someones_robot:wobble"),
            ("number", "someones_robot:number"),
            ("taken", "someones_robot:taken"),
            ("absent", "someones_robot:absent"),
            ("ruin", "someones_ruin:effect"),
            ("exit", "someones_exit:effect"),
            ("gone", "someones_gone:effect"),
        ]
    ]
    monkeypatch.setattr(lookup, "entry_points", lambda group: points)
    found = all_effects()
    assert found.find("wobble").name == "wobble"
    assert find("wobble").name == "wobble"
    own = all_effects([written(tmp_path, OWN)])
    assert own.find("wobble") is not found.find("wobble")
    assert "own.py: its wobble goes before the installed one" in own.warnings[-1]
    (second := tmp_path / "second.py").write_text((tmp_path / "own.py").read_text())
    twice = all_effects([tmp_path / "own.py", second])
    assert f"second.py: its wobble goes before that of {tmp_path / 'own.py'}" in twice.warnings[-1]
    assert len(found.effects) == len(LIBRARY) + 1
    warnings = "\n".join(found.warnings)
    assert len(found.warnings) == 6
    for told in (
        "effect number of .*it is no effect but a int",
        "effect taken of .*the name lateral_slip is taken",
        "effect absent of .*AttributeError",
        "effect ruin of .*ZeroDivisionError",
        "effect exit of .*SystemExit",
        "effect gone of .*ModuleNotFoundError",
    ):
        assert re.search(told, warnings)


def test_an_installed_package_is_found_through_its_entry_point(tmp_path: Path) -> None:
    """A folder on the path with a .dist-info is what pip makes of a package."""
    (tmp_path / "soft_tyres.py").write_text(dedent(OWN))
    info = tmp_path / "soft_tyres-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: soft-tyres\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text(f"[{lookup.GROUP}]\nwobble = soft_tyres:wobble\n")
    code = "from werrimbi_odom.effects import find; print(find('wobble').summary)"
    root = Path(__file__).parents[2]
    shown = subprocess.run(
        [sys.executable, "-c", code],
        env={"PYTHONPATH": f"{tmp_path}:{root}", "PATH": ""},
        capture_output=True,
        text=True,
        check=True,
    )
    assert shown.stdout == "It wobbles.\n"


def test_effects_import_the_model_and_numpy_alone() -> None:
    """What runs in the node must not need more than the node does."""
    for effect in LIBRARY:
        source = inspect.getsource(inspect.getmodule(effect.apply))  # type: ignore[arg-type]
        for node in ast.walk(ast.parse(source)):
            if isinstance(node, ast.ImportFrom):
                allowed = (
                    "__future__",
                    "werrimbi_odom.model.",
                    "werrimbi_odom.effects.functions",
                    "werrimbi_odom.effects.shapes",
                    "werrimbi_odom.effects.indistinguishable_pairs",
                    "werrimbi_odom.effects.wheel_force",
                )
                assert node.module is not None
                assert node.module.startswith(allowed)
            elif isinstance(node, ast.Import):
                assert [name.name for name in node.names] == ["math"]
