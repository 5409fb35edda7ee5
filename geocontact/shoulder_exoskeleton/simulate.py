"""Motion of one exoskeleton arm along a recorded human one: the start from a hanging arm, then steps in a tolerance.

With the human arm up there are several equilibria: the sphere may be inside the cuff, or a hand's breadth beyond its
end with the passive joints folded the other way. A wearer puts the device on with the arm hanging. So the start is
reached from there: equilibrium without friction at `HANGING`, then the arm is raised to its first posture in the
upright plane that it is in, friction acting, and held. What friction would remember of the way that was really taken
is not known.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float

from geocontact.dynamics.recorded_inputs import RecordedInputs
from geocontact.dynamics.simulate import SimulatedMotion
from geocontact.shoulder_exoskeleton.arm_model import ArmModel, Outputs, arm_model, output_slices
from geocontact.shoulder_exoskeleton.arm_motion import ArmMotion
from geocontact.shoulder_exoskeleton.arm_numbers import adjusted_numbers, slices
from geocontact.shoulder_exoskeleton.cuff_contact import (
    MIRROR,
    MOST_LOST,
    Cuff,
    arm_inputs,
    mirrored_arm,
    require_in_cuff,
)
from geocontact.shoulder_exoskeleton.device import JOINTS, Device, Wearer

HANGING = np.radians(10.0)
"""Up to this elevation an arm hangs; one that is raised farther is first raised from here."""
PACE = 1.0
"""rad/s; most of raising it."""
HELD = 0.5
"""s; then the arm is held at its first posture."""
STEP = 0.01
"""s; between the places of the sphere on this way."""
FIRST = 1e-4
"""s; first step that is tried."""
SIDEWAYS = 1e-6
"""Least horizontal part of an arm's length that tells the plane in which it is raised."""
OUTWARDS = np.array([-0.5, -np.sqrt(0.75), 0.0])
"""Direction of a right arm that points straight up: the plane of the shoulder blade, 30 degrees outwards of the
front."""

State = tuple[Float[np.ndarray, " n"], Float[np.ndarray, " n"], Float[np.ndarray, " k"]]


def start_state(
    model: ArmModel,
    device: Device,
    p: Float[np.ndarray, " p"],
    motion: ArmMotion,
    inputs: RecordedInputs,
    *,
    cuff: Cuff,
    tolerance: float,
) -> State:
    """Coordinates, rates and force of the cylinder at the first frame of a right arm.

    Parameters
    ----------
    inputs
        Of the motion (`arm_inputs`): the support's factor and what presses the arm into the cuff are those of the first
        frame all the way.
    tolerance
        As that of `Stepper.simulate`.

    ArithmeticError where nothing rests in equilibrium around the hanging arm, or it cannot be raised.
    """
    first = inputs(motion.time[0])[0]
    way = raising(motion, lowest=max(HANGING, device["elevation_lower"]))
    if way is None:
        return at_rest(model, device, p, first)
    same = np.ones(len(way.time))
    led = arm_inputs(way, first[9] * same, cuff, first[10] * same if cuff == "point" else None)
    rest = at_rest(model, device, p, led(0.0)[0])
    try:
        found = model.stepper.simulate(rest, way.time, inputs=led, parameters=p, tolerance=tolerance, first=FIRST)
    except ArithmeticError as error:
        up = np.degrees(elevation_of(motion))
        raise ArithmeticError(f"raised from hanging to its first {up:.0f} deg the arm is lost: {error}") from error
    return found.q[-1], found.u[-1], found.z[-1]


def elevation_of(motion: ArmMotion) -> float:
    """Elevation of the upper arm at the first frame from the frame's -z [rad]."""
    x, y, z = motion.interface[0] - motion.shoulder[0]
    return float(np.arctan2(np.hypot(x, y), -z))


def raising(motion: ArmMotion, lowest: float = HANGING) -> ArmMotion | None:
    """The way of a right arm from hanging to its first posture about the shoulder that it has there, then held.

    None where the arm is not raised farther than `lowest` [rad]. Smooth to the second derivative; gravity is that of
    the first frame.
    """
    end = elevation_of(motion)
    if end <= lowest:
        return None
    shoulder, reach = motion.shoulder[0], motion.interface[0] - motion.shoulder[0]
    length, sideways = float(np.linalg.norm(reach)), float(np.hypot(reach[0], reach[1]))
    across = reach * [1.0, 1.0, 0.0] / sideways if sideways > SIDEWAYS * length else OUTWARDS
    lasts = 15.0 / 8.0 * (end - lowest) / PACE
    time = np.arange(int(np.ceil((lasts + HELD) / STEP)) + 1) * STEP
    x = np.clip(time / lasts, 0.0, 1.0)
    angle = lowest + (end - lowest) * x**3 * (10.0 - 15.0 * x + 6.0 * x**2)
    along = np.sin(angle)[:, None] * across - np.cos(angle)[:, None] * np.array([0.0, 0.0, 1.0])
    return replace(
        motion,
        time=time,
        interface=shoulder + length * along,
        shoulder=np.tile(shoulder, (len(time), 1)),
        elevation=angle,
        gravity=motion.gravity_at_frames()[0],
    )


def at_rest(model: ArmModel, device: Device, p: Float[np.ndarray, " p"], inputs: Float[np.ndarray, " w"]) -> State:
    """Static equilibrium around a sphere that is held: coordinates, rates 0, force of the cylinder.

    Of the equilibria that friction would hold it is the one without friction, next to passive joints in the middle. Of
    a raised arm that may be one with the sphere out of the cuff: see `start_state`.
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
    return q, np.zeros(len(q)), z


def _guess(p: Float[np.ndarray, " p"], sphere: Float[np.ndarray, " 3"]) -> Float[np.ndarray, " 3"]:
    """Passive joints in the middle, and the arm link towards the sphere."""
    of = slices()
    offset = sphere - p[of["base"]] - p[of["link_1"]] - p[of["link_2"]]
    return np.array([0.0, 0.0, np.arctan2(-offset[1], -offset[2])])


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
    outputs
        Forces and places, see `arm_model.Outputs`; in the device's frame, the left arm's medial to the right.
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
    outputs: Outputs
    steps: int
    refused: int

    @property
    def elevation(self) -> Float[np.ndarray, " t"]:
        """Elevation of the active joint [rad]."""
        return self.angles[:, JOINTS.index("elevation")]

    @property
    def supporting(self) -> Float[np.ndarray, " t"]:
        """Interface force that raises the human arm [N]: the paper's z-component."""
        return self.outputs["in_cuff"][:, 2]

    @property
    def shear(self) -> Float[np.ndarray, " t"]:
        """Size of the friction on the arm [N]."""
        return np.asarray(np.linalg.norm(self.outputs["friction"], axis=1))

    @property
    def shear_around(self) -> Float[np.ndarray, " t"]:
        """Friction on the arm around the cuff, positive from medial towards raising [N]; 0 on its axis, where around
        has no direction.
        """
        radial, friction = self.outputs["place"][:, 1:], self.outputs["friction"][:, 1:]
        size = np.hypot(*radial.T)
        turned = radial[:, 0] * friction[:, 1] - radial[:, 1] * friction[:, 0]
        return np.asarray(np.divide(turned, size, out=np.zeros_like(size), where=size > 0.0))

    @property
    def slip(self) -> Float[np.ndarray, " t"]:
        """Distance that the arm has slid along the wall since the start [m]."""
        speed = np.linalg.norm(self.outputs["sliding"], axis=1)
        steps = 0.5 * (speed[1:] + speed[:-1]) * np.diff(self.motion.time)
        return np.concatenate([[0.0], np.cumsum(steps)])

    @property
    def out_of_cuff(self) -> Bool[np.ndarray, " t"]:
        """Where the sphere's centre is beyond an end of the cuff."""
        return np.asarray(np.abs(self.outputs["place"][:, 0]) > 0.5 * self.device["cuff_length"])

    @property
    def at_stop(self) -> Bool[np.ndarray, "t 3"]:
        """Which joints are in a stop."""
        return np.asarray(self.outputs["stops"] != 0.0)


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
        Of that share at each frame (0 to 1), held until the next one; 1 by default. The cylinder follows with its
        lag.
    pressed
        Force that presses the human arm into a point's cuff besides its motion, at each frame [N]: what a push on the
        tool leaves there; linear between frames, none by default. ValueError with a surface.
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
        """Elevation of the active joint [rad]."""
        return self.found.q[:, JOINTS.index("elevation")]

    def simulation(self, most_lost: float = MOST_LOST) -> ArmSimulation:
        """The arm with its forces; `OutOfCuffError` as of `simulate_arm`."""
        found, motion = self.found, self.motion
        outputs = _simulated(self.model, found.q, found.u, found.z, self.recorded, self.numbers)
        if motion.side == "left":
            outputs["force"] = outputs["force"] * MIRROR
            outputs["moment"] = -outputs["moment"] * MIRROR
            outputs["joints"] = outputs["joints"] * np.tile(MIRROR, 4)
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
            outputs,
            found.steps,
            found.refused,
        )
        require_held(arm, most_lost)
        return arm


def require_held(arm: ArmSimulation, most_lost: float = MOST_LOST) -> None:
    """`OutOfCuffError` where the sphere is far out of the cuff for more than this share of the time."""
    hinge = arm.outputs["joints"].reshape(-1, 4, 3)[:, JOINTS.index("elevation")]
    require_in_cuff(arm.motion, arm.device, arm.wearer, arm.outputs["place"][:, 0], hinge, most_lost)


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


def _simulated(
    model: ArmModel,
    q: Float[np.ndarray, "t n"],
    u: Float[np.ndarray, "t n"],
    z: Float[np.ndarray, "t k"],
    w: Float[np.ndarray, "t w"],
    p: Float[np.ndarray, " p"],
) -> Outputs:
    found = np.array(model.outputs.map(len(q))(q.T, u.T, z.T, w.T, np.repeat(p[:, None], len(q), axis=1))).T
    return {name: found[:, place] for name, place in output_slices().items()}
