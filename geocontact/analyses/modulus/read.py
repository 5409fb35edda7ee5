"""What an identification starts from: areas, forces, radius, and a trial to predict, as the options name them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.analyses.modulus.options import ModulusOptions
from geocontact.analyses.run_record import Record
from geocontact.contact.area_hertz import READINGS, Reading
from geocontact.data.errors import InputError
from geocontact.elastic_modulus.area_force import ADDUCTION, Adhesion, ThresholdAreas
from geocontact.io.recordings.area_table import AreaTable, read_area_over_force, read_area_table
from geocontact.io.recordings.force_curves import SIDES, ForceCurves, read_force_curves
from geocontact.io.recordings.radius_profile import RadiusProfile, read_radius_profile
from geocontact.io.text.columns import angles_of, parse_map
from geocontact.io.text.tables import read_table

FLEXION = "flexion"
ORDER = ("total", "medial", "lateral")
BOTH, HALVES = "both", ("medial", "lateral")
"""Side that stands for the two halves met at once, as a free adduction asks for."""

MeasuredAreas = tuple[Float[np.ndarray, " m"], Float[np.ndarray, " m"]]
"""Forces [N] and areas [m^2]."""


@dataclass(frozen=True, eq=False)
class OtherTrial:
    """Areas of a trial that was not used, and its forces where they are known."""

    table: AreaTable
    forces: ForceCurves | None


@dataclass(frozen=True, eq=False)
class ModulusInputs:
    """Everything read; `evolutions` by side, as far as areas and forces have it; `lag` as given [s].

    `sides` are those to be identified: every evolution, or both halves at once.
    """

    table: AreaTable
    forces: ForceCurves
    evolutions: Mapping[str, ThresholdAreas]
    reading: Reading
    lag: float
    adhesion: Adhesion | None
    sides: tuple[str, ...]
    measured_areas: MeasuredAreas | None
    other: OtherTrial | None


def read(o: ModulusOptions, record: Record) -> ModulusInputs:
    """Everything the options name."""
    mapping = {} if o.map is None else parse_map(o.map, (*SIDES, FLEXION))
    if FLEXION in mapping and o.flexion is None:
        raise InputError("", "`map`", "flexion has no effect without `flexion`", "leave it out")
    table, forces = _areas(record, "`area`", o.area), _forces(record, "`force`", o.force, o, mapping)
    evolutions = _evolutions(record, o, table, forces, mapping.get(FLEXION, (1.0, FLEXION)))
    reading = next(each for each in READINGS if each.name == o.reading)
    at_once = ADDUCTION in (o.free or {}) and all(half in evolutions for half in HALVES)
    sides = (BOTH,) if at_once else tuple(evolutions)
    measured = _measured_areas(record, o, table)
    lag = 0.0 if o.lag is None else o.lag
    sticks = None if o.adhesion is None else Adhesion(o.adhesion, o.work_of_adhesion or 0.0)
    return ModulusInputs(table, forces, evolutions, reading, lag, sticks, sides, measured, _other(record, o, mapping))


def _areas(record: Record, role: str, paths: tuple[Path, ...]) -> AreaTable:
    table = read_area_table(paths)
    for path in paths:
        record.add_input(role, path)
    return table


def _forces(
    record: Record, role: str, path: Path, o: ModulusOptions, mapping: Mapping[str, tuple[float, str]]
) -> ForceCurves:
    forces = read_force_curves(path, o.unit, {side: mapping[side] for side in SIDES if side in mapping})
    record.add_input(role, path, unit=forces.unit)
    return forces


def _evolutions(
    record: Record, o: ModulusOptions, table: AreaTable, forces: ForceCurves, source: tuple[float, str]
) -> dict[str, ThresholdAreas]:
    """Areas of every side that has forces, with the radius at each frame."""
    sides = [side for side in ORDER if side in table.areas and side in forces.forces]
    if not sides:
        what = f"areas of {', '.join(table.areas)}, forces of {', '.join(forces.forces)}"
        raise InputError(o.force, "", what, "they need a side in common; `split` the area")
    flexion = _flexion(record, o, table, source)
    radii = _radii(record, o, table, flexion, sides)
    length = float("nan") if o.length is None else o.length
    return {
        s: ThresholdAreas(table.time, table.thresholds, table.areas[s], radii[s], length, table.tilted.get(s), flexion)
        for s in sides
    }


def _measured_areas(record: Record, o: ModulusOptions, table: AreaTable) -> MeasuredAreas | None:
    if o.calibrate is None:
        return None
    if len(table.thresholds) < 3:
        what, remedy = "calibrating needs areas at 3 thresholds or more", "see `threshold` of geocontact area"
        raise InputError(o.calibrate, "", what, remedy)
    record.add_input("`calibrate`", o.calibrate)
    return read_area_over_force(o.calibrate)


def _other(record: Record, o: ModulusOptions, mapping: Mapping[str, tuple[float, str]]) -> OtherTrial | None:
    if not o.predict_area:
        return None
    table = _areas(record, "`predict_area`", o.predict_area)
    if o.predict_force is None:
        return OtherTrial(table, None)
    return OtherTrial(table, _forces(record, "`predict_force`", o.predict_force, o, mapping))


def _radii(
    record: Record, o: ModulusOptions, table: AreaTable, flexion: Float[np.ndarray, " t"] | None, sides: list[str]
) -> dict[str, Float[np.ndarray, " t"]]:
    if o.profile is None or flexion is None:
        return {side: np.full(len(table.time), o.radius) for side in sides}
    profiles = read_radius_profile(o.profile)
    record.add_input("`profile`", o.profile)
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
    record.add_input("`flexion`", o.flexion)
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
        raise InputError(path, "", what, "extend `profile` of geocontact fit; see `map` flexion=-… for the sign")
    return np.asarray(np.mean([np.interp(flexion, p.flexion, p.radius) for p in own], axis=0))
