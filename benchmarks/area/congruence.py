"""Congruence of surfaces that are known, and of two subtalar joints over stance: `python -m
benchmarks.area.congruence`.

Balls against a ball and in sockets, with and without noise on the vertices, over the radius within which curvatures
are fitted, beside 1/r1 ± 1/r2. With `--data`, the two people of `jma_ankles` (bones by CT, both moving): every 12th
frame of the first 85 % of stance within 4 mm, as both recordings end before toe-off. Mean, least and largest over the
frames; seconds with the areas.
"""

from __future__ import annotations

import argparse
import json
import tempfile
import time
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

import geocontact as gc
from benchmarks.machine import as_json, stamp
from geocontact.geometry.contact_area.congruence import CongruencePair
from geocontact.geometry.contact_area.evolution import Settings
from geocontact.geometry.surface import Surface
from meshes import simple_shapes

HERE = Path(__file__).resolve().parents[1]
STANCE = {"Norm_01": (10, 133), "Norm_03": (17, 177)}
"""Frames of heel strike and toe-off, as *_Event.xlsx has them."""
SHARE, STEP, THRESHOLD = 0.85, 12, 4e-3
RADII = (2e-3, 3e-3, 4e-3, 6e-3)
NOISE = 0.05e-3  # m, standard deviation on each coordinate of each vertex
SEED = 1
SHOWN = {
    "area_fixed [mm^2]": "area_mm2",
    "min_distance [mm]": "least_distance_mm",
    "relative_curvature_min [1/mm]": "relative_curvature_min_per_mm",
    "relative_curvature_max [1/mm]": "relative_curvature_max_per_mm",
    "congruence_index [1/mm]": "index_per_mm",
    "congruence_share [-]": "share",
}


def main() -> None:
    """Measure, print, write the JSON after every row."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.area.congruence", description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, help="folder of the real recordings")
    parser.add_argument("--out", type=Path, default=HERE / "results")
    options = parser.parse_args()
    report: dict[str, Any] = {**stamp({"scipy"}), "seed": SEED, "known": [], "ankles": []}
    options.out.mkdir(parents=True, exist_ok=True)
    for part, rows in (("known", known()), ("ankles", ankles(options.data) if options.data else ())):
        for row in rows:
            report[part].append(row)
            print(json.dumps(row), flush=True)
            (options.out / "congruence.json").write_text(as_json(report), encoding="utf-8")


def known() -> Iterator[dict[str, Any]]:
    """Balls of 20 mm against one of 20 mm and in sockets of 24 and 20.5 mm, triangles of about 1 mm."""
    ball = simple_shapes.sphere(20.0, 24)
    cases = {
        "ball of 20 mm on another": (ball, (0.0, 40.2, 0.0), 0.1),
        "ball of 20 mm in a socket of 24 mm": (simple_shapes.cup(24.0, 5.0, 36), (0.0, -3.9, 0.0), 1 / 20 - 1 / 24),
        "ball of 20 mm in a socket of 20.5 mm": (simple_shapes.cup(20.5, 5.0, 32), (0.0, -0.4, 0.0), 1 / 20 - 1 / 20.5),
    }
    rng = np.random.default_rng(SEED)
    for name, (other, shift, true) in cases.items():
        for noise in (0.0, NOISE):
            moving, fixed = (Surface(v * 1e-3 + noise * rng.standard_normal(v.shape), f) for v, f in (ball, other))
            for radius in RADII:
                pair = CongruencePair(moving, fixed, Settings(thresholds=(1e-3,)), radius)
                found = pair.at(np.eye(3), np.array(shift) * 1e-3)
                yield {
                    "case": name,
                    "noise_mm": noise * 1e3,
                    "radius_mm": radius * 1e3,
                    "true_per_mm": round(true, 6),
                    "index_per_mm": round(float(found.index[0]) * 1e-3, 6),
                    "min_per_mm": round(float(found.least[0]) * 1e-3, 6),
                    "max_per_mm": round(float(found.most[0]) * 1e-3, 6),
                    "share": round(float(found.share[0]), 4),
                }


def ankles(data: Path) -> Iterator[dict[str, Any]]:
    """Talus in the frame of the calcaneus, which is FIXED."""
    with tempfile.TemporaryDirectory() as folder:
        for person, (strike, off) in STANCE.items():
            home, made = data / "jma_ankles" / person, {}
            for bone in ("Talus", "Calcaneus"):
                rows = (home / f"{person}_Walk_{bone}.txt").read_text(encoding="utf-8").split()
                made[bone] = Path(folder) / f"{person}_{bone}.txt"
                part = rows[strike - 1 : strike + int(SHARE * (off - strike)) : STEP]
                made[bone].write_text("\n".join(part) + "\n", encoding="utf-8")
            bodies = home / f"{person}_Talus.stl", home / f"{person}_Calcaneus_Right.stl"
            motions = {"motion": (str(made["Talus"]),), "motion_fixed": (str(made["Calcaneus"]),)}
            for radius in RADII:
                begun = time.process_time()
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore", gc.InputWarning)
                    result = gc.area(*bodies, unit="mm", **motions, rate=1.0, threshold=(THRESHOLD,), congruence=radius)
                seconds = time.process_time() - begun
                table = result.table()
                spans = {key: [round(float(v), 5) for v in _span(table[name])] for name, key in SHOWN.items()}
                yield {
                    "person": person, "radius_mm": radius * 1e3, "threshold_mm": THRESHOLD * 1e3,
                    "frames": len(table), "cpu_s_with_areas": round(seconds, 1), **spans,
                }  # fmt: skip


def _span(values: Any) -> tuple[float, float, float]:
    """Mean, least and largest."""
    return values.mean(), values.min(), values.max()


if __name__ == "__main__":
    main()
