# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The command line as tests give it words, and what it says: fixtures of all tests."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, NamedTuple

import pytest

ROOT = Path(__file__).parents[1]
"""The checkout."""
WERRIMBI = (sys.executable, "-m", "werrimbi_odom.cli.main")
"""The command, in a process of its own."""


def ran(
    command: Iterable[object], cwd: Path = ROOT, timeout: float = 300.0, **environment: str
) -> subprocess.CompletedProcess[str]:
    """A command in a process of its own, which finds this package, when it has ended."""
    return subprocess.run(
        [*map(str, command)],
        cwd=cwd,
        env={**os.environ, "PYTHONPATH": str(ROOT), **environment},
        capture_output=True,
        text=True,
        check=False,
        timeout=timeout,
    )


def started(command: Iterable[object], cwd: Path = ROOT, **how: Any) -> subprocess.Popen[str]:
    """The same, while it runs; what it says can be read unless told otherwise."""
    env = {**os.environ, "PYTHONPATH": str(ROOT)}
    how = {"env": env, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **how}
    return subprocess.Popen([*map(str, command)], cwd=cwd, text=True, **how)


class Said(NamedTuple):
    """What a command printed."""

    out: str
    err: str

    @property
    def words(self) -> str:
        """Of stdout, as if the terminal were wide."""
        return " ".join(self.out.split())


Printed = Callable[[], str]
Werrimbi = Callable[..., Said]
Complaint = Callable[..., str]


@pytest.fixture
def printed(capsys: pytest.CaptureFixture[str]) -> Printed:
    """Tells what was printed since it was asked last, as if the terminal were wide."""
    return lambda: Said(*capsys.readouterr()).words


@pytest.fixture
def werrimbi(capsys: pytest.CaptureFixture[str]) -> Werrimbi:
    """Runs a command that ends with `code`, and tells what it said."""

    def run(*words: object, code: int = 0) -> Said:
        from werrimbi_odom.cli.main import main

        capsys.readouterr()
        assert main([*map(str, words)]) == code
        return Said(*capsys.readouterr())

    return run


@pytest.fixture
def complaint(werrimbi: Werrimbi) -> Complaint:
    """The one line that a command says of a mistake, and nothing else."""

    def run(*words: object) -> str:
        out, err = werrimbi(*words, code=2)
        assert out == ""
        assert len(err.splitlines()) == 1
        assert err.startswith(f"werrimbi {words[0]}: ")
        return err

    return run
