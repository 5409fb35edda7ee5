"""Effects of a strap inside the full model of standing up: fitted to trials beside its numbers, judged on others.

Each is one more number of the calibrated strap: a normal force without displacement, a stiffness that grows with the
square of the displacement, the largest force along the thigh, a turn of the mat. What is believed of them is invented.
The feet are held at what was planted.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from benchmarks.standing.truth import STIFFENS, Pad
from geocontact.dynamics.collocation.solve import CollocationResult, SolverOptions, solve
from geocontact.dynamics.sphere_contact import together
from geocontact.standing_up.chain import EVERY_PLANTED, Subject
from geocontact.standing_up.exoskeleton import STRAP, STRAP_PARAMETERS, Strap, thigh_strap, with_exoskeleton
from geocontact.standing_up.phase import PhaseProblem, standing_phase
from geocontact.standing_up.phases import TRACKS_B, phase_b
from geocontact.standing_up.strap_sites import ContactParameter
from geocontact.standing_up.trials import LITTLE_ENERGY, StandingNoise, StandingTrial, seen_in

FURTHER = {
    "preload": ContactParameter("preload", "N", 0.0, 20.0, -100.0, 100.0),
    "stiffening": ContactParameter("stiffening", "-", 0.0, 1.0, -0.5, 20.0),
    "slip": ContactParameter("slip", "N", 30.0, 1.0, 1.0, 1e3, logarithm=True),
    "tilt": ContactParameter("tilt", "rad", 0.0, 0.3, -1.0, 1.0),
}
"""By effect: its number; a pad is `stiffening` times stiffer again at 10 mm."""
NAMED = {
    "preload": "preload",
    "sensor_offset": "preload",
    "motion_offset": "preload",
    "dead_zone": "preload",
    "contact_loss": "preload",
    "stiffening": "stiffening",
    "end_stop": "stiffening",
}
"""Names of the diagnosis, as they are called here; four of them are one constant force."""
NODES = 40.0
OPTIONS = SolverOptions("radau", 4, 1, 1e-7, 300)
WITHOUT_MAT = tuple(name for name in TRACKS_B if name != "strap")


@dataclass(frozen=True)
class StrapWith:
    """The calibrated strap with one effect."""

    effect: str

    def __call__(self, tree: Any, p: Any) -> Strap:
        """As `StrapLaw` wants it; the effect's number stands behind the strap's."""
        from casadi import cos, exp, sin, tanh

        plain, more = thigh_strap(tree, p), p[len(STRAP_PARAMETERS)]
        normal, tangential = (STRAP_PARAMETERS[k].usual * exp(p[k]) for k in range(2))
        if self.effect == "tilt":
            return replace(plain, normal=plain.normal * cos(more) + plain.shear * sin(more))
        pad = Pad(tree, p[3])
        across, along = pad.off[0] * 0.0, pad.off[1] * 0.0
        if self.effect == "preload":
            across = more
        if self.effect == "stiffening":
            across = normal * pad.off[0] * more * (pad.off[0] / STIFFENS) ** 2
        if self.effect == "slip":
            limit, spring = FURTHER["slip"].usual * exp(more), tangential * pad.off[1]
            along = limit * tanh(spring / limit) - spring
        loads = together(plain.loads, pad.loads(across, along))
        return replace(plain, loads=loads, normal=plain.normal + across, shear=plain.shear + along)


Uses = tuple[Sequence[StandingTrial], Sequence[StandingTrial]]
"""Trials to fit to, and held out."""


def refitted(effect: str, uses: Uses, noise: StandingNoise) -> dict[str, Any]:
    """Mat's force on held-out trials by the full model that is not told it, fitted without and with an effect.

    Coordinates, rates, plates and torques are given. An effect that is "" is none.
    """
    subject, told = Subject(), {}
    for when, of in (("before", ""), ("after", effect)):
        if when == "after" and not effect:
            continue
        further = (FURTHER[of],) if of else ()
        model = with_exoskeleton(subject, StrapWith(of) if of else None, further)
        free = (*STRAP, *(each.name for each in further))
        found = _solved(phase_b(model, subject, uses[0], noise, EVERY_PLANTED, free=free), uses[0])
        names = [each.name for each in model.parameters]
        values = {n: model.parameters[k].value(float(found.p[k])) for k, n in enumerate(names) if n in free}
        off, solved = [], [found.solved]
        for trial in uses[1]:
            small = {"energy": LITTLE_ENERGY * model.energy**2}
            held = standing_phase(
                model, subject, [trial], noise, free=(), tracks=WITHOUT_MAT, small=small, held=found.p, start=found.p
            )
            again = _solved(held, [trial])
            solved.append(again.solved)
            seen = seen_in(model, again.motions[0], again.p, trial.time, trial.name)
            assert seen.strap is not None and trial.strap is not None
            off.append(seen.strap - trial.strap)
        told[when] = {"mat_N": float(np.sqrt(np.mean(np.concatenate(off) ** 2))), "numbers": values}
        told[when] |= {"solved": solved, "objective": found.objective}
    return told


def _solved(phase: PhaseProblem, trials: Sequence[StandingTrial]) -> CollocationResult:
    meshes = tuple(np.linspace(0.0, 1.0, round(NODES * float(t.time[-1])) + 1) for t in trials)
    return solve(phase.control, OPTIONS, meshes=meshes)
