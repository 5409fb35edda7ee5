"""The page of a centre of pressure: where under the foot, how the force stands on it, how much and when."""

from __future__ import annotations

import numpy as np
import pandas as pd
from jaxtyping import Float, Int
from scipy.spatial import ConvexHull

from geocontact.analyses.cop.figure import PERCENT, stance_curves
from geocontact.analyses.cop.loads import SHARE, FootLoads, along_foot, mean_normal, reach_of_centre
from geocontact.analyses.cop.plates import compared, root_mean_squares
from geocontact.analyses.frame.pages import thinned
from geocontact.analyses.frame.words import NOT_A_DEVICE, counted, rounded
from geocontact.data.frame_blocks import blocks, release, worked
from geocontact.data.motion import MATRIX, Course
from geocontact.data.text import seconds
from geocontact.loads.centre_of_pressure import path_length, points_in_foot
from geocontact.view.curves.declared import INK, Curve, Curves, CurveSheet
from geocontact.view.page.content import (
    Mark,
    Page,
    Plan,
    Readout,
    Row,
    Section,
    Table,
    Track,
    Words,
)

MM = 1e3
ROUND = np.linspace(0.0, 2.0 * np.pi, 49)
VECTORS = 60  # forces drawn at most
TALL = 0.6  # of the ground's length, how high the largest force is drawn
LEAST = 0.1  # m; a path may be shorter than the drawing
ZONES = 5  # named at most
FOOT = "Seen from above, in the foot's frame: spheres that stand for the sole, their outline, and the path."
BODIES = f"{FOOT} Spheres on another body than the first are drawn as in the first frame of the motion."


def axis_name(axis: int, sign: float = 1.0) -> str:
    """ "x", "−z"."""
    return ("" if sign > 0.0 else "−") + "xyz"[axis]


def foot_plan(r: FootLoads, shown: Int[np.ndarray, " k"]) -> Plan:
    """Spheres, their outline and the path, seen against the ground's normal: the longer way lies across."""
    sole = r.foot.sole
    across, up, sign = _view_axes(r)

    def flat(points: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "n 2"]:
        return points[:, [across, up]] * (1.0, sign) * MM

    middle, radius = flat(sole.centre), sole.radius * MM
    circles = middle[:, None] + radius[:, None, None] * np.column_stack([np.cos(ROUND), np.sin(ROUND)])
    corners = circles.reshape(-1, 2)
    edge = ConvexHull(corners).vertices
    zones = list(sole.zones.items())
    marks = [Mark(name, _edge(circles[which])) for name, which in zones] if len(zones) <= ZONES else []
    poses = r.foot.motion.poses[shown]
    tracks = [Track("centre of pressure", flat(points_in_foot(r.centre.centre[shown], poses)))]
    if r.plate is not None:
        there = np.full_like(r.centre.centre, np.nan)
        there[r.plate.frames] = r.plate.centre
        tracks.append(Track("force plate", flat(points_in_foot(there[shown], poses))))
    outline = corners[[*edge, edge[0]]]
    return Plan(
        "Path under the foot",
        "mm",
        axis_name(across),
        axis_name(up, sign),
        [outline, *circles],
        tracks,
        marks,
        words=BODIES if len(r.foot.carriers) > 1 else FOOT,
    )


def ground_plan(r: FootLoads, shown: Int[np.ndarray, " k"]) -> Plan:
    """Path of the centre of each foot and of all feet together, seen against the ground's normal."""
    upward = _upward(r)
    across, up = [axis for axis in range(3) if axis != (1 if upward is None else upward)]
    centres = {"all feet": r.centre.centre, **{name: c.centre for name, c in r.feet.items()}}
    tracks = [Track(name, centre[shown][:, [across, up]] * MM) for name, centre in centres.items()]
    return Plan("Paths on the ground", "mm", axis_name(across), axis_name(up), [], tracks, words=FEET)


FEET = "Seen from above, in the frame of the ground: centre of pressure of each foot, and of all feet together."


def butterfly(r: FootLoads, shown: Int[np.ndarray, " k"]) -> Plan | None:
    """Forces on the foot, each from its centre of pressure, seen across the way that the centre takes (Pedotti).

    None where there is no centre of pressure.
    """
    c = r.centre
    upward = _upward(r)
    if upward is None:
        return None
    reach, along = _along(r, upward)
    plane = [along, upward]
    sizes = worked(lambda force: np.linalg.norm(force[:, plane], axis=1), c.wrench.force)
    some = np.flatnonzero(np.isfinite(c.centre[:, 0]))
    scale = _round_scale(TALL * max(reach, LEAST) * MM / float(sizes[some].max()))  # mm for 1 N

    def ends(frames: Int[np.ndarray, " k"]) -> tuple[Float[np.ndarray, "k 2"], Float[np.ndarray, "k 2"]]:
        start = c.centre[frames][:, plane] * MM
        return start, start + scale * c.wrench.force[frames][:, plane]

    some = some[np.unique(np.linspace(0, len(some) - 1, VECTORS).astype(int))]
    start, tip = ends(shown)
    words = f"Each line is the force in one frame, from its centre of pressure: 100 N are {100.0 * scale:g} mm long."
    return Plan(
        "Forces along the path (butterfly diagram)",
        "mm",
        axis_name(along),
        axis_name(upward),
        list(np.stack(ends(some), axis=1)),
        [Track("centre of pressure", start), Track("force", tip, [f"{size:.0f} N" for size in sizes[shown]])],
        words=words,
    )


def travel(r: FootLoads) -> tuple[float, str]:
    """How far the centre of pressure goes on the ground [m], and along which axis it goes the most."""
    way, along = _along(r, _upward(r))
    return way, axis_name(along)


def _along(r: FootLoads, upward: int | None) -> tuple[float, int]:
    """How far the path goes along the axis of the ground along which it is longest [m], and that axis."""
    reach = reach_of_centre(r)
    across = [axis for axis in range(3) if axis != upward]
    along = max(across, key=lambda axis: float(reach[axis]))
    return float(reach[along]), along


def _view_axes(r: FootLoads) -> tuple[int, int, float]:
    """Axes of the foot to the right and upwards in the drawing, and the sign of the latter, for a view from above."""
    known, seen = 0, np.zeros(3)
    for some in blocks(len(r.foot.motion), MATRIX):
        turned = r.foot.motion.poses[some].rotation.inv().as_matrix()
        own = r.centre.normal[some]
        there = np.isfinite(own[:, 0])
        seen += np.einsum("tij,tj->i", turned[there], own[there])
        known += int(there.sum())
        release()
    thinnest = np.ptp(r.foot.sole.centre) - np.ptp(r.foot.sole.centre, axis=0)
    normal = seen / known if known else thinnest
    above = int(np.argmax(np.abs(normal)))
    sides = [(above + 1) % 3, (above + 2) % 3]
    reach = np.ptp(r.foot.sole.centre, axis=0)
    across, up = sorted(sides, key=lambda axis: -float(reach[axis]))
    right_handed = 1.0 if (across + 1) % 3 == up else -1.0
    return across, up, right_handed * (1.0 if normal[above] >= 0.0 else -1.0)


def _edge(circles: Float[np.ndarray, "n c 2"]) -> tuple[float, float]:
    """Above the middle of a zone, where its name does not cover the path."""
    points = circles.reshape(-1, 2)
    middle = circles.mean(axis=(0, 1))
    return float(middle[0]), float(points[:, 1].max())


def _round_scale(scale: float) -> float:
    """The largest of 1, 2, 5 times a power of ten that is not above `scale`."""
    power = 10.0 ** np.floor(np.log10(scale))
    return float(power * max(step for step in (1.0, 2.0, 5.0) if step <= scale / power * (1.0 + 1e-9)))


AXES = "xyz"
NO_MOMENT = 1e-6  # N m; less is what rounding leaves


def headline(r: FootLoads) -> list[str]:
    """Largest force and way of the centre; in how many frames there is one; the plate's difference."""
    time, c = r.foot.motion.time, r.centre
    found = np.isfinite(c.centre[:, 0])
    if not c.pressing.any():
        return ["No sphere touches the ground: there is no force and no centre of pressure."]
    k = int(np.argmax(c.pressing))
    what = "all feet together" if r.feet else "the foot"
    said = f"The ground presses on {what} with up to {rounded(c.pressing[k], 3)} N, at {_at(time[k])}"
    if not found.any():
        return [f"{said}: too little for a centre of pressure, which needs {r.options.gate:g} N."]
    way, along = travel(r)
    lines = [f"{said}; its centre of pressure moves {way * MM:.0f} mm along {along}."]
    if not found.all():
        lines.append(
            f"There is a centre of pressure in {found.sum()} of {counted(len(found), 'frame')}; "
            f"in the others the normal force is below {r.options.gate:g} N."
        )
    return lines + _beside(r)


def _beside(r: FootLoads) -> list[str]:
    """Difference to the plate as one distance and one force."""
    lines = []
    for name, table in compared(r.comparison).items():
        rms = root_mean_squares(table)
        force = [rms[f"rms_force_{axis} [N]"] for axis in AXES]
        centre = [rms[f"rms_cop_{axis} [m]"] for axis in AXES]
        told = [f"the force differs by {_length(force):.3g} N"]
        if None not in centre:
            told.append(f"the centre of pressure by {_length(centre) * MM:.3g} mm")
        whose = f"{name}: compared" if name else "Compared"
        lines.append(f"{whose} with the force plate {' and '.join(told)} (root mean square).")
    return lines


def _at(time: float) -> str:
    return f"{seconds(round(float(time), 3))} s"


def _length(parts: list[float | None]) -> float:
    return float(np.sqrt(sum(part**2 for part in parts if part is not None)))


def facts(r: FootLoads) -> list[tuple[str, str]]:
    """How much, for how long, under what, how far, and how it turns."""
    time, c = r.foot.motion.time, r.centre
    found, touching = np.isfinite(c.centre[:, 0]), c.pressing > 0.0
    k = int(np.argmax(c.pressing))
    lines = [("Largest normal force", f"{c.pressing[k]:.0f} N at {_at(time[k])}")]
    if touching.any():
        first, last = time[np.flatnonzero(touching)[[0, -1]]]
        lines.append(("On the ground", f"{_at(first)} to {_at(last)}"))
        zones = {name: float(force.sum()) for name, force in r.zones.items()}
        most = max(zones, key=lambda name: zones[name])
        lines.append(("Zone that bears most", f"{most}, {zones[most] / sum(zones.values()):.0%} of all force"))
    if found.any():
        lines.append(("Length of the path", f"{path_length(c.centre) * MM:.0f} mm"))
        turn = c.free_moment[found]
        if np.abs(turn).max() > NO_MOMENT:
            lines.append(("Free moment", f"{turn.min():.2g} … {turn.max():.2g} N m"))
    return lines


def foot_curves(r: FootLoads) -> list[Curves]:
    """Place of each centre from the heel [% of the foot's length]."""
    within = along_foot(r)
    if within is None:
        return []
    shares = [str(name) for name in within.columns if str(name).endswith(SHARE)]
    curves = [
        Curve(name.removesuffix(SHARE).replace("_", " "), within[name].to_numpy(float) * PERCENT) for name in shares
    ]
    return [Curves("Centre of pressure along the foot, from the heel", "% of foot length", curves)]


SPHERES, PLATE = "spheres", "force plate"
LAW = (
    "Forces follow from how deep spheres of given stiffness stand in the ground. A millimetre of error in the motion "
    "is a large part of that depth: sizes of forces are only as accurate as motion and stiffness; the centre of "
    "pressure depends on them less."
)


def cop_page(r: FootLoads) -> Page:
    """The page before it becomes a file."""
    time, c = r.foot.motion.time, r.centre
    shown = thinned(len(time), [c.pressing, *c.wrench.force.T], [int(np.argmax(c.pressing))])
    forces = butterfly(r, shown)
    sections: list[Section] = [
        ground_plan(r, shown) if r.feet else foot_plan(r, shown),
        Readout(_rows(r, shown)),
        *([] if forces is None else [forces]),
        *load_curves(r).at(shown),
        *_further_curves(r).at(shown),
        *stance_curves(r),
        *_comparison(r),
        Words("What the numbers rest on", [LAW, NOT_A_DEVICE]),
    ]
    part = f"the page shows {len(shown)} of {len(time)} frames; cop.csv has them all"
    return Page(
        title=f"Centre of pressure of {r.foot.name}",
        subtitle=f"{len(r.foot.sole)} spheres on the ground, motion {r.options.motion.name}",
        time=time[shown],
        time_label="time [s]",
        headline=headline(r),
        facts=facts(r),
        reservations=(part,) if len(shown) < len(time) else (),
        start_frame=int(np.argmax(c.pressing[shown])),
        sections=tuple(sections),
        numbers=shown + 1,
        total=len(time),
    )


def _rows(r: FootLoads, shown: Int[np.ndarray, " k"]) -> list[Row]:
    c = r.centre
    own = r.loads.depth[shown]
    touching, depth = np.count_nonzero(own > 0.0, axis=1), np.maximum(own.max(axis=1), 0.0)
    return [
        Row("normal force", "N", _texts(c.pressing[shown], 1)),
        *(Row(f"force {axis}", "N", _texts(c.wrench.force[shown, k], 1)) for k, axis in enumerate("xyz")),
        *(Row(f"centre of pressure {axis}", "mm", _texts(c.centre[shown, k] * MM, 1)) for k, axis in enumerate("xyz")),
        Row("free moment", "N m", _texts(c.free_moment[shown], 2)),
        Row("spheres that touch", "", [str(count) for count in touching]),
        Row("greatest depth", "mm", _texts(depth * MM, 2)),
    ]


def load_curves(r: FootLoads) -> CurveSheet:
    """Force, centre and free moment over time, each beside the plate's where there is one."""
    c, plate, axes = r.centre, r.plate, "xyz"
    force, centre, moment = c.wrench.force, worked(lambda part: part * MM, c.centre), worked(_plain, c.free_moment)
    if plate is None:
        panels = [
            Curves("Force on the foot", "N", [Curve(axis, force[:, k]) for k, axis in enumerate(axes)]),
            Curves(
                "Centre of pressure on the ground", "mm", [Curve(axis, centre[:, k]) for k, axis in enumerate(axes)]
            ),
            Curves("Free moment", "N m", [Curve("free moment", moment)]),
        ]
    else:
        theirs = _plate_at(r, plate.force), _plate_at(r, plate.centre) * MM
        turning = _plain(_plate_at(r, plate.free_moment[:, None])[:, 0])

        def both(ours: Float[np.ndarray, " t"], plates: Float[np.ndarray, " t"]) -> list[Curve]:
            return [Curve(SPHERES, ours, stroke=0), Curve(PLATE, plates, stroke=INK)]

        panels = [
            *(
                Curves(f"Force on the foot, {axis}", "N", both(force[:, k], theirs[0][:, k]))
                for k, axis in enumerate(axes)
            ),
            *(
                Curves(f"Centre of pressure on the ground, {axis}", "mm", both(centre[:, k], theirs[1][:, k]))
                for k, axis in enumerate(axes)
                if k != _upward(r)
            ),
            Curves("Free moment", "N m", both(moment, turning)),
        ]
    return CurveSheet(panels, Course("time", "s", r.foot.motion.time))


def _further_curves(r: FootLoads) -> CurveSheet:
    """Force of each zone, difference to the plate, and the centres along the foot."""
    force, panels = r.centre.wrench.force, []
    if r.feet:
        curves = [Curve(name, c.pressing) for name, c in r.feet.items()]
        panels.append(Curves("Normal force of each foot", "N", curves))
    if len(r.zones) > 1:
        panels.append(Curves("Normal force of each zone", "N", [Curve(name, own) for name, own in r.zones.items()]))
    if r.plate is not None:
        off = force - _plate_at(r, r.plate.force)
        curves = [Curve(axis, off[:, k]) for k, axis in enumerate("xyz")]
        panels.append(Curves("Difference in force (spheres − plate)", "N", curves))
    return CurveSheet([*panels, *foot_curves(r)])


def _plate_at(r: FootLoads, values: Float[np.ndarray, "f n"]) -> Float[np.ndarray, "t n"]:
    """What a plate shows at all of our frames; NaN beyond its recording."""
    frames = np.empty(0, int) if r.plate is None else r.plate.frames
    found = np.full((len(r.foot.motion), values.shape[1]), np.nan)
    found[frames] = values
    return found


def _upward(r: FootLoads) -> int | None:
    """Axis nearest to the ground's normal; None where there is no centre."""
    normal = mean_normal(r)
    return None if normal is None else int(np.argmax(np.abs(normal)))


def _comparison(r: FootLoads) -> list[Table]:
    """Every quantity's difference to the plate: root mean square, mean, largest."""
    return [_differences(name, table) for name, table in compared(r.comparison).items()]


def _differences(foot: str, table: pd.DataFrame) -> Table:
    rows = []
    for name in table.columns:
        if not str(name).startswith("difference_"):
            continue
        label, _, unit = str(name).removeprefix("difference_").removesuffix("]").partition(" [")
        per, unit = (MM, "mm") if unit == "m" else (1.0, unit)
        values = _plain(table[name].dropna().to_numpy(float)) * per
        told = (
            [f"{np.sqrt(np.mean(values**2)):.3g}", f"{values.mean():.3g}", f"{values[np.argmax(np.abs(values))]:.3g}"]
            if len(values)
            else ["–"] * 3
        )
        rows.append((label.replace("cop_", "centre of pressure ").replace("_", " "), unit, *told, str(len(values))))
    header = ("", "unit", "root mean square", "mean", "largest", "frames")
    of = f"{foot}: difference" if foot else "Difference"
    return Table(f"{of} to the force plate (spheres − plate)", header, rows)


def _plain(values: Float[np.ndarray, " k"]) -> Float[np.ndarray, " k"]:
    """Without what rounding leaves of zeros: curves of 1e-17 would be drawn as if they were something."""
    return np.where(np.abs(values) < NO_MOMENT, 0.0, values)


def _texts(values: Float[np.ndarray, " k"], digits: int) -> list[str]:
    return ["–" if np.isnan(value) else f"{value:.{digits}f}" for value in values]
