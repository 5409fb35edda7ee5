"""Free coordinates that nothing holds: along them the component could be anywhere."""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool, Float

from geocontact.loads.settling.coordinates import NAMES
from geocontact.loads.settling.newton import ARM, scales

HELD = 0.05
"""Of load over 20 mm: the least stiffness that counts as holding a coordinate. A load that rests in a valley with a
radius of 0.4 m has this much. Pieces of half a millimetre make up to 0.016 where there is none; those of one millimetre
make up to 0.08, so that what nothing holds may pass there."""

SHARE = 0.3
"""Least part of a coordinate in a direction that is not held for it to be named."""


def least_held(stiffness: Float[np.ndarray, "6 6"], free: Bool[np.ndarray, " 6"]) -> float:
    """Smallest stiffness along any direction of the free coordinates, turns on a lever of 20 mm [N/m]."""
    return float(np.linalg.eigvalsh(_scaled(stiffness, free))[0])


def not_held(stiffness: Float[np.ndarray, "6 6"], free: Bool[np.ndarray, " 6"], load: float) -> tuple[str, ...]:
    """Names of the free coordinates that neither the contact nor a spring holds; none where all are held."""
    curvature, directions = np.linalg.eigh(_scaled(stiffness, free))
    loose = curvature < HELD * load / ARM
    if not loose.any():
        return ()
    part = np.abs(directions[:, loose]).max(axis=1)
    names = np.array(NAMES)[free]
    return tuple(str(name) for name, share in zip(names, part, strict=True) if share >= SHARE)


def _scaled(stiffness: Float[np.ndarray, "6 6"], free: Bool[np.ndarray, " 6"]) -> Float[np.ndarray, "n n"]:
    scale = scales()[free]
    return np.asarray(stiffness[np.ix_(free, free)] * np.outer(scale, scale))
