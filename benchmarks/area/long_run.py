"""What a frame of a long run of `area` costs: `python -m benchmarks.area.long_run`; `--peers`: against other libraries.

The shipped knee at medium resolution through its gait cycle, interpolated to many poses; of each both maps, refined
areas with bounds, areas at 13 further thresholds, exact least distance and depth. CPU milliseconds a frame of one
process and one thread, the least of some rounds; reading, trees and compilation are not counted. With `--peers` the job
of `long_run_peers` instead, written to results/long_run_peers.json.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

from benchmarks.one_core import pin

MESHES = Path(__file__).resolve().parents[2] / "meshes"
MILLIMETRE = 1e-3


def main() -> None:
    """Measure and write the JSON."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.area.long_run", description=__doc__.splitlines()[0])
    parser.add_argument("--frames", type=int, help="300, with --peers 1001")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--peers", action="store_true", help="1001 frames of the larger pair against other libraries")
    parser.add_argument("--faces", type=int, default=50_000, help="of each body with --peers, about")
    parser.add_argument("--every", type=int, default=50, help="which frames peers do with --peers")
    options = parser.parse_args()
    options.frames = options.frames or (1001 if options.peers else 300)
    pin()
    if options.peers:
        against_peers(options)
    else:
        alone(options)


def against_peers(options: argparse.Namespace) -> None:
    """Both rows of geocontact and its peers through the same long motion; one line of each."""
    from benchmarks.area.long_run_peers import LIBIGL, compared, engines, long_pair, measured
    from benchmarks.engines.ours import OURS
    from benchmarks.machine import write_results

    pair, rows = long_pair(options.faces, options.frames), engines()
    found = measured(pair, rows, options.every, lambda line: print(line, file=sys.stderr, flush=True))
    table = compared(found, LIBIGL if LIBIGL in found else OURS)
    faces = {"moving": len(pair.moving.faces), "fixed": len(pair.fixed.faces)}
    figures = {"faces": faces, "poses": len(pair.rotation), "rows": table}
    file = write_results("long_run_peers", vars(options), figures, {engine.package for engine in rows})
    for name, row in table.items():
        ratio = f", {row['ratio']:.1f} times {row['compared_with']} (aim {row['aim']:g})" if "ratio" in row else ""
        off = f"areas within {row['largest_area_difference_percent']:.2g} %"
        sys.stdout.write(f"{name}: {row['cpu_s']:.1f} CPU s, {off}{ratio}\n")
    sys.stdout.write(f"{file.name}\n")


def alone(options: argparse.Namespace) -> None:
    """The shipped medium knee."""
    import numpy as np

    import geocontact as gc
    from benchmarks.machine import write_results
    from geocontact.analyses.area.bodies import BRIEF, SENSITIVITY
    from geocontact.geometry.contact_area.area import Refinement

    names = ("femoral_component", "tibial_insert")
    femoral, insert = (gc.read_surface(str(MESHES / f"{name}_right_medium.stl"), "mm") for name in names)
    cycle = gc.read_motion(str(MESHES / "gait.csv"))
    motion = cycle.at(np.linspace(cycle.time[0], cycle.time[-1], options.frames))
    sensitivity = tuple(4.0 * MILLIMETRE * SENSITIVITY)
    settings = gc.Settings((4.0 * MILLIMETRE,), refinement=Refinement(pieces=BRIEF), sensitivity=sensitivity)
    gc.area_evolution(femoral, insert, cycle, settings, workers=1)  # compiles the kernels
    seconds = []
    for _ in range(options.rounds):
        start = time.process_time()
        found = gc.area_evolution(femoral, insert, motion, settings, workers=1)
        seconds.append(time.process_time() - start)
    figures = {
        "faces": {"moving": len(femoral.faces), "fixed": len(insert.faces)},
        "ms_a_frame": [1e3 * each / options.frames for each in seconds],
        "least_ms_a_frame": 1e3 * min(seconds) / options.frames,
        "aim_ms_a_frame": 4.0,
        "frames_with_overlap": int((found.min_distance <= 0.0).sum()),
        "largest_area_fixed_mm2": float(found.fixed.area.max()) / MILLIMETRE**2,
        "greatest_depth_um": 1e6 * float(found.max_penetration_fixed.max()),
    }
    file = write_results("long_run", {"frames": options.frames, "rounds": options.rounds}, figures)
    sys.stdout.write(f"{figures['least_ms_a_frame']:.1f} CPU ms a frame: {file.name}\n")


if __name__ == "__main__":
    main()
