"""What the page of a contact-area analysis shows: where, how much, in which frame, and how far to trust it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from jaxtyping import Int

from geocontact.data.evolution import MM, MM2, AreaEvolution
from geocontact.data.motion import Course, Motion
from geocontact.geometry.maps import DistanceMaps
from geocontact.geometry.surface import Surface
from geocontact.view.contact_words import reviewers_words
from geocontact.view.directions import camera_directions
from geocontact.view.page.content import Body, Curve, Curves, Page, Readout, Row, Scene, Section, Strip, Table
from geocontact.view.page.write import write_page

TICK = 0.5e-3  # m; the colours end at a round number
FRAMES = 201  # frames that the page animates at most; longer motions are thinned out, and the page says so


def write_report(
    path: Path,
    moving: Surface,
    fixed: Surface,
    motion: Motion,
    evolution: AreaEvolution,
    maps: DistanceMaps,
    title: str = "",
    provenance: Sequence[Table] = (),
    warnings: Sequence[str] = (),
) -> int:
    """Write the self-contained page of one contact-area analysis; returns its size in bytes.

    Parameters
    ----------
    path
        HTML file to write.
    moving, fixed, motion
        What was analysed.
    evolution
        The areas, from `area_evolution`; with `Settings.sensitivity` the page shows how much the threshold matters.
    maps
        Distance maps gathered by the same call (`each=maps.add`).
    provenance
        Further tables: inputs with hashes, options, versions.
    warnings
        Reservations that came up on the way.
    """
    frames = np.asarray(maps.frames, np.int64)
    if len(frames) == 0:
        raise ValueError("the distance maps hold no frame; gather them with area_evolution(..., each=maps.add)")
    kept = np.arange(0, len(frames), -(-len(frames) // FRAMES))
    return write_page(_page(moving, fixed, motion, evolution, maps, kept, title, provenance, warnings), Path(path))


def _page(
    moving: Surface,
    fixed: Surface,
    motion: Motion,
    evolution: AreaEvolution,
    maps: DistanceMaps,
    kept: Int[np.ndarray, " k"],
    title: str,
    provenance: Sequence[Table],
    warnings: Sequence[str],
) -> Page:
    frames = np.asarray(maps.frames, np.int64)[kept]
    main = int(np.argmax(evolution.thresholds))
    shown = evolution.fixed.area[frames, main]
    sections: list[Section] = [
        _scene(moving, fixed, motion, evolution, maps, kept),
        Readout(_rows(evolution, frames, main), title=f"This frame, threshold {_mm(evolution, main)}"),
        *_curves(evolution, frames, main),
    ]
    if evolution.sensitivity_thresholds:
        sections.append(_strip(evolution, frames, main))
    sections += [_meshes(moving, fixed), *provenance]
    sections += reviewers_words(moving, fixed, evolution, main, len(motion), len(frames), warnings)
    return Page(
        title=title or f"{moving.name} on {fixed.name}",
        subtitle=f"Contact area over {len(motion)} frames: what lies within {_mm(evolution, main)} of the other body",
        time=motion.course.values[frames],
        time_label=motion.course.label,
        headline=_headline(evolution, main, motion.course),
        start_frame=int(np.argmax(shown)),
        sections=tuple(sections),
    )


def _mm(evolution: AreaEvolution, k: int) -> str:
    return f"{evolution.thresholds[k] * MM:g} mm"


def _headline(e: AreaEvolution, main: int, course: Course) -> list[tuple[str, str]]:
    """How much, when, where."""
    area = e.fixed.area[:, main] * MM2
    largest, nearest = int(np.argmax(area)), int(np.argmin(e.min_distance))

    def when(frame: int) -> str:
        return f"at {course.at(frame)} (frame {frame + 1} of {len(e.time)})"

    lines = [
        ("Largest contact area on the fixed body", f"{area[largest]:.0f} mm² {when(largest)}"),
        ("Range over the motion", f"{area.min():.0f} … {area.max():.0f} mm² (mean {area.mean():.0f} mm²)"),
    ]
    if area[largest] > 0.0:
        x, y, z = e.fixed.centroid[largest, main] * MM
        where = f"centroid x {x:.1f}, y {y:.1f}, z {z:.1f} mm"
        if e.medial_side:
            medial = e.medial[largest, main] / e.fixed.area[largest, main]
            where += f"; {medial:.0%} medial, {1.0 - medial:.0%} lateral"
        lines.append(("Where, in that frame", where))
    word = "Deepest overlap" if e.min_distance[nearest] < 0.0 else "Smallest distance"
    lines.append((word, f"{abs(e.min_distance[nearest]) * MM:.2f} mm {when(nearest)}"))
    return lines


def _scene(
    moving: Surface,
    fixed: Surface,
    motion: Motion,
    e: AreaEvolution,
    maps: DistanceMaps,
    kept: Int[np.ndarray, " k"],
) -> Scene:
    farthest = max((*e.thresholds, *e.sensitivity_thresholds))
    deepest = min(-0.25 * max(e.thresholds), float(e.min_distance.min()))
    deepest = 0.0 if e.signed == "none" else -np.ceil(-deepest / TICK) * TICK
    frames = np.asarray(maps.frames, np.int64)[kept]
    word = "distance" if e.signed == "none" else "signed distance"
    return Scene(
        bodies=(
            Body(fixed.name, fixed.vertices, fixed.faces, distance=maps.fixed[kept]),
            Body(moving.name, moving.vertices, moving.faces, motion.poses[frames], maps.moving[kept]),
        ),
        thresholds=e.thresholds,
        span=(float(deepest), farthest),
        value_name=f"{word} to the other body",
        directions=camera_directions(np.asarray(e.split_normal) * e.medial_side),
    )


def _rows(e: AreaEvolution, frames: Int[np.ndarray, " k"], main: int) -> list[Row]:
    """The table's row of each frame, rounded to what a reader can use."""
    columns = e.table().iloc[frames * len(e.thresholds) + main]
    rows = []
    for label, column, digits in (
        ("area of the fixed body", "area_fixed [mm^2]", 2),
        ("certainly at least", "area_fixed_lower [mm^2]", 2),
        ("certainly at most", "area_fixed_upper [mm^2]", 2),
        ("medial part", "area_fixed_medial [mm^2]", 2),
        ("lateral part", "area_fixed_lateral [mm^2]", 2),
        ("area of the moving body", "area_moving [mm^2]", 2),
        ("smallest distance", "min_distance [mm]", 3),
        ("penetration of the fixed body", "max_penetration_fixed [mm]", 3),
        ("centroid x", "centroid_x [mm]", 2),
        ("centroid y", "centroid_y [mm]", 2),
        ("centroid z", "centroid_z [mm]", 2),
    ):
        if column in columns:
            unit = column[column.index("[") + 1 : -1].replace("^2", "²")
            texts = ["–" if np.isnan(value) else f"{value:.{digits}f}" for value in columns[column]]
            rows.append(Row(label, unit, texts))
    return rows


def _curves(e: AreaEvolution, frames: Int[np.ndarray, " k"], main: int) -> list[Curves]:
    def within(k: int) -> Curve:
        side = e.fixed
        name = f"fixed body, {_mm(e, k)}"
        return Curve(name, side.area[frames, k] * MM2, side.lower[frames, k] * MM2, side.upper[frames, k] * MM2)

    areas = [within(main)]
    if e.medial_side:
        areas += [
            Curve(f"medial, {_mm(e, main)}", e.medial[frames, main] * MM2),
            Curve(f"lateral, {_mm(e, main)}", e.lateral[frames, main] * MM2),
        ]
    areas += [within(k) for k in range(len(e.thresholds)) if k != main]
    distance = [Curve("smallest distance", e.min_distance[frames] * MM)]
    return [Curves("Contact area", "mm²", areas), Curves("Smallest distance (negative: overlap)", "mm", distance)]


def _strip(e: AreaEvolution, frames: Int[np.ndarray, " k"], main: int) -> Strip:
    order = np.argsort(e.sensitivity_thresholds)
    values = e.sensitivity[np.ix_(frames, order)] * MM2
    thresholds = np.asarray(e.sensitivity_thresholds)[order]
    values[:, np.isclose(thresholds, e.thresholds[main])] = e.fixed.area[frames, main, None] * MM2  # the better number
    return Strip(
        title="How much the threshold matters (fixed body)",
        thresholds=thresholds * MM,
        values=values,
        unit="mm²",
        current=e.thresholds[main] * MM,
    )


def _meshes(moving: Surface, fixed: Surface) -> Table:
    """What the areas rest on."""
    header = ("body", "vertices", "faces", "edge, median [mm]", "edge, longest [mm]", "size [mm]", "closed")
    rows = []
    for role, body in (("moving", moving), ("fixed", fixed)):
        used = body.vertices[body.used]
        size = np.ptp(used, axis=0) * MM
        edges = body.edge_length * MM
        closed = "yes" if body.topology.closed else ("assumed" if body.closed else "no: distances to it are unsigned")
        rows.append((
            f"{role}: {body.name}", f"{len(used)}", f"{len(body.faces)}", f"{np.median(edges):.2f}",
            f"{edges.max():.2f}", " × ".join(f"{length:.1f}" for length in size), closed,
        ))  # fmt: skip
    return Table("The two surfaces", header, rows)


def inputs_table(inputs: Sequence[Mapping[str, object]]) -> Table:
    """Files that went in, as `run.json` lists them."""
    rows = [(str(i["role"]), Path(str(i["file"])).name, str(i.get("unit", "")), str(i["sha256"])) for i in inputs]
    return Table("Input files", ("role", "file", "unit", "SHA-256"), rows)
