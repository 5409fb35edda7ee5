"""The page of a centre of pressure: where under the foot, how the force stands on it, how much and when."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float, Int

from geocontact.analyses.cop.foot_loads import FootLoads
from geocontact.analyses.cop.page_answer import NO_MOMENT, facts, headline
from geocontact.analyses.cop.page_plans import MM, butterfly, foot_plan
from geocontact.analyses.cop.page_stances import foot_curves, stance_pictures
from geocontact.analyses.page_frames import thinned
from geocontact.analyses.page_words import NOT_A_DEVICE
from geocontact.view.page.content import Curve, Curves, Page, Readout, Row, Section, Table, Words

SPHERES, PLATE = "spheres", "force plate"
LAW = (
    "Forces follow from how deep spheres of given stiffness stand in the ground. A millimetre of error in the motion "
    "is a large part of that depth: sizes of forces are as good as motion and stiffness, the place of the centre "
    "depends on them less."
)


def cop_page(r: FootLoads) -> Page:
    """The page before it becomes a file."""
    time, c = r.foot.motion.time, r.centre
    shown = thinned(len(time), [c.pressing, *c.wrench.force.T], [int(np.argmax(c.pressing))])
    forces = butterfly(r, shown)
    sections: list[Section] = [
        foot_plan(r, shown),
        Readout(_rows(r, shown)),
        *([] if forces is None else [forces]),
        *_curves(r, shown),
        *foot_curves(r, shown),
        *stance_pictures(r),
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
    touching = np.count_nonzero(r.loads.depth > 0.0, axis=1)
    depth = np.maximum(r.loads.depth.max(axis=1), 0.0)
    return [
        Row("normal force", "N", _texts(c.pressing[shown], 1)),
        *(Row(f"force {axis}", "N", _texts(c.wrench.force[shown, k], 1)) for k, axis in enumerate("xyz")),
        *(Row(f"centre of pressure {axis}", "mm", _texts(c.centre[shown, k] * MM, 1)) for k, axis in enumerate("xyz")),
        Row("free moment", "N m", _texts(c.free_moment[shown], 2)),
        Row("spheres that touch", "", [str(count) for count in touching[shown]]),
        Row("greatest depth", "mm", _texts(depth[shown] * MM, 2)),
    ]


def _curves(r: FootLoads, shown: Int[np.ndarray, " k"]) -> list[Curves]:
    """Forces, force of each zone, centre and free moment; each beside the plate's where there is one."""
    c, zones = r.centre, r.zones
    of_zones = [Curve(name, force[shown]) for name, force in zones.items()]
    centre = [Curve(axis, c.centre[shown, k] * MM) for k, axis in enumerate("xyz")]
    plate = r.plate
    if plate is None:
        forces = [Curve(axis, c.wrench.force[shown, k]) for k, axis in enumerate("xyz")]
        panels = [Curves("Force on the foot", "N", forces)]
        after = [
            Curves("Centre of pressure on the ground", "mm", centre),
            Curves("Free moment", "N m", [Curve("free moment", _plain(c.free_moment[shown]))]),
        ]
    else:
        moments = c.free_moment, _at(r, plate.free_moment[:, None])[:, 0]
        theirs = _at(r, plate.force)[shown], _at(r, plate.centre)[shown] * MM

        def both(ours: Float[np.ndarray, " k"], plates: Float[np.ndarray, " k"]) -> list[Curve]:
            return [Curve(SPHERES, ours), Curve(PLATE, plates)]

        panels = [
            Curves(f"Force on the foot, {axis}", "N", both(c.wrench.force[shown, k], theirs[0][:, k]))
            for k, axis in enumerate("xyz")
        ]
        after = [
            *(
                Curves(f"Centre of pressure on the ground, {axis}", "mm", both(centre[k].values, theirs[1][:, k]))
                for k, axis in enumerate("xyz")
                if k != _upward(r)
            ),
            Curves("Free moment", "N m", both(*(_plain(each[shown]) for each in moments))),
            Curves(
                "Difference in force (spheres − plate)",
                "N",
                [Curve(axis, c.wrench.force[shown, k] - theirs[0][:, k]) for k, axis in enumerate("xyz")],
            ),
        ]
    return [*panels, *([Curves("Normal force of each zone", "N", of_zones)] if len(zones) > 1 else []), *after]


def _at(r: FootLoads, values: Float[np.ndarray, "f n"]) -> Float[np.ndarray, "t n"]:
    """What a plate shows at all of our frames; NaN beyond its recording."""
    frames = np.empty(0, int) if r.plate is None else r.plate.frames
    found = np.full((len(r.foot.motion), values.shape[1]), np.nan)
    found[frames] = values
    return found


def _upward(r: FootLoads) -> int | None:
    """Axis nearest to the ground's normal; None where there is no centre."""
    known = r.centre.normal[np.isfinite(r.centre.normal[:, 0])]
    return int(np.argmax(np.abs(known.mean(axis=0)))) if len(known) else None


def _comparison(r: FootLoads) -> list[Table]:
    """Every quantity's difference to the plate: root mean square, mean, largest."""
    if r.comparison is None:
        return []
    rows = []
    for name in r.comparison.columns:
        if not str(name).startswith("difference_"):
            continue
        label, _, unit = str(name).removeprefix("difference_").removesuffix("]").partition(" [")
        per, unit = (MM, "mm") if unit == "m" else (1.0, unit)
        values = _plain(r.comparison[name].dropna().to_numpy(float)) * per
        told = (
            [f"{np.sqrt(np.mean(values**2)):.3g}", f"{values.mean():.3g}", f"{values[np.argmax(np.abs(values))]:.3g}"]
            if len(values)
            else ["–"] * 3
        )
        rows.append((label.replace("cop_", "centre of pressure ").replace("_", " "), unit, *told, str(len(values))))
    header = ("", "unit", "root mean square", "mean", "largest", "frames")
    return [Table("Difference to the force plate (spheres − plate)", header, rows)]


def _plain(values: Float[np.ndarray, " k"]) -> Float[np.ndarray, " k"]:
    """Without what rounding leaves of zeros: curves of 1e-17 would be drawn as if they were something."""
    return np.where(np.abs(values) < NO_MOMENT, 0.0, values)


def _texts(values: Float[np.ndarray, " k"], digits: int) -> list[str]:
    return ["–" if np.isnan(value) else f"{value:.{digits}f}" for value in values]
