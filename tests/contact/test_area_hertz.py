"""Readings of the area-integrated law: each undoes its own closed form, and what each makes of the paper's numbers."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from geocontact.contact.area_hertz import (
    READINGS,
    PatchGeometry,
    Reading,
    cap_force,
    disc_force,
    discs_force,
    strip_force,
    threshold_force,
)
from geocontact.contact.elasticity import plane_modulus
from geocontact.contact.hertz import line_half_width, point_force, point_radius
from tests.closed_forms import sphere_plane_on_sphere

R = 37e-3
PAPER = PatchGeometry(radius=R, length=60e-3, threshold=4e-3)
PAGE = Path(__file__).resolve().parents[2] / "docs" / "theory" / "contact_laws.md"
readings = pytest.mark.parametrize("reading", READINGS, ids=lambda r: r.name)
forces, moduli = st.floats(1.0, 1e4), st.floats(1e6, 1e11)


@given(forces, moduli)
def test_disc_undoes_the_hertzian_circle(force: float, modulus: float) -> None:
    a = point_radius(force, R, modulus)
    assert disc_force(np.pi * a**2, R, modulus) == pytest.approx(force, rel=1e-12)
    assert discs_force(2.0 * np.pi * a**2, R, modulus) == pytest.approx(2.0 * force, rel=1e-12)


@given(forces, moduli)
def test_strip_undoes_the_hertzian_strip(force: float, modulus: float) -> None:
    b = line_half_width(force / PAPER.length, R, modulus)
    assert strip_force(2.0 * b * PAPER.length, R, modulus, PAPER.length) == pytest.approx(force, rel=1e-12)


@given(st.floats(1e-6, 2e-3), st.floats(0.0, 5e-3), moduli)
def test_caps_undo_the_area_of_a_rigid_sphere(depth: float, threshold: float, modulus: float) -> None:
    force = point_force(depth, R, modulus)
    assert cap_force(sphere_plane_on_sphere(R, -depth, 0.0), R, modulus) == pytest.approx(force, rel=1e-9)
    area = sphere_plane_on_sphere(R, -depth, threshold)
    assert threshold_force(area, R, modulus, threshold) == pytest.approx(force, rel=1e-8)


def test_a_sphere_that_only_touches_carries_nothing_in_one_reading_alone() -> None:
    area = sphere_plane_on_sphere(R, 0.0, PAPER.threshold)
    seen = {r.name: float(r.force(0.999 * area, PAPER, 1e9)) > 0.0 for r in READINGS}
    assert seen == {"disc": True, "discs": True, "strip": True, "cap": True, "threshold": False}


@readings
def test_force_is_proportional_to_the_modulus_alone(reading: Reading) -> None:
    """(E, nu) pairs with one E* give one force: they cannot be told apart."""
    pairs = [(E, np.sqrt(1.0 - E / 5e9)) for E in (3e9, 4e9, 4.9e9)]
    forces = [float(reading.force(1.1e-3, PAPER, plane_modulus(E, nu))) for E, nu in pairs]
    assert forces == pytest.approx([forces[0]] * 3, rel=1e-14)
    assert reading.modulus(1.1e-3, forces[0], PAPER) == pytest.approx(5e9, rel=1e-12)


@readings
def test_power_of_the_area_is_as_told(reading: Reading) -> None:
    touching = 2.0 * np.pi * R * PAPER.threshold if reading.name == "threshold" else 0.0
    ratio = reading.force(touching + 2e-4, PAPER, 1.0) / reading.force(touching + 1e-4, PAPER, 1.0)
    assert np.log2(ratio) == pytest.approx(reading.power, rel=1e-9)


@readings
def test_no_area_no_force(reading: Reading) -> None:
    assert reading.force(0.0, PAPER, 1e9) == 0.0
    assert reading.modulus(0.0, 1600.0, PAPER) == np.inf


@readings
def test_the_page_tells_what_each_reading_implies(reading: Reading) -> None:
    """E* for 1601 N on 1100 mm^2, and the force of the paper's 4.67 GPa and 0.25."""
    rows = re.findall(rf"^\| `{reading.name}` \|.*\| (\S+) MPa \| (\S+) N \|$", PAGE.read_text("utf-8"), re.MULTILINE)
    assert len(rows) == 1
    modulus, force = map(float, rows[0])
    assert modulus == pytest.approx(reading.modulus(1.1e-3, 1601.0, PAPER) * 1e-6, rel=0.006)
    assert force == pytest.approx(float(reading.force(1.1e-3, PAPER, plane_modulus(4.67e9, 0.25))), rel=0.006)
