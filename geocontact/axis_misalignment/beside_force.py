"""What was measured beside the force: the cuff's moment, which sets the scale of k and lengths, and the arm's angle.

With F the measured force, of the model in terms of the link's end (`law`)

    M = κ γ - F z/cos² γ        moment of the cuff on the forearm
    α = β - γ + zero            angle of the person's elbow

γ depends on x/l, y/l alone, so that M/F has a length in it, z, while α has only ratios. κ, the cuff's stiffness against
turning, is a nuisance unless it is known: the moment is linear in it. So is the zero of α, one for each trial, unless
the sensor was zeroed at the stretched arm. Both are taken out of the residual (variable projection: Golub and Pereyra
1973, SIAM J Numer Anal 10, 413), so that they cost what they cost and are no number of the law.

The measured force stands in M, not the modelled one: what a person adds to the force goes through the cuff as well, and
is in the moment. Where the fixation yields (c > 0) γ is that under load, without the part of κ in the load.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float, Int

from geocontact.axis_misalignment.bins import ALPHA, BETA, FORCE, MOMENT, PRESSURE, RATE, Binned
from geocontact.axis_misalignment.explicit import NEAR_POLE
from geocontact.axis_misalignment.law import STEP, ElbowLaw


@dataclass(frozen=True)
class Sensors:
    """What is known of them.

    Parameters
    ----------
    turning
        Stiffness κ of the cuff against turning [N m/rad]; None where it is looked for.
    zeroed
        Whether the arm's angle has the zero of the exoskeleton's; its level counts then, else its change alone.
    """

    turning: float | None = None
    zeroed: bool = False


@dataclass(frozen=True, eq=False)
class BesideForce:
    """Mean moments or angles of cells, and of the visits that they consist of.

    Parameters
    ----------
    channel
        MOMENT or ALPHA.
    cells, visits
        Means of all channels.
    trial, of_visit
        Trial of each cell; the cell that each visit is a part of.
    visit
        Which of all visits each one is.
    share
        Of its cell's samples.
    means
        Mean moment [N m] or angle [rad] of each cell.
    weight
        Root of each cell's information.
    """

    channel: int
    sensors: Sensors
    cells: Float[np.ndarray, "n c"]
    visits: Float[np.ndarray, "v c"]
    trial: Int[np.ndarray, " n"]
    of_visit: Int[np.ndarray, " v"]
    visit: Int[np.ndarray, " v"]
    share: Float[np.ndarray, " v"]
    means: Float[np.ndarray, " n"]
    weight: Float[np.ndarray, " n"]

    @property
    def name(self) -> str:
        """In words."""
        return "moment of the cuff" if self.channel == MOMENT else "angle of the arm"

    def model(
        self, theta: Float[np.ndarray, " 8"], means: Float[np.ndarray, "m c"], trial: Int[np.ndarray, " m"]
    ) -> tuple[Float[np.ndarray, " m"], Float[np.ndarray, "m q"]]:
        """Model of these means without nuisance, and by how much each nuisance adds; its columns are orthogonal."""
        _, _, _, tangent = _link(theta, means)
        gamma = np.arctan(tangent)
        if self.channel == ALPHA:
            return means[:, BETA] - gamma, self._zeros(trial)
        moment = -means[:, FORCE] * theta[4] * (1.0 + tangent**2)
        if self.sensors.turning is None:
            return moment, gamma[:, None]
        return moment + self.sensors.turning * gamma, np.zeros((len(gamma), 0))

    def _zeros(self, trial: Int[np.ndarray, " m"]) -> Float[np.ndarray, "m q"]:
        if self.sensors.zeroed:
            return np.zeros((len(trial), 0))
        return np.asarray(trial[:, None] == np.unique(self.trial), float)

    def nuisance(self, theta: Float[np.ndarray, " 8"]) -> Float[np.ndarray, " q"]:
        """Best κ [N m/rad], or zero of each trial's angle [rad]."""
        modelled, linear = self.model(theta, self.cells, self.trial)
        return self._best(modelled, linear)

    def nuisance_error(self, theta: Float[np.ndarray, " 8"]) -> Float[np.ndarray, " q"]:
        """Standard errors of the nuisance with the numbers of the law held."""
        _, linear = self.model(theta, self.cells, self.trial)
        return np.asarray(1.0 / np.linalg.norm(linear * self.weight[:, None], axis=0))

    def fitted(self, theta: Float[np.ndarray, " 8"]) -> Float[np.ndarray, " n"]:
        """Modelled mean of each cell, with the best nuisance."""
        modelled, linear = self.model(theta, self.cells, self.trial)
        return np.asarray(modelled + linear @ self._best(modelled, linear))

    def residual(self, theta: Float[np.ndarray, " 8"]) -> Float[np.ndarray, " n"]:
        """What the model is too large by, in standard deviations."""
        return np.asarray(self.weight * (self.fitted(theta) - self.means))

    def slopes(self, theta: Float[np.ndarray, " 8"], *, fixation: bool) -> Float[np.ndarray, "n 8"]:
        """Derivative of the residual with respect to each number of the law, its change by the nuisance's left out.

        That leaves the gradient of the sum of squares as it is (Kaufman 1975, BIT 15, 49).
        """
        modelled, linear = self.model(theta, self.cells, self.trial)
        nuisance = self._best(modelled, linear)
        out = self._by_lengths(theta, nuisance)
        if fixation or theta[7] != 0.0:
            out = self._by_difference(theta, nuisance)
        scaled, out = linear * self.weight[:, None], out * self.weight[:, None]
        size = np.einsum("nq,nq->q", scaled, scaled)
        return np.asarray(out - scaled @ ((scaled.T @ out) / np.where(size > 0.0, size, 1.0)[:, None]))

    def _by_lengths(
        self, theta: Float[np.ndarray, " 8"], nuisance: Float[np.ndarray, " q"]
    ) -> Float[np.ndarray, "n 8"]:
        """Derivatives of the model with a rigid fixation, in closed form."""
        s, c, bottom, tangent = _link(theta, self.cells)
        by_tangent = np.column_stack([c + tangent * s, s - tangent * c, -tangent]) / bottom[:, None]  # x, y, l
        turned = by_tangent / (1.0 + tangent**2)[:, None]
        out = np.zeros((len(self.means), len(theta)))
        if self.channel == ALPHA:
            out[:, 1:4] = -turned
            return out
        force, turning = self.cells[:, FORCE], self.sensors.turning
        out[:, 1:4] = -2.0 * theta[4] * (force * tangent)[:, None] * by_tangent
        out[:, 1:4] += (float(nuisance[0]) if turning is None else turning) * turned
        out[:, 4] = -force * (1.0 + tangent**2)
        return out

    def _by_difference(
        self, theta: Float[np.ndarray, " 8"], nuisance: Float[np.ndarray, " q"]
    ) -> Float[np.ndarray, "n 8"]:
        """Derivatives of the model where the fixation yields."""

        def with_nuisance(numbers: Float[np.ndarray, " 8"]) -> Float[np.ndarray, " n"]:
            modelled, linear = self.model(numbers, self.cells, self.trial)
            return np.asarray(modelled + linear @ nuisance)

        out = np.zeros((len(self.means), len(theta)))
        for k in range(len(theta)):
            h = STEP * (theta[3] if 0 < k < 5 else 1.0 / theta[0] if k == 7 else max(abs(theta[k]), STEP))
            above, below = theta.copy(), theta.copy()
            above[k], below[k] = theta[k] + h, theta[k] - h
            out[:, k] = (with_nuisance(above) - with_nuisance(below)) / (2.0 * h)
        return out

    def off_visits(self, theta: Float[np.ndarray, " 8"]) -> Float[np.ndarray, " v"]:
        """Measured less modelled mean of each visit, with the cells' best nuisance, times its share of the cell."""
        modelled, linear = self.model(theta, self.visits, self.trial[self.of_visit])
        off = self.visits[:, self.channel] - modelled - linear @ self.nuisance(theta)
        return np.asarray(self.share * off)

    def scores(self, theta: Float[np.ndarray, " 8"], slopes: Float[np.ndarray, "n p"]) -> Float[np.ndarray, "v p"]:
        """Gradient of half the sum of squares, visit by visit; `slopes` are those of the residual."""
        weighted = self.off_visits(theta) * self.weight[self.of_visit]
        return np.asarray(-weighted[:, None] * slopes[self.of_visit])

    def redrawn(self, theta: Float[np.ndarray, " 8"], factor: Float[np.ndarray, " all"]) -> BesideForce:
        """The fitted values with every visit's residual times its factor."""
        off = factor[self.visit] * self.off_visits(theta)
        return replace(self, means=self.fitted(theta) + np.bincount(self.of_visit, off, len(self.means)))

    def turned(self) -> BesideForce:
        """The same moment with its sign turned; an angle as it is."""
        if self.channel != MOMENT:
            return self
        return replace(self, means=-self.means)

    def _best(self, modelled: Float[np.ndarray, " n"], linear: Float[np.ndarray, "n q"]) -> Float[np.ndarray, " q"]:
        """Least squares for the nuisance, whose columns are orthogonal."""
        scaled, off = linear * self.weight[:, None], self.weight * (self.means - modelled)
        size = np.einsum("nq,nq->q", scaled, scaled)
        return np.asarray((scaled.T @ off) / np.where(size > 0.0, size, 1.0))


def _link(theta: Float[np.ndarray, " 8"], means: Float[np.ndarray, "m c"]) -> tuple[Float[np.ndarray, " m"], ...]:
    """Sine and cosine of the angle, bottom of tan γ [m] and tan γ, with the offsets under load."""
    law = ElbowLaw(*(np.ascontiguousarray(means[:, k]) for k in (BETA, RATE, PRESSURE)))
    x, y = law.offsets_under_load(theta)
    s, c = np.sin(law.beta), np.cos(law.beta)
    bottom = theta[3] + y * c - x * s
    bottom = np.where(np.abs(bottom) < NEAR_POLE, NEAR_POLE, bottom)
    return s, c, bottom, (x * c + y * s) / bottom


def beside_force(data: Binned, sensors: Sensors) -> tuple[BesideForce, ...]:
    """Moment and angle as far as they were recorded, in that order."""
    there = np.isfinite(data.cells.means).any(axis=0)
    return tuple(_beside(data, sensors, channel) for channel in (MOMENT, ALPHA) if there[channel])


def _beside(data: Binned, sensors: Sensors, channel: int) -> BesideForce:
    cells, visits = data.cells, data.visits
    kept = np.isfinite(cells.means[:, channel])
    place = np.cumsum(kept) - 1
    visit = np.flatnonzero(kept[cells.of_visit])
    of_visit = cells.of_visit[visit]
    return BesideForce(
        channel=channel,
        sensors=sensors,
        cells=cells.means[kept],
        visits=visits.means[visit],
        trial=cells.trial[kept],
        of_visit=place[of_visit],
        visit=visit,
        share=visits.count[visit] / cells.count[of_visit],
        means=cells.means[kept, channel],
        weight=np.sqrt(data.information_of(data.beside[channel]))[kept],
    )
