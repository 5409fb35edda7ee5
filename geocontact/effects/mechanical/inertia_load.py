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

from geocontact.chain.differentiated_inputs import DifferentiatedInputs
from geocontact.chain.effect import Candidate, Effect
from geocontact.chain.links import Channels, Modifier, Values
from geocontact.chain.system import System
from geocontact.chain.traits import Mass
from geocontact.data.parameter import Parameter
from geocontact.effects.parts import load_channels, with_balance, with_geometry

RANK = 20.0
HEAVY = 0.2
"""Share of the largest load, that a mass which somebody left out makes at the most in a typical acceleration."""
KNOWN = 10.0
"""Times the known moment of inertia that somebody may have left out."""
FIRST = 0.02
"""Share of the largest mass, from which a search sets out."""
INERTIA = {("N", "m"): "kg", ("N m", "rad"): "kg m^2"}
"""Unit of a load over that of the acceleration of an input."""


def heaviest(system: System, name: str, load: str, arm: float = 1.0) -> float:
    """Largest plausible mass; accelerations of an input are typically the square of its rate over its half-range."""
    scale = system.scale
    return HEAVY * scale.of(load) * scale.span.get(name, 1.0) / (abs(arm) * scale.speed.get(name, 1.0) ** 2)


def at_the_end(system: System, body: Mass) -> Candidate:
    """Mass times tangential acceleration of the end of a link: of the elbow's, of the arm in the shoulder's cuff."""
    (angle,), (load, *_) = body.moved, load_channels(system)
    most = heaviest(system, angle, load, {**system.known, **system.start}[body.lever])
    mass = Parameter(f"inertia_load.{body.variant}.mass", "kg", FIRST * most, -most, most)
    row, column = system.inputs.index(angle), system.outputs.index(load)

    def change(outputs: Channels, movement: DifferentiatedInputs, values: Values) -> Channels:
        out = outputs.copy()
        out[:, column] += values[mass.name] * values[body.lever] * movement.acceleration[row]
        return out

    link = with_balance(Modifier(f"inertia_load.{body.variant}", RANK, change))
    start = ({mass.name: -mass.start},)
    return Candidate("inertia_load", body.variant, "load", (mass,), link, {mass.name: 0.0}, start)


def at_the_attachment(system: System, body: Mass) -> Candidate:
    """Mass times second derivative of the deflection, as the geometry without further effects has it."""
    load = load_channels(system)[0]
    most = HEAVY * system.scale.of(load) * system.scale.deflection / system.scale.rate**2
    mass = Parameter(f"inertia_load.{body.variant}.mass", "kg", FIRST * most, 0.0, most)
    column = system.outputs.index(load)

    def change(outputs: Channels, movement: DifferentiatedInputs, values: Values) -> Channels:
        _, rate = system.geometry.deflection(movement, values)
        out = outputs.copy()
        out[:, column] += values[mass.name] * np.gradient(rate[:, 0], movement.time)
        return out

    link = with_balance(Modifier(f"inertia_load.{body.variant}", RANK, change))
    return Candidate("inertia_load", body.variant, "load", (mass,), link, {mass.name: 0.0})


def in_the_plane(system: System, body: Mass) -> Candidate:
    """Foot: mass at a distance from the heel, both components."""
    (x, y, pitch), (along, across) = (system.inputs.index(name) for name in body.moved), load_channels(system)[:2]
    most, long = heaviest(system, body.moved[1], across), system.length
    mass = Parameter("inertia_load.mass", "kg", 2.0 * FIRST * most, 0.0, most)
    ahead = Parameter("inertia_load.ahead", "m", 0.2 * long, 0.0, 1.2 * long)
    first, second = system.outputs.index(along), system.outputs.index(across)

    def change(outputs: Channels, movement: DifferentiatedInputs, values: Values) -> Channels:
        s, c = np.sin(movement.position[pitch]), np.cos(movement.position[pitch])
        turn, spin = movement.acceleration[pitch], movement.rate[pitch] ** 2
        m, arm = values[mass.name], values[ahead.name]
        out = outputs.copy()
        out[:, first] += m * (movement.acceleration[x] - arm * (turn * s + spin * c))
        out[:, second] += m * (movement.acceleration[y] + arm * (turn * c - spin * s))
        return out

    link = with_balance(Modifier("inertia_load", RANK, change))
    return Candidate("inertia_load", "", "load", (mass, ahead), link, {mass.name: 0.0}, ({ahead.name: 0.6 * long},))


def of_the_input(system: System) -> tuple[Candidate, ...]:
    """One load and an input in space that it resists: mass times the second derivative of that input."""
    moved, loads = system.geometry.yields, load_channels(system)
    alone = len(loads) == 1 and system.role(moved) == "position"
    unit = INERTIA.get((system.unit(loads[0]), system.unit(moved))) if alone else None
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


def offer(system: System) -> tuple[Candidate, ...]:
    """One candidate for each body that may have more mass, first the one that the forces move where there is one."""
    moved = system.geometry.slots.free("inertia_load.inertia")
    first = (of_the_arm_that_is_moved(system),) if moved else ()
    if system.traits.masses is None:
        return (*first, *of_the_input(system))
    return (*first, *(of_a_body(system, body) for body in system.traits.masses))


def of_a_body(system: System, body: Mass) -> Candidate:
    """By what moves it."""
    if not body.moved:
        return at_the_attachment(system, body)
    return in_the_plane(system, body) if len(body.moved) > 1 else at_the_end(system, body)


INERTIA_LOAD = Effect("inertia_load", "load", offer, "Newton's second law")
