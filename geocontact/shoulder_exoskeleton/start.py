"""Where an exoskeleton's arm is when a recording begins: rest around an arm that hangs, then raised to where it is.

With the human arm up there are several equilibria: the sphere may be inside the cuff, or a hand's breadth beyond its
end with the passive joints folded the other way. A wearer puts the device on with the arm hanging. So the start is
reached from there: equilibrium without friction at `HANGING`, then the arm is raised to its first posture in the
upright plane that it is in, friction acting, and held. What friction would remember of the way that was really taken
is not known.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from jaxtyping import Float

from geocontact.dynamics.recorded_inputs import RecordedInputs
from geocontact.shoulder_exoskeleton.arm_model import ArmModel
from geocontact.shoulder_exoskeleton.arm_motion import ArmMotion
from geocontact.shoulder_exoskeleton.arm_numbers import slices
from geocontact.shoulder_exoskeleton.cuff_contact import Cuff
from geocontact.shoulder_exoskeleton.device import JOINTS, Device
from geocontact.shoulder_exoskeleton.recorded_arm import arm_inputs

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
"""Of a right arm that points straight up: the plane of the shoulder blade, 30 degrees outwards of the front."""

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
    """Of the upper arm at the first frame from the frame's -z [rad]."""
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
