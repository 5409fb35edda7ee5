"""Motions, places and choices of faces for `geocontact area` and `geocontact fit`."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from benchmarks.same_outputs.inputs.text import table, written

POSES = "time [s], tx [mm], ty [mm], tz [mm], qw, qx, qy, qz"


STUDY = """\
analysis = "area"
files = "gait_{trial}.csv"

[options]
moving = "../meshes/femoral_component_right_coarse.stl"
fixed = "../meshes/tibial_insert_right_coarse.stl"
unit = "mm"
motion = "{file}"

[sweep]
threshold = [1, 4]

[[leave_out]]
trial = "11"
threshold = 1
"""

ON_SURFACE = """\
analysis = "area"
files = "ball_{subject}_{speed}.csv"

[options]
moving = "../meshes/sphere_r20.stl"
fixed = "../meshes/plate_80x80x12.stl"
unit = "mm"
motion = "{file}"
threshold = 8
save_map = true

[summary]
condition = "speed"

[surface]
particles = "plate.particles"
unit = "mm"
at = [0, 100]
"""


def make(home: Path, meshes: Path) -> None:
    """Some frames of the shipped cycle in every form that is read, and poses of a ball on a plate."""
    for name, frames in (("gait_a", (0, 30)), ("gait_b", (15, 60)), ("gait_11", range(0, 101, 10))):
        written(home / f"{name}.csv", rows((meshes / "gait.csv").read_text("utf-8"), 1, frames))
    written(home / "left.csv", rows((meshes / "gait_left.csv").read_text("utf-8"), 1, (0, 30)))
    text = (meshes / "gait.mot").read_text("utf-8")
    head = text.splitlines().index("endheader") + 2
    written(home / "gait.mot", rows(text, head, (0, 30)).replace("nRows=101", "nRows=2"))
    clinical(home / "clinical.csv", text.splitlines()[head:])
    pressed = "\n".join(f"{k},3,{20.0 - depth},-2,1,0,0,0" for k, depth in enumerate((0.3, 0.1, -0.5)))
    written(home / "ball.csv", f"{POSES}\n{pressed}\n")
    written(home / "study.toml", STUDY)
    on_surface(home)
    written(home / "place.txt", "1 0 0 0.5\n0 1 0 0.2\n0 0 1 -0.3\n0 0 0 1\n")
    written(home / "faces.txt", " ".join(map(str, range(0, 1500, 3))) + "\n")
    written(home / "measured.csv", "time [s], threshold [mm], area_fixed [mm^2]\n0.1,4,2200\n0.2,4,2300\n")


def on_surface(home: Path) -> None:
    """Three subjects whose ball comes nearer to a plate, slowly and fast, and places on that plate."""
    for k, subject in enumerate("ABC"):
        for speed, nearer in (("slow", 1.0), ("fast", 2.0)):
            heights = (23.0 + 0.1 * k, 23.0 + 0.1 * k * k - nearer)
            lines = "\n".join(f"{t},0,{height},0,1,0,0,0" for t, height in enumerate(heights))
            written(home / f"ball_{subject}_{speed}.csv", f"{POSES}\n{lines}\n")
    places = "\n".join(f"{x} 0 {z}" for x in (-12, 0, 12) for z in (-9, 0.3, 9))
    written(home / "plate.particles", places + "\n")
    written(home / "surface.toml", ON_SURFACE)


def rows(text: str, head: int, frames: object) -> str:
    """The head of a table, and some of its rows."""
    lines = text.splitlines()
    return "\n".join([*lines[:head], *(lines[head + k] for k in frames)]) + "\n"  # type: ignore[attr-defined]


def clinical(file: Path, lines: list[str]) -> None:
    """Two frames by the angles of Grood and Suntay; lengths in mm."""
    values = np.array([lines[k].split() for k in (0, 30)], dtype=float)
    values[:, 2:4] *= -1.0
    values[:, 4:] *= 1e3
    angles, shifts = ("flexion", "adduction", "rotation"), ("tx", "ty", "tz")
    names = ["time [s]", *(f"{name} [deg]" for name in angles), *(f"{name} [mm]" for name in shifts)]
    table(file, dict(zip(names, values.T, strict=True)))
