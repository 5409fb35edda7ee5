"""Effects that these trials would not show, because refitted base parameters reproduce them.

An effect at the size where a search for it sets out moves the prediction by s (each channel in noise levels); refitting
the base leaves the part P⊥ s that no base parameter reproduces. What is left of the energy, |P⊥ s|²/|s|², is the
visible share: where it is small the effect makes wrong parameters instead of a gap.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.chain.effect import Candidate
from geocontact.gap.case.plain_fit import Plain, base_starts
from geocontact.gap.case.problem import Problem
from geocontact.gap.case.refit import Measured, derivatives, refit
from geocontact.gap.data_errors import exchanged
from geocontact.gap.levels import APART

VISIBLE = 0.03  # share of the energy that may be left of an effect that counts as absorbed
MOST = 10
TIED = 6  # digits of a share; what agrees in these is listed by name


@dataclass(frozen=True)
class Visibility:
    """Visible share of an effect, of one variant, shape and sign; `nats` over the noise floor are left of a mistake."""

    name: str
    share: float
    nats: float = 0.0

    @property
    def absorbed(self) -> bool:
        """Whether base parameters reproduce it."""
        return self.share < VISIBLE and self.nats < APART


NOTHING = Visibility("", np.inf)


def non_identifiable(problem: Problem, candidates: Sequence[Candidate], named: Sequence[str]) -> list[Visibility]:
    """Effects and mistakes that the base parameters reproduce, the most completely reproduced first."""
    return confounded((*visibilities(problem, candidates), *mistakes(problem, candidates)), named)


def confounded(seen: Sequence[Visibility], named: Sequence[str]) -> list[Visibility]:
    """Those of them that base parameters reproduce and nobody named, once each, most completely reproduced first."""
    least: dict[str, Visibility] = {}
    for each in seen:
        if each.absorbed and each.name not in named and each.share < least.get(each.name, NOTHING).share:
            least[each.name] = each
    return sorted(least.values(), key=lambda each: (round(each.share, TIED), each.name))[:MOST]


def shown(seen: Sequence[Visibility]) -> tuple[str, ...]:
    """Mistakes of which every variant that was tried leaves a gap, by name."""
    gaps: dict[str, bool] = {}
    for each in seen:
        gaps[each.name] = gaps.get(each.name, True) and not each.absorbed and each.nats >= APART
    return tuple(sorted(name for name, gap in gaps.items() if gap))


def visibilities(problem: Problem, candidates: Sequence[Candidate]) -> list[Visibility]:
    """Visibility of every candidate with a parameter, at every start that it offers."""
    system, values, measured = problem.system, problem.plain.values, problem.calibration
    whiten = [Plain(there, problem.floor_of_noise) for there in measured.present]
    before = measured.residuals(system, values)
    slopes = np.concatenate([w(j) for w, j in zip(whiten, derivatives(system, measured, values, before), strict=True)])
    basis = np.linalg.qr(slopes)[0]
    found = []
    for one in candidates:
        if not one.parameters:
            continue
        changed = one.apply(system)
        for start in one.starts:
            after = measured.residuals(changed, {**values, **start})
            step = [w((a - b)[..., None])[:, 0] for w, a, b in zip(whiten, after, before, strict=True)]
            moved = np.concatenate(step)
            energy = float(moved @ moved)
            if energy > 0.0:
                rest = moved - basis @ (basis.T @ moved)
                found.append(Visibility(one.name, float(rest @ rest) / energy))
    return found


def mistakes(problem: Problem, candidates: Sequence[Candidate]) -> list[Visibility]:
    """Visibility of every mistake in the data that changes a prediction, in all trials.

    Nats that cannot decide whether a mistake is absorbed any more are not searched to the end.
    """
    system, values, measured = problem.system, problem.plain.values, problem.calibration
    before = measured.residuals(system, values)
    still = [o - r for o, r in zip(measured.outputs, before, strict=True)]
    starts = [values, *base_starts(system)[:1]]
    found = []
    for one in candidates:
        if one.somewhere is None:
            continue
        floor = _written_down(problem, one)
        whiten = [Plain(there, floor) for there in measured.present]
        outputs = [o - r for o, r in zip(measured.outputs, measured.residuals(one.apply(system), values), strict=True)]
        moved = [w((a - b)[..., None])[:, 0] for w, a, b in zip(whiten, outputs, still, strict=True)]
        energy = 0.5 * sum(float(each @ each) for each in moved)
        if energy > 0.0:
            trials = Measured(measured.trials, tuple(outputs), measured.rough)
            left = refit(system, trials, whiten, starts, useful=min(APART, VISIBLE * energy)).cost
            found.append(Visibility(one.name, left / energy, left))
    return found


def _written_down(problem: Problem, one: Candidate) -> Float[np.ndarray, " c"]:
    """Noise of each channel in the units, and under the name, that a mistake writes it with."""
    floor, names = problem.floor_of_noise.copy(), problem.system.outputs
    if one.channel in names:
        floor[names.index(one.channel)] *= abs(one.factor)
    elif not one.channel:
        a, b = exchanged(one.variant, names)
        floor[[a, b]] = floor[[b, a]]
    return floor
