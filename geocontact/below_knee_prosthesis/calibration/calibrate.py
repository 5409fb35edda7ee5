"""Fifteen numbers of a sole from recorded stances, with the keel without inertia along the recorded poses.

From each of several starts, spread over the bounds (Latin hypercube), a few turns of solving the keel and fitting
stiffness and damping at its depths (`linear_turn`); the best of them are finished over all numbers by damped
Gauss-Newton steps. What is made least is the sum of squares of force and centre of pressure, each in units of its
noise, and of the numbers' logarithms about the usual ones, in units of the prior's standard deviation.

Deviation from the study of the variable-stiffness foot, which fits the size of the force only, in newtons, without
priors: the direction of the force and the centre are recorded as well, and tell zones apart that the size does not.

Where depths, their rates and the directions of sliding are held, normal forces are linear in stiffness and damping; so
are, at held friction, the forces along the ground and the moment of the normal forces about the measured centre.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy.optimize import lsq_linear

from geocontact.below_knee_prosthesis.calibration.known_numbers import Knowledge, knowledge
from geocontact.below_knee_prosthesis.calibration.recorded_stance import RecordedStance
from geocontact.below_knee_prosthesis.calibration.sole_residuals import SoleResiduals
from geocontact.below_knee_prosthesis.keel.foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.keel.quasi_static import KeelMotion, QuasiStaticKeel
from geocontact.below_knee_prosthesis.leg import FootOffset
from geocontact.below_knee_prosthesis.simulate import share_of_foot
from geocontact.contact.sphere_foot import normal_force
from geocontact.identify.optimise.bounded_gauss_newton import least
from geocontact.identify.optimise.quasi_newton import spread_starts
from geocontact.loads.sphere_set import SoleLaw


def linear_rows(
    stance: RecordedStance, keel: QuasiStaticKeel, motion: KeelMotion, noise: Float[np.ndarray, "t c"]
) -> tuple[Float[np.ndarray, "rows k"], Float[np.ndarray, " rows"]]:
    """Matrix on stiffness and damping of the zones, and what it should give, both over the noise.

    The centre's rows are the moment about the measured centre over the measured force; they leave out frames without.
    """
    law: SoleLaw = keel.law
    zones = np.stack(list(keel.sole.spheres.zones.values()), axis=1).astype(float)
    depth, rate = motion.loads.depth, motion.rate
    parts: list[np.ndarray] = [np.asarray(normal_force(depth, rate, *each)) for each in _units(law)]
    pressing = motion.loads.pressing[..., None]
    per_pressing = np.divide(motion.loads.force, pressing, out=np.zeros_like(motion.loads.force), where=pressing > 0.0)
    along = np.stack(
        [share_of_foot(stance.poses, keel.keel.length, point) for point in motion.loads.point.swapaxes(0, 1)], axis=1
    )
    known = np.isfinite(stance.centre)
    arm = np.nan_to_num(along[known] - stance.centre[known, None]) / stance.force[known, 1, None]
    blocks = [
        np.hstack([(part * per_pressing[..., axis]) @ zones for part in parts]) / noise[:, axis, None]
        for axis in range(3)
    ]
    blocks.append(np.hstack([(part[known] * arm) @ zones for part in parts]) / noise[known, 3, None])
    target = [stance.force[:, axis] / noise[:, axis] for axis in range(3)]
    return np.vstack(blocks), np.concatenate([*target, np.zeros(int(known.sum()))])


def bounded_fit(
    matrix: Float[np.ndarray, "rows k"],
    target: Float[np.ndarray, " rows"],
    now: Float[np.ndarray, " k"],
    sd: Float[np.ndarray, " k"],
    usual: Float[np.ndarray, " k"],
    reach: Float[np.ndarray, " k"],
) -> Float[np.ndarray, " k"]:
    """Numbers within `usual` e^±reach that fit best, each held to its present value by `sd` of itself.

    What no row tells keeps its present value.
    """
    scaled = np.vstack([matrix * now, np.diag(1.0 / sd)])
    bounds = (usual * np.exp(-reach) / now, usual * np.exp(reach) / now)
    wanted = np.concatenate([target, 1.0 / sd])
    return np.asarray(now * lsq_linear(scaled, wanted, bounds).x)


def _units(law: SoleLaw) -> tuple[tuple[float, float, float, float], tuple[float, float, float, float]]:
    """Stiffness, exponent, damping and depth of a unit of stiffness, and of damping."""
    return (1.0, law.exponent, 0.0, law.full_depth), (0.0, law.exponent, 1.0, law.full_depth)


STARTS, TURNS, FINISHED = 8, 4, 2
"""Starts beside the usual numbers, linear turns of each, and how many are finished."""
ROUNDS, ENOUGH = 30, 1e-2
"""Evaluations of a search, and the cost that is not worth another."""
SHARES = (1.0, 0.7, 0.5, 0.35, 0.2)
"""Shares of the way from the usual numbers to a start along which the keel may find no balance."""
HELD = np.log(3.0)
"""Standard deviation of a number's step in a linear turn: depths are held only so far."""


@dataclass(frozen=True, eq=False)
class SoleCalibration:
    """What was found.

    Parameters
    ----------
    law
        The foot's law with the numbers.
    logarithms
        Of the numbers over the usual ones.
    at
        Everything that was sought: the logarithms, then height and pitch in standard deviations.
    cost
        Half the sum of squares, priors included.
    costs
        After the linear turns, of every start; the usual numbers' first.
    converged
        Whether the search of the best ended by itself.
    solved
        How often the keel was solved along a stance.
    """

    residuals: SoleResiduals
    law: SoleLaw
    logarithms: Float[np.ndarray, " p"]
    at: Float[np.ndarray, " q"]
    cost: float
    costs: tuple[float, ...]
    converged: bool
    knowledge: Knowledge

    @property
    def offsets(self) -> tuple[FootOffset, ...]:
        """Offsets of the foot beside each standing trial."""
        return self.knowledge.offsets

    @property
    def solved(self) -> int:
        """How often the keel was solved along a stance."""
        return self.residuals.solved

    @property
    def foot(self) -> VariableStiffnessFoot:
        """With the law that was found."""
        usual = self.residuals.foot
        return replace(usual, law=self.law)


def calibrate(
    stances: Sequence[RecordedStance],
    foot: VariableStiffnessFoot,
    *,
    starts: int = STARTS,
    finished: int = FINISHED,
    seed: int = 0,
    level: float = 0.95,
) -> SoleCalibration:
    """From one stance, or one of each setting; around the law of `foot`.

    ArithmeticError where the keel finds no equilibrium from any start.
    """
    residuals = SoleResiduals.of(stances, foot)
    zones = residuals.zones
    usual = zones.values_of(zones.usual)
    begun = []
    for start in spread_starts(zones.parameters(), starts, seed):
        z = np.zeros(len(residuals.sd))
        z[: len(usual)] = [np.log(start.get(name, of) / of) for name, of in zip(zones.names, usual, strict=True)]
        begun.append(turned(residuals, balancing(residuals, z)))
    if not np.isfinite([cost for _, cost in begun]).any():
        raise ArithmeticError("the keel has no equilibrium along the stance from any start")
    best = sorted(begun, key=lambda each: each[1])[:finished]
    reach = residuals.reach
    searches = [least(residuals, residuals.slope, z, -reach, reach, ROUNDS, ENOUGH) for z, _ in best]
    found = min(searches, key=lambda each: each.cost)
    return SoleCalibration(
        residuals,
        zones.law(residuals.values(found.x)),
        found.x[: len(usual)],
        found.x,
        found.cost,
        tuple(cost for _, cost in begun),
        found.finished,
        knowledge(residuals, found.x, level),
    )


def balancing(residuals: SoleResiduals, z: Float[np.ndarray, " p"]) -> Float[np.ndarray, " p"]:
    """The logarithms, or so much of them that the keel balances in every frame; none of them where it never does."""
    for share in SHARES:
        try:
            for place in range(len(residuals.stances)):
                residuals.motion(share * z, place)
        except ArithmeticError:
            continue
        return np.asarray(share * z)
    return 0.0 * z


def turned(
    residuals: SoleResiduals, z: Float[np.ndarray, " p"], turns: int = TURNS
) -> tuple[Float[np.ndarray, " p"], float]:
    """The best of the logarithms along some linear turns, and its cost; infinite where the keel never balances."""
    zones = residuals.zones
    k = 2 * len(zones.zones)
    usual = zones.values_of(zones.usual)[:k]
    best, lowest, now = z, np.inf, z
    for turn in range(turns + 1):
        off = residuals(now)
        cost = 0.5 * float(off @ off)
        if cost < lowest:
            best, lowest = now, cost
        if turn == turns:
            break
        try:
            rows = [
                linear_rows(stance, residuals.keel(now, stance), residuals.motion(now, place)[0], noise)
                for place, noise in enumerate(residuals.noise)
                for stance in [residuals.stance(now, place)]
            ]
        except ArithmeticError:
            return best, lowest
        matrix, target = (np.concatenate(each) for each in zip(*rows, strict=True))
        values = residuals.values(now)[:k]
        fitted = bounded_fit(matrix, target, values, np.full(k, HELD), usual, zones.reach[:k])
        now = np.concatenate([np.log(fitted / usual), now[k:]])
    return best, lowest
