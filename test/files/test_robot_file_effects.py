# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Effects in robot files: what is read, and what stays of a file when they change."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from ruamel.yaml import YAML

from werrimbi_odom.effects import LIBRARY, Collection, find
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.robot_files.robot_file import RobotFile, read_robot_file
from werrimbi_odom.files.robot_files.robot_file_rewrite import write_robot_file
from werrimbi_odom.model.effect import AppliedEffect, Effect

BARE = """\
odom_node:
  ros__parameters:
    wheel_separation: 0.35
    wheel_radius: 0.05  # m
    left_ticks_per_revolution: 2000.0
    right_ticks_per_revolution: 2000.0
"""
HOLDING = f"""\
# my robot
{BARE}\
    effects: [eccentric_left_wheel, lateral_slip]  # two of them
    # the bent axle
    eccentric_left_wheel:  # since March
      amplitude: 0.0008  # m
      phase: 0.4
    # how it slides

    lateral_slip:
      creep: 0.002  # s
    # the counters
    encoder_bits: 16
# the end
"""
ECCENTRIC, SLIP, SWAPPED = (
    find("eccentric_left_wheel"),
    find("lateral_slip"),
    find("wheels_swapped"),
)


def file(tmp_path: Path, text: str = HOLDING) -> RobotFile:
    path = tmp_path / "robot.yaml"
    path.write_text(text)
    return read_robot_file(path)


def written(source: RobotFile, tmp_path: Path, *effects: AppliedEffect) -> RobotFile:
    return write_robot_file(source, {}, tmp_path / "new.yaml", force=True, effects=effects)


# ------------------------------------------------------------------------ reading


def test_effects_stand_in_the_order_of_their_list_with_the_values_of_their_blocks(
    tmp_path: Path,
) -> None:
    robot = file(tmp_path).robot
    assert [item.name for item in robot.effects] == ["eccentric_left_wheel", "lateral_slip"]
    assert robot.effects[0].values == {"amplitude": 0.0008, "phase": 0.4}
    assert robot.effects[1].values == {"creep": 0.002}
    assert robot.effects[0].ready


def test_what_is_left_out_is_null_and_what_each_run_has_anew_is_unknown(tmp_path: Path) -> None:
    names = "effects: [eccentric_left_wheel, radius_drift, castor_kick]\n"
    block = "    eccentric_left_wheel: {amplitude: 0.001}\n    radius_drift: {per_metre: 1}\n"
    text = BARE + "    " + names + block.replace("per_metre: 1", "per_metre: 0.001")
    wheel, drift, castor = file(tmp_path, text).effects
    assert wheel.unknown == ("phase",)
    assert not wheel.ready
    assert drift.values == {"per_metre": 0.001, "per_second": 0.0}
    assert castor.values == find("castor_kick").nulls


def test_a_dot_is_how_ros_spells_a_block(tmp_path: Path) -> None:
    text = BARE + "    lateral_slip.creep: 0.002\n    effects: [lateral_slip]\n"
    assert file(tmp_path, text).effects == (SLIP.using(creep=0.002),)


def test_a_set_up_mistake_is_only_listed(tmp_path: Path) -> None:
    assert file(tmp_path, BARE + "    effects: [wheels_swapped]\n").effects == (SWAPPED.using(),)


def test_no_effects_are_none_at_all(tmp_path: Path) -> None:
    for text in (BARE, BARE + "    effects: []\n"):
        assert file(tmp_path, text).effects == ()


def test_names_are_looked_up_in_the_collection_that_is_given(tmp_path: Path) -> None:
    mine = Effect("outward", "body", SLIP.parameters, SLIP.apply, SLIP.doc)
    path = tmp_path / "robot.yaml"
    path.write_text(BARE + "    effects: [outward]\n    outward: {creep: 0.01}\n")
    assert read_robot_file(path, Collection((mine,))).effects == (mine.using(creep=0.01),)
    with pytest.raises(
        InputError, match=r"line 7: unknown effect outward \(.*--effects FILE, or pip"
    ):
        read_robot_file(path)


def test_a_package_that_is_broken_is_the_reason_given(tmp_path: Path) -> None:
    path = tmp_path / "robot.yaml"
    path.write_text(BARE + "    effects: [my_slip]\n")
    why = "effect my_slip of my_robot (my_robot:slip) is left out: ImportError: no module numpi"
    with pytest.raises(InputError, match=r"line 7: unknown effect my_slip: .*no module numpi"):
        read_robot_file(path, Collection((SLIP,), (why,)))


# ------------------------------------------------------------------------ writing


def test_the_same_effects_are_the_same_text(tmp_path: Path) -> None:
    source = file(tmp_path)
    assert written(source, tmp_path, *source.effects).text == source.text


def test_effects_stay_where_only_numbers_change(tmp_path: Path) -> None:
    new = write_robot_file(file(tmp_path), {"wheel_radius": 0.06}, tmp_path / "new.yaml")
    assert new.effects == file(tmp_path).effects
    assert new.text == HOLDING.replace("0.05  # m", "0.06  # m")


def test_a_new_effect_brings_its_block_with_units(tmp_path: Path) -> None:
    text = written(
        file(tmp_path, BARE + "\n# the end\n"), tmp_path, ECCENTRIC.using(amplitude=8e-4)
    )
    assert text.text == BARE + (
        "    effects: [eccentric_left_wheel]     # in order of application\n"
        "    eccentric_left_wheel:\n"
        "      amplitude: 0.0008                 # m, from the axle to the wheel's centre\n"
        "\n# the end\n"
    )
    assert text.effects[0].unknown == ("phase",)


@pytest.mark.parametrize("text", [HOLDING, BARE])
def test_what_refines_a_law_is_stated_where_it_is_refined(tmp_path: Path, text: str) -> None:
    """Files of a law with fewer numbers read as before, and a fit that needs no more adds none."""
    slip = find("longitudinal_slip")
    plain = written(file(tmp_path, text), tmp_path, slip.using(coefficient=0.02))
    assert "turning" not in plain.text
    (held,) = read_robot_file(tmp_path / "new.yaml").effects
    assert held.values == {"coefficient": 0.02, "turning": 1.0}
    refined = written(plain, tmp_path, slip.using(coefficient=0.02, turning=0.4))
    assert "turning: 0.4" in refined.text
    assert refined.effects[0].values["turning"] == 0.4


def test_a_changed_value_keeps_its_place_and_comment(tmp_path: Path) -> None:
    source = file(tmp_path)
    new = written(source, tmp_path, source.effects[0], SLIP.using(creep=0.003))
    assert new.text == HOLDING.replace("creep: 0.002", "creep: 0.003")


def test_a_phase_that_is_unknown_is_left_out(tmp_path: Path) -> None:
    source = file(tmp_path)
    new = written(source, tmp_path, ECCENTRIC.using(amplitude=8e-4), source.effects[1])
    assert new.text == HOLDING.replace("      phase: 0.4\n", "")


def test_a_removed_effect_takes_its_block_along_and_no_comment_of_others(tmp_path: Path) -> None:
    source = file(tmp_path)
    new = written(source, tmp_path, source.effects[1])
    assert new.effects == source.effects[1:]
    for comment in (
        "# my robot",
        "# two of them",
        "# how it slides",
        "# the counters",
        "# the end",
    ):
        assert comment in new.text
    assert "amplitude" not in new.text
    nothing = written(source, tmp_path)
    assert nothing.effects == ()
    assert "creep" not in nothing.text
    assert nothing.values == source.values


def test_a_file_all_in_brackets_keeps_its_brackets(tmp_path: Path) -> None:
    parameters = YAML(typ="safe").load(HOLDING)["odom_node"]["ros__parameters"]
    source = file(tmp_path, json.dumps({"/**": {"ros__parameters": parameters}}))
    new = written(source, tmp_path, SWAPPED.using(), find("encoder_skew").using(delay=0.01))
    assert new.values == source.values
    assert new.text.startswith("{")
    assert new.text.count("\n") == 1


def test_a_list_item_below_item_and_dots_stay_so(tmp_path: Path) -> None:
    text = BARE + "    effects:\n      - lateral_slip  # slides\n    lateral_slip.creep: 0.002\n"
    source = file(tmp_path, text)
    new = written(source, tmp_path, SLIP.using(creep=0.003), SWAPPED.using())
    lines = (
        "      - lateral_slip  # slides\n      - wheels_swapped\n    lateral_slip.creep: 0.003\n"
    )
    assert new.text == BARE + "    effects:\n" + lines


@pytest.mark.parametrize("value", [5.0, math.nan])
def test_a_value_that_could_not_be_read_back_is_not_written(tmp_path: Path, value: float) -> None:
    wrong = AppliedEffect(SLIP, {"creep": value})
    with pytest.raises(InputError, match=r"lateral_slip\.creep must be a number"):
        write_robot_file(file(tmp_path), {}, tmp_path / "new.yaml", effects=[wrong])
    assert not (tmp_path / "new.yaml").exists()


def test_a_file_that_is_off_by_a_thousand_can_be_mended(tmp_path: Path) -> None:
    """Millimetres entered as metres, or the other way round."""
    names = (
        "wheel_separation_multiplier",
        "left_wheel_radius_multiplier",
        "right_wheel_radius_multiplier",
    )
    for factor in (1e-3, 1e3):
        changes = dict.fromkeys(names, factor)
        new = write_robot_file(file(tmp_path), changes, tmp_path / "new.yaml", force=True)
        assert new.robot.track == pytest.approx(0.35 * factor)


def _applied(effect: Effect) -> st.SearchStrategy[AppliedEffect]:
    values = {name: st.floats(*item.bounds) for name, item in effect.parameters.items()}
    must = {name: values[name] for name in values if not effect.parameters[name].per_run}
    may = {name: values[name] for name in values if effect.parameters[name].per_run}
    return st.fixed_dictionaries(must, optional=may).map(lambda given: effect.using(**given))


SETS = st.lists(st.sampled_from(LIBRARY), unique_by=lambda effect: effect.name, max_size=4).flatmap(
    lambda effects: st.tuples(*map(_applied, effects))
)
LAYOUTS = [
    HOLDING,
    BARE,
    HOLDING.replace(
        "[eccentric_left_wheel, lateral_slip]  # two of them",
        "\n      - eccentric_left_wheel # a\n      - lateral_slip # b",
    ),
]


def test_a_phase_of_zero_is_written_where_the_file_left_it_open(tmp_path: Path) -> None:
    text = (
        BARE
        + "    effects: [eccentric_left_wheel]\n    eccentric_left_wheel:\n      amplitude: 0.001\n"
    )
    source = file(tmp_path, text)
    assert source.effects[0].unknown == ("phase",)
    known = ECCENTRIC.using(amplitude=1e-3, phase=0.0)
    out = tmp_path / "new.yaml"
    write_robot_file(source, {}, out, effects=(known,))
    assert read_robot_file(out).effects == (known,)


@settings(
    max_examples=25, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(first=SETS, second=SETS, layout=st.sampled_from(LAYOUTS))
def test_any_effects_are_read_back_by_us_and_by_yaml_1_1(
    tmp_path: Path,
    first: tuple[AppliedEffect, ...],
    second: tuple[AppliedEffect, ...],
    layout: str,
) -> None:
    source = file(tmp_path, layout)
    for effects in (first, second):
        source = written(source, tmp_path, *effects)
        assert source.effects == effects
        assert read_robot_file(tmp_path / "new.yaml").effects == effects
        yaml_1_1 = YAML(typ="safe", pure=True)
        yaml_1_1.version = (1, 1)
        block = yaml_1_1.load(source.text)["odom_node"]["ros__parameters"]
        assert (block.get("effects") or []) == [item.name for item in effects]
        for item in effects:
            for name in set(item.effect.parameters) - set(item.unknown):
                value = block.get(item.name, {}).get(name, item.effect.nulls[name])
                assert value == item.values[name]
                assert isinstance(value, float)
    if layout == HOLDING:
        for comment in ("# my robot", "# how it slides", "# the counters", "# the end"):
            assert comment in source.text
