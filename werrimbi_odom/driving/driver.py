# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""State machine of a drive: when the robot moves, and when it stops.

A `Driver` waits for `start`, drives its plan once, and stands still again. Any fault stops it, and
only another `start` moves it again. The caller passes the time: `now` is any monotonic clock [s].
"""

from __future__ import annotations

import math
from collections import deque
from typing import Literal

from werrimbi_odom.driving.limits import (
    SLIP_WINDOW,
    STILL,
    Area,
    Command,
    Limits,
    OdometryReading,
    Watch,
    fault_between,
)
from werrimbi_odom.driving.path_following import PathFollower
from werrimbi_odom.driving.plan import SLACK, ManoeuvrePlan, room_of, seen_from
from werrimbi_odom.errors import InputError
from werrimbi_odom.model.pose import Pose, compose
from werrimbi_odom.model.slip import Turns

State = Literal["waiting", "driving", "done", "stopped"]

MIN_PERIOD = 0.012
"""Shortest time between two commands [s]; faster odometry is checked, but not answered."""
PAUSE, SHORT_PAUSE = 0.2, 0.1
"""Longest step of the odometry [s] by which the plan advances: after a longer pause it has waited,
as a base does without commands. The second is the longest step for the limits on acceleration."""
OLDEST = 0.5
"""Largest difference between odometry stamps and the node's clock at the start of a drive [s]."""
AT_REST, AT_REST_TURN = 0.02, 0.05
"""Largest mean speeds that count as rest [m/s, rad/s], over the last AT_REST_FOR seconds."""
AT_REST_FOR = 0.3
LATER = 60.0
"""Time limit of a drive beyond 1.5 times its planned duration [s]."""


class Driver:
    """Drives a robot through a plan, within an area in the frame of the first start pose."""

    def __init__(self, plan: ManoeuvrePlan, limits: Limits, area: Area, watch: Watch) -> None:
        self.plan, self.limits, self.area, self.watch = plan, limits, area, watch
        self.state: State = "waiting"
        self.words = "waiting to be asked to start"
        self.command = STILL
        """The last command."""
        self.last: OdometryReading | None = None
        self._heard = self._scanned = self._turned = -math.inf
        self._nearest = math.inf
        self._anchor: Pose | None = None
        self._origin = Pose(0.0, 0.0, 0.0)
        self._tracker = PathFollower(plan, limits)
        self._slip = Turns(SLIP_WINDOW)
        self._since: deque[OdometryReading] = deque()  # twice AT_REST_FOR
        self._commanded = 0.0
        self._least_age = math.inf
        self._ends_by = math.inf

    # ------------------------------------------------------------------------- requests

    def refusal(self, now: float) -> str:
        """Why a drive cannot begin; "" if it can."""
        last, watch = self.last, self.watch
        if self.state == "driving":
            return "it is driving already"
        if last is None or now - self._heard > watch.odom_timeout:
            return "no odometry comes"
        if abs(last.age) > OLDEST:
            return (
                f"the odometry's stamps are {last.age:.2f} s old by this computer's clock: it is "
                "delayed, or clocks are apart (use_sim_time?)"
            )
        if not self._at_rest():
            return "the robot moves, or has not been heard to stand for long enough"
        wrong = self._of_surroundings(now)
        if wrong:
            return wrong
        if watch.slip > 0.0 and self._slip.span is None:
            return (
                "the gyro's stamps and the odometry's are of different times: it could not tell "
                "slip; clocks are apart (use_sim_time?)"
            )
        path = self.plan.path()
        room = room_of(path, self.area, seen_from(self._anchor or last.pose, last.pose))
        if room < SLACK:
            far = max(math.hypot(point.x, point.y) for point in path)
            return (
                f"the path leads {SLACK - room:.2f} m too near to the border of the area or beyond "
                f"(it goes {far:.2f} m from where it begins; the robot's radius and {SLACK:g} m "
                "are kept free): give more area, or a smaller manoeuvre"
            )
        return ""

    def start(self, now: float, busy: float = 0.0) -> None:
        """Start the drive; InputError with the reason if it cannot start.

        For `busy` [s] before `now` no messages were processed, as at the start of a recording. That
        counts neither as silence nor as delay, because these messages are still to come.
        """
        wrong = self.refusal(now - busy)
        if wrong:
            raise InputError(wrong)
        assert self.last is not None
        self._heard += busy
        self._scanned += busy
        self._turned += busy
        self._origin = self.last.pose
        self._anchor = self._anchor or self._origin
        self._tracker = PathFollower(self.plan, self.limits)
        self._commanded, self._least_age = self.last.stamp, self.last.age + busy
        planned = self.plan.duration(self.limits)
        self._ends_by = self.last.stamp + 1.5 * planned + LATER
        self.state, self.words = "driving", f"driving {self.plan.name}"

    def stop(self, why: str) -> None:
        """Stop at once; no effect on a robot that is not driven."""
        if self.state == "driving":
            self.state, self.words = "stopped", why
        self.command = STILL

    # ------------------------------------------------------------------------- messages

    def odometry(self, reading: OdometryReading, now: float) -> Command | None:
        """Process an odometry message; return the command to send, if one is due."""
        before, self.last = self.last, reading
        self._heard = now
        self._slip.wheels(reading.stamp, reading.pose.yaw)
        wrong = fault_between(before, reading, self.limits) if before else ""
        if wrong:  # also, the place of the area is unknown now
            self._since.clear()
            self._anchor = None
        self._since.append(reading)
        while reading.stamp - self._since[0].stamp > 2.0 * AT_REST_FOR:
            self._since.popleft()
        if self.state != "driving":
            return None
        self._least_age = min(self._least_age, reading.age)
        wrong = wrong or self._of_reading(reading) or self._of_surroundings(now)
        if wrong:
            return self._stopped(wrong)
        duration = reading.stamp - self._commanded
        if duration < MIN_PERIOD:
            return None
        self._commanded = reading.stamp
        pose = seen_from(self._origin, reading.pose)
        wanted = self._tracker.follow(pose, min(duration, PAUSE))
        if self._tracker.done:
            self.state, self.words = "done", f"{self.plan.name} is driven"
            self.command = STILL
            return STILL
        wrong = self._of_following()
        if wrong:
            return self._stopped(wrong)
        self.command = self.limits.kept(wanted, self.command, min(duration, SHORT_PAUSE))
        return self.command

    def scan(self, nearest: float, now: float) -> Command | None:
        """Process the nearest distance of a scan [m]; return a command if it stops the robot."""
        self._scanned, self._nearest = now, nearest
        return self.tick(now)

    def gyro(self, stamp: float, rate: float, now: float) -> Command | None:
        """Process a yaw rate of the gyro [rad/s]; return a command if it stops the robot."""
        self._turned = now
        self._slip.gyro(stamp, rate)
        return self.tick(now)

    def tick(self, now: float) -> Command | None:
        """Check for timeouts; return a command if one stops the robot."""
        if self.state != "driving":
            return None
        wrong = self._of_surroundings(now)
        if now - self._heard > self.watch.odom_timeout:
            wrong = f"the odometry is silent for {now - self._heard:.2f} s"
        return self._stopped(wrong) if wrong else None

    # ------------------------------------------------------------------------- checks

    def _stopped(self, why: str) -> Command:
        self.stop(why)
        return STILL

    def _of_reading(self, reading: OdometryReading) -> str:
        late = reading.age - self._least_age
        if late > self.watch.odom_timeout:
            return f"the odometry comes {late:.2f} s later than before"
        assert self._anchor is not None
        if reading.stamp > self._ends_by:
            return "the manoeuvre takes far longer than planned"
        here = seen_from(self._anchor, reading.pose)
        if self.area.room(here.x, here.y) < 0.0:
            return f"it left the area ({here.x:.2f}, {here.y:.2f} m from the start)"
        return ""

    def _of_surroundings(self, now: float) -> str:
        watch = self.watch
        if watch.scan_min_distance > 0.0:
            if now - self._scanned > watch.scan_timeout:
                return "no scan comes"
            if self._nearest < watch.scan_min_distance:
                return f"the scan sees something at {self._nearest:.2f} m"
        if watch.slip > 0.0:
            if now - self._turned > watch.odom_timeout:
                return "no gyro comes"
            apart = self._slip.difference()
            if abs(apart) > watch.slip:
                return f"the wheels slip: they and the gyro differ by {math.degrees(apart):.1f} deg"
        return ""

    def _of_following(self) -> str:
        tracker, watch = self._tracker, self.watch
        if tracker.deviation > watch.deviation or abs(tracker.turned_off) > watch.turned_off:
            return (
                f"the robot does not follow: {tracker.deviation:.2f} m and "
                f"{math.degrees(tracker.turned_off):.0f} deg from where it should be"
            )
        return ""

    def _at_rest(self) -> bool:
        """Whether odometry came for the last AT_REST_FOR seconds at least, without motion."""
        first, last = self._since[0], self._since[-1]
        duration = last.stamp - first.stamp
        if duration < AT_REST_FOR:
            return False
        moved = seen_from(first.pose, last.pose)
        return (
            math.hypot(moved.x, moved.y) < AT_REST * duration
            and abs(moved.yaw) < AT_REST_TURN * duration
        )

    # ------------------------------------------------------------------------- output

    def shown(self) -> list[Pose]:
        """The planned path in the odometry frame, from the start or the present pose."""
        start = self._origin
        if self.state != "driving" and self.last is not None:
            start = self.last.pose
        return [compose(start, point) for point in self.plan.path()]

    @property
    def progress(self) -> str:
        """Number of finished moves, in words; a rest is none."""
        moving = [bool(move.length or move.turn) for move in self.plan.moves]
        return f"{sum(moving[: self._tracker.index])} of {sum(moving)} moves"
