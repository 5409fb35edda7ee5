"""A body that presses into the elastic layer of another one: pressure, force, moment and centre in one pose."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from jaxtyping import Bool, Float

from geocontact.contact.elastic_foundation import linear_pressure, logarithmic_pressure
from geocontact.geometry.pieces import Pieces
from geocontact.geometry.surface import Surface
from geocontact.loads.pressure_load import PressureLoad, compartment_loads, pressure_load

FOUNDATIONS: Mapping[str, Callable[..., Any]] = {"linear": linear_pressure, "logarithmic": logarithmic_pressure}
"""Laws of one layer, by name: pressure of (depth, thickness, modulus)."""

USUAL = 1e-3
"""m; deeper points are looked for in a second, slower query."""


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
    """

    pieces: Pieces
    thickness: Float[np.ndarray, " p"]
    modulus: float
    law: str = "linear"
    parts: Mapping[str, Bool[np.ndarray, " p"]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if self.law not in FOUNDATIONS:
            raise ValueError(f"law must be {' or '.join(FOUNDATIONS)}, not {self.law!r}")
        if not (self.thickness > 0.0).all() or not self.modulus > 0.0:
            raise ValueError("thickness and modulus must be positive")


@dataclass(frozen=True, eq=False)
class Pressed:
    """What a pose does to a layer, in the frame of its body: pressure of each piece [Pa] and what it sums up to.

    `strain` is the largest depth over thickness [-].
    """

    pressure: Float[np.ndarray, " p"]
    load: PressureLoad
    parts: dict[str, PressureLoad]
    strain: float


def pressed(
    layer: Layer, moving: Surface, rotation: Float[np.ndarray, "3 3"], translation: Float[np.ndarray, " 3"]
) -> Pressed:
    """Load on the layer with the rigid, closed body `moving` at x = rotation x_moving + translation [m].

    The depth of a piece is minus its signed distance to `moving`. Pieces that face the same way as the surface next to
    them carry nothing: they are the far side of something thin, not what is pressed.
    """
    if not moving.closed:
        raise ValueError(f"{moving.name} is open: without an inside there is no depth")
    pieces = layer.pieces
    depth = _depth(pieces, moving, rotation, translation)
    pressure = FOUNDATIONS[layer.law](depth, layer.thickness, layer.modulus)
    numbers = pressure, pieces.area, pieces.normal, pieces.point, "FIXED"
    strain = float((depth / layer.thickness).max(initial=0.0))
    return Pressed(pressure, pressure_load(*numbers), compartment_loads(*numbers, layer.parts), strain)


def _depth(
    pieces: Pieces, moving: Surface, rotation: Float[np.ndarray, "3 3"], translation: Float[np.ndarray, " 3"]
) -> Float[np.ndarray, " p"]:
    there = (pieces.point - translation) @ rotation
    near = moving.proximity(there, USUAL)
    distance, normal = near.distance.copy(), near.normal.copy()
    deep = np.isneginf(distance)
    if deep.any():
        found = moving.proximity(there[deep])
        distance[deep], normal[deep] = found.distance, found.normal
    inside = distance < 0.0
    depth = np.zeros(len(distance))
    against = np.einsum("pi,pi->p", normal[inside] @ rotation.T, pieces.normal[inside])
    depth[inside] = np.where(against < 0.0, -distance[inside], 0.0)
    return depth
