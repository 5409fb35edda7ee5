"""The exoskeleton's description with what its motion identified, and where the two contradict each other.

Friction that the motion identifies by itself takes the place of the described one; below 0 it is 0, if 0 is within its
interval, else it is not taken. Masses act on no motor by themselves: they stay as described, and so do lengths and
straps. Mass centres and inertias are left out: they follow from masses and the dynamic parameters under `[identified]`.
A number contradicts the description where it lies more than `FAR` standard deviations from what described numbers say;
rows of the shipped description say nothing of an exoskeleton.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from geocontact.data.parameter import Number
from geocontact.io.recordings.exoskeleton_description import (
    BODIES,
    ExoskeletonFile,
    IdentifiedParameters,
)
from geocontact.standing_up.exoskeleton import part_lengths
from geocontact.standing_up.exoskeleton_torque import UNITS, ExoskeletonDynamics
from geocontact.standing_up.worn_device import FRICTION_NAMES, PARTS, identified_device

FAR = 3.0
"""Standard deviations from which an identified number contradicts a described one."""
KINDS = ("centre", "ahead", "inertia")
BODY_NUMBERS = frozenset(f"{part}_{kind}" for part in BODIES for kind in KINDS)
"""What identified dynamics and masses have."""


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
    numbers = {name: each for name, each in described.numbers.items() if name not in BODY_NUMBERS}
    remarks, kept = {}, []
    for number, name in FRICTION_NAMES.items():
        low, high = ends[name]
        if name in alone and high >= 0.0:
            note = f"sit-to-stand device, {100.0 * level:g} %: {low:.4g} to {high:.4g}"
            if number in described.numbers:
                remarks[number] = f"was {described.numbers[number].value:.4g}"
            numbers[number] = Number(max(values[name], 0.0), "derived", note)
        else:
            kept.append(number)
    against = []
    for name, stated in described_parameters(fit.subject.device.stated).items():
        if name in alone and abs(values[name] - stated) > FAR * sd[name]:
            against.append(
                f"{name}: {values[name]:.4g} ± {sd[name]:.2g} {units[name]} (standard deviation) identified, "
                f"{stated:.4g} by the description {described.name}"
            )
    found = IdentifiedParameters(part_lengths(fit.subject)[:2], values, alone)
    remarks |= {name: "by itself" if name in alone else "in sums, or not at all" for name in fit.names}
    kept = [f"{part}_mass" for part in ("foot_plate", *BODIES)] + kept
    known = [name for name in kept if name in described.numbers]
    missing = [name for name in kept if name not in described.numbers]
    taken = sum(name not in kept for name in FRICTION_NAMES)
    sentence = f"device.toml: friction of {taken} of {len(FRICTION_NAMES)} kinds identified"
    sentence += f"; kept as described: {', '.join(known)}" if known else ""
    sentence += f"; neither described nor identified: {', '.join(missing)}" if missing else ""
    left_out = _left_out(described, fit)
    sentence += f"; left out, as [identified] and masses have them: {', '.join(left_out)}" if left_out else ""
    return MergedExoskeleton(ExoskeletonFile(described.name, numbers, found), remarks, tuple(against), sentence)


def _left_out(described: ExoskeletonFile, fit: ExoskeletonDynamics) -> list[str]:
    """Described mass centres and inertias, each beside the identified one where all masses are described."""
    names = [name for name in described.numbers if name in BODY_NUMBERS]
    device, found = fit.subject.device, dict[str, float]()
    if names and {f"{part}_mass" for part in BODIES} <= device.stated.keys():
        values = {name: float(value) for name, value in zip(fit.names, fit.values, strict=True)}
        try:
            parts = identified_device(values, part_lengths(fit.subject), device.masses).parts
        except ValueError:
            parts = ()  # a study that names the file refuses these masses
        for part, body in zip(PARTS, parts, strict=False):
            own = (body.along, body.across, body.inertia)
            found |= {f"{part.removeprefix('exo_')}_{kind}": each for kind, each in zip(KINDS, own, strict=True)}
    at = {name: described.numbers[name].value for name in names}
    return [f"{name} ({at[name]:.4g}, identified {found[name]:.4g})" if name in found else name for name in names]


def described_parameters(numbers: Mapping[str, Number]) -> dict[str, float]:
    """Dynamic parameters that follow from described numbers alone, by name, in SI.

    First moments across, and those of the module, which carries nothing: what hangs at the end of the others acts as
    their own.
    """
    of = {name: each.value for name, each in numbers.items()}
    found = {name: of[number] for number, name in FRICTION_NAMES.items() if number in of}
    for part in BODIES:
        if {f"{part}_mass", f"{part}_ahead"} <= of.keys():
            found[f"exo_{part} first moment along x"] = of[f"{part}_mass"] * of[f"{part}_ahead"]
    if {"module_mass", "module_centre"} <= of.keys():
        found["exo_module first moment along y"] = of["module_mass"] * of["module_centre"]
        if "module_inertia" in of:
            off = of["module_centre"] ** 2 + of.get("module_ahead", 0.0) ** 2
            found["exo_module inertia"] = of["module_inertia"] + of["module_mass"] * off
    return found
