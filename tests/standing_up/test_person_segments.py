"""Whose segments stand up: the tables beside de Leva's own, own values in the chain, and a study that has them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import geocontact as gc
from geocontact.analyses.sit_to_stand.standing_trials import standing_trials
from geocontact.data.body_segments import SEGMENTS, STATURE
from geocontact.dynamics.inverse_dynamics import generalised_forces
from geocontact.dynamics.tree import tree_of
from geocontact.standing_up.chain import Subject, leg_chain
from geocontact.standing_up.person_segments import SHARES

STUDY = Path(__file__).resolve().parents[2] / "meshes" / "standing_up" / "study.toml"
TO_ANKLE = {"male": 0.4403, "female": 0.4386}
TO_NECK = {"male": 0.6033, "female": 0.6148}
"""De Leva's table 4: knee to the ankle's centre, and hips to the seventh cervical vertebra [m]."""


@pytest.mark.parametrize("sex", ["male", "female"])
def test_legs_are_those_of_the_table(sex: str) -> None:
    table, own, tall = SEGMENTS[sex], SHARES[sex], STATURE[sex]
    for name in ("foot", "shank", "thigh"):
        assert own[name].mass == 2 * table[name].mass
    # the women's shank is of the row to the ankle's centre, the men's of that to the malleolus
    shorter = table["shank"].length / TO_ANKLE[sex] if sex == "female" else 1.0
    for name, share in (("foot", 1.0), ("shank", shorter), ("thigh", 1.0)):
        assert own[name].gyration == pytest.approx(share * table[name].radii[1], abs=3e-4 if share < 1.0 else 1e-12)
    assert own["thigh"].centre == pytest.approx(1.0 - table["thigh"].centre)
    assert own["shank"].centre == pytest.approx(1.0 - shorter * table["shank"].centre, abs=6e-5)
    assert own["foot"].centre == pytest.approx(table["foot"].centre - 0.24, abs=0.002)  # the ankle over the heel
    lengths = {"foot": table["foot"].length, "shank": TO_ANKLE[sex], "thigh": table["thigh"].length}
    for name, length in lengths.items():
        assert own[name].length == pytest.approx(length / tall, abs=6e-5)


@pytest.mark.parametrize("sex", ["male", "female"])
def test_upper_body_is_the_sum_of_its_parts(sex: str) -> None:
    """Trunk, head and hanging arms over the hips, parallel axes added; the men's radius is 0.44 for 0.37."""
    table, tall = SEGMENTS[sex], STATURE[sex]
    hips = table["thigh"].length + TO_ANKLE[sex] + 0.039 * tall
    at, parts = 0.818 * tall - hips, []
    for name in ("upper_arm", "forearm", "hand"):
        parts.append((2 * table[name].mass, at - table[name].centre * table[name].length, name))
        at -= table[name].length
    parts.append((table["trunk"].mass, (1.0 - table["trunk"].centre) * table["trunk"].length, "trunk"))
    parts.append((table["head"].mass, tall - hips - table["head"].centre * table["head"].length, "head"))
    mass = sum(m for m, _, _ in parts)
    centre = sum(m * z for m, z, _ in parts) / mass
    square = sum(m * ((table[n].radii[1] * table[n].length) ** 2 + (z - centre) ** 2) for m, z, n in parts) / mass
    own, long = SHARES[sex]["trunk"], TO_NECK[sex]
    assert own.mass == pytest.approx(mass, abs=5e-4) and own.length == pytest.approx(long / tall, abs=6e-5)
    assert own.centre == pytest.approx(centre / long, abs=0.006)
    assert own.gyration == pytest.approx(np.sqrt(square) / long, abs=0.08 if sex == "male" else 0.006)


OWN = {
    "foot": {"mass": 0.8, "centre": 0.04},
    "shank": {"mass": 2.5, "length": 0.35, "centre": 0.2, "gyration": 0.09},
    "thigh": {"mass": 7.0, "length": 0.38},
    "trunk": {"centre": 0.3, "gyration": 0.25},
}


def test_own_values_hold_a_leaning_chain() -> None:
    """Torques at rest by the weights of three bodies beside their joints, written out."""
    from casadi import Function

    person = Subject(50.0, 1.6, sex="female", own=OWN)
    tree = tree_of(leg_chain(person))
    q = np.array([0.1, 0.09, 0.0, -0.3, 0.7, -0.6])
    forces = Function("f", [tree.q, tree.u, tree.a], [generalised_forces(tree)])
    found = forces(q, np.zeros(6), np.zeros(6)).full()[:, 0]
    thigh = 1.0 - 0.3612
    lean = np.cumsum(q[3:])
    knee = -0.35 * np.sin(lean[0])
    hip = knee - 0.38 * np.sin(lean[1])
    masses = 5.0, 14.0, 50.0 - 1.6 - 5.0 - 14.0
    at = (-0.2 * np.sin(lean[0]), knee - thigh * 0.38 * np.sin(lean[1]), hip - 0.3 * np.sin(lean[2]))
    weights = [9.81 * m * x for m, x in zip(masses, at, strict=True)]
    ankle = sum(weights)
    at_knee = sum(w - 9.81 * m * knee for w, m in zip(weights[1:], masses[1:], strict=True))
    at_hip = weights[2] - 9.81 * masses[2] * hip
    np.testing.assert_allclose(found[3:], [ankle, at_knee, at_hip], rtol=1e-10)
    assert found[2] == pytest.approx(ankle + 9.81 * 1.6 * 0.04, rel=1e-10)
    trunk = next(body for body in leg_chain(person).bodies if body.name == "trunk")
    assert trunk.inertia[2, 2] == pytest.approx(masses[2] * 0.25**2)


def study_with(folder: Path, person: str) -> Path:
    text = STUDY.read_text(encoding="utf-8")
    head, *trials = text.split("[[trials]]")
    for line in trials[0].splitlines():
        name = line.partition('"')[2].rstrip('"')
        if (STUDY.parent / name).is_file() and name:
            (folder / name).write_bytes((STUDY.parent / name).read_bytes())
    file = folder / "study.toml"
    file.write_text(f"{head}{person}\n[[trials]]{trials[0]}", encoding="utf-8")
    return file


@pytest.mark.filterwarnings("ignore::geocontact.InputWarning")
def test_a_study_says_whose_segments_they_are(tmp_path: Path) -> None:
    text = '[person]\nsex = "female"\n[person.shank]\nlength = { value = 39.5, unit = "cm" }\n'
    subject = standing_trials(study_with(tmp_path, text), "study").subject
    height = subject.height
    assert subject.segments["shank"].length == 0.395
    assert subject.segments["thigh"].length == pytest.approx(0.2124 * height)
    text = '[person.thigh]\nmass = { value = 30, unit = "kg" }\n[person.trunk]\nmass = { value = 30, unit = "kg" }\n'
    with pytest.raises(gc.InputError, match=r"study\.toml \[person\]: both legs have .* check their sum"):
        standing_trials(study_with(tmp_path, text), "study")


def test_a_person_with_own_segments_can_be_looked_up() -> None:
    """Equations of a person are kept, by the person: others with the same mass and height are others."""
    one, other = (Subject(50.0, 1.6, own=own) for own in (OWN, {}))
    assert len({one: 1, other: 2, Subject(50.0, 1.6, own=dict(OWN)): 3}) == 2


JENSEN = {"head": 14.15, "trunk": 42.35, "upper_arm": 2.8, "forearm": 1.5, "hand": 0.85, "thigh": 9.75, "shank": 4.95}
"""Half-way between the printed percentages at 6 and 12 years, both of which sum up to 100.2."""


def test_a_child_of_9_years_by_hand() -> None:
    """Legs by the shares of boys; a head of 14 % moves the mass centre over the hips up by 7 % of the trunk."""
    share = {name: value / 100.2 for name, value in JENSEN.items()}
    child = Subject(30.0, 1.35, age=9.0).segments
    assert child["thigh"].mass == pytest.approx(2 * 30.0 * share["thigh"], rel=1e-12)
    assert child["shank"].mass == pytest.approx(2 * 30.0 * share["shank"], rel=1e-12)
    assert sum(each.mass for each in child.values()) == pytest.approx(30.0, rel=1e-12)
    table, tall = SEGMENTS["male"], STATURE["male"]
    hips = tall * (0.2425 + 0.2529 + 0.039)
    at = {"trunk": (1.0 - 0.4486) * 0.5319, "head": tall - hips - 0.5976 * 0.2033}
    arm = 0.818 * tall - hips
    at |= {
        "upper_arm": arm - 0.5772 * 0.2817,
        "forearm": arm - 0.2817 - 0.4574 * 0.2689,
        "hand": arm - 0.2817 - 0.2689 - 0.79 * 0.0862,
    }
    mass = {name: (1 if name in ("trunk", "head") else 2) * share[name] for name in at}
    whole = sum(mass.values())
    centre = sum(mass[name] * at[name] for name in at) / whole
    turning = sum(mass[n] * ((table[n].radii[1] * table[n].length) ** 2 + (at[n] - centre) ** 2) for n in at) / whole
    long = 0.3465 * tall
    assert child["trunk"].centre / child["trunk"].length == pytest.approx(centre / long, rel=1e-12)
    assert child["trunk"].gyration / child["trunk"].length == pytest.approx(np.sqrt(turning) / long, rel=1e-12)
    assert centre / long - SHARES["male"]["trunk"].centre == pytest.approx(0.07, abs=0.01)
    assert Subject(30.0, 1.35, age=30.0).segments == Subject(30.0, 1.35).segments


def test_a_study_of_a_child_says_what_its_masses_are(tmp_path: Path) -> None:
    text = '[person]\nsex = "female"\nage = { value = 12, unit = "years" }\n'
    file = study_with(tmp_path, text)
    with pytest.warns(
        gc.InputWarning, match=r"\[person\] age: masses of segments of boys of 12 years .* girls as well"
    ):
        subject = standing_trials(file, "study").subject
    assert subject.segments["foot"].mass == pytest.approx(2 * subject.mass * 2.1 / 100.2)
    file.write_text(file.read_text().replace('value = 12, unit = "years"', 'value = 5, unit = "years"'))
    with pytest.raises(gc.InputError, match=r"\[person\] age: 5 years cannot be .* 6 to 110 years"):
        standing_trials(file, "study")
