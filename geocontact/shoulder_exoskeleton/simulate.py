"""Motion of one exoskeleton arm along a recorded human one: rest at the start, then steps within a tolerance."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float

from geocontact.dynamics.recorded_inputs import RecordedInputs, linear_inputs, recorded_inputs, stepped_inputs
from geocontact.shoulder_exoskeleton.arm_model import ArmModel, Told, arm_model, output_slices
from geocontact.shoulder_exoskeleton.arm_motion import ArmMotion
from geocontact.shoulder_exoskeleton.arm_numbers import adjusted_numbers, slices
from geocontact.shoulder_exoskeleton.cuff_contact import Cuff
from geocontact.shoulder_exoskeleton.device import JOINTS, Device, Wearer

TOLERANCE = 5e-7
"""Error allowed in a step [rad, rad/s, N], plus as much of each one's size: 0.01 degrees and 0.1 N over a trial."""
FIRST = 1e-4
"""s; first step that is tried."""
FARTHEST = 0.25
"""m; a sphere that rest leaves farther from the cuff's middle is not in it."""
MIRROR = np.array([-1.0, 1.0, 1.0])


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

    ArithmeticError where nothing rests in equilibrium at the start, or the motion cannot go on.
    """
    model, p = arm_model(device, machine_code=machine_code, cuff=cuff), adjusted_numbers(device, wearer, level)
    mirrored = mirrored_arm(motion)
    inputs = arm_inputs(mirrored, factor, cuff, pressed)
    start = at_rest(model, device, p, inputs(motion.time[0])[0])
    found = model.stepper.simulate(
        start, motion.time, inputs=inputs, parameters=p, tolerance=tolerance, first=FIRST, steps=steps
    )
    told = _told(model, found.q, found.u, found.z, inputs.at(motion.time), p)
    if motion.side == "left":
        told["force"] = told["force"] * MIRROR
        told["moment"] = -told["moment"] * MIRROR
        told["joints"] = told["joints"] * np.tile(MIRROR, 4)
    return ArmSimulation(
        motion, device, wearer, level, cuff, found.q, found.u, found.z[:, 0], told, found.steps, found.refused
    )


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
    found = (
        recorded_inputs(motion.time, motion.interface, derivatives=1)
        .beside(recorded_inputs(motion.time, motion.gravity_at_frames()))
        .beside(stepped_inputs(motion.time, held[:-1, None]))
    )
    if cuff == "point":
        force = np.zeros(len(motion.time)) if pressed is None else np.asarray(pressed, float)
        return found.beside(linear_inputs(motion.time, force[:, None]))
    if pressed is not None:
        raise ValueError("a surface has no force that presses the arm into it besides its motion")
    line = motion.interface - motion.shoulder
    line = line / np.linalg.norm(line, axis=1, keepdims=True)
    return found.beside(recorded_inputs(motion.time, line, derivatives=1))


State = tuple[Float[np.ndarray, " n"], Float[np.ndarray, " n"], Float[np.ndarray, " k"]]


def at_rest(model: ArmModel, device: Device, p: Float[np.ndarray, " p"], inputs: Float[np.ndarray, " w"]) -> State:
    """Static equilibrium around a sphere that is held: coordinates, rates 0, force of the cylinder.

    Of the equilibria that friction would hold it is the one without friction, next to passive joints in the middle.
    """
    held = inputs.copy()
    held[3:6] = 0.0
    held[13:16] = 0.0
    guess = _guess(p, held[:3])
    lower, upper = (np.array([device[f"{joint}_{end}"] for joint in JOINTS]) for end in ("lower", "upper"))
    try:
        q, z = model.equilibrium.find((guess, p[slices()["push"]] * held[9]), inputs=held, parameters=p, tolerance=1e-7)
    except ArithmeticError as error:
        wanted, low, high = np.degrees([guess[2], lower[2], upper[2]])
        if low <= wanted <= high:
            raise
        ends = f"{low:.0f} to {high:.0f} deg"
        raise ArithmeticError(
            f"at the start the arm is at {wanted:.0f} deg, beyond the stops of elevation ({ends})"
        ) from error
    beyond = np.maximum(q - upper, lower - q)
    if np.all(beyond > 0.0):
        raise ArithmeticError("at the start all joints are beyond their stops")
    off = np.linalg.norm(_told(model, q[None], np.zeros((1, 3)), z[None], held[None], p)["place"][0])
    if off > FARTHEST:
        raise ArithmeticError(f"at the start the arm is {1e3 * off:.0f} mm from the cuff's middle")
    return q, np.zeros(len(q)), z


def _guess(p: Float[np.ndarray, " p"], sphere: Float[np.ndarray, " 3"]) -> Float[np.ndarray, " 3"]:
    """Passive joints in the middle, and the arm link towards the sphere."""
    of = slices()
    offset = sphere - p[of["base"]] - p[of["link_1"]] - p[of["link_2"]]
    return np.array([0.0, 0.0, np.arctan2(-offset[1], -offset[2])])


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
