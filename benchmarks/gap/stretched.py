"""Is the answer the same in a world where seconds, newtons and metres are others? `python -m benchmarks.gap.stretched`.

Every case of a folder is diagnosed as it is and with its clock, forces and lengths a hundred times as large, one after
the other or all at once; angles, shares and exponents stay. Words must be the same and probabilities the same to 0.01.
Gravity is no longer 9.81 m/s² then, so a mass that only weighs something is stretched with the force.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pandas as pd

from geocontact.data.gap_case import GapCase
from geocontact.data.parameter import Parameter
from geocontact.data.trial import Trial

SAME = 0.01
"""Largest change of a probability."""
EXPONENTS = {
    "s": (1, 0, 0),
    "m": (0, 0, 1),
    "m^2": (0, 0, 2),
    "N": (0, 1, 0),
    "N m": (0, 1, 1),
    "N/m": (0, 1, -1),
    "N s/m": (1, 1, -1),
    "Pa": (0, 1, -2),
    "kg": (0, 1, 0),
    "rad": (0, 0, 0),
    "-": (0, 0, 0),
}
"""Of time, force and length, by unit."""
UNITS = {
    **dict.fromkeys(("l", "z", "x", "y", "l_ex", "z_ex", "R", "L_h", "o_x", "o_y", "l_c", "delta_full"), "m"),
    **dict.fromkeys(("b",), "N s/m"),
    "cuff_pressure": "Pa",
}
"""Of constants and covariates; others have no unit but those below."""
OTHERS = {"I": (2, 1, 1), "c": (1, 1, 1), "v_th": (-1, 0, 1)}


@dataclass(frozen=True)
class Stretch:
    """How many times as long a second, as large a newton, as long a metre becomes."""

    time: float = 1.0
    force: float = 1.0
    length: float = 1.0

    def by(self, exponents: tuple[float, float, float]) -> float:
        """Of a quantity with these exponents."""
        return float(self.time ** exponents[0] * self.force ** exponents[1] * self.length ** exponents[2])

    def number(self, name: str) -> float:
        """Of a constant."""
        return self.by(OTHERS[name] if name in OTHERS else EXPONENTS[UNITS.get(name, "-")])

    def case(self, case: GapCase) -> GapCase:
        """The case in that world."""
        power = case.constants.get("n", 1.0)
        units = dict(zip(case.calibration[0].signals.channels, case.calibration[0].signals.units, strict=True))

        def parameter(p: Parameter) -> Parameter:
            own = self.by((0, 1, -power) if p.unit == "N/m^n" else EXPONENTS[p.unit])
            return replace(p, start=p.start * own, lower=p.lower * own, upper=p.upper * own)

        def table(one: pd.DataFrame) -> pd.DataFrame:
            own = {name: name.rpartition("[")[2].rstrip("]") for name in one.columns}
            return one.assign(**{name: one[name] * self.by(EXPONENTS[u]) for name, u in own.items() if u in EXPONENTS})

        return replace(
            case,
            calibration=tuple(map(self.trial, case.calibration)),
            evaluation=tuple(map(self.trial, case.evaluation)),
            parameters=tuple(map(parameter, case.parameters)),
            constants=self.numbers(case.constants),
            noise={name: sd * self.by(EXPONENTS[units[name]]) for name, sd in case.noise.items()},
            tables={name: table(one) for name, one in case.tables.items()},
        )

    def numbers(self, given: Mapping[str, float]) -> dict[str, float]:
        """Constants or covariates."""
        return {name: value * self.number(name) for name, value in given.items()}

    def trial(self, one: Trial) -> Trial:
        """What would have been recorded."""
        recorded = one.signals
        factors = np.array([self.by(EXPONENTS[unit]) for unit in recorded.units])
        columns = np.stack([recorded.column(name) for name in recorded.channels], axis=1)
        signals = replace(recorded, time=self.time * recorded.time, values=columns * factors)
        return replace(one, signals=signals, covariates=self.numbers(one.covariates))


STRETCHES = {
    "clock": Stretch(time=100.0),
    "force": Stretch(force=100.0),
    "length": Stretch(length=100.0),
    "all at once": Stretch(100.0, 100.0, 100.0),
}


def apart(one: Mapping[str, float], other: Mapping[str, float]) -> float:
    """Largest difference of two sets of probabilities."""
    return max(abs(one.get(name, 0.0) - other.get(name, 0.0)) for name in {*one, *other})


def main() -> int:
    """Diagnose, print a line each; 1 where an answer changes."""
    from geocontact.gap.diagnose import diagnose
    from geocontact.io.cases.gap_case import gap_case_folders, read_gap_case
    from geocontact.systems.catalogue import system_of

    parser = argparse.ArgumentParser(prog="python -m benchmarks.gap.stretched", description=__doc__.splitlines()[0])
    parser.add_argument("cases", type=Path, help="folder of gap cases, such as the practice cases")
    parser.add_argument("--stretch", nargs="+", default=["all at once"], choices=list(STRETCHES))
    parser.add_argument("--only", nargs="+", help="names of cases")
    options = parser.parse_args()
    changed = 0
    for folder in gap_case_folders(options.cases):
        if options.only and folder.name not in options.only:
            continue
        case = read_gap_case(folder)
        first = diagnose(case, system_of(case)).diagnosis
        for name in options.stretch:
            other = STRETCHES[name].case(case)
            said = diagnose(other, system_of(other)).diagnosis
            off = apart(first.probabilities, said.probabilities)
            same = (first.verdict, first.effects) == (said.verdict, said.effects) and off <= SAME
            changed += not same
            words = f"{said.verdict} {', '.join(said.effects)}".strip()
            print(f"{folder.name}, {name}: {words}, {'the same' if same else 'CHANGED'}, {off:.4f} apart", flush=True)
    return int(changed > 0)


if __name__ == "__main__":
    sys.exit(main())
