# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Exclusive ROS domains for demos and tests on this machine."""

from __future__ import annotations

import fcntl
import tempfile
from pathlib import Path
from typing import TextIO

from werrimbi_odom.errors import InputError

DOMAINS = range(1, 102)
"""Domains with ports on every operating system, except the default 0."""


def free_domain() -> tuple[int, TextIO]:
    """Reserve a ROS domain for as long as the returned file stays open.

    InputError if all are in use.
    """
    for domain in DOMAINS:
        path = Path(tempfile.gettempdir()) / f"werrimbi_odom_ros_domain_{domain}"
        try:
            lock = path.open("a", encoding="ascii")
        except OSError:  # owned by another user
            continue
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            lock.close()
        else:
            return domain, lock
    raise InputError("all ROS domains are in use on this machine by demos and tests")
