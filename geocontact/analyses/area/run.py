"""The area analysis: reads, computes, writes, says what it found."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict
from pathlib import Path

import numpy as np
import pandas as pd

from geocontact.analyses import quantities
from geocontact.analyses.area.motions import motions_given
from geocontact.analyses.area.page import FRAMES
from geocontact.analyses.area.pressure import PressureEvolution, pressure_evolution
from geocontact.analyses.area.reference_areas import Reference, compared, largest_difference, read_reference
from geocontact.analyses.area.write import Analysis, write_results
from geocontact.analyses.bodies import chosen_faces, read_body
from geocontact.analyses.progress import preparing, progress
from geocontact.analyses.results_folder import written_whole
from geocontact.analyses.run_record import Record
from geocontact.cli.area import AreaOptions
from geocontact.cli.idle import refuse_idle
from geocontact.data.errors import InputError
from geocontact.data.evolution import AreaEvolution
from geocontact.geometry.contact_area.area import Refinement
from geocontact.geometry.contact_area.evolution import FrameContact, Settings, area_evolution
from geocontact.geometry.contact_area.maps import DistanceMaps
from geocontact.geometry.contact_area.rules import REFINED
from geocontact.geometry.contact_area.warm_up import warm_up
from geocontact.geometry.surface import Surface
from geocontact.view.surfaces.vtp_series import require_pyvista

BRIEF, PATIENT = 40_000, 1_000_000  # triangles divided per area, without and with bounds asked for
TOLERANCE = "2%"
SENSITIVITY = np.linspace(0.0, 1.5, 13)  # shares of the largest threshold at which the page shows the area as well
ZERO_REACH = 1e-3  # m; what these shares are of where the threshold is zero
NEAR = 20e-3  # m; bodies that never come this close are a mistake in the input


def analyse(moving: Path, fixed: Path, more_motions: Sequence[str], o: AreaOptions) -> int:
    """Run the whole analysis; exit code 1 when a comparison is beyond its tolerance, else 0."""
    record = Record("area", {"moving": moving, "fixed": fixed, **asdict(o), "more_motions": list(more_motions)})
    tolerance = quantities.fraction(TOLERANCE if o.tolerance is None else o.tolerance, "--tolerance")
    reference = None if o.compare is None else Reference(o.compare, read_reference(o.compare), tolerance)
    if reference is not None:
        record.add_input("--compare", reference.path)
    files = [*(o.motion or []), *more_motions]
    refuse_idle(o, files)
    within = True
    if o.paraview:
        require_pyvista()
    with record.catching_warnings(), written_whole(o.out) as draft:
        settings_of = _settings(record, o)
        bodies = (
            read_body(record, "moving", moving, o.unit, o.place_moving, o.assume_closed in ("moving", "both")),
            read_body(record, "fixed", fixed, o.unit, o.place_fixed, o.assume_closed in ("fixed", "both")),
        )
        settings = settings_of(*bodies)
        motions = motions_given(record, o, files, bodies[0])
        with preparing():
            warm_up()
        shared = len(record.warnings)
        for name, motion in motions:
            before = len(record.warnings)
            folder = draft / name
            folder.mkdir(exist_ok=True)
            analysis = Analysis(*bodies, motion, settings, o, name)
            evolution, maps = _evaluated(record, analysis)
            pressure = _pressures(record, analysis, maps) if o.pressure else None
            comparison = None if reference is None else _compared(record, evolution, reference)
            if reference is not None and comparison is not None:
                within &= reference.accepts(comparison)
            reservations = record.warnings[:shared] + record.warnings[before:]
            write_results(record, analysis, evolution, maps, comparison, pressure, reservations, folder)
        record.write(draft, *(draft / name for name, _ in motions))
        written = sorted(str(file.relative_to(draft)) for file in draft.rglob("*") if file.is_file())
    record.say(f"results in {o.out}: {', '.join(written)}")
    record.speak()
    return 0 if within else 1


def _settings(record: Record, o: AreaOptions) -> Callable[[Surface, Surface], Settings]:
    """Settings as far as the command line gives them, before any file is read; the bodies complete them."""
    thresholds = quantities.thresholds(o.threshold)
    bounds = None if o.bounds is None else quantities.fraction(o.bounds, "--bounds")
    split = None if o.split is None else quantities.splitting_plane(o.split, o.unit)

    def completed(moving: Surface, fixed: Surface) -> Settings:
        return Settings(
            thresholds=thresholds,
            rule=o.rule,
            refinement=Refinement(pieces=BRIEF) if bounds is None else Refinement(bounds=bounds, pieces=PATIENT),
            fixed_faces=chosen_faces(record, "--region", o.region, fixed, o.unit),
            moving_faces=chosen_faces(record, "--region-moving", o.region_moving, moving, o.unit),
            split=split,
            medial_side=1 if o.medial == "+" else -1,
            sensitivity=tuple((max(thresholds) or ZERO_REACH) * SENSITIVITY),
        )

    return completed


def _evaluated(record: Record, a: Analysis) -> tuple[AreaEvolution, DistanceMaps]:
    o = a.options
    maps = DistanceMaps(a.moving, a.fixed, every=1 if o.save_map or o.paraview else -(-len(a.motion) // FRAMES))
    with progress(a.name or "frames", len(a.motion)) as step:

        def each(frame: int, contact: FrameContact) -> None:
            maps.add(frame, contact)
            step()

        evolution = area_evolution(a.moving, a.fixed, a.motion, a.settings, o.workers, each)
    _refuse_strangers(evolution, o)
    _warn_of_doubts(record, evolution, a.settings, o.bounds is not None)
    _summarise(record, evolution, a.name)
    return evolution, maps


def _pressures(record: Record, a: Analysis, maps: DistanceMaps) -> PressureEvolution:
    """Loads of all frames; maps of the frames whose distances are kept."""
    return pressure_evolution(record, a.moving, a.fixed, a.motion, a.settings, a.options, maps.frames, a.name)


def _refuse_strangers(evolution: AreaEvolution, o: AreaOptions) -> None:
    closest = float(evolution.min_distance.min())
    if closest > NEAR:
        remedy = "wrong direction? try --moving parent" if o.osim else "check unit, frames and direction"
        if o.osim and o.moving_body == "parent":
            remedy = "wrong direction? try --moving child"
        raise InputError("", "", f"bodies are {closest * 1e3:.0f} mm apart in every frame", remedy)


def _warn_of_doubts(record: Record, e: AreaEvolution, settings: Settings, asked: bool) -> None:
    if e.undecided.any():
        worst = int(e.undecided.max())
        record.warn(f"up to {worst} points per frame have no side (winding number near 0.5); they count as outside")
    wanted = settings.refinement.bounds
    if settings.rule == REFINED or asked:
        for side, name in ((e.fixed, "area_fixed"), (e.moving, "area_moving")):
            with np.errstate(invalid="ignore"):
                width = np.nan_to_num((side.upper - side.lower) / side.upper)
            if (width > wanted).any():
                record.warn(f"bounds of {name} stay {width.max():.1%} apart in the worst frame; asked for {wanted:.1%}")


def _summarise(record: Record, e: AreaEvolution, name: str) -> None:
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
        record.say(f"{label}area of FIXED within {threshold * 1e3:g} mm: {areas.min():.1f} … {areas.max():.1f} mm^2")
    record.results[name or "motion"] = lines


def _compared(record: Record, evolution: AreaEvolution, reference: Reference) -> pd.DataFrame:
    rows = compared(evolution.table(), reference.table, reference.path)
    worst = largest_difference(rows)
    record.say(rows.to_string(index=False, max_rows=40))
    verdict = "within" if reference.accepts(rows) else "beyond"
    record.say(f"largest relative difference {worst:.2%}, {verdict} the tolerance of {reference.tolerance:.2%}")
    return rows
