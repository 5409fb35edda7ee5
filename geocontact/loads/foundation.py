"""A body that presses into the elastic layer of another one: pressure, force, moment, energy and stiffness.

With d the depth of a piece at x, m = -dd/dx the slope of the smooth surface of MOVING there and w(d) the energy per
area of the law (`contact.elastic_foundation`), U = sum w(d) A. A small displacement s of MOVING and a small turn u
about a point c change d by m . (s + u x r), r = x - c. The force and the moment on MOVING are -sum p A m and
-sum p A r x m, and the stiffness is the second derivative of U:

    K = sum A (p'(d) g g^T + p d''),   g = (m, r x m)

with d'' from the curvature of the smooth surface (`geometry.curvature`) and from the turn of m with the body.
Winkler foundation: Johnson, Contact Mechanics (1985), sec. 4.3; in knee implants Fregly, Bei & Sylvester, J Biomech 36
(2003) 1659.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from jaxtyping import Bool, Float, Int

from geocontact.contact.elastic_foundation import (
    linear_energy,
    linear_pair_pressure,
    linear_pressure,
    linear_stiffness,
    logarithmic_energy,
    logarithmic_pair_pressure,
    logarithmic_pressure,
    logarithmic_stiffness,
)
from geocontact.geometry.curvature import corner_normals, phong_offset, phong_slope
from geocontact.geometry.plane import Plane
from geocontact.geometry.surface import Surface
from geocontact.geometry.surface_quadrature import SurfaceQuadrature
from geocontact.loads.overlap import Overlap, overlap
from geocontact.loads.pressure_load import PressureLoad, compartment_loads, pressure_load

FOUNDATIONS: Mapping[str, Callable[..., Any]] = {"linear": linear_pressure, "logarithmic": logarithmic_pressure}
"""Laws of one layer, by name: pressure of (depth, thickness, modulus)."""

PAIRS: Mapping[str, Callable[..., Any]] = {"linear": linear_pair_pressure, "logarithmic": logarithmic_pair_pressure}
"""Laws of two layers, by the same names: pressure of (depth, thickness, modulus, other thickness, other modulus)."""


@dataclass(frozen=True, eq=False)
class Layer:
    """An elastic layer on a rigid base.

    Parameters
    ----------
    pieces
        Its surface in the frame of its body.
    thickness
        Under each piece [m], > 0.
    modulus
        Confined modulus M [Pa], `layer_modulus`.
    law
        Name in `FOUNDATIONS`.
    parts
        Pieces of each compartment, by its name.
    height
        Of the smooth surface above each piece [m], `geometry.curvature`; None where triangles are taken as they are.
    """

    pieces: SurfaceQuadrature
    thickness: Float[np.ndarray, " p"]
    modulus: float
    law: str = "linear"
    parts: Mapping[str, Bool[np.ndarray, " p"]] = field(default_factory=dict)
    height: Float[np.ndarray, " p"] | None = None

    def __post_init__(self) -> None:
        if self.law not in FOUNDATIONS:
            raise ValueError(f"law must be {' or '.join(FOUNDATIONS)}, not {self.law!r}")
        if not (self.thickness > 0.0).all() or not self.modulus > 0.0:
            raise ValueError("thickness and modulus must be positive")


def layer_on(
    surface: Surface,
    pieces: SurfaceQuadrature,
    thickness: Float[np.ndarray, " p"],
    modulus: float,
    law: str = "linear",
    sides: tuple[Plane, int] | None = None,
    smooth: bool = True,
) -> Layer:
    """Elastic layer on a surface that is cut into pieces.

    Parameters
    ----------
    surface, pieces
        The surface, and the pieces of it that the layer is under, in its frame.
    thickness
        Under each piece [m], > 0.
    modulus
        Confined modulus M [Pa], `layer_modulus`.
    law
        Name in `FOUNDATIONS`.
    sides
        Plane that parts "medial" from "lateral" pieces by their middles, and the sign of the heights above it that are
        medial; one part without.
    smooth
        Whether triangles stand for a smooth surface, `geometry.curvature`; taken as they are otherwise.

    Raises
    ------
    ValueError
        A thickness or the modulus is not positive, or there is no such law.
    """
    parts: dict[str, Bool[np.ndarray, " p"]] = {}
    if sides is not None:
        plane, sign = sides
        medial = plane.height(pieces.point) * sign > 0.0
        parts = {"medial": medial, "lateral": ~medial}
    height = phong_offset(surface, corner_normals(surface), pieces.face, pieces.point) if smooth else None
    return Layer(pieces, thickness, modulus, law, parts, height)


@dataclass(frozen=True, eq=False)
class Skin:
    """What `moving` brings besides its triangles.

    Parameters
    ----------
    normals
        `corner_normals` of it, where its triangles stand for a smooth surface.
    thickness, modulus
        Elastic layer of its own: thickness under each face [m], > 0, and confined modulus [Pa]; rigid without.
    """

    normals: Float[np.ndarray, "m 3 3"] | None = None
    thickness: Float[np.ndarray, " m"] | None = None
    modulus: float = np.inf


RIGID = Skin()


@dataclass(frozen=True, eq=False)
class Pressed:
    """What a pose does to a layer, in the frame of its body: pressure of each piece [Pa] and what it sums up to.

    `strain` is the largest shortening of a layer over its thickness [-].
    """

    pressure: Float[np.ndarray, " p"]
    load: PressureLoad
    parts: dict[str, PressureLoad]
    strain: float


def pressed(
    layer: Layer,
    moving: Surface,
    rotation: Float[np.ndarray, "3 3"],
    translation: Float[np.ndarray, " 3"],
    skin: Skin = RIGID,
) -> Pressed:
    """Load on the layer with the closed body `moving` at x = rotation x_moving + translation [m], rigid under its skin.

    The depth of a piece is minus its signed distance to `moving`; with the heights of both smooth surfaces above their
    triangles, where `layer.height` and `skin.normals` say them. Pieces that face the same way as the surface next to
    them carry nothing: they are the far side of something thin, not what is pressed.
    """
    if not moving.closed:
        raise ValueError(f"{moving.name} is open: without an inside there is no depth")
    pieces = layer.pieces
    over = overlap(pieces, layer.height, moving, rotation, translation, skin.normals)
    pressure, strain = _carried(layer, skin, over.depth, over.face)
    numbers = pressure, pieces.area, pieces.normal, pieces.point, "FIXED"
    return Pressed(pressure, pressure_load(*numbers), compartment_loads(*numbers, layer.parts), strain)


def _carried(
    layer: Layer, skin: Skin, depth: Float[np.ndarray, " p"], face: Int[np.ndarray, " p"]
) -> tuple[Float[np.ndarray, " p"], float]:
    """Pressure of each piece [Pa] and the largest strain of a layer."""
    if skin.thickness is None:
        pressure = FOUNDATIONS[layer.law](depth, layer.thickness, layer.modulus)
        return pressure, float((depth / layer.thickness).max(initial=0.0))
    pressure = np.zeros(len(depth))
    on = np.flatnonzero(depth > 0.0)
    pressure[on] = PAIRS[layer.law](
        depth[on], layer.thickness[on], layer.modulus, skin.thickness[face[on]], skin.modulus
    )
    most = float(pressure.max(initial=0.0)) / min(layer.modulus, skin.modulus)
    return pressure, most if layer.law == "linear" else float(-np.expm1(-most))


Law = Callable[..., Any]
LAWS: Mapping[str, tuple[Law, Law, Law]] = {
    "linear": (linear_energy, FOUNDATIONS["linear"], linear_stiffness),
    "logarithmic": (logarithmic_energy, FOUNDATIONS["logarithmic"], logarithmic_stiffness),
}
"""Energy per area, pressure and its slope, of (depth, thickness, modulus)."""

ON_EDGE = 1e-9
"""Share of a corner below which the closest point lies on the edge opposite to it."""

SHARP = 1e-5
"""m; distance to an edge below which its curvature 1/distance is not followed any further."""


@dataclass(frozen=True, eq=False)
class FoundationState:
    """What a pose does to an elastic foundation, in the frame of FIXED.

    Parameters
    ----------
    energy
        Stored [J].
    slope
        (6,) derivative of the energy to a displacement [N] and to a turn about the point [N m]: minus the force and the
        moment on MOVING.
    stiffness
        (6, 6) second derivative [N/m, N, N m].
    pressed
        Pieces under pressure.
    depth, pressure
        Of each of these [m] and [Pa].
    against
        Slope m of MOVING's smooth surface at each of these, near 1 in size.
    """

    energy: float
    slope: Float[np.ndarray, " 6"]
    stiffness: Float[np.ndarray, "6 6"]
    pressed: Int[np.ndarray, " n"]
    depth: Float[np.ndarray, " n"]
    pressure: Float[np.ndarray, " n"]
    against: Float[np.ndarray, "n 3"]


def foundation_state(
    layer: Layer,
    moving: Surface,
    normals: Float[np.ndarray, "m 3 3"],
    rotation: Float[np.ndarray, "3 3"],
    translation: Float[np.ndarray, " 3"],
    about: Float[np.ndarray, " 3"],
) -> FoundationState:
    """Energy, forces and stiffness with the rigid closed body `moving` at x = rotation x_moving + translation [m].

    Parameters
    ----------
    normals
        `corner_normals` of `moving`.
    about
        Point of MOVING, in FIXED's frame, that turns are about [m].
    """
    over = overlap(layer.pieces, layer.height, moving, rotation, translation, normals)
    on = np.flatnonzero(over.depth > 0.0)
    depth, area = over.depth[on], layer.pieces.area[on]
    energy, pressure, slope = (each(depth, layer.thickness[on], layer.modulus) for each in LAWS[layer.law])
    along, bend = _depth_slopes(moving, normals, over, on)
    m, curved = -along @ rotation.T, rotation @ bend @ rotation.T
    r = layer.pieces.point[on] - about
    g = np.hstack([m, np.cross(r, m)])
    load = pressure * area
    stiffness = (g * (slope * area)[:, None]).T @ g + _turning(m, r, load) + _curving(curved, r, load)
    symmetric = 0.5 * (stiffness + stiffness.T)
    return FoundationState(float(energy @ area), load @ g, symmetric, on, depth, pressure, m)


def layer_loads(layer: Layer, state: FoundationState) -> dict[str, PressureLoad]:
    """Load on FIXED of each part of the layer and of all, "total"; along MOVING's normals, as the energy has it."""
    pieces, on = layer.pieces, state.pressed
    numbers = state.pressure, pieces.area[on], -state.against, pieces.point[on], "FIXED"
    parts = {name: which[on] for name, which in layer.parts.items()}
    return {**compartment_loads(*numbers, parts), "total": pressure_load(*numbers)}


def _depth_slopes(
    moving: Surface, normals: Float[np.ndarray, "m 3 3"], over: Overlap, on: np.ndarray
) -> tuple[Float[np.ndarray, "n 3"], Float[np.ndarray, "n 3 3"]]:
    """First and second derivative of the depth to the place, in MOVING's frame.

    The closest point follows within its triangle, along its edge, or stays at its corner.
    """
    face, closest, normal, distance = over.face[on], over.closest[on], over.normal[on], over.distance[on]
    slope, bend = phong_slope(moving, normals, face, closest)
    outward = moving.face_normal[face]
    follows = np.eye(3) - outward[:, :, None] * outward[:, None, :]
    curved = np.zeros_like(follows)
    beside = np.flatnonzero(np.abs(np.einsum("ni,ni->n", normal, outward)) < 1.0 - ON_EDGE)
    if len(beside):
        follows[beside] = _along_edge(moving, face[beside], closest[beside])
        n = normal[beside]
        away = np.where(distance[beside] < 0.0, -1.0, 1.0) * np.maximum(np.abs(distance[beside]), SHARP)
        round_it = np.eye(3) - n[:, :, None] * n[:, None, :] - follows[beside]
        curved[beside] = -round_it / away[:, None, None]
    first = -normal + np.einsum("nij,nj->ni", follows, slope)
    return first, curved + follows @ bend @ follows


def _along_edge(moving: Surface, face: np.ndarray, closest: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "n 3 3"]:
    """Projector onto the edge that each point lies on; zero at corners."""
    corners = moving.corners_of(face)
    to_corner = corners - (closest - moving.centre)[:, None, :]
    edges = np.roll(corners, -1, axis=1) - np.roll(corners, 1, axis=1)  # opposite to each corner
    length = np.maximum(np.linalg.norm(edges, axis=2), 1e-300)
    unit = edges / length[:, :, None]
    next_corner = np.roll(to_corner, 1, axis=1)
    off = np.linalg.norm(np.cross(unit, next_corner), axis=2)
    which = np.argmin(off, axis=1)
    rows = np.arange(len(face))
    u = unit[rows, which]
    at_corner = np.linalg.norm(to_corner, axis=2).min(axis=1) < ON_EDGE * length.max(axis=1)
    return np.where(at_corner[:, None, None], 0.0, u[:, :, None] * u[:, None, :])


def _turning(
    m: Float[np.ndarray, "n 3"], r: Float[np.ndarray, "n 3"], load: Float[np.ndarray, " n"]
) -> Float[np.ndarray, "6 6"]:
    """What the turn of the body does to the place of a piece in it, to second order."""
    out = np.zeros((6, 6))
    total = load @ m
    both = (r * load[:, None]).T @ m
    out[:3, 3:] = -_cross_matrix(total)
    out[3:, :3] = out[:3, 3:].T
    out[3:, 3:] = np.trace(both) * np.eye(3) - 0.5 * (both + both.T)
    return out


def _curving(
    curved: Float[np.ndarray, "n 3 3"], r: Float[np.ndarray, "n 3"], load: Float[np.ndarray, " n"]
) -> Float[np.ndarray, "6 6"]:
    """What the second derivative of the depth to the place adds."""
    shift = np.zeros((len(r), 3, 6))  # place of the piece in the body by displacement and turn
    shift[:, :, :3] = -np.eye(3)
    x, y, z = r.T
    shift[:, 0, 4], shift[:, 0, 5] = -z, y
    shift[:, 1, 3], shift[:, 1, 5] = z, -x
    shift[:, 2, 3], shift[:, 2, 4] = -y, x
    total = (np.swapaxes(shift, 1, 2) @ curved @ shift) * load[:, None, None]
    return np.asarray(total.sum(axis=0))


def _cross_matrix(a: Float[np.ndarray, " 3"]) -> Float[np.ndarray, "3 3"]:
    """[a] with [a] b = a x b."""
    return np.array([[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]])
