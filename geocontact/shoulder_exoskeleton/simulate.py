"""Motion of one exoskeleton arm along a recorded human one: the start from a hanging arm, then steps in a tolerance."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from geocontact.dynamics.simulate import SimulatedMotion
from geocontact.shoulder_exoskeleton.arm_model import ArmModel, Told, arm_model, output_slices
from geocontact.shoulder_exoskeleton.arm_motion import ArmMotion
from geocontact.shoulder_exoskeleton.arm_numbers import adjusted_numbers
from geocontact.shoulder_exoskeleton.cuff_contact import Cuff
from geocontact.shoulder_exoskeleton.device import JOINTS, Device, Wearer
from geocontact.shoulder_exoskeleton.in_cuff import MOST_LOST, require_in_cuff
from geocontact.shoulder_exoskeleton.recorded_arm import MIRROR, arm_inputs, mirrored_arm
from geocontact.shoulder_exoskeleton.start import FIRST, start_state

TOLERANCE = 5e-7
"""Error allowed in a step [rad, rad/s, N], plus as much of each one's size: 0.01 degrees and 0.1 N over a trial."""


@dataclass(frozen=True, eq=False)
class ArmSimulation:
    """What an exoskeleton's arm does.

    Parameters
    ----------
    motion
        Of the human arm, at the recorded frames.
    device, wearer, level
        Whose motion it is; share of the cylinder's force.
    cuff
        How the arm is held.
    angles, rates
        Of `JOINTS` [rad, rad/s]: elevation from hanging down; passive joints positive across the chest, for both sides.
    cylinder
        Force of the cylinder [N].
    recorded
        Inputs of the equations, which are those of a right arm (`recorded_arm.arm_inputs`).
    told
        Forces and places, see `arm_model.Told`; in the device's frame, the left arm's medial to the right.
    steps, refused
        Of the integration.
    """

    motion: ArmMotion
    device: Device
    wearer: Wearer
    level: float
    cuff: Cuff
    angles: Float[np.ndarray, "t 3"]
    rates: Float[np.ndarray, "t 3"]
    cylinder: Float[np.ndarray, " t"]
    recorded: Float[np.ndarray, "t w"]
    told: Told
    steps: int
    refused: int

    @property
    def elevation(self) -> Float[np.ndarray, " t"]:
        """Of the active joint [rad]."""
        return self.angles[:, JOINTS.index("elevation")]

    @property
    def supporting(self) -> Float[np.ndarray, " t"]:
        """Interface force that raises the human arm [N]: the paper's z-component."""
        return self.told["in_cuff"][:, 2]

    @property
    def shear(self) -> Float[np.ndarray, " t"]:
        """Size of the friction on the arm [N]."""
        return np.asarray(np.linalg.norm(self.told["friction"], axis=1))

    @property
    def slip(self) -> Float[np.ndarray, " t"]:
        """Distance that the arm has slid along the wall since the start [m]."""
        speed = np.linalg.norm(self.told["sliding"], axis=1)
        steps = 0.5 * (speed[1:] + speed[:-1]) * np.diff(self.motion.time)
        return np.concatenate([[0.0], np.cumsum(steps)])

    @property
    def out_of_cuff(self) -> Bool[np.ndarray, " t"]:
        """Where the sphere's centre is beyond an end of the cuff."""
        return np.asarray(np.abs(self.told["place"][:, 0]) > 0.5 * self.device["cuff_length"])

    @property
    def at_stop(self) -> Bool[np.ndarray, "t 3"]:
        """Which joints are in a stop."""
        return np.asarray(self.told["stops"] != 0.0)


def simulate_arm(
    motion: ArmMotion,
    device: Device,
    wearer: Wearer,
    level: float,
    *,
    factor: Float[np.ndarray, " t"] | None = None,
    pressed: Float[np.ndarray, " t"] | None = None,
    tolerance: float = TOLERANCE,
    steps: int | None = None,
    machine_code: bool = True,
    cuff: Cuff = "point",
    most_lost: float = MOST_LOST,
) -> ArmSimulation:
    """Motion of the exoskeleton's arm, at the recorded times.

    Parameters
    ----------
    motion
        Filtered and without gaps. ValueError where samples are missing.
    level
        Share of the cylinder's force, 0 to 1.
    factor
        Of that share at each frame (0 to 1), held until the next one; 1 unless given. The cylinder follows with its
        lag.
    pressed
        Force that presses the human arm into a point's cuff besides its motion, at each frame [N]: what a push on the
        tool leaves there; linear between frames, none unless given. ValueError with a surface.
    tolerance, steps
        As those of `Stepper.simulate`.
    cuff
        How the arm is held: at a point, as in the paper, or by the surface of a padded cuff.
    most_lost
        Share of the time for which the sphere may be far out of the cuff (`in_cuff`).

    ArithmeticError where nothing rests in equilibrium at the start, or the motion cannot go on; `OutOfCuffError`, which
    is one, where it is for longer.
    """
    moved = move_arm(
        motion,
        device,
        wearer,
        level,
        factor=factor,
        pressed=pressed,
        tolerance=tolerance,
        steps=steps,
        machine_code=machine_code,
        cuff=cuff,
    )
    return moved.simulation(most_lost)


@dataclass(frozen=True, eq=False)
class MovedArm:
    """Motion of an exoskeleton's arm before forces and places are worked out.

    Parameters
    ----------
    motion, device, wearer, level, cuff
        As those of `ArmSimulation`.
    model, numbers
        The equations and their parameters.
    recorded
        Inputs of the equations at the recorded frames.
    found
        States over time.
    """

    motion: ArmMotion
    device: Device
    wearer: Wearer
    level: float
    cuff: Cuff
    model: ArmModel
    numbers: Float[np.ndarray, " p"]
    recorded: Float[np.ndarray, "t w"]
    found: SimulatedMotion

    @property
    def elevation(self) -> Float[np.ndarray, " t"]:
        """Of the active joint [rad]."""
        return self.found.q[:, JOINTS.index("elevation")]

    def simulation(self, most_lost: float = MOST_LOST) -> ArmSimulation:
        """The arm with its forces; `OutOfCuffError` as of `simulate_arm`."""
        found, motion = self.found, self.motion
        told = _told(self.model, found.q, found.u, found.z, self.recorded, self.numbers)
        if motion.side == "left":
            told["force"] = told["force"] * MIRROR
            told["moment"] = -told["moment"] * MIRROR
            told["joints"] = told["joints"] * np.tile(MIRROR, 4)
        arm = ArmSimulation(
            motion,
            self.device,
            self.wearer,
            self.level,
            self.cuff,
            found.q,
            found.u,
            found.z[:, 0],
            self.recorded,
            told,
            found.steps,
            found.refused,
        )
        require_held(arm, most_lost)
        return arm


def require_held(arm: ArmSimulation, most_lost: float = MOST_LOST) -> None:
    """`OutOfCuffError` where the sphere is far out of the cuff for more than this share of the time."""
    hinge = arm.told["joints"].reshape(-1, 4, 3)[:, JOINTS.index("elevation")]
    require_in_cuff(arm.motion, arm.device, arm.wearer, arm.told["place"][:, 0], hinge, most_lost)


def move_arm(
    motion: ArmMotion,
    device: Device,
    wearer: Wearer,
    level: float,
    *,
    factor: Float[np.ndarray, " t"] | None = None,
    pressed: Float[np.ndarray, " t"] | None = None,
    tolerance: float = TOLERANCE,
    steps: int | None = None,
    machine_code: bool = True,
    cuff: Cuff = "point",
) -> MovedArm:
    """Motion alone, of which a controller asks many times; parameters and errors as of `simulate_arm`."""
    model, p = arm_model(device, machine_code=machine_code, cuff=cuff), adjusted_numbers(device, wearer, level)
    mirrored = mirrored_arm(motion)
    inputs = arm_inputs(mirrored, factor, cuff, pressed)
    start = start_state(model, device, p, mirrored, inputs, cuff=cuff, tolerance=tolerance)
    found = model.stepper.simulate(
        start, motion.time, inputs=inputs, parameters=p, tolerance=tolerance, first=FIRST, steps=steps
    )
    return MovedArm(motion, device, wearer, level, cuff, model, p, inputs.at(motion.time), found)


def _told(
    model: ArmModel,
    q: Float[np.ndarray, "t n"],
    u: Float[np.ndarray, "t n"],
    z: Float[np.ndarray, "t k"],
    w: Float[np.ndarray, "t w"],
    p: Float[np.ndarray, " p"],
) -> Told:
    found = np.array(model.outputs.map(len(q))(q.T, u.T, z.T, w.T, np.repeat(p[:, None], len(q), axis=1))).T
    return {name: found[:, place] for name, place in output_slices().items()}
