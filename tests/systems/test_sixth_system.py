"""What a sixth listed system needs outside of its own file, and that its candidates follow from its roles."""

from __future__ import annotations

import ast
import json
import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import geocontact
from geocontact.chain.effect import Candidate, Effect
from geocontact.chain.system import System
from geocontact.chain.traits import Mass, Migration, Traits, Way
from geocontact.data.gap_case import LISTED_SYSTEMS
from geocontact.data.parameter import Parameter
from geocontact.data.trial import Trial
from geocontact.effects.catalogue import candidates
from geocontact.gap.experiment.menu import menu
from tests.systems import sixth_system
from tests.systems.examples import foot, recording, sites

PACKAGE = Path(geocontact.__file__).parent
LISTS = "data/gap_case.py", "systems/catalogue.py"
"""All that is edited so that case.toml may name a further system."""
BEHAVIOUR = ("chain", "effects", "gap", "identify")
"""Rooms of the diagnosis, none of which may name one."""
MOST_FILES = 6


def trials() -> tuple[Trial, ...]:
    time = np.arange(0.0, 4.0, 0.02)
    found = []
    for number, speed in enumerate((2.0, 3.1)):
        press, swing = 0.004 + 0.003 * np.sin(speed * time), 0.5 * np.sin(0.7 * speed * time)
        found.append(recording(f"t{number}", time, {"press": press, "swing": swing, "force": 900.0 * press}))
    return tuple(found)


def thumb(traits: Traits = sixth_system.TRAITS) -> System:
    made = sixth_system.build((Parameter("k", "N/m", 900.0, 100.0, 5000.0),), {"reach": 0.4}, {})
    return replace(made, traits=traits).scaled(trials())


def offered(system: System) -> dict[str, Candidate]:
    return {one.label: one for one in candidates(system)}


def test_candidates_follow_from_roles() -> None:
    found = offered(thumb())
    assert {label.partition(".")[0] for label in found} == {
        *(
            "time_shift",
            "clock_slip",
            "filter_lag",
            "motion_offset",
            "play",
            "series_compliance",
            "stiffening",
            "damping",
            "relaxation",
        ),
        *("dry_friction", "dead_zone", "end_stop", "slip", "contact_loss", "gravity_load", "inertia_load"),
        *("sensor_gain", "sensor_offset", "sensor_drift", "saturation", "unit_error", "sign_flip"),
    }
    assert {label for label in found if label.startswith(("contact_loss", "inertia_load", "motion_offset"))} == {
        *("contact_loss", "inertia_load.thumb", "motion_offset.press", "motion_offset.swing"),
    }


def test_sizes_are_those_that_the_system_says() -> None:
    found = {label: one.parameters[0] for label, one in offered(thumb()).items() if one.parameters}
    press = np.concatenate([trial.column("press") for trial in trials()])
    force, half = 900.0 * press.max(), 0.5 * np.ptp(press)
    assert found["motion_offset.swing"].upper == 0.1
    assert found["motion_offset.press"].upper == pytest.approx(0.5 * half, rel=1e-12)
    compliance = found["series_compliance"]
    assert compliance.unit == "m/N"
    assert compliance.upper == pytest.approx(0.25 * press.max() / force, rel=1e-2)  # inputs are smoothed a little


@pytest.mark.parametrize(
    ("changed", "gone", "more"),
    [
        ({"pushes_only": False}, {"contact_loss"}, {"contact_loss.positive", "contact_loss.negative"}),
        ({"masses": ()}, {"inertia_load.thumb"}, set()),
        ({"masses": None}, {"inertia_load.thumb"}, set()),  # the pad moves against the handle, not in space
        ({"masses": None, "roles": {}}, {"inertia_load.thumb"}, {"inertia_load"}),
        (
            {"roles": {"press": "displacement", "swing": "turn"}},
            {"gravity_load", "motion_offset.swing", "play.swing"},
            set(),
        ),
        ({"roles": {"press": "travel"}}, {"motion_offset.press", "play.press"}, set()),
        ({"plausible": {"press": 0.0}}, {"motion_offset.press"}, set()),
        ({"masses": (Mass("pad"),)}, {"inertia_load.thumb"}, {"inertia_load.pad"}),
        ({"way": Way(), "migration": Migration(2.0)}, set(), set()),  # sizes only
    ],
)
def test_each_trait_decides_what_it_is_about(changed: dict[str, object], gone: set[str], more: set[str]) -> None:
    before, after = set(offered(thumb())), set(offered(thumb(replace(sixth_system.TRAITS, **changed))))
    assert (before - after, after - before) == (gone, more)


def test_experiments_follow_from_roles() -> None:
    """A movement in space that makes contact by its size is not made smaller, one against the body is."""

    def kinds(roles: dict[str, str]) -> set[str]:
        traits = replace(sixth_system.TRAITS, roles=roles)
        return {one.name for one in menu(thumb(traits), trials())}

    assert kinds({"press": "displacement", "swing": "turn"}) - kinds({"press": "displacement"}) == {"smaller"}
    assert [foot().role(name) for name in ("x", "y", "force_x", "cop_x")] == ["travel", "position", "load", "centre"]


def test_what_an_effect_needs_is_asked_of_every_place() -> None:
    """An own model of several places is offered effects on its contacts, which before only the listed one was."""
    own = offered(replace(sites(), name="two straps of my own"))
    assert set(own) == set(offered(sites())) >= {"stiffening.thigh", "stiffening"}
    without = replace(sites(), law=sites().law.lacking("thigh.stiffening.gain"))
    assert not any(label.startswith("stiffening") for label in offered(without))


def test_an_effect_that_still_lists_systems_is_refused_in_words() -> None:
    with pytest.raises(TypeError, match="offer"):
        Effect("tare", "sensor", ("thumb",), lambda system: (), "here")  # type: ignore[arg-type]


def named(file: Path) -> set[str]:
    """Listed systems whose name is a word of the code."""
    words = {node.value for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))) if hasattr(node, "value")}
    return {name for name in LISTED_SYSTEMS if name in {word for word in words if isinstance(word, str)}}


def test_no_room_of_the_diagnosis_names_a_system() -> None:
    files = [file for room in BEHAVIOUR for file in (PACKAGE / room).rglob("*.py")]
    assert len(files) > 100
    assert {file.relative_to(PACKAGE).as_posix(): named(file) for file in files if named(file)} == {}
    assert named(PACKAGE / LISTS[0]) == set(LISTED_SYSTEMS)


def linked(source: Path, target: Path, changed: dict[str, str]) -> None:
    """A folder of links to another one, but for files that have another text, or are new."""
    target.mkdir()
    inside = {name.partition("/")[0] for name in changed}
    for each in source.iterdir():
        if each.name not in inside:
            (target / each.name).symlink_to(each)
    for first in inside:
        below = {name.partition("/")[2]: text for name, text in changed.items() if name.partition("/")[0] == first}
        if "" in below:
            (target / first).write_text(below[""], encoding="utf-8")
        else:
            linked(source / first, target / first, below)


LOOK = """
import json, geocontact as gc
from geocontact.effects.catalogue import candidates
system = gc.system_of(gc.read_gap_case("case"))
print(json.dumps([gc.__file__, system.name, [one.label for one in candidates(system)]]))
"""


@pytest.mark.slow
def test_a_sixth_listed_system_needs_two_lines_outside_of_its_file(tmp_path: Path) -> None:
    """A copy of the package with the system in it reads, checks and diagnoses a case that names it."""
    lists = {name: (PACKAGE / name).read_text(encoding="utf-8") for name in LISTS}
    edited = {
        LISTS[0]: lists[LISTS[0]].replace('"sit_to_stand")\n', '"sit_to_stand", "thumb")\n'),
        LISTS[1]: lists[LISTS[1]]
        .replace("import SIT_TO_STAND\n", "import SIT_TO_STAND\nfrom geocontact.systems.thumb import THUMB\n")
        .replace("KNEE, SIT_TO_STAND)", "KNEE, SIT_TO_STAND, THUMB)"),
    }
    assert all(edited[name] != lists[name] for name in LISTS)
    assert len(edited) <= MOST_FILES
    own = Path(sixth_system.__file__).read_text(encoding="utf-8")
    linked(PACKAGE, tmp_path / "geocontact", {**edited, "systems/thumb.py": own})
    (tmp_path / "case" / "trials").mkdir(parents=True)
    for trial in trials():
        units = dict(zip(("time", *trial.signals.channels), ("s", "m", "rad", "N"), strict=True))
        header = ",".join(f"{name} [{unit}]" for name, unit in units.items())
        table = np.column_stack([trial.time, trial.signals.values])
        np.savetxt(tmp_path / "case" / "trials" / f"{trial.name}.csv", table, delimiter=",", header=header, comments="")
    text = 'format = 1\nsystem = "thumb"\ncalibration = ["t0"]\nevaluation = ["t1"]\n[noise]\nforce = 0.05\n'
    text += '[constants]\nreach = 0.4\n[parameters.k]\nstart = 900.0\nlower = 100.0\nupper = 5000.0\nunit = "N/m"\n'
    (tmp_path / "case" / "case.toml").write_text(text, encoding="utf-8")
    environment = {**os.environ, "PYTHONPATH": str(tmp_path), "GEOCONTACT_UNCHECKED": "1"}
    done = subprocess.run(
        [sys.executable, "-c", LOOK], cwd=tmp_path, env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    where, name, labels = json.loads(done.stdout.splitlines()[-1])
    assert Path(where).parent == tmp_path / "geocontact"
    assert name == "thumb"
    assert labels == list(offered(thumb()))
