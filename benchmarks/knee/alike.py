"""Which effects the trials of a case cannot tell apart: `python -m benchmarks.knee.alike CASE`.

The signature of a candidate is what a small amount of it changes in the outputs, over the noise that the case tells,
with what E* of each trial makes of it taken off. Two are alike when the cosine between their signatures is near ±1:
then only their amplitudes' bounds and signs tell them apart.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
import pandas as pd

from geocontact.chain.system import System
from geocontact.data.gap_case import GapCase
from geocontact.effects.catalogue import candidates
from geocontact.io.cases.gap_case import read_gap_case
from geocontact.systems.catalogue import system_of

ALIKE = 0.9
POSE = "motion_offset"
SMALL = 0.2
"""Of the amplitude that a search starts with."""


def signatures(case: GapCase, system: System) -> dict[str, np.ndarray]:
    """Signature by label, in noise levels; only effects with an amplitude that is nothing at 0."""
    trials = (*case.calibration, *case.evaluation)
    sd = np.array([case.noise[name] for name in system.outputs])
    base = [system.simulate(trial, system.start) / sd for trial in trials]
    found = {}
    for one in candidates(system):
        if one.parameters and one.neutral.get(one.parameters[0].name) == 0.0:
            values = {**system.start, **{p.name: p.start for p in one.parameters}}
            values[one.parameters[0].name] *= SMALL
            changed = [one.apply(system).simulate(trial, values) / sd for trial in trials]
            found[one.label] = np.concatenate([off_base(c - b, b) for c, b in zip(changed, base, strict=True)])
    return found


def effect(label: str) -> str:
    return label.partition(".")[0]


def off_base(change: np.ndarray, base: np.ndarray) -> np.ndarray:
    """Change without the part that a factor on all outputs of the trial makes, which E* swallows."""
    return (change - base * (change * base).sum() / (base * base).sum()).ravel()


def table(found: dict[str, np.ndarray], least: float = ALIKE) -> pd.DataFrame:
    """Pairs that are alike, most alike first: of different effects, or of different coordinates of the pose."""
    visible = {label: one for label, one in found.items() if np.linalg.norm(one) > 1e-9}
    labels = list(visible)
    unit = np.array([one / np.linalg.norm(one) for one in visible.values()])
    cosine = unit @ unit.T
    pairs = [
        (labels[i], labels[j], cosine[i, j])
        for i in range(len(labels))
        for j in range(i)
        if abs(cosine[i, j]) >= least and (effect(labels[i]) != effect(labels[j]) or effect(labels[i]) == POSE)
    ]
    rows = sorted(pairs, key=lambda pair: -abs(pair[2]))
    return pd.DataFrame(rows, columns=["effect", "is like", "cosine [-]"])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("case", type=Path)
    parser.add_argument("--least", type=float, default=ALIKE, help="smallest cosine that is told (%(default)s)")
    given = parser.parse_args()
    case = read_gap_case(given.case)
    found = signatures(case, system_of(case))
    hidden = [label for label, one in found.items() if np.linalg.norm(one) <= 1e-9]
    print(table(found, given.least).to_string(index=False, float_format=lambda x: f"{x:.3f}"))
    print("swallowed by E* altogether:", ", ".join(hidden) or "none")


if __name__ == "__main__":
    main()
