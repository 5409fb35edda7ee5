"""A named effect refitted over the whole simulated stance: `python -m benchmarks.prosthesis.whole_refit [KIND ...]`.

The stance of `below_knee_prosthesis.simulate`, with friction, inertia, socket and the pelvis' free places, walks along
four synthetic courses of one participant. The truth is a finer foot (`synthetic.trial.true_foot`) with one thing that
the model has not; the model is given the course and the other leg's force, and its number of that thing is sought on
two stances (bounded Brent) and judged on the two others. What is left with the true number is what the coarser foot
misses anyhow. Motions are exact: markers are not part of this. Answers go to
benchmarks/results/prosthesis_whole_refit.json, a kind that is run by itself in place of its own.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from scipy.optimize import minimize_scalar

from benchmarks.machine import write_results
from geocontact.below_knee_prosthesis.evaluation import PlateStance, stance_errors
from geocontact.below_knee_prosthesis.keel.foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.keel.sole import numbers as sole_numbers
from geocontact.below_knee_prosthesis.keel.vsf import fulcrum_of, vsf_foot
from geocontact.below_knee_prosthesis.simulate import Stance, simulate_stance
from geocontact.contact.bushing import SOCKET, Bushing
from meshes.gait_course import GaitCourse, course
from meshes.gait_persons import PARTICIPANTS, STANCE, true_leg
from meshes.gait_trial import FORCE_NOISE, true_foot

PERSON, SETTING, SEED = PARTICIPANTS[0], "low", 7
PHASES = (-0.2, 0.1, 0.0, 0.25)
"""rad; of the pelvis' turns: two stances to fit to, two held out."""
TOLERANCE, EVALUATIONS = 1e-4, 14
QUANTITIES = ("resultant", "vertical", "fore_aft", "cop_ground")
RESULTS = Path(__file__).resolve().parents[1] / "results" / "prosthesis_whole_refit.json"


@dataclass(frozen=True)
class Walked:
    """Foot, fulcrum [m] and socket that a course is walked on."""

    foot: VariableStiffnessFoot
    fulcrum: float
    bushing: Bushing = SOCKET

    def along(self, one: GaitCourse) -> Stance:
        """The simulated stance."""
        given = one.motion, self.foot, self.fulcrum, one.push, one.span
        return simulate_stance(*given, bushing=self.bushing, tolerance=TOLERANCE)


def further(walked: Walked, value: float) -> Walked:
    """With the fulcrum ahead by so much [m]."""
    return replace(walked, fulcrum=walked.fulcrum + value)


def softer(walked: Walked, value: float) -> Walked:
    """With a socket whose translations are so many times as stiff."""
    k = walked.bushing.stiffness
    return replace(
        walked, bushing=replace(walked.bushing, stiffness=(*k[:3], value * k[3], value * k[4], value * k[5]))
    )


KINDS: dict[str, tuple[Callable[[Walked, float], Walked], float, float, tuple[float, float]]] = {
    "wrong fulcrum": (further, 0.020, 0.0, (0.0, 0.06)),
    "pistoning": (softer, 0.4, 1.0, (0.1, 2.0)),
}
"""What changes, planted value, the one that the model is told, and bounds."""


def errors(walked: Walked, courses: list[GaitCourse], plates: list[PlateStance]) -> dict[str, float]:
    """Root mean squares over stances, of body weight and of the foot's length."""
    tables = [stance_errors(walked.along(one), plate).table for one, plate in zip(courses, plates, strict=True)]
    return {name: float(np.sqrt(np.mean([each[name][1] ** 2 for each in tables]))) for name in QUANTITIES}


def refitted(kind: str) -> dict[str, Any]:
    """One kind: planted and found, and what is left on the held-out stances."""
    change, planted, told, bounds = KINDS[kind]
    before, rng = time.process_time(), np.random.default_rng(SEED)
    leg, fulcrum = true_leg(PERSON, sole_numbers()["below"].value), fulcrum_of(SETTING)
    courses = [course(leg, vsf_foot(), fulcrum, STANCE[SETTING], phase=phase) for phase in PHASES]
    plates = []
    for one in courses:
        s = change(Walked(true_foot(), fulcrum), planted).along(one)
        plates.append(PlateStance(s.time, s.force + rng.normal(0.0, FORCE_NOISE, s.force.shape), s.centre("ground")))
    model = Walked(vsf_foot(), fulcrum)

    def cost(value: float) -> float:
        try:
            off = errors(change(model, value), courses[:2], plates[:2])
        except ArithmeticError:
            return 1.0
        return off["vertical"] ** 2 + off["fore_aft"] ** 2 + off["cop_ground"] ** 2

    best = minimize_scalar(cost, bounds=bounds, method="bounded", options={"maxiter": EVALUATIONS})
    found = {
        name: errors(change(model, value), courses[2:], plates[2:])
        for name, value in (("told", told), ("found", float(best.x)), ("planted", planted))
    }
    return {"planted": planted, "told": told, "found": float(best.x), "held_out": found} | {
        "seconds": time.process_time() - before
    }


def main() -> None:
    """Print a table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("kinds", nargs="*", default=list(KINDS))
    answers = json.loads(RESULTS.read_text(encoding="utf-8"))["figures"] if RESULTS.is_file() else {}
    for kind in parser.parse_args().kinds:
        one = answers[kind] = refitted(kind)
        print(f"{kind}: planted {one['planted']:g}, found {one['found']:.3g}, {one['seconds']:.0f} CPU s")
        for name, off in one["held_out"].items():
            print(f"  {name:8}" + ", ".join(f"{key} {100.0 * off[key]:.2f} %" for key in QUANTITIES), flush=True)
        write_results("prosthesis_whole_refit", {"seed": SEED}, answers, {"casadi"})


if __name__ == "__main__":
    main()
