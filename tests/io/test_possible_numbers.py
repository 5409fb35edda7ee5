"""Every number of every description at -1, 0, NaN and infinity: refused at its key, or one that means something."""

from __future__ import annotations

import json
import math
import re
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from geocontact.analyses.prosthesis.foot_file import read_foot
from geocontact.analyses.shoulder.devices import device_named
from geocontact.data.errors import InputError
from geocontact.io.cases.case_settings import check_settings, parameters_of, read_settings
from geocontact.io.opensim.osim_multibody import read_multibody
from geocontact.io.recordings.device_numbers import read_device_numbers
from geocontact.io.recordings.spheres import read_spheres
from tests.io.test_osim import MODELS, written
from tests.io.test_wrong_kinds import DESCRIPTIONS, changed, outcome, places

TRIED = (-1.0, 0.0, math.nan, math.inf)
ANY, NONE = (-1.0, 0.0), (0.0,)
"""On either side of the origin; absent, or at the origin."""
MEANS: dict[str, dict[str, tuple[float, ...]]] = {
    "study": {r"trials \d walk|summary where .*": ANY, r"sweep threshold \d|surface at 0": NONE},
    "population": {r"\w (normal )?(value|mean|lower)|\w uniform lower": ANY, "correlation l_y": NONE},
    "gathering": {
        "noise force": NONE,  # with a warning: it is not known
        r"constants l|trial t01 level|from t01 (belt|threshold)": ANY,  # by the model, and by the table of areas
        "parameters k lower": ANY,
        "parameters k upper": (math.inf,),
    },
    "standing": {"straps damping": NONE, r"trials 0 (chair|start value|end)": ANY},
    "socket": {r"\w+_damping value": NONE},
    "foot": {
        r"keel (posterior|lowest|highest|sections \d to) value|settings soft value|sole below value": NONE,  # places
        r"keel retardation value|sole zones heel (damping|static|kinetic) value": NONE,
        r"bench (at|noise|travel) value|compressions 1 (fulcrum|sd) value": NONE,
        "bench tilt value": ANY,
    },
    "foot on foam": {
        r"keel (posterior|lowest|highest) value|foam below value|foam zones heel to value": NONE,
        r"foam zones heel (retardation|static|kinetic) value": NONE,
    },
    "pairs": {r"free 0 [fp][xyz] value": ANY},
    "gait": {r"trials \d other_plate": ANY},
    "overhead": {
        r"tasks T1 (tool value|push value|dominant_share)": NONE,
        r"tasks T1 push_direction \d|trials 0 upright \d": ANY,
    },
    "device": {"controller delay value": NONE},
    "exoskeleton": {"numbers module_mass value": NONE, "identified parameters .* value": ANY},
    "person": {},
    "case": {
        "noise force": NONE,
        r"constants l|trial t01 level": ANY,  # by the model: tests/systems/test_possible_numbers.py
        "parameters k lower": ANY,
        "parameters k upper": (math.inf,),
    },
    "layout": {r"first_id|(masked|dead) 0 \d|sensors mat 0 \d": NONE},
    "law": {r"zone heel k|(zone heel )?(b|mu_s|mu_k)|foot (height|pitch)(_sd)?": NONE},
    "weights": {r"(medial|lateral) \d": ANY},  # of a regression
}


def toml(value: Any) -> str:
    """A value as TOML writes it, infinite numbers too."""
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{json.dumps(key)} = {toml(each)}" for key, each in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml, value)) + "]"
    return repr(value) if isinstance(value, float) else json.dumps(value)


def case(path: Path) -> None:
    """case.toml with what it says held against itself."""
    settings = read_settings(path)
    check_settings(settings, path)
    parameters_of(settings, path)


READ: dict[str, Callable[[Path], Any]] = {"case": case, "device": lambda path: device_named(str(path))}
"""Readers that go further than those of the kinds: numbers of a device have ranges of their own."""


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with all files that the descriptions name."""
    folder = tmp_path_factory.mktemp("numbers")
    for name in ("a.csv", "a.stl", "a.osim", "a.particles", "P1_slow.csv", "P1_fast.csv", "P2_slow.csv", "P2_fast.csv"):
        (folder / name).touch()
    (folder / "people.csv").write_text("subject,mass [kg]\nP1,70\nP2,80\n", encoding="utf-8")
    (folder / "offsets.csv").write_text("x [mm]\n1\n2\n", encoding="utf-8")
    return folder


@pytest.mark.filterwarnings("ignore:.* is unusual for ")
@pytest.mark.filterwarnings("ignore:.*kinetic friction mu_k .* is larger than the static")
@pytest.mark.parametrize("what", DESCRIPTIONS)
def test_a_number_that_cannot_be_is_refused_at_its_key(home: Path, what: str) -> None:
    content, bad, idle = tomllib.loads(DESCRIPTIONS[what].text), [], dict(MEANS[what])
    for place, value in places(content):
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            continue
        key = " ".join(map(str, place))
        for new in TRIED:
            typed = int(new) if isinstance(value, int) and math.isfinite(new) else new
            file = home / f"{what.replace(' ', '_')}.toml"
            text = (f"{json.dumps(k)} = {toml(v)}\n" for k, v in changed(content, place, typed).items())
            file.write_text("".join(text), encoding="utf-8")
            said = outcome(READ.get(what, DESCRIPTIONS[what].read), file, place)
            found = [pattern for pattern, may in MEANS[what].items() if re.fullmatch(pattern, key) and new in may]
            if said != "refused":
                for pattern in found:
                    idle.pop(pattern, None)
            if said != "refused" and not (found and (said == "read" or said.startswith("elsewhere: "))):
                bad.append(f"{key} = {new} -> {said}")
    assert not bad, "\n".join(bad)
    assert not idle, f"never read: {idle}"


def test_a_place_of_a_foot_is_held_against_its_keel(home: Path) -> None:
    """What a place of 0 may be for one key it cannot be for another."""
    content = tomllib.loads(DESCRIPTIONS["foot on foam"].text)
    for key, value, unit in (("thickness", 7, "mm"), ("bending", 28, "N m^2")):
        content["keel"][key] = {"value": value, "unit": unit}
    for place in (("keel", "highest", "value"), ("foam", "below", "value"), ("foam", "zones", "heel", "to", "value")):
        file = home / "keel.toml"
        new = changed(content, place, 0)
        file.write_text("".join(f"{key} = {toml(value)}\n" for key, value in new.items()), encoding="utf-8")
        with pytest.raises(InputError, match=place[0]):
            read_foot(file)


SPHERES = "px [m],py [m],pz [m],radius [m],zone,k [N/m],b [N s/m]\n0,0.01,0,0.011,heel,1000,10\n"


@pytest.mark.parametrize("value", TRIED)
@pytest.mark.parametrize(("column", "written"), [("radius", "0.011"), ("k", "1000"), ("b", "10\n"), ("py", "0.01,")])
def test_a_number_of_a_table_of_spheres(tmp_path: Path, column: str, written: str, value: float) -> None:
    file = tmp_path / "spheres.csv"
    file.write_text(SPHERES.replace(written, written.replace(written.strip("\n,"), str(value))), encoding="utf-8")
    if value in {"b": NONE, "py": ANY}.get(column, ()):
        read_spheres(file)
        return
    with pytest.raises(InputError, match=rf"spheres.csv line 2: {column} is"):
        read_spheres(file)


@pytest.mark.parametrize("value", TRIED)
@pytest.mark.parametrize("key", ["mass", "inertia"])
def test_a_body_of_a_model(tmp_path: Path, key: str, value: float) -> None:
    """A body without mass is a frame; one without inertia is a point."""
    said = {"mass": "<mass>1</mass>", "inertia": "<inertia>1 1 1 0 0 0</inertia>"}[key]
    text = MODELS["4 PinJoint"]
    assert said in text
    file = written(tmp_path, text.replace(said, said.replace(">1", f">{value}", 1), 1))
    if value == 0.0:
        assert [body.name for body in read_multibody(file).bodies] == ["p", "c"]
        return
    with pytest.raises(InputError, match=f"<{key}>"):
        read_multibody(file)


@pytest.mark.parametrize("value", TRIED)
def test_a_height_of_no_person(tmp_path: Path, value: float) -> None:
    file = tmp_path / "numbers.csv"
    file.write_text(f"number,value,note\nheight,{value},\nhip inertia,-0.1,\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"numbers.csv line 2: height"):
        read_device_numbers(file, ("hip inertia",))
    file.write_text("number,value,note\nheight,1.8,\nhip inertia,-0.1,\n", encoding="utf-8")
    assert read_device_numbers(file, ("hip inertia",)).values == {"hip inertia": -0.1}
