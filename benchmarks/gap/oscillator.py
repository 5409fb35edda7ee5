"""What the diagnosis says of a movement that is fast for its sampling: `python -m benchmarks.gap.oscillator`.

Synthetic oscillators in the way of electronic ones: 68 Hz, 5 % damping, shaken by many sines up to 19 Hz from rest,
so that they ring at first, and recorded at 610 Hz, nine samples a period. Stiffening, friction and play are withheld,
or nothing. The base is a page of one's own: u = m y'' + d y' + k y, a simulator that takes a force law.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

import geocontact as gc
from benchmarks.machine import write_results
from geocontact.data.gap_case import GapCase
from geocontact.data.motion import Signals
from geocontact.data.trial import Trial

RATE, FINER, SAMPLES, TRIALS = 610.35, 10, 600, 6
"""Recorded samples a second; steps of the truth between two of them; samples of a trial."""
MASS = 1.0 / (2.0 * np.pi * 68.0) ** 2
DAMPER = 2.0 * 0.05 * np.sqrt(MASS)
NOISE = 2e-4
"""Of y and u [V]."""
SINES, SIZE = np.arange(1.0, 20.0), 0.15
"""[Hz]; root mean square of u in a trial of middle size [V]."""
PARAMETERS = (
    gc.Parameter("m", "s^2", 5e-6, 1e-7, 1e-4),
    gc.Parameter("d", "s", 2e-4, 0.0, 1e-2),
    gc.Parameter("k", "", 0.8, 0.1, 3.0),
)
Spring = Callable[[float, float], float]
KINDS: dict[str, tuple[str, Spring]] = {
    "nothing": ("", lambda y, rate: y),
    "cubic spring": ("stiffening", lambda y, rate: y + 3.5 * y**3),
    "friction": ("dry_friction", lambda y, rate: y + 0.02 * float(np.tanh(rate))),
    "play": ("dead_zone", lambda y, rate: y - float(np.clip(y, -0.015, 0.015))),
}
"""Effect of each, and its force [V] at y [V] and y' [V/s]."""


def run(time: np.ndarray, inputs: np.ndarray, numbers: dict[str, float], law: gc.chain.ActingLaw) -> np.ndarray:
    """The circuit without what is withheld."""
    return np.asarray(numbers["m"] * law.acceleration + numbers["d"] * law.rate + law(inputs[0], law.rate))


BASE = gc.simulator_base("oscillator", {"y": "V"}, {"u": "V"}, run, dynamic=True, acts_on="y", law={"k": "k"})


def trial(name: str, spring: Spring, size: float, rng: np.random.Generator) -> Trial:
    """One recording: the fourth-order Runge-Kutta method, `FINER` steps a sample."""
    phases = rng.uniform(0.0, 2.0 * np.pi, len(SINES))
    fine = np.arange((SAMPLES - 1) * FINER * 2 + 1) / (2 * FINER * RATE)  # halves of steps
    u = size * np.sqrt(2.0 / len(SINES)) * np.sin(2.0 * np.pi * np.outer(fine, SINES) + phases).sum(axis=1)

    def slope(state: np.ndarray, at: int) -> np.ndarray:
        y, rate = state
        return np.array([rate, (u[at] - DAMPER * rate - spring(y, rate)) / MASS])

    step, state, path = 1.0 / (FINER * RATE), np.zeros(2), [0.0]
    for at in range(0, len(fine) - 1, 2):
        a = slope(state, at)
        b = slope(state + 0.5 * step * a, at + 1)
        c = slope(state + 0.5 * step * b, at + 1)
        d = slope(state + step * c, at + 2)
        state = state + step / 6.0 * (a + 2.0 * b + 2.0 * c + d)
        path.append(float(state[0]))
    clean = np.column_stack([path[::FINER], u[:: 2 * FINER]])
    recorded = clean + rng.normal(0.0, NOISE, clean.shape)
    return Trial(name, Signals(fine[:: 2 * FINER], recorded, ("y", "u"), ("V", "V")))


def case(spring: Spring, seed: int) -> GapCase:
    """Half of the trials for calibration, the larger half held out."""
    rng = np.random.default_rng(seed)
    trials = [trial(f"t{k}", spring, SIZE * (0.6 + 0.2 * k), rng) for k in range(TRIALS)]
    half = TRIALS // 2
    return GapCase("oscillator", "own", tuple(trials[:half]), tuple(trials[half:]), PARAMETERS, {}, {"u": NOISE})


def said(spring: Spring, seed: int) -> dict[str, Any]:
    """The answer to one case."""
    from geocontact.gap.diagnose import diagnose

    one, began = case(spring, seed), time.process_time()
    told = diagnose(one, BASE.build(one.parameters, one.constants, one.tables)).diagnosis
    gap = told.gap["u"]
    return {
        "verdict": told.verdict,
        "effects": told.effects,
        "ambiguity": told.ambiguity,
        "reduction": gap.reduction,
        "ci95": gap.ci95,
        "where": [each.phase for each in told.where],
        "remarks": told.remarks,
        "cpu_s": time.process_time() - began,
    }


def main() -> None:
    """Diagnose all kinds, print, write the JSON."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.gap.oscillator", description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", type=int, nargs="+", default=[5, 6, 7])
    parser.add_argument("--name", default="oscillator", help="of the file of results")
    options = parser.parse_args()
    figures: dict[str, Any] = {}
    for kind, (effect, spring) in KINDS.items():
        answers = {str(seed): said(spring, seed) for seed in options.seeds}
        figures[kind] = {"effect": effect, "answers": answers}
        print(
            kind, *(f"{one['verdict']} {' + '.join(one['effects'])}" for one in answers.values()), sep=" | ", flush=True
        )
        file: Path = write_results(options.name, {"seeds": options.seeds}, figures)
    print(file)


if __name__ == "__main__":
    main()
