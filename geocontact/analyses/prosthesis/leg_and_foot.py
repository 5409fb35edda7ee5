"""Leg and foot that are simulated: law of the sole from a file, numbers with sources, words of socket and foot."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd

from geocontact.analyses.frame.collector import add_input, reserve
from geocontact.analyses.frame.folder import digest
from geocontact.below_knee_prosthesis.foot_numbers import foot_numbers, socket_numbers
from geocontact.below_knee_prosthesis.keel.vsf import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.leg import AS_STOOD, FootOffset, Leg
from geocontact.below_knee_prosthesis.leg_tree import GRAVITY
from geocontact.below_knee_prosthesis.limb_in_socket import LimbInSocket
from geocontact.below_knee_prosthesis.simulate import Stance
from geocontact.contact.bushing import Bushing
from geocontact.data.errors import InputError
from geocontact.data.parameter import Number
from geocontact.io.recordings.spheres import read_law
from geocontact.loads.sphere_set import SoleLaw


def foot_with_law(foot: VariableStiffnessFoot, file: Path | None) -> VariableStiffnessFoot:
    """The foot with the numbers that a file gives, for all spheres or by zone; the rest are as they were."""
    if file is None:
        return foot
    law_file, zones = read_law(file), foot.sole.spheres.zones
    add_input("`law`", file)
    strange = sorted(set(law_file.zone) - set(zones))
    if strange:
        raise InputError(file, f"zone.{strange[0]}", "no sphere is in that zone", f"zones are: {', '.join(zones)}")
    count, law = len(foot.sole.spheres), foot.law
    usual = {"k": law.stiffness, "b": law.damping, "mu_s": law.static, "mu_k": law.kinetic}
    by_sphere = {}
    for key, values in usual.items():
        all_spheres = getattr(law_file, key)
        by_sphere[key] = np.array(np.broadcast_to(values if all_spheres is None else all_spheres, count), float)
        for zone, numbers in law_file.zone.items():
            if (value := getattr(numbers, key)) is not None:
                by_sphere[key][zones[zone]] = value
    shared = {"exponent": law_file.n, "full_depth": law_file.delta_full, "threshold_speed": law_file.v_th}
    stated = {name: value for name, value in shared.items() if value is not None}
    try:
        new: SoleLaw = replace(
            law,
            stiffness=by_sphere["k"],
            damping=by_sphere["b"],
            static=by_sphere["mu_s"],
            kinetic=by_sphere["mu_k"],
            **stated,
        )
    except ValueError as error:
        raise InputError(file, "force law", str(error), "correct the number") from error
    return replace(foot, law=new)


def offset_of_law(file: Path | None, standing: Path) -> FootOffset:
    """How the foot is beside a standing trial; none where the file does not say, or says it of another trial."""
    beside = None if file is None else read_law(file).foot
    if beside is None:
        return AS_STOOD
    if beside.standing is not None and beside.standing != digest(standing):
        reserve(
            f"{file}: [foot] was found beside another standing trial than `static`, and is left out: height and pitch "
            "are errors of that trial (if it is the same in another file, take the line `standing` out of the law)"
        )
        return AS_STOOD
    return FootOffset(beside.height, beside.pitch, beside.height_sd, beside.pitch_sd)


def all_numbers(leg: Leg, foot: VariableStiffnessFoot, fulcrum: float, bushing: Bushing) -> Mapping[str, Number]:
    """Numbers of leg, socket, keel and sole that are simulated, in SI; motion, plates, ground are in files and options.

    Fixed besides is a pinned end of the keel (`Keel.compliance` has its hinges from EI and fulcrum).
    """
    return leg_numbers(leg) | socket_numbers(bushing) | numbers_without_leg(foot, fulcrum)


def leg_numbers(leg: Leg) -> dict[str, Number]:
    """Numbers of the leg by name, in SI; height and pitch of the foot are in `leg keel` and `leg turn`."""
    return {f"leg {name}": number for name, number in leg.numbers().items()}


def numbers_without_leg(foot: VariableStiffnessFoot, fulcrum: float) -> dict[str, Number]:
    """Numbers of keel and sole, and gravity."""
    return foot_numbers(foot, fulcrum) | {"gravity": Number(GRAVITY, "derived", "standard gravity")}


def numbers_of(s: Stance) -> Mapping[str, Number]:
    """`all_numbers` of a stance that was simulated."""
    return all_numbers(s.motion.leg, s.foot, s.fulcrum, s.bushing)


def numbers_table(numbers: Mapping[str, Number]) -> pd.DataFrame:
    """Every number in SI, and where it is from."""
    rows = [(name, number.value, number.source, number.note) for name, number in numbers.items()]
    return pd.DataFrame(rows, columns=["number", "value", "source", "note"])


def offset_words(offset: FootOffset) -> str:
    """The foot beside its standing trial, as the law has it, in a sentence."""
    return f"the foot is {offset.words} beside where its standing trial has it, as the law's file says"


def counted_twice(limb: LimbInSocket) -> str:
    """The socket's motion that stays in the leg's angles, where taking it out did not settle, in words."""
    if limb.turns == 0:
        turned = np.degrees(np.abs(limb.stance.found.q[:, 2:5]).max())
        piston = 1e3 * np.abs(limb.stance.pistoning).max()
        return (
            f"the socket's motion, up to {turned:.1f} degrees and {piston:.0f} mm, is counted twice: in the leg's "
            "angles and in the bushing"
        )
    return (
        f"fit and simulated socket do not agree yet: the last of {limb.turns} turns changed the force by "
        f"{limb.change:.1%} of body weight"
    )
