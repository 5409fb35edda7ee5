"""What a frame of a long run of `area` costs: `python -m benchmarks.area.long_run`.

The shipped knee at medium resolution through its gait cycle, interpolated to many poses; of each both maps, refined
areas with bounds, areas at 13 further thresholds, exact least distance and depth. CPU milliseconds a frame of one
process and one thread, the least of some rounds; reading, trees and compilation are not counted.
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
    parser.add_argument("--frames", type=int, default=300)
    parser.add_argument("--rounds", type=int, default=3)
    options = parser.parse_args()
    pin()
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
    file = write_results("long_run", vars(options), figures)
    sys.stdout.write(f"{figures['least_ms_a_frame']:.1f} CPU ms a frame: {file.name}\n")


if __name__ == "__main__":
    main()
