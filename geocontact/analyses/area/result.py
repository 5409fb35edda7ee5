"""The area analysis, and the same analysis called for its pressures.

>>> import geocontact as gc
>>> femoral, insert = "meshes/femoral_component_right_coarse.stl", "meshes/tibial_insert_right_coarse.stl"
>>> result = gc.area(femoral, insert, unit="mm", motion="meshes/gait.csv", threshold=gc.mm(4), rule="clip")
>>> print(result)
area of FIXED within 4 mm: 1773.3 … 2484.0 mm^2
least distance -0.047 mm in frame 55 of 101, 0.54 s (signed: negative is overlap)
>>> result.table()[["time [s]", "area_fixed [mm^2]"]].head(2).round(2)
   time [s]  area_fixed [mm^2]
0      0.00            2397.72
1      0.01            2396.87

>>> import geocontact as gc
>>> femoral, insert = "meshes/femoral_component_right_coarse.stl", "meshes/tibial_insert_right_coarse.stl"
>>> layer = {"modulus": gc.MPa(500), "poisson": 0.46, "piece": gc.mm(1)}
>>> result = gc.pressure(femoral, insert, unit="mm", motion="meshes/gait.csv", rule="clip", **layer)
>>> result.sentences[-1]
'linear foundation: force up to 47.5 N, pressure up to 8.00 MPa'
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.area.bodies import Bodies, Reference, read
from geocontact.analyses.area.contact import (
    MotionResult,
    congruence_of,
    pressure_error_of,
    pressures_of,
    tables_of,
)
from geocontact.analyses.area.cycles import area_trials
from geocontact.analyses.area.goodness import goodness_of_areas
from geocontact.analyses.area.literature import beside_literature
from geocontact.analyses.area.motion_outputs import figure_of, page_of, pressure_figure_of, write_further
from geocontact.analyses.area.options import AreaOptions, PressureOptions
from geocontact.analyses.area.page import FRAMES
from geocontact.analyses.area.separation import (
    least_distance,
    refuse_far_apart,
    say_inner_area,
    warn_of_lift_off,
    warn_of_no_contact,
    warn_of_overlap,
)
from geocontact.analyses.frame.collector import current, judge, listener, note, reserve, say
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.pages import Thinned
from geocontact.analyses.frame.result import REPORT, Result
from geocontact.analyses.motion.styles import Trials, cycle_tables
from geocontact.data.evolution import MM2, AreaEvolution
from geocontact.data.motion import Motion
from geocontact.geometry.contact_area.area import REFINED
from geocontact.geometry.contact_area.comparison import compared, largest_difference
from geocontact.geometry.contact_area.evolution import FrameContact, Settings, area_evolution
from geocontact.geometry.contact_area.maps import DistanceMaps
from geocontact.geometry.contact_area.pose_error import ENDS, AreaUncertainty, area_uncertainty
from geocontact.loads.pressure_evolution import PressureEvolution

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class AreaResult(Result):
    """Contact of two bodies over one motion or several.

    Parameters
    ----------
    bodies
        The bodies and how their contact was counted.
    motions
        What was found over each motion.
    notes
        What is to be said of the pictures of a motion, by its name, once they are drawn.
    trials
        Quantities over the gait cycles of all motions; empty without events.
    """

    options: AreaOptions
    bodies: Bodies
    motions: tuple[MotionResult, ...]
    notes: dict[str, list[str]] = field(default_factory=dict)
    trials: Trials = field(default_factory=dict)

    @property
    def accepted(self) -> bool:
        """False where a difference to measured areas is beyond the tolerance."""
        reference = self.bodies.reference
        return reference is None or all(
            reference.accepts(one.comparison) for one in self.motions if one.comparison is not None
        )

    @property
    def folders(self) -> tuple[str, ...]:
        """The folder itself, and one for each of several motions."""
        return ("", *(one.name for one in self.motions if one.name))

    @property
    def title(self) -> str:
        """The bodies."""
        return self.bodies.title

    @property
    def time(self) -> Float[np.ndarray, " t"]:
        """Time of the frames [s]."""
        return self._motion.evolution.time

    @property
    def thresholds(self) -> Float[np.ndarray, " k"]:
        """Largest distance that counts as contact [m]."""
        return np.asarray(self._motion.evolution.thresholds)

    @property
    def area(self) -> Float[np.ndarray, "t k"]:
        """Contact area of FIXED in every frame within each threshold [m^2]."""
        return self._motion.evolution.fixed.area

    @property
    def area_moving(self) -> Float[np.ndarray, "t k"]:
        """The same of MOVING [m^2]."""
        return self._motion.evolution.moving.area

    @property
    def min_distance(self) -> Float[np.ndarray, " t"]:
        """Smallest distance of the bodies in every frame [m]; negative where they overlap."""
        return self._motion.evolution.min_distance

    @property
    def force(self) -> Float[np.ndarray, " t"]:
        """Force on the layer in every frame, by `pressure` [N]."""
        return np.array([load.pressing for load in self._loads.loads])

    @property
    def pressure(self) -> Float[np.ndarray, " t"]:
        """Largest contact pressure in every frame, by `pressure` [Pa]."""
        return np.array([load.peak for load in self._loads.loads])

    @property
    def _motion(self) -> MotionResult:
        """The one motion; ValueError where there are several, each of which has its own numbers."""
        if len(self.motions) > 1:
            names = ", ".join(one.name for one in self.motions)
            raise ValueError(f"there are {len(self.motions)} motions ({names}): take `motions[0].evolution` and so on")
        return self.motions[0]

    @property
    def _loads(self) -> PressureEvolution:
        """Loads on the layer; ValueError where none were asked for."""
        loads = self._motion.pressure
        if loads is None:
            raise ValueError("there are no loads: call `gc.pressure`, or give `modulus` and `poisson`")
        return loads

    def tables(self) -> dict[str, pd.DataFrame]:
        """`area`, `pressure`, `comparison` and `literature`; of several motions "name/area" and so on.

        The main table is `pressure` where the analysis was called for that.
        """
        found = {
            _named(one, name): table
            for one in self.motions
            for name, table in tables_of(self.bodies, one, self.options).items()
        }
        if self.trials:
            found |= cycle_tables(self.trials)
        if not isinstance(self.options, PressureOptions):
            return found
        return dict(sorted(found.items(), key=lambda item: not item[0].endswith("pressure")))

    def figure(self) -> Figure:
        """Areas and separation, or force and pressure where the analysis was called for that; of the first motion."""
        one = self.motions[0]
        if one.pressure is not None and isinstance(self.options, PressureOptions):
            return pressure_figure_of(self.bodies, one, one.pressure)
        return figure_of(self.bodies, one)

    def figures(self) -> dict[str, Figure]:
        """`area` of each motion, and `pressure` where it was asked for."""
        found = {}
        for one in self.motions:
            found[_named(one, "area")] = figure_of(self.bodies, one)
            if one.pressure is not None:
                found[_named(one, "pressure")] = pressure_figure_of(self.bodies, one, one.pressure)
        return found

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Thinned]:
        """Bodies, curves and numbers of each motion over time."""
        return {_named(one, REPORT): page_of(self.bodies, one) for one in self.motions}

    def reservations(self, folder: str) -> tuple[str, ...]:
        """Those of one motion, and what is to be said of its pictures."""
        own = {one.name: one.reservations for one in self.motions}
        return (*own[folder], *self.notes.get(folder, ()))

    def write_files(self, folder: Path) -> None:
        """Maps, series for ParaView, models for other programs, stills and loads for OpenSim, as asked for."""
        for one in self.motions:
            self.notes[one.name] = write_further(self.options, self.bodies, one, folder / one.name)
            for line in self.notes[one.name]:
                reserve(line)
        super().write_files(folder)


def _named(one: MotionResult, file: str) -> str:
    """A file of one motion, in the sub-folder that it has among several."""
    return f"{one.name}/{file}" if one.name else file


def run(bodies: Bodies, o: AreaOptions) -> AreaResult:
    """Every motion after the other."""
    shared = tuple(current().warnings)
    with listener().preparing():  # kernels are compiled where the first frame that needs them calls them
        motions = tuple(over_motion(bodies, o, name, motion, shared) for name, motion in bodies.motions)
    trials = {} if bodies.cutting is None else area_trials(bodies.cutting, motions, bodies.stems)
    return AreaResult(options=o, bodies=bodies, motions=motions, trials=trials)


def over_motion(bodies: Bodies, o: AreaOptions, name: str, motion: Motion, shared: tuple[str, ...]) -> MotionResult:
    """One motion; `shared` are the reservations that hold for all of them."""
    before = len(current().warnings)
    evolution, maps = _evaluated(bodies, o, name, motion)
    pressure, wear = pressures_of(bodies, o, name, motion, maps.frames) if o.pressure else (None, None)
    say_inner_area(bodies, o, name, motion, evolution)
    comparison = None if bodies.reference is None else _compared(evolution, bodies.reference)
    uncertainty = _uncertain(bodies, o, name, motion, evolution)
    alike = None if o.congruence is None else congruence_of(bodies, o.congruence, name, motion)
    pressed = pressure_error_of(bodies, o, name, motion, pressure)
    published = None
    if bodies.flexions is not None:
        published = beside_literature(bodies.flexions, motion, evolution, pressure, name)
    reservations = (*shared, *current().warnings[before:])
    return MotionResult(
        name, motion, evolution, maps, pressure, comparison, uncertainty, alike, reservations, published, pressed, wear
    )


def _evaluated(bodies: Bodies, o: AreaOptions, name: str, motion: Motion) -> tuple[AreaEvolution, DistanceMaps]:
    every = 1 if o.save_map or o.paraview else -(-len(motion) // FRAMES)
    maps = DistanceMaps(bodies.moving, bodies.fixed, every)
    with listener().progress(name or "frames", len(motion)) as step:

        def each(frame: int, contact: FrameContact) -> None:
            maps.add(frame, contact)
            step()

        evolution = area_evolution(bodies.moving, bodies.fixed, motion, bodies.settings, o.workers, each)
    refuse_far_apart(evolution, motion, o)
    warn_of_no_contact(evolution, motion, name)
    warn_of_lift_off(evolution, motion, name)
    warn_of_overlap(evolution, motion, name)
    _warn_of_doubts(evolution, bodies.settings, o.bounds is not None)
    _judge(bodies, evolution, name)
    _summarise(evolution, name)
    say(least_distance(evolution, motion, name))
    return evolution, maps


def _judge(bodies: Bodies, e: AreaEvolution, name: str) -> None:
    """A doubt where an area is that of all faces that count."""
    s = bodies.settings
    sides = (
        ("FIXED", bodies.fixed, s.fixed_faces, e.fixed.area),
        ("MOVING", bodies.moving, s.moving_faces, e.moving.area),
    )
    judge(goodness_of_areas(name, sides, np.asarray(e.thresholds)))


def _uncertain(
    bodies: Bodies, o: AreaOptions, name: str, motion: Motion, evolution: AreaEvolution
) -> AreaUncertainty | None:
    if bodies.error is None:
        return None
    with listener().progress(f"{name or 'frames'}, error of the pose", len(motion)) as step:
        found = area_uncertainty(
            bodies.moving, bodies.fixed, motion, bodies.settings, evolution, bodies.error, o.workers, step
        )
    summary: dict[str, object] = {}
    note(f"{name} pose_error".lstrip(), summary)
    for k, threshold in enumerate(evolution.thresholds):
        lower, upper = found.interval(k) * MM2
        odd = sum(found.verdict(frame, k) != "yes" for frame in range(len(motion)))
        peak = np.quantile(found.drawn(k).max(axis=0), ENDS) * MM2
        known = found.deviation(k) * MM2
        worst = int(np.argmax(known[0]))
        summary[f"at_{threshold * 1e3:g}_mm"] = {
            "draws": len(bodies.error.draws),
            "widest_interval_mm2": round(float((upper - lower).max()), 3),
            "largest_area_ci95_mm2": [round(float(end), 3) for end in peak],
            "largest_sd_mm2": round(float(known[0, worst]), 3),
            "largest_sd_ci95_mm2": [round(float(end), 3) for end in known[1:, worst]],
            "frames_where_first_order_disagrees": odd,
        }
        say(
            f"error of the pose: largest area within {threshold * 1e3:g} mm is {peak[0]:.1f} … {peak[1]:.1f} mm^2 "
            f"(95 %); first order agrees with the draws in {len(motion) - odd} of {len(motion)} frames"
        )
        say(
            f"largest standard deviation of the area {known[0, worst]:.3g} mm^2, in frame {worst + 1} of "
            f"{len(motion)}: {len(bodies.error.draws)} draws give {known[1, worst]:.3g} … {known[2, worst]:.3g} mm^2 "
            "(95 %)"
        )
        if odd:
            reserve(
                f"first order and draws of the pose disagree in {odd} frames at {threshold * 1e3:g} mm: "
                "trust the draws there (column agree of pose_error.csv)"
            )
    return found


def _warn_of_doubts(e: AreaEvolution, settings: Settings, asked: bool) -> None:
    if e.undecided.any():
        worst = int(e.undecided.max())
        reserve(f"up to {worst} points per frame have no side (winding number near 0.5); they count as outside")
    wanted = settings.refinement.bounds
    if settings.rule == REFINED or asked:
        for side, name in ((e.fixed, "area_fixed"), (e.moving, "area_moving")):
            with np.errstate(invalid="ignore"):
                width = np.nan_to_num((side.upper - side.lower) / side.upper)
            if (width > wanted).any():
                line = f"bounds of {name} stay {width.max():.1%} apart in the worst frame; asked for {wanted:.1%}"
                reserve(line if asked else f"{line} (`bounds` {wanted:.0%} divides triangles longer)")


def _summarise(e: AreaEvolution, name: str) -> None:
    lines: dict[str, object] = {
        "frames": len(e.time),
        "signed": e.signed,
        "min_distance_mm": round(float(e.min_distance.min()) * 1e3, 6),
    }
    for k, threshold in enumerate(e.thresholds):
        areas = e.fixed.area[:, k] * 1e6
        lines[f"area_fixed_mm2_at_{threshold * 1e3:g}_mm"] = [
            round(float(areas.min()), 3),
            round(float(areas.max()), 3),
        ]
        label = f"{name}: " if name else ""
        said = f"{label}area of FIXED within {threshold * 1e3:g} mm: {areas.min():.1f} … {areas.max():.1f} mm^2"
        if e.fixed.coverage is not None and e.fixed.region is not None:
            low, high = (float(end) for end in (e.fixed.coverage[:, k].min(), e.fixed.coverage[:, k].max()))
            lines[f"coverage_fixed_at_{threshold * 1e3:g}_mm"] = [round(low, 6), round(high, 6)]
            said += f", {low:.1%} … {high:.1%} of the {e.fixed.region * MM2:.1f} mm^2 of `region`"
        say(said)
    note(name or "motion", lines)


def _compared(evolution: AreaEvolution, reference: Reference) -> pd.DataFrame:
    rows = compared(evolution.table(), reference.table, reference.path)
    worst = largest_difference(rows)
    say(rows.to_string(index=False, max_rows=40))
    verdict = "within" if reference.accepts(rows) else "beyond"
    say(f"largest relative difference {worst:.2%}, {verdict} the tolerance of {reference.tolerance:.2%}")
    return rows


area = Job("area", AreaOptions, read, run)
pressure = Job("area", PressureOptions, read, run)
