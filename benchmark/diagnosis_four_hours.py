# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Processor time and memory of a diagnosis of four hours of driving in one recording, at 200 Hz.

2.9 million readings of the counters and a reference at 25 Hz, by kinematics and white noise alone.

    python benchmark/diagnosis_four_hours.py [HOURS]
"""

from __future__ import annotations

import resource
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from test.white_noise_robot import WhiteNoiseRobot, drive, wandering
from werrimbi_odom.api.one_blas_thread import with_one_blas_thread
from werrimbi_odom.effects.library import LIBRARY
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference.diagnosis.diagnosis import diagnose
from werrimbi_odom.model.robot import Robot

HERTZ = 200.0

LIMIT, MOST = 120.0, 2000.0
"""Processor time [s] and resident memory [MB] that four hours should stay below."""


def made(hours: float) -> Run:
    """One drive."""
    random = np.random.default_rng(5)
    commands = wandering(random, 3600.0 * hours, HERTZ)
    return drive(WhiteNoiseRobot(), commands, random, every=8, fine=1, hertz=HERTZ)


def main() -> None:
    """Measure, and print."""
    hours = float(sys.argv[1]) if len(sys.argv) > 1 else 4.0
    with ProcessPoolExecutor(1) as pool:  # what making it takes is not counted
        run = pool.submit(made, hours).result()
    before = time.process_time()
    found = with_one_blas_thread(diagnose)([run], Robot(0.35, 0.05, 2000.0, 2000.0), LIBRARY)
    spent = time.process_time() - before
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3
    print(f"{run.ticks.rows} readings in {hours:g} hours: {found.verdict} {', '.join(found.found)}")
    print(f"{spent:.0f} s of processor time, {memory:.0f} MB; limits {LIMIT:.0f} s, {MOST:.0f} MB")
    if spent > LIMIT or memory > MOST:
        print("over the limit (was the machine idle?)", file=sys.stderr)


if __name__ == "__main__":
    main()
