# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Much work by several processes, that can be stopped at any time and goes on from there.

Each result is a line of JSON, kept as soon as it is there. A folder of them belongs to one state of
the code that is judged; other code begins anew.
"""

from __future__ import annotations

import json
import os
import subprocess
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import ProcessPoolExecutor, as_completed
from multiprocessing import get_context
from pathlib import Path
from typing import Any, TypeVar

from test.hidden.sets import ROOT, cache, code_mark

Task = TypeVar("Task")
Line = dict[str, Any]

CODE = tuple(
    f"werrimbi_odom/{name}" for name in ("model", "effects", "scans", "files", "inference")
)
"""What a verdict depends on; when it changes, everything is judged anew, on other sets."""


def mark() -> str:
    """Of the code that is judged."""
    return code_mark(*CODE)


def results_of(part: str) -> Path:
    """Where a part's results of the present code are kept."""
    return cache() / "results" / mark() / f"{part}.jsonl"


def commit_now() -> str:
    """Of the checkout, with a + where it was changed since."""
    words = ["git", "-C", str(ROOT), "describe", "--always", "--dirty=+", "--abbrev=10"]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    return done.stdout.strip() or "unknown"


def kept(file: Path) -> dict[str, Line]:
    """All results of a file by their keys; a last line that was cut off is left out."""
    found: dict[str, Line] = {}
    for text in file.read_text(encoding="utf-8").splitlines() if file.exists() else ():
        try:
            line = json.loads(text)
        except json.JSONDecodeError:
            continue
        found[line.pop("key")] = line
    return found


def keep(key: str, line: Line, file: Path) -> None:
    """Add a result."""
    file.parent.mkdir(parents=True, exist_ok=True)
    with file.open("a", encoding="utf-8") as out:
        out.write(json.dumps({"key": key, **line}) + "\n")


def done(
    file: Path, tasks: Mapping[str, Task], work: Callable[[Task], Line], workers: int
) -> Iterator[tuple[str, Line]]:
    """Do what is not done yet; each result as soon as it is there.

    Parameters
    ----------
    tasks
        By the keys of their results; each can be sent to another process, as can `work`.
    """
    there = kept(file)
    missing = {key: task for key, task in tasks.items() if key not in there}
    if not missing:
        return
    # Before numpy is there: small matrices are slower with several threads.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    with ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as pool:
        jobs = {pool.submit(work, task): key for key, task in missing.items()}
        for job in as_completed(jobs):
            try:
                line = job.result()
            except Exception as error:  # one task must not end an hour's work; it is tried again
                print(f"{jobs[job]} failed: {type(error).__name__}: {error}", flush=True)
                continue
            keep(jobs[job], line, file)
            yield jobs[job], line
