"""What the equations read of a recorded arm: its motion as that of a right arm, and inputs over time."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np
from jaxtyping import Float

from geocontact.dynamics.recorded_inputs import RecordedInputs, linear_inputs, recorded_inputs, stepped_inputs
from geocontact.shoulder_exoskeleton.arm_motion import ArmMotion
from geocontact.shoulder_exoskeleton.cuff_contact import Cuff

MIRROR = np.array([-1.0, 1.0, 1.0])


REMEMBERED = 64
"""Motions whose mirror image and splines are kept: one is simulated under many profiles."""


@lru_cache(REMEMBERED)
def mirrored_arm(motion: ArmMotion) -> ArmMotion:
    """A left arm as a right one, which the equations are those of; a right one as it is."""
    if motion.side == "right":
        return motion
    return replace(
        motion,
        side="right",
        interface=motion.interface * MIRROR,
        shoulder=motion.shoulder * MIRROR,
        gravity=motion.gravity * MIRROR,
    )


def arm_inputs(
    motion: ArmMotion,
    factor: Float[np.ndarray, " t"] | None = None,
    cuff: Cuff = "point",
    pressed: Float[np.ndarray, " t"] | None = None,
) -> RecordedInputs:
    """Place and velocity of the sphere, gravity and the support's factor over time.

    Then the force that presses on a point, or the arm's line for a surface.
    """
    held = np.ones(len(motion.time)) if factor is None else np.asarray(factor, float)
    found = _placed(motion).beside(stepped_inputs(motion.time, held[:-1, None]))
    if cuff == "point":
        force = np.zeros(len(motion.time)) if pressed is None else np.asarray(pressed, float)
        return found.beside(linear_inputs(motion.time, force[:, None]))
    if pressed is not None:
        raise ValueError("a surface has no force that presses the arm into it besides its motion")
    line = motion.interface - motion.shoulder
    line = line / np.linalg.norm(line, axis=1, keepdims=True)
    return found.beside(recorded_inputs(motion.time, line, derivatives=1))


@lru_cache(REMEMBERED)
def _placed(motion: ArmMotion) -> RecordedInputs:
    """Place and velocity of the sphere, and gravity."""
    place = recorded_inputs(motion.time, motion.interface, derivatives=1)
    return place.beside(recorded_inputs(motion.time, motion.gravity_at_frames()))
