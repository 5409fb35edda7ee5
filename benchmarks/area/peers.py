"""geocontact against other distance engines on one core: `python -m benchmarks.area.peers [--pair knee|sphere-cup|dm]`.

The job: A moves through its poses, B is fixed; distance map of A's vertices to B up to 4 mm and the area of A that is
clipped exactly at the iso-line. CPU seconds of one process on one core, trees built beforehand. Beside it the whole
command, from start to end (`whole_command`).
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

from benchmarks.one_core import pin

HERE = Path(__file__).resolve().parents[1]


def arguments() -> argparse.Namespace:
    """Command line."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.area.peers", description=__doc__.splitlines()[0])
    parser.add_argument("--pair", choices=("knee", "sphere-cup", "dm"), default="knee")
    parser.add_argument("--frames", type=int, default=101)
    parser.add_argument("--faces", type=int, default=50_000, help="of each synthetic body, about")
    parser.add_argument("--rounds", type=int, default=5, help="interleaved repetitions")
    parser.add_argument("--only", nargs="+", default=[], metavar="TEXT", help="rows whose name contains one of these")
    parser.add_argument("--no-memory", action="store_true", help="without the table of peak memory")
    parser.add_argument("--out", type=Path, default=HERE / "results", help="folder for the JSON")
    return parser.parse_args()


def main() -> None:
    """Measure, print both tables, write the JSON."""
    options = arguments()
    pin()
    from benchmarks.area import tables
    from benchmarks.area.measure import measured
    from benchmarks.area.memory import peaks
    from benchmarks.engines.all import all_engines
    from benchmarks.engines.ours import BOTH, OURS
    from benchmarks.machine import machine, versions
    from benchmarks.pairs import PAIRS
    from benchmarks.whole_command import whole_command

    pair = PAIRS[options.pair](options.faces, options.frames)
    wanted = [OURS, BOTH, *options.only]
    engines = [e for e in all_engines() if not options.only or any(text in e.name for text in wanted)]
    rows = measured(pair, engines, options.rounds, lambda line: print(line, file=sys.stderr, flush=True))
    whole = whole_command(pair, options.rounds)
    names = [] if options.no_memory else ["", *(row.engine.name for row in rows if not row.skipped)]
    memory = peaks(names, options.pair, options.faces)
    about = machine()
    size = f"{len(pair.moving.faces)} × {len(pair.fixed.faces)} faces, {len(pair.moving.vertices)} vertices asked for"
    print(f"Pair {pair.name}: {size}, {len(pair.rotation)} poses, {options.rounds} interleaved rounds.")
    print(f"{about['processor']}, {about['cores']} cores, one used, load {about['load']}; {about['date']}.\n")
    print(tables.speed_table(pair, rows), "\n")
    ours, both = (next(row for row in rows if row.engine.name == name) for name in (OURS, BOTH))
    print(tables.whole_table(whole, ours, both, rows), "\n")
    print(tables.memory_table(memory) if memory else "")
    found = {
        "pair": {"name": pair.name, "moving_faces": len(pair.moving.faces), "fixed_faces": len(pair.fixed.faces)},
        "poses": len(pair.rotation),
        "machine": about,
        "versions": versions({e.package for e in engines}),
        "rows": tables.record(pair, rows),
        "whole_command": {"machine": about, "cpu_s": whole.all, "parts_cpu_s": whole.parts},
        "peak_memory_MB": memory,
    }
    options.out.mkdir(parents=True, exist_ok=True)
    (options.out / f"peers-{pair.name}.json").write_text(json.dumps(found, indent=1) + "\n")


if __name__ == "__main__":
    main()
