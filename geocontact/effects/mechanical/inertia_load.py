"""A mass that the model does not know, times its acceleration.

Elbow, "tip": force += m l β'', the mass at the end of the forearm link moving across it, of either sign (the sensor's
sense is not stated); "attachment": force += m d_tot'', the cuff's own mass moving with the deflection, m >= 0. Foot:
force_x += m x_c'', force_y += m y_c'' for a mass m >= 0 in the foot at the distance c ahead of the heel (the shape);
the centre of pressure is left alone. Shoulder, "exo": the exoskeleton's arm is harder to turn by an inertia I >= 0;
"cuff": force += m L_h a'', a mass between sensor and limb, of either sign. A joint of one angle: moment += I angle''
for an inertia I >= 0; of one length: force += m x''. Accelerations are those of the fit that differentiates the inputs.
"""

from __future__ import annotations

import numpy as np

from geocontact.chain.candidate import Candidate
from geocontact.chain.differentiated_inputs import DifferentiatedInputs
from geocontact.chain.effect import Effect
from geocontact.chain.links import Channels, Modifier, Values
from geocontact.chain.system import System
from geocontact.data.parameter import Parameter
from geocontact.effects.parts import load_channels, with_balance, with_geometry

RANK = 20.0
HEAVY = 10.0
"""Largest plausible mass [kg] or moment of inertia [kg m^2] that somebody left out."""
INERTIA = {("N", "m"): "kg", ("N m", "rad"): "kg m^2"}
"""Unit of a load over that of the acceleration of an input."""


def at_the_tip(system: System) -> Candidate:
    """Elbow: mass times tangential acceleration of the link's end."""
    mass = Parameter("inertia_load.tip.mass", "kg", 0.2, -HEAVY, HEAVY)
    row = system.inputs.index("beta")

    def change(outputs: Channels, movement: DifferentiatedInputs, values: Values) -> Channels:
        return np.asarray(outputs + values[mass.name] * values["l"] * movement.acceleration[row][:, None])

    link = with_balance(Modifier("inertia_load.tip", RANK, change))
    return Candidate("inertia_load", "tip", "load", (mass,), link, {mass.name: 0.0}, ({mass.name: -0.2},))


def at_the_attachment(system: System) -> Candidate:
    """Elbow: mass times second derivative of the deflection, as the geometry without further effects has it."""
    mass = Parameter("inertia_load.attachment.mass", "kg", 0.2, 0.0, HEAVY)

    def change(outputs: Channels, movement: DifferentiatedInputs, values: Values) -> Channels:
        _, rate = system.geometry.deflection(movement, values)
        return np.asarray(outputs + values[mass.name] * np.gradient(rate[:, 0], movement.time)[:, None])

    link = with_balance(Modifier("inertia_load.attachment", RANK, change))
    return Candidate("inertia_load", "attachment", "load", (mass,), link, {mass.name: 0.0})


def in_the_foot(system: System) -> Candidate:
    """Foot: mass at a distance from the heel, both components."""
    mass = Parameter("inertia_load.mass", "kg", 1.0, 0.0, 2.0 * HEAVY)
    ahead = Parameter("inertia_load.ahead", "m", 0.05, 0.0, 0.3)
    x, y, pitch = (system.inputs.index(name) for name in ("x", "y", "pitch"))

    def change(outputs: Channels, movement: DifferentiatedInputs, values: Values) -> Channels:
        s, c = np.sin(movement.position[pitch]), np.cos(movement.position[pitch])
        turn, spin = movement.acceleration[pitch], movement.rate[pitch] ** 2
        m, arm = values[mass.name], values[ahead.name]
        out = outputs.copy()
        out[:, 0] += m * (movement.acceleration[x] - arm * (turn * s + spin * c))
        out[:, 1] += m * (movement.acceleration[y] + arm * (turn * c - spin * s))
        return out

    link = with_balance(Modifier("inertia_load", RANK, change))
    return Candidate("inertia_load", "", "load", (mass, ahead), link, {mass.name: 0.0}, ({ahead.name: 0.15},))


def of_the_input(system: System) -> tuple[Candidate, ...]:
    """Any system with one load and an input that it resists: mass times the second derivative of that input."""
    moved, loads = system.geometry.yields, load_channels(system)
    unit = INERTIA.get((system.unit(loads[0]), system.unit(moved))) if len(loads) == 1 else None
    if unit is None:
        return ()
    mass = Parameter("inertia_load.mass", unit, 0.2, 0.0, HEAVY)
    row, hit = system.inputs.index(moved), np.array([name in loads for name in system.outputs])

    def change(outputs: Channels, movement: DifferentiatedInputs, values: Values) -> Channels:
        return np.asarray(outputs + values[mass.name] * movement.acceleration[row][:, None] * hit)

    link = with_balance(Modifier("inertia_load", RANK, change))
    return (Candidate("inertia_load", "", "load", (mass,), link, {mass.name: 0.0}),)


def of_the_arm_that_is_moved(system: System) -> Candidate:
    """Shoulder: moment of inertia of the exoskeleton's arm beyond the known one."""
    known = {**system.known, **system.start}["I"]
    inertia = Parameter("inertia_load.exo.inertia", "kg m^2", 0.1 * known, 0.0, HEAVY * known)
    link = with_geometry({"inertia_load.inertia": inertia.name})
    return Candidate("inertia_load", "exo", "load", (inertia,), link, {inertia.name: 0.0})


def at_the_cuff(system: System) -> Candidate:
    """Shoulder: mass times acceleration of the arm where the interface is."""
    mass = Parameter("inertia_load.cuff.mass", "kg", 0.2, -HEAVY, HEAVY)
    row, column = system.inputs.index("arm"), system.outputs.index("force")

    def change(outputs: Channels, movement: DifferentiatedInputs, values: Values) -> Channels:
        out = outputs.copy()
        out[:, column] += values[mass.name] * values["L_h"] * movement.acceleration[row]
        return out

    link = with_balance(Modifier("inertia_load.cuff", RANK, change))
    return Candidate("inertia_load", "cuff", "load", (mass,), link, {mass.name: 0.0}, ({mass.name: -0.2},))


def offer(system: System) -> tuple[Candidate, ...]:
    """Two candidates for the elbow and the shoulder, one for others."""
    if system.name == "elbow":
        return at_the_tip(system), at_the_attachment(system)
    if system.name == "shoulder":
        return of_the_arm_that_is_moved(system), at_the_cuff(system)
    return (in_the_foot(system),) if system.name == "foot" else of_the_input(system)


INERTIA_LOAD = Effect("inertia_load", "load", ("elbow", "foot", "shoulder"), offer, "Newton's second law")
