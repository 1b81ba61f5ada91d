# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The files of a draft's package, as texts: an effect file, pyproject.toml, README.md."""

from __future__ import annotations

from werrimbi_odom.inference.drafting.draft import Draft


def package_of(draft: Draft) -> dict[str, str]:
    """Text of each file, by its name."""
    return {
        f"{draft.name}.py": draft.source,
        "pyproject.toml": _project(draft.name),
        "README.md": _readme(draft),
    }


def _project(name: str) -> str:
    return f"""[build-system]
requires = ["setuptools>=61"]
build-backend = "setuptools.build_meta"

[project]
name = "{name.replace("_", "-")}"
version = "0.1.0"
description = "A physical effect of my robot, drafted by werrimbi"
dependencies = ["werrimbi_odom"]

[project.entry-points."werrimbi_odom.effects"]
{name} = "{name}:{name}"

[tool.setuptools]
py-modules = ["{name}"]
"""


def _readme(draft: Draft) -> str:
    claim, two = draft.claim, draft.of_two
    names = claim.variable if two is None else "` and `".join(two.variables)
    law = f": `{draft.law}`" if draft.law else ""
    node = (
        f"; the node refuses it: it has counters alone, no {' and no '.join(draft.effect.channels)}"
        if draft.effect.channels
        else ", and the node runs it"
    )
    return f"""# {draft.name}

A draft of `werrimbi draft`. In the drives that it was made from, the {claim.channel} error goes
with `{names}`, and a {draft.form} describes it{law}.
That is what the data show; why it is so they cannot know.

1. Read `{draft.name}.py`: it is short. Its docstring says the law.
2. Try it before it is installed: werrimbi's commands for drives take `--effects {draft.name}.py`.
3. Find the physics, measure it with a ruler, and give the effect its name and its law: the name
   stands in the file, in `pyproject.toml` and in your robot file.
4. `pip install .` here; then robot files may name it{node}.

`werrimbi_odom.effects.contract.check_effect` tests it for the properties that effects must have.
"""
