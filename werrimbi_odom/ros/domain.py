# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""ROS domains that nobody else on this machine hears, for demos and tests."""

from __future__ import annotations

import fcntl
import tempfile
from pathlib import Path
from typing import TextIO

from werrimbi_odom.errors import InputError

DOMAINS = range(1, 102)
"""All that every operating system has ports for, but 0, in which everybody is."""


def free_domain() -> tuple[int, TextIO]:
    """A ROS domain that no other demo or test on this machine uses while the file stays open.

    Raises
    ------
    InputError
        When all are in use.
    """
    for domain in DOMAINS:
        path = Path(tempfile.gettempdir()) / f"werrimbi_odom_ros_domain_{domain}"
        try:
            lock = path.open("a", encoding="ascii")
        except OSError:  # another user's
            continue
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            lock.close()
        else:
            return domain, lock
    raise InputError("all ROS domains are in use on this machine by demos and tests")
