"""Certificates of a phase's motions, and what is left of the balance between their points over time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.dynamics.collocation.certificate import Certificate, certificate, fine_residual
from geocontact.dynamics.collocation.resimulation import Resimulation, resimulation
from geocontact.dynamics.collocation.solve import CollocationResult
from geocontact.dynamics.equations import Equations
from geocontact.dynamics.simulate import Stepper
from geocontact.standing_up.phase import PhaseProblem


@dataclass(frozen=True, eq=False)
class JudgedMotion:
    """One trial.

    Parameters
    ----------
    certificate
        None where the search was ended before its time, so that there is nothing to certify.
    time
        Of the finer grid [s].
    force, moment
        Largest residual of the balance there [N], [N m].
    """

    certificate: Certificate | None
    time: Float[np.ndarray, " t"]
    force: Float[np.ndarray, " t"]
    moment: Float[np.ndarray, " t"]


def judged(
    equations: Equations,
    controlled: Sequence[int],
    turning: Sequence[bool],
    phase: PhaseProblem,
    found: CollocationResult,
    *,
    certify: bool = True,
) -> tuple[JudgedMotion, ...]:
    """Of every trial; `controlled` are those of the equations' inputs that were sought."""
    stepper = Stepper(equations)
    system = phase.control.system
    each = []
    for trial, motion in zip(phase.control.trials, found.motions, strict=True):
        again: Resimulation = resimulation(stepper, motion, found.p, trial.inputs, controlled)
        left = fine_residual(system, trial, motion, found.p, turning)
        seen = certificate(found.solved, system, trial, again, turning) if certify else None
        each.append(JudgedMotion(seen, left.time, left.force, left.moment))
    return tuple(each)
