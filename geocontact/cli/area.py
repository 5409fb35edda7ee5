"""`geocontact area`: contact area of two rigid surfaces over a motion."""

from __future__ import annotations

import glob
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

import numpy as np
from cyclopts import Parameter

from geocontact.cli import quantities
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
from geocontact.io.motion import read_motion
from geocontact.io.results import write_table
from geocontact.view.area_figure import draw_areas

NEAR = 20e-3  # m; bodies that never come this close are a mistake in the input
Dashed = Parameter(allow_leading_hyphen=True)


@dataclass(frozen=True)
class Analysis:
    """One motion of two bodies and how it is to be counted."""

    moving: Surface
    fixed: Surface
    motion: Motion
    settings: Settings
    workers: int | None


def area(
    moving: Path,
    fixed: Path,
    *more_motions: str,
    motion: Annotated[list[str] | None, Parameter(consume_multiple=False, negative="")] = None,
    unit: Literal["m", "cm", "mm", "in"],
    out: Path,
    threshold: str = "4",
    osim: Path | None = None,
    joint: str | None = None,
    moving_body: Annotated[Literal["child", "parent"], Parameter(name="--moving")] = "child",
    map: Annotated[str | None, Dashed] = None,
    order: str | None = None,
    angles: Literal["deg", "rad"] | None = None,
    convention: Literal["grood-suntay"] | None = None,
    side: Literal["right", "left"] | None = None,
    sweep: Annotated[str | None, Dashed] = None,
    axis: Annotated[str | None, Dashed] = None,
    place_moving: str | None = None,
    place_fixed: str | None = None,
    assume_closed: Literal["moving", "fixed", "both"] | None = None,
    split: str | None = None,
    medial: Annotated[Literal["-", "+"], Dashed] = "-",
    region: Annotated[str | None, Dashed] = None,
    region_moving: Annotated[str | None, Dashed] = None,
    rule: Literal["refined", "clip", "all-vertices", "any-vertex", "centroid"] = "refined",
    bounds: str | None = None,
    compare: Path | None = None,
    tolerance: str = "2%",
    save_map: Annotated[bool, Parameter(negative="")] = False,
    parquet: Annotated[bool, Parameter(negative="")] = False,
    workers: int | None = None,
) -> int:
    """Contact area of two rigid surfaces over a motion, with certified bounds.

    Writes area.csv, area.png, area.svg and run.json into OUT. A point counts as in contact when its signed distance to
    the other body is not above the threshold; against an open body distances are unsigned, and the table says so.

    Parameters
    ----------
    moving
        Mesh that moves (.stl .ply .obj .vtp).
    fixed
        Mesh in whose frame results are given.
    more_motions
        Further motion files, as a shell glob after --motion gives them.
    motion
        Poses (.csv) or coordinates (.mot .sto); several, or a pattern in quotes: one sub-folder each.
    unit
        Unit of both meshes; never guessed.
    out
        Folder for the results.
    threshold
        Largest distance that counts, or several: 0.1,0.5,1,4 (mm unless a unit is given).
    osim
        OpenSim model whose joint turns coordinates into poses: FIXED is the parent body, MOVING the child.
    joint
        Name of that joint.
    moving_body
        parent: MOVING is the joint's parent body.
    map
        Columns instead of a model: rz=knee_flexion,rx=knee_adduction,ry=-knee_rotation,tx=knee_tx
    order
        Order of intrinsic rotations: XYZ is R = Rx Ry Rz.
    angles
        Unit of angles where the file does not say.
    convention
        grood-suntay: columns are clinical knee angles; needs --side.
    side
        Side of the knee.
    sweep
        Instead of --motion: turn MOVING about --axis, flexion=0:90:1 in degrees.
    axis
        x,y,z,dx,dy,dz (point in the mesh unit), a file of these, or a fit.json; else the cylinder fitted to MOVING.
    place_moving
        Where the mesh sits in its body: a file with a 4x4 matrix, or model.osim:body.
    place_fixed
        The same for FIXED.
    assume_closed
        Treat a surface as closed although its edges do not show it.
    split
        x, y or z (or z=1.5): medial and lateral parts of FIXED apart.
    medial
        Side of the splitting plane that is medial.
    region
        Faces of FIXED that count: "ny>0.25" in x y z nx ny nz (mesh unit), or a file of face numbers.
    region_moving
        The same for MOVING.
    rule
        How area is counted; the crude rules are for comparing with papers.
    bounds
        Refine until (upper - lower) / upper is below: 0.02 or 2%.
    compare
        Table of your own measured areas; exit 1 beyond the tolerance.
    tolerance
        Largest relative difference.
    save_map
        Also write the distance of every vertex in every frame (distances.npz).
    parquet
        Also write area.parquet.
    workers
        Threads; all cores by default. Results do not depend on it.
    """
    given = dict(locals())
    record = Record("area", given)
    reference = None if compare is None else read_reference(compare)
    with record.catching_warnings(), written_whole(out) as draft:
        body_fixed = read_body(record, "fixed", fixed, unit, place_fixed, assume_closed in ("fixed", "both"))
        body_moving = read_body(record, "moving", moving, unit, place_moving, assume_closed in ("moving", "both"))
        settings = Settings(
            thresholds=quantities.thresholds(threshold),
            rule=rule,
            refinement=Refinement(bounds=None if bounds is None else quantities.fraction(bounds, "--bounds")),
            fixed_faces=chosen_faces("--region", region, body_fixed, unit),
            moving_faces=chosen_faces("--region-moving", region_moving, body_moving, unit),
            split=None if split is None else quantities.splitting_plane(split, unit),
            medial_side=1 if medial == "+" else -1,
        )
        within = True
        for name, poses in _motions(record, given, body_moving):
            folder = draft / name
            folder.mkdir(exist_ok=True)
            analysis = Analysis(body_moving, body_fixed, poses, settings, workers)
            evolution = _analyse(record, analysis, folder, given, name)
            if reference is not None and compare is not None:
                within &= _compare(evolution, reference, compare, folder, quantities.fraction(tolerance, "--tolerance"))
        record.write(draft)
    print(f"results in {out}: area.csv, area.png, area.svg, run.json")
    return 0 if within else 1


def _motions(record: Record, given: dict[str, object], moving: Surface) -> list[tuple[str, Motion]]:
    """Name of the sub-folder (empty when there is one motion) and motion."""
    files = [*(given["motion"] or []), *given["more_motions"]]  # type: ignore[misc]
    if (given["sweep"] is None) == (not files):
        raise InputError("", "--motion", "give either --motion or --sweep", "see geocontact area --help")
    if given["sweep"] is not None:
        return [("", _swept(str(given["sweep"]), given["axis"], str(given["unit"]), moving, record))]
    paths = _expanded([str(file) for file in files])
    if given["convention"] is not None and given["side"] is None:
        raise InputError("", "--side", "is missing beside --convention", "give right or left")
    motions = []
    for path in paths:
        poses = read_motion(
            path, osim=given["osim"], joint=given["joint"], moving=str(given["moving_body"]), mapping=given["map"],
            order=given["order"], angles=given["angles"],
            grood_suntay_side=given["side"] if given["convention"] else None,
        )  # type: ignore[arg-type]  # fmt: skip
        record.add_input("motion", path, frames=len(poses), source=poses.source)
        motions.append((path.stem if len(paths) > 1 else "", poses))
    if given["osim"] is not None:
        record.add_input("model", str(given["osim"]), joint=given["joint"])
    return motions


def _expanded(patterns: list[str]) -> list[Path]:
    paths: list[Path] = []
    for pattern in patterns:
        matches = [pattern] if Path(pattern).exists() or not glob.has_magic(pattern) else sorted(glob.glob(pattern))
        if not matches:
            raise InputError(pattern, "", "matches no file", "check the pattern")
        paths += [Path(match) for match in matches]
    names = [path.stem for path in paths]
    for name in names:
        if names.count(name) > 1:
            raise InputError("", "--motion", f"two motions are called {name}", "their results would share a folder")
    return paths


def _swept(text: str, axis: object, unit: str, moving: Surface, record: Record) -> Motion:
    name, start, stop, step = quantities.sweep_range(text)
    if axis is not None:
        return swept(quantities.axis(str(axis), unit), start, stop, step, name)
    fit = fit_cylinder(moving.vertices[moving.used])
    record.warn(
        f"no --axis: turned about the cylinder fitted to all of {moving.name}, "
        f"radius {fit.radius * 1e3:.2f} mm, rms {fit.rms * 1e3:.2f} mm"
    )
    point, direction = fit.point.tolist(), fit.direction.tolist()
    return swept(Axis(tuple(point), tuple(direction)), start, stop, step, name)


def _analyse(record: Record, a: Analysis, folder: Path, given: dict[str, object], name: str) -> AreaEvolution:
    keep = DistanceMaps(a.moving, a.fixed)
    with preparing(), progress(name or "frames", len(a.motion)) as step:

        def each(frame: int, contact: FrameContact) -> None:
            keep.add(frame, contact, everything=bool(given["save_map"]))
            step()

        evolution = area_evolution(a.moving, a.fixed, a.motion, a.settings, a.workers, each)
    _refuse_strangers(evolution, given)
    _warn_of_doubts(record, evolution, a.settings)
    write_table(evolution.table(), folder, bool(given["parquet"]))
    if given["save_map"]:
        keep.write(folder / "distances.npz", a.motion, evolution)
    title = f"{a.moving.name} on {a.fixed.name} — {a.motion.source}"
    label = "cycle [%]" if a.motion.time_unit == "%" else "time [s]"
    draw_areas(
        evolution, a.fixed.vertices, a.fixed.faces, keep.shown, keep.frame, title,
        (folder / "area.png", folder / "area.svg"), label,
    )  # fmt: skip
    _summarise(record, evolution, name)
    return evolution


def _refuse_strangers(evolution: AreaEvolution, given: dict[str, object]) -> None:
    closest = float(evolution.min_distance.min())
    if closest > NEAR:
        remedy = "wrong direction? try --moving parent" if given["osim"] else "check unit, frames and direction"
        if given["moving_body"] == "parent":
            remedy = "wrong direction? try --moving child"
        raise InputError("", "", f"bodies are {closest * 1e3:.0f} mm apart in every frame", remedy)


def _warn_of_doubts(record: Record, e: AreaEvolution, settings: Settings) -> None:
    if e.undecided.any():
        worst = int(e.undecided.max())
        record.warn(f"up to {worst} points per frame have no side (winding number near 0.5); they count as outside")
    wanted = settings.refinement.bounds
    if wanted is not None and settings.rule == REFINED:
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
        lines[f"area_fixed_mm2_at_{threshold * 1e3:g}_mm"] = [round(float(areas.min()), 3), round(float(areas.max()), 3)]
        label = f"{name}: " if name else ""
        print(f"{label}area of FIXED within {threshold * 1e3:g} mm: {areas.min():.1f} … {areas.max():.1f} mm^2")
    record.results[name or "motion"] = lines


def _compare(evolution: AreaEvolution, reference: object, path: Path, folder: Path, tolerance: float) -> bool:
    rows = compared(evolution.table(), reference, path)  # type: ignore[arg-type]
    rows.to_csv(folder / "comparison.csv", index=False)
    worst = float(rows["relative [-]"].abs().max())
    print(rows.to_string(index=False, max_rows=40))
    verdict = "within" if worst <= tolerance else "beyond"
    print(f"largest relative difference {worst:.2%}, {verdict} the tolerance of {tolerance:.2%}")
    return worst <= tolerance
