"""The exoskeleton's description with what its motion identified, and where the two contradict each other.

Friction that the motion identifies by itself takes the place of the described one. Masses act on no motor by
themselves: they stay as described, and so does every other number; the dynamic parameters stand beside them under
`[identified]`.
A number contradicts the description where it lies more than `FAR` standard deviations from what described numbers say.
"""

from __future__ import annotations

from dataclasses import dataclass

from geocontact.data.parameter import Number
from geocontact.io.recordings.exoskeleton_description import (
    BODIES,
    HINGED,
    ExoskeletonFile,
    IdentifiedParameters,
)
from geocontact.standing_up.exoskeleton import part_lengths
from geocontact.standing_up.exoskeleton_torque import UNITS, ExoskeletonDynamics

FAR = 3.0
"""Standard deviations from which an identified number contradicts a described one."""


@dataclass(frozen=True)
class MergedExoskeleton:
    """What is written.

    Parameters
    ----------
    remarks
        What stands behind a number in the file, by name.
    contradictions
        A line for each identified number that contradicts the description.
    sentence
        What was merged and what was kept.
    """

    file: ExoskeletonFile
    remarks: dict[str, str]
    contradictions: tuple[str, ...]
    sentence: str


def merged(described: ExoskeletonFile, fit: ExoskeletonDynamics, level: float) -> MergedExoskeleton:
    """The description with the friction and the dynamics of a fit; `level` is the probability of its intervals."""
    alone = tuple(name for name, by_itself in zip(fit.names, fit.alone, strict=True) if by_itself)
    values = {name: float(value) for name, value in zip(fit.names, fit.values, strict=True)}
    sd = dict(zip(fit.names, fit.deviations, strict=True))
    ends = {name: (low, high) for name, low, high in zip(fit.names, *fit.intervals(level), strict=True)}
    units = dict(zip(fit.names, UNITS, strict=True))
    numbers, remarks, kept = dict(described.numbers), {}, []
    for number, name in friction_names().items():
        if name in alone:
            low, high = ends[name]
            note = f"sit-to-stand device, {100.0 * level:g} %: {low:.4g} to {high:.4g}"
            if number in described.numbers:
                remarks[number] = f"was {described.numbers[number].value:.4g}"
            numbers[number] = Number(max(values[name], 0.0), "derived", note)
        else:
            kept.append(number)
    against = []
    for name, stated in described_parameters(described).items():
        if name in alone and abs(values[name] - stated) > FAR * sd[name]:
            against.append(
                f"{name}: {values[name]:.4g} ± {sd[name]:.2g} {units[name]} (standard deviation) identified, "
                f"{stated:.4g} by the description {described.name}"
            )
    lengths = part_lengths(fit.subject)
    found = IdentifiedParameters(lengths[:2], values, alone)
    remarks |= {name: "by itself" if name in alone else "in sums, or not at all" for name in fit.names}
    kept = [f"{part}_mass" for part in ("foot_plate", *BODIES)] + kept
    known = [name for name in kept if name in described.numbers]
    missing = [name for name in kept if name not in described.numbers]
    sentence = f"device.toml: friction of {sum(n in alone for n in friction_names().values())} of 6 kinds identified"
    sentence += f"; kept as described: {', '.join(known)}" if known else ""
    sentence += f"; neither described nor identified: {', '.join(missing)}" if missing else ""
    return MergedExoskeleton(ExoskeletonFile(described.name, numbers, found), remarks, tuple(against), sentence)


def friction_names() -> dict[str, str]:
    """Dynamic parameters by the names of friction in a description."""
    kinds = {"viscous": "viscous", "coulomb": "Coulomb"}
    return {f"{hinge}_{key}": f"exo_{hinge} {kind} friction" for hinge in HINGED for key, kind in kinds.items()}


def described_parameters(described: ExoskeletonFile) -> dict[str, float]:
    """Dynamic parameters that follow from described numbers alone, by name, in SI.

    First moments across, and those of the module, which carries nothing: what hangs at the end of the others acts as
    their own.
    """
    of = {name: each.value for name, each in described.numbers.items()}
    found = {name: of[number] for number, name in friction_names().items() if number in of}
    for part in BODIES:
        if {f"{part}_mass", f"{part}_ahead"} <= of.keys():
            found[f"exo_{part} first moment along x"] = of[f"{part}_mass"] * of[f"{part}_ahead"]
    if {"module_mass", "module_centre"} <= of.keys():
        found["exo_module first moment along y"] = of["module_mass"] * of["module_centre"]
        if "module_inertia" in of:
            off = of["module_centre"] ** 2 + of.get("module_ahead", 0.0) ** 2
            found["exo_module inertia"] = of["module_inertia"] + of["module_mass"] * off
    return found
