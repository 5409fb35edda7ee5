"""A sole of spheres, its motion on the ground, a force law and a force plate, for `geocontact cop`."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from benchmarks.same_outputs.inputs.text import storage, table, written

TIME = np.linspace(0.0, 0.8, 81)


def make(home: Path, meshes: Path) -> None:
    """Fifteen spheres in three zones; heel strike, flat foot, heel rise in the sagittal plane."""
    spheres(home / "spheres.csv")
    x, y, pitch = motion(TIME, 0.004)
    storage(home / "foot.mot", {"time": TIME, "x": x, "y": y, "pitch": pitch})
    half = 0.5 * pitch
    still = np.zeros_like(TIME)
    quaternion = {"qw": np.cos(half), "qx": still, "qy": still, "qz": np.sin(half)}
    table(home / "foot.csv", {"time [s]": TIME, "tx [m]": x, "ty [m]": y, "tz [m]": still, **quaternion})
    law = "n = 1.5\nmu_s = 0.8\nmu_k = 0.6\ndelta_full = 0.002\nv_th = 0.2\nk = 9e4\nb = 200.0\n"
    written(home / "law.toml", law + "[zone.z1]\nk = 7e4\nb = 300.0\n")
    plate(home / "plate.mot")


def spheres(file: Path) -> None:
    """The table of the sole; lengths in m."""
    rows = [f"{0.22 * i / 14:.6f},0.012,0.0,0.011,z{1 + i // 5}" for i in range(15)]
    written(file, "\n".join(["px [m],py [m],pz [m],radius [m],zone", *rows]) + "\n")


def motion(time: np.ndarray, depth: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """x, y [m] and pitch [rad] of the foot, which sinks up to `depth` [m]; a trial lasts 0.8 s."""
    phase = time / 0.8
    pitch = 0.25 - 0.7 * phase**2 + 0.06 * np.sin(3.0 * np.pi * phase)
    places = np.linspace(0.0, 0.22, 15)[:, None]
    lowest = np.min(places * np.sin(pitch) + 0.012 * np.cos(pitch) - 0.011, axis=0)
    y = -lowest - depth * np.sin(np.pi * (0.05 + 0.9 * phase)) * (1.0 + 0.3 * np.cos(4.0 * np.pi * phase))
    return 0.02 * phase + 0.003 * np.sin(2.0 * np.pi * phase), y, pitch


def plate(file: Path) -> None:
    """Reactions of a plate [N, m, N m] that loads two feet alike."""
    rise = np.sin(np.pi * TIME / 0.8)
    still = np.zeros_like(TIME)
    sides = {}
    for side in ("r", "l"):
        force = {"vx": 30.0 * np.cos(np.pi * TIME / 0.8), "vy": 700.0 * rise, "vz": 5.0 * rise}
        point = {"px": 0.02 + 0.25 * TIME, "py": still, "pz": still + 0.01}
        sides |= {f"ground_force_{side}_{name}": values for name, values in (force | point).items()}
        sides |= {f"ground_torque_{side}_{axis}": still for axis in "xyz"}
    storage(file, {"time": TIME, **sides})
