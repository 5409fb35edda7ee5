"""The elastic layer of a body: its modulus, and its thickness under points."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.analyses.frame.collector import reserve
from geocontact.analyses.frame.shared_options import RAYS
from geocontact.contact.elasticity import layer_modulus
from geocontact.data.errors import InputError
from geocontact.geometry.surface import Surface
from geocontact.geometry.surface_quadrature import thickness_below

STIFF, LEAST_RATIO = 50e6, 0.15
"""Pa, and Poisson's ratio: cartilage has 0 to 0.2 at equilibrium (Athanasiou, J Orthop Res 9, 1991) and below 20 MPa;
no plastic or metal of an implant has as little."""


def confined_modulus(young: float | None, poisson: float | None) -> float:
    """Confined modulus [Pa]."""
    if young is None or poisson is None:
        raise ValueError("an elastic layer needs Young's modulus and Poisson's ratio")
    if young > STIFF and poisson < LEAST_RATIO:
        what = f"{poisson:g} beside a modulus of {young * 1e-6:.4g} MPa: plastics and metals have 0.25 to 0.49"
        reserve(f"`poisson`: {what}; cartilage, which has less, is softer")
    return float(layer_modulus(young, poisson))


def measured_thickness(
    body: Surface,
    points: Float[np.ndarray, "n 3"],
    normals: Float[np.ndarray, "n 3"],
    given: float | str | None,
    option: str,
) -> Float[np.ndarray, " n"]:
    """Thickness of a body's layer under points on it [m]: as given, or along rays."""
    if given is not None and given != RAYS:
        least = float(np.ptp(body.vertices, axis=0).min())
        if body.closed and float(given) > least:
            what = (
                f"{1e3 * float(given):.4g} mm is more than {body.name} has across, {1e3 * least:.3g} mm at its thinnest"
            )
            reserve(f"{option}: {what}: is the layer's thickness in this unit?")
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
        reserve(f"{int(lost.sum())} of {len(found)} rays do not come out of {body.name}: the thinnest is taken")
    return found
