"""Centre of pressure, force and free moment of a foot on spheres: `geocontact cop`, `gc.centre_of_pressure`.

>>> import geocontact as gc, pandas as pd
>>> heel, ball = (0.0, 0.012, 0.0, 0.012, "heel"), (0.16, 0.012, 0.0, 0.012, "ball")
>>> columns = ["px [m]", "py [m]", "pz [m]", "radius [m]", "zone"]
>>> pd.DataFrame([heel, ball], columns=columns).to_csv("spheres.csv", index=False)
>>> fall = {"time [s]": [0.0, 0.1, 0.2], "tx [mm]": 0, "ty [mm]": [-2, -3, -4], "tz [mm]": 0}
>>> turn = {"rx [deg]": 0, "ry [deg]": 0, "rz [deg]": [0.5, 0.0, -0.5]}
>>> pd.DataFrame(fall | turn).to_csv("foot.csv", index=False)
>>> result = gc.centre_of_pressure("spheres.csv", motion="foot.csv", order="XYZ", stiffness=8e4, damping=0.0)
>>> print(result)
normal force up to 258.0 N; a centre of pressure in 3 of 3 frames
warning: numbers of the force law that were not given are assumed: n = 1.2, mu_s = 0.9, mu_k = 0.7, v_th =
0.25 m/s
"""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import nullcontext
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from jaxtyping import Bool, Float

from geocontact.analyses.cop.feet import Carrier, doubt_weight, spheres_by_foot
from geocontact.analyses.cop.figure import cop_figure
from geocontact.analyses.cop.foot import Foot, low_passed, read
from geocontact.analyses.cop.loads import (
    NAMES,
    SHARE,
    FootLoads,
    along_foot,
    feet_table,
    loads_table,
    mean_normal,
    stance_table,
    stances,
)
from geocontact.analyses.cop.options import CopOptions
from geocontact.analyses.cop.page import cop_page, load_curves
from geocontact.analyses.cop.plates import FOOT, compared, comparison_table, plate_curves, root_mean_squares
from geocontact.analyses.frame.collector import listener, note, reserve, say
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.result import REPORT
from geocontact.data.errors import InputError
from geocontact.data.frame_blocks import parts, worked
from geocontact.geometry.shapes import HalfSpace
from geocontact.io.text.results import frame_of
from geocontact.loads.centre_of_pressure import POINTS, FootAxis, Smooth, axis_of_sole
from geocontact.loads.centre_of_pressure import centre_of_pressure as centre_of
from geocontact.loads.ground import Stairs
from geocontact.loads.opensim_law import OpenSimLaw
from geocontact.loads.resultant import pose_rate
from geocontact.loads.sphere_set import SoleLaw, SphereLoads, beside, clearance, sphere_loads

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from geocontact.view.page.content import Page


FRAME = "ground"
WORDS = "the frame in which the motion gives the foot's pose; forces are those on the foot"
FOOT_WORDS = "distance from the heel along the foot's own axis, and that over the length of the foot"
CENTRES = {"ground": "centre of the ground points", "sphere": "centre of the sphere centres"}


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class CopResult(FootLoads):
    """Loads on a foot over its motion, with tables, figure and page."""

    @property
    def force(self) -> Float[np.ndarray, "t 3"]:
        """Force of the ground on the foot over time, in the frame of the ground [N]."""
        return self.centre.wrench.force

    @property
    def centre_of_pressure(self) -> Float[np.ndarray, "t 3"]:
        """Centre of pressure over time [m]; NaN where the normal force is too small for one."""
        return self.centre.centre

    @property
    def free_moment(self) -> Float[np.ndarray, " t"]:
        """Moment about the normal through the centre of pressure over time [N m]."""
        return self.centre.free_moment

    def tables(self) -> dict[str, pd.DataFrame]:
        """`cop`, `zones`; `feet` of several; `comparison` with a plate, `along_foot` with `toe`, `stances` if asked."""
        found = {"cop": loads_table(self), "zones": self._zones_table()}
        if self.feet:
            found["feet"] = feet_table(self)
        if self.comparison is not None:
            found["comparison"] = self.comparison
        within = along_foot(self)
        if within is not None:
            found["along_foot"] = within
        if self.options.stances:
            found["stances"] = stance_table(self, found["cop"])
        return found

    def figures(self) -> dict[str, Figure]:
        """`cop`: forces, centre and free moment over time, and the path seen from above."""
        time, c = self.foot.motion.time, self.centre
        return {"cop": cop_figure(load_curves(self), time, c.centre, mean_normal(self))}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """The path under the foot, the forces along it, and their numbers in every frame."""
        return {REPORT: cop_page(self)}

    def refers_to(self, table: str) -> Mapping[str, object]:
        """The frame, and which centre is meant."""
        if table == "along_foot":
            return {"frame": "foot", "words": FOOT_WORDS}
        return {"frame": FRAME, "words": WORDS, "cop": CENTRES[self.options.point]}

    def _zones_table(self) -> pd.DataFrame:
        """Normal force of every zone."""
        forces = {f"{name} [N]": force for name, force in self.zones.items()}
        return frame_of({"time [s]": self.foot.motion.time, **forces})


NEAR = 20e-3  # m; a foot that never comes this close is a mistake in the input
REMEDY = "check the frame, the unit and which way is up; see `ground`"


def run(foot: Foot, o: CopOptions) -> CopResult:
    """Load of every frame, and the plate's beside it."""
    loads = _loads(foot, o)
    time = foot.motion.time

    def smooth(values: Float[np.ndarray, "t k"]) -> Float[np.ndarray, "t k"]:
        if not o.force_cutoff:
            return values
        return low_passed(time, values, o.force_cutoff, o.motion, "`force_cutoff`")

    found = {point: centre_of(loads, point, o.gate, smooth if o.force_cutoff else None) for point in POINTS}
    centre = found[o.point]
    several = spheres_by_foot(foot.carriers) if len(foot.feet) > 1 else {}
    feet = {
        name: centre_of(loads.chosen(own), o.point, o.gate, smooth if o.force_cutoff else None)
        for name, own in several.items()
    }
    ours = {name: feet.get(name, centre) for name in foot.plates}
    curves = {name: plate_curves(plate, time, ours[name], o) for name, plate in foot.plates.items()}
    beside_plates = {name: comparison_table(time, ours[name], own) for name, own in curves.items()}
    if feet:
        for name, table in beside_plates.items():
            table.insert(0, FOOT, name)
    result = CopResult(
        options=o,
        foot=foot,
        loads=loads,
        centre=centre,
        centres={point: each.centre for point, each in found.items()},
        axis=None if o.toe is None else _axis(foot, o.toe, o.foot_length),
        feet=feet,
        zones={zone: _zone_force(loads, own, smooth) for zone, own in foot.sole.zones.items()},
        plates=curves,
        comparison=pd.concat(beside_plates.values(), ignore_index=True) if beside_plates else None,
    )
    _summarise(result)
    return result


def _zone_force(loads: SphereLoads, own: Bool[np.ndarray, " n"], smooth: Smooth) -> Float[np.ndarray, " t"]:
    of_zone = worked(lambda part: np.ascontiguousarray(part[:, own]), loads.pressing)
    return worked(lambda part: part.sum(axis=1), smooth(of_zone))


def _axis(foot: Foot, toe: str, length: float | None) -> FootAxis:
    """`toe` is an axis with its sign: x, -z."""
    direction = np.eye(3)["xyz".index(toe[-1])] * (-1.0 if toe.startswith("-") else 1.0)
    return axis_of_sole(foot.sole, direction, length)


def _loads(foot: Foot, o: CopOptions) -> SphereLoads:
    if len(foot.motion) == 1 and foot.law.needs_velocity:
        reserve(f"{o.motion} has one frame: the foot is assumed to stand still")
    try:
        # only a mesh asks a kernel: on other grounds numba is not even loaded
        with nullcontext() if isinstance(foot.ground, HalfSpace | Stairs) else listener().preparing():
            loads = beside([_of_body(foot, k) for k in range(len(foot.carriers))])
    except ValueError as error:
        raise InputError(o.motion, "", str(error), REMEDY) from error
    _reserve_oddities(foot, loads, o)
    return loads


def _of_body(foot: Foot, k: int) -> SphereLoads:
    """Loads on the spheres of one body."""
    body: Carrier = foot.carriers[k]
    law = foot.law
    if len(foot.carriers) > 1:
        law = law.chosen(np.repeat(np.arange(len(foot.carriers)) == k, [len(one.sole) for one in foot.carriers]))
    rate = pose_rate(body.motion.time, body.motion.poses)
    return sphere_loads(body.sole, law, body.motion.poses, rate, foot.ground)


def _reserve_oddities(foot: Foot, loads: SphereLoads, o: CopOptions) -> None:
    if not any((part > 0.0).any() for (part,) in parts(loads.depth)):
        gap = clearance(foot.sole, loads, foot.ground)
        if gap > NEAR:
            what = f"the foot stays {gap * 1e3:.0f} mm above the ground in every frame"
            raise InputError(o.motion, "", what, REMEDY)
        reserve(f"no sphere touches the ground; the nearest comes within {gap * 1e3:.2f} mm")
    beneath = sum(int((part > foot.sole.radius).any(axis=1).sum()) for (part,) in parts(loads.depth))
    if beneath:
        reserve(f"centres of spheres are under the ground in {beneath} frames: too soft, or misplaced")


def _summarise(r: CopResult) -> None:
    c, law = r.centre, r.foot.law
    found = np.isfinite(c.centre[:, 0])
    if c.pressing.any() and not found.any():
        reserve(f"no centre of pressure: the normal force stays below the gate of {r.options.gate:g} N")
    doubt_weight(c.pressing, r.foot.weight, r.options)
    note(
        "cop",
        {
            "frames": len(r.foot.motion),
            "frames_with_cop": int(found.sum()),
            "peak_normal_N": round(float(c.pressing.max()), 6),
            "point": r.options.point,
            "law": _law_of_model(law) if isinstance(law, OpenSimLaw) else _law_of_sole(law),
        },
    )
    say(f"normal force up to {c.pressing.max():.1f} N; a centre of pressure in {found.sum()} of {len(found)} frames")
    for name, c in r.feet.items():
        say(f"{name}: normal force up to {c.pressing.max():.1f} N")
    _report_foot(r)
    for name, table in compared(r.comparison).items():
        _report_comparison(name, table, root_mean_squares(table))


def _law_of_sole(law: SoleLaw) -> dict[str, object]:
    return {
        "k": sorted(set(law.stiffness.tolist())),
        "b": sorted(set(law.damping.tolist())),
        "n": law.exponent,
        "delta_full_m": law.full_depth,
        "mu_s": _one_or_all(law.static),
        "mu_k": _one_or_all(law.kinetic),
        "v_th_m_per_s": law.threshold_speed,
    }


def _law_of_model(law: OpenSimLaw) -> dict[str, object]:
    return {
        "smooth": bool(law.smooth.all()) if law.smooth.all() == law.smooth.any() else law.smooth.tolist(),
        "modulus_Pa": _one_or_all(law.modulus),
        "dissipation_s_per_m": _one_or_all(law.dissipation),
        "transition_m_per_s": _one_or_all(law.transition),
        "static": _one_or_all(law.static),
        "dynamic": _one_or_all(law.dynamic),
        "viscous_s_per_m": _one_or_all(law.viscous),
    }


def _report_foot(r: CopResult) -> None:
    """Length of the foot and where the centre goes along it; how many stances are complete."""
    within = along_foot(r)
    if within is not None and r.axis is not None:
        told: dict[str, float | None] = {"length_mm": round(r.axis.length * 1e3, 6)}
        for name in within.columns:
            if str(name).endswith(SHARE):
                known = within[name].dropna()
                for end, value in (("from", known.min()), ("to", known.max())):
                    told[f"{str(name).removesuffix(SHARE)}_{end}"] = round(float(value), 9) if len(known) else None
        note("along_foot", told)
        least, most = (told[f"{NAMES[r.options.point]}_{end}"] for end in ("from", "to"))
        if least is not None and most is not None:
            length = f"foot of {r.axis.length * 1e3:.0f} mm"
            say(f"centre of pressure at {least:.0%} to {most:.0%} of the {length}, from the heel")
    if r.options.stances:
        count = len(stances(r))
        note("stances", count)
        if not count:
            reserve(f"no complete stance: the normal force does not rise through {r.options.gate:g} N and fall again")


def _one_or_all(values: Float[np.ndarray, " n"]) -> float | list[float]:
    """The value that all spheres share, else all that occur."""
    found = sorted(set(values.tolist()))
    return found[0] if len(found) == 1 else found


def _report_comparison(foot: str, table: pd.DataFrame, differences: dict[str, float | None]) -> None:
    note(f"comparison {foot}".strip(), {"rows": len(table), **differences})
    shown = ", ".join(f"{name[4:]} {value:.4g}" for name, value in differences.items() if value is not None)
    of = f"{foot}: " if foot else ""
    say(f"{of}root mean square difference to the plate: {shown or 'nothing to compare above the gate'}")


centre_of_pressure = Job("cop", CopOptions, read, run)
