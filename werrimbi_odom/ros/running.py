# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A node from its start to its end: signals and exit codes."""

from __future__ import annotations

import signal
import sys
from collections.abc import Callable

import rclpy
from rclpy.exceptions import ParameterException
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions, install_signal_handlers

from werrimbi_odom.errors import InputError


def run(make_node: Callable[[], Node], name: str, args: list[str] | None = None) -> int:
    """Run a node until it is told to stop.

    Parameters
    ----------
    make_node : callable
        Makes the node; raises InputError when what it was given cannot be used.
    name : str
        For what is said before there is a node.
    args : list of str, optional
        Arguments for ROS; those of the command line if left out.

    Returns
    -------
    int
        Exit code: 0 after SIGINT and SIGTERM, 2 when something that was given cannot be used.
    """
    interrupt = _Interrupt()
    try:
        rclpy.init(args=args, signal_handler_options=SignalHandlerOptions.NO)
    except KeyboardInterrupt:
        return 0
    except RuntimeError as error:
        print(f"{name}:", " ".join(str(error).split()), file=sys.stderr)  # in one line
        return 2
    node = None
    try:
        node = make_node()
        executor = SingleThreadedExecutor()
        # Not before: rclpy's handlers shut the context down, and rclpy cannot set up anything in
        # a context that is.
        install_signal_handlers(SignalHandlerOptions.ALL)
        rclpy.spin(node, executor)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    except (InputError, ParameterException) as error:
        rclpy.logging.get_logger(name).fatal(str(error))
        return 2
    except Exception:
        # A signal in the midst of a callback shuts the context down under it, or surfaces as an
        # error of whatever rclpy was doing. That is no fault.
        if rclpy.ok() and not interrupt.told:
            raise
    finally:
        interrupt.ignore()
        if node is not None:
            node.destroy_node()
        rclpy.try_shutdown()  # puts the handlers back that stood before rclpy's
        interrupt.ignore()
    return 0


class _Interrupt:
    """Makes the first SIGINT or SIGTERM a KeyboardInterrupt, and ignores what follows.

    Ctrl-C in a terminal reaches a node twice, once through `ros2 run` or a launch file; the second
    must not break the clearing up.
    """

    def __init__(self) -> None:
        self.told = False
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, self._take)

    def ignore(self) -> None:
        """Ignore everything from now on, also while Python itself clears up."""
        self.told = True
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, signal.SIG_IGN)

    def _take(self, *_: object) -> None:
        if not self.told:
            self.told = True
            raise KeyboardInterrupt
