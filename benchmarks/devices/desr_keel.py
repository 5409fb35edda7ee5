"""The prosthetic ankle of the DESR data as a keel on a sliding fulcrum: `python -m benchmarks.devices.desr_keel`.

The foot is taken to store energy in a leaf spring that is held at one end, supported by the slider and bent at the
other through a cam: the recordings come without a drawing. So at the setting s its compliance is that of
`below_knee_prosthesis.keel.keel` with an overhang a - s, and something in series: K(s) = k / ((1 - q) C(s)/C(0) + q).
Both the
spring's length and where the slider is at 0 are unknown; pinned at its end, C is proportional to (a - s)² and needs
neither, clamped the slider is taken to start at the end. The curve over the angle is the mean of the recordings that
are fitted to, as for the base model `elastic_joint`, which has k exp(growth s + bend s²) instead: three numbers each,
and the angle of zero torque.

Hysteresis, in the way of the keel: damping and friction grow with the stiffness, retardation K(s) u' and rubbing K(s)
u_0 z, z' as in the effect `dry_friction` with a reach; for the base model the effects `damping` and `dry_friction` of
one size for all settings. All recordings turn at one speed: torques by the rate and by its sign are hardly told apart.
"""

from __future__ import annotations

import argparse
import json
import os
import tempfile
from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from benchmarks.devices import desr
from geocontact.below_knee_prosthesis.keel.keel import tip_compliance
from geocontact.below_knee_prosthesis.keel.sections import SUPPORTS, Support
from geocontact.chain.interface_law import INTERFACE_LAW
from geocontact.chain.links import Law, Source, Values
from geocontact.chain.system import System
from geocontact.data.gap_case import GapCase
from geocontact.data.parameter import Parameter
from geocontact.data.trial import Trial
from geocontact.effects.catalogue import candidates
from geocontact.identify.optimise.least_squares import fit
from geocontact.io.cases.gap_case import read_gap_case
from geocontact.systems import elastic_joint
from geocontact.systems.base import require_numbers
from geocontact.systems.catalogue import system_of

HERE = Path(__file__).resolve().parents[1]
NUMBERS = ("k", "overhang", "series")
HYSTERESIS = ("none", "damping", "dry_friction.stroke")
STOPPED = 11.8
"""s; the foot is held from here on."""
PARAMETERS = (
    Parameter("k", "N m/rad", 150.0, 20.0, 2000.0),
    Parameter("overhang", "mm", 90.0, 46.0, 1000.0),
    Parameter("series", "1", 0.05, 0.0, 0.9),
    Parameter("angle0", "rad", 0.0, -0.05, 0.05),
)
OWN = {
    "none": (),
    "damping": (Parameter("retardation", "s", 0.5, 0.0, 10.0),),
    "dry_friction.stroke": (
        Parameter("rubbing", "rad", 0.01, 0.0, 0.2),
        Parameter("reach", "rad", 0.01, 1e-3, 0.2),
    ),
}
"""Numbers of the keel's own hysteresis."""


def stiffness(support: Support, values: Values) -> float:
    """K(s) [N m/rad]; overhang and setting in mm. The clamped spring's slider starts at its end."""
    overhang, setting, share = values["overhang"], values["setting"], values["series"]
    if support == "pinned":
        softer = (1.0 - setting / overhang) ** 2
    else:
        softer = tip_compliance(setting, overhang, 1.0, support) / tip_compliance(0.0, overhang, 1.0, support)
    return values["k"] / ((1.0 - share) * softer + share)


def times_stiffness(support: Support, name: str, values: Values) -> float:
    return values[name] * stiffness(support, values)


def build(
    support: Support,
    parameters: tuple[Parameter, ...],
    constants: Mapping[str, float],
    tables: Mapping[str, pd.DataFrame],
) -> System:
    """The elastic joint's chain with that stiffness, and with the hysteresis whose numbers are given."""
    require_numbers("desr keel", NUMBERS, parameters, constants)
    joint = tuple(p for p in parameters if p.name in ("k", "angle0"))
    sources: dict[str, Source] = {"k": partial(stiffness, support)}
    names = {p.name for p in parameters}
    if "retardation" in names:
        sources["damping.b"] = partial(times_stiffness, support, "retardation")
    if "rubbing" in names:
        sources["dry_friction.stroke.limit"] = partial(times_stiffness, support, "rubbing")
        sources["dry_friction.stroke.reach"] = "reach"
    law = Law(INTERFACE_LAW, load="N m", deflection="rad").having(sources)
    base = elastic_joint.build(joint, constants, tables)
    return replace(base, name=f"desr_keel_{support}", law=law, parameters=parameters)


def models(case: GapCase, kind: str) -> dict[str, tuple[System, list[dict[str, float]]]]:
    """The base model and both keels with a kind of hysteresis, and where to start from; the case's curve for all."""
    base = system_of(case)
    found: dict[str, tuple[System, list[dict[str, float]]]] = {}
    one = {each.label: each for each in candidates(base)}.get(kind)
    found["elastic_joint"] = (one.apply(base), [dict(start) for start in one.starts]) if one else (base, [{}])
    for support in SUPPORTS:
        system = build(support, (*PARAMETERS, *OWN[kind]), {}, case.tables)
        found[f"keel, {support}"] = (system, [{}])
    return found


def torque(trial: Trial) -> np.ndarray:
    return trial.column("torque")[:, None]


def loop_area(trial: Trial, torques: np.ndarray) -> float:
    """Work that a turn takes [J], until the foot is held."""
    turning = trial.time < STOPPED
    return float(np.trapezoid(torques[turning, 0], trial.column("angle")[turning]))


def fitted(case: GapCase, system: System, starts: list[dict[str, float]]) -> dict[str, Any]:
    """Numbers from the settings that are fitted to; errors of torque [N m] and of work [J] at the others."""
    found = fit(
        lambda values: [system.simulate(trial, values) for trial in case.calibration],
        [torque(trial) for trial in case.calibration],
        system.parameters,
        np.ones(1),
        starts,
    )
    values = found.values  # noqa: PD011
    told: dict[str, Any] = {"values": {**values}}
    for side, trials in (("fitted", case.calibration), ("predicted", case.evaluation)):
        errors, areas, spans, slopes = {}, {}, {}, {}
        for trial in trials:
            simulated = system.simulate(trial, values)
            errors[trial.name] = float(np.sqrt(np.mean((torque(trial) - simulated) ** 2)))
            areas[trial.name] = (loop_area(trial, torque(trial)), loop_area(trial, simulated))
            spans[trial.name] = float(np.ptp(torque(trial)))
            slopes[trial.name] = float(np.vdot(simulated, simulated) / np.vdot(torque(trial), simulated) - 1.0)
        told[side] = {
            "rmse [N m]": float(np.sqrt(np.mean(np.square(list(errors.values()))))),
            "by setting [N m]": errors,
            "worst over the range of torque": max(errors[name] / spans[name] for name in errors),
            "work measured, simulated [J]": areas,
            "stiffness over that of the setting alone, less 1": slopes,
        }
    return told


def compared(file: Path, kinds: tuple[str, ...] = HYSTERESIS) -> dict[str, Any]:
    """All models with all kinds of hysteresis."""
    with tempfile.TemporaryDirectory() as folder:
        case = read_gap_case(desr.write_case(file, Path(folder) / "case", desr.SYSTEMS["joint"]))
    found: dict[str, Any] = {}
    plain: dict[str, dict[str, float]] = {}
    for kind in kinds:
        for name, (system, starts) in models(case, kind).items():
            told = fitted(case, system, [{**plain.get(name, {}), **start} for start in starts])
            plain.setdefault(name, told["values"])
            found[f"{name}; {kind}"] = told
    return found


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.devices.desr_keel", description=__doc__.splitlines()[0])
    default = Path(os.environ.get("GEOCONTACT_DATA") or HERE.parents[1] / "shared" / "data")
    parser.add_argument("--data", type=Path, default=default, help="folder of the real data (%(default)s)")
    parser.add_argument("--out", type=Path, default=HERE / "results")
    given = parser.parse_args()
    if not (given.data / desr.FILE).is_file():
        parser.error(f"no {given.data / desr.FILE}; name the folder of the real data with --data")
    found = compared(given.data / desr.FILE)
    given.out.mkdir(parents=True, exist_ok=True)
    (given.out / "desr_keel.json").write_text(json.dumps(found, indent=2) + "\n", encoding="utf-8")
    print(f"{'model':40} fitted  predicted [N m]  worst of the range  stiffness at x10, x25, x35, x45  work")
    for name, each in found.items():
        a, b = each["fitted"], each["predicted"]
        slopes = " ".join(f"{100 * x:+.1f}" for x in b["stiffness over that of the setting alone, less 1"].values())
        work = " ".join(f"{two:.2f}/{one:.2f}" for one, two in b["work measured, simulated [J]"].values())
        share = 100 * b["worst over the range of torque"]
        print(f"{name:40} {a['rmse [N m]']:.3f} {b['rmse [N m]']:.3f} {share:.2f} % {slopes} % {work} J")


if __name__ == "__main__":
    main()
