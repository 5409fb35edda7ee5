"""Thickness and modulus of an elastic layer, as the options of an analysis give them."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.analyses.layer_options import RAYS
from geocontact.analyses.run_record import Record
from geocontact.contact.elasticity import layer_modulus
from geocontact.data.errors import InputError
from geocontact.geometry.surface import Surface
from geocontact.geometry.surface_quadrature import thickness_below


def confined_modulus(young: float | None, poisson: float | None) -> float:
    """Confined modulus [Pa]."""
    if young is None or poisson is None:
        raise ValueError("an elastic layer needs Young's modulus and Poisson's ratio")
    return float(layer_modulus(young, poisson))


def measured_thickness(
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
