"""Intervals of what was identified at an elbow, and the direction in which nothing is identified.

Stretches of time are what varies independently. Their scores give the sandwich covariance (Liang and Zeger 1986,
Biometrika 73, 13); the profile is cut where its parabola would have that width (Chandler and Bate 2007, as in
`profile_likelihood`); and in the wild bootstrap (Cameron, Gelbach and Miller 2008, Review of Economics and Statistics
90, 414) the residuals of a stretch keep or turn their sign together.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.special import stdtrit

from geocontact.axis_misalignment.bins import FORCE, Binned
from geocontact.axis_misalignment.law import GROWING, NAMES, SCALED
from geocontact.axis_misalignment.least_squares import ElbowFit, ElbowProblem, best_from, law_at
from geocontact.identify.intervals.profile_likelihood import POINTS, Profile, profile_of
from geocontact.identify.noise.autocorrelation import spread

DISTINCT = 1e-2  # of a number: minima that lie closer are one
SERIES = 1e-4  # of a column: what differences leave of one that is another's multiple
FLAT = 1e-6  # of the largest singular value: below, the data say nothing in this direction


@dataclass(frozen=True, eq=False)
class Covariance:
    """Covariance of the free numbers, by stretches.

    Parameters
    ----------
    matrix
        In their units.
    inverse
        (J'J)^-1 of the weighted derivatives, priors included.
    freedom
        Stretches less free numbers.
    """

    matrix: Float[np.ndarray, "p p"]
    inverse: Float[np.ndarray, "p p"]
    freedom: int

    def half_width(self, k: int, level: float = 0.95) -> float:
        """Half the interval of the k-th free number if the law were linear."""
        return float(stdtrit(self.freedom, 0.5 + 0.5 * level) * np.sqrt(self.matrix[k, k]))

    def cut(self, k: int, level: float = 0.95) -> float:
        """Rise of the sum of squares at which the profile of the k-th free number is cut."""
        return self.half_width(k, level) ** 2 / float(self.inverse[k, k])


@dataclass(frozen=True, eq=False)
class Direction:
    """What the data identify of numbers when each is changed by a share of itself.

    Parameters
    ----------
    names
        Of the numbers.
    singular_values
        Of the derivatives with respect to their logarithms, largest first [N].
    least
        Unit vector of the direction identified least; where it is (-1, 1, 1, 1, 1)/sqrt(5) in k, x, y, l, z it is the
        scale.
    """

    names: tuple[str, ...]
    singular_values: Float[np.ndarray, " p"]
    least: Float[np.ndarray, " p"]

    @property
    def flat(self) -> bool:
        """Whether nothing is identified in that direction."""
        return bool(self.singular_values[-1] <= FLAT * self.singular_values[0])


def covariance(data: Binned, e: ElbowFit) -> Covariance:
    """Sandwich of the stretches' scores; priors and the scale count as one stretch each that has just its error."""
    jacobian = e.problem.jacobian(e.values)
    inverse = spread(jacobian)
    scores, stretches = _scores(data, e)
    middle = scores.T @ scores * stretches / max(stretches - 1, 1)
    known = jacobian[e.problem.measured :]
    matrix = inverse @ (middle + known.T @ known) @ inverse
    return Covariance(matrix, inverse, max(stretches - len(e.values), 1))


def profiled(e: ElbowFit, c: Covariance, name: str, level: float = 0.95, points: int = POINTS) -> Profile:
    """Profile of one free number, and its interval of probability `level`.

    Offsets of other signs can fit nearly as well. Each value is searched from every minimum that lies within the cut,
    and from where the nearest value ended; there are as many intervals as minima that the cut keeps apart.
    """
    k = e.problem.names.index(name)
    parameter = e.problem.parameters[NAMES.index(name)]
    prior = e.problem.priors.get(name)
    half = max(c.half_width(k, level), 1e-9 * abs(float(e.values[k])))
    minima = _minima(e, c.cut(k, level))
    ended: dict[float, Float[np.ndarray, " p"]] = {}

    def held(value: float) -> float:
        problem = e.problem.held(name, value)
        apart = 0.0 if prior is None else ((value - prior.mean) / prior.sd) ** 2
        if not problem.free:
            return 2.0 * _cost(e, value) + apart
        begins = [_near(e.problem, values, name, value) for values in minima]
        begins += [ended[near] for near in sorted(ended, key=lambda v: abs(v - value))[:1]]
        found = min((problem.searched(np.delete(begin, k)) for begin in begins), key=lambda search: search.cost)
        ended[value] = np.insert(found.values, k, value)
        return 2.0 * found.cost + apart

    others = [float(values[k]) for values in minima[1:]]
    return profile_of(held, 2.0 * e.cost, parameter, float(e.values[k]), half, float(c.inverse[k, k]), points, others)


def with_link_held(e: ElbowFit) -> ElbowFit:
    """The same with l held where it is: k and the lengths are then, in units of l, independent of the scale."""
    problem, place = e.problem.held("l", e.named["l"]), e.problem.names.index("l")
    return best_from(problem, [np.delete(values, place) for values in _minima(e, np.inf)])


def _minima(e: ElbowFit, cut: float) -> list[Float[np.ndarray, " p"]]:
    """Ends of searches less than `cut` above the least sum of squares, each once; at one l where the scale is free."""
    found = [e.values]
    for end, cost in zip(e.ends, e.costs, strict=True):
        factor = e.named["l"] / e.problem.theta(end)[3] if e.problem.scale_free else 1.0
        values = _scaled(e.problem.theta(end), np.array([factor]))[0][e.problem.free]
        if 2.0 * (cost - e.cost) < cut and not any(np.allclose(values, other, rtol=DISTINCT) for other in found):
            found.append(values)
    return found


def _near(problem: ElbowProblem, values: Float[np.ndarray, " p"], name: str, value: float) -> Float[np.ndarray, " p"]:
    """Where to search from with one number held at a value: along the scale where it is free, else where it was."""
    best = float(values[problem.names.index(name)])
    if not problem.scalable or name not in SCALED or value * best <= 0.0:
        return values
    factor = value / best if name in GROWING else best / value
    return np.asarray(_scaled(problem.theta(values), np.array([factor]))[0][problem.free])


def _cost(e: ElbowFit, value: float) -> float:
    off = (e.problem.law.force(e.problem.theta(np.array([value]))) - e.problem.force) * e.problem.weight
    return 0.5 * float(off @ off)


def wild_bootstrap(data: Binned, e: ElbowFit, count: int, seed: int = 0) -> Float[np.ndarray, "b p"]:
    """Free numbers refitted to `count` replicates: stretches keep or turn the sign of their residuals.

    Residuals are widened by the root of G/(G - p) for G stretches and p free numbers; means of priors are drawn from
    the priors, and the scale from its error. Each replicate is searched from every minimum within the widest cut of a
    profile, and the best counts: where offsets of other signs fit nearly as well, draws are of both.
    """
    v = data.visits
    rng = np.random.default_rng(seed)
    numbers, stretch = np.unique(v.stretch, return_inverse=True)
    stretches = len(numbers)
    off = v.means[:, FORCE] - law_at(v.means).force(e.theta)
    share = v.count / data.cells.count[data.cells.of_visit] * off
    wider = np.sqrt(stretches / max(stretches - len(e.values), 1))
    c = covariance(data, e)
    minima = _minima(e, max(c.cut(k) for k in range(len(e.values))))
    found = np.empty((count, len(e.values)))
    for k in range(count):
        signs = rng.choice([-1.0, 1.0], stretches)[stretch]
        drawn = np.bincount(data.cells.of_visit, wider * signs * share, len(data.cells.count))
        others = [each.redrawn(e.theta, wider * signs) for each in e.problem.beside]
        found[k] = best_from(e.problem.drawn(e.predicted + drawn, others, rng), minima).values
    return found


def _scores(data: Binned, e: ElbowFit) -> tuple[Float[np.ndarray, "g p"], int]:
    """Gradient of half the sum of squares, stretch by stretch, and how many stretches there are."""
    v = data.visits
    off = v.means[:, FORCE] - law_at(v.means).force(e.theta)
    cell, jacobian = data.cells.of_visit, e.problem.jacobian(e.values)
    first = len(data.cells.count)
    share = (v.count / data.cells.count[cell] * off * e.problem.weight[cell])[:, None] * jacobian[:first][cell]
    for each in e.problem.beside:
        last = first + len(each.means)
        share[each.visit] -= each.scores(e.theta, jacobian[first:last])
        first = last
    numbers, stretch = np.unique(v.stretch, return_inverse=True)
    return np.column_stack([np.bincount(stretch, column) for column in share.T]), len(numbers)


@dataclass(frozen=True, eq=False)
class Separability:
    """How far a yielding fixation of the upper arm is separable from a softer cuff.

    Parameters
    ----------
    from_cuff
        Share of the force's change by c that no change of k makes; 0 where both are in series and nothing else.
    from_all
        That no change of the free numbers makes, c left out.
    """

    from_cuff: float
    from_all: float

    @property
    def separable(self) -> bool:
        """Whether angle and force separate the two at all."""
        return self.from_all > SERIES


def separability(e: ElbowFit) -> Separability:
    """Separability of the compliance c, at the numbers found, weighted as in the fit; without priors.

    Where the attachment is on the limb's line (z = 0) c and 1/k are in series exactly, F = d_tot/(1/k + c). Beside it
    the force across the limb, which z brings about, turns the limb and makes the rest.
    """
    slopes = e.problem.law.slopes(e.theta) * e.problem.weight[:, None]
    others = [k for k in e.problem.free if NAMES[k] != "c"]
    return Separability(_share_outside(slopes[:, 7], slopes[:, :1]), _share_outside(slopes[:, 7], slopes[:, others]))


def _share_outside(column: Float[np.ndarray, " n"], others: Float[np.ndarray, "n p"]) -> float:
    """Length of what is left of a column beside others, over its own; 0 where it has none."""
    own = float(np.linalg.norm(column))
    sizes = np.linalg.norm(others, axis=0)
    scaled = others[:, sizes > 0.0] / sizes[sizes > 0.0]
    fitted = scaled @ np.linalg.lstsq(scaled, column, rcond=None)[0]
    return float(np.linalg.norm(column - fitted)) / own if own > 0.0 else 0.0


def direction(e: ElbowFit, names: tuple[str, ...] = SCALED) -> Direction:
    """Singular values and the direction identified least, of numbers that need not be free, in their logarithms.

    Numbers that are 0 are left out: they have no logarithm, and no factor changes them.

    The derivative with respect to the logarithm of a number is the number times the derivative: it has no unit to
    choose, and a number may be negative. Priors do not count: this is what the recordings tell.
    """
    names = tuple(name for name in names if e.named[name] != 0.0)
    places = [NAMES.index(name) for name in names]
    slopes = e.problem.law.slopes(e.theta)[:, places] * e.theta[places]
    _, values, rows = np.linalg.svd(slopes, full_matrices=False)
    least = rows[-1]
    return Direction(names, values, np.asarray(least if least[-1] >= 0.0 else -least))


def along_the_scale(e: ElbowFit, factors: Float[np.ndarray, " m"]) -> Float[np.ndarray, "m 8"]:
    """Numbers (k/s, s times the lengths and the compliance) for each factor s; every row gives the same force."""
    return _scaled(e.theta, factors)


def _scaled(theta: Float[np.ndarray, " 8"], factors: Float[np.ndarray, " m"]) -> Float[np.ndarray, "m 8"]:
    rows = np.tile(theta, (len(factors), 1))
    rows[:, 0] /= factors
    rows[:, 1:5] *= factors[:, None]
    rows[:, 5] /= factors
    rows[:, 7] *= factors
    return rows
