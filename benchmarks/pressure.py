"""Pressure maps per second on one core: `python -m benchmarks.pressure [--faces 10000 100000]`.

A femoral component on a tibial insert, both synthetic, of about so many faces each, one piece per face; the poses of
the shipped gait, sunk 0.5 mm so that something is pressed. Thickness by rays, normals and trees are built beforehand.
Then how far the force is from that of the same bodies in 400 000 faces each. Both with triangles as they are (flat)
and as facets of smooth surfaces (smooth).
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from pathlib import Path

from benchmarks.one_core import pin

HERE = Path(__file__).resolve().parent
SUNK = 0.5e-3  # m
FINEST = 400_000  # faces of each body that refinement is held against
MODULUS = 2.3e9  # Pa; confined modulus of 500 MPa and 0.46


def main() -> None:
    """Measure, print, write the JSON."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.pressure", description=__doc__.splitlines()[0])
    parser.add_argument("--faces", type=int, nargs="+", default=[10_000, 100_000])
    parser.add_argument("--frames", type=int, default=51)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--out", type=Path, default=HERE / "results")
    options = parser.parse_args()
    pin()
    from benchmarks.machine import machine

    ways = [(faces, smooth) for faces in options.faces for smooth in (False, True)]
    rows = [measured(faces, options.frames, options.rounds, smooth) for faces, smooth in ways]
    finest = {smooth: one_force(FINEST, 0.1e-3, smooth) for smooth in (False, True)}
    refinement = [refined(faces, finest[smooth], smooth) for faces, smooth in ways]
    for row in [*rows, *refinement]:
        print(json.dumps(row))
    report = {"machine": machine(), "frames": options.frames, "speed": rows, "refinement": refinement}
    (options.out / "pressure.json").write_text(json.dumps(report, indent=2) + "\n", encoding="utf-8")


def bed_of(insert, edge: float, smooth: bool):
    """The insert's upper faces as a layer, and what building it costs."""
    from dataclasses import replace

    from geocontact.geometry.bulge import bulge, corner_normals
    from geocontact.geometry.pieces import pieces_of
    from geocontact.geometry.thickness import thickness_below
    from geocontact.loads.foundation import Layer

    started = time.process_time()
    pieces = pieces_of(insert, edge, insert.face_normal[:, 1] > 0.25)
    layer = Layer(pieces, thickness_below(insert, pieces.point, pieces.normal), MODULUS)
    if smooth:
        layer = replace(layer, height=bulge(insert, corner_normals(insert), pieces.face, pieces.point))
    return layer, time.process_time() - started


def skin_of(femur, smooth: bool):
    """What the femoral component brings."""
    from geocontact.geometry.bulge import corner_normals
    from geocontact.loads.foundation import Skin

    return Skin(corner_normals(femur)) if smooth else Skin()


def measured(faces: int, frames: int, rounds: int, smooth: bool) -> dict[str, float]:
    """Frames per second of pressure maps, the best of some rounds, and the seconds of the rays."""
    import numpy as np

    from benchmarks.pairs import PAIRS
    from geocontact.loads.foundation import pressed

    pair = PAIRS["knee"](faces, frames)
    femur, insert, rotation, translation = bodies(pair)
    layer, rays = bed_of(insert, np.inf, smooth)
    skin = skin_of(femur, smooth)
    pressed(layer, femur, rotation[0], translation[0], skin)
    best, forces = np.inf, []
    for _ in range(rounds):
        started = time.process_time()
        found = [pressed(layer, femur, r, t, skin) for r, t in zip(rotation, translation, strict=True)]
        best = min(best, time.process_time() - started)
        forces = [frame.load.pressing for frame in found]
        print(f"{faces} faces: {best:.3f} s", file=sys.stderr, flush=True)
    return {
        "facets": "smooth" if smooth else "flat", "faces_asked": faces, "faces_moving": len(femur.faces),
        "faces_fixed": len(insert.faces),
        "pieces": len(layer.pieces.area), "frames_per_second": round(frames / best, 1), "rays_s": round(rays, 3),
        "largest_force_N": round(max(forces), 3),
    }  # fmt: skip


def refined(faces: int, finest: float, smooth: bool) -> dict[str, float]:
    """Force in one frame with one piece per face and with pieces of 0.5 mm, against the finest mesh's."""
    import numpy as np

    force = {
        name: one_force(faces, edge, smooth) for name, edge in (("per_face", np.inf), ("pieces_of_0.5_mm", 0.5e-3))
    }
    row: dict[str, float] = {
        "facets": "smooth" if smooth else "flat",
        "faces_asked": faces,
        "finest_mesh_N": round(finest, 3),
    }
    return row | {f"off_{name}": round(value / finest - 1.0, 6) for name, value in force.items()}


def one_force(faces: int, edge: float, smooth: bool) -> float:
    """Force in one frame of meshes of about so many faces [N]."""
    from benchmarks.pairs import PAIRS
    from geocontact.loads.foundation import pressed

    femur, insert, rotation, translation = bodies(PAIRS["knee"](faces, 3))
    layer, _ = bed_of(insert, edge, smooth)
    return pressed(layer, femur, rotation[1], translation[1], skin_of(femur, smooth)).load.pressing


def bodies(pair):
    """Both surfaces and the poses, sunk."""
    return pair.moving, pair.fixed, pair.rotation, pair.translation - [0.0, SUNK, 0.0]


if __name__ == "__main__":
    main()
