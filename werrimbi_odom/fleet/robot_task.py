# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The diagnosis of one robot as a task for another process; it always returns a row."""

from __future__ import annotations

import traceback
from dataclasses import dataclass
from pathlib import Path
from threading import Lock

from werrimbi_odom.api.compare_diagnose_add import diagnosed
from werrimbi_odom.api.drives import refuse_circles, told_apart
from werrimbi_odom.effects.lookup import all_effects
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.recordings import Asked, read
from werrimbi_odom.report.fleet import Row

_ONE_AT_A_TIME = Lock()
"""Modules of effect files are global to the process."""


@dataclass(frozen=True)
class Task:
    """A robot to diagnose; can be pickled."""

    name: str
    asked: Asked


def row_of(task: Task) -> Row:
    """Diagnose a robot; errors are returned in its row, never raised."""
    try:
        with _ONE_AT_A_TIME:
            asked = task.asked
            given = told_apart(read(asked, all_effects(asked.how.effects)))
            refuse_circles(given)
            figures = diagnosed(given).to_dict()
        return Row(task.name, _drives(task), figures)
    except MemoryError:
        return failed(task, "this needs more memory than there is; cut the runs into several")
    except (InputError, OSError) as error:
        return failed(task, str(error))
    except (SystemExit, KeyboardInterrupt) as error:  # Ctrl-C does not arrive here, see `spread`
        return failed(task, f"code that it ran ended it ({type(error).__name__}: {error})")
    except Exception as error:  # one robot must not end the fleet
        return failed(task, bug(error))


def failed(task: Task, why: str) -> Row:
    """Row of a robot that could not be diagnosed."""
    return Row(task.name, _drives(task), None, " ".join(why.split()))


def bug(error: BaseException) -> str:
    """Message for an unexpected exception, which is a bug of this package."""
    message = " ".join(str(error).split())
    steps = traceback.extract_tb(error.__traceback__)
    where = f" ({Path(steps[-1].filename).name}, line {steps[-1].lineno})" if steps else ""
    return (
        "this is a bug of werrimbi_odom, not of your files; please report it: "
        f"{type(error).__name__}: {message}{where}"
    )


def _drives(task: Task) -> int:
    return len(task.asked.runs) + len(task.asked.holdout)
