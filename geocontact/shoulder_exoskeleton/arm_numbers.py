"""Numbers of a device, adjusted to its wearer, in the order in which the equations of an arm read them."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from jaxtyping import Float

from geocontact.shoulder_exoskeleton.device import JOINTS, Device, Wearer, piston_area

BODIES = ("link_1", "link_2", "arm")
SIZES: dict[str, int] = {
    "base": 3,
    "link_1": 3,
    "link_2": 3,
    "cuff": 3,
    "masses": 3,
    "centres": 9,
    "inertias": 18,
    "lower": 3,
    "upper": 3,
    "stop": 3,
    "damping": 3,
    "push": 1,
    "lag": 1,
    "lever": 3,
    "law": 8,
    "seal": 2,
    "padded": 9,
}
"""Groups of numbers, and how many each has."""
PADDED = (
    "cuff_radius",
    "cuff_length",
    "pad_thickness",
    "pad_modulus",
    "tissue_thickness",
    "tissue_modulus",
    "interference",
    "pad_damping",
    "delta_full",
)
"""Numbers of a cuff that holds the arm by its surface."""
COLUMN = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)]
"""Entries of a symmetric matrix that are kept."""


def slices() -> dict[str, slice]:
    """Where each group is."""
    ends = np.cumsum([0, *SIZES.values()])
    return {name: slice(int(a), int(b)) for name, (a, b) in zip(SIZES, pairwise(ends), strict=True)}


def adjusted_numbers(device: Device, wearer: Wearer, level: float) -> Float[np.ndarray, " p"]:
    """Numbers of a right arm, in SI.

    Parameters
    ----------
    level
        Share of the cylinder's force, 0 to 1.
    """
    d = device
    links = [d.link(1), d.link(2)]
    rods = [_rod(d[f"link_{k}_mass"], link) for k, link in enumerate(links, start=1)]
    masses, centres, inertias = zip(*rods, _arm(d), strict=True)
    groups = {
        "base": [-d["bar_share"] * wearer.shoulder_width, 0.0, 0.0],
        "link_1": links[0],
        "link_2": links[1],
        "cuff": [d["cuff_x"], 0.0, -d["armrest_share"] * wearer.upper_arm],
        "masses": masses,
        "centres": np.concatenate(centres),
        "inertias": [matrix[i, j] for matrix in inertias for i, j in COLUMN],
        "lower": [d[f"{joint}_lower"] for joint in JOINTS],
        "upper": [d[f"{joint}_upper"] for joint in JOINTS],
        "stop": [d["stop_stiffness"], d["stop_width"], d["stop_damping"]],
        "damping": [d[f"{joint}_damping"] for joint in JOINTS],
        "push": [level * piston_area(d["bore"]) * d["supply"]],
        "lag": [d["lag"]],
        "lever": [d["lever_a"], d["lever_b"], d["lever_phase"]],
        "law": [d[name] for name in ("k", "b", "delta_full", "v_th", "mu_s", "mu_k", "rounding", "strap")],
        "seal": [d["seal_friction"], d["seal_speed"]],
        "padded": [d[name] for name in PADDED],
    }
    return np.concatenate([np.asarray(groups[name], float) for name in SIZES])


Rigid = tuple[float, Float[np.ndarray, " 3"], Float[np.ndarray, "3 3"]]
"""Mass [kg], centre [m], inertia about it [kg m²]."""


def _rod(mass: float, ends_at: Float[np.ndarray, " 3"]) -> Rigid:
    """A slender uniform rod from the origin."""
    return mass, 0.5 * ends_at, mass / 12.0 * _across(ends_at)


def _arm(d: Device) -> Rigid:
    """The arm link with the cylinder as a point on it."""
    parts = [(d["arm_mass"], -d["arm_centre"]), (d["cylinder_mass"], -d["cylinder_centre"])]
    mass = sum(each for each, _ in parts)
    centre = np.array([0.0, 0.0, sum(m * z for m, z in parts) / mass if mass > 0.0 else 0.0])
    gyration, twist, up = d["arm_gyration"], d["arm_twist_gyration"], np.array([0.0, 0.0, 1.0])
    own = d["arm_mass"] * (gyration**2 * _across(up) + twist**2 * np.outer(up, up))
    return mass, centre, own + sum(m * _across(np.array([0.0, 0.0, z]) - centre) for m, z in parts)


def _across(r: Float[np.ndarray, " 3"]) -> Float[np.ndarray, "3 3"]:
    """|r|² 1 - r rᵀ."""
    return np.asarray((r @ r) * np.eye(3) - np.outer(r, r))
