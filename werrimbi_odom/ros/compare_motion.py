# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Whether the robot currently moves as its wheels turn, or is held, carried, or slips.

A recording is classified with hindsight (`inference.legs.held_or_carried`). Here the state is
derived from the last second, and reported once it has lasted.
"""

from __future__ import annotations

import math
from collections import deque
from typing import Literal

from werrimbi_odom.inference import rules
from werrimbi_odom.model.pose import between, wrap
from werrimbi_odom.ros.compare_legs import Both

State = Literal["standing", "driving", "held", "carried", "slipping"]

SPAN = 2.0 * rules.NO_DRIVING_WINDOW
"""Window over which wheels and reference are compared [s]; with large noise, as long as a leg."""
REMEMBERED = 600
"""Number of instants of driving that show whether wheels and reference agree at all."""

WORDS: dict[State, str] = {
    "standing": "the robot stands",
    "driving": "the robot drives as its wheels turn",
    "held": "the wheels turn and the robot does not: it is held, or against a wall",
    "carried": "the robot moves and its wheels do not: it is carried, or pushed",
    "slipping": "the robot moves otherwise than its wheels turn: they slip, or it is pushed",
}


class Motion:
    """Classifies the motion from odometry and reference, instant by instant."""

    def __init__(self) -> None:
        self.state: State = "standing"
        self._kept: deque[Both] = deque()
        self._agreed: deque[bool] = deque(maxlen=REMEMBERED)
        self._seen: State = "standing"
        self._since = -math.inf

    @property
    def ever_agrees(self) -> bool:
        """Whether wheels and reference usually agree; otherwise something is set up wrongly."""
        few = len(self._agreed) < rules.NO_DRIVING_FEWEST
        return few or sum(self._agreed) > 0.5 * len(self._agreed)

    def restart(self) -> None:
        """Restart, after the pose was set."""
        self._kept.clear()
        self._since = -math.inf

    def take(self, both: Both) -> State:
        """State at an instant; abnormal states are reported once they have lasted."""
        kept, time = self._kept, both.odometry.time
        if kept and time - kept[-1].odometry.time > SPAN:
            self.restart()
        kept.append(both)
        while len(kept) > 2 and time - kept[1].odometry.time >= SPAN:
            kept.popleft()
        if time - kept[0].odometry.time < SPAN:
            return self.state
        seen = _state(kept[0], both)
        if seen not in ("standing", "carried"):
            self._agreed.append(seen == "driving")
        if seen != self._seen:
            self._seen, self._since = seen, time
        if seen in ("standing", "driving") or time - self._since >= rules.NO_DRIVING_STOPPED_FOR:
            self.state = seen
        return self.state

    def status(self) -> tuple[bool, str]:
        """Whether all is well, and the message."""
        if not self.ever_agrees:
            return False, (
                "wheels and reference hardly ever go together: is something set up wrongly? Record "
                "a drive, and ask werrimbi diagnose"
            )
        return self.state in ("standing", "driving"), WORDS[self.state]


def _state(start: Both, end: Both) -> State:
    """Classify the motion between two instants."""
    wheels = between(start.odometry.pose, end.odometry.pose)
    seen = between(start.reference.pose, end.reference.pose)
    noise = [start.reference.covariance, end.reference.covariance]
    noise_way = rules.NO_DRIVING_NOISE * math.sqrt(sum(each.xx + each.yy for each in noise))
    noise_turn = rules.NO_DRIVING_NOISE * math.sqrt(sum(each.yawyaw for each in noise))
    least_way, least_turn = (
        max(rules.NO_DRIVING_WAY, noise_way),
        max(rules.NO_DRIVING_TURN, noise_turn),
    )
    way, turn = math.hypot(wheels.x, wheels.y), abs(wrap(wheels.yaw))
    seen_way, seen_turn = math.hypot(seen.x, seen.y), abs(wrap(seen.yaw))
    rolled = end.odometry.path - start.odometry.path
    turned = end.odometry.turned - start.odometry.turned
    if rolled < rules.STANDS * least_way and turned < rules.STANDS * least_turn:
        return "carried" if seen_way > least_way or seen_turn > least_turn else "standing"
    if way < least_way and turn < least_turn:
        return "standing"  # or too slow to decide
    stopped_way = seen_way < rules.NO_DRIVING_STOPPED * way + noise_way
    stopped_turn = seen_turn < rules.NO_DRIVING_STOPPED * turn + noise_turn
    if stopped_way and stopped_turn:
        return "held"
    off_way = abs(seen_way - way) > rules.NO_DRIVING_OFF * way + noise_way
    off_turn = abs(wrap(seen.yaw - wheels.yaw)) > rules.NO_DRIVING_OFF * turn + noise_turn + (
        rules.NO_DRIVING_TURN
    )
    return "slipping" if off_way or off_turn else "driving"
