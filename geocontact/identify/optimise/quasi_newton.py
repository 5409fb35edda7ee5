"""Parameters within bounds by a quasi-Newton search from several starts (L-BFGS-B), the best one polished."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from jaxtyping import Bool, Float
from scipy.optimize import minimize

from geocontact.data.parameter import Parameter
from geocontact.identify.optimise.bounded_gauss_newton import ROUNDING, STEP
from geocontact.identify.optimise.least_squares import Fit, Predict, SearchRecord, divided, fit

OPTIONS: Any = {"maxiter": 200, "ftol": 1e-10, "gtol": 1e-7}


@dataclass(frozen=True, eq=False)
class Coordinates:
    """Search coordinates of the free parameters: 0 … 1 between their bounds, in the logarithm where these are wide."""

    lower: Float[np.ndarray, " p"]
    upper: Float[np.ndarray, " p"]
    logarithmic: Bool[np.ndarray, " p"]

    @classmethod
    def of(cls, free: Sequence[Parameter]) -> Coordinates:
        """Coordinates of these parameters; all bounds must be finite."""
        lower, upper = np.array([p.lower for p in free], float), np.array([p.upper for p in free], float)
        if not np.isfinite(lower).all() or not np.isfinite(upper).all():
            raise ValueError("every free parameter needs a finite lower and upper bound")
        wide = np.array([p.over_decades for p in free])
        return cls(np.where(wide, np.log(np.where(wide, lower, 1.0)), lower), _upper(upper, wide), wide)

    def values(self, z: Float[np.ndarray, " p"]) -> Float[np.ndarray, " p"]:
        """Parameters at these coordinates."""
        linear = self.lower + z * (self.upper - self.lower)
        return np.asarray(np.where(self.logarithmic, np.exp(np.where(self.logarithmic, linear, 0.0)), linear))

    def at(self, values: Float[np.ndarray, " p"]) -> Float[np.ndarray, " p"]:
        """Coordinates of these parameters, those outside the bounds moved to them."""
        logarithm = np.log(np.where(self.logarithmic, np.maximum(values, np.finfo(float).tiny), 1.0))
        linear = np.where(self.logarithmic, logarithm, values)
        return np.asarray(np.clip((linear - self.lower) / (self.upper - self.lower), 0.0, 1.0))


def _upper(upper: Float[np.ndarray, " p"], wide: Bool[np.ndarray, " p"]) -> Float[np.ndarray, " p"]:
    return np.where(wide, np.log(np.where(wide, upper, 1.0)), upper)


def spread_starts(parameters: Sequence[Parameter], count: int, seed: int = 0) -> list[dict[str, float]]:
    """The parameters' own starts, and `count` more spread over the bounds (Latin hypercube)."""
    free = [p for p in parameters if not p.fixed]
    if not free:
        return [{}]
    coordinates = Coordinates.of(free)
    drawn = latin_hypercube(len(free), count, seed)
    return [{}, *(dict(zip([p.name for p in free], map(float, coordinates.values(z)), strict=True)) for z in drawn)]


def latin_hypercube(dimensions: int, count: int, seed: int) -> Float[np.ndarray, "n d"]:
    """Points in the unit cube, one in each of `count` slices of each dimension.

    McKay, Beckman and Conover (1979), Technometrics 21, 239. `scipy.stats.qmc.LatinHypercube` draws the same, but its
    import takes half a second.
    """
    rng = np.random.default_rng(seed).spawn(1)[0]  # as scipy does
    inside = rng.uniform(size=(count, dimensions))
    slices = np.tile(np.arange(1, count + 1), (dimensions, 1))
    for each in slices:
        rng.shuffle(each)
    return np.asarray((slices.T - inside) / count)


def search(
    predict: Predict,
    measured: Sequence[Float[np.ndarray, "_ c"]],
    parameters: Sequence[Parameter],
    floor: Float[np.ndarray, " c"],
    starts: Sequence[Mapping[str, float]] = ({},),
) -> Fit:
    """Least squares within bounds by L-BFGS-B, the best of several starts; as `least_squares.fit` otherwise.

    Byrd, Lu, Nocedal and Zhu (1995), SIAM J. Sci. Comput. 16, 1190; gradients by differences within the bounds. What
    is minimised is the logarithm of the mean square, so that starts decades away do no harm. The best search
    is finished by `least_squares.fit`, which a narrow valley does not slow down; `costs` are those before it.
    """
    free = [p for p in parameters if not p.fixed]
    names = tuple(p.name for p in free)

    def residual(values: Float[np.ndarray, " p"]) -> Float[np.ndarray, " n"]:
        predicted = predict(dict(zip(names, map(float, values), strict=True)))
        return np.concatenate([divided(p, m, floor) for p, m in zip(predicted, measured, strict=True)])

    if not free:
        return fit(predict, measured, parameters, floor)
    coordinates = Coordinates.of(free)

    def cost(z: Float[np.ndarray, " p"]) -> tuple[float, Float[np.ndarray, " p"]]:
        off, slope = residual(coordinates.values(z)), np.empty(len(z))
        for k in range(len(z)):
            ends = min(z[k] + STEP, 1.0), max(z[k] - STEP, 0.0)  # beyond the bounds the law need not be defined
            ahead, behind = (residual(coordinates.values(np.where(np.arange(len(z)) == k, end, z))) for end in ends)
            slope[k] = off @ (ahead - behind) / (ends[0] - ends[1])
        square = float(off @ off) / len(off) + ROUNDING
        return float(np.log(square)), 2.0 * slope / (len(off) * square)

    count = int(sum(np.isfinite(m).sum() for m in measured))

    def scaled(low: float) -> float:
        return 0.5 * count * max(float(np.exp(low)) - ROUNDING, 0.0)

    searches, records = [], []
    for start in starts:
        begin = coordinates.at(np.array([start.get(p.name, p.start) for p in free], float))
        counted = _Counted(cost)
        found: Any = minimize(
            counted,
            begin,
            jac=True,
            method="L-BFGS-B",
            bounds=[(0.0, 1.0)] * len(free),
            options=OPTIONS,
            callback=counted.iterated,
        )
        searches.append((float(found.fun), coordinates.values(np.asarray(found.x, float))))
        records.append(SearchRecord((1, *counted.reached), tuple(map(scaled, counted.lows)), str(found.message)))
    _, values = min(searches, key=lambda found: found[0])
    polished = fit(predict, measured, parameters, floor, [dict(zip(names, map(float, values), strict=True))])
    return replace(polished, costs=tuple(scaled(low) for low, _ in searches), record=tuple(records))


class _Counted:
    """An objective that counts its calls, and notes how many there were and how low it was after each iteration."""

    def __init__(self, cost: Callable[[Float[np.ndarray, " p"]], tuple[float, Float[np.ndarray, " p"]]]) -> None:
        self._cost, self._calls = cost, 0
        self.reached: list[int] = []
        self.lows: list[float] = []

    def __call__(self, z: Float[np.ndarray, " p"]) -> tuple[float, Float[np.ndarray, " p"]]:
        self._calls += 1
        found = self._cost(z)
        if self._calls == 1:
            self.lows.append(found[0])
        return found

    def iterated(self, intermediate_result: Any) -> None:
        """One iteration is over."""
        self.reached.append(self._calls)
        self.lows.append(float(intermediate_result.fun))
