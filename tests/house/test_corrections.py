"""Figures in the rows of the page of corrections are those of the code, as far as they can be computed in a moment."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

from geocontact.axis_misalignment.explicit import Offsets, displacement
from geocontact.axis_misalignment.synthetic import PAPER
from geocontact.below_knee_prosthesis.keel.keel import tip_compliance
from geocontact.below_knee_prosthesis.keel.sections import SUPPORTS
from geocontact.contact.area_hertz import disc_force
from geocontact.contact.bushing import PRINTED, SOCKET
from geocontact.contact.smooth_half_space import half_space_force
from geocontact.shoulder_exoskeleton.device import lucy, lucy_new_cylinder
from tests.house.first_screens import ROOT

PAGE = (ROOT / "docs" / "theory" / "corrections.md").read_text(encoding="utf-8")
SIX_BAR = 6e5
BEAM = 0.229  # m
ENDS = ((0.066, 10e3), (0.151, 32e3))
"""Fulcrum [m] and measured stiffness [N/m] at either end of its travel."""


def told(*figures: str) -> None:
    """One row of the page has them all."""
    assert any(all(each in row for each in figures) for row in PAGE.splitlines() if row.startswith("|")), figures


def test_force_of_a_whole_implant() -> None:
    force = disc_force(1100e-6, 37e-3, 4.67e9 / (1.0 - 0.25**2))
    told("4.67 GPa on 1100 mm² and 37 mm", f"{force / 1e6:.1f} MN")


def test_displacements_of_the_elbow() -> None:
    found = displacement(np.radians([135.0]), Offsets(l=0.2, z=0.08, x=0.0, y=0.1))
    told(f"d_lin is {1e3 * found.linear[0]:.0f} mm", f"d_tot {1e3 * found.total[0]:.0f} mm")


def test_lengths_and_stiffness_of_the_elbow_are_one_number() -> None:
    told("F(k/s, s x, s y, s l, s z) = F exactly")
    beta, s = np.radians(np.linspace(5.0, 120.0, 50)), 1.7
    length = {name: PAPER[name] for name in "lzxy"}
    longer = {name: s * value for name, value in length.items()}
    force = PAPER["k"] * displacement(beta, Offsets(**length)).total
    same = PAPER["k"] / s * displacement(beta, Offsets(**longer)).total
    np.testing.assert_allclose(same, force, rtol=1e-13, atol=1e-13)


def test_bins() -> None:
    told("42 bins of 2° over 0 to π", f"42 bins of 2° are {42 * 2}°")


def test_bores_and_lever_of_the_shoulder() -> None:
    thin, wide = (device.numbers["bore"].value for device in (lucy(), lucy_new_cylinder()))
    forces = [SIX_BAR * pi / 4.0 * bore**2 for bore in (wide, thin)]
    lever = lucy().numbers["lever_a"].value
    torques = [f"{force * lever:.1f}" for force in forces]
    assert forces[0] == pytest.approx(482.0, abs=1.0)
    told("482 N at 6 bar", f"{torques[1]} and {torques[0]} N m", f"one lever of {1e3 * lever:g} mm")
    told(f"bores of {1e3 * wide:g} and {1e3 * thin:g} mm", f"= {(thin / wide) ** 2:.3f}, 7.8/12.8 = {7.8 / 12.8:.3f}")


def test_length_of_the_keel() -> None:
    told("66 mm and 15 of 11.64 mm, 229 mm in all", f"16 segments are {66 + 15 * 11.64:.1f} mm")


def test_rotation_of_the_socket() -> None:
    told(f"turns by {50.0 / PRINTED.stiffness[0]:.0f} rad under 50 N m")
    degree = pi / 180.0
    told(f"{SOCKET.stiffness[0] * degree:g} N m/deg and {SOCKET.damping[0] * degree:g} N m s/deg")


def test_ratio_of_the_ends_of_a_beam() -> None:
    (first, soft), (last, stiff) = ENDS
    ratios = sorted(tip_compliance(first, BEAM, 1.0, each) / tip_compliance(last, BEAM, 1.0, each) for each in SUPPORTS)
    told(f"a ratio of {ratios[0]:.1f} to {ratios[-1]:.1f} between the ends, {stiff / soft:g} is measured")


def test_stiffness_of_the_smooth_half_space() -> None:
    told("k = K^(2/3)/2")
    modulus, radius, depth = 3e6, 0.03, 5e-3
    k = modulus ** (2.0 / 3.0) / 2.0
    force = half_space_force(depth, 0.0, modulus, radius, c=1.0, b_d=1e5, b_v=1e3, constant=0.0)
    assert force == pytest.approx(4.0 / 3.0 * k * np.sqrt(radius * k) * depth**1.5, rel=1e-12)
