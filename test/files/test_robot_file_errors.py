# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Robot files that are wrong: what is said, and about which line."""

from __future__ import annotations

import re
import time
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from test.robot_file import BARE
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.robot_files import yaml_text
from werrimbi_odom.files.robot_files.robot_file import read_robot_file


def _with(line: str) -> str:
    return f"{BARE}    {line}\n"


def _slipping(block: str, more: str = "") -> str:
    return _with(f"effects: [lateral_slip]\n    lateral_slip: {block}{more}")


def complaint(path: Path, text: str | bytes) -> str:
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(InputError) as caught:
        read_robot_file(path)
    said = str(caught.value)
    assert said.startswith(str(path)), said
    assert "\n" not in said
    return said.removeprefix(str(path))


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (
            _with("wheel_separaton_multiplier: 1.0"),
            ", line 7: unknown parameter wheel_separaton_multiplier; "
            "the nearest known one is wheel_separation_multiplier",
        ),
        (_with("5: 1.0"), ", line 7: unknown parameter 5"),
        *(
            (BARE.replace("0.05", number), f", line 4: ROS reads {number} otherwise than YAML does")
            for number in ("0100", "-0100", "089", "1_0", "1_0.5", "1_e3", "0o17", "0b11", "0x1_F")
        ),
        (_slipping("{creep: 0_1}"), ", line 8: ROS reads 0_1 otherwise"),
        (BARE.replace("0.05", '!!int "010"'), ", line 4: ROS reads 010 otherwise"),
        ("%YAML 1.1\n---\n" + BARE, ", line 2: leave out %YAML"),
        (
            BARE.replace("0.35", "1.0e-300"),
            ", line 3: wheel_separation times wheel_separation_multiplier must be from 1e-09 to "
            "1e+09 m, it is 1e-300 m",
        ),
        (
            _with("wheel_separation_multiplier: 1.0e+10"),
            ", line 7: wheel_separation times wheel_separation_multiplier must be from",
        ),
        (
            BARE.replace(
                "right_ticks_per_revolution: 2000.0", "right_ticks_per_revolution: 5e-324"
            ),
            ", line 6: travel for one count (wheel_radius times right_wheel_radius_multiplier "
            "times 2 pi over right_ticks_per_revolution) must be from 1e-15 to 1e+09 m, it is inf",
        ),
        (_with("left_wheel_noise: 1.0e160"), ", line 7: left_wheel_noise must be at most 1000"),
        (
            BARE.replace("0.05", "-0.05"),
            ", line 4: wheel_radius must be a number greater than 0 (m), not -0.05",
        ),
        (
            BARE.replace("0.05", "0"),
            ", line 4: wheel_radius must be a number greater than 0 (m), not 0",
        ),
        (BARE.replace("0.05", ".nan"), ", line 4: wheel_radius must be a number (m), not nan"),
        (BARE.replace("0.05", "-.inf"), ", line 4: wheel_radius must be a number (m), not -inf"),
        (BARE.replace("0.05", "5 cm"), ", line 4: wheel_radius must be a number (m), not '5 cm'"),
        (BARE.replace("0.05", "true"), ", line 4: wheel_radius must be a number (m), not True"),
        (BARE.replace("0.05", "[0.05]"), ", line 4: wheel_radius must be a number (m), not [0.05]"),
        (BARE.replace("0.05", ""), ", line 4: wheel_radius must be a number (m), not None"),
        (BARE.replace("0.05", "2024-01-01"), ", line 4: wheel_radius must be a number (m), not "),
        (_with("encoder_bits: 16.5"), ", line 7: encoder_bits must be a whole number (bits)"),
        (_with("encoder_bits: 65"), ", line 7: encoder_bits must be a whole number of at most 64"),
        (
            _with("encoder_bits: 1"),
            ", line 7: encoder_bits must be 0 (never wraps) or from 2 to 64",
        ),
        (_with("left_wheel_noise: -1e-4"), ", line 7: left_wheel_noise must be a number of at"),
        (_with("enable_odom_tf: 1"), ", line 7: enable_odom_tf must be true or false, not 1"),
        (_with('enable_odom_tf: "yes"'), ", line 7: enable_odom_tf must be true or false"),
        (_with("input_type: joints"), ", line 7: input_type must be one of joint_state, int32"),
        (_with("odom_frame_id: 7"), ", line 7: odom_frame_id must be a text, not 7"),
        (_with("left_wheel_names: a"), ", line 7: left_wheel_names must be a list of names"),
        (_with("left_wheel_names: []"), ", line 7: left_wheel_names must be a list of names"),
        (
            _with("left_wheel_names: [a, b]\n    right_wheel_names: [c, b]"),
            ", line 8: b is in left_wheel_names and in right_wheel_names; name the joint of each",
        ),
        (
            _with("left_wheel_names: [right_wheel_joint]"),
            ", line 7: right_wheel_joint is in left_wheel_names and in right_wheel_names",
        ),
        (_with("left_wheel_names: [a, 1]"), ", line 7: left_wheel_names must be a list of names"),
        (
            _with("effects: [lateral_slop]"),
            ", line 7: unknown effect lateral_slop; the nearest known one is lateral_slip",
        ),
        (_with("effects: [track_width, track_width]"), ", line 7: effects lists track_width twice"),
        (_with("effects: [1]"), ", line 7: effects must be a list of names, [] for none, not [1]"),
        (_with("effects: {a: 1}"), ", line 7: effects must be a list of names, [] for none"),
        (
            _slipping("{crep: 0.1}"),
            ", line 8: lateral_slip has no parameter crep; it has creep",
        ),
        (
            _slipping("\n      crep: 0.1"),
            ", line 9: lateral_slip has no parameter crep; it has creep",
        ),
        (
            _slipping("\n      creep: 5"),
            ", line 9: lateral_slip.creep must be a number of at most 0.1 (s), not 5",
        ),
        (
            _slipping("{creep: fast}"),
            ", line 8: lateral_slip.creep must be a number (s), not 'fast'",
        ),
        (_slipping("{creep: true}"), ", line 8: lateral_slip.creep must be a number (s), not True"),
        (_slipping("{creep: {a: 1}}"), ", line 8: lateral_slip.creep must be a number (s), not "),
        (
            _slipping("0.01"),
            ", line 8: lateral_slip must be a block of its parameters (creep), not 0.01",
        ),
        (
            _slipping(""),
            ", line 8: lateral_slip must be a block of its parameters (creep), not nothing",
        ),
        (
            _slipping("{creep: 0.01}", "\n    lateral_slip.creep: 0.01"),
            ", line 9: lateral_slip.creep is given twice",
        ),
        (
            _with("lateral_slip.creep: 0.01"),
            ", line 7: this is a block of parameters for lateral_slip, but effects does not list "
            "lateral_slip; add it to the list, or take the block out",
        ),
        (
            _slipping("{creep: 0.01}", "\n    castor_kick:\n      angle: 0.01"),
            ", line 9: this is a block of parameters for castor_kick, but effects does not list",
        ),
        (
            _with("lateral_slop:\n      creep: 0.01"),
            ", line 7: unknown effect lateral_slop; the nearest known one is lateral_slip",
        ),
        (
            _with("effects: [wheels_swapped]\n    wheels_swapped: true"),
            ", line 8: wheels_swapped has no parameters; take this line out",
        ),
        (
            _with("effects: [wheels_swapped]\n    wheels_swapped: {yes: 1}"),
            ", line 8: wheels_swapped has no parameter yes; it is a set-up mistake, made or not",
        ),
        (
            _with("effects:"),
            ", line 7: effects must be a list of names, [] for none, not 'nothing'",
        ),
        (_with("effects: lateral_slip"), ", line 7: effects must be a list of names, [] for none"),
        (_with("wheel_radius: 0.06"), ', line 7: this is not YAML: found duplicate key "wheel_rad'),
        (
            "odom_node:\n  ros__parameters:\n    wheel_radius: 0.05\n    position_unit: ticks\n",
            ": odom_node must also give wheel_separation (m), left_ticks_per_revolution (ticks), "
            "right_ticks_per_revolution (ticks)",
        ),
        (
            _with("encoder_bits: 16").replace("    left_ticks_per_revolution: 2000.0\n", ""),
            ": odom_node must also give left_ticks_per_revolution (ticks)",
        ),
        (
            re.sub(r".*_ticks_.*\n", "", _with("encoder_bits: 16")),
            ", line 5: encoder_bits needs left_ticks_per_revolution and right_ticks_per_revolution",
        ),
        ("odom_node:\n  ros__parameters:\n", ": odom_node must also give wheel_separation (m)"),
        ("odom_node:\n  ros__parameters: 5\n", ", line 2: ros__parameters must hold lines of name"),
        ("odom_node:\n  wheel_radius: 1\n", ", line 1: below odom_node comes ros__parameters"),
        ("odom_node:\n", ", line 1: below odom_node comes ros__parameters"),
        ("5:\n  ros__parameters: {}\n", ", line 1: the top key must be a node's name, not 5"),
        ("a: 1\nb: 2\n", ": a robot file tells of one node (odom_node or /**); here are: a, b"),
        (BARE + BARE.replace("odom_node", "/**"), ": a robot file tells of one node"),
        ("{}\n", ": a robot file tells of one node (odom_node or /**); here are: none"),
        ("", " is empty"),
        ("# only a comment\n", " is empty"),
        ("- a\n", ": a robot file begins with the node's name and a colon"),
        ("just words\n", ": a robot file begins with the node's name and a colon"),
        (BARE.replace("0.05", '"0.05'), ", line 4: this is not YAML"),
        (BARE.replace("0.05", "\t0.05"), ", line 4: this is not YAML"),
        (BARE.replace(" 0.05", "0.05"), ", line 4: this is not YAML"),
        (BARE.replace("0.05", "2024-13-77"), ": this is not YAML: month must be in 1..12"),
        (BARE.replace("0.05", "9" * 5000), ": this is not YAML: Exceeds the limit"),
        (BARE + "---\n" + BARE, ", line 7: a second document begins"),
        (BARE.encode() + b"    # \xff\n", ", line 7: byte 0xff is not UTF-8"),
        (BARE + "\0", ": this is not YAML"),
        (BARE.replace(" 0.05", "  # m\n      0.05\n\n"), ", line 4: a comment between a key and"),
    ],
)
def test_wrong_files(tmp_path: Path, text: str | bytes, said: str) -> None:
    assert complaint(tmp_path / "robot.yaml", text).startswith(said)


def test_no_such_file_and_a_folder(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"none\.yaml: there is no such file"):
        read_robot_file(tmp_path / "none.yaml")
    with pytest.raises(InputError, match="is a folder; give the YAML file in it"):
        read_robot_file(tmp_path)
    with pytest.raises(InputError, match="cannot be read"):
        read_robot_file("a\0b")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("x: !!python/object/apply:os.system ['touch {proof}']\n", ", line 1: the tag"),
        ("x: !!python/name:os.system\n", ", line 1: the tag"),
        ("a: &a [x, x]\nb: &b [*a, *a]\nc: [*b, *b]\n", ", line 2: write the value out instead"),
        ("a: &a\n  b: *a\n", ", line 2: write the value out instead"),
        ("<<: *a\n", ", line 1: write the value out instead"),
        ("[" * 100_000, ", line 1: nested more than 8 deep"),
        ("{a: " * 50_000, ", line 1: nested more than 8 deep"),
        ("- " * 50_000, ", line 1: nested more than 8 deep"),
        ("a" * 1_000_001, " is larger than 1,000,000 bytes"),
    ],
)
def test_hostile_files_cost_little_and_run_nothing(tmp_path: Path, text: str, said: str) -> None:
    proof = tmp_path / "proof"
    began = time.process_time()
    got = complaint(tmp_path / "robot.yaml", text.replace("{proof}", str(proof)))
    assert got.startswith(said)
    assert time.process_time() - began < 5.0
    assert not proof.exists()


def test_a_device_without_end_is_not_read_to_its_end() -> None:
    with pytest.raises(InputError, match="larger than"):
        read_robot_file("/dev/zero")


@settings(
    max_examples=100,
    deadline=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
@given(
    st.one_of(
        st.binary(max_size=200),
        st.text(max_size=200).map(lambda text: text.encode("utf-8", "surrogatepass")),
        st.text("{}[]:,&*!|>-?'\"#%@` \n\tab0.", max_size=80).map(
            lambda text: BARE.encode() + b"    x: " + text.encode()
        ),
        st.text("{}[]:,&*!|>-?'\"#%@` \n\tab0.e-", max_size=20).map(
            lambda text: BARE.replace("0.05", text).encode()
        ),
    )
)
def test_whatever_is_in_the_file_nothing_but_an_input_error(tmp_path: Path, raw: bytes) -> None:
    path = tmp_path / "robot.yaml"
    path.write_bytes(raw)
    try:
        read_robot_file(path)
    except InputError as error:
        said = str(error)
    else:
        said = str(path)
    assert str(path) in said


def test_depth_allows_the_blocks_of_effects() -> None:
    assert yaml_text.MAX_DEPTH >= 4
