# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Runs a node from start to end: signals and exit codes."""

from __future__ import annotations

import signal
import sys
from collections.abc import Callable
from typing import TypeVar

import rclpy
from rclpy.exceptions import ParameterException
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions, install_signal_handlers
from rclpy.utilities import remove_ros_args

from werrimbi_odom.errors import InputError

Made = TypeVar("Made", bound=Node)


def run(
    make_node: Callable[[], Made],
    name: str,
    args: list[str] | None = None,
    *,
    farewell: Callable[[Made], None] | None = None,
) -> int:
    """Run a node until it is stopped; return the exit code.

    That is 0 after SIGINT and SIGTERM, 2 after invalid input, for which `make_node` raises
    InputError. `name` is the prefix of messages before the node exists. `farewell` is called before
    the node ends, for any reason, while it can still publish.
    """
    told = _Told()
    try:
        others = remove_ros_args(args)[1 if args is None else 0 :]
        if others:
            return _not_of_ros(name, others[0])
        rclpy.init(args=args, signal_handler_options=SignalHandlerOptions.NO)
    except RuntimeError as error:
        print(f"{name}:", " ".join(str(error).split()), file=sys.stderr)  # in one line
        return 2
    node = None
    try:
        node = make_node()
        executor = SingleThreadedExecutor()
        if farewell is not None:
            return _spin_until_told(node, executor, told, farewell)
        # Not earlier: rclpy's handlers shut the context down, and rclpy cannot create anything in
        # such a context.
        install_signal_handlers(SignalHandlerOptions.ALL)
        if not told.to_end:
            rclpy.spin(node, executor)
    except ExternalShutdownException:
        pass
    except (InputError, ParameterException) as error:
        rclpy.logging.get_logger(name).fatal(str(error))
        return 2
    except Exception:
        # A signal shuts the context down during a callback, which then raises an error of some
        # rclpy call. This is not a fault.
        if rclpy.ok():
            raise
    finally:
        told.ignore()
        if node is not None:
            node.destroy_node()
        rclpy.try_shutdown()  # restores the signal handlers that preceded rclpy's
        told.ignore()
    return 0


def _spin_until_told(
    node: Made, executor: SingleThreadedExecutor, told: _Told, farewell: Callable[[Made], None]
) -> int:
    """Spin with own signal handlers: those of rclpy would end the context before the farewell."""
    executor.add_node(node)
    try:
        while not told.to_end:
            executor.spin_once(timeout_sec=0.02)
    finally:
        farewell(node)
        executor.shutdown()
    return 0


def _not_of_ros(name: str, word: str) -> int:
    """Report an argument that rclpy would ignore; return the exit code."""
    usage = f"{name} --ros-args [--params-file FILE.yaml] [-p NAME:=VALUE] [-r FROM:=TO]"
    if word in ("-h", "--help"):
        print(f"{usage}\n\nTopics and parameters: docs/node.md and docs/robot.md of werrimbi_odom.")
        return 0
    print(f"{name}: {word} is unknown, or must come after --ros-args: {usage}", file=sys.stderr)
    return 2


class _Told:
    """Records that SIGINT or SIGTERM arrived, without interrupting.

    It raises no exception: Python discards one that is raised in the callback of a weak reference,
    as happens during imports, and the signal would be lost. Starting takes a fraction of a second,
    so the delay is short. While the node spins, rclpy's own handlers end it.
    """

    def __init__(self) -> None:
        self.to_end = False
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, self._take)

    def ignore(self) -> None:
        """Ignore all further signals, also during Python's own shutdown.

        Ctrl-C in a terminal reaches a node twice, once through `ros2 run` or a launch file. The
        second signal must not interrupt the clean-up.
        """
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, signal.SIG_IGN)

    def _take(self, *_: object) -> None:
        self.to_end = True
