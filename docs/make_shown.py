# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Runs every command of docs/shown.md, and writes the page with what they printed.

    python docs/make_shown.py [WORD]      # only those whose command holds WORD; the others stay

About twenty minutes on two idle cores. A command that fails is shown as it failed.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

from werrimbi_odom.files.text_files import replacing

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "shown.md"
_LONGEST = 3600.0
"""For one command [s]."""
_LINES = 40
"""Of an output, the last."""


@dataclass(frozen=True)
class Shown:
    """A claim, and the command that shows it."""

    claim: str
    command: str


def by_tests(places: str, claim: str, *, long: bool = False) -> Shown:
    """A claim that tests hold; on request those of `make evidence` too."""
    marked = "" if long else "-m 'not evidence' "
    return Shown(claim, f"python -m pytest {marked}-n 2 --dist loadfile {places}")


SECTIONS: dict[str, tuple[Shown, ...]] = {
    "Find out why": (
        Shown(
            "Real robots, mended by following the tool's advice alone. A plain least squares of "
            "all that was known to be wrong in them reached 1.9, 4, 3.3 and 26 mm; that the first "
            "has two clocks was not known.",
            "python docs/follow_advice.py",
        ),
        Shown(
            "An hour of driving at 50 Hz with all candidates, in less than 30 s on two cores; the "
            "cost grows in proportion to the length.",
            "python benchmark/diagnosis_hour.py",
        ),
        Shown(
            "A draft, where no effect of the library explains the errors, beside the diagnosis "
            "that it begins with.",
            "python benchmark/draft.py",
        ),
        Shown(
            "The live node with the added effect errs less on held-out drives, whose ticks are "
            "sent to it over DDS.",
            "python -m pytest test/hidden/test_live_node.py",
        ),
        by_tests(
            "test/inference/test_set_up_recorded_robots.py test/inference/test_set_up.py",
            "Set-up mistakes, and factors of 2, 4, π, 57.3 and 1000, put into recordings of real "
            "robots and into simulated ones, are named in every case.",
            long=True,
        ),
        Shown(
            "A small, fixed part of the evidence (all of it: [evidence.md](evidence.md), "
            "`python -m test.hidden`).",
            "python -m pytest test/hidden/test_small_part.py test/hidden/test_command_line.py",
        ),
    ),
    "See it": (
        by_tests(
            "test/workbench test/report",
            "The loop by clicks alone and by keys alone, the reports, axe's rules in every state "
            "of the page, 390 pixels wide too, in a real browser.",
            long=True,
        ),
        Shown("An hour of driving on the page.", "python benchmark/page_hour.py"),
    ),
    "ROS": (
        by_tests(
            "test/package test/ros/test_two_robots.py test/ros/test_full_ros.py -rs",
            "Launch files, two robots in their namespaces, QoS overrides, colcon (what a full ROS "
            "alone can show is skipped without one).",
        ),
        by_tests(
            "test/ros/test_odom_parameters.py test/ros/test_lifecycle.py test/ros/test_reports.py",
            "Parameters changed while the node runs, its end by signals, `set_pose` and `~/reset`.",
        ),
        by_tests(
            "test/files/test_bag_ticks.py test/files/test_bag_reference.py",
            "Bags, sqlite3 and MCAP, with the node's own input and with the messages of common "
            "robots.",
        ),
        by_tests(
            "test/ros/test_compare_node.py test/ros/test_compare_legs.py",
            "`compare_node` tells an honest covariance from one that is too small.",
        ),
    ),
    "With an EKF": (
        Shown(
            "filterpy's EKF downstream: its mean NEES, and the share of instants within the 95 % "
            "bounds, with our covariance and with constants.",
            "python -m test.ros.test_ekf_filterpy",
        ),
        by_tests("test/ros/test_ekf_config.py", "`config/ekf.yaml` in robot_localization's form."),
    ),
    "Faults": (
        by_tests(
            "test/faults test/ros/test_bad_input.py",
            "Random messages, kill and restart, hostile YAML, CSV and bags.",
        ),
        Shown(
            "Ten hours at 50 Hz: memory, and the covariance against the closed form of the whole "
            "path.",
            "python -m pytest -m evidence -s test/faults/test_soak.py",
        ),
        Shown(
            "Fuzzing of each reader of files by atheris, guided by coverage.",
            "python -m pytest -m evidence -s test/faults/test_fuzz.py",
        ),
    ),
    "Speed": (
        Shown(
            "The model, in seconds for a million ticks.",
            "python benchmark/core_speed.py --most 10000000",
        ),
        Shown(
            "Messages per piece, and the error of the covariance.",
            "python benchmark/piece_tolerance.py",
        ),
        Shown(
            "The node beside an empty relay, and beside itself with a piece for each message.",
            "python benchmark/node_cost.py",
        ),
    ),
    "Fleets": (
        by_tests(
            "test/fleet",
            "Many robots on this machine and on a Dask cluster (a local one), with the same JSON, "
            "byte for byte; the table itself is in [fleet.md](fleet.md).",
        ),
    ),
}  # fmt: skip


def printed(command: str) -> str:
    """What a command prints, without colours; the end of it where it is long."""
    environment = os.environ | {"PYTHONPATH": str(ROOT), "COLUMNS": "110", "NO_COLOR": "1"}
    words = command.replace("python ", f"{sys.executable} ", 1)
    done = subprocess.run(
        words, shell=True, cwd=ROOT, env=environment, capture_output=True, text=True,
        check=False, timeout=_LONGEST,
    )  # fmt: skip
    lines = [line.rstrip() for line in done.stdout.splitlines() if line.strip()]
    if "pytest" in command:
        told = re.compile(r"(^SKIPPED)|(\d (passed|failed|skipped|deselected))|covariance off")
        lines = [line.lstrip(".") for line in lines if told.search(line)]
    if done.returncode != 0:
        lines.append(f"(ended with {done.returncode})")
    return "\n".join(lines[-_LINES:])


def known() -> dict[str, str]:
    """What the page holds already, by command."""
    if not PAGE.exists():
        return {}
    blocks = re.findall(r"^```text\n\$ ([^\n]*)\n(.*?)\n```$", PAGE.read_text(), re.M | re.S)
    return dict(blocks)


def page(kept: dict[str, str]) -> str:
    """The page with all that is known."""
    parts = [
        "# What is claimed, and the command that shows it",
        "",
        "This page lists what is claimed, and for each claim a command that shows it, with what "
        "it printed on two cores. To try one, type it as it stands; `python` is that of "
        "`make setup` (`.venv/bin/python`).",
        "",
        "    python docs/make_shown.py           # runs all, and writes this page",
        "    python docs/make_shown.py fleet     # only those whose command holds this word",
    ]
    for heading, entries in SECTIONS.items():
        parts += ["", f"## {heading}"]
        for entry in entries:
            output = kept.get(entry.command, "not run yet")
            parts += ["", entry.claim, "", "```text", f"$ {entry.command}", output, "```"]
    return "\n".join(parts) + "\n"


def main() -> None:
    """Run what is asked for, and write after each."""
    word = sys.argv[1] if len(sys.argv) > 1 else ""
    kept = known()
    for entry in (entry for entries in SECTIONS.values() for entry in entries):
        if word not in entry.command:
            continue
        kept[entry.command] = printed(entry.command)
        print(f"$ {entry.command}\n{kept[entry.command]}\n", flush=True)
        with replacing(PAGE) as file:
            file.write(page(kept))


if __name__ == "__main__":
    main()
