# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Our launch files as the command lines that `ros2 launch` makes of them.

`launch` has no wheel. Our files are XML with nothing in them but <arg>, <include>, <node>, <param>
and <remap>, and the substitutions $(var ...) and $(find-pkg-share werrimbi_odom); this reads that
much of the format and refuses everything else, so that the files stay that plain.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

_ATTRIBUTES = {
    "arg": {"name", "default", "description", "value"},
    "include": {"file"},
    "node": {"pkg", "exec", "name", "namespace", "output", "args"},
    "param": {"name", "value", "from"},
    "remap": {"from", "to"},
}


@dataclass(frozen=True)
class Process:
    """One node to be started."""

    package: str
    executable: str
    arguments: tuple[str, ...]


def launched(share: Path, name: str, **given: str) -> list[Process]:
    """The nodes that `ros2 launch werrimbi_odom NAME key:=value ...` starts, out of `share`."""
    tree = ElementTree.parse(share / "launch" / name).getroot()
    assert tree.tag == "launch"
    values: dict[str, str] = {}
    processes: list[Process] = []
    for entity in tree:
        _known(entity)
        if entity.tag == "arg":
            key = entity.attrib["name"]
            assert "description" in entity.attrib, f"{name}: {key} is not explained"
            if key in given:
                values[key] = given[key]
            else:
                assert "default" in entity.attrib, f"{name} asks for {key}"
                values[key] = _filled(entity.attrib["default"], values, share)
        elif entity.tag == "include":
            file = Path(_filled(entity.attrib["file"], values, share))
            handed = {
                each.attrib["name"]: _filled(each.attrib["value"], values, share) for each in entity
            }
            assert file.parent == share / "launch"
            processes += launched(share, file.name, **handed)
        else:
            processes.append(_node(entity, values, share))
    assert set(given) <= set(values), f"{name} has no {set(given) - set(values)}"
    return processes


def _node(entity: ElementTree.Element, values: dict[str, str], share: Path) -> Process:
    def of(element: ElementTree.Element, key: str) -> str:
        return _filled(element.attrib.get(key, ""), values, share)

    ros = ["-r", f"__node:={of(entity, 'name')}"]
    if of(entity, "namespace"):
        ros += ["-r", f"__ns:=/{of(entity, 'namespace').strip('/')}"]
    for element in entity:
        _known(element)
        if element.tag == "remap":
            ros += ["-r", f"{of(element, 'from')}:={of(element, 'to')}"]
        elif "from" in element.attrib:
            ros += ["--params-file", of(element, "from")]
        else:
            ros += ["-p", f"{of(element, 'name')}:={of(element, 'value')}"]
    own = of(entity, "args").split()
    return Process(of(entity, "pkg"), of(entity, "exec"), (*own, "--ros-args", *ros))


def _known(entity: ElementTree.Element) -> None:
    assert entity.tag in _ATTRIBUTES, entity.tag
    assert set(entity.attrib) <= _ATTRIBUTES[entity.tag], entity.attrib


def _filled(text: str, values: dict[str, str], share: Path) -> str:
    text = text.replace("$(find-pkg-share werrimbi_odom)", str(share))
    text = re.sub(r"\$\(var (\w+)\)", lambda found: values[found[1]], text)
    assert "$(" not in text, text
    return text
