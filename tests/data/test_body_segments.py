"""De Leva's table: shares that make a whole body, and radii that a body can have."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.data.body_segments import SEGMENTS, STATURE, Sex, body_segments


@pytest.mark.parametrize("sex", ["female", "male"])
def test_masses_add_up_to_a_body(sex: Sex) -> None:
    """To the last digit printed: 99.99 % of a woman, 100 % of a man."""
    once = sum(SEGMENTS[sex][name].mass for name in ("head", "trunk"))
    twice = sum(each.mass for name, each in SEGMENTS[sex].items() if name not in ("head", "trunk"))
    assert once + 2.0 * twice == pytest.approx({"female": 0.9999, "male": 1.0}[sex], abs=1e-12)


@pytest.mark.parametrize("sex", ["female", "male"])
def test_moments_of_inertia_are_those_of_bodies(sex: Sex) -> None:
    """No principal moment exceeds the sum of the other two, and the centre lies within."""
    for name, segment in SEGMENTS[sex].items():
        moments = segment.moments(2.0, 0.3)
        assert max(moments) < sum(moments) - max(moments), name
        assert moments[0] == pytest.approx(2.0 * (0.3 * segment.radii[0]) ** 2)
        assert 0.3 < segment.centre < 0.8, name


def test_lengths_make_the_stature() -> None:
    """Head, trunk, thigh, shank: what is missing is neck and foot, what is too much is where segments overlap."""
    for sex, rows in SEGMENTS.items():
        height = sum(rows[name].length for name in ("head", "trunk", "thigh", "shank"))
        assert 0.88 < height / STATURE[sex] < 0.93


PRINTED = {
    6: (18.2, 43.0, 2.4, 1.3, 0.8, 8.5, 4.6, 1.9),
    12: (10.1, 41.7, 3.2, 1.7, 0.9, 11.0, 5.3, 2.1),
    15: (6.7, 41.6, 3.5, 1.7, 0.8, 12.1, 5.6, 2.1),
}
"""Head with neck, trunk, upper arm, forearm, hand, thigh, leg, foot at these ages [%], as the public table has them."""
NAMES = ("head", "trunk", "upper_arm", "forearm", "hand", "thigh", "shank", "foot")
SIDES = np.array([1, 1, 2, 2, 2, 2, 2, 2])


@pytest.mark.parametrize("age", [6.0, 7.3, 12.0, 13.9, 15.0, 17.99])
def test_a_child_is_a_whole_body(age: float) -> None:
    """Masses by interpolation of the printed percentages, each set of which is scaled to 100; the rest of an adult."""
    child = body_segments("female", age)
    assert child.whole == pytest.approx(1.0, abs=1e-12) and child.age == age and "boys" in child.source
    if age <= 15.0:
        rows = np.array([np.array(row) / (SIDES @ row) for row in PRINTED.values()])
        for name, column in zip(NAMES, rows.T, strict=True):
            assert child[name].mass == pytest.approx(np.interp(age, list(PRINTED), column), rel=1e-12)
    for name in NAMES:
        adult = SEGMENTS["female"][name]
        assert (child[name].centre, child[name].radii, child[name].length) == (adult.centre, adult.radii, adult.length)


def test_the_head_of_children_beside_the_line_of_the_second_paper() -> None:
    """Within the difference of both papers that the module states."""
    ages = np.linspace(6.0, 17.9, 40)
    own = np.array([body_segments("male", float(age))["head"].mass for age in ages])
    off = own - (0.27881 - 0.021152 * ages + 0.00053168 * ages**2)
    assert off.max() == pytest.approx(0.012, abs=2e-3) and off.min() == pytest.approx(-0.0145, abs=1.5e-3)


def test_adults_are_the_table_itself() -> None:
    for sex in ("female", "male"):
        for age in (None, 18.0, 70.0):
            body = body_segments(sex, age, mass=60.0, height=1.7)
            assert body.rows is SEGMENTS[sex] and body.stature == STATURE[sex] and body.source == "de Leva 1996"
    with pytest.raises(ValueError, match="known from 6 years on, not at 5"):
        body_segments("male", 5.0)


def test_own_values_replace_the_table() -> None:
    own = {"shank": {"mass": 2.0, "length": 0.35, "centre": 0.15, "gyration": 0.1}, "hand": {"mass": 0.3}}
    body = body_segments("male", mass=50.0, height=1.6, own=own)
    table = SEGMENTS["male"]
    assert body["shank"].mass == 0.04 and body["shank"].length == 0.35
    assert body["shank"].centre == pytest.approx(0.15 / 0.35)
    sagittal, transverse, long = body["shank"].moments(2.0, 0.35)
    assert sagittal == transverse == pytest.approx(2.0 * 0.1**2) and long == table["shank"].moments(2.0, 0.35)[2]
    assert body["thigh"].length == pytest.approx(0.4222 * 1.6 / 1.741) and body["thigh"].mass == table["thigh"].mass
    lost = 2 * (0.0433 - 0.04) + 2 * (0.0061 - 0.3 / 50.0)
    assert body["trunk"].mass == pytest.approx(0.4346 + lost) and body.whole == pytest.approx(1.0, abs=1e-12)
    assert body.own == ("hand", "shank") and len({body: 1, body_segments("male"): 2}) == 2
    with pytest.raises(ValueError, match="mass of the body"):
        body_segments("male", own=own)
    with pytest.raises(ValueError, match="needs its length"):
        body_segments("male", mass=50.0, own={"foot": {"centre": 0.1}})
