"""De Leva's table: shares that make a whole body, and radii that a body can have."""

from __future__ import annotations

import pytest

from geocontact.data.body_segments import SEGMENTS, STATURE, Sex


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
