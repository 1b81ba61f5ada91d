# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""CPU time of a draft, against that of the diagnosis that it begins with.

Six minutes of driving at 50 Hz over a slippery spot, which no effect of the library explains. A law
of the place costs most: where the wheels stand depends on what the law does to them, so each
prediction takes several passes.

    python benchmark/draft.py [--hide PECULIARITY[=STRENGTH]]
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from benchmark.diagnosis_hour import ROBOT, drive
from werrimbi_odom.api.compare_diagnose_add import diagnose
from werrimbi_odom.api.draft import draft
from werrimbi_odom.files.robot_files.robot_file import read_robot_file
from werrimbi_odom.simulation import write_robot_file

DRIVES = 6
"""One minute each."""


def main() -> None:
    """Measure, and print."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--hide", default="slippery_spot=0.25", help="what is hidden")
    wish = parser.parse_args().hide
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        file = read_robot_file(write_robot_file(ROBOT, folder / "robot.yaml"))
        runs = [drive(folder, number, wish, 60.0) for number in range(DRIVES)]
        begun = time.process_time()
        verdict = diagnose(file, runs).found.diagnosis.verdict
        middle = time.process_time()
        law = draft(file, runs, force=True).found
        ended = time.process_time()
    alone, whole = middle - begun, ended - middle
    print(f"{DRIVES} min of driving; hidden: {wish}; verdict {verdict}; drafted: {law.name}")
    print(f"diagnose {alone:.1f} s, draft {whole:.1f} s of CPU: {whole / alone:.1f} times as long")


if __name__ == "__main__":
    main()
