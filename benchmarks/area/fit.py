"""Cylinder fit at 1e5 points beside other fitters: `python -m benchmarks.area.fit`.

Synthetic wall of radius 37 mm, length 60 mm, noise 0.1 mm, a fifth of the points outliers; seconds of the processor on
one core, largest error of the radius over seeds. scikit-spatial is measured where it is installed. Then the coverage of
the 95 % interval of the radius on smaller clouds: independent noise, few points, and errors that neighbours share.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Callable
from pathlib import Path

from benchmarks import one_core

one_core.pin()

import numpy as np  # noqa: E402
from scipy.optimize import least_squares  # noqa: E402

from benchmarks.area.tables import markdown  # noqa: E402
from benchmarks.machine import machine, versions  # noqa: E402
from geocontact.geometry.fit.cylinder import fit_cylinder  # noqa: E402
from tests.geometry.fit.clouds import CLOUDS, RADIUS, spoilt  # noqa: E402

KINDS = ("anywhere", "inside", "another face")
Fitter = Callable[[np.ndarray], float]


def ours(cloud: np.ndarray) -> float:
    """Radius [m] by `geocontact fit`."""
    return float(fit_cylinder(cloud).radius or np.nan)


def plain_from_one_start(cloud: np.ndarray) -> float:
    """Radius by least squares without loss, from the direction of largest extent of the points, differences."""
    middle = cloud.mean(axis=0)
    axis = np.linalg.svd(cloud - middle, full_matrices=False)[2][0]
    spare = np.linalg.svd(axis[None])[2][1:]

    def residual(x: np.ndarray) -> np.ndarray:
        way = axis + x[:2] @ spare
        way /= np.linalg.norm(way)
        return np.linalg.norm(np.cross(cloud - middle - x[2:4] @ spare, way), axis=1) - x[4]

    return float(abs(least_squares(residual, [0.0, 0.0, 0.0, 0.0, 0.03], x_scale=[1.0, 1.0, 0.01, 0.01, 0.01]).x[4]))


def plain_ours(cloud: np.ndarray) -> float:
    """Radius by our own search without its loss (`--no-robust`)."""
    return float(fit_cylinder(cloud, robust=False).radius or np.nan)


def scikit_spatial(cloud: np.ndarray) -> float:
    """Radius by scikit-spatial, which needs memory with the square of the points."""
    from skspatial.objects import Cylinder

    return float(Cylinder.best_fit(cloud).radius)


FITTERS: dict[str, tuple[Fitter, int]] = {
    "geocontact": (ours, 100_000),
    "geocontact --no-robust": (plain_ours, 100_000),
    "least squares, one start": (plain_from_one_start, 100_000),
    "scikit-spatial": (scikit_spatial, 5_000),
}
"""Fitter, and the most points that it can take."""


def rows_of(arc: float, count: int, seeds: int) -> list[dict[str, object]]:
    """A row per kind of outliers and fitter; all fitters in turn on the same cloud."""
    rows: list[dict[str, object]] = []
    for kind in KINDS:
        seconds: dict[str, list[float]] = {name: [] for name in FITTERS}
        errors: dict[str, list[float]] = {name: [] for name in FITTERS}
        for seed in range(seeds):
            cloud = spoilt(arc, count, seed, kind)
            for name, (fitter, most) in FITTERS.items():
                some = cloud[np.random.default_rng(seed).permutation(count)[:most]]
                start = time.process_time()
                try:
                    radius = fitter(some)
                except ImportError:
                    continue
                seconds[name].append(time.process_time() - start)
                errors[name].append(radius - RADIUS)
        rows += [
            {
                "arc_deg": arc,
                "outliers": kind,
                "fitter": name,
                "points": min(count, FITTERS[name][1]),
                "seconds": float(np.median(seconds[name])),
                "ratio_to_ours": float(np.median(seconds[name]) / np.median(seconds["geocontact"])),
                "largest_error_m": float(np.max(np.abs(errors[name]))),
            }
            for name in FITTERS
            if seconds[name]
        ]
    return rows


def coverage(runs: int) -> list[dict[str, object]]:
    """Share of runs whose interval holds the radius, and the median half-width over the spread of the radius."""
    rows: list[dict[str, object]] = []
    for kind, cloud in CLOUDS.items():
        fits = [fit_cylinder(cloud(seed)) for seed in range(runs)]
        held = np.mean([low <= RADIUS <= high for low, high in (fit.radius_interval for fit in fits)])
        ratio = np.median([fit.quality.half_widths[-1] for fit in fits]) / np.std([fit.radius for fit in fits])
        rows.append({"errors": kind, "runs": runs, "held": float(held), "half_width_over_sd": round(float(ratio), 3)})
        print(json.dumps(rows[-1]), flush=True)
    return rows


def main() -> None:
    """Measure, print one table, write the JSON."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.area.fit", description=__doc__.splitlines()[0])
    parser.add_argument("--points", type=int, default=100_000)
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--runs", type=int, default=1000, help="of the coverage")
    parser.add_argument("--out", type=Path, default=Path(__file__).resolve().parents[1] / "results")
    options = parser.parse_args()
    rows = [row for arc in (360.0, 120.0, 60.0) for row in rows_of(arc, options.points, options.seeds)]
    head = ["arc [°]", "a fifth of outliers", "fitter", "points", "CPU [s]", "÷ ours", "largest |ΔR| [mm]"]
    body = [
        [
            f"{row['arc_deg']:g}", str(row["outliers"]), str(row["fitter"]), str(row["points"]),
            f"{row['seconds']:.2f}", f"{row['ratio_to_ours']:.2g}", f"{1e3 * float(str(row['largest_error_m'])):.3g}",
        ]
        for row in rows
    ]  # fmt: skip
    print(markdown(head, body))
    options.out.mkdir(parents=True, exist_ok=True)
    found = {
        "machine": machine(),
        "versions": versions({"scipy", "scikit-spatial"}),
        "rows": rows,
        "coverage": coverage(options.runs),
    }
    (options.out / "fit.json").write_text(json.dumps(found, indent=1) + "\n")


if __name__ == "__main__":
    main()
