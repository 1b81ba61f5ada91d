# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A diagnosis with everything reported beside it: next manoeuvre, detection limits, changes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from werrimbi_odom.files.recordings import Recordings
from werrimbi_odom.inference.changes.between_drives import Moved, changes_between
from werrimbi_odom.inference.diagnosis.diagnosis import SURE, Diagnosis, diagnose
from werrimbi_odom.inference.diagnosis.evidence import Dependence
from werrimbi_odom.inference.manoeuvres.detection_limits import DetectionLimit, detection_limits
from werrimbi_odom.inference.manoeuvres.proposal import ProposedManoeuvre, next_manoeuvre, strongest
from werrimbi_odom.progress import Show, silent


@dataclass(frozen=True)
class Told:
    """A diagnosis and everything that is reported with it."""

    diagnosis: Diagnosis
    manoeuvre: ProposedManoeuvre | None
    sights: Sequence[DetectionLimit]
    leg: float = 1.0
    """Length of the judged legs [m]."""
    held_out: bool = True
    """Whether held-out drives were given; otherwise the diagnosis held out parts itself."""
    changes: Sequence[Moved] = ()
    """Changes between the fitted drives."""


def told_of(given: Recordings, show: Show = silent) -> Told:
    """Diagnose one robot, with the next manoeuvre, the detection limits and the changes.

    Raises
    ------
    InputError
        When the drives do not allow it; the message says why.
    """
    effects = given.collection.effects
    diagnosis = diagnose(
        given.runs, given.robot, effects, given.evaluation, holdout=given.holdout, show=show
    )
    show(0.97, "the next step")
    manoeuvre = next_manoeuvre(diagnosis)
    sights = detection_limits(diagnosis, effects)
    changes = changes_between(diagnosis, effects)
    return Told(diagnosis, manoeuvre, sights, given.how.leg, bool(given.holdout), changes)


def significant(diagnosis: Diagnosis) -> list[Dependence]:
    """Significant cells of the evidence map, one for each channel and variable.

    Most significant first; if no effect explains the errors, first the cell that explains most.
    """
    cells = one_each(beyond_chance(diagnosis.depends_on))
    first = strongest(diagnosis) if diagnosis.verdict == "unknown" else None
    if first is None:
        return cells
    others = [cell for cell in cells if (cell.channel, cell.name) != (first.channel, first.name)]
    return [first, *others]


def beyond_chance(cells: Iterable[Dependence]) -> Iterator[Dependence]:
    """Significant cells of the evidence map."""
    return (cell for cell in cells if cell.p_value < SURE)


def one_each(cells: Iterable[Dependence]) -> list[Dependence]:
    """The first cell of each channel and variable."""
    found: dict[tuple[str, str], Dependence] = {}
    for cell in cells:
        found.setdefault((cell.channel, cell.name), cell)
    return list(found.values())
