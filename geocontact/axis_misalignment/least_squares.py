"""Offsets, link and stiffness of an elbow exoskeleton from binned forces, and residuals by bin.

The explicit model's own fit counts every bin alike (its eq. 19). Here a bin counts by the time spent in it over twice
the noise's correlation time, which makes the sum of squares a likelihood, so that priors have their weight.
F(k/s, s × lengths) = F exactly: k and the four lengths are known up to one factor, whatever is recorded of angle and
force. One of them, a prior, or the displacement of a free joint has to say the rest.

Neighbouring bins share noise: a force that remembers is met again in the next bin a moment later. A test of their
distribution has to know of that, so its p-value comes from residuals of simulated normal noise with the same memory.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from jaxtyping import Float

from geocontact.axis_misalignment.beside_force import BesideForce, Sensors, beside_force
from geocontact.axis_misalignment.bins import BETA, FORCE, MOMENT, PRESSURE, RATE, Binned
from geocontact.axis_misalignment.compensation import DisplacementScale
from geocontact.axis_misalignment.law import NAMES, SCALED, ElbowLaw
from geocontact.data.elbow_recording import ElbowRecording
from geocontact.data.parameter import Parameter
from geocontact.identify.intervals.bin_tests import DRAWS, Normality, lilliefors
from geocontact.identify.noise.autocorrelation import mean_covariance, spread
from geocontact.identify.optimise.levenberg_marquardt import LevenbergMarquardtResult, levenberg_marquardt
from geocontact.identify.optimise.quasi_newton import spread_starts
from geocontact.identify.signals.angle_bins import bin_numbers

STARTS = 8
SAME = 1e-6  # of the cost: searches that end so close to each other end equally well


@dataclass(frozen=True)
class Prior:
    """What is known of a parameter from elsewhere: normal, with a mean and a standard deviation."""

    mean: float
    sd: float


@dataclass(frozen=True, eq=False)
class ElbowProblem:
    """Mean forces of cells, the law at their means, and what is known of its numbers beforehand.

    Parameters
    ----------
    force
        Mean force of each cell [N].
    law
        At the cells' mean angles, rates and pressures.
    weight
        Root of each cell's information [1/N].
    parameters
        One for each of NAMES, in that order; fixed where known.
    priors
        By name, of free ones.
    scale
        What a free joint's displacement tells of the lengths; None without.
    beside
        Moment of the cuff and angle of the arm, as far as they were measured.
    """

    force: Float[np.ndarray, " n"]
    law: ElbowLaw
    weight: Float[np.ndarray, " n"]
    parameters: tuple[Parameter, ...]
    priors: Mapping[str, Prior]
    scale: DisplacementScale | None = None
    beside: tuple[BesideForce, ...] = ()

    @cached_property
    def free(self) -> list[int]:
        """Places of the free numbers in NAMES."""
        return [k for k, p in enumerate(self.parameters) if not p.fixed]

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Free numbers."""
        return tuple(NAMES[k] for k in self.free)

    @cached_property
    def scalable(self) -> bool:
        """Whether one factor may change k and the lengths: a known number forbids it, unless it is 0."""
        return not any(p.fixed and p.start != 0.0 for p in self.parameters if p.name in SCALED)

    @cached_property
    def scale_by_moment(self) -> bool:
        """Whether a measured moment sets that factor: over the force it is a length, z."""
        return self.scalable and "z" in self.names and any(each.channel == MOMENT for each in self.beside)

    @cached_property
    def scale_free(self) -> bool:
        """Whether nothing sets that factor: no prior, no free joint's displacement, no moment of the cuff."""
        known = self.scale is not None or self.scale_by_moment or set(self.priors) & set(SCALED)
        return self.scalable and not known

    @cached_property
    def measured(self) -> int:
        """How many residuals are of measured means; those of scale and priors follow."""
        return len(self.force) + sum(len(each.means) for each in self.beside)

    def theta(self, values: Float[np.ndarray, " p"]) -> Float[np.ndarray, " 8"]:
        """All numbers, given the free ones."""
        full = self._starts.copy()
        full[self.free] = values
        return full

    def residual(self, values: Float[np.ndarray, " p"]) -> Float[np.ndarray, " m"]:
        """What the law is too large by, in standard deviations: force, then what else was measured; then what scale and
        priors are missed by in theirs.
        """
        theta = self.theta(values)
        off = (self.law.force(theta) - self.force) * self.weight
        others = [each.residual(theta) for each in self.beside]
        scale = [] if self.scale is None else [self.scale.residual(theta)]
        return np.concatenate(
            [off, *others, scale, (values - self._prior_mean)[self._known] / self._prior_sd[self._known]]
        )

    def jacobian(self, values: Float[np.ndarray, " p"]) -> Float[np.ndarray, "m p"]:
        """Derivative of the residual."""
        theta = self.theta(values)
        yields = not self.parameters[NAMES.index("c")].fixed
        slopes = self.law.slopes(theta, fixation=yields)[:, self.free] * self.weight[:, None]
        others = [each.slopes(theta, fixation=yields)[:, self.free] for each in self.beside]
        scale = [] if self.scale is None else [self.scale.slopes(theta)[None, self.free]]
        return np.vstack([slopes, *others, *scale, np.diag(1.0 / self._prior_sd)[self._known]])

    def held(self, name: str, value: float) -> ElbowProblem:
        """The same problem with one number known; its prior stays, as a constant that no step changes."""
        known = replace(self.parameters[NAMES.index(name)], start=value, lower=value, upper=value, fixed=True)
        parameters = tuple(known if p.name == name else p for p in self.parameters)
        return replace(self, parameters=parameters, priors={n: p for n, p in self.priors.items() if n != name})

    def measuring(self, force: Float[np.ndarray, " n"]) -> ElbowProblem:
        """The same problem with other mean forces, and nothing measured beside them."""
        return replace(self, force=force, beside=())

    def with_beside(self, beside: Sequence[BesideForce]) -> ElbowProblem:
        """The same problem with other means beside the force."""
        return replace(self, beside=tuple(beside))

    def drawn(
        self, force: Float[np.ndarray, " n"], beside: Sequence[BesideForce], rng: np.random.Generator
    ) -> ElbowProblem:
        """The same problem with other measured means, and with what is known otherwise as it could have been found."""
        priors = {n: Prior(float(rng.normal(p.mean, p.sd)), p.sd) for n, p in self.priors.items()}
        scale = None if self.scale is None else self.scale.drawn(rng)
        return replace(self, force=force, beside=tuple(beside), priors=priors, scale=scale)

    def searched(self, start: Float[np.ndarray, " p"]) -> LevenbergMarquardtResult:
        """Least squares from one start."""
        free = [self.parameters[k] for k in self.free]
        lower, upper = np.array([p.lower for p in free]), np.array([p.upper for p in free])
        scale = np.array([_scale(p) for p in free])
        return levenberg_marquardt(self.residual, self.jacobian, start, lower, upper, scale)

    @cached_property
    def _starts(self) -> Float[np.ndarray, " 8"]:
        return np.array([p.start for p in self.parameters])

    @cached_property
    def _prior_mean(self) -> Float[np.ndarray, " p"]:
        return np.array([self.priors[n].mean if n in self.priors else 0.0 for n in self.names])

    @cached_property
    def _prior_sd(self) -> Float[np.ndarray, " p"]:
        return np.array([self.priors[n].sd if n in self.priors else np.inf for n in self.names])

    @cached_property
    def _known(self) -> list[int]:
        return [k for k, n in enumerate(self.names) if n in self.priors]


@dataclass(frozen=True, eq=False)
class ElbowFit:
    """Values of the free numbers, the best of several searches.

    Parameters
    ----------
    theta
        All numbers, in the order of NAMES.
    values
        The free ones.
    costs, ends
        Half the sum of squares and the free numbers at the end of every search, in the order of the starts.
    """

    problem: ElbowProblem
    theta: Float[np.ndarray, " 8"]
    values: Float[np.ndarray, " p"]
    cost: float
    converged: bool
    costs: tuple[float, ...]
    ends: tuple[Float[np.ndarray, " p"], ...]

    @property
    def named(self) -> dict[str, float]:
        """All numbers by name."""
        return dict(zip(NAMES, map(float, self.theta), strict=True))

    @property
    def predicted(self) -> Float[np.ndarray, " n"]:
        """Force of each cell [N]."""
        return self.problem.law.force(self.theta)


def problem_of(
    data: Binned,
    parameters: Sequence[Parameter],
    priors: Mapping[str, Prior],
    scale: DisplacementScale | None = None,
    sensors: Sensors | None = None,
) -> ElbowProblem:
    """What the bins of some trials ask; moment and angle of the arm count with `sensors` only."""
    means, weight = data.cells.means, np.sqrt(data.information)
    others = () if sensors is None else beside_force(data, sensors)
    return ElbowProblem(means[:, FORCE], law_at(means), weight, tuple(parameters), priors, scale, others)


def law_at(means: Float[np.ndarray, "n c"]) -> ElbowLaw:
    """The law at the means of cells or visits."""
    return ElbowLaw(*(np.ascontiguousarray(means[:, k]) for k in (BETA, RATE, PRESSURE)))


def estimated(problem: ElbowProblem, starts: int = STARTS) -> ElbowFit:
    """The best of the searches from the parameters' own start and `starts` more, spread over the bounds."""
    names = problem.names
    own = {n: problem.parameters[NAMES.index(n)].start for n in names}
    spread = spread_starts(problem.parameters, starts)
    begins = [np.array([start.get(n, own[n]) for n in names]) for start in spread]
    return best_from(problem, begins)


def best_from(problem: ElbowProblem, begins: Sequence[Float[np.ndarray, " p"]]) -> ElbowFit:
    """The best of the searches from some starts.

    Of searches that end equally well the first counts: where only the scale is free, that is the first start.
    """
    found = [problem.searched(begin) for begin in begins]
    least = min(each.cost for each in found)
    best = next(each for each in found if each.cost <= (1.0 + SAME) * least + np.finfo(float).tiny)
    costs, ends = tuple(each.cost for each in found), tuple(each.values for each in found)
    return ElbowFit(problem, problem.theta(best.values), best.values, best.cost, best.converged, costs, ends)


def r_squared(measured: Float[np.ndarray, " n"], predicted: Float[np.ndarray, " n"]) -> float:
    """Coefficient of determination about the measured mean, as eq. 20; NaN where nothing varies."""
    spread = measured - measured.mean()
    total = float(spread @ spread)
    off = measured - predicted
    return 1.0 - float(off @ off) / total if total > 0.0 else float("nan")


def _scale(p: Parameter) -> float:
    """Magnitude of a parameter: a fifth of the room between its bounds, or of its start where they are far apart."""
    return min(0.2 * (p.upper - p.lower), max(abs(p.start), 1e-2 * (p.upper - p.lower)))


def residual_by_bin(data: Binned, e: ElbowFit) -> tuple[Float[np.ndarray, " b"], Float[np.ndarray, " b"]]:
    """Angle [rad] and measured less fitted force [N] of each bin, all trials together."""
    there = np.unique(data.cells.place)
    return data.centres[there], _pooled(data, (data.cells.means[:, FORCE] - e.predicted)[None])[0]


def standard_residuals(data: Binned, e: ElbowFit) -> Float[np.ndarray, " b"]:
    """Residual of each bin times the root of its information: about one spread, however long a bin was stayed in."""
    return np.asarray(residual_by_bin(data, e)[1] * _root_information(data))


def normal_residuals(
    recordings: Sequence[ElbowRecording], data: Binned, e: ElbowFit, count: int = DRAWS, seed: int = 0
) -> Float[np.ndarray, "d b"]:
    """`standard_residuals` of `count` draws of normal noise in the place of the recorded one.

    Ornstein-Uhlenbeck noise with the correlation time of `data` along the recorded angles, less what the fit would take
    out of it, to first order.
    """
    left = _noise_left(recordings, data, e, count, seed)
    return np.asarray(_pooled(data, left / e.problem.weight) * _root_information(data))


@dataclass(frozen=True)
class Excess:
    """What the fit leaves, trial by trial and bin by bin, against what noise within the trials would leave.

    Parameters
    ----------
    ratio
        Of the weighted sums of squares, 1 where noise is all.
    p
        Share of draws of noise that leave as much.
    """

    ratio: float
    p: float


def excess(
    recordings: Sequence[ElbowRecording], data: Binned, e: ElbowFit, count: int = DRAWS, seed: int = 1
) -> Excess:
    """Offsets that change from trial to trial, and whatever the law misses, leave more than a trial's noise does."""
    left = _noise_left(recordings, data, e, count, seed)
    draws = np.einsum("dn,dn->d", left, left)
    found = float(np.sum((e.problem.weight * (data.cells.means[:, FORCE] - e.predicted)) ** 2))
    return Excess(found / float(draws.mean()), float((1 + np.sum(draws >= found)) / (1 + len(draws))))


def _noise_left(
    recordings: Sequence[ElbowRecording], data: Binned, e: ElbowFit, count: int, seed: int
) -> Float[np.ndarray, "d n"]:
    """Weighted residuals of draws of noise, by trial and bin."""
    rng, bins, cells = np.random.default_rng(seed), len(data.visits.edges) - 1, data.cells
    noise = np.empty((count, len(cells.count)))
    for trial, r in enumerate(recordings):
        mine = cells.trial == trial
        all_bins = mean_covariance(r.time, bin_numbers(r.beta, data.visits.edges), bins, float(data.noise.tau[0]))
        reached = cells.place[mine]
        value, vector = np.linalg.eigh(all_bins[np.ix_(reached, reached)])
        noise[:, mine] = rng.standard_normal((count, len(value))) @ (vector * np.sqrt(np.maximum(value, 0.0))).T
    jacobian = e.problem.jacobian(e.values)
    slopes, off = jacobian[: len(cells.count)], noise * e.problem.weight
    return np.asarray(data.noise.sd[0] * (off - off @ slopes @ spread(jacobian) @ slopes.T))


def normality(recordings: Sequence[ElbowRecording], data: Binned, e: ElbowFit) -> Normality:
    """Lilliefors' test of the bins' standard residuals."""
    return lilliefors(standard_residuals(data, e), normal_residuals(recordings, data, e))


def _pooled(data: Binned, off: Float[np.ndarray, "d n"]) -> Float[np.ndarray, "d b"]:
    """Means of cells over the trials, for the bins that were reached."""
    there, place = np.unique(data.cells.place, return_inverse=True)
    share = np.zeros((len(place), len(there)))
    share[np.arange(len(place)), place] = data.cells.count
    return np.asarray(off @ (share / share.sum(axis=0)))


def _root_information(data: Binned) -> Float[np.ndarray, " b"]:
    information = np.bincount(data.cells.place, data.information)
    return np.asarray(np.sqrt(information[np.unique(data.cells.place)]))
