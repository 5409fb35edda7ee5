"""Does what was named hold in every trial? Each trial predicted from all the others, with it and without.

Leaving a trial out needs no fit of its own: with each trial's whitened residual r_i and derivatives D_i at the common
fit, A_i = D_iᵀ D_i and g_i = D_iᵀ r_i, one Gauss-Newton step without trial i is

    δ₋ᵢ = (A - A_i + S⁻²)⁻¹ (g - g_i),   C₋ᵢ = (A - A_i + S⁻²)⁻¹,

S the prior spread of the parameters, and the trial's predictive density N(r_i - D_i δ₋ᵢ; 0, I + D_i C₋ᵢ D_iᵀ).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.gap.case.problem import Problem
from geocontact.gap.selection.evidence import Judged, prior_spread


@dataclass(frozen=True)
class TrialGain:
    """How much better a trial is predicted from all others with what was named [nats], and whether it was held out."""

    trial: str
    held_out: bool
    nats: float


def leave_one_out(problem: Problem, base: Judged, named: Judged) -> tuple[TrialGain, ...]:
    """Gain of every trial, calibration trials first; both models under the noise of the one that was named.

    Levels of noise stay as they were estimated, from the calibration trials together.
    """
    without, with_it = predictive(problem, base, named), predictive(problem, named, named)
    count = len(problem.calibration.trials)
    return tuple(
        TrialGain(trial.name, i >= count, float(b - a))
        for i, (trial, a, b) in enumerate(zip(problem.recorded.trials, without, with_it, strict=True))
    )


def predictive(problem: Problem, one: Judged, under: Judged) -> Float[np.ndarray, " i"]:
    """Logarithm of each trial's predictive density given all others, without the constant [nats]."""
    whitenings = problem.whitenings(under.noise, one.model)
    spread = prior_spread(one.model.system, one.model.values)
    whitened = [
        whiten(np.concatenate([residual[..., None], jacobian * spread], axis=-1))
        for whiten, residual, jacobian in zip(whitenings, one.model.residuals, one.model.jacobian, strict=True)
    ]
    densities = left_out([each[:, 0] for each in whitened], [each[:, 1:] for each in whitened])
    return np.asarray(densities - [whiten.log_scale for whiten in whitenings])


def left_out(
    residuals: list[Float[np.ndarray, " _"]], designs: list[Float[np.ndarray, "_ p"]]
) -> Float[np.ndarray, " i"]:
    """Logarithm of N(r_i; D_i m, I + D_i C D_iᵀ), without the constant.

    m and C are the mean and covariance of the parameters given all other trials, under a unit prior.
    """
    grams = [design.T @ design for design in designs]
    pulls = [design.T @ residual for residual, design in zip(residuals, designs, strict=True)]
    scores = []
    for residual, design, gram, pull in zip(residuals, designs, grams, pulls, strict=True):
        others = np.eye(len(gram)) + sum(grams) - gram
        left = residual - design @ np.linalg.solve(others, sum(pulls) - pull)
        inner = others + gram  # I + D C Dᵀ by the matrix determinant lemma and Woodbury's identity
        part = design.T @ left
        quadratic = float(left @ left) - float(part @ np.linalg.solve(inner, part))
        half = 0.5 * float(np.linalg.slogdet(inner)[1] - np.linalg.slogdet(others)[1])
        scores.append(-0.5 * quadratic - half)
    return np.array(scores)
