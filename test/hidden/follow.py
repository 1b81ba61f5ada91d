# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A user who does what the tool says: diagnose, type the command that it prints, diagnose again.

Only commands and what they print and write are looked at, so this holds whatever becomes of the
code behind them. Commands run in this process: importing costs as much as some of them do.
"""

from __future__ import annotations

import contextlib
import io
import json
import os
import re
import shlex
import tempfile
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

MOST = 7
"""Commands that are followed, at the most: more than any set hides."""

_COMMAND = re.compile(r"(?:^ {4,}|[?:] {2,})(werrimbi [a-z].*)$", re.MULTILINE)


@dataclass(frozen=True)
class Ran:
    """A command that was run."""

    code: int
    printed: str
    complained: str
    seconds: float
    """Of one core."""


@dataclass
class Followed:
    """Where the printed commands led to."""

    ended: str = ""
    """none, unknown (nothing more to add); again (a verdict that was given before); refused (a
    command ended with an error); no command; goes on (MOST commands and no end); crashed."""
    verdicts: list[str] = field(default_factory=list)
    """What each diagnosis said: verdict, and what it found."""
    added: list[list[str]] = field(default_factory=list)
    """What each command added."""
    first: dict[str, Any] = field(default_factory=dict)
    """JSON of the first diagnosis."""
    printed: str = ""
    """What it prints."""
    seconds: float = 0.0
    """Of one core, for the first diagnosis, reading and all."""
    after: float | None = None
    """Held-out position error of the robot file at the end, as the last diagnosis says [m]."""
    fits: list[dict[str, Any]] = field(default_factory=list)
    """JSON of each addition."""
    explains: bool | None = None
    """Whether compare says that the final model explains all drives; None but after a `none`."""
    mean_is_right: bool | None = None
    """The same of its mean alone, whatever compare says of the covariance."""
    drafted: float | None = None
    """Held-out position error with the effect that was drafted, where asked for [m]."""
    error: str = ""

    @property
    def names(self) -> tuple[str, ...]:
        """All that was added."""
        return tuple(name for names in self.added for name in names)


def run(words: Sequence[str]) -> Ran:
    """A command as `werrimbi` would run it; exceptions are those that no user may ever see."""
    from werrimbi_odom.cli.main import main

    out, err = io.StringIO(), io.StringIO()
    begin = time.process_time()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        code = main(list(words))
    return Ran(code, out.getvalue(), err.getvalue().strip(), time.process_time() - begin)


def run_json(words: Sequence[str]) -> tuple[Ran, dict[str, Any]]:
    """A command with --json, and that JSON; empty where the command ended with an error."""
    with tempfile.TemporaryDirectory() as place:
        file = Path(place) / "found.json"
        done = run([*words, "--json", str(file)])
        return done, json.loads(file.read_text(encoding="utf-8")) if done.code == 0 else {}


def commands(text: str, verb: str) -> list[list[str]]:
    """Commands of a verb that a text tells to type, as words; a backslash carries on a line."""
    whole = re.sub(r"\s*\\\n\s*", " ", text)
    found = [shlex.split(words) for words in _COMMAND.findall(whole)]
    return [words for words in found if words[1] == verb]


def typed(command: Sequence[str], train: Sequence[str], holdout: Sequence[str]) -> list[str]:
    """What a shell makes of a command; a user puts the drives where it says RUN..."""
    drives = iter((train, holdout))
    words: list[str] = []
    for word in command[1:]:
        if word == "RUN...":
            words += next(drives)
        elif "*" in word:
            words += sorted(map(str, Path().glob(word))) or [word]
        else:
            words.append(word)
    return words


def follow(
    folder: Path, options: Sequence[str] = (), *, most: int = MOST, draft: bool = False
) -> Followed:
    """Follow what is printed for a hidden set, until it comes to rest.

    Parameters
    ----------
    folder
        With robot.yaml, and runs below train and holdout; nothing is written into it.
    options
        Of the user's own commands, such as --reference-kind incremental.
    most
        Commands that are followed at the most; 0: a diagnosis, and nothing of what it says.
    draft
        Also draft what is unknown from the beginning, and try the draft.
    """
    told = Followed()
    with _day(folder):
        try:
            _walk(told, list(options), most)
            if draft and told.verdicts[:1] == ["unknown"]:
                told.drafted = _drafted(told, list(options))
        except Exception as error:  # a crash is a finding, and must not end an hour's work
            told.ended, told.error = "crashed", f"{type(error).__name__}: {error}"
    return told


@contextlib.contextmanager
def _day(folder: Path) -> Iterator[None]:
    """A folder to work in, with the set's files as a user has them."""
    before = Path.cwd()
    with tempfile.TemporaryDirectory(prefix="follow") as name:
        day = Path(name)
        (day / "robot.yaml").write_bytes((folder / "robot.yaml").read_bytes())
        for part in ("train", "holdout"):
            if (folder / part).exists():
                (day / part).symlink_to((folder / part).resolve())
        os.chdir(day)
        try:
            yield
        finally:
            os.chdir(before)


def _drives(part: str) -> list[str]:
    return sorted(str(run) for run in Path(part).glob("*") if run.is_dir())


def _walk(told: Followed, options: list[str], most: int) -> None:
    train, holdout = _drives("train"), _drives("holdout")
    words = ["diagnose", "--robot", "robot.yaml", *train, *options]
    words += ["--holdout", *holdout] if holdout else []
    while not told.ended:
        text = _diagnose(words, told)
        *earlier, last = told.verdicts or [""]
        if told.ended:
            break
        if last in ("none", "unknown"):
            told.ended = last
        elif last in earlier:
            told.ended = "again"
        elif len(told.added) >= most:
            told.ended = "goes on"
        else:
            words = _add(text, told, train, holdout)
    if told.ended == "none" and most:
        _compare(words[words.index("--robot") + 1], [*train, *holdout], options, told)


def _diagnose(words: list[str], told: Followed) -> str:
    """What a diagnosis prints."""
    done, said = run_json(words)
    if done.code != 0:
        told.ended, told.error = "refused", done.complained
        return ""
    if not told.first:
        told.first, told.printed, told.seconds = said, done.printed, done.seconds
    told.after = said["holdout"]["before"]
    names = ", ".join(said["rivals"] or [each["effect"] for each in said["found"]])
    told.verdicts.append(f"{said['verdict']} {names}".strip())
    return done.printed


def _add(text: str, told: Followed, train: list[str], holdout: list[str]) -> list[str]:
    """Add what is printed first; returns the diagnosis that the addition prints."""
    wanted = commands(text, "add")
    if not wanted:
        told.ended = "no command"
        return []
    words = typed(wanted[0], train, holdout)
    done, said = run_json(words)
    if done.code != 0:
        told.ended, told.error = "refused", done.complained
        return []
    told.added.append(words[1].split(","))
    told.fits.append(said)
    wanted = commands(done.printed, "diagnose")
    if not wanted:
        told.ended = "no command"
        return []
    return typed(wanted[0], train, holdout)


def _compare(robot: str, runs: list[str], options: list[str], told: Followed) -> None:
    """What compare says of a model that the diagnosis finds nothing wrong with."""
    done, said = run_json(["compare", "--robot", robot, *runs, *options])
    if done.code != 0:
        told.error = done.complained
        return
    told.explains = said["verdict"]["good"]
    told.mean_is_right = said["verdict"]["mean_is_right"]


def _drafted(told: Followed, options: list[str]) -> float | None:
    """Held-out position error once the draft is added [m]; None where the commands do not lead."""
    train, holdout = _drives("train"), _drives("holdout")
    wanted = commands(told.printed, "draft")
    done = run(typed(wanted[0], train, holdout)) if wanted else None
    tries = commands(done.printed, "add") if done is not None and done.code == 0 else []
    if not tries:
        told.error = done.complained if done is not None else "no draft is proposed"
        return None
    words = typed(tries[0], train, holdout)
    done = run(words)
    if done.code != 0:
        told.error = done.complained
        return None
    model = [words[words.index("--effects") + 1], "--robot", words[words.index("--out") + 1]]
    done, said = run_json(["compare", "--effects", *model, *holdout, *options])
    if done.code != 0:
        told.error = done.complained
        return None
    return float(said["legs"]["rmse_position_m"])
