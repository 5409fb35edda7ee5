"""Mistakes that show once bodies are read: a plane beside FIXED, penetration where no body has an inside."""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool

from geocontact.data.errors import InputError
from geocontact.geometry.plane import Plane
from geocontact.geometry.surface import Surface
from geocontact.io.text.units import LENGTH


def refuse_plane_beside(
    split: str, plane: Plane, fixed: Surface, counted: Bool[np.ndarray, " m"] | None, unit: str
) -> None:
    """InputError for a plane that leaves all faces of FIXED that count on one side."""
    faces = fixed.faces if counted is None else fixed.faces[counted]
    height = plane.height(fixed.vertices[np.unique(faces)])
    if height.min() < 0.0 < height.max():
        return
    low, high = ((end + plane.offset) / LENGTH[unit] for end in (height.min(), height.max()))
    axis = split.partition("=")[0].strip()
    what = f"{axis} = {plane.offset / LENGTH[unit]:.6g} {unit} does not cut {fixed.name}"
    what += (
        f", whose {'faces that count go' if counted is not None else 'faces go'} from {low:.4g} to {high:.4g} {unit}"
    )
    middle = float(f"{0.5 * (low + high):.2g}")
    raise InputError("", "`split`", what, f"write for example {axis}={middle:g}")


def refuse_zero_without_inside(thresholds: tuple[float, ...], moving: Surface, fixed: Surface) -> None:
    """InputError for a threshold of 0, which counts penetration, where no body has an inside."""
    if 0.0 in thresholds and not moving.closed and not fixed.closed:
        what = f"0 counts what is inside the other body, and neither {moving.name} nor {fixed.name} is closed"
        raise InputError("", "`threshold`", what, "give a length, or say `assume_closed`")
