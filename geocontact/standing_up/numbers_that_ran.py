"""Every number of a model and of a phase as it was solved, in SI, and where each is from.

They are read from what was solved: the bodies and laws of which the equations were built, the sizes of the cost, the
bounds of the problem, the meshes of the motions. Recorded channels are in the study's files.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from geocontact.data.multibody.model import Body, Multibody
from geocontact.data.parameter import Source
from geocontact.dynamics.collocation.motion import CollocatedMotion
from geocontact.dynamics.collocation.problem import ControlProblem
from geocontact.standing_up.phase import PhaseProblem, PhaseSizes
from geocontact.standing_up.standing_model import GroundLaw, StandingModel
from geocontact.standing_up.strap_sites import DAMPING, TURNING_DAMPING, ContactParameter, StrapSite
from geocontact.standing_up.trials import SHIPPED, StandingTrial
from geocontact.standing_up.worn_device import SHIPPED_DEVICE, DeviceMasses, WornDevice

DE_LEVA = "both sides; fractions of mass and height by de Leva (1996), or the person's own"
OF_BOTH = "of both sides"
DESCRIBED = ", by the exoskeleton's description"
IDENTIFIED = ", by sit-to-stand device"
WEIGHED = "as the study has it"
FROM_FILE = "as the file of parameters gives it"
PERTURBED = "of the file of parameters, times a factor"
NOISE_UNITS = {
    "length": "m",
    "angle": "rad",
    "rate": "rad/s and m/s",
    "force": "N",
    "centre": "m",
    "torque": "N m",
    "strap": "N",
}
WEIGHT_UNITS = {"torques": "1/(N m)^2", "energy": "1/J^2"}


class Ran(NamedTuple):
    """A number that ran."""

    number: str
    value: float
    unit: str
    source: Source
    note: str = ""


def model_numbers(model: StandingModel) -> list[Ran]:
    """Bodies, joints, gravity, ground and straps. ValueError for a model that does not say what it was built of."""
    of = model.constants
    if of is None:
        raise ValueError("this model does not say what it was built of")
    rows = [row for body in of.chain.bodies if body.mass > 0.0 for row in _body(body, of.device)]
    device = of.device or SHIPPED_DEVICE
    rows += [*joint_numbers(of.chain, device), *_ground(of.ground)]
    return rows + [row for site in of.sites for row in _strap(site, device)]


def parameter_numbers(
    parameters: Sequence[ContactParameter],
    p: Float[np.ndarray, " p"],
    prefix: str = "",
    *,
    free: Sequence[str] = (),
    note: str = "held",
) -> list[Ran]:
    """Values from what is searched; `note` is of those that are not free."""
    return [
        Ran(
            f"{prefix}{each.name}",
            each.value(float(value)),
            each.unit,
            "derived",
            "found" if each.name in free else note,
        )
        for each, value in zip(parameters, p, strict=True)
    ]


def belief_numbers(phase: PhaseProblem, prefix: str = "") -> list[Ran]:
    """Prior of each parameter that is sought, and its bounds."""
    rows = []
    for each in phase.parameters:
        if each.name in phase.free:
            scale = "1 of the logarithm" if each.logarithm else each.unit
            name = f"{prefix}{each.name}"
            rows += [
                Ran(f"{name} usual", each.usual, each.unit, "invented", "prior mean"),
                Ran(f"{name} sd", each.sd, scale, "invented", "standard deviation of what is used"),
                Ran(f"{name} least", each.least, each.unit, "invented", "lower bound"),
                Ran(f"{name} most", each.most, each.unit, "invented", "upper bound"),
            ]
    return rows


def size_numbers(sizes: PhaseSizes, prefix: str = "") -> list[Ran]:
    """What the terms of the cost are measured by; the noise of measured shear is in none of them."""
    noise = [
        Ran(f"{prefix}noise {name}", float(value), NOISE_UNITS[name], "derived", "of one sample, as the study has it")
        for name, value in vars(sizes.noise).items()
        if name in NOISE_UNITS
    ]
    rate = Ran(f"{prefix}rate", sizes.rate, "Hz", "invented", "samples a second at which a deviation counts as itself")
    usual = SHIPPED
    jerk = [
        Ran(f"{prefix}jerk {name}", size, unit, *_asked(size, own, "size that counts as 1"))
        for name, size, unit, own in zip(
            ("foot", "joints"), sizes.jerk, ("m/s^3 and rad/s^3", "rad/s^3"), usual.jerk, strict=True
        )
    ]
    weights = [
        Ran(f"{prefix}weight {name}", value, WEIGHT_UNITS[name], *_asked(value, getattr(usual, name), "of the square"))
        for name, value in sizes.weights.items()
    ]
    return [*noise, rate, *jerk, *weights]


def _asked(value: float, shipped: float, note: str) -> tuple[Source, str]:
    """Source and note of a number that is invented unless the study gives another."""
    return ("invented", note) if value == shipped else ("derived", f"{note}, as the study has it")


def end_numbers(control: ControlProblem, prefix: str = "") -> list[Ran]:
    """How far the first and the last state may be off what is given of them; of the first trial, as all of them."""
    low, high = control.trials[0].start
    n, half = len(control.system.names[0]) // 3, 0.5 * (high - low)
    note = "from the smoothed recording to either side"
    at = {"length": (0, "m"), "angle": (2, "rad"), "rate": (n, "rad/s and m/s")}
    return [Ran(f"{prefix}ends {name}", float(half[k]), unit, "invented", note) for name, (k, unit) in at.items()]


def search_numbers(motions: Sequence[CollocatedMotion], trials: Sequence[StandingTrial], prefix: str = "") -> list[Ran]:
    """Numbers of each trial: its length and rate, and the mesh on which it was solved; `mesh.csv` has where intervals
    begin.
    """
    rows = []
    for motion, trial in zip(motions, trials, strict=True):
        name, lengths = f"{prefix}{motion.name}", np.diff(motion.breaks)
        rows += [
            Ran(f"{name} duration", float(np.ptp(motion.breaks)), "s", "derived", "of the recording that is used"),
            Ran(f"{name} rate", trial.rate, "Hz", "derived", "samples a second of the recording"),
            Ran(f"{name} degree", float(motion.scheme.degree), "-", "invented", "points of an interval, Radau's"),
            Ran(f"{name} intervals", float(len(lengths)), "-", "derived", "as refined"),
            Ran(f"{name} shortest interval", float(lengths.min()), "s", "derived", "as refined"),
        ]
    return rows


def _body(body: Body, device: WornDevice | None) -> Iterator[Ran]:
    """Rows of one body; masses that differ from the shipped ones are the study's."""
    mass: tuple[Source, str] = ("derived", DE_LEVA)
    kinds: dict[str, tuple[Source, str]] = dict.fromkeys(("ahead", "centre", "inertia"), ("derived", ""))
    if device is not None and (body.name == "foot" or body.name.startswith("exo_")):
        part = body.name.removeprefix("exo_").replace("foot", "foot_plate")
        weighed = getattr(device.masses, part) != getattr(DeviceMasses(), part)
        if body.name == "foot":
            mass = ("derived", f"{DE_LEVA}; with foot plates, {WEIGHED if weighed else 'which are invented'}")
        else:
            mass = ("derived", f"of both sides, {WEIGHED}") if weighed else ("invented", OF_BOTH)
            kinds = {kind: _described(device, f"{part}_{kind}", ("invented", "")) for kind in kinds}
            if device.identified:
                kinds = dict.fromkeys(kinds, ("derived", IDENTIFIED))
        if (stated := device.stated.get(f"{part}_mass")) is not None and stated.value == getattr(device.masses, part):
            whose = f"{DE_LEVA}; with foot plates" if body.name == "foot" else OF_BOTH
            found, note = _described(device, f"{part}_mass", ("derived", ""))
            mass = ("derived" if body.name == "foot" else found, f"{whose}{note}")
    name = f"body {body.name}"
    yield Ran(f"{name} mass", body.mass, "kg", *mass)
    for axis, value, (source, by) in zip("xy", body.centre[:2], (kinds["ahead"], kinds["centre"]), strict=True):
        yield Ran(f"{name} centre_{axis}", float(value), "m", source, f"mass centre in the body's frame{by}")
    source, by = kinds["inertia"]
    yield Ran(f"{name} inertia", float(body.inertia[2, 2]), "kg m^2", source, f"about z through the mass centre{by}")


def _described(device: WornDevice, name: str, shipped: tuple[Source, str]) -> tuple[Source, str]:
    """Source of a number of a description, and what is behind a note on it; `shipped` where it is not described."""
    if (stated := device.stated.get(name)) is None:
        return shipped
    return stated.source, f"{DESCRIBED}: {stated.source}{stated.note and f', {stated.note}'}"


def _placed(device: WornDevice, length: str) -> tuple[Source, str]:
    """Where the place of the exoskeleton's hinge at the end of a part of this length is from.

    Its shank is the person's and `knee_above`, unless it is described; its thigh what then is left of the person's.
    """
    if length in device.stated:
        return _described(device, length, ("invented", ""))
    return _set_to(device, "shank_length" if "shank_length" in device.stated else "knee_above")


def _set_to(device: WornDevice, name: str) -> tuple[Source, str]:
    """Where a place is from that follows from a number of the exoskeleton and the person's lengths."""
    if name not in device.stated:
        return "invented", ""
    return "derived", f"{_described(device, name, ('derived', ''))[1]}; set to the person"


def joint_numbers(chain: Multibody, device: WornDevice) -> Iterator[Ran]:
    """Places of the joints between bodies with mass, and gravity."""
    ends = {"exo_knee": "shank_length", "exo_hip": "thigh_length"}
    for joint in chain.joints:
        if joint.parent in {body.name for body in chain.bodies if body.mass > 0.0}:
            for axis, value in zip("xy", joint.parent_offset.translation[:2], strict=True):
                source: tuple[Source, str] = ("invented" if joint.child.startswith("exo_") else "derived", "")
                if axis == "y" and joint.name in ends:
                    source = _placed(device, ends[joint.name])
                note = f"in the frame of {joint.parent}{source[1]}"
                yield Ran(f"joint {joint.name} {axis}", float(value), "m", source[0], note)
    for axis, value in zip("xy", chain.gravity[:2], strict=True):
        yield Ran(f"gravity_{axis}", float(value), "m/s^2", "derived", "standard gravity")


def _ground(law: GroundLaw) -> Iterator[Ran]:
    simbody = "Simbody's default"
    yield Ran("ground hertz_smoothing", law.hertz, "1/m", "paper", simbody)
    yield Ran("ground hunt_crossley_smoothing", law.hunt_crossley, "s/m", "paper", simbody)
    yield Ran("ground constant", law.constant, "m^2 and m^2/s^2", "paper", simbody)
    names = ("transition_speed", "m/s"), ("static", "-"), ("dynamic", "-"), ("viscous", "s/m")
    for (name, unit), value in zip(names, law.friction.numbers, strict=True):
        note = "before the factor `friction`" if name in ("static", "dynamic") else ""
        yield Ran(f"ground {name}", float(value), unit, "invented", note)


def _strap(site: StrapSite, device: WornDevice) -> Iterator[Ran]:
    name = f"strap at the {site.name}"
    yield Ran(f"{name} count", float(site.count), "-", "derived", "in parallel between the chains")
    dashpots = (
        ("damping", "N s/m", DAMPING, "of one, across and along"),
        ("turning_damping", "N m s/rad", TURNING_DAMPING, "of one"),
    )
    for what, unit, paper, note in dashpots:
        value = float(getattr(site, what))
        source: tuple[Source, str] = ("paper", "") if value == paper else ("derived", ", as the study has it")
        if (stated := device.stated.get(f"strap_{what}")) is not None and stated.value == value:
            source = _described(device, f"strap_{what}", source)
        yield Ran(f"{name} {what}", value, unit, source[0], f"{note}{source[1]}")
    by = {"shank": "", "thigh": "knee_above", "trunk": "thigh_length"}[site.person]
    source = _set_to(device, "shank_length" if by == "knee_above" and "shank_length" in device.stated else by)
    yield Ran(f"{name} above", site.above, "m", source[0], f"the exoskeleton's hinge over the person's{source[1]}")
