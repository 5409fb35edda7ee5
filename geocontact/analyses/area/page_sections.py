"""What a contact page shows of areas: the scene, the numbers of a frame, curves, and what the threshold matters."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
from jaxtyping import Bool, Float, Int

from geocontact.analyses.area.figure import area_curves, colour_span
from geocontact.analyses.area.pressure_page import Pressures, face_map, pressure_rows
from geocontact.analyses.area.wear import wear_map
from geocontact.data.evolution import MM, MM2, AreaEvolution
from geocontact.data.motion import Motion
from geocontact.geometry.contact_area.area import CLIP, REFINED
from geocontact.geometry.contact_area.comparison import Compared
from geocontact.geometry.contact_area.congruence import CongruenceEvolution
from geocontact.geometry.contact_area.evolution import Settings
from geocontact.geometry.contact_area.maps import DistanceMaps
from geocontact.geometry.contact_area.pose_error import ENDS, NORMAL, AreaUncertainty
from geocontact.geometry.surface import Surface
from geocontact.loads.wear import LayerWear
from geocontact.view.page.content import Curve, Curves, FaceMap, Points, Row, Scene, SceneBody, Strip, Table
from geocontact.view.surfaces.camera import camera_directions

READ = (
    ("lower bound (these meshes)", "area_fixed_lower [mm^2]", 2),
    ("upper bound (these meshes)", "area_fixed_upper [mm^2]", 2),
    ("medial part", "area_fixed_medial [mm^2]", 2),
    ("lateral part", "area_fixed_lateral [mm^2]", 2),
    ("coverage of the fixed body's region", "coverage_fixed [-]", 3),
    ("coverage of the moving body's region", "coverage_moving [-]", 3),
    ("contact area on the moving body", "area_moving [mm^2]", 2),
    ("smallest distance", "min_distance [mm]", 3),
    ("penetration of the fixed body", "max_penetration_fixed [mm]", 3),
    ("index of congruence", "congruence_index [1/mm]", 4),
    ("relative curvature, least", "relative_curvature_min [1/mm]", 4),
    ("relative curvature, largest", "relative_curvature_max [1/mm]", 4),
    ("centroid x", "centroid_x [mm]", 2),
    ("centroid y", "centroid_y [mm]", 2),
    ("centroid z", "centroid_z [mm]", 2),
)
"""Label, column and digits of what the page reads out in each frame, after the area of FIXED."""
BESIDE_PRESSURES = ("coverage_fixed [-]", "min_distance [mm]", "max_penetration_fixed [mm]")
"""Those of them that stay where pressures are read out."""
MEASURED = {
    "area_fixed [mm^2]": "fixed body",
    "area_fixed_medial [mm^2]": "medial",
    "area_fixed_lateral [mm^2]": "lateral",
    "area_moving [mm^2]": "moving body",
}
"""Columns that may be compared with measured ones, as the curves call them."""


@dataclass(frozen=True, eq=False)
class Told:
    """What a page tells: an analysis, and which of the frames kept in `maps` are shown (`kept`, places in there)."""

    moving: Surface
    fixed: Surface
    motion: Motion
    settings: Settings
    evolution: AreaEvolution
    maps: DistanceMaps
    kept: Int[np.ndarray, " k"]
    pressures: Pressures | None = None
    compared: Compared | None = None
    uncertainty: AreaUncertainty | None = None
    congruence: CongruenceEvolution | None = None
    published: pd.DataFrame | None = None
    wear: LayerWear | None = None

    @property
    def frames(self) -> Int[np.ndarray, " k"]:
        """Numbers of the frames shown."""
        return np.asarray(np.asarray(self.maps.frames, np.int64)[self.kept])

    @property
    def main(self) -> int:
        """Place of the largest threshold, which the page is about."""
        return int(np.argmax(self.evolution.thresholds))

    @property
    def crude(self) -> bool:
        """Whether areas were counted by a rule that does not cut triangles."""
        return self.settings.rule not in (REFINED, CLIP)


def in_mm(evolution: AreaEvolution, k: int) -> str:
    """A threshold as the page shows it."""
    return f"{evolution.thresholds[k] * MM:g} mm"


def scene(told: Told) -> Scene:
    """Both bodies with their distances, and the pressures where there are some."""
    e, kept = told.evolution, told.kept
    signed = {"fixed": e.signed in ("both", "fixed"), "moving": e.signed in ("both", "moving")}
    return Scene(
        bodies=(
            SceneBody(
                told.fixed.name,
                told.fixed.vertices,
                told.fixed.faces,
                signed=signed["fixed"],
                distance=seen_distances(told.maps.fixed[kept], told.fixed, told.settings.fixed_faces),
            ),
            SceneBody(
                told.moving.name,
                told.moving.vertices,
                told.moving.faces,
                told.motion.poses[told.frames],
                signed=signed["moving"],
                distance=seen_distances(told.maps.moving[kept], told.moving, told.settings.moving_faces),
            ),
        ),
        thresholds=e.thresholds,
        span=colour_span(e),
        value_name="distance to the other body" if e.signed == "none" else "signed distance to the other body",
        directions=camera_directions(np.asarray(e.split_normal) * e.medial_side),
        maps=_maps(told),
    )


def _maps(told: Told) -> list[FaceMap]:
    """Pressures, and the wear by them."""
    found = [] if told.pressures is None else [face_map(told.pressures, told.frames, 0)]
    return found if told.wear is None else [*found, wear_map(told.wear, len(told.fixed.faces), len(told.frames))]


def seen_distances(
    distance: Float[np.ndarray, "t n"], body: Surface, faces: Bool[np.ndarray, " f"] | None
) -> Float[np.ndarray, "t n"]:
    """Distances with vertices of no counted face taken as far away, so that only what counts is coloured."""
    if faces is None:
        return distance
    counts = np.zeros(len(body.vertices), bool)
    counts[body.faces[faces]] = True
    return np.where(counts, distance, np.inf)


def rows(told: Told, k: int) -> list[Row]:
    """The table's row of each frame at threshold `k`, rounded to what a reader can use; with pressures, those first."""
    e = told.evolution
    more = READ if told.pressures is None else [one for one in READ if one[1] in BESIDE_PRESSURES]
    alike = {} if told.congruence is None else told.congruence.columns()
    columns = e.table().assign(**alike).iloc[told.frames * len(e.thresholds) + k]
    found = [] if told.pressures is None else pressure_rows(told.pressures, told.frames)
    area = (
        "contact area on the fixed body" + (f", {told.settings.rule}" if told.crude else ""),
        "area_fixed [mm^2]",
        2,
    )
    for label, column, digits in (area, *more):
        if column in columns:
            unit = column[column.index("[") + 1 : -1].replace("^2", "²")
            texts = ["–" if np.isnan(value) else f"{value:.{digits}f}" for value in columns[column]]
            found.append(Row(label, unit, texts))
    return found


def compared_areas(told: Told, main: int) -> Curves:
    """Areas with their bounds, those of threshold `main` first, and measured ones as points."""
    measured = _measured(told, main)
    moving = any(each.name.startswith("measured, moving") for each in measured)
    return replace(area_curves(told.evolution, main, moving).at(told.frames), points=measured)


def uncertainty_curves(told: Told, main: int) -> list[Curves]:
    """The area with the intervals that the error of the poses gives it, by draws and to first order."""
    u, frames = told.uncertainty, told.frames
    if u is None:
        return []
    area = u.area[frames, main] * MM2
    lower, upper = u.interval(main)[:, frames] * MM2
    sd = NORMAL * MM2 * np.array([u.cells[frame][main].first_order for frame in frames])
    curves = [
        Curve(f"95 % of {len(u.error.draws)} draws", area, lower, upper),
        Curve("first order, lower", np.maximum(area - sd, 0.0)),
        Curve("first order, upper", area + sd),
    ]
    met = sum(u.verdict(frame, main) == "yes" for frame in range(len(u.cells)))
    words = f"First order agrees with the draws in {met} of {len(u.cells)} frames."
    return [
        Curves(f"Contact area with the error of the pose ({in_mm(told.evolution, main)})", "mm²", curves, words=words)
    ]


def largest_within(u: AreaUncertainty, k: int) -> tuple[float, float]:
    """95 % interval of the largest area over the motion, by draws [mm²]."""
    low, high = np.quantile(u.drawn(k).max(axis=0), ENDS) * MM2
    return float(low), float(high)


def congruence_range(told: Told, k: int) -> tuple[float, float, float] | None:
    """Least and largest index of congruence [1/mm] and the least share of the area they are over; None without any."""
    if told.congruence is None:
        return None
    index = told.congruence.index[:, k]
    known = np.isfinite(index)
    if not known.any():
        return None
    share = told.congruence.share[known, k]
    return float(index[known].min()) / MM, float(index[known].max()) / MM, float(share.min())


def congruence_curves(told: Told, k: int) -> list[Curves]:
    """The index of congruence in each frame, where it is known."""
    if congruence_range(told, k) is None or told.congruence is None:
        return []
    index = told.congruence.index[told.frames, k] / MM
    words = "0 where the surfaces fit exactly; 1/R for a sphere of radius R on a plane."
    title = f"Index of congruence ({in_mm(told.evolution, k)})"
    return [Curves(title, "1/mm", [Curve("index of congruence", index)], words=words)]


def _measured(told: Told, k: int) -> list[Points]:
    """What was compared at threshold `k`, along the course of the motion."""
    if told.compared is None:
        return []
    rows = told.compared.rows
    rows = rows[np.isclose(rows["threshold [mm]"], told.evolution.thresholds[k] * MM)]
    course = told.motion.course.values  # noqa: PD011
    return [
        Points(
            f"measured, {MEASURED.get(str(quantity), str(quantity))}",
            np.interp(one["time [s]"].to_numpy(float), told.motion.time, course),
            one["reference [mm^2]"].to_numpy(float),
        )
        for quantity, one in rows.groupby("quantity", sort=False)
    ]


def comparison_tables(told: Told) -> list[Table]:
    """Every measured area beside ours; published ones besides."""
    published = [] if told.published is None else [published_table(told.published)]
    if told.compared is None:
        return published
    rows = told.compared.rows
    texts = rows.map(lambda value: f"{value:.6g}" if isinstance(value, float) else str(value))
    return [
        Table("Compared with the measured areas", tuple(map(str, rows.columns)), texts.to_numpy().tolist()),
        *published,
    ]


SHOWN = ("published", "flexion [deg]", "load [N]", "area_least [mm^2]", "area_most [mm^2]", "ours [mm^2]", "why")
"""Columns of literature.csv that a page has room for."""


def published_table(rows: pd.DataFrame) -> Table:
    """Published areas, what this run has beside them, and why not."""
    texts = rows[list(SHOWN)].map(
        lambda value: "" if value != value else f"{value:.4g}" if isinstance(value, float) else value
    )
    return Table("Beside published areas (sources in literature.csv)", SHOWN, texts.to_numpy().tolist())


def strip(told: Told) -> Strip:
    """Area against threshold in each frame."""
    e = told.evolution
    order = np.argsort(e.sensitivity_thresholds)
    thresholds = np.asarray(e.sensitivity_thresholds)[order]
    values = e.sensitivity[np.ix_(told.frames, order)] * MM2
    if not told.crude:  # the refined area is the better number, where there is one
        values[:, np.isclose(thresholds, e.thresholds[told.main])] = e.fixed.area[told.frames, told.main, None] * MM2
    return Strip(
        title="How much the threshold matters (fixed body, triangles cut)",
        thresholds=thresholds * MM,
        values=values,
        unit="mm²",
        current=e.thresholds[told.main] * MM,
    )
