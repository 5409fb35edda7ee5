"""The study of the paper, synthetic, beside the paper's figures: `python -m benchmarks.shoulder.study OUT`.

Makes the trials (`benchmarks.shoulder.trials`, a few minutes), runs `geocontact shoulder study`, and writes what
the paper reports beside it: benchmarks/results/shoulder_study.json. Ours is synthetic: persons, motion, logger and mat.
"""

from __future__ import annotations

import argparse
import json
import time
import warnings
from pathlib import Path

import pandas as pd

import geocontact as gc
from benchmarks.machine import machine, versions
from benchmarks.shoulder.trials import TRUE, write_study

RESULTS = Path(__file__).resolve().parents[1] / "results"
PAPER = {
    ("elevation", "all"): (4.8, 7.1),
    ("elevation", "work"): (3.7, 6.0),
    ("force", "all"): (4.3, 5.6),
}
"""MAE and RMSD [deg, N]: Yao et al. (2024), sec. 5.1; the force's is not told by phase."""
DIFFERENCES = {
    "exoskeleton [deg]": 8.3,
    "shoulder [deg]": 8.2,
    "shoulder less exoskeleton [deg]": 13.8,
    "force [N]": 0.66,
}
"""Screw-in, sec. 5.2."""


def compared(summary: pd.DataFrame, differences: pd.DataFrame) -> list[dict[str, object]]:
    """Rows of ours and theirs."""
    found: list[dict[str, object]] = []
    for row in summary.to_dict("records"):
        theirs = PAPER.get((row["channel"], row["part"]), (None, None))
        for name, paper in zip(("mae", "rmsd"), theirs, strict=True):
            what = f"{row['channel']}, {row['part']}: {name.upper()} [{row['unit']}]"
            found.append({"figure": what, "ours": row[name], "paper": paper})
    mean = differences[differences["trial"] == "mean"].iloc[0]
    return found + [
        {"figure": f"screw-in: {name}", "ours": mean[name], "paper": DIFFERENCES[name]} for name in DIFFERENCES
    ]


def main() -> None:
    """Make, run, compare, write."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.shoulder.study", description=__doc__.splitlines()[0])
    parser.add_argument("out", type=Path)
    out = parser.parse_args().out
    file = out / "study.toml" if (out / "study.toml").is_file() else write_study(out)
    warnings.simplefilter("ignore")
    started = time.process_time()
    result = gc.shoulder.study(file)
    seconds = time.process_time() - started
    result.write(out / "result")
    rows = compared(result.table("summary"), result.table("differences"))
    for row in rows:
        print(f"{row['figure']}: {row['ours']:.3g}, paper {row['paper'] or '-'}")
    print(f"{len(result.cases)} arms in their trials, both groups: {seconds:.1f} CPU s with reading")
    told = {"machine": machine(), "versions": versions({"scipy", "casadi"}), "withheld": vars(TRUE), "seconds": seconds}
    text = json.dumps({**told, "rows": rows}, indent=1) + "\n"
    (RESULTS / "shoulder_study.json").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
