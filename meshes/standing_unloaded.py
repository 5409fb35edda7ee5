"""A synthetic recording of the exoskeleton that moves alone: angles of its hinges, and what its motors give.

Sums of two sines that no two hinges share, so that all that acts on the motors is told. Frictions are invented.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.standing_up.chain import Subject
from geocontact.standing_up.exoskeleton import EXO_JOINTS, two_chains
from geocontact.standing_up.exoskeleton_torque import regressor

SECONDS, RATE = 20.0, 50.0
"""[s], [Hz]."""
FREQUENCIES = np.array([[0.15, 0.23, 0.31], [0.47, 0.61, 0.37]])
"""[Hz], by hinge."""
SIZES = np.array([[0.25, 0.5, 0.4], [0.06, 0.10, 0.12]])
MIDDLE = np.array([-0.2, 0.8, -0.6])
"""[rad]."""
VISCOUS, COULOMB = (2.0, 3.0, 2.5), (1.5, 2.5, 2.0)
"""Of both legs [N m s/rad], [N m], invented."""
TURN_NOISE, MOTOR_NOISE = float(np.radians(0.01)), 0.3
"""Standard deviations of encoders [rad] and motors [N m], invented."""

Table = Float[np.ndarray, "t 3"]


def planted(subject: Subject) -> Float[np.ndarray, " p"]:
    """Dynamic parameters in the order of `exoskeleton_torque`."""
    bodies = {body.name: body for body in two_chains(subject).bodies}
    found: list[float] = []
    for joint in two_chains(subject).joints:
        if joint.name in EXO_JOINTS:
            b = bodies[joint.child]
            about = b.inertia[2, 2] + b.mass * float(b.centre @ b.centre)
            found += [b.mass, *(b.mass * b.centre[:2]).tolist(), float(about)]
    return np.asarray(np.r_[found, np.column_stack([VISCOUS, COULOMB]).ravel()])


def synthetic_unloaded(
    subject: Subject, seed: int = 36, turn_noise: float = TURN_NOISE
) -> tuple[Float[np.ndarray, " t"], Table, Table]:
    """Times [s], angles [rad] and torques of the motors [N m], with noise."""
    time = np.arange(round(SECONDS * RATE)) / RATE
    pace, size = 2.0 * np.pi * FREQUENCIES[:, None, :], SIZES[:, None, :]
    turn = pace * time[None, :, None]
    q = MIDDLE + (size * np.sin(turn)).sum(axis=0)
    u, a = (size * pace * np.cos(turn)).sum(axis=0), -(size * pace**2 * np.sin(turn)).sum(axis=0)
    motors = regressor(subject, q, u, a) @ planted(subject)
    rng = np.random.default_rng(seed)
    return time, q + turn_noise * rng.normal(size=q.shape), motors + MOTOR_NOISE * rng.normal(size=q.shape)
