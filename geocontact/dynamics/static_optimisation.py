"""Muscle forces of least squared activation that make given joint moments, with a contact force held where it is known.

In each frame by itself, activations a between 0.01 and 1 minimise

    sum a^2 + sum ((moments - arms' F a) / reserve)^2 + ((compression - held) / reserve)^2

F is the largest isometric force: no length, no speed, no tendon. Crowninshield and Brand, J Biomech 14 (1981) 793, with
the power of OpenSim's tool; reserves are its actuators of an optimal force of 1 N m. A contact that is held is one more
equation (DeMers, Pal and Delp, J Orthop Res 32 (2014) 769). The problem is convex: bounded linear least squares.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

RESERVE = 1.0
"""N m along a turn, N along a way and of a contact: what a reserve makes at the cost of a muscle at full activation."""

LEAST = 0.01
"""Activation below which no muscle is, as in OpenSim."""


@dataclass(frozen=True, eq=False)
class Contact:
    """Compression of one joint, along an axis of the body beyond it.

    Parameters
    ----------
    pulls
        Compression by a unit of tension of each muscle [-].
    net
        Compression without muscles [N]: load and weight beyond the joint.
    held
        Measured compression [N]; NaN in frames in which it is not known. None to let muscles make it.
    """

    pulls: Float[np.ndarray, "t m"]
    net: Float[np.ndarray, " t"]
    held: Float[np.ndarray, " t"] | None = None


@dataclass(frozen=True, eq=False)
class MuscleForces:
    """Activations and what they make.

    Parameters
    ----------
    activations
        `LEAST` to 1.
    missed
        Moments that reserves make, since muscles cannot [N m, N].
    compression
        Of the joint of `Contact` [N]; None without one.
    """

    activations: Float[np.ndarray, "t m"]
    missed: Float[np.ndarray, "t n"]
    compression: Float[np.ndarray, " t"] | None


def static_optimisation(
    strongest: Float[np.ndarray, " m"],
    arms: Float[np.ndarray, "t m n"],
    moments: Float[np.ndarray, "t n"],
    contact: Contact | None = None,
) -> MuscleForces:
    """Activations of least squares.

    Parameters
    ----------
    strongest
        Largest isometric forces [N].
    arms
        Moment arms about the coordinates [m].
    moments
        What muscles are to make along the coordinates [N m].
    """
    from scipy.optimize import lsq_linear

    frames, count = len(moments), len(strongest)
    found = np.empty((frames, count))
    for t in range(frames):
        rows, wanted = [arms[t].T * strongest / RESERVE], [moments[t] / RESERVE]
        if contact is not None and contact.held is not None and np.isfinite(contact.held[t]):
            rows.append((contact.pulls[t] * strongest / RESERVE)[None])
            wanted.append(np.array([(contact.held[t] - contact.net[t]) / RESERVE]))
        whole = np.vstack([*rows, np.eye(count)])
        aim = np.concatenate([*wanted, np.zeros(count)])
        solved = lsq_linear(whole, aim, (LEAST, 1.0), method="bvls", tol=1e-12, max_iter=20 * count)
        if not solved.success:
            raise ValueError(f"frame {t + 1}: {solved.message}")
        found[t] = solved.x
    tension = found * strongest
    missed = moments - np.einsum("tmn,tm->tn", arms, tension)
    compression = None if contact is None else contact.net + np.einsum("tm,tm->t", contact.pulls, tension)
    return MuscleForces(found, missed, compression)
