"""Pressure maps per second on one core, and how far forces depend on the mesh: `python -m benchmarks.area.pressure`.

Speed: a femoral component on a tibial insert, both synthetic, of about so many faces each; the poses of the shipped
gait, sunk 0.5 mm so that something is pressed; pieces of 0.5 mm, the default of `geocontact area --pressure`, and one
piece per face. Thickness by rays, normals and trees are built beforehand.

Refinement: the force in several frames at several depths against that of the same bodies in 400 000 faces each; and,
where the real data are, of subject DM's implants in the recorded poses against that of their own surfaces with every
face cut into sixteen, new corners on the smooth surface. Triangles as they are (flat) and as facets of smooth surfaces
(smooth).
"""

from __future__ import annotations

import argparse
import json
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks.one_core import pin

HERE = Path(__file__).resolve().parents[1]
SUNK = 0.5e-3  # m, where speed is measured
DEPTHS = (0.2e-3, 0.5e-3, 1.0e-3)  # m
PIECE = 0.5e-3  # m
FRAMES = 5  # of the gait, in which forces are compared
FINEST = 400_000  # faces of each body that refinement is held against
MODULUS = 2.3e9  # Pa; confined modulus of 500 MPa and 0.46


def main() -> None:
    """Measure, print, write the JSON."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.area.pressure", description=__doc__.splitlines()[0])
    parser.add_argument("--faces", type=int, nargs="+", default=[10_000, 100_000])
    parser.add_argument("--frames", type=int, default=51)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--out", type=Path, default=HERE / "results")
    options = parser.parse_args()
    pin()
    from benchmarks.machine import machine, versions

    ways = [(faces, smooth) for faces in options.faces for smooth in (False, True)]
    speed = [
        told(speed_of(faces, options.frames, options.rounds, smooth, edge))
        for faces, smooth in ways
        for edge in (PIECE, np.inf)
    ]
    finest = sunk_forces("knee", FINEST, True)
    refinement = [told(beside(sunk_forces("knee", faces, smooth), finest, faces, smooth)) for faces, smooth in ways]
    report = {
        "machine": machine(), "versions": versions({"scipy"}), "frames": options.frames, "piece_m": PIECE,
        "speed": speed, "refinement": {"frames": FRAMES, "sunk_m": DEPTHS, "finest_N": rounded(finest.force),
                                       "rows": refinement},
    }  # fmt: skip
    try:
        report["real"] = real()
    except FileNotFoundError as absent:
        print(absent)
    (options.out / "pressure.json").write_text(json.dumps(report, indent=1) + "\n", encoding="utf-8")


def told(row: dict[str, object]) -> dict[str, object]:
    """The row, printed."""
    print(json.dumps(row), flush=True)
    return row


@dataclass(frozen=True)
class Forces:
    """Force by frame and depth [N], and the faces of both bodies."""

    force: np.ndarray
    faces: tuple[int, int]


def bed_of(insert, edge: float, smooth: bool):
    """The insert's upper faces as a layer, and what building it costs."""
    from dataclasses import replace

    from geocontact.geometry.curvature import corner_normals, phong_offset
    from geocontact.geometry.surface_quadrature import surface_quadrature, thickness_below
    from geocontact.loads.foundation import Layer

    started = time.process_time()
    pieces = surface_quadrature(insert, edge, insert.face_normal[:, 1] > 0.25)
    layer = Layer(pieces, thickness_below(insert, pieces.point, pieces.normal), MODULUS)
    if smooth:
        layer = replace(layer, height=phong_offset(insert, corner_normals(insert), pieces.face, pieces.point))
    return layer, time.process_time() - started


def skin_of(femur, smooth: bool):
    """What the femoral component brings."""
    from geocontact.geometry.curvature import corner_normals
    from geocontact.loads.foundation import Skin

    return Skin(corner_normals(femur)) if smooth else Skin()


def speed_of(faces: int, frames: int, rounds: int, smooth: bool, edge: float) -> dict[str, object]:
    """Frames per second of pressure maps, the best of some rounds, and the seconds of the rays."""
    from benchmarks.pairs import PAIRS
    from geocontact.loads.foundation import pressed

    pair = PAIRS["knee"](faces, frames)
    layer, rays = bed_of(pair.fixed, edge, smooth)
    skin = skin_of(pair.moving, smooth)
    poses = list(zip(pair.rotation, pair.translation - [0.0, SUNK, 0.0], strict=True))
    pressed(layer, pair.moving, *poses[0], skin)
    best, forces = np.inf, []
    for _ in range(rounds):
        started = time.process_time()
        forces = [pressed(layer, pair.moving, r, t, skin).load.pressing for r, t in poses]
        best = min(best, time.process_time() - started)
    return {
        "facets": "smooth" if smooth else "flat", "pieces": "0.5 mm" if np.isfinite(edge) else "per face",
        "faces_asked": faces, "faces_moving": len(pair.moving.faces), "faces_fixed": len(pair.fixed.faces),
        "number_of_pieces": len(layer.pieces.area), "frames_per_second": round(frames / best, 1),
        "rays_s": round(rays, 3), "largest_force_N": round(max(forces), 3),
    }  # fmt: skip


def sunk_forces(name: str, faces: int, smooth: bool) -> Forces:
    """Forces in frames spread over the gait, at each depth, pieces of the default size."""
    from benchmarks.pairs import PAIRS

    pair = PAIRS[name](faces, FRAMES)
    return forces_of(pair.moving, pair.fixed, pair.rotation, pair.translation, smooth, DEPTHS)


def forces_of(femur, insert, rotation, translation, smooth: bool, depths, most: float = PIECE) -> Forces:
    """Forces of two bodies in these poses, sunk by each depth."""
    from geocontact.loads.foundation import pressed

    layer, _ = bed_of(insert, most, smooth)
    skin = skin_of(femur, smooth)
    found = [
        [pressed(layer, femur, r, t - [0.0, depth, 0.0], skin).load.pressing for depth in depths]
        for r, t in zip(rotation, translation, strict=True)
    ]
    return Forces(np.array(found), (len(femur.faces), len(insert.faces)))


def beside(ours: Forces, finest: Forces, faces: int, smooth: bool) -> dict[str, object]:
    """By how much forces are off, by depth: the largest over the frames in which that depth presses at all."""
    worst = {}
    for k, depth in enumerate(DEPTHS):
        pressing = finest.force[:, k] > 0.0
        off = ours.force[pressing, k] / finest.force[pressing, k] - 1.0
        worst[f"{depth * 1e3:g} mm"] = round(float(off[np.argmax(np.abs(off))]), 6)
    return {"facets": "smooth" if smooth else "flat", "faces_asked": faces, "off_worst_frame": worst}


def refined(surface, times: int = 2):
    """Every face cut into four, so many times; new corners on the smooth surface, creases kept."""
    from geocontact.geometry.curvature import corner_normals, phong_offset
    from geocontact.geometry.surface import Surface

    for _ in range(times):
        normals = corner_normals(surface)
        vertices, faces = surface.vertices[surface.topology.merged], surface.topology.merged[surface.faces]
        edges = np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        unique, place = np.unique(edges, axis=0, return_inverse=True)
        middle = vertices[unique].mean(axis=1)
        normal = np.zeros((len(unique), 3))
        face = np.arange(len(faces)).repeat(3)
        lift = phong_offset(surface, normals, face, vertices[edges].mean(axis=1))
        np.add.at(normal, place.ravel(), surface.face_normal[face])
        height = np.bincount(place.ravel(), lift, len(unique)) / np.bincount(place.ravel(), minlength=len(unique))
        normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-300)
        a, b, c = faces.T
        ab, bc, ca = (place.ravel().reshape(-1, 3) + len(vertices)).T
        faces = np.concatenate([np.column_stack(t) for t in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])
        surface = Surface(np.concatenate([vertices, middle + height[:, None] * normal]), faces, surface.name)
    return surface


def real(frames: int = FRAMES) -> dict[str, object]:
    """Forces of subject DM's implants in recorded poses that overlap, and of their refined surfaces, taken flat."""
    from benchmarks.pairs import PAIRS

    pair = PAIRS["dm"](0, frames)
    bodies, poses = (pair.moving, pair.fixed), (pair.rotation, pair.translation)
    fine = forces_of(*(refined(body) for body in bodies), *poses, False, (0.0,))
    rows = {
        facets: forces_of(*bodies, *poses, smooth, (0.0,)).force[:, 0]
        for facets, smooth in (("flat", False), ("smooth", True))
    }
    pressing = fine.force[:, 0] > 0.01 * fine.force.max()
    return told({
        "pair": "dm", "faces": [len(body.faces) for body in bodies], "faces_refined": list(fine.faces),
        "frames_pressed": int(pressing.sum()), "refined_N": rounded(fine.force[:, 0]),
        **{f"off_{facets}": rounded(force[pressing] / fine.force[pressing, 0] - 1.0) for facets, force in rows.items()},
    })  # fmt: skip


def rounded(values: np.ndarray) -> list:
    """Numbers for the JSON."""
    return np.round(values, 6).tolist()


if __name__ == "__main__":
    main()
