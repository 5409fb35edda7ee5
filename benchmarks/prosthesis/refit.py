"""The package's keel of 8 hinges and 24 spheres without friction, with what a diagnosis named, fitted to trials.

Stiffness and damping of the five zones are fitted beside the numbers of a field of the foot: the keel's hysteresis, a
fulcrum, a socket between the markers and the foot, or spheres that were missing. The keel has no inertia and moves in
the plane along what the markers show.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np
from scipy.optimize import least_squares
from scipy.spatial.transform import RigidTransform, Rotation

from benchmarks.prosthesis.truth import FootPath, Measured, given_way
from geocontact.below_knee_prosthesis.keel.foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.keel.quasi_static import QuasiStaticKeel
from geocontact.below_knee_prosthesis.keel.sole import KeelSole
from geocontact.below_knee_prosthesis.keel.vsf import fulcrum_of, vsf_foot
from geocontact.geometry.shapes import HalfSpace
from geocontact.loads.centre_of_pressure import centre_in_foot
from geocontact.loads.resultant import pose_rate
from geocontact.loads.sphere_set import SphereSet

Trials = dict[str, Measured]
SETTING = "low"
LACKING = ("heel_back", "heel_front")
"""Zones without which a model has one row of spheres at the heel in place of three."""
FIELDS: dict[str, tuple[tuple[float, float, float], ...]] = {
    "": (),
    "heel": (),
    "hysteresis": ((0.05, 1e-3, 0.9),),
    "fulcrum": ((0.075, 0.066, 0.151),),
    "socket": ((60e3, 2e3, 2e6), (10e3, 10.0, 1e5)),
}
"""Start and bounds of the numbers of each: share; m; N/m and N s/m."""
BELIEVED = np.log([3.0] * 5 + [10.0] * 5)
"""Standard deviation of the logarithm of stiffness and damping by zone, as in a calibration."""
UNCERTAIN = (10.0, 2e-3)
"""N and m; of upward force and centre of pressure, by which they are weighed."""
EVALUATIONS = 8
"""Of a fit, its differences not counted."""
WAVES, HALF = 20, 0.5
"""Turns between the foot's load and the socket's give, and the share of each that is taken."""


@lru_cache(maxsize=1)
def fulcrum() -> float:
    """That everybody is told [m]."""
    return fulcrum_of(SETTING)


@lru_cache(maxsize=2)
def foot_without(lacking: tuple[str, ...]) -> VariableStiffnessFoot:
    """The package's foot, no friction along the floor, without spheres of some zones."""
    foot = vsf_foot()
    kept = [k for k, zone in enumerate(foot.sole.spheres.zone) if zone not in lacking]
    s = foot.sole.spheres
    spheres = SphereSet(s.centre[kept], s.radius[kept], tuple(s.zone[k] for k in kept))
    sole = KeelSole(spheres, tuple(foot.sole.segment[k] for k in kept))
    none = np.zeros(len(kept))
    law = replace(
        foot.law, stiffness=foot.law.stiffness[kept], damping=foot.law.damping[kept], static=none, kinetic=none
    )
    return replace(foot, sole=sole, law=law)


def centre_seen(m: Measured) -> np.ndarray:
    """Centre of pressure by the plate in the foot's frame by the markers [m]."""
    return centre_in_foot(m.plate[:, 2], *m.path.pose.T)


def predicted(foot: VariableStiffnessFoot, path: FootPath, at: float) -> tuple[np.ndarray, np.ndarray]:
    """Upward force [N] and centre of pressure in the foot's frame [m] by the package's keel along a path."""
    turn = Rotation.from_euler("z", path.pose[:, 2:])
    poses = RigidTransform.from_components(np.column_stack([path.pose[:, :2], 0.0 * path.time]), turn)
    keel = QuasiStaticKeel(foot.keel, at, foot.sole, foot.law)
    loads = keel.solve(poses, HalfSpace(), rate=pose_rate(path.time, poses), time=path.time).loads
    up = loads.pressing.sum(axis=1)
    with np.errstate(invalid="ignore"):
        ground = np.nansum(loads.pressing * np.nan_to_num(loads.point[..., 0]), axis=1) / np.where(up > 0.0, up, np.nan)
    return up, centre_in_foot(ground, *path.pose.T)


@dataclass(frozen=True)
class FullModel:
    """The package's foot with factors on its sole's numbers, and with the numbers of a field."""

    foot: VariableStiffnessFoot
    field: str

    def along(self, path: FootPath, factors: np.ndarray, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Upward force and centre of pressure; `factors` on stiffness and damping of each zone."""
        foot, at = self._with(factors), fulcrum()
        if self.field == "hysteresis":
            foot = replace(foot, keel=replace(foot.keel, hysteresis=float(values[0])))
        if self.field == "fulcrum":
            at = float(values[0])
        if self.field != "socket":
            return predicted(foot, path, at)
        given, step = np.zeros(len(path.time)), float(path.time[1] - path.time[0])
        up_along = np.column_stack([-np.sin(path.pose[:, 2]), np.cos(path.pose[:, 2]), 0.0 * path.time])
        for _ in range(WAVES):
            moved = FootPath(path.time, path.pose + given[:, None] * up_along)
            up, centre = predicted(foot, moved, at)
            new = given_way(up * np.cos(path.pose[:, 2]), step, float(values[0]), float(values[1]))
            near = np.abs(new - given).max() < 1e-5
            given = given + HALF * (new - given)
            if near:
                break
        return up, centre_in_foot_of(centre, moved, path)

    def _with(self, factors: np.ndarray) -> VariableStiffnessFoot:
        zones = list(self.foot.sole.spheres.zones.values())
        k, b = self.foot.law.stiffness.copy(), self.foot.law.damping.copy()
        for zone, stiffer, damped in zip(zones, factors[: len(zones)], factors[len(zones) :], strict=True):
            k[zone] *= stiffer
            b[zone] *= damped
        return replace(self.foot, law=replace(self.foot.law, stiffness=k, damping=b))

    def errors(self, made: Trials, names: tuple[str, ...], x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Upward force [N] and centre [m] less measured, trial after trial; no centre where either has none."""
        zones = 2 * len(self.foot.sole.spheres.zones)
        off = []
        for name in names:
            m = made[name]
            up, centre = self.along(m.path, np.exp(x[:zones]), np.exp(x[zones:]))
            off.append((up - m.plate[:, 1], np.nan_to_num(centre - centre_seen(m))))
        return np.concatenate([each[0] for each in off]), np.concatenate([each[1] for each in off])

    def fitted(self, made: Trials, names: tuple[str, ...], held: np.ndarray | None = None) -> np.ndarray:
        """Logarithms of factors and of the field's numbers, on trials; `held`: the factors' ones."""
        zones = 2 * len(self.foot.sole.spheres.zones)
        field = np.log(np.array(FIELDS[self.field]).reshape(-1, 3))
        sd = np.concatenate([np.full(zones // 2, BELIEVED[0]), np.full(zones // 2, BELIEVED[-1])])
        free = zones if held is None else 0

        def whole(x: np.ndarray) -> np.ndarray:
            return x if held is None else np.concatenate([held, x])

        def off(x: np.ndarray) -> np.ndarray:
            try:
                force, centre = self.errors(made, names, whole(x))
            except ArithmeticError:
                return np.full(count, 1e3)
            return np.concatenate([force / UNCERTAIN[0], centre / UNCERTAIN[1], x[:free] / sd[:free]])

        count = sum(2 * len(made[name].path.time) for name in names) + free
        start = np.concatenate([np.zeros(free), field[:, 0]])
        reach = 3.0 * sd[:free]
        low, high = np.concatenate([-reach, field[:, 1]]), np.concatenate([reach, field[:, 2]])
        if not len(start):
            return whole(start)
        return whole(least_squares(off, start, bounds=(low, high), diff_step=1e-3, max_nfev=EVALUATIONS).x)


def centre_in_foot_of(centre: np.ndarray, moved: FootPath, path: FootPath) -> np.ndarray:
    """A place along one foot [m] as the other has it, both pitched alike."""
    across = (moved.pose[:, 0] - path.pose[:, 0]) * np.cos(path.pose[:, 2])
    return centre + across + (moved.pose[:, 1] - path.pose[:, 1]) * np.sin(path.pose[:, 2])


def refitted(
    field: str, made: Trials, uses: tuple[tuple[str, ...], tuple[str, ...]], before: Trials | None = None
) -> dict[str, Any]:
    """Held-out error of the foot without and with a field, fitted to the calibration trials.

    `before`: trials from which the sole's numbers are, and then held.
    """
    lacking = LACKING if field == "heel" else ()
    plain, whole = FullModel(foot_without(lacking), ""), FullModel(foot_without(()), field)
    held = plain.fitted(before, uses[0]) if before is not None else None
    told: dict[str, Any] = {}
    for name, model in (("before", plain), ("after", whole)):
        x = model.fitted(made, uses[0], held)
        force, centre = model.errors(made, uses[1], x)
        told[name] = {"force_N": float(np.sqrt(np.mean(force**2))), "centre_m": float(np.sqrt(np.mean(centre**2)))}
        numbers = np.exp(x[2 * len(model.foot.sole.spheres.zones) :])
        told[name] |= {"field": [float(each) for each in numbers], "factors": [float(each) for each in np.exp(x)]}
    return told
