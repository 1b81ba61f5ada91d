# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Hidden sets: made once, kept in a cache, found again by their names.

A set is a folder as `werrimbi simulate` writes it: robot.yaml, runs below train and holdout, and
truth.json, which only the assertions read.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import shutil
import tempfile
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import asdict, dataclass, replace
from functools import cache as cache_once
from functools import reduce
from pathlib import Path

import numpy as np

from test.hidden.machines import Machine, machine
from test.hidden.poorer import rewrite
from werrimbi_odom.simulation import (
    Hidden,
    Recording,
    UnstableError,
    hide,
    record,
    write_robot_file,
    write_run,
)

ROOT = Path(__file__).parents[2]

CODE = ("werrimbi_odom/simulation", "test/hidden/machines.py", "test/hidden/poorer.py")
"""What the data depend on; when it changes, sets are made anew."""


def cache() -> Path:
    """Where sets are kept: WERRIMBI_HIDDEN, or .hidden in the checkout."""
    return Path(os.environ.get("WERRIMBI_HIDDEN", ROOT / ".hidden"))


@cache_once
def code_mark(*places: str) -> str:
    """A mark of the program in some files or packages."""
    digest = hashlib.sha256()
    for place in places:
        path = ROOT / place
        for file in sorted(path.rglob("*.py")) if path.is_dir() else [path]:
            digest.update(file.relative_to(ROOT).as_posix().encode() + file.read_bytes())
    return digest.hexdigest()[:12]


@dataclass(frozen=True)
class HiddenSet:
    """What is to be hidden where. Equal sets have equal names, and the same data.

    Parameters
    ----------
    group : str
        Which rule judges it.
    effects : tuple of str
        NAME or NAME=STRENGTH; a strength that is not given is drawn from the realistic range.
    seed : int
    setup : str
        Of `machine`.
    seen : str
        A poorer reference's name, or "" for the whole one.
    entered : tuple of (str, float)
        Keys of the robot file, and what their values are multiplied with.
    """

    group: str
    effects: tuple[str, ...]
    seed: int
    setup: str = "own"
    seen: str = ""
    entered: tuple[tuple[str, float], ...] = ()

    @property
    def name(self) -> str:
        """Of its folder."""
        wrong = [f"{key}_times_{factor:.4g}" for key, factor in self.entered]
        parts = [self.setup, *(self.effects or ["none"]), *wrong, self.seen, str(self.seed)]
        return re.sub(r"[^\w.+-]+", "_", "-".join(part for part in parts if part))

    @property
    def path(self) -> Path:
        """Of its folder."""
        return cache() / f"sets_{code_mark(*CODE)}" / self.name

    @property
    def names(self) -> tuple[str, ...]:
        """Of what is hidden."""
        return tuple(effect.partition("=")[0] for effect in self.effects)

    @property
    def plain(self) -> HiddenSet:
        """The set that it is made from: measured well, entered rightly."""
        return replace(self, group="clean" if not self.effects else self.group, seen="", entered=())

    @property
    def truth(self) -> dict[str, object]:
        """What stands in truth.json."""
        found = json.loads((self.path / "truth.json").read_text(encoding="utf-8"))
        assert isinstance(found, dict)
        return found

    def hidden(self) -> list[Hidden]:
        """The engine's peculiarities."""
        found = []
        for number, wish in enumerate(self.effects):
            name, _, strength = wish.partition("=")
            value = float(strength) if strength else None
            found.append(hide(name, value, seed=self.seed, number=number))
        return found


def make(wanted: HiddenSet) -> Path:
    """The folder of a set, made if it is not there yet."""
    if wanted.path.exists():
        return wanted.path
    wanted.path.parent.mkdir(parents=True, exist_ok=True)
    if wanted.seen or wanted.entered:
        make(wanted.plain)
    folder = Path(tempfile.mkdtemp(prefix=".new.", dir=wanted.path.parent))
    try:
        if wanted.seen or wanted.entered:
            _derive(wanted, folder)
        else:
            _drive(wanted, folder)
        try:
            folder.rename(wanted.path)
        except OSError:
            if not wanted.path.exists():  # another process was faster: the same data
                raise
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    return wanted.path


def _drive(wanted: HiddenSet, folder: Path) -> None:
    """Let the engine make it."""
    there = machine(wanted.setup, wanted.seed)
    hidden = wanted.hidden()
    odd = [each.peculiarity for each in hidden]
    written = reduce(lambda robot, each: each.written(robot), odd, there.robot)
    write_robot_file(written, folder / "robot.yaml")
    with there.built():
        for number, (name, drive) in enumerate(there.drives.items()):
            recording = record(
                there.robot,
                drive,
                seed=1000 * wanted.seed + number,
                reference=there.reference,
                ticks_rate_hz=there.ticks_rate_hz,
                hidden=odd,
            )
            write_run(_steady(recording, there), folder / name)
    truth = {
        "group": wanted.group,
        "hidden": [
            {
                "effect": each.entry.name,
                "strength": each.strength,
                "unit": each.entry.unit,
                "kind": each.entry.kind,
                "parameters": asdict(each.peculiarity),
            }
            for each in hidden
        ],
        "seed": wanted.seed,
        "robot_before_hiding": asdict(there.robot),
        "setup": wanted.setup,
        "seen": "",
        "entered": [],
    }
    (folder / "truth.json").write_text(json.dumps(truth, indent=2) + "\n", encoding="utf-8")


def _steady(recording: Recording, there: Machine) -> Recording:
    """A record switched on and off while the robot moves, where the machine wants it so."""
    if not there.steady:
        return recording
    ticks = (recording.t_s > 3.0) & (recording.t_s < recording.t_s[-1] - 3.0)
    seen = (recording.reference_t_s > 3.2) & (
        recording.reference_t_s < recording.reference_t_s[-1] - 3.2
    )
    return replace(
        recording,
        t_s=recording.t_s[ticks],
        left_ticks=recording.left_ticks[ticks],
        right_ticks=recording.right_ticks[ticks],
        reference_t_s=recording.reference_t_s[seen],
        reference_x_m=recording.reference_x_m[seen],
        reference_y_m=recording.reference_y_m[seen],
        reference_yaw_rad=recording.reference_yaw_rad[seen],
        channels={name: values[ticks] for name, values in recording.channels.items()},
    )


def _derive(wanted: HiddenSet, folder: Path) -> None:
    """The drives of another set, seen or entered worse."""
    source = wanted.plain
    shutil.copytree(source.path, folder, dirs_exist_ok=True)
    if wanted.seen:
        for run in runs_of(folder, "train") + runs_of(folder, "holdout"):
            rewrite(run, wanted.seen, wanted.seed)
    file = folder / "robot.yaml"
    text = file.read_text(encoding="utf-8")
    for key, factor in wanted.entered:
        text = times(text, key, factor)
    file.write_text(text, encoding="utf-8")
    truth = source.truth | {
        "group": wanted.group,
        "seen": wanted.seen,
        "entered": [list(pair) for pair in wanted.entered],
    }
    (folder / "truth.json").write_text(json.dumps(truth, indent=2) + "\n", encoding="utf-8")


def times(text: str, key: str, factor: float) -> str:
    """A robot file with one value multiplied."""
    pattern = re.compile(rf"^(\s+{key}:\s*)([^\s#]+)", re.MULTILINE)
    found = pattern.search(text)
    assert found, f"no {key} in the robot file"
    value = float(found[2]) * factor
    return text[: found.start(2)] + f"{value!r}" + text[found.end(2) :]


def runs_of(folder: Path, part: str) -> list[Path]:
    """Run folders of a set, in order."""
    return sorted(each for each in (folder / part).glob("*") if each.is_dir())


def make_all(wanted: Sequence[HiddenSet], workers: int) -> Iterator[HiddenSet]:
    """Make what is not there yet, each set as soon as it is ready.

    Sets that others are made from come first. A robot that the engine cannot hold is left out.
    """
    missing = [each for each in wanted if not each.path.exists()]
    sources = {each.plain.name: each.plain for each in missing if each.seen or each.entered}
    first = [each for each in sources.values() if not each.path.exists()]
    done = {each.name for each in first}
    second = [each for each in missing if each.name not in done]
    for part in (first, second):
        yield from _pooled(part, workers)


def _pooled(wanted: Iterable[HiddenSet], workers: int) -> Iterator[HiddenSet]:
    with ProcessPoolExecutor(workers) as pool:
        jobs = {pool.submit(make, each): each for each in dict.fromkeys(wanted)}
        for job in as_completed(jobs):
            try:
                job.result()
            except UnstableError as error:
                print(f"left out: {jobs[job].name}: {error}")
                continue
            yield jobs[job]


def drawn(seed: int, *words: str) -> np.random.Generator:
    """Chance for one purpose."""
    return np.random.default_rng([seed, *"|".join(words).encode()])
