"""What the page's script needs, as plain data and packed arrays. Lengths in mm, about the middle of the scene."""

from __future__ import annotations

import re
from collections.abc import Collection, Sequence
from dataclasses import asdict, dataclass

import numpy as np
from jaxtyping import Float

from geocontact.data.text import seconds
from geocontact.view.curves.declared import HUES
from geocontact.view.curves.strokes import Line, assigned, lines_of, with_strokes
from geocontact.view.page.content import (
    Curves,
    FaceMap,
    Intervals,
    Matrix,
    Page,
    Plan,
    Readout,
    Scene,
    SceneBody,
    Section,
    Strip,
    Strips,
    Track,
)
from geocontact.view.page.heat import matrix_data, strips_data
from geocontact.view.page.opening import opacities, opening_view
from geocontact.view.page.pack import AmountLevels, Block, Grid, Levels, across, face_words, packed
from geocontact.view.page.scene import Linkage

MM = 1e3
UNITS = "N m|N|kN|mm²|cm²|mm|cm|m|MPa|kPa|Pa|s|ms|%|deg|°"
"""A line does not end between a number and one of these."""
TOGETHER = 1 << 18
"""Faces whose volumes are summed together: what is needed of them meanwhile stays small."""
LATE = 1e5
"""s; from here on the digits that a page shows do not tell frames apart."""


@dataclass(frozen=True)
class Payload:
    """Data for JSON, the arrays it refers to, and what quantising them costs at most [m]."""

    data: dict[str, object]
    blocks: list[Block]
    position_error: float = 0.0
    distance_error: float = 0.0


def payload(page: Page) -> Payload:
    """Everything the script draws; texts that the HTML holds already are left out."""
    blocks: list[Block] = []
    time, label = _clock(page)
    data: dict[str, object] = {
        "time": _numbers(time),
        "timeLabel": label,
        "title": page.title,
        "start": page.opening,
        "numbers": None if page.numbers is None else [int(number) for number in page.numbers],
        "total": len(page.time) if page.total is None else int(page.total),
        "plays": page.plays,
        "thresholds": _chosen(page),
    }
    parts: list[dict[str, object]] = []
    position_error = distance_error = 0.0
    placed = page.placed()
    strokes = assigned([_lines(section) for *_, section in placed])
    named = {line for *_, section in placed if not isinstance(section, Intervals) for line, _ in _lines(section)}
    for (name, _, _, section), own in zip(placed, strokes, strict=True):
        place = {"id": name}
        match section:
            case Scene():
                levels = _levels(section)
                data["scene"] = _scene(section, page.opening, levels, blocks)
                grids = [*(Grid.around(b.vertices) for b in section.bodies), *(each.grid for each in section.linkages)]
                position_error = max(grid.error for grid in grids)
                distance_error = levels.error
            case Curves():
                parts.append(place | {"kind": "curves"} | _curves(with_strokes(section, own)))
            case Strip():
                parts.append(place | {"kind": "strip"} | _strip(section))
            case Plan():
                parts.append(place | {"kind": "plan"} | _plan(section, own))
            case Intervals():
                parts.append(place | {"kind": "intervals"} | _intervals(section, own, named))
            case Strips():
                parts.append(place | {"kind": "strips"} | strips_data(section))
            case Matrix():
                parts.append(place | {"kind": "matrix"} | matrix_data(section))
            case Readout():
                texts = [[shown(text) for text in row.texts] for row in section.rows]
                parts.append(place | {"kind": "readout", "texts": texts})
    data["parts"] = parts
    return Payload(data, blocks, position_error, distance_error)


def shown(text: str) -> str:
    """A number with a minus sign (U+2212) in place of a leading hyphen, and none before a rounded zero."""
    return re.sub(r"^-(?=[\d.])", "−", re.sub(r"^-(?=0*\.?0*(?![\d.eE]))(?=[\d.])", "", text))


def minus(text: str) -> str:
    """Words with a minus sign before numbers and axes that stand by themselves, and units kept beside: "z −19.5 mm"."""
    signed = re.sub(r"(?<![^\s(\[])-(?=\d|[xyz]\b)", "−", text)
    return re.sub(rf"(?<=\d) (?=(?:{UNITS})(?![\w/]))", "\u00a0", signed)


def _levels(scene: Scene) -> Levels:
    lower, upper = scene.span
    most = upper + (upper - lower)  # a few far corners shall not make everything coarse
    reach = [across(body.faces, body.distance, upper, most) for body in scene.bodies if body.distance is not None]
    return Levels.of(scene.span, scene.threshold, max(reach, default=upper))


def _scene(scene: Scene, frame: int, levels: Levels, blocks: list[Block]) -> dict[str, object]:
    middle = _middle(scene, frame)
    return {
        "bodies": [
            _body(body, k, opacity, middle, levels, blocks)
            for k, (body, opacity) in enumerate(zip(scene.bodies, opacities(scene), strict=True))
        ],
        "thresholds": sorted((float(t) * MM for t in scene.thresholds), reverse=True),
        "span": [float(limit) * MM for limit in scene.span],
        "first": levels.first * MM,
        "step": levels.step * MM,
        "valueName": scene.value_name,
        "sides": scene.sides,
        "directions": [[name, [float(x) for x in vector]] for name, vector in scene.directions.items()],
        "up": [float(x) for x in scene.up],
        "view": opening_view(scene, frame).tolist(),
        "maps": [_map(each, k, blocks) for k, each in enumerate(scene.maps)],
        "linkages": [_linkage(each, k, middle, blocks) for k, each in enumerate(scene.linkages)],
    }


def _map(each: FaceMap, k: int, blocks: list[Block]) -> dict[str, object]:
    levels = AmountLevels.of(each.upper)
    blocks.append(packed(f"map-{k}", levels.codes(each.values)))
    described = {"name": each.name, "unit": each.unit, "body": each.body, "upper": each.upper, "step": levels.step}
    return described | {"values": blocks[-1].described()}


def _linkage(each: Linkage, k: int, middle: Float[np.ndarray, " 3"], blocks: list[Block]) -> dict[str, object]:
    blocks.append(packed(f"linkage-{k}", each.words()))
    return {
        "name": each.name,
        "tone": each.tone,
        "radius": each.radius * MM,
        "width": each.width * MM,
        "lines": each.lines.tolist(),
        "corner": ((each.grid.corner - middle) * MM).tolist(),
        "size": (each.grid.size * MM).tolist(),
        "points": blocks[-1].described(),
    }


def _middle(scene: Scene, frame: int) -> Float[np.ndarray, " 3"]:
    """Middle of the bodies at the opening frame and of where linkages go [m]: single precision is enough about it."""
    corners = []
    for body in scene.bodies:
        placed = body.vertices if body.poses is None else body.poses[frame].apply(body.vertices)
        corners += [placed.min(axis=0), placed.max(axis=0)]
    for each in scene.linkages:
        corners += [each.places.min(axis=0), each.places.max(axis=0)]
    return np.asarray(0.5 * (np.min(corners, axis=0) + np.max(corners, axis=0)))


def _body(
    body: SceneBody, k: int, opacity: float, middle: Float[np.ndarray, " 3"], levels: Levels, blocks: list[Block]
) -> dict[str, object]:
    grid = Grid.around(body.vertices)
    centre = grid.corner + 0.5 * grid.size

    def stored(what: str, array: np.ndarray) -> dict[str, object]:
        blocks.append(packed(f"body-{k}-{what}", array))
        return blocks[-1].described()

    described: dict[str, object] = {
        "name": body.name,
        "opacity": opacity,
        "signed": body.signed,
        "size": (grid.size * MM).tolist(),
        "positions": stored("positions", grid.steps(body.vertices)),
        "faces": stored("faces", face_words(_outward(body, centre))),
        "poses": stored("poses", _poses(body, centre, middle)),
    }
    if body.distance is not None:
        described["distance"] = stored("distance", levels.codes(body.distance))
    if body.source is not None:
        source = body.source
        described["source"] = {
            "file": source.file,
            "sha256": source.sha256,
            "unit": source.unit,
            "frame": source.frame,
            "vertices": stored("source", np.asarray(source.vertices, np.float64)),
            "landmarks": [asdict(each) for each in source.landmarks],
        }
    return described


def _outward(body: SceneBody, centre: Float[np.ndarray, " 3"]) -> np.ndarray:
    """Faces turned so that the body's volume is positive: a section shows its inside as inside."""
    volume = 0.0
    for start in range(0, len(body.faces), TOGETHER):
        a, b, c = (body.vertices[corner] - centre for corner in body.faces[start : start + TOGETHER].T)
        volume += float(np.einsum("ij,ij->", a, np.cross(b, c)))
    return body.faces if volume >= 0.0 else body.faces[:, ::-1]


def _poses(body: SceneBody, centre: Float[np.ndarray, " 3"], middle: Float[np.ndarray, " 3"]) -> np.ndarray:
    """Rotation (row-major) and shift [mm] of the centred body about the scene's middle, (t, 12); (1, 12) if fixed."""
    if body.poses is None:
        rotation, shift = np.eye(3)[None], (centre - middle)[None]
    else:
        rotation = body.poses.rotation.as_matrix().reshape(-1, 3, 3)
        shift = np.asarray(body.poses.apply(centre)).reshape(-1, 3) - middle
    return np.concatenate([rotation.reshape(-1, 9), shift * MM], axis=1).astype(np.float32)


def _curves(panel: Curves) -> dict[str, object]:
    curves = [
        {
            "name": curve.name,
            "values": _numbers(curve.values),
            "lower": None if curve.lower is None else _numbers(curve.lower),
            "upper": None if curve.upper is None else _numbers(curve.upper),
            "stroke": curve.stroke,
            "thin": curve.thin,
        }
        for curve in panel.curves
    ]
    points = [
        {"name": p.name, "time": _numbers(p.time), "values": _numbers(p.values), "stroke": p.stroke, "joined": p.joined}
        for p in panel.points
    ]
    return {
        "title": panel.title,
        "unit": panel.unit,
        "curves": curves,
        "points": points,
        "limits": [asdict(limit) for limit in panel.limits],
        "spans": [asdict(span) for span in panel.spans],
        "beside": None if panel.beside is None else asdict(panel.beside),
        "over": None if panel.over is None else {"label": panel.over.label, "values": _numbers(panel.over.values)},
        "log": panel.log,
    }


def _lines(section: Section) -> list[Line]:
    """What a section's key names by a colour."""
    match section:
        case Curves():
            return lines_of(section)
        case Plan():
            return [(track.name, None) for track in section.tracks]
        case Intervals():
            return [(kind, None) for kind in _kinds(section)]
    return []


def _kinds(shown: Intervals) -> list[str]:
    return [kind for kind in dict.fromkeys(one.kind for one in shown.intervals) if kind]


def _track(track: Track, stroke: int) -> dict[str, object]:
    points: dict[str, object] = {
        "name": track.name,
        "x": _numbers(track.points[:, 0]),
        "y": _numbers(track.points[:, 1]),
        "stroke": stroke,
    }
    return {**points, "told": list(track.told)} if track.told else points


def _plan(plan: Plan, strokes: Sequence[int]) -> dict[str, object]:
    return {
        "title": plan.title,
        "unit": plan.unit,
        "across": plan.across,
        "up": plan.up,
        "lines": [[_numbers(line[:, 0]), _numbers(line[:, 1])] for line in plan.lines],
        "tracks": [_track(track, own) for track, own in zip(plan.tracks, strokes, strict=True)],
        "marks": [{"name": mark.name, "at": [float(x) for x in mark.point]} for mark in plan.marks],
        "lengths": [
            {"name": each.name, "told": minus(each.told), "ends": [list(map(float, p)) for p in (each.start, each.end)]}
            for each in plan.lengths
        ],
    }


def _intervals(shown: Intervals, strokes: Sequence[int], named: Collection[str]) -> dict[str, object]:
    """Rows; a kind that a curve or a track is `named` as has its hue."""
    rows = []
    for one in shown.intervals:
        value, lower, upper = _numbers(np.array([one.value, one.lower, one.upper]))
        rows.append({"name": one.name, "value": value, "lower": lower, "upper": upper, "kind": one.kind})
    hues = {kind: own % HUES for kind, own in zip(_kinds(shown), strokes, strict=True) if kind in named}
    return {"title": shown.title, "unit": shown.unit, "bars": shown.bars, "hues": hues, "intervals": rows}


def _chosen(page: Page) -> list[float | None]:
    """Bold contour of each choice [mm], the page's own first."""
    own = next((section.threshold * MM for section in page.sections if isinstance(section, Scene)), None)
    others = () if page.choices is None else page.choices.others
    return [own, *(None if each.threshold is None else each.threshold * MM for each in others)]


def _strip(strip: Strip) -> dict[str, object]:
    return {
        "title": strip.title,
        "unit": strip.unit,
        "current": strip.current,
        "thresholds": _numbers(strip.thresholds),
        "values": [_numbers(row) for row in strip.values],
    }


def _clock(page: Page) -> tuple[Float[np.ndarray, " t"], str]:
    """Times and their label; times of a clock that counts from 1970 are shown from the first one on."""
    if not page.time_label.startswith("time") or not len(page.time) or abs(page.time[0]) < LATE:
        return page.time, page.time_label
    name, bracket, unit = page.time_label.partition(" [")
    return page.time - page.time[0], f"{name} after {seconds(float(page.time[0]))}{bracket}{unit}"


def _numbers(values: Float[np.ndarray, " t"]) -> list[float | None]:
    """Seven digits are more than a picture shows; what is not finite is a gap."""
    return [float(f"{value:.7g}") if np.isfinite(value) else None for value in values]
