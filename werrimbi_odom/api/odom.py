# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Dead reckoning of a recorded run, from where its reference begins."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, TextIO, TypeVar

from werrimbi_odom.api.drives import read_run
from werrimbi_odom.api.result import Result
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.robot_file import RobotFile
from werrimbi_odom.files.run import Run
from werrimbi_odom.progress import Show, silent

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from werrimbi_odom.model.pose import Floats, Pose
    from werrimbi_odom.model.reference_measurement import Path as ShownPath
    from werrimbi_odom.model.trajectory import Trajectory
    from werrimbi_odom.report.reckoning import Reckoning

COLUMNS = "t_s,x_m,y_m,yaw_rad,xx,xy,xyaw,yy,yyaw,yawyaw"
_BLOCK = 32768  # rows that are text at once
Found = TypeVar("Found")


@dataclass(frozen=True, repr=False, kw_only=True)
class Reckoned(Result[Any]):
    """Dead reckoning of a run."""

    found: Reckoning

    def write_rows(
        self, path: str | Path, *, as_reference: bool = False, show: Show = silent
    ) -> None:
        """Write pose and covariance, a row for each row of ticks; an existing file is replaced.

        Parameters
        ----------
        as_reference
            What the reference is predicted to show, in place of the axle's midpoint.

        Raises
        ------
        InputError
            When it cannot be written.
        """
        from werrimbi_odom.files.replacing import replacing

        ticks, driven = self.found.run.ticks, self.found.driven
        with replacing(Path(path)) as file:
            shown = self.found.shown if as_reference else driven
            _write_rows(file, ticks.time, driven.expanded(ticks.rows), shown, show)


def odom(robot: RobotFile, run: Run | str | Path) -> Reckoned:
    """Dead reckoning of a run, started where the reference shows its first pose.

    Parameters
    ----------
    robot
        From `read_robot`.
    run
        From `read_run`, or its path.

    Raises
    ------
    InputError
        When the run cannot be used; the message says why.
    """
    from werrimbi_odom.files.learned_phases import with_learnt_phases
    from werrimbi_odom.files.start_pose import start_of
    from werrimbi_odom.model.effect import view_of
    from werrimbi_odom.model.reference_measurement import shown
    from werrimbi_odom.report.reckoning import reckoning_of
    from werrimbi_odom.report.reckoning_document import document_of

    recorded = run if isinstance(run, Run) else read_run(run, robot)
    complete, learnt = _usable(recorded, lambda: with_learnt_phases(recorded, robot))
    start = _usable(recorded, lambda: start_of(recorded, complete))
    driven = _reckoned(recorded, complete, start.pose)
    seen = shown(driven, view_of(complete.robot.effects))
    found = reckoning_of(recorded, start, driven, seen, learnt)
    return Reckoned(
        found=found,
        document=lambda: document_of(found, robot.path),
        figures_of_json=found.as_json,
    )


def _usable(recorded: Run, work: Callable[[], Found]) -> Found:
    """The result of some work on a run; what is wrong with the run names it."""
    import numpy as np

    try:
        with np.errstate(all="ignore"):  # absurd numbers are found in the end, and said once
            return work()
    except ValueError as error:
        raise InputError(f"{recorded.path}: {error}") from error


def _reckoned(recorded: Run, robot_file: RobotFile, start: Pose) -> Trajectory:
    import numpy as np

    from werrimbi_odom.files.start_pose import driven

    found = _usable(recorded, lambda: driven(recorded, robot_file, start))
    for values in (found.x, found.y, found.yaw, *found.covariance):
        wrong = np.flatnonzero(~np.isfinite(values))
        if wrong.size:
            row = int(found.row[wrong[0]]) + 1
            raise InputError(
                f"{recorded.path}: the pose grows beyond all numbers at row {row} of the ticks; "
                "are the counts, and wheel_radius, right?"
            )
    return found


def _write_rows(
    file: TextIO,
    time: Floats,
    entry: NDArray[np.intp],
    driven: Trajectory | ShownPath,
    show: Show,
) -> None:
    import numpy as np

    estimates = (driven.x, driven.y, _half_open(driven.yaw), *driven.covariance)
    file.write(COLUMNS + "\n")
    for first in range(0, time.size, _BLOCK):
        rows = slice(first, first + _BLOCK)
        table = np.stack([time[rows], *(values[entry[rows]] for values in estimates)], axis=1)
        # repr is the shortest text that reads back as the same number
        file.writelines(",".join(map(repr, row)) + "\n" for row in table.tolist())
        show(first / time.size, "writing")


def _half_open(yaw: Floats) -> Floats:
    """The same directions in (-pi, pi]."""
    import numpy as np

    from werrimbi_odom.model.pose import wrap_all

    wrapped = wrap_all(yaw)
    return np.minimum(np.where(wrapped <= -np.pi, wrapped + 2.0 * np.pi, wrapped), np.pi)
