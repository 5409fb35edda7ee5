"""A foot of one's own: what its file says is what is simulated, and the shipped foot is such a file."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import geocontact as gc
from geocontact.analyses.frame.record import Record
from geocontact.analyses.prosthesis.compare.options import ProsthesisCompareOptions
from geocontact.analyses.prosthesis.compare.stances import read as read_study
from geocontact.analyses.prosthesis.design.trial import in_plane
from geocontact.analyses.prosthesis.foot_file import SHIPPED, foot_of, fulcrum_at
from geocontact.analyses.prosthesis.foot_writer import write_foot
from geocontact.analyses.prosthesis.simulate.options import ProsthesisSimulateOptions
from geocontact.analyses.prosthesis.simulate.walk import read
from geocontact.below_knee_prosthesis.design.drawn import finer_feet
from geocontact.below_knee_prosthesis.design.varied import values_of
from geocontact.below_knee_prosthesis.keel.vsf import vsf_foot
from tests.cli.calls import MESHES
from tests.recording import opened

TRIAL = MESHES / "gait_P1_medium_1"
BAR = """
name = "bar foot"

[keel]
length = { value = 250, unit = "mm" }
posterior = { value = 70, unit = "mm" }
lowest = { value = 70, unit = "mm" }
highest = { value = 160, unit = "mm" }
width = { value = 50, unit = "mm" }
thickness = { value = 8, unit = "mm" }
density = { value = 1.6, unit = "g/cm^3" }
modulus = { value = 20, unit = "GPa" }
joints = 10

[settings]
walking = { value = 9, unit = "cm" }

[sole]
spheres = "spheres.csv"
below = { value = 25, unit = "mm" }

[sole.zones.heel]
stiffness = { value = 30, unit = "N/mm" }
damping = { value = 0.4, unit = "N s/mm" }
static = { value = 0.9, unit = "-" }
kinetic = { value = 0.8, unit = "-" }

[sole.zones.toe]
stiffness = { value = 40, unit = "N/mm", source = "paper", note = "table 7" }
damping = { value = 500, unit = "N s/m" }
static = { value = 0.9, unit = "-" }
kinetic = { value = 0.8, unit = "-" }
"""
SPHERES = """px [mm],py [mm],pz [mm],radius [mm],zone
10,-5,-20,20,heel
10,-5,20,20,heel
40,-10,0,15,heel
200,-10,-20,15,toe
230,-10,0,15,toe
"""
SECTIONS = """
[[keel.sections]]
to = { value = 100, unit = "mm" }
thickness = { value = 10, unit = "mm" }

[[keel.sections]]
to = { value = 250, unit = "mm" }
thickness = { value = 8, unit = "mm" }
width = { value = 40, unit = "mm" }
"""


def written(folder: Path, *changes: tuple[str, str]) -> Path:
    text = BAR
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    (folder / "foot.toml").write_text(text)
    (folder / "spheres.csv").write_text(SPHERES)
    return folder / "foot.toml"


def test_a_bar_has_the_stiffness_of_its_section_and_the_spheres_of_its_table(tmp_path: Path) -> None:
    """EI = E w t³/12 by hand, mass density times volume; places and law as they stand there."""
    foot = foot_of(written(tmp_path))
    assert foot.keel.bending == pytest.approx(20e9 * 0.05 * 0.008**3 / 12.0, rel=1e-12)
    whole = foot.keel.posterior_mass + foot.keel.joints * foot.keel.segment_mass
    assert whole == pytest.approx(1600.0 * 0.05 * 0.008 * 0.25, rel=1e-12)
    assert foot.record.settings == {"walking": pytest.approx(0.09)}
    np.testing.assert_allclose(foot.sole.spheres.centre[2], [0.04, -0.01, 0.0], atol=1e-15)
    assert foot.sole.segment == (0, 0, 0, 8, 9)  # joints every 18 mm from 70 mm on
    np.testing.assert_allclose(foot.law.stiffness, [3e4] * 3 + [4e4] * 2)
    np.testing.assert_allclose(foot.law.damping, [400.0] * 3 + [500.0] * 2)


def test_sections_by_thickness_have_the_stiffness_of_each(tmp_path: Path) -> None:
    keel = foot_of(written(tmp_path, ("\n[settings]", SECTIONS + "\n[settings]"))).keel
    assert keel.bending == pytest.approx(20e9 * 0.05 * 0.010**3 / 12.0, rel=1e-12)
    assert keel.sections.edges == (pytest.approx(0.1),)
    assert keel.sections.factors == (1.0, pytest.approx(0.04 * 0.008**3 / (0.05 * 0.010**3), rel=1e-12))


def test_a_keel_twists_where_its_file_says_so(tmp_path: Path) -> None:
    """GJ = 4 G/E EI of a flat section by default; a foot reads back as it is written; plane feet leave it out."""
    assert not foot_of(written(tmp_path)).keel.twists
    foot = foot_of(written(tmp_path, ("\n[settings]", "twists = true\n\n[settings]")))
    assert foot.keel.twists
    assert foot.keel.hinges == foot.keel.joints + 1
    write_foot(tmp_path / "again", foot)
    again = foot_of(tmp_path / "again" / "foot.toml").keel
    assert (again.twists, again.torsional) == (True, pytest.approx(foot.keel.torsional, rel=1e-12))
    with pytest.warns(gc.InputWarning, match="twists by its file, and does not here"):
        assert not in_plane(foot).keel.twists


def test_the_shipped_foot_is_a_file_with_the_numbers_of_the_study() -> None:
    """Written by `python -m meshes.make_foot`; the fit behind it is run anew here, as exactly as processors agree."""
    shipped, derived = foot_of(None), vsf_foot()
    assert shipped.keel.bending == pytest.approx(derived.keel.bending, rel=1e-9)
    np.testing.assert_allclose(shipped.law.stiffness, derived.law.stiffness, rtol=1e-9)
    np.testing.assert_array_equal(shipped.sole.spheres.centre, derived.sole.spheres.centre)
    assert shipped.sole.segment == derived.sole.segment
    assert shipped.record.settings == pytest.approx(derived.record.settings, rel=1e-9)
    for name, number in derived.record.origin.items():
        own = shipped.record.origin[name]
        assert (own.source, own.note) == (number.source, number.note), name


@pytest.mark.parametrize("sections", ["", SECTIONS])
def test_a_foot_that_is_written_reads_back_as_the_same(tmp_path: Path, sections: str) -> None:
    foot = foot_of(written(tmp_path, ("\n[settings]", sections + "\n[settings]")))
    write_foot(tmp_path / "again", foot)
    again = foot_of(tmp_path / "again" / "foot.toml")
    assert replace(again.keel, sections=foot.keel.sections) == foot.keel
    assert again.keel.sections.edges == foot.keel.sections.edges
    assert again.keel.sections.factors == pytest.approx(foot.keel.sections.factors, rel=1e-15)
    assert again.record.settings == foot.record.settings and again.record.below == foot.record.below
    np.testing.assert_array_equal(again.law.stiffness, foot.law.stiffness)
    np.testing.assert_array_equal(again.sole.spheres.centre, foot.sole.spheres.centre)


def test_simulate_reads_the_foot_and_its_settings(tmp_path: Path) -> None:
    o = options(foot=written(tmp_path), setting="walking")
    opened(Record("prosthesis simulate", {}))
    recorded = read(o)
    assert recorded.foot.record.name == "bar foot" and recorded.fulcrum == pytest.approx(0.09)


def options(**changed: object) -> ProsthesisSimulateOptions:
    given: dict[str, object] = {
        "static": TRIAL / "standing.trc",
        "mass": 77.3,
        "plates": TRIAL / "plates.mot",
        "other_plate": "other_force",
    }
    return ProsthesisSimulateOptions(TRIAL / "walking.trc", **(given | changed))  # type: ignore[arg-type]


def test_a_setting_that_the_foot_has_not_is_refused(tmp_path: Path) -> None:
    foot = foot_of(written(tmp_path))
    with pytest.raises(gc.InputError, match="'medium' is none of the settings of bar foot; write walking"):
        fulcrum_at(foot, "medium", None)
    with pytest.raises(gc.InputError, match="165 mm cannot be the place of a fulcrum: that is 70 to 160 mm"):
        fulcrum_at(foot, "medium", 0.165)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('length = { value = 250, unit = "mm" }', 'length = { value = 250, unit = "m" }', "is 250 mm meant?"),
        ('length = { value = 250, unit = "mm" }', "length = 250", "is not a value with its unit"),
        ("walking = { value = 9,", "walking = { value = 99,", "cannot be a place along a keel"),
        (
            "walking = { value = 9,",
            "walking = { value = 19,",
            "190 mm is out of the fulcrum's range; that is 70 to 160",
        ),
        ('modulus = { value = 20, unit = "GPa" }', "", "EI of the keel is not known"),
        ("value = 160,", "value = 260,", "first joint and fulcrums must be on the keel of 0.25 m"),
        ("[sole.zones.toe]", "[sole.zones.tip]", "zones of the table are heel, toe"),
        ('below = { value = 25, unit = "mm" }', 'below = { value = 5, unit = "mm" }', "these two have to agree"),
        ('unit = "GPa"', 'unit = "Pa"', "cannot be a modulus"),
        ("joints = 10", "joints = 2.5", "is no count"),
        ("\n[settings]", SECTIONS.replace("250", "240") + "\n[settings]", "let it end at the tip"),
    ],
)
def test_refused(tmp_path: Path, old: str, new: str, words: str) -> None:
    with pytest.raises(gc.InputError, match=re.escape(words)):
        foot_of(written(tmp_path, (old, new)))


def test_a_foot_without_a_sole_has_that_of_the_study_stretched(tmp_path: Path) -> None:
    text = BAR[: BAR.index("[sole]")]
    file = tmp_path / "bare.toml"
    file.write_text(text)
    with pytest.warns(gc.InputWarning, match="no \\[sole\\]"):
        foot = foot_of(file)
    usual = foot_of(None).sole.spheres.centre
    np.testing.assert_allclose(foot.sole.spheres.centre[:, 0], usual[:, 0] * 0.25 / 0.229, rtol=1e-12)


def test_the_shipped_file_is_in_the_package() -> None:
    assert SHIPPED.is_file() and SHIPPED.parent.name == "shipped_foot"


def test_a_foot_of_ones_own_with_more_spheres_has_the_same_zones(tmp_path: Path) -> None:
    """Twice as many spheres, each half as stiff, on both sides of the one; the shipped foot is fitted anew."""
    foot = foot_of(written(tmp_path))
    one, two = finer_feet(foot, 2)
    assert one is foot and len(two.sole.spheres) == 10
    for zone, of in foot.sole.spheres.zones.items():
        more = two.sole.spheres.zones[zone]
        for kind in ("stiffness", "damping"):
            assert getattr(two.law, kind)[more].sum() == pytest.approx(getattr(foot.law, kind)[of].sum(), rel=1e-12)
    x = two.sole.spheres.centre[:, 0]
    np.testing.assert_allclose(x[:2], [0.01 - 0.0075, 0.01 + 0.0075], atol=1e-12)  # rows at 10 and 40 mm: 30 mm apart
    assert two.keel == foot.keel and two.record is foot.record
    assert values_of("fulcrum", foot.keel)[[0, -1]] == pytest.approx([0.07, 0.16])  # 66 to 151 mm stood there
    assert [len(each.sole.spheres) for each in finer_feet(foot_of(None), 2)] == [24, 48]


def test_a_persons_foot_is_that_of_the_study(tmp_path: Path) -> None:
    """A setting of that foot is accepted, one that it has not is refused with the trial's name."""
    written(tmp_path)
    trial = f'markers = "{TRIAL}/walking.trc"\nplates = "{TRIAL}/plates.mot"\nplate = "own_force"\n'
    text = (
        f'[persons.P1]\nmass = {{ value = 77.3, unit = "kg" }}\nstatic = "{TRIAL}/standing.trc"\nfoot = "foot.toml"\n'
    )
    study = tmp_path / "study.toml"
    study.write_text(f'{text}[[trials]]\nperson = "P1"\nsetting = "walking"\n{trial}other_plate = "other_force"\n')
    opened(Record("prosthesis compare", {}))
    (one,) = read_study(ProsthesisCompareOptions(study))
    assert one.walk.foot.record.name == "bar foot" and one.walk.fulcrum == pytest.approx(0.09)
    study.write_text(study.read_text().replace('walking"\nmarkers', 'medium"\nmarkers'))
    with pytest.raises(gc.InputError, match=r"\[\[trials\]\] P1_1 setting: 'medium' is none of the settings"):
        gc.prosthesis.compare(study)
