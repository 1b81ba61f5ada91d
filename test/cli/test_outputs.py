# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What a verb writes: never over what it reads, and known to be writable before the work."""

from __future__ import annotations

import os
from importlib import util
from pathlib import Path
from typing import NamedTuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from test.cli.commands import RECORDING
from test.command_line import Werrimbi
from werrimbi_odom.cli.main import main

EFFECT = '''
from werrimbi_odom.model.effect import Parameter, wheel_effect

@wheel_effect(size=Parameter("", 0.0, 0.1, (-1.0, 1.0), "how much"))
def of_my_own(travel, drive, size):
    """Nothing at all."""
    return travel
'''
SQUARES = "sense,x_m,y_m\ncw,0.1,0.1\ncw,0.11,0.1\nccw,-0.1,0.1\nccw,-0.11,0.1\n"
FIND = util.find_spec
ENDS = "ex_m,ey_m,eyaw_rad\n" + "".join(f"0.00{n},0.01,0.01\n" for n in range(1, 9))


class Place(NamedTuple):
    folder: Path
    inputs: tuple[Path, ...]

    def bytes(self) -> list[bytes]:
        return [path.read_bytes() for path in self.inputs]


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Place:
    """One of everything that a verb reads, links to each, and a fleet of one."""
    folder = tmp_path_factory.mktemp("place")
    names = ["robot.yaml", "run/ticks.csv", "run/reference.csv", "held/ticks.csv"]
    names += ["held/reference.csv", "fleet/one/robot.yaml", "fleet/one/train/a/ticks.csv"]
    names += ["fleet/one/train/a/reference.csv"]
    for name in names:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes((RECORDING / Path(name).name).read_bytes())
    texts = {"effect.py": EFFECT, "squares.csv": SQUARES, "ends.csv": ENDS}
    for name, text in texts.items():
        (folder / name).write_text(text)
    (folder / "bag").mkdir()
    inputs = tuple(folder / name for name in (*names, *texts))
    for path in inputs:
        (folder / f"link_to_{'_'.join(path.relative_to(folder).parts)}").symlink_to(path)
    (folder / "folder_link").symlink_to(folder / "run")
    return Place(folder, inputs)


READS = {
    "odom": ("robot.yaml", "run/ticks.csv", "run/reference.csv", "effect.py"),
    "fleet": ("fleet/one/robot.yaml", "fleet/one/train/a/ticks.csv", "effect.py"),
    "explain": ("effect.py",),
    "umbmark": ("robot.yaml", "squares.csv"),
    "umbmark runs": ("robot.yaml", "run/ticks.csv", "held/reference.csv"),
    "noise": ("robot.yaml", "ends.csv"),
}
"""Files that each verb reads; of the others the eight of `RECORDED`."""
RECORDED = ("robot.yaml", "run/ticks.csv", "run/reference.csv", "held/ticks.csv", "effect.py")
DRIVES = "--robot {0}/robot.yaml {0}/run --holdout {0}/held --effects {0}/effect.py"
VERBS = {
    "odom": "odom --robot {0}/robot.yaml {0}/run --effects {0}/effect.py",
    "compare": "compare --robot {0}/robot.yaml {0}/run {0}/held --effects {0}/effect.py",
    "diagnose": f"diagnose {DRIVES}",
    "fleet": "diagnose --fleet {0}/fleet --effects {0}/effect.py",
    "add": f"add track_width {DRIVES}",
    "draft": f"draft {DRIVES}",
    "workbench": f"workbench {DRIVES}",
    "umbmark": "calibrate umbmark {0}/squares.csv --side 4 --robot {0}/robot.yaml",
    "umbmark runs": "calibrate umbmark {0}/run --after {0}/held --side 4 --robot {0}/robot.yaml",
    "noise": "calibrate noise {0}/ends.csv --distance 10 --robot {0}/robot.yaml",
    "fit": f"calibrate fit {DRIVES}",
    "explain": "explain --effects {0}/effect.py",
}
OUTPUTS = {
    "compare": ("json",),  # and a report, which has an ending of its own
    "diagnose": ("json",),
    "fleet": ("json",),
    "explain": ("json",),
}
NEEDS_OUT = ("odom", "add", "draft", "umbmark", "umbmark runs", "noise", "fit")
HAS_FORCE = ("add", "draft", "workbench", "umbmark", "umbmark runs", "noise", "fit")


def spelt(folder: Path, name: str, how: str) -> Path:
    """Another path to the same file."""
    if how == "link":
        return folder / f"link_to_{name.replace('/', '_')}"
    if how == "dots":
        return folder / "bag" / ".." / name
    if how == "through a folder" and name.startswith("run/"):
        return folder / "folder_link" / Path(name).name
    if how == "relative":
        return Path(os.path.relpath(folder / name))
    return folder / name


@given(data=st.data())
def test_no_verb_writes_over_what_it_reads(place: Place, data: st.DataObject) -> None:
    verb = data.draw(st.sampled_from(sorted(VERBS)))
    words = VERBS[verb].format(place.folder).split()
    option = data.draw(st.sampled_from(OUTPUTS.get(verb, ("out", "json"))))
    name = data.draw(st.sampled_from(READS.get(verb, RECORDED)))
    how = data.draw(st.sampled_from(["plain", "link", "dots", "through a folder", "relative"]))
    target = spelt(place.folder, name, how)
    if verb == "draft" and option == "out":
        target = target.parent
    words += [f"--{option}", str(target)]
    if option != "out" and verb in NEEDS_OUT:
        words += ["--out", str(place.folder / "new")]
    if verb in HAS_FORCE and data.draw(st.booleans()):
        words += ["--force"]
    before = place.bytes(), sorted(os.listdir(place.folder))
    assert main(words) == 2, words
    assert (place.bytes(), sorted(os.listdir(place.folder))) == before


@pytest.mark.parametrize("verb", [verb for verb in VERBS if verb not in OUTPUTS])
def test_two_outputs_are_never_one_file(place: Place, verb: str, werrimbi: Werrimbi) -> None:
    one = place.folder / "both.html"
    other = place.folder / "run" / ".." / "both.html"
    words = [*VERBS[verb].format(place.folder).split(), "--out", str(one), "--json", str(other)]
    assert "--out" in werrimbi(*words, code=2).err
    assert not one.exists()


@pytest.mark.parametrize("option", ["out", "json", "report"])
@pytest.mark.parametrize("verb", VERBS)
def test_what_cannot_be_written_is_said_before_the_work(
    place: Place, verb: str, option: str, werrimbi: Werrimbi
) -> None:
    """/sys takes no files, not even from root; the runs are not there to be worked on."""
    if option == "out" and verb in OUTPUTS:
        pytest.skip("writes no robot file")
    if option == "report" and verb in ("odom", "workbench", "explain"):
        pytest.skip("makes no report")
    words = VERBS[verb].format(place.folder).replace("/run", "/bag").split()
    words += [f"--{option}", "/sys/new.html"]
    if option != "out" and verb in NEEDS_OUT:
        words += ["--out", str(place.folder / "new")]
    said = werrimbi(*words, code=2)
    assert said.err.count("\n") == 1
    assert "/sys/new.html cannot be written" in said.err
    assert said.out == ""


def test_a_folder_or_a_place_in_none_is_no_file(place: Place, werrimbi: Werrimbi) -> None:
    words = VERBS["add"].format(place.folder).split()
    for out, said in (("run", "is a folder"), ("no/where", "there is no folder")):
        for option in ("out", "json"):
            given = [*words, f"--{option}", str(place.folder / out)]
            given += [] if option == "out" else ["--out", str(place.folder / "new")]
            assert said in werrimbi(*given, code=2).err


@pytest.mark.parametrize("verb", ["compare", "diagnose", "add", "fleet", "noise"])
def test_a_report_without_plotly_is_refused_before_the_work(
    place: Place, verb: str, monkeypatch: pytest.MonkeyPatch, werrimbi: Werrimbi
) -> None:
    words = [*VERBS[verb].format(place.folder).split(), "--report", str(place.folder / "r.html")]
    if verb in NEEDS_OUT:
        words += ["--out", str(place.folder / "new")]
    monkeypatch.setattr(util, "find_spec", lambda name: FIND(name) if name != "plotly" else None)
    said = werrimbi(*words, code=2)
    assert said.out == ""
    assert "pip install 'werrimbi_odom[tools]'" in said.err
    assert sorted(place.folder.glob("r.html")) == []


def test_pictures_get_names_of_their_own_and_none_of_what_is_read(
    place: Place, werrimbi: Werrimbi
) -> None:
    """A report as pictures is a file for each figure: r.png, r-legs.png and so on."""
    mine = place.folder / "r-legs.png"
    mine.write_text(EFFECT)
    words = [*VERBS["compare"].format(place.folder).split(), "--effects", str(mine)]
    err = werrimbi(*words, "--report", place.folder / "r.png", code=2).err
    mine.unlink()
    assert "r-legs.png, which is read" in err or "chromium" in err
