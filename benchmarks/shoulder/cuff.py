"""A cuff that holds by its surface beside a point, and a real arm shape in it: `python -m benchmarks.shoulder.cuff`.

Along the shipped synthetic trial: what a padded cuff changes against the point of the paper, with the usual layers and
with layers as stiff as the point. Then one cuff at rest: the round arm of `padded_cuff` beside the upper arm of
meshes/upper_arm.stl, whose pressures are those of `loads.foundation` on 21 600 pieces of the wall.
"""

from __future__ import annotations

import json
import time
import warnings
from pathlib import Path
from typing import Any

import numpy as np
from casadi import SX, Function, cross, densify
from scipy.spatial.transform import Rotation

import geocontact as gc
from benchmarks.machine import machine, versions
from geocontact.dynamics.symbols import apply_numpy
from geocontact.dynamics.tree import Moving
from geocontact.geometry.surface_quadrature import SurfaceQuadrature
from geocontact.loads.foundation import Layer, Skin, pressed
from geocontact.shoulder_exoskeleton.cuff_contact import Cuff
from geocontact.shoulder_exoskeleton.device import Device, lucy
from geocontact.shoulder_exoskeleton.padded_cuff import ArmLine, CuffLaw, cuff_load
from geocontact.shoulder_exoskeleton.simulate import simulate_arm
from geocontact.shoulder_exoskeleton.work_phases import PHASES

ROOT = Path(__file__).resolve().parents[2]
TRIAL = ROOT / "meshes" / "overhead_P1T1S100"
AROUND, ALONG = 180, 120
"""Pieces of the wall."""
MIDDLE = 0.02
"""Where the cuff sits on the arm of the mesh [m], from its middle towards the elbow."""
POSES = ((0.0, 0.0, 0.0), (0.0, 2e-3, 0.0), (0.0, 4e-3, 0.0), (2e-3, 4e-3, 0.0), (0.0, 0.0, 0.05), (0.0, 4e-3, 0.05))
"""Medial and raising offset of the arm [m], tilt in the raising plane [rad]."""


LAYERS = ("pad_thickness", "pad_modulus", "tissue_thickness", "tissue_modulus")
STILL = {"damping": 0.0, "delta_full": 1e-3, "v_th": 1e-3, "mu_s": 0.0, "mu_k": 0.0}
"""Numbers of the law that do nothing at rest."""


def main() -> None:
    """Measure, print, write the JSON."""
    report = {"machine": machine(), "versions": versions({"numpy", "casadi"})}
    report |= {"trial": along_the_trial(), "at rest": at_rest()}
    file = ROOT / "benchmarks" / "results" / "shoulder_cuff.json"
    file.write_text(json.dumps(report, indent=1) + "\n", encoding="utf-8")
    print(json.dumps(report, indent=1))


def along_the_trial() -> list[dict[str, Any]]:
    """Means over the screw-in of the right arm, and the most at lowering."""
    found = []
    for level in (0.5, 1.0):
        for name, cuff, device in (
            ("point", "point", lucy()),
            ("surface", "surface", lucy()),
            ("as stiff as the point", "surface", as_stiff_as_the_point()),
        ):
            found.append({"level": level, "cuff": name} | one_trial(level, cuff, device))
    return found


def as_stiff_as_the_point() -> Device:
    """Layers so soft that the closed cuff gives way as the paper's point does: pi r L K = k."""
    device = lucy()
    h1, m1, h2, m2 = (device[name] for name in LAYERS)
    across = np.pi * device["cuff_radius"] * device["cuff_length"] / (h1 / m1 + h2 / m2)
    share = device["k"] / across
    return device.having(pad_modulus=share * m1, tissue_modulus=share * m2)


def one_trial(level: float, cuff: Cuff, device: Device) -> dict[str, float]:
    """Right arm; CPU seconds with what is compiled already."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        given = {"tool": TRIAL / "tool.csv", "upright": (0.0, 0.5), "side": "right"}
        arm = gc.shoulder.simulate(TRIAL / "markers.trc", level=level, **given).arms[0]
    motion, wearer = arm.simulation.motion, arm.simulation.wearer
    simulate_arm(motion, device, wearer, level, cuff=cuff)
    start = time.process_time()
    found = simulate_arm(motion, device, wearer, level, cuff=cuff)
    seconds = time.process_time() - start
    exact = simulate_arm(motion, device, wearer, level, cuff=cuff, tolerance=1e-10)
    working, lowering = (arm.phase == PHASES.index(phase) for phase in ("screw-in", "lower"))
    return {
        "elevation_deg": float(np.degrees(found.elevation[working].mean())),
        "supporting_N": float(found.supporting[working].mean()),
        "most_at_lowering_N": float(found.supporting[lowering].max()),
        "shear_N": float(found.shear[working].mean()),
        "couple_N_m": float(np.linalg.norm(found.outputs["couple"][working], axis=1).mean()),
        "peak_Pa": float(found.outputs["peak"][working].mean()),
        "pressed": float(found.outputs["share"][working].mean()),
        "times_real_time": float(np.ptp(motion.time) / seconds),
        "off_at_most_N": float(np.linalg.norm(found.outputs["force"] - exact.outputs["force"], axis=1).max()),
    }


def at_rest() -> list[dict[str, Any]]:
    """Force across, couple and pressure on the arm in each pose, of a round arm and of the mesh."""
    surface, radius = arm_of_the_mesh()
    law = {name: lucy()[name] for name in (*LAYERS, "interference")} | {"length": lucy()["cuff_length"]}
    law["radius"] = radius - law["interference"]
    found = []
    for pose in POSES:
        told = {"medial_mm": 1e3 * pose[0], "raising_mm": 1e3 * pose[1], "tilt_rad": pose[2]}
        found.append(told | {"round": round_arm(law, pose), "mesh": arm_mesh(surface, law, pose)})
    return found


def arm_of_the_mesh() -> tuple[gc.Surface, float]:
    """The arm in the cuff's axes (distal, medial, raising) about its own axis, and its mean radius in the cuff [m]."""
    read = gc.read_surface(ROOT / "meshes" / "upper_arm.stl", "mm")
    turned = np.column_stack([-read.vertices[:, 1] - MIDDLE, read.vertices[:, 0], -read.vertices[:, 2]])
    within = np.abs(turned[:, 0]) < 0.5 * lucy()["cuff_length"]
    turned[:, 1:] -= turned[within, 1:].mean(axis=0)
    radius = float(np.hypot(turned[within, 1], turned[within, 2]).mean())
    return gc.Surface(turned, read.faces, "upper arm"), radius


def arm_mesh(arm: gc.Surface, law: dict[str, float], pose: tuple[float, ...]) -> dict[str, Any]:
    """Elastic foundation of the padded wall, skin and muscle a layer of the arm."""
    angle = 2.0 * np.pi * (np.arange(AROUND) + 0.5) / AROUND
    x = law["length"] * ((np.arange(ALONG) + 0.5) / ALONG - 0.5)
    out = np.column_stack([np.zeros(AROUND), np.cos(angle), np.sin(angle)])
    point = (x[:, None, None] * np.array([1.0, 0.0, 0.0]) + law["radius"] * out).reshape(-1, 3)
    count = AROUND * ALONG
    area = np.full(count, 2.0 * np.pi * law["radius"] * law["length"] / count)
    wall = SurfaceQuadrature(point, area, -np.tile(out, (ALONG, 1)), np.arange(count))
    layer = Layer(wall, np.full(count, law["pad_thickness"]), law["pad_modulus"])
    skin = Skin(thickness=np.full(len(arm.faces), law["tissue_thickness"]), modulus=law["tissue_modulus"])
    turn = Rotation.from_rotvec([0.0, -pose[2], 0.0]).as_matrix()
    found = pressed(layer, arm, turn, np.array([0.0, *pose[:2]]), skin)
    on_the_arm = -found.load.wrench.force
    couple = -found.load.wrench.moment - np.cross([0.0, *pose[:2]], on_the_arm)
    return told(on_the_arm, couple, found.load.pressing, found.load.peak, found.load.area / area.sum())


def round_arm(law: dict[str, float], pose: tuple[float, ...]) -> dict[str, Any]:
    """`padded_cuff`, which the simulation has, at rest and without friction."""
    apply_numpy()
    still = SX(3, 1)
    line = ArmLine(SX([0.0, *pose[:2]]), still, SX([np.cos(pose[2]), 0.0, np.sin(pose[2])]), still)
    numbers = CuffLaw(**{name: SX(value) for name, value in (law | STILL).items()})
    load = cuff_load(line, Moving(SX.eye(3), still, still, still, still, still), SX.eye(3), still, numbers)
    couple = load.moment - cross(line.place, load.force)
    wanted = (load.normal, couple, load.pressing, load.peak, load.share)
    run = Function("f", [], [densify(each) for each in wanted])
    return told(*(np.array(each).ravel() for each in run.call([])))


def told(force: Any, couple: Any, pressing: Any, peak: Any, share: Any) -> dict[str, Any]:
    """Of one pose, on the arm, in the cuff's axes."""
    return {
        "force_N": np.round(force, 3).tolist(),
        "couple_N_m": np.round(couple, 4).tolist(),
        "pressing_N": float(np.squeeze(pressing)),
        "peak_Pa": float(np.squeeze(peak)),
        "pressed": float(np.squeeze(share)),
    }


if __name__ == "__main__":
    main()
