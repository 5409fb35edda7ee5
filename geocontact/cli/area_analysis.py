"""The area analysis: reads, computes, writes, says what it found."""

from __future__ import annotations

import glob
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from geocontact.cli import quantities
from geocontact.cli.area import AreaOptions
from geocontact.cli.bodies import chosen_faces, read_body
from geocontact.cli.comparison import compared, read_reference
from geocontact.cli.maps import DistanceMaps
from geocontact.cli.output import written_whole
from geocontact.cli.patience import preparing, progress
from geocontact.cli.record import Record
from geocontact.data.errors import InputError
from geocontact.data.evolution import AreaEvolution
from geocontact.data.motion import Motion
from geocontact.geometry.area import Refinement
from geocontact.geometry.cylinder import fit_cylinder
from geocontact.geometry.evolution import FrameContact, Settings, area_evolution
from geocontact.geometry.rules import REFINED
from geocontact.geometry.surface import Surface
from geocontact.geometry.sweep import Axis
from geocontact.geometry.sweep import sweep as swept
from geocontact.geometry.warm_up import warm_up
from geocontact.io.motion import read_motion
from geocontact.io.results import write_table
from geocontact.view.area_figure import draw_areas

BRIEF, PATIENT = 40_000, 1_000_000  # triangles divided per area, without and with bounds asked for
NEAR = 20e-3  # m; bodies that never come this close are a mistake in the input


@dataclass(frozen=True)
class Analysis:
    """One motion of two bodies and how it is to be counted."""

    moving: Surface
    fixed: Surface
    motion: Motion
    settings: Settings
    options: AreaOptions
    name: str


def analyse(moving: Path, fixed: Path, more_motions: Sequence[str], o: AreaOptions) -> int:
    """Run the whole analysis; exit code 1 when a comparison is beyond its tolerance, else 0."""
    record = Record("area", {"moving": moving, "fixed": fixed, **asdict(o), "more_motions": list(more_motions)})
    reference = None if o.compare is None else read_reference(o.compare)
    tolerance = quantities.fraction(o.tolerance, "--tolerance")
    if o.compare is not None:
        record.add_input("--compare", o.compare)
    _refuse_idle(o)
    within = True
    with record.catching_warnings(), written_whole(o.out) as draft:
        settings_of = _settings(record, o)
        bodies = (
            read_body(record, "moving", moving, o.unit, o.place_moving, o.assume_closed in ("moving", "both")),
            read_body(record, "fixed", fixed, o.unit, o.place_fixed, o.assume_closed in ("fixed", "both")),
        )
        settings = settings_of(*bodies)
        motions = _motions(record, o, more_motions, bodies[0])
        with preparing():
            warm_up()
        for name, motion in motions:
            folder = draft / name
            folder.mkdir(exist_ok=True)
            evolution = _evaluated(record, Analysis(*bodies, motion, settings, o, name), folder)
            if reference is not None and o.compare is not None:
                within &= _compare(record, evolution, reference, o.compare, folder, tolerance)
        record.write(draft)
        written = sorted(str(file.relative_to(draft)) for file in draft.rglob("*") if file.is_file())
    record.say(f"results in {o.out}: {', '.join(written)}")
    record.speak()
    return 0 if within else 1


def _refuse_idle(o: AreaOptions) -> None:
    """Options that would do nothing are mistakes: the user believes that they did something."""
    idle = (
        (o.workers is not None and o.workers < 1, "--workers", "is less than one thread", "give 1 or more"),
        (o.map is not None and o.osim is not None, "--map", "beside --osim names the columns twice", "give one"),
        (o.moving_body == "parent" and o.osim is None and o.convention is None, "--moving",
         "parent needs a joint or a knee convention to swap", "swap the two meshes, or give --osim and --joint"),
        (o.axis is not None and o.sweep is None, "--axis", "does nothing without --sweep", "give --sweep, or leave it"),
        (o.medial == "+" and o.split is None, "--medial", "does nothing without --split", "give --split"),
        (o.side is not None and o.convention is None, "--side", "does nothing without --convention", "give it too"),
        (o.order is not None and (o.osim is not None or o.convention is not None), "--order",
         "does nothing here: the joint or the convention gives the order", "leave it"),
    )  # fmt: skip
    for wrong, option, what, remedy in idle:
        if wrong:
            raise InputError("", option, what, remedy)


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
        )

    return completed


def _motions(record: Record, o: AreaOptions, more_motions: Sequence[str], moving: Surface) -> list[tuple[str, Motion]]:
    """Name of the sub-folder (empty when there is one motion) and motion."""
    files = [*(o.motion or []), *more_motions]
    if (o.sweep is None) == (not files):
        raise InputError("", "--motion", "give either --motion or --sweep", "see geocontact area --help")
    if o.sweep is not None:
        return [("", _swept(o.sweep, o.axis, o.unit, moving, record))]
    paths = _expanded(files)
    if o.convention is not None and o.side is None:
        raise InputError("", "--side", "is missing beside --convention", "give right or left")
    motions = []
    for path in paths:
        poses = read_motion(
            path,
            osim=o.osim,
            joint=o.joint,
            moving=o.moving_body,
            mapping=o.map,
            order=o.order,
            angles=o.angles,
            grood_suntay_side=o.side if o.convention else None,
        )
        record.add_input("motion", path, frames=len(poses), source=poses.source)
        motions.append((path.stem if len(paths) > 1 else "", poses))
    if o.osim is not None:
        record.add_input("model", o.osim, joint=o.joint)
    return motions


def _expanded(patterns: list[str]) -> list[Path]:
    paths: list[Path] = []
    for pattern in patterns:
        matches = [pattern] if Path(pattern).exists() or not glob.has_magic(pattern) else sorted(glob.glob(pattern))
        if not matches:
            raise InputError(pattern, "", "matches no file", "check the pattern")
        paths += [Path(match) for match in matches]
    names = [path.stem for path in paths]
    for name in names if len(names) > 1 else ():
        if name in ("", ".", "..") or name.lower() == "run.json":
            raise InputError("", "--motion", f"a motion called {name!r} cannot name a folder", "rename its file")
        if names.count(name) > 1:
            raise InputError("", "--motion", f"two motions are called {name}", "their results would share a folder")
    return paths


def _swept(text: str, axis: str | None, unit: str, moving: Surface, record: Record) -> Motion:
    name, start, stop, step = quantities.sweep_range(text)
    if axis is not None:
        file = quantities.named_file(axis)
        if file is not None:
            record.add_input("--axis", file)
        return swept(quantities.axis(axis, unit), start, stop, step, name)
    fit = fit_cylinder(moving.vertices[moving.used])
    record.warn(
        f"no --axis: turned about the cylinder fitted to all of {moving.name}, "
        f"radius {fit.radius * 1e3:.2f} mm, rms {fit.rms * 1e3:.2f} mm"
    )
    point, direction = fit.point.tolist(), fit.direction.tolist()
    return swept(Axis(tuple(point), tuple(direction)), start, stop, step, name)


def _evaluated(record: Record, a: Analysis, folder: Path) -> AreaEvolution:
    o = a.options
    keep = DistanceMaps(a.moving, a.fixed)
    with progress(a.name or "frames", len(a.motion)) as step:

        def each(frame: int, contact: FrameContact) -> None:
            keep.add(frame, contact, everything=o.save_map)
            step()

        evolution = area_evolution(a.moving, a.fixed, a.motion, a.settings, o.workers, each)
    _refuse_strangers(evolution, o)
    _warn_of_doubts(record, evolution, a.settings, o.bounds is not None)
    table = evolution.table()
    if a.motion.coordinate is not None:
        name, angle = a.motion.coordinate
        table[f"{name} [deg]"] = np.repeat(np.degrees(angle), len(evolution.thresholds))
    write_table(table, folder, o.parquet)
    if o.save_map:
        keep.write(folder / "distances.npz", a.motion, evolution)
    title = f"MOVING {a.moving.name} on FIXED {a.fixed.name}" + (f", {a.name}" if a.name else "")
    label = "cycle [%]" if a.motion.time_unit == "%" else "time [s]"
    draw_areas(
        evolution, a.fixed.vertices, a.fixed.faces, keep.shown, keep.frame, title,
        (folder / "area.png", folder / "area.svg"), label,
    )  # fmt: skip
    _summarise(record, evolution, a.name)
    return evolution


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


def _compare(
    record: Record, evolution: AreaEvolution, reference: pd.DataFrame, path: Path, folder: Path, tolerance: float
) -> bool:
    rows = compared(evolution.table(), reference, path)
    rows.to_csv(folder / "comparison.csv", index=False)
    worst = float(rows["relative [-]"].abs().max())
    record.say(rows.to_string(index=False, max_rows=40))
    verdict = "within" if worst <= tolerance else "beyond"
    record.say(f"largest relative difference {worst:.2%}, {verdict} the tolerance of {tolerance:.2%}")
    return worst <= tolerance
