"""The smallest amplitude of an effect that the diagnosis would see on given trials, with a stated power.

An effect at some amplitude adds P⊥ s to whitened residuals that are otherwise independent and of unit variance. To
first order, what its model gains is

    G = ½ |Qᵀ (P⊥ s + ε)|² - ½ log det(I + S Dᵀ P⊥ D S) - log(its variants),

Q the directions of its own parameters beyond the base's, D their derivatives at this amplitude, S their prior spread:
half a noncentral chi-square with noncentrality 2 × the visible nats, less Occam's price. Other effects gain on the same
residual, correlated with it, so chi-squares are drawn together, not looked up. Gains then pass what the verdict makes
of them (`gap.selection.verdict`: borne out by calibration trials, tolerance of form, `SURE` for the base model), and
the effect counts as seen where effects together outweigh "none". The seed is the same at every amplitude, so a
bisection finds the amplitude. Noise levels are taken as known. That something is seen does not say that the right
effect is named.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.chain.effect import Candidate
from geocontact.gap.case.refit import magnitude
from geocontact.gap.identifiability.signatures import (
    ADDS,
    BaseState,
    Sized,
    at_nats,
    orthonormal,
    own_slopes,
    reach_of,
    rest_of,
    sized,
)
from geocontact.gap.levels import DRAWS, FLAT, SLIGHT, SURE
from geocontact.gap.selection.verdict import borne_out

POWER = 0.8  # share of repetitions in which an effect of the stated amplitude is seen
HALVINGS = 10  # of the bracket that the amplitude is in
FAINTEST = 0.5  # visible nats from which the search sets out; two more at least are needed to be seen
CLEAR = 80.0  # visible nats at which every effect is seen


@dataclass(frozen=True)
class Detectability:
    """What it takes for an effect to be seen.

    Parameters
    ----------
    candidate
        The effect.
    smallest
        Smallest amplitude that is seen with the stated power, the other parameters where a search for it starts; None
        where its bounds end before.
    at
        The effect there; at the end of its bounds where it is not seen.
    power
        Share of repetitions in which it is seen there.
    """

    candidate: Candidate
    smallest: float | None
    at: Sized
    power: float


@dataclass(frozen=True)
class Gainer:
    """A model that may gain on residuals: directions of its own on all rows and on calibration rows, and its price.

    `share` of what it changes, the base refitted, lies in the calibration rows. `sign` is +1 where the amplitude may
    only be positive along the one direction, 0 where either way will do.
    """

    name: str
    directions: Float[np.ndarray, "n k"]
    calibration: Float[np.ndarray, "n k"]
    price: float
    calibration_price: float
    chosen_from: float
    share: float
    sign: int


def detectabilities(
    ground: BaseState,
    candidates: Sequence[Candidate],
    asked: Sequence[Candidate],
    step: Callable[[], None] = lambda: None,
) -> tuple[Detectability, ...]:
    """Detectability of those asked about, all of which and `candidates` may gain; `step` is called after each."""
    variants, competitors = (
        Counter(one.name for one in candidates if one.parameters),
        competitors_of(ground, candidates),
    )
    found = []
    for one in asked:
        found.append(detectability(ground, one, competitors, variants[one.name]))
        step()
    return tuple(found)


def competitors_of(ground: BaseState, candidates: Sequence[Candidate]) -> dict[str, list[Gainer]]:
    """Every candidate with a parameter where it starts from, by label."""
    known = [one for one in candidates if one.parameters]
    variants = Counter(one.name for one in known)
    return {one.label: _starting(ground, one, variants[one.name]) for one in known}


def detectability(
    ground: BaseState, candidate: Candidate, competitors: dict[str, list[Gainer]], variants: int
) -> Detectability:
    """Detectability of one candidate; `rivals` are all that may gain, by label."""
    faint, clear = (at_nats(ground, candidate, nats) for nats in (FAINTEST, CLEAR))
    others = [each for label, some in competitors.items() if label != candidate.label for each in some]

    def seen(one: Sized) -> float:
        return power(ground, one, others, variants)

    most = seen(clear)
    if most < POWER:
        return Detectability(candidate, None, clear, most)
    low, high, best, reached = _share(faint), _share(clear), clear, most
    for _ in range(HALVINGS):
        middle = float(np.sqrt(low * high))
        one = _at_share(ground, candidate, middle)
        chance = seen(one)
        if chance >= POWER:
            high, best, reached = middle, one, chance
        else:
            low = middle
    return Detectability(candidate, best.amplitude, best, reached)


def _share(one: Sized) -> float:
    """Part of the way from rest to the end of its bounds."""
    rest, start = rest_of(one.candidate), one.candidate.starts[0]
    return max((one.amplitude - rest) / reach_of(one.candidate, start), 1e-9)


def _at_share(ground: BaseState, candidate: Candidate, share: float) -> Sized:
    start, first = candidate.starts[0], candidate.parameters[0].name
    value = rest_of(candidate) + share * reach_of(candidate, start)
    return sized(ground, candidate, {**start, first: value})


def power(ground: BaseState, one: Sized, others: Sequence[Gainer], variants: int) -> float:
    """Share of repetitions in which effects outweigh "none" where this effect is there."""
    moved = ground.moved(one.candidate.apply(ground.system), {**ground.values, **one.values})
    own = _gainer(ground, one.candidate, one.values, moved, variants, present=True)
    gainers = [own, *others]
    rows = _independent(gainers)
    rng = np.random.default_rng(0)
    draws = rng.standard_normal((DRAWS, rows.shape[1])) + rows.T @ ground.left(moved)
    best: dict[str, Float[np.ndarray, " r"]] = {}
    for each in gainers:
        gain = _gains(each, rows, draws)
        best[each.name] = np.maximum(best.get(each.name, gain), gain)
    return float(np.mean(_outweighs(np.stack(list(best.values())))))


def _outweighs(gains: Float[np.ndarray, "e r"]) -> Float[np.ndarray, " r"]:
    """Where effects together are more probable than none, as `gap.selection.verdict.answer` weighs them: 1, else 0."""
    most = np.maximum(gains.max(axis=0), 0.0)
    tolerance = 1.0 + SLIGHT * most
    effects = np.exp((gains - most) / tolerance).sum(axis=0)
    return np.asarray(effects > np.exp((SURE - most) / tolerance), dtype=float)


def _gains(one: Gainer, rows: Float[np.ndarray, "n k"], draws: Float[np.ndarray, "r k"]) -> Float[np.ndarray, " r"]:
    """Over the base model, as far as the calibration trials bear them out [nats]."""
    along = draws @ (rows.T @ one.directions)
    total = 0.5 * (along**2).sum(axis=1) - one.price
    part = 0.5 * ((draws @ (rows.T @ one.calibration)) ** 2).sum(axis=1) - one.calibration_price
    borne = np.array([borne_out(float(a), float(b), one.share) for a, b in zip(total, part, strict=True)])
    borne = borne - one.chosen_from
    return np.where(along[:, 0] > 0.0, borne, -np.inf) if one.sign else borne


def _independent(gainers: Sequence[Gainer]) -> Float[np.ndarray, "n k"]:
    """Orthonormal directions in which everyone's lie."""
    return orthonormal(np.hstack([part for one in gainers for part in (one.directions, one.calibration)]))


def _starting(ground: BaseState, candidate: Candidate, variants: int) -> list[Gainer]:
    """A competing model, at every start that it offers."""
    system = candidate.apply(ground.system)
    return [
        _gainer(ground, candidate, start, ground.moved(system, {**ground.values, **start}), variants, present=False)
        for start in candidate.starts
    ]


def _gainer(
    ground: BaseState,
    candidate: Candidate,
    values: Mapping[str, float],
    moved: Float[np.ndarray, " n"],
    variants: int,
    present: bool,
) -> Gainer:
    """A candidate near given values: the first direction is what it does there, the others its shape's.

    Of a competing model, `present` false, only the first: what its shape can do besides is in its other starts.
    """
    parameters = candidate.parameters if present else candidate.parameters[:1]
    slopes = own_slopes(ground, candidate, values, moved)[:, : len(parameters)]
    spread = [_spread(p.upper - p.lower, magnitude(p)) for p in parameters]
    inside = slice(0, ground.fitted_rows)
    first = ground.left(moved)
    parts = np.column_stack([first, *(ground.left(slopes[:, k]) for k in range(1, len(parameters)))])
    calibration = np.zeros_like(parts)
    known = orthonormal(ground.slopes[inside])
    whole = np.column_stack([moved, slopes[:, 1:]])[inside]
    calibration[inside] = whole - known @ (known.T @ whole)
    amplitude = candidate.parameters[0]
    return Gainer(
        candidate.name,
        _in_order(parts),
        _in_order(calibration),
        _price(slopes * spread, ground.base),
        _price((slopes * spread)[inside], known),
        float(np.log(variants)),
        _calibration_share(ground, moved),
        int(amplitude.lower >= rest_of(candidate) or amplitude.upper <= rest_of(candidate)),
    )


def _calibration_share(ground: BaseState, moved: Float[np.ndarray, " n"]) -> float:
    """Part, in the calibration rows, of what is left of a change once the base is refitted to these."""
    inside = slice(0, ground.fitted_rows)
    size = np.linalg.norm(ground.slopes[inside], axis=0)
    slopes = ground.slopes[:, size > 0.0] / size[size > 0.0]
    left = moved - slopes @ np.linalg.lstsq(slopes[inside], moved[inside], rcond=ADDS)[0]
    whole = float(left @ left)
    return float(left[inside] @ left[inside]) / whole if whole > 0.0 else ground.share


def _spread(width: float, size: float) -> float:
    return width / FLAT if np.isfinite(width) else 100.0 * size


def _price(design: Float[np.ndarray, "n p"], base: Float[np.ndarray, "n k"]) -> float:
    """Occam's: half the logarithm of how much the data narrow the prior, base parameters being free."""
    left = design - base @ (base.T @ design)
    return 0.5 * float(np.linalg.slogdet(np.eye(left.shape[1]) + left.T @ left)[1])


def _in_order(columns: Float[np.ndarray, "n k"]) -> Float[np.ndarray, "n k"]:
    """Orthonormal, the first along the first column; columns that add nothing are zero."""
    made = np.zeros_like(columns)
    for k in range(columns.shape[1]):
        rest = columns[:, k] - made[:, :k] @ (made[:, :k].T @ columns[:, k])
        size = float(np.linalg.norm(rest))
        if size > 1e-6 * max(float(np.linalg.norm(columns[:, k])), 1e-300):
            made[:, k] = rest / size
    return made
