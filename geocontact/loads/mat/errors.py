"""How far the wrench of a mat is off: cells that read wrong, and a mat that lies elsewhere than was thought.

To first order, for cells with pressures p, areas A and unit forces u (m^2, against the normal) at x:

- each cell by itself off by the share e: covariance e^2 sum p^2 (u, x × u)(u, x × u)^T;
- all cells off by the same share g: g^2 (F, M)(F, M)^T;
- the mat moved by d and turned by θ about its middle c: F changes by θ × F, the moment about o by
  θ × M_c + (c - o) × (θ × F) + d × F, with M_c the moment about c. Components of d and of θ are independent where only
  their size is stated; where residuals tell their covariance, that is used.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.data.wrench import Wrench
from geocontact.geometry.register.uncertainty import PoseCovariance
from geocontact.loads.mat.map import MatMap


@dataclass(frozen=True)
class MatErrors:
    """Standard deviations.

    Parameters
    ----------
    cell
        Of each cell's reading by itself, as a share of it.
    gain
        Of what all cells share.
    shift
        Of where the mat lies, along each axis [m].
    turn
        Of how it is turned, about each axis [rad].
    pose
        Of where the mat lies, as the residuals tell it of the body's registration and of the mat's own marks.
    """

    cell: float = 0.0
    gain: float = 0.0
    shift: float = 0.0
    turn: float = 0.0
    pose: PoseCovariance | None = None


def wrench_covariance(
    placed: MatMap, pressure: Float[np.ndarray, "t n"], wrench: Wrench, errors: MatErrors
) -> Float[np.ndarray, "t six six"]:
    """Covariance of force [N] and moment [N m] about the wrench's origin, frame by frame."""
    middle = (placed.area @ placed.centre) / placed.area.sum()
    origin = wrench.origin[0]
    own = np.concatenate([placed.force, placed.moment - np.cross(origin, placed.force)], axis=1)
    total = np.einsum("tn,ni,nj->tij", (errors.cell * pressure) ** 2, own, own, optimize=True)
    whole = np.concatenate([wrench.force, wrench.moment], axis=1)
    total += errors.gain**2 * whole[:, :, None] * whole[:, None, :]
    about = wrench.moved_to(middle).moment
    turned = np.concatenate([-_crossing(wrench.force), -_crossing(about)], axis=1)
    turned[:, 3:] += _crossing((middle - origin)[None]) @ turned[:, :3]
    moved = np.concatenate([np.zeros((len(whole), 3, 3)), -_crossing(wrench.force)], axis=1)
    for by, jacobian in ((errors.turn, turned), (errors.shift, moved)):
        total += by**2 * jacobian @ jacobian.transpose(0, 2, 1)
    if errors.pose is not None:
        both = np.concatenate([moved, turned], axis=2)
        total += both @ errors.pose.at(middle) @ both.transpose(0, 2, 1)
    return np.asarray(total)


def _crossing(vector: Float[np.ndarray, "t 3"]) -> Float[np.ndarray, "t 3 3"]:
    """Matrices [v] with [v] w = v × w."""
    x, y, z = vector.T
    nothing = np.zeros_like(x)
    return np.stack([nothing, -z, y, z, nothing, -x, -y, x, nothing], axis=1).reshape(-1, 3, 3)
