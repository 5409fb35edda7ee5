"""A sole of foam in a foot's file: its columns by hand, written and read again, refused, through the commands."""

from __future__ import annotations

import re
import tomllib
import warnings
from pathlib import Path

import numpy as np
import pytest

import geocontact as gc
from geocontact.analyses.cop.foot import sole_law
from geocontact.analyses.cop.options import CopOptions
from geocontact.analyses.frame.record import Record
from geocontact.analyses.prosthesis.foot_file import foot_of
from geocontact.analyses.prosthesis.foot_writer import write_foot
from geocontact.analyses.prosthesis.number_units import unit_of
from geocontact.analyses.prosthesis.recorded_files import foot_with_law
from geocontact.analyses.prosthesis.simulate.options import ProsthesisSimulateOptions
from geocontact.analyses.prosthesis.simulate.walk import bushing_of, read, walk_of
from geocontact.below_knee_prosthesis.foot_numbers import all_numbers, foot_numbers
from geocontact.below_knee_prosthesis.keel.vsf import vsf_on_foam
from geocontact.below_knee_prosthesis.stance_model import stance_numbers
from geocontact.io.recordings.spheres import read_spheres
from meshes.make_foot import compressions
from tests.analyses.prosthesis.test_foot_file import BAR, SPHERES
from tests.analyses.prosthesis.test_numbers_that_ran import leg_of, socket_of
from tests.analyses.prosthesis.test_simulate import GIVEN, TRIAL
from tests.recording import opened

FOAM = (
    BAR[: BAR.index("[sole]")]
    + """[foam]
below = { value = 25, unit = "mm" }
breadth = { value = 60, unit = "mm" }
column = { value = 10, unit = "mm" }
across = 3
exponent = { value = 2, unit = "-" }

[foam.zones.heel]
to = { value = 100, unit = "mm" }
thickness = { value = 20, unit = "mm" }
modulus = { value = 0.5, unit = "MPa", source = "paper", note = "table 7" }
retardation = { value = 10, unit = "ms" }
static = { value = 0.9, unit = "-" }
kinetic = { value = 0.8, unit = "-" }

[foam.zones.fore]
to = { value = 250, unit = "mm" }
thickness = { value = 15, unit = "mm" }
modulus = { value = 900, unit = "kPa" }
retardation = { value = 0.02, unit = "s" }
static = { value = 0.7, unit = "-" }
kinetic = { value = 0.6, unit = "-" }
"""
)


def written(folder: Path, *changes: tuple[str, str]) -> Path:
    text = FOAM
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    (folder / "spheres.csv").write_text(SPHERES)
    file = folder / "foot.toml"
    file.write_text(text)
    return file


def test_columns_are_those_of_the_file(tmp_path: Path) -> None:
    foot = foot_of(written(tmp_path))
    spheres, law = foot.sole.spheres, foot.law
    assert len(spheres) == 75 and spheres.zone.count("heel") == 30
    np.testing.assert_allclose(spheres.centre[[0, 1, 2, 3], 0], [0.005, 0.005, 0.005, 0.015], atol=1e-15)
    np.testing.assert_allclose(spheres.centre[:3, 2], [-0.02, 0.0, 0.02], atol=1e-15)
    np.testing.assert_allclose(spheres.centre[:, 1] - spheres.radius, -0.025, atol=1e-15)
    area, heel = 0.010 * 0.020, np.array(spheres.zone) == "heel"
    np.testing.assert_allclose(law.stiffness, np.where(heel, area * 5e5 / 0.02**2, area * 9e5 / 0.015**2), rtol=1e-12)
    np.testing.assert_allclose(law.damping, np.where(heel, 0.01 * area * 5e5 / 0.02, 0.02 * area * 9e5 / 0.015))
    np.testing.assert_allclose(law.static, np.where(heel, 0.9, 0.7))
    np.testing.assert_allclose(spheres.deepest, np.where(heel, 0.02, 0.015))
    assert (law.exponent, law.full_depth, law.threshold_speed) == (2.0, 2e-3, 0.01)
    assert foot.sole.segment[:21] == (0,) * 21 and foot.sole.segment[-1] == 10  # first joint at 70 mm, the last at 232


def test_foam_that_is_written_reads_back_as_the_same(tmp_path: Path) -> None:
    foot = foot_of(written(tmp_path))
    write_foot(tmp_path / "again", foot)
    assert [file.name for file in (tmp_path / "again").iterdir()] == ["foot.toml"]
    again = foot_of(tmp_path / "again" / "foot.toml")
    assert again.sole.foam == foot.sole.foam and again.keel == foot.keel
    np.testing.assert_array_equal(again.sole.spheres.centre, foot.sole.spheres.centre)
    np.testing.assert_allclose(again.law.stiffness, foot.law.stiffness, rtol=1e-12)
    np.testing.assert_allclose(again.law.damping, foot.law.damping, rtol=1e-12)
    origin = again.record.origin["sole heel_modulus"]
    assert (origin.source, origin.note) == ("paper", "table 7")


SOLE = BAR[BAR.index("[sole]") :]


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("[foam]\n", f"{SOLE}\n[foam]\n", "has [sole] and [foam]; keep spheres or foam"),
        ('to = { value = 250, unit = "mm" }', 'to = { value = 90, unit = "mm" }', "order the zones from the heel"),
        ('to = { value = 250, unit = "mm" }', 'to = { value = 110, unit = "mm" }', "the foam ends at 110 mm, the keel"),
        ("value = 20, unit", "value = 26, unit", "26 mm, and the sole ends 25 mm below the keel's axis"),
        ("value = 0.9,", "value = 0.7,", "kinetic friction 0.8 is larger than the static one, 0.7"),
        ("across = 3", "across = 2.5", "is no count"),
        ('value = 10, unit = "mm" }\nacross = 3', 'value = 0.5, unit = "mm" }\nacross = 3', "columns are too many"),
        ('value = 0.5, unit = "MPa"', 'value = 0.5, unit = "Pa"', "cannot be the modulus of foam"),
        ('value = 10, unit = "ms"', 'value = 10, unit = "mm"', "retardation"),
        ('thickness = { value = 15, unit = "mm" }\n', "", "thickness"),
    ],
)
def test_refused(tmp_path: Path, old: str, new: str, words: str) -> None:
    with pytest.raises(gc.InputError, match=re.escape(words)):
        foot_of(written(tmp_path, (old, new)))


def test_many_columns_and_zones_that_seem_exchanged_are_warned_of(tmp_path: Path) -> None:
    with pytest.warns(gc.InputWarning, match="375 columns; a simulation takes long"):
        foot_of(written(tmp_path, ('value = 10, unit = "mm" }\nacross', 'value = 2, unit = "mm" }\nacross')))
    exchanged = written(tmp_path, ("zones.heel", "zones.a"), ("zones.fore", "zones.heel"), ("zones.a", "zones.fore"))
    with pytest.warns(gc.InputWarning, match="do the zones begin at the heel"):
        foot_of(exchanged)


def test_the_table_of_numbers_alone_gives_the_equations_theirs(tmp_path: Path) -> None:
    """Columns and law by hand from names and values of the table, every one of which has a unit."""
    write_foot(tmp_path, vsf_on_foam(9e-3, 1))
    o = ProsthesisSimulateOptions(TRIAL / "walking.trc", **(GIVEN | {"foot": tmp_path / "foot.toml"}))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        opened(Record("prosthesis simulate", {}))
        walk = walk_of(read(o), o)
    numbers = all_numbers(walk.leg, walk.foot, walk.fulcrum, bushing_of(o))
    assert all(unit_of(name) for name in numbers if name.startswith("sole "))
    told = {name: number.value for name, number in numbers.items()}
    start, rows = 0.0, []
    for zone in ("heel_back", "heel_middle", "heel_front", "midfoot", "forefoot"):
        of = {name: told[f"sole {zone}_{name}"] for name in ("to", "thickness", "modulus", "retardation")}
        count = round((of["to"] - start) / told["sole column"] + 1e-6)
        stiff = told["sole breadth"] * (of["to"] - start) / count * of["modulus"] / of["thickness"]
        rows.append((stiff, stiff * of["retardation"], told[f"sole {zone}_static"], told[f"sole {zone}_kinetic"]))
        start = of["to"]
    ran = stance_numbers(walk.leg, walk.foot, walk.fulcrum, bushing_of(o))
    np.testing.assert_allclose(ran[-20:], np.transpose(rows).ravel(), rtol=1e-9)
    again = stance_numbers(leg_of(told), walk.foot, told["fulcrum"], socket_of(told))
    np.testing.assert_allclose(again, ran, rtol=1e-9, atol=1e-11)


def test_the_keel_command_identifies_the_foam(tmp_path: Path) -> None:
    """Compressions of the study; the written foot is read again and meets them."""
    write_foot(tmp_path / "foot", vsf_on_foam(9e-3, 1), compressions())
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        found = gc.prosthesis.keel(tmp_path / "foot" / "foot.toml")
    numbers = found.table("keel").set_index("number")
    low, high = found.intervals["modulus of the foam, forefoot"]
    assert low < vsf_on_foam(9e-3, 1).record.origin["sole forefoot_modulus"].value < high
    assert numbers.loc["modulus of the foam, forefoot", "unit"] == "Pa"
    assert any("MPa in the foam of forefoot" in line for line in found.sentences)
    again = foot_of(found.write(tmp_path / "out") / "foot.toml")
    assert not (tmp_path / "out" / "spheres.csv").exists()
    np.testing.assert_allclose(again.law.stiffness, found.foot.law.stiffness, rtol=1e-12)
    assert again.record.origin["sole forefoot_modulus"].source == "derived"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[zone.heel]\nk = 2e4\n", "k and b are of one sphere, and the sole of bar foot has 75 columns of foam"),
        ("columns = 60\nb = 10.0\n", "k and b are of one of 60 columns of foam, and the sole of bar foot has 75"),
    ],
)
def test_a_law_of_another_sole_is_refused(tmp_path: Path, text: str, words: str) -> None:
    """38 kN/m of a sphere were taken for that of each of 75 columns."""
    foot, law = foot_of(written(tmp_path)), tmp_path / "law.toml"
    law.write_text(text)
    opened(Record("prosthesis simulate", {}))
    with pytest.raises(gc.InputError, match=words):
        foot_with_law(foot, law)
    law.write_text("columns = 75\nmu_k = 0.3\n[zone.heel]\nk = 2e4\n")
    changed = foot_with_law(foot, law)
    heel = np.array(foot.sole.spheres.zone) == "heel"
    np.testing.assert_allclose(changed.law.stiffness[heel], 2e4)
    np.testing.assert_allclose(changed.law.stiffness[~heel], foot.law.stiffness[~heel])
    numbers = foot_numbers(changed, 0.09)
    assert numbers["sole heel_modulus"].value == pytest.approx(2e4 * 0.02**2 / (0.01 * 0.02), rel=1e-12)
    with pytest.raises(gc.InputError, match="k and b are of one of 75 columns of foam, and the sole of the variable"):
        foot_with_law(foot_of(None), law)


def test_a_law_of_foam_is_none_of_spheres(tmp_path: Path) -> None:
    (tmp_path / "spheres.csv").write_text(SPHERES)
    (tmp_path / "law.toml").write_text("columns = 75\nk = 2e4\n")
    table = read_spheres(tmp_path / "spheres.csv")
    opened(Record("cop", {}))
    with pytest.raises(gc.InputError, match="k and b are of columns of foam; give a law of spheres"):
        sole_law(table, CopOptions(tmp_path / "spheres.csv", motion=tmp_path / "foot.csv", law=tmp_path / "law.toml"))


@pytest.mark.long
@pytest.mark.slow
def test_foam_is_calibrated_and_its_law_goes_on(tmp_path: Path) -> None:
    """Shipped trial, coarse columns: law.toml says of what it is, and the simulated stance carries the person."""
    write_foot(tmp_path, vsf_on_foam(8e-3, 1))
    foot, count = tmp_path / "foot.toml", len(vsf_on_foam(8e-3, 1).sole.spheres)
    given = {name: GIVEN[name] for name in ("static", "mass", "plates", "plate")}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        found = gc.prosthesis.calibrate(TRIAL / "walking.trc", foot=foot, starts=0, **given)
        law = found.write(tmp_path / "calibrated") / "law.toml"
        stance = gc.prosthesis.simulate(TRIAL / "walking.trc", foot=foot, law=law, socket_turns=0, **GIVEN).stance
    said = tomllib.loads(law.read_text())
    assert said["columns"] == count == len(stance.foot.sole.spheres)
    area = 0.06 * (0.229 - 0.148) / stance.foot.sole.spheres.zone.count("forefoot")
    modulus = said["zone"]["forefoot"]["k"] * 0.02 / area
    assert f"E {1e-6 * modulus:.4g} MPa" in law.read_text()
    np.testing.assert_allclose(stance.foot.law.stiffness[-1], said["zone"]["forefoot"]["k"])
    assert 1.0 < stance.force[:, 1].max() / (77.3 * 9.80665) < 1.6
    assert found.vertical.r2 > 0.8


@pytest.mark.parametrize("name", ["calibrate", "design"])
def test_foam_without_damping_has_no_factor(tmp_path: Path, name: str) -> None:
    foot = written(tmp_path, ('value = 10, unit = "ms"', 'value = 0, unit = "ms"'))
    given = {"static": TRIAL / "standing.trc", "mass": 77.3, "plates": TRIAL / "plates.mot", "plate": "own_force"}
    with pytest.raises(gc.InputError, match=r"foot\.toml zone heel: damping, of foam its retardation, is 0"):
        getattr(gc.prosthesis, name)(TRIAL / "walking.trc", foot=foot, fulcrum=0.1, **given)
