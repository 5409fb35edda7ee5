"""Registration by shape by open3d, where it is installed, or by our own search where it is not."""

from __future__ import annotations

import warnings
from dataclasses import replace
from typing import Any, Literal

import numpy as np
from scipy.spatial.transform import RigidTransform

from geocontact.geometry.register.icp import BIWEIGHT, IcpSearch, icp, judged, samples, shape_covariance
from geocontact.geometry.register.quality import Registration
from geocontact.geometry.surface import Surface

DENSE = 200_000  # points that stand for the fixed surface, which open3d takes as a cloud
FINE = 1e-4  # m; scale of the residuals in the last search
AGAIN = 30  # rounds of a search begun again from the result
STANDS = 2e-6  # m, motion at the points in these, below which the result stands


def shape_registration(
    moving: Surface, fixed: Surface, start: Registration, engine: Literal["auto", "own", "open3d"] = "auto"
) -> tuple[Literal["own", "open3d"], Registration]:
    """The pose X_BA at which A lies on B by shape, its covariance, and the engine that found it.

    Parameters
    ----------
    moving, fixed
        A and B; B's frame is that of the result.
    start
        Where A lies about, e.g. by landmarks; its covariance stays in the directions in which A slides on B.
    engine
        own: `icp`. open3d: `open3d_icp`, an ImportError where open3d is not installed. auto: open3d where it is.
    """
    used: Literal["own", "open3d"] = "own"
    found = None
    if engine != "own":
        try:
            used, found = "open3d", open3d_icp(moving, fixed, start.pose)
        except ImportError:
            if engine == "open3d":
                raise
            used = "own"
    found = found or icp(moving, fixed, start.pose)
    return used, replace(found, covariance=shape_covariance(moving, fixed, found.pose, start=start.covariance))


def open3d_icp(moving: Surface, fixed: Surface, start: RigidTransform, search: IcpSearch | None = None) -> Registration:
    """The pose X_BA of `icp`, found by open3d's point-to-plane search with Tukey's weights.

    B is a dense cloud to it, so partners on the rim cannot be dropped: pairs are bounded by the reach first, and by
    ever less of it afterwards. Its residual map is made by the same distances as that of `icp`. It does not say whether
    it converged: a search begun again from the result must not move it.
    """
    o3d: Any = _open3d()
    search = search or IcpSearch()
    points, normals = samples(moving, search.points)
    clouds = []
    for positions, directions in ((points, normals), samples(fixed, DENSE)):
        cloud = o3d.geometry.PointCloud(o3d.utility.Vector3dVector(positions))
        cloud.normals = o3d.utility.Vector3dVector(directions)
        clouds.append(cloud)
    registration = o3d.pipelines.registration
    matrix, rounds, reach = start.as_matrix(), 0, search.reach
    ends = registration.ICPConvergenceCriteria(1e-12, 1e-12, search.rounds)
    while True:
        plane = registration.TransformationEstimationPointToPlane(
            registration.TukeyLoss(BIWEIGHT * max(0.1 * reach, FINE))
        )
        found = registration.registration_icp(*clouds, reach, matrix, plane, ends)
        matrix, rounds = np.array(found.transformation), rounds + 1
        if reach <= search.tolerance:
            break
        reach = max(0.5 * reach, search.tolerance)
    once_more = registration.ICPConvergenceCriteria(1e-12, 1e-12, AGAIN)
    again = registration.registration_icp(*clouds, reach, matrix, plane, once_more)
    pose, other = (RigidTransform.from_matrix(each) for each in (matrix, np.array(again.transformation)))
    stands = float(np.linalg.norm(other.apply(points) - pose.apply(points), axis=1).max()) < STANDS
    return judged(fixed, points, normals, pose, search, stands, rounds)


def _open3d() -> Any:
    """The library, or a line that says what to do without it."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # what its own imports are warned of is nothing to who measures
            import open3d
    except (ImportError, OSError) as why:  # its wheel needs system libraries that a bare machine lacks
        raise ImportError(
            f"open3d does not import ({why}); install geocontact[scan], or register by geometry.register.icp"
        ) from why
    return open3d
