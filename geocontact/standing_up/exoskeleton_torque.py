"""What the exoskeleton's motors need to move it alone, and what is left of their torque for the person.

The exoskeleton moves by itself with its foot plate on the ground. What its motors give is linear in the dynamic
parameters: of each body mass m, first moments m c_x and m c_y, inertia about its joint, and of each hinge viscous and
Coulomb friction (Khalil & Dombre (2002), Modeling, identification and control of robots, ch. 12). Not all of them act
on the motors, and no motion tells the ones that do not; least squares with the shortest answer gives the right torques
all the same. Friction is identified by itself, for no mass does what it does.

In a trial the torque at a hinge is that of its motor less friction. That of the person is what inverse dynamics of
both, rigidly coupled, asks for less that of the exoskeleton.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Bool, Float
from scipy.special import ndtri

from geocontact.data.multibody.model import GROUND, Multibody
from geocontact.identify.signals.filters import zero_lag
from geocontact.standing_up.chain import Subject
from geocontact.standing_up.exoskeleton import EXO_JOINTS, two_chains
from geocontact.standing_up.worn_device import TURNS

if TYPE_CHECKING:
    from casadi import Function

FRICTIONS = ("viscous", "Coulomb")
UNITS = (*(("kg", "kg m", "kg m", "kg m^2") * 3), *(("N m s/rad", "N m") * 3))
"""Units of the parameters, in their order."""
OF_A_BODY = ("mass", "first moment along x", "first moment along y", "inertia")
UNTOLD = 1e-9
"""Singular value, of the largest, below which a motion tells nothing of a combination."""
ALONE = 1e-6
"""Part of a parameter's direction that may lie in what a motion tells nothing of."""

Table = Float[np.ndarray, "t 3"]
Rows = Float[np.ndarray, "_ ..."]


MARGIN = 1.0
"""Periods of the cut-off at either end that are not used: there the filter's own course is in the accelerations."""


@dataclass(frozen=True, eq=False)
class DeviceMotion:
    """Over time: angles, smoothed, their rates and accelerations, and the motors' torques as recorded."""

    time: Float[np.ndarray, " t"]
    q: Table
    u: Table
    a: Table
    motors: Table

    @staticmethod
    def smoothed(time: Float[np.ndarray, " t"], q: Table, motors: Table, cutoff: float) -> DeviceMotion:
        """The motion from angles as recorded; ValueError where they cannot be filtered."""
        step = float(np.ptp(time)) / (len(time) - 1)
        smooth = zero_lag(q, step, cutoff)
        u = np.gradient(smooth, step, axis=0)
        return DeviceMotion(time, smooth, u, np.gradient(u, step, axis=0), motors)

    @property
    def step(self) -> float:
        """Between two samples [s]."""
        return float(np.ptp(self.time)) / (len(self.time) - 1)

    def smooth(self, values: Float[np.ndarray, "t ..."], cutoff: float) -> Float[np.ndarray, "t ..."]:
        """Values at the times, without what lies above the cut-off [Hz]."""
        return zero_lag(values, self.step, cutoff)

    def independent(self, cutoff: float) -> float:
        """Part of the samples that is independent behind the filter.

        What passes a filter at fc is correlated: of white noise 2 fc dt of the variance is left, in as many independent
        samples, so that the variance of the unfiltered torque is that of the residual over 2 fc dt.
        """
        return min(2.0 * cutoff * self.step, 1.0)

    def inner(self, cutoff: float) -> Bool[np.ndarray, " t"]:
        """Where the ends do not show."""
        margin = MARGIN / cutoff
        return np.asarray((self.time >= self.time[0] + margin) & (self.time <= self.time[-1] - margin))


@dataclass(frozen=True, eq=False)
class ExoskeletonDynamics:
    """Dynamic parameters that an unloaded motion tells.

    Parameters
    ----------
    names, values, deviations
        In SI; standard deviations are those of what the motion tells, by the residual of the fit.
    alone
        Of each parameter, whether the motion identifies it by itself and not only in combinations.
    rank
        Combinations that are identified.
    residual
        Root mean square of what the fit leaves of the motors' torques [N m].
    """

    subject: Subject
    names: tuple[str, ...]
    values: Float[np.ndarray, " p"]
    deviations: Float[np.ndarray, " p"]
    alone: Bool[np.ndarray, " p"]
    rank: int
    residual: float

    def friction(self, u: Table) -> Table:
        """Friction of each hinge, against its rate [N m]."""
        at = len(self.names) - len(FRICTIONS) * len(EXO_JOINTS)
        viscous, coulomb = self.values[at:].reshape(len(EXO_JOINTS), len(FRICTIONS)).T
        return np.asarray(viscous * u + coulomb * _sign(u))

    def unloaded(self, q: Table, u: Table, a: Table) -> Table:
        """What the motors give where nothing but the exoskeleton moves [N m]."""
        return np.asarray(regressor(self.subject, q, u, a) @ self.values)

    def torque(self, motors: Table, u: Table) -> Table:
        """Torque of the exoskeleton at its hinges in a trial [N m]."""
        return np.asarray(motors - self.friction(u))

    def in_trial(self, motion: DeviceMotion, cutoff: float) -> Table:
        """The same of a motion whose motors go through a filter of this cut-off [Hz], as its angles did."""
        return self.torque(motion.smooth(motion.motors, cutoff), motion.u)

    def intervals(self, level: float) -> tuple[Float[np.ndarray, " p"], Float[np.ndarray, " p"]]:
        """Ends of the intervals of a probability, in SI; NaN of parameters that are not identified by themselves."""
        off = np.where(self.alone, float(ndtri(0.5 + 0.5 * level)) * self.deviations, np.nan)
        return self.values - off, self.values + off


def identified(
    subject: Subject,
    q: Table,
    u: Table,
    a: Table,
    motors: Table,
    *,
    through: Callable[[Rows], Rows] = np.asarray,
    independent: float = 1.0,
) -> ExoskeletonDynamics:
    """By linear least squares from an unloaded motion.

    Parameters
    ----------
    subject
        Says how long the exoskeleton's parts are.
    through
        What both sides of the equations go through over time, such as a low-pass filter: friction changes at once where
        a hinge turns back, and the filtered torque does not.
    independent
        Part of the samples that are independent then.
    """
    matrix = through(regressor(subject, q, u, a)).reshape(-1, len(parameter_names()))
    motors, size = through(motors), np.linalg.norm(matrix, axis=0)
    size = np.where(size > UNTOLD * size.max(), size, np.inf)  # what does not act on the motors is rounding there
    scaled = matrix / size
    left, sharp, right = np.linalg.svd(scaled, full_matrices=False)
    told = sharp > UNTOLD * sharp[0]
    back = right[told].T / sharp[told]
    values = back @ (left[:, told].T @ motors.ravel())
    off = motors.ravel() - scaled @ values
    variance = float(off @ off) / (len(off) - int(told.sum()))
    deviations = np.sqrt(variance / independent * np.sum(back**2, axis=1)) / size
    residual = float(np.sqrt(np.mean(off**2)))
    alone = np.sum(right[told] ** 2, axis=0) > 1.0 - ALONE
    rank = int(told.sum())
    return ExoskeletonDynamics(subject, parameter_names(), values / size, deviations, alone, rank, residual)


def identified_from(subject: Subject, motion: DeviceMotion, cutoff: float) -> ExoskeletonDynamics:
    """Parameters from a motion without a person, both sides of the equations through one filter, without the ends.

    Parameters
    ----------
    subject
        Says how long the exoskeleton's parts are.
    cutoff
        With which the motion was smoothed [Hz].
    """
    inner = motion.inner(cutoff)

    def through(values: Rows) -> Rows:
        return np.asarray(motion.smooth(values, cutoff)[inner])

    part = motion.independent(cutoff)
    return identified(subject, motion.q, motion.u, motion.a, motion.motors, through=through, independent=part)


def human_torque(together: Table, exoskeleton: Table) -> Table:
    """Torque of the person at ankle, knee and hip: inverse dynamics of both, rigidly coupled, less the exoskeleton's
    [N m].
    """
    return np.asarray(together - exoskeleton)


def regressor(subject: Subject, q: Table, u: Table, a: Table) -> Float[np.ndarray, "t 3 p"]:
    """Derivatives of the motors' torques by the parameters, in the order of `ExoskeletonDynamics.names`."""
    many = _of_bodies(subject).map(len(q))(q.T, u.T, a.T).full()
    bodies = many.reshape(len(EXO_JOINTS), len(q), -1).swapaxes(0, 1)
    friction = np.zeros((len(q), len(EXO_JOINTS), len(EXO_JOINTS), len(FRICTIONS)))
    for k in range(len(EXO_JOINTS)):
        friction[:, k, k] = np.stack([u[:, k], _sign(u[:, k])], axis=-1)
    return np.concatenate([bodies, friction.reshape(len(q), len(EXO_JOINTS), -1)], axis=2)


def _sign(u: Float[np.ndarray, ...]) -> Float[np.ndarray, ...]:
    return np.asarray(np.tanh(u / TURNS))


def parameter_names() -> tuple[str, ...]:
    """Names of all dynamic parameters, in their order."""
    bodies = [joint.child for joint in two_chains(Subject()).joints if joint.name in EXO_JOINTS]
    of_bodies = [f"{body} {what}" for body in bodies for what in OF_A_BODY]
    return (*of_bodies, *(f"{joint} {what} friction" for joint in EXO_JOINTS for what in FRICTIONS))


def device_alone(subject: Subject) -> Multibody:
    """The exoskeleton's bodies and hinges, its foot plate the ground."""
    chain = two_chains(subject)
    joints = tuple(
        replace(joint, parent=GROUND) if joint.parent == "foot" else joint
        for joint in chain.joints
        if joint.name in EXO_JOINTS
    )
    names = [joint.child for joint in joints]
    return replace(chain, bodies=tuple(body for body in chain.bodies if body.name in names), joints=joints)


@cache
def _of_bodies(subject: Subject) -> Function:
    """(q, u, a) of the exoskeleton's hinges to the derivatives of the torques by the bodies' parameters, (3, 12)."""
    from casadi import SX, Function, densify, jacobian, substitute, vertcat

    from geocontact.dynamics.inverse_dynamics import generalised_forces
    from geocontact.dynamics.tree import tree_of

    alone = device_alone(subject)
    names = [joint.child for joint in alone.joints]
    p = SX.sym("p", len(OF_A_BODY), len(names))
    masses = {name: p[0, k] for k, name in enumerate(names)}
    centres = {name: vertcat(p[1, k], p[2, k], 0.0) / p[0, k] for k, name in enumerate(names)}
    about = {name: p[3, k] - (p[1, k] ** 2 + p[2, k] ** 2) / p[0, k] for k, name in enumerate(names)}
    inertias = {name: about[name] * SX.eye(3) for name in names}
    tree = tree_of(alone, masses=masses, centres=centres, inertias=inertias)
    flat = p.reshape((p.numel(), 1))
    # linear in the parameters, so that the point at which it is differentiated does not matter
    by = substitute(jacobian(generalised_forces(tree), flat), flat, SX.ones(flat.shape))
    return Function("by", [tree.q, tree.u, tree.a], [densify(by)])
