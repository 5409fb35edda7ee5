"""Numbers of a leg, its socket and its foot as a simulation takes them, and where each is from."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from geocontact.below_knee_prosthesis.keel.keel import Keel
from geocontact.below_knee_prosthesis.keel.sole import ROWS as SOLE_ROWS
from geocontact.below_knee_prosthesis.keel.vsf import ROWS as KEEL_ROWS
from geocontact.below_knee_prosthesis.keel.vsf import VariableStiffnessFoot, vsf_foot
from geocontact.below_knee_prosthesis.leg import Leg
from geocontact.below_knee_prosthesis.leg_tree import GRAVITY, SOCKET
from geocontact.below_knee_prosthesis.simulate import Stance
from geocontact.contact.bushing import PRINTED, Bushing
from geocontact.contact.bushing import SOCKET as AS_MEANT
from geocontact.data.parameter import Number, Source
from geocontact.loads.sphere_set import SoleLaw

COMPRESSED = "fitted to 10, 19 and 32 N/mm in compression of the sole"
GIVEN = "as the law's file gives it"
BY_ZONE = ("stiffness", "damping", "static", "kinetic")
SHARED = ("exponent", "full_depth", "threshold_speed")
"""Numbers of a sole's law: by zone, and of all spheres."""


def foot_numbers(foot: VariableStiffnessFoot, fulcrum: float) -> dict[str, Number]:
    """Numbers of keel and sole by name, in SI: what `simulate_stance` takes of this foot, whatever it was built
    from.
    """
    own = {"fulcrum": Number(fulcrum, "derived", "chosen")}
    own |= {f"keel {name}": number for name, number in _keel(foot.keel, fulcrum)}
    return own | {f"sole {name}": number for name, number in _sole(foot)}


def socket_numbers(bushing: Bushing) -> dict[str, Number]:
    """Stiffness and damping along the socket's six directions [N m/rad, N/m; N m s/rad, N s/m]."""
    note = {AS_MEANT: "sec. 2.1, turns with N m in place of N mm", PRINTED: "sec. 2.1, as printed"}.get(
        bushing, "given"
    )
    found = {}
    for kind, values in (("stiffness", bushing.stiffness), ("damping", bushing.damping)):
        for name, value in zip(SOCKET, values, strict=True):
            turned = bushing == AS_MEANT and "_r" in name
            found[f"{name} {kind}"] = Number(value, "derived" if turned else "paper", note)
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


def _keel(keel: Keel, fulcrum: float) -> Iterator[tuple[str, Number]]:
    known = {name: (source, note) for name, _, source, note in KEEL_ROWS}
    for name in ("length", "posterior", "joints", "width", "density", "retardation"):
        yield name, Number(float(getattr(keel, name)), *known[name])
    yield (
        "bending",
        Number(keel.bending, "derived", f"EI, with the forefoot's stiffness {COMPRESSED}; {keel.support} end"),
    )
    yield "thickness", Number(keel.thickness, "derived", "from width, modulus and EI as of beam theory")
    for k, value in enumerate(keel.stiffness(fulcrum), start=1):
        yield f"stiffness_{k}", Number(float(value), "derived", f"of hinge {k}, from EI and fulcrum")
    if keel.rubs:
        for name in ("hysteresis", "friction", "presliding"):
            yield name, Number(float(getattr(keel, name)), "invented", "of the keel's friction")


def _sole(foot: VariableStiffnessFoot) -> Iterator[tuple[str, Number]]:
    """Spheres as they lie, all of one radius and height; all of one zone have one law."""
    known = {name: (source, note) for name, _, source, note in SOLE_ROWS}
    spheres, law, usual = foot.sole.spheres, foot.law, vsf_foot()
    built_in = spheres.zone == usual.sole.spheres.zone
    yield "radius", Number(float(spheres.radius[0]), *known["radius"])
    yield "below", Number(float(spheres.radius[0] - spheres.centre[0, 1]), *known["below"])
    for zone, of in spheres.zones.items():
        for k, place in enumerate(spheres.centre[of], start=1):
            for axis, value in zip("xz", place[::2], strict=True):
                yield f"{zone}_{k}_{axis}", Number(float(value), "invented", f"centre of its sphere {k}, from K")
    for zone, of in spheres.zones.items():
        first = int(np.flatnonzero(of)[0])
        for kind in BY_ZONE:
            value, expected = _of(law, kind, first), _of(usual.law, kind, first) if built_in else np.nan
            source, note = _named(known, zone, kind) if value == expected else ("derived", GIVEN)
            yield f"{zone}_{kind}", Number(value, source, note)
    for name in SHARED:
        value = float(getattr(law, name))
        source, note = known[name] if value == float(getattr(usual.law, name)) else ("derived", GIVEN)
        yield name, Number(value, source, note)


def _named(known: Mapping[str, tuple[Source, str]], zone: str, kind: str) -> tuple[Source, str]:
    """Source and note of a number of the built-in sole."""
    if kind != "stiffness":
        return known[kind]
    if zone == "forefoot":
        return "derived", f"of a sphere, with EI {COMPRESSED}"
    return known[f"{zone.partition('_')[0]}_stiffness"]


def _of(law: SoleLaw, kind: str, sphere: int) -> float:
    return float(np.broadcast_to(getattr(law, kind), len(law.stiffness))[sphere])
