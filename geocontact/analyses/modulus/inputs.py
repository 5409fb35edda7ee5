"""What an identification starts from: areas, forces, radius, and what is unknown, as the options say."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.analyses import quantities
from geocontact.analyses.modulus.free_parameters import freed
from geocontact.analyses.run_record import Record
from geocontact.cli.idle import bootstrap_rule, refuse
from geocontact.cli.modulus import ModulusOptions
from geocontact.contact.area_hertz import READINGS, Reading
from geocontact.data.errors import InputError
from geocontact.data.parameter import Parameter
from geocontact.elastic_modulus.area_force import ADDUCTION, LAG, SLOPE, AreaForce, ThresholdAreas
from geocontact.elastic_modulus.both_sides import end_to_end
from geocontact.io.recordings.area_table import FEWEST, AreaTable, read_area_table
from geocontact.io.recordings.force_curves import SIDES, ForceCurves, read_force_curves
from geocontact.io.recordings.radius_profile import RadiusProfile, read_radius_profile
from geocontact.io.text.columns import angles_of, parse_map
from geocontact.io.text.tables import read_table

USUAL = 4.0e-3  # m, the threshold of the knee-implant paper
FLEXION = "flexion"
ORDER = ("total", "medial", "lateral")
BOTH, HALVES = "both", ("medial", "lateral")
"""Side that stands for the two halves met at once, as a free adduction asks for."""


@dataclass(frozen=True, eq=False)
class Inputs:
    """Everything read; `evolutions` by side, as far as areas and forces have it; `lag` as given [s].

    `sides` are those to be identified: every evolution, or both halves at once.
    """

    table: AreaTable
    forces: ForceCurves
    evolutions: Mapping[str, ThresholdAreas]
    reading: Reading
    lag: float
    sides: tuple[str, ...]


def refuse_idle(o: ModulusOptions) -> None:
    """Options that would do nothing, and numbers that cannot be."""
    poisson_ratios(o)
    free = freed(o)
    refuse(
        ((o.radius_mm is None) == (o.profile is None), "--radius-mm",
         "or --profile: exactly one says the radius of the contact", "give for example --radius-mm 37"),
        (o.radius_mm is not None and not 0.1 <= o.radius_mm <= 1e4, "--radius-mm",
         f"{o.radius_mm} is no radius of a contact in mm", "give for example 37"),
        (o.profile is not None and o.flexion is None, "--profile", "needs --flexion", "give both"),
        (SLOPE in free and o.flexion is None, "--free", "slope needs --flexion", "give the motion of the areas"),
        (o.flexion is not None and o.profile is None and SLOPE not in free, "--flexion",
         "does nothing without --profile or --free slope", "give one of them"),
        (o.angles is not None and o.flexion is None, "--angles", "does nothing without --flexion", "leave it out"),
        (o.reading == "strip" and o.length_mm is None, "--length-mm", "is missing for a strip", "give it"),
        (o.length_mm is not None and not 0.1 <= o.length_mm <= 1e4, "--length-mm", f"{o.length_mm} is no length in mm",
         "give for example 60"),
        (o.predict_force is not None and not o.predict_area, "--predict-force", "does nothing without --predict-area",
         "give it too"),
        (o.predict_area is not None and (o.profile is not None or SLOPE in free), "--predict-area",
         "and a radius of flexion do not go together: its flexion is not known", "give --radius-mm"),
        bootstrap_rule(o.bootstrap, 1000),
        (o.lag is not None and not np.isfinite(o.lag), "--lag", f"{o.lag} is not a time", "give seconds"),
        (o.calibrate is not None and o.threshold is not None, "--calibrate", "finds what --threshold gives",
         "give one"),
    )  # fmt: skip


def poisson_ratios(o: ModulusOptions) -> tuple[float, ...]:
    """Those stated."""
    ratios = tuple(quantities.number(part, "--poisson", "0.25,0.46") for part in o.poisson.split(","))
    if any(not -1.0 < ratio <= 0.5 for ratio in ratios):
        raise InputError("", "--poisson", f"{o.poisson!r} is not above -1 and at most 0.5", "write for example 0.46")
    return ratios


def inputs_given(record: Record, o: ModulusOptions) -> Inputs:
    """Read what the options name."""
    mapping = {} if o.map is None else parse_map(o.map, (*SIDES, FLEXION))
    if FLEXION in mapping and o.flexion is None:
        raise InputError("", "--map", "flexion does nothing without --flexion", "leave it out")
    table = read_area_table(o.area)
    forces = read_force_curves(o.force, o.unit, {side: mapping[side] for side in SIDES if side in mapping})
    for path in o.area:
        record.add_input("--area", path)
    record.add_input("--force", o.force, unit=forces.unit)
    sides: list[str] = [s for s in ORDER if s in table.areas and s in forces.forces]
    if not sides:
        what = f"areas of {', '.join(table.areas)}, forces of {', '.join(forces.forces)}"
        raise InputError(o.force, "", what, "they need a side in common; split the area with --split")
    flexion = _flexion(record, o, table, mapping.get(FLEXION, (1.0, FLEXION)))
    radii = _radii(record, o, table, flexion, sides)
    length = float("nan") if o.length_mm is None else o.length_mm * 1e-3
    evolutions = {
        s: ThresholdAreas(table.time, table.thresholds, table.areas[s], radii[s], length, table.tilted.get(s), flexion)
        for s in sides
    }
    reading = next(each for each in READINGS if each.name == o.reading)
    at_once = ADDUCTION in freed(o) and all(half in evolutions for half in HALVES)
    told = (BOTH,) if at_once else tuple(evolutions)
    return Inputs(table, forces, evolutions, reading, 0.0 if o.lag is None else o.lag, told)


def threshold_given(o: ModulusOptions, table: AreaTable) -> float:
    """Threshold [m] of --threshold, or the usual one."""
    if o.threshold is None:
        near = np.isclose(table.thresholds, USUAL, rtol=1e-9)
        if near.any() or len(table.thresholds) == 1:
            return float(table.thresholds[int(np.argmax(near))])
    wanted = USUAL if o.threshold is None else quantities.length(o.threshold, "--threshold")
    near = np.isclose(table.thresholds, wanted, rtol=1e-9, atol=1e-12)
    if not near.any():
        levels = ", ".join(f"{level * 1e3:g}" for level in table.thresholds)
        what = f"{wanted * 1e3:g} mm was not evaluated; {table.file} has {levels} mm"
        raise InputError("", "--threshold", what, "name one of these, or --free threshold")
    return float(table.thresholds[int(np.argmax(near))])


def model_of(
    i: Inputs, side: str, threshold: float, others: tuple[Parameter, ...]
) -> tuple[AreaForce, Float[np.ndarray, " n"]]:
    """The law of one side on the frames that area and force share at every lag that is allowed, and the force there."""
    if side == BOTH:
        halves = [model_of(i, half, threshold, others) for half in HALVES]
        return end_to_end([model for model, _ in halves], [force for _, force in halves])
    time, clock, evolution = i.table.time, i.forces.time, i.evolutions[side]
    free = next((p for p in others if p.name == LAG), None)
    low, high = (i.lag, i.lag) if free is None else (free.lower, free.upper)
    taken = i.lag if free is None else free.start
    inside = (time + taken >= clock[0]) & (time + taken <= clock[-1])
    inside &= (time + taken - high >= time[0] - 1e-12) & (time + taken - low <= time[-1] + 1e-12)
    if inside.sum() < FEWEST:
        what = f"{int(inside.sum())} frames of the area ({time[0]:g} to {time[-1]:g} s) lie in the force's time"
        remedy = f"{FEWEST} at least; are the clocks the same? see --lag"
        raise InputError(i.forces.file, "", f"{what} ({clock[0]:g} to {clock[-1]:g} s)", remedy)
    frames = time[inside]
    measured = np.interp(frames + taken, clock, i.forces.forces[side])
    return AreaForce(evolution, i.reading, frames, taken, threshold), measured


def _radii(
    record: Record, o: ModulusOptions, table: AreaTable, flexion: Float[np.ndarray, " t"] | None, sides: list[str]
) -> dict[str, Float[np.ndarray, " t"]]:
    if o.radius_mm is not None:
        return {side: np.full(len(table.time), o.radius_mm * 1e-3) for side in sides}
    if o.profile is None or flexion is None:
        raise InputError("", "--profile", "needs --flexion", "give both")
    profiles = read_radius_profile(o.profile)
    record.add_input("--profile", o.profile)
    return {side: _followed(profiles, side, flexion, o.profile) for side in sides}


def _flexion(
    record: Record, o: ModulusOptions, table: AreaTable, source: tuple[float, str]
) -> Float[np.ndarray, " t"] | None:
    """Flexion at the frames of the areas [rad]."""
    if o.flexion is None:
        return None
    sign, name = source
    motion, time = read_table(o.flexion), table.time
    values = sign * angles_of(motion, [name], o.angles)[:, 0]
    if time[0] < motion.time[0] - 1e-6 or time[-1] > motion.time[-1] + 1e-6:
        what = f"ends before the areas do ({motion.time[0]:g} to {motion.time[-1]:g} s)"
        raise InputError(o.flexion, "", what, "give the motion that the areas were computed on")
    record.add_input("--flexion", o.flexion)
    return np.asarray(np.interp(time, motion.time, values))


def _followed(
    profiles: Mapping[str, RadiusProfile], side: str, flexion: Float[np.ndarray, " t"], path: Path
) -> Float[np.ndarray, " t"]:
    """Radius at each frame, of the side's own profile or of the mean of all there are."""
    own = [profiles[side]] if side in profiles else list(profiles.values())
    low, high = max(float(p.flexion[0]) for p in own), min(float(p.flexion[-1]) for p in own)
    if flexion.min() < low - 1e-9 or flexion.max() > high + 1e-9:
        reach = f"{np.degrees(flexion.min()):.1f} to {np.degrees(flexion.max()):.1f}"
        what = f"profile from {np.degrees(low):.1f} to {np.degrees(high):.1f} degrees, flexion from {reach}"
        raise InputError(path, "", what, "extend --profile of geocontact fit; see --map flexion=-… for the sign")
    return np.asarray(np.mean([np.interp(flexion, p.flexion, p.radius) for p in own], axis=0))
