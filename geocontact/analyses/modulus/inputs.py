"""Areas and forces as they are read, the numbers that are free, and the model of one side."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.analyses.frame.collector import add_input, reserve
from geocontact.analyses.modulus.options import ModulusOptions
from geocontact.contact.area_hertz import READINGS, Reading
from geocontact.data.errors import InputError
from geocontact.data.parameter import Parameter
from geocontact.elastic_modulus.area_force import (
    ADDUCTION,
    LAG,
    SLOPE,
    THRESHOLD,
    WORK,
    Adhesion,
    AreaForce,
    ThresholdAreas,
)
from geocontact.elastic_modulus.identify import end_to_end
from geocontact.elastic_modulus.prediction import shared_frames
from geocontact.io.recordings.area_table import (
    FEWEST,
    SIDES,
    AreaTable,
    ForceCurves,
    RadiusProfile,
    read_area_over_force,
    read_area_table,
    read_force_curves,
    read_radius_profile,
)
from geocontact.io.recordings.pose_draws import PoseDraws, read_pose_draws
from geocontact.io.text.columns import angles_of, parse_map
from geocontact.io.text.tables import read_table
from geocontact.trial_checks.twice import same_recordings

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
    draws: PoseDraws | None = None


def read(o: ModulusOptions) -> ModulusInputs:
    """Everything the options name."""
    mapping = {} if o.map is None else parse_map(o.map, (*SIDES, FLEXION))
    if FLEXION in mapping and o.flexion is None:
        raise InputError("", "`map`", "flexion has no effect without `flexion`", "leave it out")
    table, forces = _areas("`area`", o.area), _forces("`force`", o.force, o, mapping)
    evolutions = _evolutions(o, table, forces, mapping.get(FLEXION, (1.0, FLEXION)))
    reading = next(each for each in READINGS if each.name == o.reading)
    at_once = ADDUCTION in (o.free or {}) and all(half in evolutions for half in HALVES)
    sides = (BOTH,) if at_once else tuple(evolutions)
    measured = _measured_areas(o, table)
    lag = 0.0 if o.lag is None else o.lag
    given = STICKY if o.work_of_adhesion is None else o.work_of_adhesion
    sticks = None if o.adhesion is None else Adhesion(o.adhesion, given)
    other, draws = _other(o, table, mapping), _draws(o, table, sides)
    return ModulusInputs(table, forces, evolutions, reading, lag, sticks, sides, measured, other, draws)


def _draws(o: ModulusOptions, table: AreaTable, sides: tuple[str, ...]) -> PoseDraws | None:
    """Areas of drawn poses, in the frames and within the thresholds of the table."""
    if o.pose_draws is None:
        return None
    found = read_pose_draws(o.pose_draws)
    add_input("`pose_draws`", o.pose_draws, draws=found.area.shape[2])
    alike = (
        len(a) == len(b) and np.allclose(a, b)
        for a, b in ((found.time, table.time), (found.thresholds, table.thresholds))
    )
    if not all(alike):
        what = "has other frames or thresholds than the areas"
        raise InputError(o.pose_draws, "", what, "give that of the same run")
    if "total" not in sides:
        raise InputError(o.pose_draws, "", "is of the total, which is not identified", "give the total force")
    return found


def _areas(role: str, paths: tuple[Path, ...]) -> AreaTable:
    table = read_area_table(paths)
    for path in paths:
        add_input(role, path)
    return table


def _forces(role: str, path: Path, o: ModulusOptions, mapping: Mapping[str, tuple[float, str]]) -> ForceCurves:
    forces = read_force_curves(path, o.unit, {side: mapping[side] for side in SIDES if side in mapping})
    add_input(role, path, unit=forces.unit)
    return forces


def _evolutions(
    o: ModulusOptions, table: AreaTable, forces: ForceCurves, source: tuple[float, str]
) -> dict[str, ThresholdAreas]:
    """Areas of every side that has forces, with the radius at each frame."""
    sides = [side for side in ORDER if side in table.areas and side in forces.forces]
    if not sides:
        what = f"areas of {', '.join(table.areas)}, forces of {', '.join(forces.forces)}"
        raise InputError(o.force, "", what, "they need a side in common; `split` the area")
    flexion = _flexion(o, table, source)
    radii = _radii(o, table, flexion, sides)
    length = float("nan") if o.length is None else o.length
    return {
        s: ThresholdAreas(table.time, table.thresholds, table.areas[s], radii[s], length, table.tilted.get(s), flexion)
        for s in sides
    }


def _measured_areas(o: ModulusOptions, table: AreaTable) -> MeasuredAreas | None:
    if o.calibrate is None:
        return None
    if len(table.thresholds) < 3:
        what, remedy = "calibrating needs areas at 3 thresholds or more", "see `threshold` of geocontact area"
        raise InputError(o.calibrate, "", what, remedy)
    add_input("`calibrate`", o.calibrate)
    force, area = read_area_over_force(o.calibrate)
    low, high = int(np.argmin(force)), int(np.argmax(force))
    if area[high] < area[low]:
        what = f"its area falls from {1e6 * area[low]:.0f} to {1e6 * area[high]:.0f} mm² while the force grows from"
        reserve(
            f"{o.calibrate}: {what} {force[low]:.0f} to {force[high]:.0f} N: does each area stand beside its force?"
        )
    return force, area


def _other(o: ModulusOptions, used: AreaTable, mapping: Mapping[str, tuple[float, str]]) -> OtherTrial | None:
    if not o.predict_area:
        return None
    table = _areas("`predict_area`", o.predict_area)
    if same_recordings({"used": used.areas["total"], "other": table.areas["total"]}):
        reserve(
            f"{table.file}: `predict_area` has the areas of `area`, sample by sample: name those of the other trial"
        )
    if o.predict_force is None:
        return OtherTrial(table, None)
    return OtherTrial(table, _forces("`predict_force`", o.predict_force, o, mapping))


def _radii(
    o: ModulusOptions, table: AreaTable, flexion: Float[np.ndarray, " t"] | None, sides: list[str]
) -> dict[str, Float[np.ndarray, " t"]]:
    if o.profile is None or flexion is None:
        return {side: np.full(len(table.time), o.radius) for side in sides}
    profiles = read_radius_profile(o.profile)
    add_input("`profile`", o.profile)
    return {side: _followed(profiles, side, flexion, o.profile) for side in sides}


def _flexion(o: ModulusOptions, table: AreaTable, source: tuple[float, str]) -> Float[np.ndarray, " t"] | None:
    """Flexion at the frames of the areas [rad]."""
    if o.flexion is None:
        return None
    sign, name = source
    motion, time = read_table(o.flexion), table.time
    values = sign * angles_of(motion, [name], o.angles)[:, 0]
    if time[0] < motion.time[0] - 1e-6 or time[-1] > motion.time[-1] + 1e-6:
        what = f"ends before the areas do ({motion.time[0]:g} to {motion.time[-1]:g} s)"
        raise InputError(o.flexion, "", what, "give the motion that the areas were computed on")
    add_input("`flexion`", o.flexion)
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


Bounds = tuple[float, float] | None

LAGS = 0.1  # s, how far a lag is searched by default
BENDS = 0.5  # share by which R may change at the largest flexion, by default
STRAIGHT = np.radians(1.0)  # a motion that flexes by less tells nothing of a radius that follows flexion


def unknowns(o: ModulusOptions, inputs: ModulusInputs, threshold: float) -> tuple[Parameter, ...]:
    """Free parameters besides E*, with their bounds."""
    makers = {
        THRESHOLD: lambda bounds: _threshold(bounds, inputs.table, threshold),
        LAG: lambda bounds: _lag(bounds, inputs.lag),
        ADDUCTION: lambda bounds: _adduction(bounds, inputs.table),
        SLOPE: lambda bounds: _slope(bounds, inputs),
        WORK: lambda bounds: _work(bounds, inputs.adhesion),
    }
    return tuple(makers[name](bounds) for name, bounds in (o.free or {}).items())


def _threshold(bounds: Bounds, table: AreaTable, start: float) -> Parameter:
    levels = table.thresholds
    if len(levels) < 3:
        what = f"threshold needs areas at 3 thresholds or more; {table.file} has {len(levels)}"
        raise InputError("", "`free`", what, "compute them: `threshold` 1,2,3,4,5 of geocontact area")
    low, high = bounds or (float(levels[0]), float(levels[-1]))
    if low < levels[0] - 1e-12 or high > levels[-1] + 1e-12:
        reach = f"{levels[0] * 1e3:g} to {levels[-1] * 1e3:g} mm"
        what = f"a threshold of {low * 1e3:g} to {high * 1e3:g} mm reaches beyond the areas, {reach}"
        raise InputError("", "`free`", what, "compute areas at more thresholds")
    return Parameter(THRESHOLD, "m", float(np.clip(start, low, high)), low, high)


def _lag(bounds: Bounds, start: float) -> Parameter:
    low, high = bounds or (start - LAGS, start + LAGS)
    return Parameter(LAG, "s", float(np.clip(start, low, high)), low, high)


def _adduction(bounds: Bounds, table: AreaTable) -> Parameter:
    """A table of areas alone does not say what another pose would give: areas at other poses do."""
    known = next(iter(table.tilted.values())).offsets if table.tilted else np.zeros(1)
    if len(known) < 3:
        what = f"adduction needs areas at 3 offsets of it or more; {table.file} has {len(known)}"
        raise InputError("", "`free`", what, "compute them: `adduction` x=-2 and x=2 of geocontact area, besides none")
    low, high = bounds or (float(known[0]), float(known[-1]))
    if low < known[0] - 1e-9 or high > known[-1] + 1e-9:
        asked, reach = (f"{np.degrees(a):g} to {np.degrees(b):g} degrees" for a, b in ((low, high), known[[0, -1]]))
        what = f"an adduction of {asked} reaches beyond the areas, {reach}"
        raise InputError("", "`free`", what, "compute areas at more offsets")
    return Parameter(ADDUCTION, "rad", float(np.clip(0.0, low, high)), low, high)


def _slope(bounds: Bounds, inputs: ModulusInputs) -> Parameter:
    flexion = next(iter(inputs.evolutions.values())).flexion
    if flexion is None:
        raise InputError("", "`free`", "slope needs `flexion`", "give the motion of the areas")
    largest = float(np.abs(flexion).max())
    if largest < STRAIGHT:
        raise InputError("", "`free`", "slope: flexion stays below 1 degree", "leave it out; see `map` flexion=…")
    low, high = bounds or (-BENDS / largest, BENDS / largest)
    if min((1.0 + end * flexion).min() for end in (low, high)) <= 0.0:
        what = f"a slope of {low:g} to {high:g} per rad: the radius would vanish at"
        what += f" {np.degrees(largest):.0f} degrees of flexion"
        raise InputError("", "`free`", what, f"stay within {1.0 / largest:.3g} per rad")
    return Parameter(SLOPE, "1/rad", float(np.clip(0.0, low, high)), low, high)


STICKY = 0.05
"""J/m^2, of polymers and tissues (0.02 to 0.1): where the search for a work of adhesion begins unless one is given."""
WORKS = 1e-6, 1e3
"""J/m^2, between which it is searched unless bounds are given."""


def _work(bounds: Bounds, sticks: Adhesion | None) -> Parameter:
    if sticks is None:
        raise InputError("", "`free`", "work needs `adhesion`", "say which law")
    low, high = bounds or WORKS
    return Parameter(WORK, "J/m^2", float(np.clip(sticks.work, low, high)), low, high)


USUAL = 4.0e-3  # m, the threshold of the knee-implant paper


def threshold_given(o: ModulusOptions, table: AreaTable) -> float:
    """Threshold [m] as given, or the usual one."""
    if o.threshold is None:
        near = np.isclose(table.thresholds, USUAL, rtol=1e-9)
        if near.any() or len(table.thresholds) == 1:
            return float(table.thresholds[int(np.argmax(near))])
    wanted = USUAL if o.threshold is None else o.threshold
    near = np.isclose(table.thresholds, wanted, rtol=1e-9, atol=1e-12)
    if not near.any():
        levels = ", ".join(f"{level * 1e3:g}" for level in table.thresholds)
        what = f"{wanted * 1e3:g} mm was not evaluated; {table.file} has {levels} mm"
        raise InputError("", "`threshold`", what, "name one of these, or `free` threshold")
    return float(table.thresholds[int(np.argmax(near))])


def model_of(
    i: ModulusInputs, side: str, threshold: float, others: tuple[Parameter, ...]
) -> tuple[AreaForce, Float[np.ndarray, " n"]]:
    """The law of one side on the frames that area and force share at every lag that is allowed, and the force there."""
    if side == BOTH:
        halves = [model_of(i, half, threshold, others) for half in HALVES]
        return end_to_end([model for model, _ in halves], [force for _, force in halves])
    time, clock, evolution = i.table.time, i.forces.time, i.evolutions[side]
    free = next((p for p in others if p.name == LAG), None)
    low, high = (i.lag, i.lag) if free is None else (free.lower, free.upper)
    taken = i.lag if free is None else free.start
    inside = shared_frames(time, clock, taken, (low, high))
    if inside.sum() < FEWEST:
        what = f"{int(inside.sum())} frames of the area ({time[0]:g} to {time[-1]:g} s) lie in the force's time"
        remedy = f"{FEWEST} at least; are the clocks the same? see `lag`"
        raise InputError(i.forces.file, "", f"{what} ({clock[0]:g} to {clock[-1]:g} s)", remedy)
    frames = time[inside]
    measured = np.interp(frames + taken, clock, i.forces.forces[side])
    return AreaForce(evolution, i.reading, frames, taken, threshold, i.adhesion), measured
