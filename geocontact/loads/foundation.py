"""A body that presses into the elastic layer of another one: pressure, force, moment and centre in one pose."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from jaxtyping import Bool, Float, Int

from geocontact.contact.elastic_foundation import (
    linear_pair_pressure,
    linear_pressure,
    logarithmic_pair_pressure,
    logarithmic_pressure,
)
from geocontact.geometry.surface import Surface
from geocontact.geometry.surface_quadrature import SurfaceQuadrature
from geocontact.loads.overlap import overlap
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
        Of the smooth surface above each piece [m], `geometry.phong_offset`; None where triangles are taken as they are.
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
