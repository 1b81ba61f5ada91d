# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi workbench`: compare, diagnose, add and save on one local page."""

from __future__ import annotations

import argparse
import os
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from werrimbi_odom.cli.options import add_recording_arguments, declare, number, read_recordings
from werrimbi_odom.cli.outputs import write_json

if TYPE_CHECKING:
    from werrimbi_odom.workbench.tab import Shared

HELP = "a local page: compare, diagnose, add an effect, watch the error fall, save"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options of `werrimbi workbench`."""
    parser.description = (
        "Serves one page on this machine alone (127.0.0.1) until Ctrl-C: where the model fails, "
        "which effect is missing, what adding it does to the error of held-out drives, undo, and "
        "the new robot file. Reads and writes nothing but what is given here. Without --holdout "
        "parts of the drives are put aside for judging."
    )
    add_recording_arguments(
        parser, holdout=True, force="overwrite --out if it exists", report=False
    )
    words = "robot file to save to; if not given, R_new.yaml beside R"
    declare(parser, "--out", required=False, help=words)
    port, words = number(int, 0, 65535, "no port (0 to 65535)"), "a free one if not given, or 0"
    parser.add_argument("--port", metavar="N", type=port, default=0, help=words)
    parser.add_argument("--open", action="store_true", help="open the page in the browser")


def run(arguments: argparse.Namespace) -> int:
    """Read, compare, serve until interrupted; return 0."""
    from werrimbi_odom.workbench.job import Job
    from werrimbi_odom.workbench.task import Open

    job = Job(Open())
    job.start()  # first, so that it imports while the drives are read
    # Otherwise NiceGUI creates a folder .nicegui where the command runs, and looks for Redis.
    os.environ["NICEGUI_STORAGE_PATH"] = str(Path(tempfile.gettempdir()) / ".werrimbi_none")
    os.environ.pop("NICEGUI_REDIS_URL", None)
    try:
        from werrimbi_odom.files.text_files import beside
        from werrimbi_odom.report.number_format import picked
        from werrimbi_odom.workbench.saving import Target
        from werrimbi_odom.workbench.server import listening, serve
        from werrimbi_odom.workbench.tab import Opening

        at = listening(arguments.port)
        given = read_recordings(arguments)
        out = arguments.out or Path(beside(arguments.robot, "new"))
        opening = Opening(job, given, Target(out, arguments.force and arguments.out is not None))
    except BaseException:
        job.cancel()
        raise

    def ready(address: str) -> None:
        print(f"{address}  (this machine only; Ctrl-C ends it)", flush=True)
        if arguments.open:
            import webbrowser

            webbrowser.open(address)

    def opened(address: str, shared: Shared) -> None:
        if arguments.json is not None:  # the page's address and its first errors, for programs
            errors, look = "rmse_position_m rmse_yaw_rad", shared.look
            found = {
                "address": address,
                "out": str(shared.target.path),
                "holdout": picked(look.holdout.main.all.figures, errors),
                "train": picked(look.train.main.all.figures, errors),
            }
            write_json(arguments.json, found)

    serve(opening, at, ready, opened)  # server and page start while the drives are compared
    return 0
