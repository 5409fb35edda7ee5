"""The explicit model of the elbow against geometry built from points and lines, and against the printed equations."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from geocontact.analyses.misalignment.simulate.trials import surfaces
from geocontact.axis_misalignment.compensation import taken_up
from geocontact.axis_misalignment.explicit import ELBOW_GEOMETRY, Offsets, constraint_force, displacement, pole_angles

FIG5 = {"l": 0.2, "z": 0.08}
shifts = st.floats(-0.11, 0.11)


def constructed(beta: float, l: float, z: float, x: float, y: float) -> dict[str, float]:
    """The same by points and lines.

    The joint is the origin; the exoskeleton's axis stands at (-x, y), its link is a stick turned by beta. The limb runs
    from the joint through the link's end. The cuff is held at right angles to the link; where its line meets the
    limb's parallel at a distance z, it has gone back along the limb by the rotary part.
    """
    axis = np.array([-x, y])
    turn = np.array([[np.cos(beta), np.sin(beta)], [-np.sin(beta), np.cos(beta)]])
    end = axis + turn @ np.array([0.0, l])
    stretched = np.array([0.0, y + np.sqrt(l * l - x * x)])
    limb, link = end / np.linalg.norm(end), (end - axis) / l
    beside_limb, beside_link = np.array([limb[1], -limb[0]]), np.array([link[1], -link[0]])
    _, along = np.linalg.solve(np.column_stack([beside_link, -limb]), z * beside_limb)
    alpha = np.arctan2(limb[0], limb[1])
    return {"alpha": alpha, "gamma": beta - alpha, "linear": stretched[1] - np.linalg.norm(end),
            "rotary": -along}  # fmt: skip


@given(st.floats(0.0, 2.4), shifts, shifts, st.floats(0.15, 0.25), st.floats(-0.13, 0.13))
def test_every_quantity_is_that_of_points_and_lines(beta: float, x: float, y: float, l: float, z: float) -> None:
    assume(l + y * np.cos(beta) - x * np.sin(beta) > 0.02)
    want = constructed(beta, l, z, x, y)
    got = displacement(np.array([beta]), Offsets(l, z, x, y))
    for name, value in want.items():
        scale = 1.0 + abs(z) / (l + y * np.cos(beta) - x * np.sin(beta))
        assert getattr(got, name)[0] == pytest.approx(value, abs=1e-12 * scale**2), name
    assert got.total[0] == pytest.approx(want["linear"] - want["rotary"], abs=1e-11)


@given(st.floats(0.02, 1.5), st.floats(0.005, 0.09), st.floats(0.005, 0.09))
def test_linear_part_is_eq_16_put_right(beta: float, x: float, y: float) -> None:
    """y outside of the root and the cosecant squared, where arctan(x/y) and the arccosine are unambiguous."""
    l = 0.2
    c, angle = np.hypot(x, y), beta + np.arctan(x / y)
    nabla = np.sqrt(l**2 + c**2 + 2.0 * l * c * np.cos(angle))
    csc = 1.0 / np.sin(beta + np.arccos(np.clip(c * np.sin(angle) / nabla, -1.0, 1.0)))
    assume(abs(y + l * np.cos(beta)) > 1e-3 and abs(1.0 / csc) > 1e-3)
    printed = l * np.sqrt(1.0 - x**2 / l**2) + y - np.sqrt((y + l * np.cos(beta)) ** 2 * csc**2)
    got = displacement(np.array([beta]), Offsets(l, 0.0, x, y)).linear[0]
    assert got == pytest.approx(printed, abs=1e-12 * max(1.0, csc**2))


def test_a_pure_y_offset_of_ten_centimetres() -> None:
    """The "about 15 cm" of the text are d_lin; d_tot, which its Fig. 5 shows, is 109 mm."""
    got = displacement(np.array([0.75 * np.pi]), Offsets(x=0.0, y=0.1, **FIG5))
    assert round(got.linear[0], 3) == 0.153 and round(got.total[0], 3) == 0.109


def test_surfaces_hold_the_values_of_the_figure() -> None:
    s = surfaces(**FIG5)
    k = int(np.argmin(np.abs(s.offset - 0.1)))
    there = displacement(s.angle, Offsets(x=0.0, y=float(s.offset[k]), **FIG5))
    np.testing.assert_array_equal(s.over_y[k], there.total)
    middle = len(s.offset) // 2
    np.testing.assert_allclose([s.over_x[middle], s.over_y[middle]], 0.0, atol=1e-15)
    assert np.isfinite([s.over_x, s.over_y]).all() and s.offset[0] == -s.offset[-1]
    table = s.table()
    row = table[(table["beta [deg]"] == 135.0) & np.isclose(table["offset [mm]"], s.offset[k] * 1e3)]
    assert row["d_lin over y [mm]"].item() == pytest.approx(there.linear[-1] * 1e3)


@given(st.floats(0.0, 2.0), shifts, shifts, st.floats(0.3, 3.0))
def test_one_factor_scales_lengths_and_stiffness_away(beta: float, x: float, y: float, s: float) -> None:
    assume(0.2 + y * np.cos(beta) - x * np.sin(beta) > 0.02)
    at, rate = np.array([beta]), np.array([0.7])
    one = constraint_force(at, rate, Offsets(0.2, 0.08, x, y), 222.0, 3.0)
    other = constraint_force(at, rate, Offsets(0.2 * s, 0.08 * s, x * s, y * s), 222.0 / s, 3.0 / s)
    np.testing.assert_allclose(other, one, rtol=1e-9, atol=1e-12)


def test_damping_is_force_per_rate() -> None:
    time = np.linspace(0.0, 2.0, 4001)
    beta = 1.0 + 0.7 * np.sin(2.0 * time)
    offsets = Offsets(0.17, 0.1, 0.03, -0.04)
    rate = np.gradient(displacement(beta, offsets).total, time)
    got = constraint_force(beta, 1.4 * np.cos(2.0 * time), offsets, 0.0, 5.0)
    np.testing.assert_allclose(got[5:-5], 5.0 * rate[5:-5], atol=1e-5)


def test_without_z_the_stretched_limb_is_free_of_force() -> None:
    """The paper found forces at small angles to vanish without z: they do where the limb is stretched, sin β = x/l.

    At β = 0 they fall to less than a third with its numbers, and no farther.
    """
    offsets = {"x": 0.048, "y": 0.059, "l": 0.169}
    at = np.array([0.0, np.arcsin(0.048 / 0.169)])
    with_z, without = (displacement(at, Offsets(z=z, **offsets)) for z in (0.127, 0.0))
    assert without.total[1] == pytest.approx(0.0, abs=1e-15) and without.alpha[1] == pytest.approx(0.0, abs=1e-15)
    assert round(with_z.total[0], 4) == -0.0387 and round(without.total[0], 4) == -0.0120


def test_a_fold_is_named_with_both_lengths() -> None:
    with pytest.raises(ValueError, match=r"\|x\| = 210 mm is more than the link's l = 200 mm"):
        displacement(np.array([0.5]), Offsets(x=-0.21, y=0.0, **FIG5))
    with pytest.raises(ValueError, match="length is -1 mm"):
        constraint_force(np.array([0.5]), np.zeros(1), Offsets(-1e-3, 0.0, 0.0, 0.0), 1.0)


@given(st.floats(-0.19, 0.19), st.floats(-0.4, 0.4))
def test_poles_are_where_the_denominator_vanishes(x: float, y: float) -> None:
    offsets = Offsets(x=x, y=y, **FIG5)
    poles = pole_angles(offsets)
    assert bool(poles) == (np.hypot(x, y) >= 0.2)
    for pole in poles:
        assert 0.2 + y * np.cos(pole) - x * np.sin(pole) == pytest.approx(0.0, abs=1e-12)


def test_a_pole_is_named_with_angle_and_offsets() -> None:
    offsets = Offsets(x=0.15, y=0.16, **FIG5)
    (pole,) = [p for p in pole_angles(offsets) if p > 0.0][:1]
    assert np.isfinite(displacement(np.linspace(0.0, pole - 0.05, 50), offsets).total).all()
    said = (
        rf"a pole at {np.degrees(pole):.4g} degrees, reached or passed at [\d.]+, with l = 200 mm, x = 150 mm, y = 160"
    )
    with pytest.raises(ValueError, match=said):
        displacement(np.linspace(0.0, 2.5, 200), offsets)
    near = Offsets(x=0.0, y=0.1999, **FIG5)
    with pytest.raises(ValueError, match=r"comes within 0\.1% of a pole at 17\d"):
        displacement(np.linspace(0.0, np.pi, 200), near)


def test_numbers_stand_where_the_kernel_reads_them() -> None:
    assert tuple(ELBOW_GEOMETRY.neutral)[:4] == ("l", "z", "x", "y")
    np.testing.assert_array_equal(Offsets(1.0, 2.0, 3.0, 4.0).numbers[:4], [1.0, 2.0, 3.0, 4.0])


def test_a_joint_takes_up_what_its_stroke_allows() -> None:
    moved, left = taken_up(np.array([-0.03, -0.01, 0.0, 0.02, 0.05]), (-0.01, 0.03))
    np.testing.assert_allclose(moved, [-0.01, -0.01, 0.0, 0.02, 0.03])
    np.testing.assert_allclose(left, [-0.02, 0.0, 0.0, 0.0, 0.02])
    with pytest.raises(ValueError, match="from 10 to -10 mm ends before it begins"):
        taken_up(np.zeros(1), (0.01, -0.01))
