# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Estimates per-run phases (of an eccentric wheel) live from a measured heading.

The estimator is `werrimbi_odom.model.phases`; this module subscribes, and decides when to report.
"""

from __future__ import annotations

import math
from typing import Any

from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Imu

from werrimbi_odom.errors import InputError
from werrimbi_odom.model.effect import AppliedEffect
from werrimbi_odom.model.phase_learner import PhaseLearner
from werrimbi_odom.model.phases import KNOWN_WELL_ENOUGH, Phase, learnable
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.ros import counter_inputs, planar
from werrimbi_odom.ros.input_health import NOT_LEARNT
from werrimbi_odom.ros.live_odometer import LiveOdometer
from werrimbi_odom.ros.topics import stamp_of, subscribe
from werrimbi_odom.ros.upright_gyro import UprightGyro

FINE = 0.03
"""Standard deviation of a phase [rad] below which further updates gain nothing."""


class NoLearning:
    """No phase to estimate, or no topic to estimate it from."""

    topic = ""

    def after(self, tracker: LiveOdometer) -> None:
        """Process the last reading of the odometer."""

    def retune(self, robot: Robot, changed: tuple[str, ...]) -> None:
        """Change the parameter values of the robot."""

    def news(self) -> dict[str, float]:
        """Parameters that are newly known, or much better than last reported."""
        return {}

    def phase(self, effect: str) -> Phase | None:
        """Current estimate of an effect's phase; None if it is not estimated."""
        return None

    def wrong(self) -> list[str]:
        """What /diagnostics warns of."""
        return []


class Learning(NoLearning):
    """Estimates phases of a robot's effects from a topic.

    `topic` and `kind` are the parameters `learn_from_topic` and `learn_from_type`.
    """

    def __init__(
        self, wiring: counter_inputs.InputOptions, robot: Robot, topic: str, kind: str
    ) -> None:
        self.topic = topic
        self._learner = PhaseLearner(robot)
        self._heard = False
        self._tracker: LiveOdometer | None = None
        self._clock = wiring.node.get_clock()
        self._logger = wiring.node.get_logger()
        self._health = wiring.health
        self._gyro = UprightGyro(topic, self._logger)
        self._told: dict[str, float] = {}
        """Standard deviation when a phase was last reported, by effect [rad]."""
        self._settled: set[str] = set()
        """Effects whose phase is precise enough, or set by someone else."""
        self._telling: set[str] = set()
        """Parameters that are about to be set by the node itself."""
        message_type, see = {
            "imu": (Imu, self._see_imu),
            "pose_stamped": (PoseStamped, lambda m: self._see_yaw(m, m.pose.orientation)),
            "odometry": (Odometry, lambda m: self._see_yaw(m, m.pose.pose.orientation)),
        }[kind]
        subscribe(wiring.node, message_type, topic, see, overridable=True)

    def after(self, tracker: LiveOdometer) -> None:
        """Process the last reading of the odometer."""
        self._tracker = tracker
        step = tracker.odometer.driven_step
        if step is not None and not self._done:
            self._learner.step(tracker.seconds(tracker.stamp), step)

    def retune(self, robot: Robot, changed: tuple[str, ...]) -> None:
        """Change the parameter values of the robot; a phase set by someone else is final."""
        self._learner.retune(robot)
        for phase in self._learner.phases():
            if _key(phase) in changed and _key(phase) not in self._telling:
                self._settled.add(phase.effect)
        self._telling -= set(changed)

    @property
    def _done(self) -> bool:
        return len(self._settled) == len(self._learner.effects)

    def news(self) -> dict[str, float]:
        """Parameters that are newly known, or twice as precisely as last reported."""
        if self._done:
            return {}
        found = {}
        for phase in self._learner.phases():
            last = self._told.get(phase.effect, 2.0 * KNOWN_WELL_ENOUGH)
            if phase.effect in self._settled or phase.std > 0.5 * last:
                continue
            self._told[phase.effect] = phase.std
            if phase.std < FINE:
                self._settled.add(phase.effect)
            found[_key(phase)] = phase.value
            self._logger.info(
                f"learnt from {self.topic}: {_key(phase)} is {phase.value:.2f} rad, give or take "
                f"{phase.std:.2f}"
            )
        self._telling = set(found)
        return found

    def phase(self, effect: str) -> Phase | None:
        """Current estimate of an effect's phase; None if it is not estimated."""
        found = (phase for phase in self._learner.phases() if phase.effect == effect)
        return next(found, None)

    def wrong(self) -> list[str]:
        """The topic was not heard although the wheels were."""
        if self._heard or self._done or self._tracker is None:
            return []
        return [f"nothing heard on {self.topic} (learn_from_topic): no phase is learnt"]

    def _see_imu(self, message: Any) -> None:
        self._heard = True
        try:
            rate = self._gyro.rate(message)
        except InputError as error:
            cause, detail = error.args
            self._health.refuse(cause, detail, NOT_LEARNT)
            return
        if not self._done:
            self._learner.see_rate(self._time_of(message), rate)

    def _see_yaw(self, message: Any, orientation: Any) -> None:
        self._heard = True
        if not self._done:
            try:
                yaw = planar.yaw_of(orientation, slack=1.0)
            except InputError as error:
                cause, detail = error.args
                self._health.refuse(cause, detail, NOT_LEARNT)
                return
            self._learner.see_yaw(self._time_of(message), yaw)

    def _time_of(self, message: Any) -> float:
        if self._tracker is None:
            return math.nan
        return self._tracker.seconds(stamp_of(message, self._clock))


def learning_of(wiring: counter_inputs.InputOptions, robot: Robot) -> NoLearning:
    """Create what the robot file requests, if any phase is unknown."""
    topic, log = str(wiring.values["learn_from_topic"]), wiring.node.get_logger()
    learnt = [applied.name for applied in learnable(robot)]
    others = {
        applied.name: ", ".join(applied.unknown)
        for applied in robot.effects
        if applied.unknown and applied.name not in learnt and applied.effect.stage != "reference"
    }
    for name, numbers in others.items():
        log.warning(f"{name}: not applied while its {numbers} is unknown; set it in the robot file")
    if topic and learnt:
        return Learning(wiring, robot, topic, str(wiring.values["learn_from_type"]))
    if topic:
        log.info(f"nothing to learn from {topic}: no effect has an unknown phase")
    elif learnt:
        log.warning(
            f"{', '.join(learnt)}: not applied while the phase is unknown; set it, or give "
            "learn_from_topic a measured heading to learn it from"
        )
    return NoLearning()


def status_of_effects(effects: tuple[AppliedEffect, ...], learning: NoLearning) -> dict[str, str]:
    """Description of each effect and its values."""
    return {f"effect {applied.name}": _words(applied, learning) for applied in effects}


def _words(applied: AppliedEffect, learning: NoLearning) -> str:
    effect, phase = applied.effect, learning.phase(applied.name)
    numbers = [
        f"{name} {applied.values[name]:.6g} {item.unit}".rstrip()
        for name, item in effect.parameters.items()
        if name not in applied.unknown
    ]
    words = [", ".join(numbers) or "on"]
    if applied.unknown:
        words.append(f"not applied: {' and '.join(applied.unknown)} unknown")
        if phase is not None:
            so_far = f"{phase.std:.2f} rad" if math.isfinite(phase.std) else "nothing"
            words.append(f"learning from {learning.topic}, so far to {so_far}")
    elif phase is not None:
        words.append(f"phase learnt from {learning.topic}, to {phase.std:.2f} rad")
    if effect.stage == "reference":
        words.append("of the measurement, so odometry does without it")
    return "; ".join(words)


def _key(phase: Phase) -> str:
    return f"{phase.effect}.{phase.parameter}"
