# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Machine code, the lines it was made of, arrays, and the live odometer: one odometry."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from test.evidence import in_evidence
from test.model.drives import ROBOT, random_drive
from test.model.records import Record, records
from test.model.test_odometer_and_trajectory import Live, assert_one_odometry, has_a_row
from werrimbi_odom.effects import find
from werrimbi_odom.model import encoder_recorded, recorded_propagation
from werrimbi_odom.model.compiled import compiled
from werrimbi_odom.model.covariance import PathNoise, piece_covariance
from werrimbi_odom.model.motion import BodyMotion
from werrimbi_odom.model.odometer import Odometer
from werrimbi_odom.model.trajectory import Trajectory, trajectory

pytest.importorskip("numba")


Way = Callable[[Callable[..., Any]], Callable[..., Any] | None]
"""What goes along a run in place of a function."""


def by_arrays(function: Callable[..., Any]) -> None:
    """Nothing does."""


def as_written(function: Callable[..., Any]) -> Callable[..., Any]:
    """The function itself, in plain Python."""
    return function


@contextmanager
def along(way: Way) -> Iterator[None]:
    """Recorded runs go this way, however long they are."""
    with (
        patch.object(recorded_propagation, "compiled_for", lambda steps, function: way(function)),
        patch.object(encoder_recorded, "compiled_for", lambda steps, function: way(function)),
    ):
        yield


def assert_same_bits(one: Trajectory, other: Trajectory) -> None:
    for name in ("time", "x", "y", "yaw", "row", "tally"):
        assert np.array_equal(getattr(one, name), getattr(other, name)), name
    for entry, its in zip(one.covariance, other.covariance, strict=True):
        assert np.array_equal(entry, its)
    assert list(one.pieces) == list(other.pieces)


def assert_machine_code_lines_and_live_odometer_alike(record: Record, together: int) -> None:
    robot, limits, ticks = record
    if not has_a_row(ticks):
        return
    with patch.object(recorded_propagation, "_BLOCK", together):
        with along(as_written):
            plain = trajectory(robot, *ticks, limits=limits)
        with along(compiled):
            machine = trajectory(robot, *ticks, limits=limits)
    assert_same_bits(machine, plain)
    assert_one_odometry(Odometer(robot, limits=limits), ticks, machine)
    live = Live(Odometer(robot, limits=limits), ticks)
    assert np.array_equal(live.pose, np.stack([machine.x, machine.y, machine.yaw], -1)[1:])
    assert np.array_equal(live.covariance, np.stack(machine.covariance, axis=-1)[1:])


@pytest.mark.parametrize("examples", [10, in_evidence(100)])
def test_machine_code_says_what_its_lines_and_the_live_odometer_say_to_the_last_bit(
    examples: int,
) -> None:
    say = settings(max_examples=examples, deadline=None)
    any_record = given(records(), st.sampled_from([1, 7, 8192]))
    say(any_record(assert_machine_code_lines_and_live_odometer_alike))()


@settings(max_examples=25, deadline=None)
@given(records())
def test_machine_code_says_what_arrays_say(record: Record) -> None:
    robot, limits, ticks = record
    if not has_a_row(ticks):
        return
    with along(by_arrays):
        arrays = trajectory(robot, *ticks, limits=limits)
    with along(compiled):
        machine = trajectory(robot, *ticks, limits=limits)
    for name in ("time", "row", "tally"):
        assert np.array_equal(getattr(arrays, name), getattr(machine, name)), name
    assert np.array_equal(arrays.yaw, machine.yaw)
    assert np.allclose(arrays.x, machine.x, rtol=1e-14, atol=1e-12)
    assert np.allclose(arrays.covariance, machine.covariance, rtol=1e-12, atol=1e-24)
    assert [p.time_start for p in arrays.pieces] == [p.time_start for p in machine.pieces]


def test_effects_act_alike_in_machine_code() -> None:
    effects = (
        find("eccentric_left_wheel").using(amplitude=8e-4, phase=0.4),
        find("sideways_drift").using(angle=0.01),
    )
    robot, ticks = replace(ROBOT, effects=effects), random_drive(4)
    with along(as_written):
        plain = trajectory(robot, *ticks)
    with along(compiled):
        assert_same_bits(trajectory(robot, *ticks), plain)


@settings(max_examples=60, deadline=None)
@given(
    st.tuples(*3 * [st.floats(-1e3, 1e3)]),
    st.floats(-60.0, 60.0) | st.floats(-1e-6, 1e-6) | st.sampled_from([0.0, 2.0, -2.0]),
    st.floats(-1e3, 1e3),
)
def test_single_functions_are_translated_to_the_last_bit(
    sizes: tuple[float, float, float], turn: float, yaw: float
) -> None:
    machine = compiled(piece_covariance)
    assert machine is not None
    along, sideways, size = sizes
    motion, noise = BodyMotion(along, sideways, turn), PathNoise(abs(size), abs(size), 0.5 * size)
    assert machine(motion, noise, yaw) == piece_covariance(motion, noise, yaw)


def test_short_runs_do_not_wait_for_numba_and_neither_does_the_odometer() -> None:
    """It takes a third of a second to import: the node, and a short run, do without."""
    program = (
        "import sys, numpy as np\n"
        "from werrimbi_odom.model.odometer import Odometer\n"
        "from werrimbi_odom.model.trajectory import trajectory\n"
        "from test.model.drives import ROBOT, random_drive\n"
        "ticks = random_drive(1)\n"
        "trajectory(ROBOT, *ticks)\n"
        "odometer = Odometer(ROBOT)\n"
        "estimates = [odometer.update(*message) for message in zip(*ticks)]\n"
        "assert estimates[-1].covariance.yawyaw > 0.0\n"
        "assert 'numba' not in sys.modules\n"
    )
    subprocess.run([sys.executable, "-c", program], check=True)


LONG = (
    "import os, sys\n"
    "if 'NOWHERE' in os.environ:\n"
    "    from numba.core import caching\n"
    "    caching.CompileResultCacheImpl._locator_classes = []\n"
    "from test.model.drives import ROBOT, random_drive\n"
    "from werrimbi_odom.model import compiled, scalar_loop\n"
    "from werrimbi_odom.model.trajectory import trajectory\n"
    "compiled.WORTH_COMPILING = 1000\n"
    "path = trajectory(ROBOT, *random_drive(1))\n"
    "machine = compiled.compiled_for(1000, scalar_loop.march)\n"
    "print(machine is not None, path.x[-1].hex(), len(path.pieces))\n"
)


def run_in(folder: Path, **environment: str) -> str:
    """A long run in a process whose sources, and home, can or cannot be written to."""
    done = subprocess.run(
        [sys.executable, "-c", LONG],
        env=os.environ | {"HOME": str(folder), "PYTHONPATH": str(Path.cwd())} | environment,
        check=True,
        capture_output=True,
        text=True,
    )
    assert not done.stderr
    return done.stdout.strip()


@pytest.mark.evidence
def test_machine_code_is_kept_for_the_next_process(tmp_path: Path) -> None:
    kept = tmp_path / "kept"
    first = run_in(tmp_path, NUMBA_CACHE_DIR=str(kept))
    files = sorted(kept.rglob("*.nbc"))
    assert len(files) == 2
    written = [file.stat().st_mtime_ns for file in files]
    assert run_in(tmp_path, NUMBA_CACHE_DIR=str(kept)) == first
    assert sorted(kept.rglob("*.nbc")) == files
    assert [file.stat().st_mtime_ns for file in files] == written
    assert first.startswith("True")


def test_without_numba_or_a_folder_to_write_to_arrays_do_the_same(tmp_path: Path) -> None:
    there = run_in(tmp_path).split()
    (tmp_path / "numba.py").write_text("raise ImportError('not here')\n")
    without = run_in(tmp_path, PYTHONPATH=f"{tmp_path}{os.pathsep}{Path.cwd()}").split()
    nowhere = run_in(tmp_path, NOWHERE="1").split()
    assert there[0] == "True"
    assert without[0] == nowhere[0] == "False"
    for other in (without, nowhere):
        assert float.fromhex(other[1]) == pytest.approx(float.fromhex(there[1]), abs=1e-12)
        assert other[2] == there[2]


def test_memory_of_a_long_run_is_its_columns() -> None:
    """Pieces of one or two steps: no objects for them; 500 B a step they would take."""
    program = (
        "import sys, tracemalloc, numpy as np\n"
        "from test.model.drives import ROBOT\n"
        "from werrimbi_odom.model.trajectory import trajectory\n"
        "random, count = np.random.default_rng(0), 300_000\n"
        "left, right = np.cumsum(random.integers(-20, 60, (2, count)), axis=1)\n"
        "time = np.arange(count) / 50.0\n"
        "trajectory(ROBOT, time, left, right)\n"
        "tracemalloc.start()\n"
        "path = trajectory(ROBOT, time, left, right)\n"
        "assert len(path.pieces) > 0.5 * count\n"
        "kept, most = tracemalloc.get_traced_memory()\n"
        "print(kept / count, most / count)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], check=True, capture_output=True, text=True
    )
    kept, most = map(float, done.stdout.split())
    assert kept < 140.0
    assert most < 400.0
