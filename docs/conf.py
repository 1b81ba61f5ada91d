# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The site of these pages: `make docs`, or rosdoc2, which finds this file by rosdoc2.yaml."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from xml.etree import ElementTree


def package_root() -> Path:
    """Above this file; rosdoc2 runs a copy that lies elsewhere, but its command names the package.

    Without it the Python reference would come out empty, and only a warning would tell.
    """
    begun_in = Path(os.environ.get("PWD", ""))  # Sphinx has gone to the copy's folder by now
    named = [begun_in / word.rpartition("=")[2] for word in sys.argv[1:]]
    for place in (*Path(__file__).resolve().parents, *named):
        if (place / "package.xml").exists() and (place / "werrimbi_odom").is_dir():
            return place.resolve()
    raise FileNotFoundError("werrimbi_odom is not found; run rosdoc2 build --package-path FOLDER")


ROOT = package_root()
sys.path.insert(0, str(ROOT))

project = "werrimbi_odom"
author = "The werrimbi_odom authors"
copyright = "2026, The werrimbi_odom authors"
release = ElementTree.parse(ROOT / "package.xml").findtext("version", "")

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx.ext.viewcode"]
html_theme = "sphinx_rtd_theme"
html_static_path = ["_static"]
html_css_files = ["site.css"]

# What rosdoc2 has sphinx-apidoc write: a page for every module, beside the reference of api.md.
exclude_patterns = ["werrimbi_odom*.rst", "modules.rst"]

# Links to a heading, page.md#the-heading, as on GitHub.
myst_heading_anchors = 4

napoleon_google_docstring = False
napoleon_use_rtype = False
autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_default_options = {"members": True, "show-inheritance": False}
