"""Models that may be true, held against each other on trials: what one leaves of another, to first order and refitted.

Where A is true and B is fitted instead, B leaves

    ½ rᵀ (I + D S² Dᵀ)⁻¹ r,   r = A's prediction minus B's, whitened, D B's derivatives, S their prior spread

to first order. B may do better than that by going further than derivatives reach; `remaining_nats` fits it to what A
predicts, within bounds, its prior around where it started: min ½ |r(φ)|² + ½ |(φ - φ₀)/S|².
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.chain.system import System
from geocontact.gap.attribute import Attribution
from geocontact.gap.case.refit import ROUNDS, Measured, RefitSearch, Whiten
from geocontact.gap.selection.evidence import prior_spread
from geocontact.gap.selection.model_comparison import Contender
from geocontact.identify.optimise.tolerances import CLOSE


@dataclass(frozen=True)
class Hypothesis:
    """A model that may be true: the names that it stands for, what it is and how it was fitted.

    `residuals`, `jacobian` are those of the trials that exist.
    """

    name: str
    system: System
    values: dict[str, float]
    residuals: list[Float[np.ndarray, "_ c"]]
    jacobian: list[Float[np.ndarray, "_ c p"]]

    @property
    def spread(self) -> Float[np.ndarray, " p"]:
        """Prior standard deviation of its parameters."""
        return prior_spread(self.system, self.values)


@dataclass(frozen=True)
class ModelPair:
    """Somebody who is true, and somebody who is fitted instead."""

    true: Hypothesis
    confounder: Hypothesis


@dataclass(frozen=True)
class Rows:
    """Whitened difference of a pair on some trials, and the confounder's directions in units of their prior spread."""

    moved: Float[np.ndarray, " n"]
    directions: Float[np.ndarray, "n p"]

    def with_(self, other: Rows, times: int) -> Rows:
        """These rows, and others that are recorded so many times."""
        root = float(np.sqrt(times))
        moved = np.concatenate([self.moved, root * other.moved])
        return Rows(moved, np.concatenate([self.directions, root * other.directions]))

    @property
    def nats(self) -> float:
        """What the confounder leaves."""
        part = self.directions.T @ self.moved
        inner = np.eye(len(part)) + self.directions.T @ self.directions
        return 0.5 * float(self.moved @ self.moved - part @ np.linalg.solve(inner, part))


def competing_models(found: Attribution) -> list[Contender]:
    """The best model of each answer still in question, what is named first; mistakes in the data do not count.

    None where nothing is missing, though something gains that may not be named.
    """
    said = found.answer
    if said.verdict == "no_gap":
        return []
    competitors = [said.chosen] if said.chosen.candidates and said.verdict != "unknown" else []
    for name in said.ambiguity:
        if any(name in one.names for one in competitors):
            continue
        models = [c for c in found.contenders if name in c.names and len(c.names) <= max(len(said.effects), 1)]
        if models:
            competitors.append(max(models, key=lambda c: c.judged.nats))
    return [one for one in competitors if not one.mistaken]


def fitted(one: Contender) -> Hypothesis:
    """A contender as it was fitted to the trials that exist."""
    model = one.judged.model
    return Hypothesis("+".join(one.names), model.system, model.values, model.residuals, model.jacobian)


def on_trials(whitenings: Sequence[Whiten], pair: ModelPair) -> Rows:
    """A pair on the trials that exist, under some noise."""
    columns = [
        np.concatenate([(b - a)[..., None], j * pair.confounder.spread], axis=-1)
        for a, b, j in zip(pair.true.residuals, pair.confounder.residuals, pair.confounder.jacobian, strict=True)
    ]
    white = np.concatenate([w(part) for w, part in zip(whitenings, columns, strict=True)])
    return Rows(white[:, 0], white[:, 1:])


@dataclass(frozen=True)
class SimulatedTrials:
    """Trials without noise that the true model would give, and the confounder as it is in them; each so many times."""

    confounder: System
    measured: Measured
    whitenings: Sequence[Whiten]
    times: int = 1


def remaining_nats(confounder: Hypothesis, recordings: Sequence[SimulatedTrials]) -> float:
    """What a confounder leaves where it is refitted to these recordings together, within bounds [nats]."""
    from scipy.optimize import least_squares

    searches = [RefitSearch(one.confounder, one.measured, one.whitenings) for one in recordings]
    roots = [float(np.sqrt(one.times)) for one in recordings]
    first = searches[0]
    start = np.array([confounder.values[p.name] for p in first.parameters]) / first.scale
    believed = np.divide(first.scale, confounder.spread, out=np.zeros(len(start)), where=confounder.spread > 0.0)

    def whitened(parts: list[list[Float[np.ndarray, "_ c p"]]]) -> Float[np.ndarray, "n p"]:
        rows = [
            root * whiten(part)
            for root, one, own in zip(roots, recordings, parts, strict=True)
            for whiten, part in zip(one.whitenings, own, strict=True)
        ]
        return np.concatenate(rows)

    def residual(z: Float[np.ndarray, " p"]) -> Float[np.ndarray, " n"]:
        off = whitened([[r[..., None] for r in one.residuals(z.tobytes())] for one in searches])[:, 0]
        return np.concatenate([off, believed * (z - start)])

    def slope(z: Float[np.ndarray, " p"]) -> Float[np.ndarray, "n p"]:
        moved = -whitened([one.slopes(z.tobytes()) for one in searches]) * first.scale
        return np.concatenate([moved, np.diag(believed)])

    inside = np.clip(start, first.lower + 1e-6, first.upper - 1e-6)
    bounds = (first.lower, first.upper)
    return float(least_squares(residual, inside, slope, bounds, max_nfev=ROUNDS, ftol=CLOSE).cost)
