"""An exoskeleton from its description: shipped numbers to the last bit, other ones by hand, contradictions named."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import geocontact as gc
from geocontact.analyses.sit_to_stand.device.merged import merged
from geocontact.analyses.sit_to_stand.worn_exoskeleton import described_exoskeleton
from geocontact.io.recordings.exoskeleton_description import EXOSKELETON
from geocontact.io.text.toml_text import toml_of
from geocontact.standing_up.chain import Subject
from geocontact.standing_up.exoskeleton import strapped, two_chains
from geocontact.standing_up.numbers_that_ran import model_numbers
from geocontact.standing_up.strap import strap_motion
from geocontact.standing_up.worn_device import SHIPPED_DEVICE
from tests.analyses.sit_to_stand.test_worn_trials import SAMPLE, read, study_of

DESCRIBED = """name = "prototype"
[numbers]
foot_plate_mass = { value = 1.2, unit = "kg", source = "derived", note = "weighed" }
shank_mass = { value = 2500, unit = "g", source = "derived", note = "weighed" }
thigh_mass = { value = 3.1, unit = "kg" }
module_mass = { value = 6, unit = "kg", source = "derived", note = "weighed" }
shank_length = { value = 460, unit = "mm" }
thigh_length = { value = 400, unit = "mm" }
module_height = { value = 0.3, unit = "m" }
thigh_centre = { value = 0.15, unit = "m" }
thigh_ahead = { value = -20, unit = "mm" }
thigh_inertia = { value = 0.05, unit = "kg m^2" }
strap_damping = { value = 25, unit = "N s/m" }
knee_coulomb = { value = 1.5, unit = "N m" }
"""


WEIGHED = {"shank": 3.0, "thigh": 4.2, "module": 5.0}
ALONE = SAMPLE / "unloaded_coordinates.sto", SAMPLE / "unloaded_motors.sto"
CENTRES = """module_centre = { value = 125, unit = "mm" }
thigh_centre = { value = 0.4, unit = "m" }
shank_inertia = { value = 0.05, unit = "kg m^2" }
"""


@pytest.fixture(scope="module")
def identified(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """device.toml of weighed parts, whose mass centres were described as well."""
    folder = tmp_path_factory.mktemp("identified")
    masses = "".join(f'{name}_mass = {{ value = {mass}, unit = "kg" }}\n' for name, mass in WEIGHED.items())
    (folder / "mine.toml").write_text(f"[numbers]\n{CENTRES}{masses}")
    result = gc.sit_to_stand.device(ALONE[0], motors=ALONE[1], device=folder / "mine.toml")
    assert re.search(r"left out, as \S+ and masses have them: .*thigh_centre \(0.4, identified 0.19", str(result))
    return result.write(folder / "found") / "device.toml"


@pytest.fixture
def described(tmp_path: Path) -> Path:
    file = tmp_path / "exoskeleton.toml"
    file.write_text(DESCRIBED)
    return file


def test_the_shipped_description_is_the_exoskeleton_without_one(tmp_path: Path) -> None:
    """The same object, so that results are the same to the last bit."""
    assert described_exoskeleton(SAMPLE / "exoskeleton.toml")[0] == SHIPPED_DEVICE
    plain, _ = read(study_of(tmp_path, "", hinges=True))
    given, _ = read(study_of(tmp_path, "", f'device = "{SAMPLE / "exoskeleton.toml"}"', hinges=True))
    assert given.sites == plain.sites and given.subject == plain.subject
    rows = [model_numbers(strapped(each.subject, each.sites)) for each in (plain, given)]
    assert rows[0] == rows[1], "numbers.csv, sources and notes included"


def test_bodies_hinges_and_straps_are_those_described(tmp_path: Path, described: Path) -> None:
    """By hand: hinges stand 460 and 860 mm above the ankle; upright, the strap's point on both is one."""
    given, _ = read(study_of(tmp_path, "", f'device = "{described}"', hinges=True))
    chain = two_chains(given.subject)
    bodies = {body.name: body for body in chain.bodies}
    assert [bodies[f"exo_{part}"].mass for part in ("shank", "thigh", "module")] == [2.5, 3.1, 6.0]
    np.testing.assert_allclose(bodies["exo_shank"].centre, [0.0, 0.23, 0.0])
    np.testing.assert_allclose(bodies["exo_thigh"].centre, [-0.02, 0.15, 0.0])
    assert bodies["exo_thigh"].inertia[2, 2] == 0.05
    assert bodies["exo_module"].inertia[2, 2] == pytest.approx(6.0 * 0.3**2 / 12.0, rel=1e-12)
    ran = {row.number: row for row in model_numbers(strapped(given.subject, given.sites))}
    assert ran["body exo_module mass"].source == "derived" and "weighed" in ran["body exo_module mass"].note
    assert bodies["foot"].mass == pytest.approx(2 * 0.0137 * 70.0 + 1.2, rel=1e-12)
    poses = chain.poses(np.zeros((1, 9)))
    assert [poses[name].translation[0, 1] for name in ("exo_thigh", "exo_module")] == pytest.approx([0.46, 0.86])
    site = given.sites[0]
    assert (site.damping, site.turning_damping) == (25.0, 0.1)
    moved = strap_motion(given.subject, np.zeros((1, 9)), 0.2, site)
    assert np.abs([moved.normal[0], moved.tangential[0], moved.rotation[0]]).max() < 1e-12
    knee = poses["thigh"].translation[0, 1]
    assert site.above == pytest.approx(0.46 - knee, abs=1e-12)
    rate = np.array([[0.3, -0.4, 0.2]])
    np.testing.assert_allclose(given.subject.device.friction(rate), [[0.0, -1.5, 0.0]], atol=1e-8)


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        (("6, unit", "0, unit"), "0 is not that of a body"),
        (("460, unit", "46, unit"), "0.046 m cannot be the length of a part.*46 cm meant"),
        (("module_height", "module_heigth"), "perhaps module_height"),
        (("1.5, unit", "-1.5, unit"), "cannot be the Coulomb friction"),
    ],
)
def test_what_cannot_be_is_refused(tmp_path: Path, described: Path, changed: tuple[str, str], said: str) -> None:
    described.write_text(DESCRIBED.replace(*changed))
    with pytest.raises(gc.InputError, match=said):
        read(study_of(tmp_path, "", f'device = "{described}"', hinges=True))


def test_what_study_and_description_say_twice_must_agree(tmp_path: Path, described: Path) -> None:
    head = f'device = "{described}"'
    tail = '\n[masses]\nmodule = { value = 4, unit = "kg" }\n'
    with pytest.raises(gc.InputError, match=r"\[masses\] module.*4 kg, and 6 kg in exoskeleton.toml"):
        read(study_of(tmp_path, "", head, hinges=True, tail=tail))
    with pytest.raises(gc.InputError, match=r"\[straps\] damping.*10, and 25 in the description"):
        read(study_of(tmp_path, "", head, hinges=True, tail="\n[straps]\ndamping = 10\n"))


def test_an_exoskeleton_that_does_not_fit_is_warned_of(tmp_path: Path, described: Path) -> None:
    described.write_text(DESCRIBED.replace("460", "520"))
    _, warned = read(study_of(tmp_path, "", f'device = "{described}"', hinges=True))
    assert any("its knee is 77 mm above the person's" in line for line in warned), warned


def test_what_device_identifies_is_read_without_hand_work(tmp_path: Path) -> None:
    """device.toml in a study is numbers.csv there: the same bodies and friction; described masses are kept."""
    files = SAMPLE / "unloaded_coordinates.sto", SAMPLE / "unloaded_motors.sto"
    masses = tmp_path / "weighed.toml"
    masses.write_text(
        "[numbers]\n" + "".join(f'{name}_mass = {{ value = {mass}, unit = "kg" }}\n' for name, mass in WEIGHED.items())
    )
    result = gc.sit_to_stand.device(files[0], motors=files[1], device=masses)
    out = result.write(tmp_path / "found")
    assert (
        "kept as described: shank_mass, thigh_mass, module_mass; neither described nor identified: foot_plate"
        in str(result)
    )
    tables = study_of(tmp_path, 'mode = "passive"', f'device = "{out / "numbers.csv"}"').read_text()
    by_table, _ = read(tmp_path / "study.toml")
    (tmp_path / "study.toml").write_text(tables.replace("numbers.csv", "device.toml"))
    by_file, warned = read(tmp_path / "study.toml")
    assert any("no mass of foot_plate: invented" in line for line in warned)
    assert by_file.subject.device.masses.thigh == 4.2
    ours, theirs = (each.subject.device for each in (by_file, by_table))
    np.testing.assert_allclose([ours.viscous, ours.coulomb], [theirs.viscous, theirs.coulomb], rtol=1e-10)
    assert by_file.trials[0].torque is not None and by_table.trials[0].torque is not None
    np.testing.assert_allclose(by_file.trials[0].torque, by_table.trials[0].torque, rtol=1e-9, atol=1e-9)
    weighed = {body.name: body for body in two_chains(by_file.subject).bodies}
    first = 4.2 * weighed["exo_thigh"].centre[1] + 5.0 * 0.414375  # what the motors see of thigh and module
    values = result.parameters
    told = values["exo_thigh first moment along y"] + values["exo_module mass"] * 0.414375
    assert first == pytest.approx(told, rel=1e-9)


def test_an_identified_number_that_contradicts_the_description_is_named(tmp_path: Path) -> None:
    """The hip was planted with 2 N m of Coulomb friction: 2.1 agrees, 3 does not; a module of 1 kg at 0.1 m neither."""
    file = tmp_path / "sheet.toml"
    files = SAMPLE / "unloaded_coordinates.sto", SAMPLE / "unloaded_motors.sto"
    rows = (
        '[numbers]\nhip_coulomb = { value = %g, unit = "N m", source = "paper", note = "sheet" }\n'
        'module_mass = { value = %g, unit = "kg" }\nmodule_centre = { value = 0.125, unit = "m" }\n'
    )
    file.write_text(rows % (2.05, 5.0))
    gc.sit_to_stand.device(files[0], motors=files[1], device=file)
    file.write_text(rows % (3.0, 1.0))
    with pytest.warns(gc.InputWarning) as caught:
        result = gc.sit_to_stand.device(files[0], motors=files[1], device=file)
    said = [str(each.message) for each in caught]
    assert any(
        "exo_hip Coulomb friction: 1.981 ± 0.032 N m" in line and "3 by the description" in line for line in said
    )
    assert any("exo_module first moment along y" in line and "0.125 by" in line for line in said)
    assert "# was 3" in (result.write(tmp_path / "out") / "device.toml").read_text()


def test_a_device_beside_another_one_is_refused(tmp_path: Path, described: Path) -> None:
    from geocontact.analyses.sit_to_stand.standing_trials import standing_trials

    study = study_of(tmp_path, "", f'device = "{SAMPLE / "exoskeleton.toml"}"', hinges=True)
    with pytest.raises(gc.InputError, match="name one of them"):
        standing_trials(study, "study", device=described)
    with pytest.raises(gc.InputError, match="has no effect without one"):
        standing_trials(SAMPLE.parent / "standing_up" / "study.toml", "study", device=described)
    with pytest.warns(gc.InputWarning, match="knee_coulomb.*has no effect"):
        given = standing_trials(study_of(tmp_path, "", hinges=True), "study", device=described)
    assert given.subject.device.masses.module == 6.0
    assert Subject(device=given.subject.device) != Subject()


def test_what_is_described_and_identified_must_agree(tmp_path: Path, identified: Path) -> None:
    """Mass centres by hand: what the motors see of a part less what hangs at its end, over its mass."""
    text = identified.read_text()
    of = {name: each["value"] for name, each in toml_of(identified, 100_000)["identified"]["parameters"].items()}
    above = sum(of[f"exo_{part} mass"] - WEIGHED[part] for part in ("thigh", "module"))
    along = (of["exo_shank first moment along y"] + 0.452575 * above) / 3.0
    ahead = of["exo_module first moment along x"] / 5.0
    inertia = of["exo_module inertia"] - 5.0 * (ahead**2 + (of["exo_module first moment along y"] / 5.0) ** 2)

    def given(rows: str, old: str = "", new: str = "") -> None:
        changed = re.sub(old, new, text, flags=re.MULTILINE) if old else text
        assert not old or changed != text
        (tmp_path / "device.toml").write_text(changed.replace("[numbers]\n", f"[numbers]\n{rows}"))
        read(study_of(tmp_path, 'mode = "passive"', 'device = "device.toml"'))

    given("")
    row = '{} = {{ value = {:.5f}, unit = "{}" }}\n'.format
    given(row("shank_centre", along, "m") + row("module_ahead", ahead, "m") + row("module_inertia", inertia, "kg m^2"))
    for name, value, unit in (
        ("thigh_inertia", 9.0, "kg m^2"),
        ("module_centre", 0.9, "m"),
        ("shank_ahead", 0.03, "m"),
        ("shank_centre", 1.01 * along, "m"),
    ):
        with pytest.raises(gc.InputError, match=rf"\[numbers\] {name}.*by \[identified\] with a mass of"):
            given(row(name, value, unit))
    with pytest.raises(gc.InputError, match=r"\[numbers\] knee_coulomb.*50, and 2.498 in"):
        given("", "^knee_coulomb = { value = [^,]*", "knee_coulomb = { value = 50.0")
    with pytest.raises(gc.InputError, match=r"\[numbers\] hip_viscous.*, and -2.5 in"):
        given("", '"exo_hip viscous friction" = { value = [^,]*', '"exo_hip viscous friction" = { value = -2.5')
    text = re.sub("^hip_coulomb.*\n", "", text, flags=re.MULTILINE)
    with pytest.raises(gc.InputError, match=r"exo_hip Coulomb friction.*-1.98 would drive the hinge"):
        given("", '"exo_hip Coulomb friction" = { value = [^,]*', '"exo_hip Coulomb friction" = { value = -1.98')


def test_friction_is_that_of_the_numbers(tmp_path: Path, identified: Path) -> None:
    """What noise makes of no friction is less than 0, and described as 0, which then is used."""
    negative = re.sub('("exo_hip Coulomb friction" = { value = )[^,]*', r"\g<1>-0.01", identified.read_text())
    changed = re.sub("^(hip_coulomb = { value = )[^,]*", r"\g<1>0.0", negative, flags=re.MULTILINE)
    (tmp_path / "device.toml").write_text(changed)
    given, _ = read(study_of(tmp_path, 'mode = "passive"', 'device = "device.toml"'))
    viscous, coulomb = given.subject.device.viscous, given.subject.device.coulomb
    assert coulomb[2] == 0.0 and coulomb[1] == pytest.approx(2.498, abs=1e-3) and min(viscous) > 1.0


def test_a_friction_below_zero_is_none_only_within_its_interval() -> None:
    result = gc.sit_to_stand.device(ALONE[0], motors=ALONE[1])
    fit, at = result.dynamics, result.dynamics.names.index("exo_hip Coulomb friction")
    for value, there in ((-0.01, True), (-1.98, False)):
        values = np.array(fit.values)
        values[at] = value
        made = merged(result.given.described, replace(fit, values=values), 0.95)
        assert ("hip_coulomb" in made.file.numbers) is there
        assert f"friction of {6 if there else 5} of 6 kinds identified" in made.sentence
        assert not there or made.file.numbers["hip_coulomb"].value == 0.0


def test_the_shipped_description_states_nothing_of_an_exoskeleton(tmp_path: Path) -> None:
    """No contradiction, which would be a warning; numbers are written in their order."""
    result = gc.sit_to_stand.device(ALONE[0], motors=ALONE[1], device=SAMPLE / "exoskeleton.toml")
    rows = [line.partition(" = {")[0] for line in (result.write(tmp_path) / "device.toml").read_text().splitlines()]
    numbers = [row for row in rows[: rows.index("[identified]")] if row in EXOSKELETON]
    assert numbers == [name for name in EXOSKELETON if name in numbers] and len(numbers) == 14


def test_an_invented_mass_says_nothing_of_a_moment(tmp_path: Path) -> None:
    """The shipped module of 5 kg with a described mass centre is no statement about the first moment."""
    text = (SAMPLE / "exoskeleton.toml").read_text() + '\nmodule_centre = { value = 0.3, unit = "m" }\n'
    (tmp_path / "mine.toml").write_text(text)
    gc.sit_to_stand.device(ALONE[0], motors=ALONE[1], device=tmp_path / "mine.toml")


def test_masses_of_nothing_are_confronted(tmp_path: Path, described: Path) -> None:
    described.write_text(DESCRIBED.replace("1.2, unit", "0, unit"))
    tail = '\n[masses]\nfoot_plate = { value = 1, unit = "kg" }\n'
    with pytest.raises(gc.InputError, match=r"\[masses\] foot_plate.*1 kg, and 0 kg in"):
        read(study_of(tmp_path, "", f'device = "{described}"', hinges=True, tail=tail))


NO_FRICTION = '{}_coulomb = {{ value = 0, unit = "N m", source = "derived", note = "measured" }}\n'


@pytest.mark.parametrize(
    ("rows", "lacking"),
    [
        ('knee_coulomb = { value = 1.5, unit = "N m" }\n', "exo_ankle, exo_hip"),
        ("".join(NO_FRICTION.format(hinge) for hinge in ("ankle", "knee", "hip")), None),
        ("", "exo_ankle, exo_knee, exo_hip"),
    ],
)
def test_hinges_without_friction_are_named(tmp_path: Path, rows: str, lacking: str | None) -> None:
    (tmp_path / "mine.toml").write_text(f"[numbers]\n{rows}")
    _, warned = read(study_of(tmp_path, 'mode = "passive"', 'device = "mine.toml"'))
    said = [line for line in warned if "friction" in line]
    assert len(said) == (lacking is not None)
    assert lacking is None or f"hinges without friction ({lacking})" in said[0]


@pytest.mark.parametrize(
    ("trial", "head", "hinges", "said"),
    [
        ("", "", True, "T1_torques.sto has torques of the hinges, friction included"),
        ("", 'tracks = ["coordinates", "rates", "force", "centre", "strap"]', False, "torque is not among tracks"),
        ('mode = "passive"', "", False, None),
    ],
)
def test_friction_without_effect_is_warned_of(
    tmp_path: Path, described: Path, trial: str, head: str, hinges: bool, said: str | None
) -> None:
    _, warned = read(study_of(tmp_path, trial, f'device = "{described}"\n{head}', hinges=hinges))
    found = [line for line in warned if "has no effect" in line]
    assert len(found) == (said is not None)
    assert said is None or ("T1: friction" in found[0] and "(knee_coulomb)" in found[0] and said in found[0])


def test_sources_of_places_and_dashpots_are_those_of_the_description(tmp_path: Path) -> None:
    """Of each number its own source: the thigh's mass centre is invented, its inertia is not."""
    (tmp_path / "mine.toml").write_text(
        '[numbers]\nshank_length = { value = 460, unit = "mm", source = "paper", note = "sheet" }\n'
        'thigh_centre = { value = 0.15, unit = "m" }\n'
        'thigh_inertia = { value = 0.05, unit = "kg m^2", source = "derived", note = "swung" }\n'
        'strap_damping = { value = 25, unit = "N s/m", source = "derived", note = "pulled" }\n'
    )
    given, _ = read(study_of(tmp_path, "", 'device = "mine.toml"', hinges=True))
    rows = {row.number: row for row in model_numbers(strapped(given.subject, given.sites))}
    at = {name: (row.source, "sheet" in row.note) for name, row in rows.items()}
    assert at["joint exo_knee y"] == ("paper", True) and rows["joint exo_knee y"].value == 0.46
    assert at["joint exo_hip y"] == at["strap at the thigh above"] == ("derived", True)
    assert at["joint exo_ankle y"] == at["joint exo_knee x"] == ("invented", False)
    assert rows["body exo_thigh centre_y"].source == rows["body exo_thigh centre_x"].source == "invented"
    assert rows["body exo_thigh inertia"].source == "derived" and "swung" in rows["body exo_thigh inertia"].note
    assert rows["strap at the thigh damping"].source == "derived"
    assert rows["strap at the thigh damping"].note.endswith("derived, pulled")
    found = gc.sit_to_stand.device(ALONE[0], motors=ALONE[1], device=tmp_path / "mine.toml").table("numbers")
    sources = dict(zip(found["number"], found["source"], strict=True))
    assert sources["joint exo_knee y"] == "paper" and sources["joint exo_hip y"] == "derived"
    (tmp_path / "mine.toml").write_text('[numbers]\nknee_above = { value = 25, unit = "mm", source = "paper" }\n')
    given, _ = read(study_of(tmp_path, "", 'device = "mine.toml"', hinges=True))
    rows = {row.number: row for row in model_numbers(strapped(given.subject, given.sites))}
    assert rows["strap at the thigh above"].source == rows["joint exo_knee y"].source == "derived"
