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
HEAVY = 0.2
"""Of the largest load, that a mass which somebody left out makes at the most in a typical acceleration."""
KNOWN = 10.0
"""Times the known moment of inertia that somebody may have left out."""
FIRST = 0.02
"""Of the largest mass, from which a search sets out."""
INERTIA = {("N", "m"): "kg", ("N m", "rad"): "kg m^2"}
"""Unit of a load over that of the acceleration of an input."""


def heaviest(system: System, name: str, load: str, arm: float = 1.0) -> float:
    """Largest plausible mass; accelerations of an input are typically the square of its rate over its half-range."""
    scale = system.scale
    return HEAVY * scale.of(load) * scale.span.get(name, 1.0) / (abs(arm) * scale.speed.get(name, 1.0) ** 2)


def at_the_tip(system: System) -> Candidate:
    """Elbow: mass times tangential acceleration of the link's end."""
    most = heaviest(system, "beta", "force", {**system.known, **system.start}["l"])
    mass = Parameter("inertia_load.tip.mass", "kg", FIRST * most, -most, most)
    row = system.inputs.index("beta")

    def change(outputs: Channels, movement: DifferentiatedInputs, values: Values) -> Channels:
        return np.asarray(outputs + values[mass.name] * values["l"] * movement.acceleration[row][:, None])

    link = with_balance(Modifier("inertia_load.tip", RANK, change))
    return Candidate("inertia_load", "tip", "load", (mass,), link, {mass.name: 0.0}, ({mass.name: -mass.start},))


def at_the_attachment(system: System) -> Candidate:
    """Elbow: mass times second derivative of the deflection, as the geometry without further effects has it."""
    most = HEAVY * system.scale.of("force") * system.scale.deflection / system.scale.rate**2
    mass = Parameter("inertia_load.attachment.mass", "kg", FIRST * most, 0.0, most)

    def change(outputs: Channels, movement: DifferentiatedInputs, values: Values) -> Channels:
        _, rate = system.geometry.deflection(movement, values)
        return np.asarray(outputs + values[mass.name] * np.gradient(rate[:, 0], movement.time)[:, None])

    link = with_balance(Modifier("inertia_load.attachment", RANK, change))
    return Candidate("inertia_load", "attachment", "load", (mass,), link, {mass.name: 0.0})


def in_the_foot(system: System) -> Candidate:
    """Foot: mass at a distance from the heel, both components."""
    most, long = heaviest(system, "y", "force_y"), system.length
    mass = Parameter("inertia_load.mass", "kg", 2.0 * FIRST * most, 0.0, most)
    ahead = Parameter("inertia_load.ahead", "m", 0.2 * long, 0.0, 1.2 * long)
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
    return Candidate("inertia_load", "", "load", (mass, ahead), link, {mass.name: 0.0}, ({ahead.name: 0.6 * long},))


def of_the_input(system: System) -> tuple[Candidate, ...]:
    """Any system with one load and an input that it resists: mass times the second derivative of that input."""
    moved, loads = system.geometry.yields, load_channels(system)
    unit = INERTIA.get((system.unit(loads[0]), system.unit(moved))) if len(loads) == 1 else None
    if unit is None:
        return ()
    most = heaviest(system, moved, loads[0])
    mass = Parameter("inertia_load.mass", unit, FIRST * most, 0.0, most)
    row, hit = system.inputs.index(moved), np.array([name in loads for name in system.outputs])

    def change(outputs: Channels, movement: DifferentiatedInputs, values: Values) -> Channels:
        return np.asarray(outputs + values[mass.name] * movement.acceleration[row][:, None] * hit)

    link = with_balance(Modifier("inertia_load", RANK, change))
    return (Candidate("inertia_load", "", "load", (mass,), link, {mass.name: 0.0}),)


def of_the_arm_that_is_moved(system: System) -> Candidate:
    """Shoulder: moment of inertia of the exoskeleton's arm beyond the known one."""
    known = {**system.known, **system.start}["I"]
    inertia = Parameter("inertia_load.exo.inertia", "kg m^2", 0.1 * known, 0.0, KNOWN * known)
    link = with_geometry({"inertia_load.inertia": inertia.name})
    return Candidate("inertia_load", "exo", "load", (inertia,), link, {inertia.name: 0.0})


def at_the_cuff(system: System) -> Candidate:
    """Shoulder: mass times acceleration of the arm where the interface is."""
    most = heaviest(system, "arm", "force", {**system.known, **system.start}["L_h"])
    mass = Parameter("inertia_load.cuff.mass", "kg", FIRST * most, -most, most)
    row, column = system.inputs.index("arm"), system.outputs.index("force")

    def change(outputs: Channels, movement: DifferentiatedInputs, values: Values) -> Channels:
        out = outputs.copy()
        out[:, column] += values[mass.name] * values["L_h"] * movement.acceleration[row]
        return out

    link = with_balance(Modifier("inertia_load.cuff", RANK, change))
    return Candidate("inertia_load", "cuff", "load", (mass,), link, {mass.name: 0.0}, ({mass.name: -mass.start},))


def offer(system: System) -> tuple[Candidate, ...]:
    """Two candidates for the elbow and the shoulder, one for others."""
    if system.name == "elbow":
        return at_the_tip(system), at_the_attachment(system)
    if system.name == "shoulder":
        return of_the_arm_that_is_moved(system), at_the_cuff(system)
    return (in_the_foot(system),) if system.name == "foot" else of_the_input(system)


INERTIA_LOAD = Effect("inertia_load", "load", ("elbow", "foot", "shoulder"), offer, "Newton's second law")
