"""The elastic layers of two bodies in contact: from options to pieces, thickness and moduli."""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool

from geocontact.analyses.area.options import FLAT, AreaOptions
from geocontact.analyses.layer_thickness import confined_modulus, measured_thickness
from geocontact.analyses.run_record import Record
from geocontact.data.errors import InputError
from geocontact.geometry.contact_area.evolution import Settings
from geocontact.geometry.phong_offset import corner_normals, phong_offset
from geocontact.geometry.surface import Surface
from geocontact.geometry.surface_quadrature import surface_quadrature
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
    thickness = measured_thickness(record, fixed, pieces.point, pieces.normal, o.thickness, "`thickness`")
    parts: dict[str, Bool[np.ndarray, " p"]] = {}
    if settings.split is not None:
        medial = settings.split.height(pieces.point) * settings.medial_side > 0.0
        parts = {"medial": medial, "lateral": ~medial}
    height = None if o.facets == FLAT else phong_offset(fixed, corner_normals(fixed), pieces.face, pieces.point)
    return Layer(pieces, thickness, confined_modulus(o.modulus, o.poisson), o.foundation or "linear", parts, height)


def skin_given(record: Record, moving: Surface, o: AreaOptions) -> Skin:
    """What MOVING brings: smooth facets unless flat, and a layer where its modulus is given."""
    normals = None if o.facets == FLAT else corner_normals(moving)
    if o.modulus_moving is None:
        return Skin(normals)
    centres = moving.vertices[moving.faces].mean(axis=1)
    thickness = measured_thickness(
        record, moving, centres, moving.face_normal, o.thickness_moving, "`thickness_moving`"
    )
    return Skin(normals, thickness, confined_modulus(o.modulus_moving, o.poisson_moving))
