"""Areas against closed forms by rule, error and observed order: `python -m benchmarks.area.accuracy`.

The ball is turned several ways about its centre, and its centre about that of the sphere or cup below it, so that the
edge of the patch crosses both meshes every way; errors are root mean squares over these turns. With the ball on the
cup's axis the edge runs along the rings of the cup's mesh: the error then goes with the place of the nearest ring,
erratic from level to level, and its order means nothing (2.70 over four levels).
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from benchmarks.area.tables import markdown
from benchmarks.machine import machine
from geocontact.geometry.contact_area.area import RULES
from geocontact.geometry.contact_area.evolution import ContactPair, Settings
from geocontact.geometry.surface import Surface
from meshes.simple_shapes import block, cup, sphere
from tests import closed_forms as exact

THRESHOLD = 4.0
"""Millimetres, as all lengths of this module."""
COUNT = 8
TURNS = Rotation.random(COUNT, np.random.default_rng(20)).as_matrix()
Body = tuple[np.ndarray, np.ndarray]


@dataclass(frozen=True)
class Case:
    """A moving ball and a fixed body whose areas within the threshold are known [mm^2].

    The ball's centre is at (0, `height`, 0) [mm]; turning it about the origin by up to `tilt` [rad] changes no area.
    """

    name: str
    moving: Callable[[int], Body]
    fixed: Callable[[int], Body]
    height: float
    tilt: float
    on_moving: float
    on_fixed: float


def cases() -> list[Case]:
    """Ball over a plate, ball on a ball, ball in a cup."""
    gap, apart = 0.5, 20.0 + 18.0 + 0.5
    off, cup_radius, ball = 0.8, 24.0, 23.0
    return [
        Case(
            "sphere on plane",
            lambda n: sphere(20.0, n),
            lambda n: block(60.0, 60.0, 12.0, 3 * n),
            20.0 + gap,
            0.0,
            exact.sphere_plane_on_sphere(20.0, gap, THRESHOLD),
            exact.sphere_plane_on_plane(20.0, gap, THRESHOLD),
        ),
        Case(
            "sphere on sphere",
            lambda n: sphere(18.0, n),
            lambda n: sphere(20.0, n),
            apart,
            np.pi,
            exact.sphere_sphere_on_first(18.0, 20.0, gap, THRESHOLD),
            exact.sphere_sphere_on_first(20.0, 18.0, gap, THRESHOLD),
        ),
        Case(
            "sphere in cup",
            lambda n: sphere(ball, n),
            lambda n: cup(cup_radius, 5.0, n),
            -off,
            np.radians(25.0),  # the patch reaches 52 degrees around its middle, the cup 90 around its own
            exact.sphere_cup_on_sphere(ball, cup_radius, off, 0.5),
            exact.sphere_cup_on_cup(ball, cup_radius, off, 0.5),
        ),
    ]


def threshold_of(case: Case) -> float:
    """The cup is conforming: half a millimetre, so that the patch ends inside it."""
    return 0.5 if case.name == "sphere in cup" else THRESHOLD


def centres(case: Case) -> Float[np.ndarray, "k 3"]:
    """Of the ball [mm], one for each turn: uniform over the cap of directions within `tilt` of the y axis, seeded."""
    random = np.random.default_rng(21)
    cosine = random.uniform(np.cos(case.tilt), 1.0, COUNT)
    around, sine = random.uniform(0.0, 2.0 * np.pi, COUNT), np.sqrt(1.0 - cosine**2)
    directions = np.column_stack([sine * np.cos(around), cosine, sine * np.sin(around)])
    return case.height * directions


def errors(case: Case, n: int, rule: str) -> tuple[list[int], Float[np.ndarray, "2 k"]]:
    """Faces of moving and fixed, and for each of them the error of every turn relative to the closed form."""
    moving, fixed = (Surface(1e-3 * v, np.ascontiguousarray(f, np.int64)) for v, f in (case.moving(n), case.fixed(n)))
    pair = ContactPair(moving, fixed, Settings((1e-3 * threshold_of(case),), rule))
    places = zip(TURNS, 1e-3 * centres(case), strict=True)
    contacts = [pair.at(np.ascontiguousarray(turn), centre) for turn, centre in places]
    areas = 1e6 * np.array([[c.moving[0].area for c in contacts], [c.fixed[0].area for c in contacts]])
    return [len(moving.faces), len(fixed.faces)], areas / [[case.on_moving], [case.on_fixed]] - 1.0


def root_mean_square(error: Float[np.ndarray, "*n k"]) -> Float[np.ndarray, "*n"]:
    """Over the turns."""
    return np.asarray(np.sqrt(np.mean(error**2, axis=-1)))


def order(faces: Float[np.ndarray, " k"], error: Float[np.ndarray, " k"]) -> float:
    """Exponent of the edge length in the error."""
    return float(-2.0 * np.polyfit(np.log(faces), np.log(np.maximum(error, 1e-15)), 1)[0])


def rows_of(case: Case, cells: Sequence[int]) -> list[dict[str, object]]:
    """One row per surface and rule."""
    rows: list[dict[str, object]] = []
    for rule in RULES:
        found = [errors(case, n, rule) for n in cells]
        for side, name in enumerate(("moving", "fixed")):
            faces = np.array([counts[side] for counts, _ in found])
            signed = np.array([error[side] for _, error in found])
            error = root_mean_square(signed)
            extrapolated = root_mean_square((4.0 * signed[-1] - signed[-2]) / 3.0)
            rows.append(
                {
                    "case": case.name,
                    "surface": name,
                    "rule": rule,
                    "faces": faces.tolist(),
                    "relative_error": error.tolist(),
                    "order": order(faces, error),
                    "richardson": float(extrapolated),
                }
            )
    return sorted(rows, key=lambda row: str(row["surface"]), reverse=True)


def table(rows: list[dict[str, object]]) -> str:
    """Errors in percent, coarse mesh first; Richardson extrapolates the two finest meshes at order 2."""
    head = ["case", "area on", "rule", "faces", *["error"] * len(rows[0]["faces"]), "order", "Richardson"]  # type: ignore[arg-type]
    body = [
        [
            str(row["case"]),
            str(row["surface"]),
            str(row["rule"]),
            f"{row['faces'][0]} … {row['faces'][-1]}",  # type: ignore[index]
            *[f"{100 * e:.2g} %" for e in row["relative_error"]],  # type: ignore[attr-defined]
            f"{row['order']:.2f}",
            f"{100 * float(str(row['richardson'])):.1g} %",
        ]
        for row in rows
    ]
    return markdown(head, body)


def main() -> None:
    """Measure, print one table per case, write the JSON."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.area.accuracy", description=__doc__.splitlines()[0])
    parser.add_argument(
        "--cells", type=int, nargs="+", default=[8, 16, 32, 64], help="cells along an edge, coarse first"
    )
    parser.add_argument("--out", type=Path, default=Path(__file__).resolve().parents[1] / "results")
    options = parser.parse_args()
    found = []
    for case in cases():
        rows = rows_of(case, options.cells)
        print(table(rows), "\n", flush=True)
        found += rows
    options.out.mkdir(parents=True, exist_ok=True)
    (options.out / "accuracy.json").write_text(json.dumps({"machine": machine(), "rows": found}, indent=1) + "\n")


if __name__ == "__main__":
    main()
