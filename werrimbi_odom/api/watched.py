# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The diagnosis of what compare_node has kept, in a process of its own that leaves others alone.

    python -m werrimbi_odom.api.watched FOLDER

FOLDER has the messages and what is asked; what was found is put there too. Nothing here is of the
node's own: drives are read, diagnosed and added to as by the command line.
"""

from __future__ import annotations

import json
import os
import pickle
import resource
import signal
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from werrimbi_odom.api.drives import Options, read_robot, read_run
from werrimbi_odom.api.result import Result
from werrimbi_odom.api.verbs import add, diagnose
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.bag_writing import BagWriter
from werrimbi_odom.files.run import Run, Ticks
from werrimbi_odom.files.run_checks import refuse_unjudgeable
from werrimbi_odom.files.text_files import replacing

MESSAGES, ASKED, FOUND, BETTER = "messages", "asked.json", "found.json", "better.yaml"
"""Files of the folder."""
RECORDED = Path("RUN...")
"""In the commands that are told, for what is kept is nowhere to be found afterwards."""
OF_NOW = "\n\nThe younger half of these drives alone:\n"
"""Between what all of them say and what that half does, where the robot became another one."""


def found_in(folder: Path) -> dict[str, Any]:
    """What is said of the drives that were kept, as JSON has it.

    `headline` and `words` are those of the terminal, `error` says why there are none, `added` which
    effects are in the new robot file, and `refused` why it is not written.
    """
    asked = json.loads((folder / ASKED).read_text(encoding="utf-8"))
    options: Options = asked["options"] | asked["topics"]
    try:
        robot = read_robot(asked["robot"])
        run = read_run(_bag(folder), robot, **asked["topics"])
        refuse_unjudgeable(run)
        drives = halves(run)
        whole = diagnose(robot, drives, **options)
        result, drives = of_now(whole, robot, drives, options)
    except InputError as error:
        return {"error": str(error)}
    of_whole = whole.to_dict()
    told, changes = of_whole if result is whole else result.to_dict(), of_whole["changes"]
    said = [*(each["words"] for each in changes), getattr(result.document().words[0], "text", "")]
    words = [each.summary().partition("\n\n")[0] for each in (whole, result)]
    found: dict[str, Any] = {
        "headline": " ".join(said),
        "words": words[0] if result is whole else OF_NOW.join(words),
        **{key: told[key] for key in ("verdict", "effect", "rivals", "next_manoeuvre")},
        "changes": changes,
        "added": [],
        "refused": "",
    }
    names = result.found.diagnosis.found
    if told["verdict"] == "named" and names:
        try:
            add(names, robot, drives, **options).write_robot(folder / BETTER)
            found["added"] = list(names)
        except InputError as error:
            found["refused"] = str(error)
    return found


def of_now(
    whole: Result[Any], robot: Any, drives: list[Run], options: Options
) -> tuple[Result[Any], list[Run]]:
    """What the robot is now, and the drives that say so.

    Where something set in, all of the drives are those of two robots, and no effect explains them;
    the younger half is of one as soon as it is as old.
    """
    told = whole.to_dict()
    if told["verdict"] == "unknown" or told["changes"]:
        now = diagnose(robot, drives[1:], **options)
        if now.to_dict()["verdict"] in ("named", "ambiguous"):
            return now, drives[1:]
    return whole, drives


def halves(run: Run) -> list[Run]:
    """A drive as two, with as much travel in each: of two can be said what changed between them."""
    ticks, reference = run.ticks, run.reference
    assert reference is not None
    steps = np.abs(np.diff(ticks.left)) + np.abs(np.diff(ticks.right))
    rolled = np.cumsum(np.nan_to_num(steps.astype(np.float64)))
    half = float(ticks.time[int(np.searchsorted(rolled, 0.5 * rolled[-1])) + 1])
    return [
        replace(
            run,
            name=name,
            path=RECORDED,
            ticks=Ticks(ticks.time[tick], ticks.left[tick], ticks.right[tick]),
            reference=reference.chosen(pose),
        )
        for name, tick, pose in (
            ("older_half", ticks.time <= half, reference.time <= half),
            ("younger_half", ticks.time >= half, reference.time >= half),
        )
    ]


def _bag(folder: Path) -> Path:
    """What was kept, as a bag that every verb reads."""
    with (folder / MESSAGES).open("rb") as file:
        topics, messages = pickle.load(file)
    writer = BagWriter(folder / "bag")
    places = [writer.topic(name, kind) for name, kind in topics]
    for received, topic, data in messages:
        writer.write(places[topic], received, data)
    writer.close()
    return folder / "bag"


def main() -> int:
    """Look, and write what was found; always 0."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the node, which ends us
    os.nice(10)
    folder = Path(sys.argv[1])
    found = found_in(folder)
    used = resource.getrusage(resource.RUSAGE_SELF)
    found["cpu_s"] = used.ru_utime + used.ru_stime
    with replacing(folder / FOUND) as file:
        json.dump(found, file)
    return 0


if __name__ == "__main__":
    sys.exit(main())
