"""The elastic layers of two bodies in contact: from options to pieces, thickness and moduli."""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool, Float

from geocontact.analyses.area.options import FLAT, RAYS, AreaOptions
from geocontact.analyses.run_record import Record
from geocontact.contact.elasticity import layer_modulus
from geocontact.data.errors import InputError
from geocontact.geometry.contact_area.evolution import Settings
from geocontact.geometry.phong_offset import corner_normals, phong_offset
from geocontact.geometry.surface import Surface
from geocontact.geometry.surface_quadrature import surface_quadrature
from geocontact.geometry.thickness import thickness_below
from geocontact.loads.foundation import Layer, Skin

Faces = Bool[np.ndarray, " f"]


def layer_given(
    record: Record, fixed: Surface, faces: Faces | None, settings: Settings, o: AreaOptions, edge: float
) -> Layer:
    """FIXED's layer in pieces of at most `edge` [m]."""
    try:
        pieces = surface_quadrature(fixed, edge, faces)
    except ValueError as error:
        raise InputError("", "`piece`", str(error), "give a longer edge") from error
    thickness = _measured(record, fixed, pieces.point, pieces.normal, o.thickness, "`thickness`")
    parts: dict[str, Bool[np.ndarray, " p"]] = {}
    if settings.split is not None:
        medial = settings.split.height(pieces.point) * settings.medial_side > 0.0
        parts = {"medial": medial, "lateral": ~medial}
    height = None if o.facets == FLAT else phong_offset(fixed, corner_normals(fixed), pieces.face, pieces.point)
    return Layer(pieces, thickness, _confined(o.modulus, o.poisson), o.foundation or "linear", parts, height)


def skin_given(record: Record, moving: Surface, o: AreaOptions) -> Skin:
    """What MOVING brings: smooth facets unless flat, and a layer where its modulus is given."""
    normals = None if o.facets == FLAT else corner_normals(moving)
    if o.modulus_moving is None:
        return Skin(normals)
    centres = moving.vertices[moving.faces].mean(axis=1)
    thickness = _measured(record, moving, centres, moving.face_normal, o.thickness_moving, "`thickness_moving`")
    return Skin(normals, thickness, _confined(o.modulus_moving, o.poisson_moving))


def _confined(young: float | None, poisson: float | None) -> float:
    """Confined modulus [Pa]."""
    if young is None or poisson is None:
        raise ValueError("an elastic layer needs Young's modulus and Poisson's ratio")
    return float(layer_modulus(young, poisson))


def _measured(
    record: Record,
    body: Surface,
    points: Float[np.ndarray, "n 3"],
    normals: Float[np.ndarray, "n 3"],
    given: float | str | None,
    option: str,
) -> Float[np.ndarray, " n"]:
    """Thickness of a body's layer under points on it [m]: as given, or along rays."""
    if given is not None and given != RAYS:
        return np.full(len(points), float(given))
    if not body.closed:
        what = f"{body.name} is open ({body.topology.why_open}): it has no thickness to measure"
        raise InputError("", option, what, "give a length, for example 8mm")
    found = thickness_below(body, points, normals)
    lost = ~(np.isfinite(found) & (found > 0.0))
    if lost.any():
        usable = found[~lost]
        if len(usable) == 0:
            raise InputError("", option, f"no ray comes out of {body.name} again", "give a length")
        found = np.where(lost, usable.min(), found)
        record.warn(f"{int(lost.sum())} of {len(found)} rays do not come out of {body.name}: the thinnest is taken")
    return found
