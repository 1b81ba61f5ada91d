# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The site of these pages: `make docs`, or rosdoc2, which finds this file by rosdoc2.yaml."""

from __future__ import annotations

import sys
from pathlib import Path
from xml.etree import ElementTree

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

project = "werrimbi_odom"
author = "The werrimbi_odom authors"
copyright = "2026, The werrimbi_odom authors"
# rosdoc2 builds from a copy of docs/ alone, and knows the version itself.
if (ROOT / "package.xml").exists():
    release = ElementTree.parse(ROOT / "package.xml").findtext("version", "")

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx.ext.viewcode"]
html_theme = "sphinx_rtd_theme"
html_static_path = ["_static"]
html_css_files = ["site.css"]

# Links to a heading, page.md#the-heading, as on GitHub.
myst_heading_anchors = 4

napoleon_google_docstring = False
napoleon_use_rtype = False
autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_default_options = {"members": True, "show-inheritance": False}
