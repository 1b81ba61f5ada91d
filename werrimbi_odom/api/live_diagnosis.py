# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Diagnosis of the messages stored by compare_node, in a separate low-priority process.

    python -m werrimbi_odom.api.live_diagnosis FOLDER

FOLDER contains the messages and the request; the result is written there too. Drives are read,
diagnosed and added to as on the command line.
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

from werrimbi_odom.api.compare_diagnose_add import add, diagnose
from werrimbi_odom.api.drives import Options, read_robot, read_run
from werrimbi_odom.api.next_command import NOT_STORED
from werrimbi_odom.api.result import Result
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.bags.bag_writing import BagWriter
from werrimbi_odom.files.run import Run, Ticks
from werrimbi_odom.files.run_checks import refuse_unjudgeable
from werrimbi_odom.files.text_files import replacing

MESSAGES, ASKED, FOUND, BETTER = "messages", "asked.json", "found.json", "better.yaml"
"""Files of the folder."""
OF_NOW = "\n\nThe younger half of these drives alone:\n"
"""Separates the words on all drives from those on the younger half, where the robot changed."""


def found_in(folder: Path) -> dict[str, Any]:
    """Diagnose the stored drives; return the result as JSON data.

    `headline` and `words` are those of the terminal; `error` is the reason if there are none;
    `added` lists the effects of the new robot file, and `refused` is the reason why it is not
    written.
    """
    asked = json.loads((folder / ASKED).read_text(encoding="utf-8"))
    options: Options = asked["options"] | asked["topics"]
    try:
        robot = read_robot(asked["robot"])
        run = read_run(_bag(folder), robot, **asked["topics"])
        refuse_unjudgeable(run, robot.robot)
        drives = halves(run, robot.robot.encoder_bits)
        whole = diagnose(robot, drives, **options)
        if whole.found.diagnosis.wander is not None:
            options["reference_kind"] = "local_map"
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
    """Diagnosis of the robot's present state, and the drives used for it.

    After an effect has set in, the drives together belong to two robots, and no effect explains
    them. The younger half belongs to one robot as soon as the change is old enough.
    """
    told = whole.to_dict()
    if told["verdict"] == "unknown" or told["changes"]:
        now = diagnose(robot, drives[1:], **options)
        if now.to_dict()["verdict"] in ("named", "ambiguous"):
            return now, drives[1:]
    return whole, drives


def halves(run: Run, bits: int = 0) -> list[Run]:
    """Split a drive into halves of equal travel, so that a change between them can be found.

    `bits`: those of counters that begin anew; 0 for none.
    """
    ticks, reference, rolling = run.ticks, run.reference, run.ticks.unwrapped(bits)
    assert reference is not None
    steps = np.abs(np.diff(rolling.left)) + np.abs(np.diff(rolling.right))
    rolled = np.cumsum(np.nan_to_num(steps.astype(np.float64)))
    half = float(ticks.time[int(np.searchsorted(rolled, 0.5 * rolled[-1])) + 1])
    return [
        replace(
            run,
            name=name,
            path=NOT_STORED / name,
            ticks=Ticks(ticks.time[tick], ticks.left[tick], ticks.right[tick]),
            reference=reference.chosen(pose),
        )
        for name, tick, pose in (
            ("older_half", ticks.time <= half, reference.time <= half),
            ("younger_half", ticks.time >= half, reference.time >= half),
        )
    ]


def _bag(folder: Path) -> Path:
    """Write the stored messages to a bag."""
    with (folder / MESSAGES).open("rb") as file:
        topics, messages = pickle.load(file)
    writer = BagWriter(folder / "bag")
    places = [writer.topic(name, kind) for name, kind in topics]
    for received, topic, data in messages:
        writer.write(places[topic], received, data)
    writer.close()
    return folder / "bag"


def main() -> int:
    """Diagnose, and write the result; always return 0."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the node, which ends this process
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
