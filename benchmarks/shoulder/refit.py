"""Planted effects fitted inside the full 3-D model of the exoskeleton: `python -m benchmarks.shoulder.refit OUT`.

Recordings with one effect each are those of `benchmarks.shoulder.planted`. Each of four effects is added to the
package's 3-D model, where it changes motion and forces, fitted to logger and mat of two trials, and judged on two that
are held out: a force that presses the arm into the cuff while the tool runs, a play and a strap of the cuff, dry seals.
Which effect the diagnosis of the base model named is read from benchmarks/results/shoulder_gap.json. Answers go to
benchmarks/results/shoulder_refit.json. Everything is synthetic.
"""

from __future__ import annotations

import argparse
import json
import time as clock
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from scipy.optimize import least_squares

from benchmarks.machine import machine, versions
from benchmarks.shoulder.planted import (
    CALIBRATION,
    DEVICES,
    EVALUATION,
    PLANTED,
    Way,
    motion_of,
    recorded,
    trial_of,
)
from benchmarks.shoulder.trials import wearer_of
from benchmarks.shoulder.truth import Measured
from geocontact.shoulder_exoskeleton.arm_motion import ArmMotion
from geocontact.shoulder_exoskeleton.device import Device
from geocontact.shoulder_exoskeleton.plane import armrest_force
from geocontact.shoulder_exoskeleton.simulate import simulate_arm
from geocontact.shoulder_exoskeleton.support.phase_machine import SCREW
from geocontact.shoulder_exoskeleton.synthetic import OverheadTrial

RESULTS = Path(__file__).resolve().parents[1] / "results"


@dataclass(frozen=True)
class Added:
    """What is added to the model: numbers of the device by the fitted ones, or a force while the tool runs [N].

    Parameters
    ----------
    numbers
        Of the device, each times its factor the fitted numbers.
    pushes
        Whether the only number is that force.
    tried
        Sizes from which the best one is refined, in the units of the fitted numbers.
    """

    numbers: Mapping[str, float]
    tried: tuple[tuple[float, ...], ...]
    pushes: bool = False

    @property
    def lower(self) -> float:
        """Of the fitted numbers."""
        return 1e-3


ADDED = {
    "push force": Added({}, ((3.0,), (10.0,), (25.0,)), pushes=True),
    "play": Added({"strap": -1e-3}, ((1.0,), (4.0,), (8.0,))),
    "strap": Added({"strap": 1e-3}, ((1.0,), (5.0,), (15.0,))),
    "dry seals": Added({"seal_friction": 1.0, "seal_speed": 1.0}, ((0.2, 0.05), (0.8, 0.05))),
}
"""By name: N, mm, mm, N m and rad/s."""
MEANS = {
    "push force": "push force",
    "poor contact": "play",
    "force at zero elevation": "strap",
    "jump at lowering": "dry seals",
}
"""What was planted, as it is called here."""
NAMED = {
    "event_load": "push force",
    "contact_loss": "play",
    "dead_zone": "play",
    "preload": "strap",
    "sensor_offset": "strap",
    "sensor_gain": "strap",
    "dry_friction": "dry seals",
}
"""Names of the diagnosis, as they are called here; an offset and half of a change in the mat is what a strap does."""


@dataclass(frozen=True, eq=False)
class Seen:
    """A trial, its arm's motion, and what logger and mat show of it."""

    trial: OverheadTrial
    motion: ArmMotion
    measured: Measured


Residual = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]


def off(seen: Seen, device: Device, pressed: np.ndarray | None) -> tuple[np.ndarray, np.ndarray]:
    """Model less measurement: elevation of the device's arm [rad], force of the mat [N]."""
    level = float(seen.trial.condition.level or 0.0)
    s = simulate_arm(seen.motion, device, wearer_of(seen.trial.participant), level, pressed=pressed)
    return s.elevation - seen.measured.logger, np.maximum(armrest_force(s, pressed), 0.0) - seen.measured.mat


def offs(trials: list[Seen], device: Device, what: tuple[Added, ...], x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The same over trials, with these effects added in these sizes."""
    numbers, push, at = {}, 0.0, 0
    for each in what:
        if each.pushes:
            push, at = float(x[at]), at + 1
        for name, factor in each.numbers.items():
            numbers[name], at = numbers.get(name, 0.0) + factor * float(x[at]), at + 1
    one = device.having(**numbers)
    found = [off(seen, one, np.where(seen.trial.phase == SCREW, push, 0.0) if push else None) for seen in trials]
    exo, force = zip(*found, strict=True)
    return np.concatenate(exo), np.concatenate(force)


def rms(values: np.ndarray) -> float:
    """Root mean square."""
    return float(np.sqrt(np.mean(values**2)))


def fitted(trials: list[Seen], device: Device, what: tuple[Added, ...]) -> np.ndarray:
    """Sizes that fit both channels best, each over its error without them."""
    exo, force = (rms(each) for each in offs(trials, device, (), np.zeros(0)))

    def residual(x: np.ndarray) -> np.ndarray:
        try:
            one, two = offs(trials, device, what, x)
        except ArithmeticError:  # nothing rests, or it cannot go on
            return np.full(2 * sum(len(seen.motion.time) for seen in trials), 10.0)
        return np.concatenate([one / exo, two / force])

    starts = [np.concatenate([each.tried[min(k, len(each.tried) - 1)] for each in what]) for k in range(3)]
    start = min(starts, key=lambda x: float(np.sum(residual(x) ** 2)))
    found = least_squares(residual, start, bounds=(1e-3, np.inf), x_scale=start, diff_step=0.02, max_nfev=12)
    return np.asarray(found.x)


def as_a_surface(device: Device) -> Device:
    """Without interference, and layers of which half of the wall gives way as the point does: pi r L K / 2 = k."""
    pad, tissue = (device[f"{name}_thickness"] / device[f"{name}_modulus"] for name in ("pad", "tissue"))
    share = 2.0 * device["k"] * (pad + tissue) / (np.pi * device["cuff_radius"] * device["cuff_length"])
    moduli = {f"{name}_modulus": share * device[f"{name}_modulus"] for name in ("pad", "tissue")}
    return device.having(interference=0.0, **moduli)


def of_a_surface(kept: Path, way: Way, kind: str) -> dict[str, float]:
    """Errors of a cuff that holds by its surface on the held-out trial, nothing fitted."""
    name = EVALUATION[0]
    trial, found = trial_of(name), recorded(kept, kind, name, way)
    wearer, level = wearer_of(trial.participant), float(trial.condition.level or 0.0)
    s = simulate_arm(motion_of(trial, way), as_a_surface(DEVICES[way]), wearer, level, cuff="surface")
    exo, force = s.elevation - found.logger, np.maximum(s.outputs["normal"][:, 2], 0.0) - found.mat
    return {"exo_deg": float(np.degrees(rms(exo))), "force_N": rms(force)}


def judged(kept: Path, way: Way, kind: str, named: list[str], most: int = 2) -> dict[str, Any]:
    """Each effect by itself, and those that were named together: sizes, errors on the held-out trials.

    `most` is the number of trials that it is fitted to, and of those held out.
    """
    started = clock.process_time()
    device, trials = DEVICES[way], {}
    for name in (*CALIBRATION[:most], *EVALUATION[:most]):
        trial = trial_of(name)
        trials[name] = Seen(trial, motion_of(trial, way), recorded(kept, kind, name, way))
    fit, held = ([trials[name] for name in names[:most]] for names in (CALIBRATION, EVALUATION))
    exo, force = offs(held, device, (), np.zeros(0))
    told: dict[str, Any] = {"before": {"exo_deg": np.degrees(rms(exo)), "force_N": rms(force)}}
    together = tuple(dict.fromkeys(NAMED[each] for each in named if each in NAMED))
    for name in dict.fromkeys((*ADDED, " + ".join(together)) if together else tuple(ADDED)):
        what = tuple(ADDED[each] for each in name.split(" + "))
        x = fitted(fit, device, what)
        exo, force = offs(held, device, what, x)
        of_fit = offs(fit, device, what, x)
        told[name] = {
            "size": x.tolist(),
            "exo_deg": np.degrees(rms(exo)),
            "force_N": rms(force),
            "calibration_exo_deg": np.degrees(rms(of_fit[0])),
            "calibration_force_N": rms(of_fit[1]),
        }
    gain = {
        name: told[name]["calibration_exo_deg"] / told["before"]["exo_deg"]
        + told[name]["calibration_force_N"] / told["before"]["force_N"]
        for name in ADDED
    }
    told["best on the calibration trials"] = min(gain, key=lambda name: gain[name])
    told["trials"] = {"fitted to": CALIBRATION[:most], "held out": EVALUATION[:most]}
    told["planted"] = MEANS.get(kind)
    told["named by the diagnosis"] = named
    told["seconds"] = clock.process_time() - started
    return told


def main() -> None:
    """Fit all, print, write the JSON."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.shoulder.refit", description=__doc__.splitlines()[0])
    parser.add_argument("out", type=Path, help="where the recordings are kept")
    parser.add_argument("--way", choices=list(DEVICES), action="append", help="free by default")
    parser.add_argument("--short", action="store_true", help="one trial to fit to and one held out instead of two")
    parser.add_argument("--only", choices=list(PLANTED), action="append", help="what was planted; all by default")
    parser.add_argument("--cuff", choices=("point", "surface"), default="point", help="surface: errors, nothing fitted")
    asked = parser.parse_args()
    answers = json.loads((RESULTS / "shoulder_gap.json").read_text(encoding="utf-8"))["answers"]
    file = RESULTS / "shoulder_refit.json"
    found = json.loads(file.read_text(encoding="utf-8")) if file.is_file() else {}
    found |= {"machine": machine(), "versions": versions({"scipy", "casadi"})}
    for way in asked.way or ["free"]:
        found.setdefault(way, {})
        for kind in asked.only or PLANTED:
            if asked.cuff == "surface":
                found[way][kind]["before, cuff as a surface"] = of_a_surface(asked.out, way, kind)
                file.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
                print(f"{way} {kind}, cuff as a surface: {found[way][kind]['before, cuff as a surface']}", flush=True)
                continue
            one = found[way][kind] = judged(asked.out, way, kind, answers[kind]["named"], 1 if asked.short else 2)
            shown = ", ".join(
                f"{name} {np.round(each['size'], 3)}: {each['exo_deg']:.2f} deg {each['force_N']:.2f} N"
                for name, each in one.items()
                if isinstance(each, dict) and "size" in each
            )
            before = one["before"]
            file.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
            print(f"{way} {kind}: {before['exo_deg']:.2f} deg {before['force_N']:.2f} N -> {shown}", flush=True)


if __name__ == "__main__":
    main()
