# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Makes the pictures of the reports anew, in Chromium, from simulated drives: `make pictures`.

The drives hide an eccentric wheel; the whole of it takes some minutes.
"""

from __future__ import annotations

import os
import sys
import tempfile
from pathlib import Path

from werrimbi_odom.cli.main import main as werrimbi
from werrimbi_odom.report.save import find_browser

ROOT = Path(__file__).parents[1]
PICTURES = ROOT / "docs" / "pictures"
sys.path.insert(0, str(ROOT / "test" / "report"))

from browser import visit  # noqa: E402


def main() -> None:
    """Simulate, compare, diagnose and add with reports, and take their pictures."""
    browser = find_browser()
    if browser is None:
        sys.exit("no Chrome or Chromium found; e.g. apt install chromium")
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)  # so that the pages show short names
        data, pages = Path("drives"), Path()
        hide = "eccentric_left_wheel=0.0015"
        run("simulate", "--out", data, "--hide", hide, "--seed", "7")
        drives = sorted((data / "train").iterdir())
        held_out = ["--holdout", *sorted((data / "holdout").iterdir())]
        common = ["--robot", data / "robot.yaml", *drives]
        run("compare", *common, "--report", pages / "compare.html")
        run("diagnose", *common, *held_out, "--report", pages / "diagnose.html")
        new = ["--out", pages / "new.yaml"]
        run("add", "eccentric_left_wheel", *common, *held_out, *new,
            "--report", pages / "add.html")  # fmt: skip
        for name, dark in (("compare", False), ("diagnose", False), ("add", True)):
            picture = PICTURES / f"report_{name}.png"
            visit(pages / f"{name}.html", browser=browser, dark=dark, width=1100, picture=picture)
            print(picture)
        os.chdir(ROOT)


def run(*words: object) -> None:
    """A command of werrimbi; ends here when it fails."""
    sys.argv = ["werrimbi", *map(str, words)]
    if code := werrimbi(sys.argv[1:]):
        sys.exit(code)


if __name__ == "__main__":
    main()
