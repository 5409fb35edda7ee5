"""A finer mesh where the balance needs one: intervals that leave too much of it are halved, the others stay.

Halved on its own an interval of degree d leaves about 2^-d of what it left, where the motion is smooth.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from time import process_time

import numpy as np

from geocontact.dynamics.collocation.certificate import CertificateLimits, fine_residual
from geocontact.dynamics.collocation.problem import ControlProblem
from geocontact.dynamics.collocation.solve import CollocationResult, Progress, SolverOptions, solve
from geocontact.dynamics.collocation.transcription import Mesh

MOST_HALVINGS = 4
"""Of an interval: to a sixteenth of its first length."""


def refined(
    problem: ControlProblem,
    found: CollocationResult,
    options: SolverOptions,
    turning: Sequence[bool],
    limits: CertificateLimits | None = None,
    progress: Progress | None = None,
) -> CollocationResult:
    """Solve again, from what was found, on meshes of `halved`, until no interval leaves more than the limits let pass.

    At most `MOST_HALVINGS` times, and no further where a search was not solved; iterations and seconds are those of all
    searches, and the options' seconds hold for all of them.

    Parameters
    ----------
    turning
        Of each coordinate: whether it is an angle, so that its balance is in N m.
    """
    began, iterations, seconds = process_time(), found.iterations, found.seconds
    for _ in range(MOST_HALVINGS):
        meshes = halved(problem, found, turning, limits)
        if not found.solved or all(len(a) == len(b) for a, b in zip(meshes, found.meshes, strict=True)):
            break
        left = max(options.seconds - seconds - (process_time() - began), 1e-3)
        found = solve(problem, replace(options, seconds=left), meshes=meshes, warm=found, progress=progress)
        iterations += found.iterations
    return replace(found, iterations=iterations, seconds=seconds + process_time() - began)


def halved(
    problem: ControlProblem,
    found: CollocationResult,
    turning: Sequence[bool],
    limits: CertificateLimits | None = None,
    shortest: Sequence[float] | None = None,
) -> tuple[Mesh, ...]:
    """Meshes with every interval halved that somewhere leaves more of the balance than the limits let pass.

    Parameters
    ----------
    shortest
        Of each trial, in parts of it: intervals are not halved to less.
    """
    limit, finer = limits or CertificateLimits(), []
    least = shortest or [0.0] * len(found.meshes)
    for trial, motion, mesh, part in zip(problem.trials, found.motions, found.meshes, least, strict=True):
        left = fine_residual(problem.system, trial, motion, found.p, turning)
        force, moment = (of.reshape(len(mesh) - 1, -1).max(axis=1) for of in (left.force, left.moment))
        middle = 0.5 * (mesh[:-1] + mesh[1:])
        coarse = np.diff(mesh) > 1.5 * part  # halved once more, lengths are parts or twice them, but for rounding
        finer.append(np.sort(np.r_[mesh, middle[coarse & ((force > limit.force) | (moment > limit.moment))]]))
    return tuple(finer)
