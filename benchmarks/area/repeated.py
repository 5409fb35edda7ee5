"""The clipped area at many poses in the field of a fixed surface: `python -m benchmarks.area.repeated`.

The job of `benchmarks.area.peers` again, without the map: 101 poses of A at about 5e4 × 5e4 faces, area of A within 4
mm of B. CPU seconds of one process and one thread, what is prepared once not counted (told beside it); all in turn.
Peers do every tenth frame. Areas are compared with the exact clip of geocontact's own map in every frame.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from pathlib import Path

from benchmarks.one_core import pin

HERE = Path(__file__).resolve().parents[1]
PEERS = {"libigl": 40.0, "open3d": 30.0}
"""Peers and how many times as long they should take."""
EVERY = 10


def main() -> None:
    """Measure and write the JSON, anew after each round."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.area.repeated", description=__doc__.splitlines()[0])
    parser.add_argument("--faces", type=int, default=50_000)
    parser.add_argument("--rounds", type=int, default=5)
    options = parser.parse_args()
    pin()
    import numpy as np

    from benchmarks.engines.all import all_engines
    from benchmarks.engines.ours import OURS
    from benchmarks.machine import commit, machine, versions
    from benchmarks.pairs import THRESHOLD, knee
    from geocontact.geometry.contact_area.repeated import RepeatedArea

    pair = knee(options.faces, 101)
    engines = [e for e in all_engines() if e.name == OURS or (e.package in PEERS and not e.points)]
    steps = {e.name: e.prepare(pair) for e in engines}
    exact = np.array([steps[OURS](k).area for k in range(len(pair.rotation))])
    start = time.process_time()
    areas = RepeatedArea(pair.moving, pair.fixed, THRESHOLD)
    prepared = time.process_time() - start
    found = areas.at(pair.rotation, pair.translation, 1)
    rows: dict[str, list[float]] = {"repeated": [], **{name: [] for name in steps}}
    for _ in range(options.rounds):
        for name, seconds in rows.items():
            every = EVERY if name not in ("repeated", OURS) else 1
            start = time.process_time()
            if name == "repeated":
                areas.at(pair.rotation, pair.translation, 1)
            else:
                for k in range(0, len(pair.rotation), every):
                    steps[name](k)
            done = len(range(0, len(pair.rotation), every))
            seconds.append((time.process_time() - start) * len(pair.rotation) / done)
        median = {name: float(np.median(values)) for name, values in rows.items()}
        record = {
            "commit": commit(),
            "machine": machine(),
            "versions": versions({e.package for e in engines}),
            "pair": {"moving_faces": len(pair.moving.faces), "fixed_faces": len(pair.fixed.faces), "poses": len(exact)},
            "prepared_once_cpu_s": prepared,
            "cpu_s": rows,
            "median_cpu_s": median,
            "least_cpu_s": {name: min(values) for name, values in rows.items()},
            "ratio": {name: median[name] / median["repeated"] for name in steps},
            "aims": {"repeated_cpu_s": 0.1, "ratio": PEERS},
            "largest_relative_error": float(np.abs(found.area / exact - 1.0).max()),
        }
        (HERE / "results" / "repeated.json").write_text(json.dumps(record, indent=1) + "\n")
    sys.stdout.write(
        json.dumps({key: record[key] for key in ("median_cpu_s", "ratio", "largest_relative_error")}) + "\n"
    )


if __name__ == "__main__":
    main()
