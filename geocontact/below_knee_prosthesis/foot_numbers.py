"""Numbers of a leg, its socket and its foot as a simulation takes them, and where each is from."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from math import isclose

from geocontact.below_knee_prosthesis.keel.foam import foam_numbers
from geocontact.below_knee_prosthesis.keel.foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.keel.sole import BY_ZONE, SHARED, Foam, zone_number
from geocontact.below_knee_prosthesis.leg import Leg
from geocontact.below_knee_prosthesis.leg_tree import GRAVITY, SOCKET
from geocontact.below_knee_prosthesis.simulate import Stance
from geocontact.contact.bushing import PRINTED, Bushing
from geocontact.contact.bushing import SOCKET as AS_MEANT
from geocontact.data.parameter import Number, Source

GIVEN = "as the law's file gives it"
ROUNDING = 1e-12
"""Relative error of a modulus that went through the stiffness of a column."""
STATED = Number(0.0, "option", "as the foot's file states it")


def foot_numbers(foot: VariableStiffnessFoot, fulcrum: float) -> dict[str, Number]:
    """Numbers of keel and sole by name, in SI: what `simulate_stance` takes of this foot, whatever it was built
    from.
    """
    own = {"fulcrum": Number(fulcrum, "derived", "chosen")}
    own |= {f"keel {name}": number for name, number in _keel(foot, fulcrum)}
    return own | {f"sole {name}": number for name, number in _sole(foot)}


OF_FILE = "as the socket's file states it"
"""Note of the numbers of a socket that has its own."""


def socket_numbers(bushing: Bushing) -> dict[str, Number]:
    """Stiffness and damping along the socket's six directions [N m/rad, N/m; N m s/rad, N s/m]."""
    note = {AS_MEANT: "sec. 2.1, turns with N m in place of N mm", PRINTED: "sec. 2.1, as printed"}.get(
        bushing, OF_FILE
    )
    found = {}
    for kind, values in (("stiffness", bushing.stiffness), ("damping", bushing.damping)):
        for name, value in zip(SOCKET, values, strict=True):
            turned = bushing == AS_MEANT and "_r" in name
            source: Source = "option" if note == OF_FILE else "derived" if turned else "paper"
            found[f"{name} {kind}"] = Number(value, source, note)
    return found


def leg_numbers(leg: Leg) -> dict[str, Number]:
    """Numbers of the leg by name, in SI; height and pitch of the foot are in `leg keel` and `leg turn`."""
    return {f"leg {name}": number for name, number in leg.numbers().items()}


def numbers_without_leg(foot: VariableStiffnessFoot, fulcrum: float) -> dict[str, Number]:
    """Numbers of keel and sole at a fulcrum [m], and gravity."""
    return foot_numbers(foot, fulcrum) | {"gravity": Number(GRAVITY, "derived", "standard gravity")}


def all_numbers(leg: Leg, foot: VariableStiffnessFoot, fulcrum: float, bushing: Bushing) -> Mapping[str, Number]:
    """Numbers of leg, socket, keel and sole that are simulated, in SI; motion, plates and ground are not among them.

    Fixed besides is a pinned end of the keel (`Keel.compliance` has its hinges from EI and fulcrum).
    """
    return leg_numbers(leg) | socket_numbers(bushing) | numbers_without_leg(foot, fulcrum)


def numbers_of(stance: Stance) -> Mapping[str, Number]:
    """`all_numbers` of a stance that was simulated."""
    return all_numbers(stance.motion.leg, stance.foot, stance.fulcrum, stance.bushing)


def _keel(foot: VariableStiffnessFoot, fulcrum: float) -> Iterator[tuple[str, Number]]:
    keel, origin = foot.keel, foot.record.origin
    for name in ("length", "posterior", "joints", "width", "density", "retardation", "bending", "thickness"):
        yield name, replace(origin.get(f"keel {name}", STATED), value=float(getattr(keel, name)))
    for k, (edge, factor) in enumerate(zip(keel.sections.edges, keel.sections.factors[1:], strict=True), start=2):
        yield f"section_{k}_from", replace(origin.get("keel sections", STATED), value=edge)
        yield f"section_{k}_factor", replace(origin.get("keel sections", STATED), value=factor)
    for k, value in enumerate(keel.stiffness(fulcrum), start=1):
        yield f"stiffness_{k}", Number(float(value), "derived", f"of hinge {k}, from EI and fulcrum")
    if keel.twists:
        yield "torsional", replace(origin.get("keel torsional", STATED), value=keel.torsional)
        yield "torsion", Number(keel.torsion(fulcrum)[0], "derived", "of the hinge along the keel, from GJ and fulcrum")
    if keel.rubs:
        for name in ("hysteresis", "friction", "presliding"):
            yield name, Number(float(getattr(keel, name)), "invented", "of the keel's friction")


def _sole(foot: VariableStiffnessFoot) -> Iterator[tuple[str, Number]]:
    """Spheres or foam, and what all of a sole share."""
    origin, law = foot.record.origin, foot.law
    yield from _spheres(foot) if foot.sole.foam is None else _foam(foot, foot.sole.foam)
    for name in SHARED:
        yield name, _stated(origin, f"sole {name}", float(getattr(law, name)))


def _foam(foot: VariableStiffnessFoot, foam: Foam) -> Iterator[tuple[str, Number]]:
    """Foam as it is cut, and its numbers by zone."""
    origin, spheres = foot.record.origin, foot.sole.spheres
    lowest = {"below": float((spheres.radius - spheres.centre[:, 1]).max())}
    for name, value in (lowest | {"breadth": foam.breadth, "column": foam.column, "across": foam.across}).items():
        yield name, replace(origin.get(f"sole {name}", STATED), value=float(value))
    numbers = foam_numbers(foot.sole, foot.law)
    for zone, end in foam.ends:
        for name, value in ({"to": end} | vars(numbers[zone])).items():
            yield f"{zone}_{name}", _stated(origin, f"sole {zone}_{name}", float(value))


def _spheres(foot: VariableStiffnessFoot) -> Iterator[tuple[str, Number]]:
    """Spheres as they lie; all of one zone have one law. Radius and height by sphere where they differ."""
    origin, spheres, law = foot.record.origin, foot.sole.spheres, foot.law
    places = origin.get("sole places", STATED)
    alike = len(set(spheres.radius.tolist())) == len(set(spheres.centre[:, 1].tolist())) == 1
    if alike:
        yield "radius", replace(origin.get("sole radius", STATED), value=float(spheres.radius[0]))
    below = float((spheres.radius - spheres.centre[:, 1]).max())
    yield "below", replace(origin.get("sole below", STATED), value=below)
    for zone, of in spheres.zones.items():
        for k, (place, radius) in enumerate(zip(spheres.centre[of], spheres.radius[of], strict=True), start=1):
            for axis, value in zip("xyz", place, strict=True):
                if not alike or axis != "y":
                    yield f"{zone}_{k}_{axis}", Number(float(value), places.source, f"centre of its sphere {k}, from K")
            if not alike:
                yield f"{zone}_{k}_radius", Number(float(radius), places.source, f"of its sphere {k}")
    for zone, of in spheres.zones.items():
        for kind in BY_ZONE:
            yield f"{zone}_{kind}", _stated(origin, f"sole {zone}_{kind}", zone_number(law, kind, of))


def _stated(origin: Mapping[str, Number], name: str, value: float) -> Number:
    """A number of the law as its foot has it, else as another file gives it."""
    known = origin.get(name)
    return (
        known
        if known is not None and isclose(known.value, value, rel_tol=ROUNDING)
        else Number(value, "derived", GIVEN)
    )
