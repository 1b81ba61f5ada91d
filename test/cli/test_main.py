# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The command `werrimbi`: exit codes, a line for each mistake, odd names, its quick start."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import time
from contextlib import redirect_stderr, redirect_stdout
from functools import cache
from io import StringIO
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from test.cli.commands import RECORDING
from test.command_line import ROOT, WERRIMBI, Said, Werrimbi, ran, started
from test.evidence import in_evidence
from werrimbi_odom.cli import main as command
from werrimbi_odom.cli import progress
from werrimbi_odom.cli.options import EXAMPLES
from werrimbi_odom.errors import InputError

ENVIRONMENT = {**os.environ, "PYTHONPATH": str(ROOT)}
SQUARE = ROOT / "werrimbi_odom" / "recordings" / "square"


@cache
def help_of(words: str) -> Said:
    """Asked for once in all tests."""
    with redirect_stdout(StringIO()) as out, redirect_stderr(StringIO()) as err:
        assert command.main([*words.split(), "--help"]) == 0
    return Said(out.getvalue(), err.getvalue())


def test_help_names_every_verb() -> None:
    said = help_of("")
    assert said.err == ""
    for verb in command.VERBS:
        assert f"\n    {verb}" in said.out


@pytest.mark.parametrize("verb", command.VERBS)
def test_every_verb_has_help(verb: str) -> None:
    assert help_of(verb).out.startswith(f"usage: werrimbi {verb}")


@pytest.mark.parametrize("of", EXAMPLES)
def test_every_help_ends_with_examples_that_are_right(of: str) -> None:
    given = help_of(of).out.split("example:\n")[1].splitlines()
    assert given == [f"  werrimbi {words}" for words in EXAMPLES[of]]
    for example in EXAMPLES[of]:
        words = example.split()
        assert command._parser(words).parse_args(words).verb == of.split()[0]


def test_help_says_what_a_leg_is() -> None:
    for verb in ("compare", "diagnose", "add", "draft", "workbench"):
        text = help_of(verb).words
        assert "drives are cut into legs of so much path" in text


def test_help_is_quick_and_imports_nothing_heavy() -> None:
    script = (
        "import sys; from werrimbi_odom.cli.main import main; code = main(['--help']);"
        "heavy = {'numpy', 'scipy', 'rich', 'rosbags', 'mujoco', 'plotly', 'rclpy', 'ruamel.yaml'};"
        "sys.exit(code or ', '.join(sorted(heavy & set(sys.modules))) or 0)"
    )
    done = ran([sys.executable, "-c", script], timeout=60)
    assert (done.returncode, done.stderr) == (0, "")


def test_the_package_runs_as_the_command() -> None:
    done = ran([sys.executable, "-m", "werrimbi_odom", "--help"], timeout=60)
    assert done.stdout == help_of("").out


def test_version() -> None:
    done = ran([*WERRIMBI, "--version"], timeout=60)
    assert done.returncode == 0
    assert done.stdout.startswith("werrimbi_odom ")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ((), "werrimbi: the following arguments are required: VERB (see werrimbi --help)"),
        (("odm",), "werrimbi: argument VERB: invalid choice: 'odm'"),
        (("--robot", "x"), "werrimbi: "),
        (("odom",), "werrimbi odom: the following arguments are required: RUN, --robot, --out"),
        (("odom", "--rob", "x"), "werrimbi odom: the following arguments are required"),
        (
            ("odom", "r", "--robot", "x", "--out", "y", "--nonsense"),
            "werrimbi odom: unrecognized argu",
        ),
        (
            ("odom", "r", "--robot", "none.yaml", "--out", "y"),
            "werrimbi odom: none.yaml: there is no such file",
        ),
    ],
)
def test_bad_use_is_one_line_and_exit_2(
    words: tuple[str, ...], said: str, werrimbi: Werrimbi
) -> None:
    out, err = werrimbi(*words, code=2)
    assert out == ""
    assert err.startswith(said)
    assert err.count("\n") == 1


def stand_in(monkeypatch: pytest.MonkeyPatch, error: BaseException | None) -> None:
    """A verb that ends in an error."""

    def run(arguments: Any) -> int:
        if error is not None:
            raise error
        return 0

    verb = SimpleNamespace(HELP="", add_arguments=lambda parser: None, run=run)
    monkeypatch.setattr(command, "_module", lambda name: verb)


@pytest.mark.parametrize(
    ("error", "code", "said"),
    [
        (None, 0, ""),
        (InputError("robot.yaml, line 3:\n  no"), 2, "werrimbi odom: robot.yaml, line 3: no\n"),
        (OSError(28, "No space left on device"), 2, "werrimbi odom: [Errno 28] No space left"),
        (MemoryError(), 2, "werrimbi odom: this needs more memory than there is"),
        (KeyboardInterrupt(), 130, ""),
        (SystemExit(0), 2, "werrimbi odom: code that it ran ended it (SystemExit: 0)"),
    ],
)
def test_how_a_verb_may_end(
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    error: BaseException | None,
    code: int,
    said: str,
) -> None:
    stand_in(monkeypatch, error)
    assert command.main(["odom"]) == code
    err = capsys.readouterr().err
    assert err.startswith(said)
    assert err.count("\n") == (1 if said else 0)


def test_a_bug_is_not_hidden(monkeypatch: pytest.MonkeyPatch) -> None:
    stand_in(monkeypatch, ZeroDivisionError("ours"))
    with pytest.raises(ZeroDivisionError):
        command.main(["odom"])


@pytest.mark.parametrize(
    ("words", "made"),
    [
        (("odom", "--robot", SQUARE / "robot.yaml", SQUARE, "--out"), "odom.csv"),
        (("explain", "--json"), "effects.json"),  # rich prints it
    ],
)
def test_nobody_reads_what_it_prints(tmp_path: Path, words: tuple[str, ...], made: str) -> None:
    read, write = os.pipe()
    os.close(read)
    done = subprocess.run(
        [*WERRIMBI, *map(str, words), str(tmp_path / made)],
        stdout=write,
        stderr=subprocess.PIPE,
        env=ENVIRONMENT,
        timeout=60,
    )
    os.close(write)
    assert (done.returncode, done.stderr) == (141, b"")
    assert (tmp_path / made).exists(), "what was asked for had been done by then"


def test_interrupted_in_mid_work_it_leaves_nothing_half_written(tmp_path: Path) -> None:
    run, out = tmp_path / "run", tmp_path / "out"
    run.mkdir()
    out.mkdir()
    rows = "".join(f"{0.001 * i:.3f},{i},{i}\n" for i in range(200_000))
    (run / "ticks.csv").write_text("t_s,left_ticks,right_ticks\n" + rows)
    words = ["odom", "--robot", SQUARE / "robot.yaml", run, "--out", out / "odom.csv"]
    working = started([*WERRIMBI, *words])
    limit = time.monotonic() + 60.0
    while not list(out.glob(".*.part")) and time.monotonic() < limit:
        assert working.poll() is None, "it ended before it could be interrupted"
        time.sleep(0.002)
    working.send_signal(signal.SIGINT)
    said, err = working.communicate(timeout=60)
    assert working.returncode == 130
    assert (said, err) == ("", "")
    assert list(out.iterdir()) == []


def test_a_line_now_and_then_on_stderr(monkeypatch: pytest.MonkeyPatch, werrimbi: Werrimbi) -> None:
    words = ["compare", "--robot", str(RECORDING / "robot.yaml"), str(RECORDING)]
    assert werrimbi(*words).err == ""
    monkeypatch.setattr(progress, "EVERY", 1e-4)
    lines = werrimbi(*words).err.splitlines()
    assert any(line.startswith("comparing: ") and " %, " in line for line in lines)


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A fleet of one robot, whose name is no UTF-8, nor are its run's and its file's."""
    folder = tmp_path_factory.mktemp("names") / os.fsdecode(b"robot_\xff")
    for number in (b"\xfe1", b"\xfe2"):
        run = folder / "train" / os.fsdecode(b"run_" + number)
        run.mkdir(parents=True)
        for name in ("ticks.csv", "reference.csv"):
            shutil.copy(RECORDING / name, run / name)
    shutil.copy(RECORDING / "robot.yaml", folder / "robot.yaml")
    return folder


@pytest.mark.parametrize(
    ("verb", "encoding"),
    [
        ("compare", "ascii"),
        ("odom", "utf-8"),
        *(
            in_evidence(verb, encoding)
            for verb, encoding in [
                *((verb, "ascii") for verb in ("diagnose", "odom", "calibrate fit", "fleet")),
                ("compare", "utf-8"),
            ]
        ),
    ],
)
def test_names_that_are_no_text_are_spelt(
    place: Path, tmp_path: Path, verb: str, encoding: str
) -> None:
    runs = sorted(map(str, (place / "train").iterdir()))
    words = [*verb.split(), "--robot", str(place / "robot.yaml"), *runs]
    report = tmp_path / os.fsdecode(b"r\xfd.html")
    if verb == "odom":
        words = [*words[:-1], "--out", str(tmp_path / os.fsdecode(b"\xff.csv"))]
    elif verb == "fleet":
        words = ["diagnose", "--fleet", str(place.parent), "--report", str(report), "--jobs", "1"]
    else:
        words += ["--report", str(report), "--json", str(tmp_path / "f.json")]
    if verb == "calibrate fit":
        words += ["--out", str(tmp_path / os.fsdecode(b"\xff.yaml"))]
    done = subprocess.run(
        [*WERRIMBI, *words],
        env={**os.environ, "PYTHONPATH": str(ROOT), "PYTHONIOENCODING": encoding},
        capture_output=True,
    )
    assert (done.returncode, done.stderr) == (0, b""), done.stderr[-600:]
    assert verb == "odom" or "udcff" in report.read_text()
