"""The foot on a ramp, on stairs and on a mesh along a known motion: `python -m benchmarks.prosthesis.grounds`.

The motion is the synthetic stance of `benchmarks.prosthesis.keel_stance` at medium, with damping and friction. On the
ramp pose and gravity are turned with the ground, so that all loads have to be those on the floor, turned; on the
stairs two rows of the midfoot hang over the edge of a step. Each ground is also a mesh of triangles
(`loads.ground.Sheet`), which has to give the loads of the formula. Told are root mean square differences of the force,
its largest, of the centre of pressure, and the CPU time of one solution of all frames.
benchmarks/results/prosthesis_grounds.json.
"""

from __future__ import annotations

import argparse
import time
from typing import Any

import numpy as np
from scipy.spatial.transform import RigidTransform, Rotation

from benchmarks.machine import write_results
from benchmarks.prosthesis.keel_stance import LEVEL, WEIGHT, Stance, stance
from geocontact.below_knee_prosthesis.keel.quasi_static import DOWNWARDS, KeelMotion, QuasiStaticKeel
from geocontact.below_knee_prosthesis.keel.vsf import fulcrum_of, vsf_foot
from geocontact.geometry.shapes import HalfSpace
from geocontact.geometry.surface import Surface
from geocontact.loads.centre_of_pressure import centre_of_pressure
from geocontact.loads.ground import Ground, Sheet, Stairs
from geocontact.loads.resultant import pose_rate

SLOPE = np.radians(5.0)
EDGE, DROP = 0.05, 0.15
"""m; of the step from the keel's posterior end in the first frame, and how much lower the tread behind it is."""
REACH, BEHIND = 2.0, 0.5
"""m; of the meshes along the walk to both sides, and half of their breadth."""
REPEATS = 3


def strip(profile: np.ndarray) -> Sheet:
    """A mesh over a line of points (x, y) with x increasing or standing still, faces looking up or back."""
    left, right = (np.column_stack([profile, np.full(len(profile), z)]) for z in (-BEHIND, BEHIND))
    k, n = np.arange(len(profile) - 1), len(profile)
    faces = np.concatenate([np.column_stack([k, k + n, k + n + 1]), np.column_stack([k, k + n + 1, k + 1])])
    return Sheet(Surface(np.concatenate([left, right]), faces))


def turned(one: Stance, angle: float) -> Stance:
    """The same motion beside a ground that rises forwards by an angle [rad]."""
    turn = RigidTransform.from_rotation(Rotation.from_euler("z", angle))
    poses = turn * one.poses
    return Stance(one.time, poses, pose_rate(one.time, poses))


def solved(
    keel: QuasiStaticKeel, one: Stance, ground: Ground, gravity: tuple[float, float, float] = DOWNWARDS
) -> tuple[KeelMotion, float]:
    """All frames, and the least CPU seconds of some solutions."""
    spent = []
    for _ in range(REPEATS):
        before = time.process_time()
        found = keel.solve(one.poses, ground, rate=one.rate, time=one.time, gravity=gravity)
        spent.append(time.process_time() - before)
    return found, float(np.median(spent))


def beside(found: KeelMotion, other: KeelMotion) -> dict[str, float]:
    """How far the force and its centre are apart."""
    off = np.linalg.norm(found.force - other.force, axis=1)
    centres = [centre_of_pressure(each.loads, gate=0.05 * WEIGHT).centre for each in (found, other)]
    away = np.linalg.norm(centres[0] - centres[1], axis=1)
    return {
        "force_rms_N": float(np.sqrt(np.mean(off**2))),
        "force_most_N": float(off.max()),
        "centre_rms_mm": float(1e3 * np.sqrt(np.nanmean(away**2))),
    }


def figures() -> dict[str, dict[str, Any]]:
    """By ground."""
    foot, fulcrum = vsf_foot(), fulcrum_of("medium")
    keel, level = foot.at(fulcrum), stance(foot, fulcrum)
    floor, seconds = solved(keel, level, LEVEL)
    told: dict[str, dict[str, Any]] = {"floor": {"seconds": seconds, "largest_N": float(floor.force[:, 1].max())}}
    sheet, seconds = solved(keel, level, strip(np.array([[-REACH, 0.0], [REACH, 0.0]])))
    told["floor as a mesh, beside the formula"] = beside(sheet, floor) | {"seconds": seconds}

    s, c = np.sin(SLOPE), np.cos(SLOPE)
    gravity, ramp = (9.80665 * s, -9.80665 * c, 0.0), turned(level, SLOPE)
    own, seconds = solved(keel, ramp, HalfSpace(normal=(-s, c, 0.0)), gravity)
    back = Rotation.from_euler("z", -SLOPE)
    off = np.linalg.norm(back.apply(own.force) - floor.force, axis=1)
    told["ramp, beside the floor turned"] = {"force_most_N": float(off.max()), "seconds": seconds}
    sheet, seconds = solved(keel, ramp, strip(REACH * np.array([[-c, -s], [c, s]])), gravity)
    told["ramp as a mesh, beside the formula"] = beside(sheet, own) | {"seconds": seconds}

    start = float(level.poses.translation[0, 0])
    edge = start + EDGE
    flight, seconds = solved(keel, level, Stairs((edge,), (-DROP, 0.0)))
    told["stairs, beside the floor"] = beside(flight, floor) | {"seconds": seconds}
    profile = np.array([[-REACH, -DROP], [edge, -DROP], [edge, 0.0], [REACH, 0.0]])
    sheet, seconds = solved(keel, level, strip(profile))
    told["stairs as a mesh, beside the formula"] = beside(sheet, flight) | {"seconds": seconds}
    return told


def main() -> None:
    """Print and write."""
    argparse.ArgumentParser(description=__doc__.splitlines()[0]).parse_args()
    told = figures()
    for name, row in told.items():
        print(f"{name}: " + ", ".join(f"{key} {value:.3g}" for key, value in row.items()))
    write_results("prosthesis_grounds", {"slope_deg": 5.0, "edge_m": EDGE, "drop_m": DROP}, told)


if __name__ == "__main__":
    main()
