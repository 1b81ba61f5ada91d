# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The real nodes of test/ros/conftest.py, as fixtures here too."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest


@pytest.fixture
def launch(tmp_path: Path) -> Iterator[Any]:
    """Start nodes, each with a client."""
    from test.ros.conftest import launcher

    yield from launcher(tmp_path)


@pytest.fixture(scope="module")
def node(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    """One node, shared by the tests of a file, that has begun."""
    from test.ros.conftest import launcher

    for launch_one in launcher(tmp_path_factory.mktemp("node")):
        yield launch_one().begin()
