"""Error of the poses carried into equilibria: pressures, area and medial share of drawn poses."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.analyses.frame.collector import listener, note, reserve, say
from geocontact.analyses.knee.settle.equilibrium import Settled, SettleInputs
from geocontact.analyses.knee.settle.options import SettleOptions
from geocontact.loads.settling import settle_along
from geocontact.loads.settling_potential import coordinates_of

if TYPE_CHECKING:
    from geocontact.geometry.contact_area.pose_error import PoseError
    from geocontact.loads.pressure_pose_error import PressureUncertainty

DRAWS, SEED = 40, 1


def settle_error(i: SettleInputs, o: SettleOptions, heaviest: int) -> PressureUncertainty | None:
    """Equilibria of drawn poses, and what is to be said of them; None without an error of the pose."""
    if o.pose_sd is None:
        return None
    from geocontact.geometry.contact_area.pose_error import PoseError  # late: with its kernels
    from geocontact.loads.pressure_pose_error import PressureUncertainty

    count = o.draws or DRAWS
    error = PoseError.normal(np.asarray(o.pose_sd), "fixed", count, SEED if o.seed is None else o.seed)
    columns: list[list[np.ndarray]] = []
    with listener().progress("equilibrium with the error of the pose", count) as step:
        for draw in range(count):
            moved = _moved(i, error, draw)
            wanted = coordinates_of(moved.motion.poses, i.bed.point)
            frames = settle_along(i.bed, i.fixed, wanted, i.load, i.springs, i.free, lambda _: None)
            s = Settled(moved, tuple(frames), o.side)
            columns.append([s.forces("total"), s.peaks, s.areas, s.forces("medial") / s.forces("total")])
            step()
    force, peak, area, share = np.moveaxis(np.array(columns), (0, 1, 2), (2, 0, 1))
    found = PressureUncertainty(force, peak, area, share)
    lost = int(np.isnan(force).sum())
    if lost:
        reserve(f"{lost} of {force.size} equilibria of drawn poses did not come to rest: left out of settle_error.csv")
    _report(found, heaviest, count)
    return found


def _report(found: PressureUncertainty, heaviest: int, count: int) -> None:
    share = found.share_where(heaviest)
    if share is None:
        return
    note("pose_error", {"draws": count, "medial_share_at_largest_load_ci95": list(share)})
    say(
        f"error of the pose: {100.0 * share[0]:.0f} … {100.0 * share[1]:.0f} % of the force medial where the load is "
        f"largest (95 % of {count} draws)"
    )


def _moved(i: SettleInputs, error: PoseError, draw: int) -> SettleInputs:
    """The same with the poses of one draw, turned about MOVING's origin."""
    poses = i.motion.poses
    turn = Rotation.from_rotvec(error.draws[draw, 3:])
    moved = RigidTransform.from_components(poses.translation + error.draws[draw, :3], turn * poses.rotation)
    return replace(i, motion=replace(i.motion, poses=moved))
