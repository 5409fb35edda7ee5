"""Effects that these trials would not show, because refitted base parameters imitate them.

An effect at the size where a search for it sets out moves the prediction by s (each channel in noise levels); refitting
the base leaves the part P⊥ s that no base parameter imitates. What is left of the energy, |P⊥ s|²/|s|², is the visible
share: where it is small the effect makes wrong parameters instead of a gap.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from geocontact.chain.candidate import Candidate
from geocontact.gap.problem import Plain, Problem
from geocontact.gap.refit import derivatives

VISIBLE = 0.03  # share of the energy that may be left of an effect that counts as absorbed
MOST = 10
TIED = 6  # digits of a share; what agrees in these is listed by name


@dataclass(frozen=True)
class Visibility:
    """Visible share of an effect, the least over its variants, shapes and signs."""

    name: str
    share: float


def absorbed(problem: Problem, candidates: Sequence[Candidate], named: Sequence[str]) -> list[Visibility]:
    """Effects that the base parameters swallow, the most completely swallowed first."""
    least: dict[str, float] = {}
    for each in visibilities(problem, candidates):
        least[each.name] = min(each.share, least.get(each.name, np.inf))
    kept = [Visibility(name, share) for name, share in least.items() if share < VISIBLE and name not in named]
    return sorted(kept, key=lambda each: (round(each.share, TIED), each.name))[:MOST]


def visibilities(problem: Problem, candidates: Sequence[Candidate]) -> list[Visibility]:
    """Of every candidate with a parameter, at every start that it offers."""
    system, values, measured = problem.system, problem.plain.values, problem.calibration
    weigh = [Plain(there, problem.floor_of_noise) for there in measured.present]
    before = measured.residuals(system, values)
    slopes = np.concatenate([w(j) for w, j in zip(weigh, derivatives(system, measured, values, before), strict=True)])
    basis = np.linalg.qr(slopes)[0]
    found = []
    for one in candidates:
        if not one.parameters:
            continue
        changed = one.apply(system)
        for start in one.starts:
            after = measured.residuals(changed, {**values, **start})
            step = [w((a - b)[..., None])[:, 0] for w, a, b in zip(weigh, after, before, strict=True)]
            moved = np.concatenate(step)
            energy = float(moved @ moved)
            if energy > 0.0:
                rest = moved - basis @ (basis.T @ moved)
                found.append(Visibility(one.name, float(rest @ rest) / energy))
    return found
