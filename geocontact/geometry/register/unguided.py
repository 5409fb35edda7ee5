"""Two scans of one body brought together without landmarks: by their principal axes, then by shape."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.geometry.register.icp import IcpSearch, icp
from geocontact.geometry.register.quality import Registration
from geocontact.geometry.register.samples import samples
from geocontact.geometry.surface import Surface

TWISTS = 12  # turns about the longest axis that are tried, both ways up
ROUGH = IcpSearch(points=400, rounds=25, settled=1e-5)
POINTS = 4000  # that principal axes are taken from
BEST = 3  # starts that are followed to the end
PLAINLY = 0.9  # another start must fit that much better than the scans as they stand


def unguided(moving: Surface, fixed: Surface, search: IcpSearch | None = None) -> Registration:
    """The pose X_BA at which a scan A lies best on another scan B of the same body.

    Starts are A as it stands, and A with its centroid and longest principal axis on those of B, turned about that axis
    in steps of 30 degrees, both ways up. Each is followed roughly by `icp`, the best three to the end. What fits is
    estimated from the median residual, so that a part that only one scan has does not count. Bodies that are alike from
    several sides have several answers: the one that needs no turn is preferred.
    """
    rated = []
    for k, start in enumerate(_starts(moving, fixed)):
        try:
            found = icp(moving, fixed, start, ROUGH)
        except ValueError:
            continue
        rated.append((_misfit(found) * (PLAINLY if k == 0 else 1.0), k, found.pose))
    if not rated:
        raise ValueError(f"{moving.name} and {fixed.name} find no partners in any pose; are they of the same body?")
    finished = [(icp(moving, fixed, pose, search), k) for _, k, pose in sorted(rated, key=lambda r: r[:2])[:BEST]]
    return min(finished, key=lambda f: (_misfit(f[0]) * (PLAINLY if f[1] == 0 else 1.0), f[1]))[0]


def _misfit(found: Registration) -> float:
    return float(np.median(found.residual))


def _starts(moving: Surface, fixed: Surface) -> Iterator[RigidTransform]:
    yield RigidTransform.identity()
    (a, from_A), (b, from_B) = (_axes(surface) for surface in (moving, fixed))
    for up in (1.0, -1.0):
        flip = np.diag([up, 1.0, up])
        for k in range(TWISTS):
            twist = Rotation.from_rotvec([0.0, 0.0, 2.0 * np.pi * k / TWISTS]).as_matrix()
            turn = Rotation.from_matrix(b @ twist @ flip @ a.T)
            yield RigidTransform.from_components(from_B - turn.apply(from_A), turn)


def _axes(surface: Surface) -> tuple[Float[np.ndarray, "3 3"], Float[np.ndarray, " 3"]]:
    """Principal axes as right-handed columns, the longest last, and the centroid."""
    points, _ = samples(surface, POINTS)
    centre = points.mean(axis=0)
    _, axes = np.linalg.eigh(np.cov((points - centre).T))
    axes[:, 0] *= np.sign(np.linalg.det(axes))
    return axes, centre


def same_place(moving: Surface, found: Registration) -> Surface:
    """A in B's frame."""
    return replace(moving, vertices=found.pose.apply(moving.vertices))
