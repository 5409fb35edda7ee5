"""The centre of pressure of a foot on spheres."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.analyses.cop.force_plate import comparison_table, plate_curves, root_mean_squares
from geocontact.analyses.cop.options import CopOptions
from geocontact.analyses.cop.read import Foot
from geocontact.analyses.cop.result import CopResult
from geocontact.analyses.run_record import Record
from geocontact.data.errors import InputError
from geocontact.loads.centre_of_pressure import centre_of_pressure
from geocontact.loads.pose_rate import pose_rate
from geocontact.loads.sphere_loads import SphereLoads, sphere_loads

NEAR = 20e-3  # m; a foot that never comes this close is a mistake in the input
REMEDY = "check the frame, the unit and which way is up; see `ground`"


def run(foot: Foot, o: CopOptions, record: Record) -> CopResult:
    """Load of every frame, and the plate's beside it."""
    loads = _loads(record, foot, o)
    centre = centre_of_pressure(loads, o.point, o.gate)
    time = foot.motion.time
    curves = None if foot.plate is None else plate_curves(foot.plate, time, centre, o)
    comparison = None if curves is None else comparison_table(time, centre, curves)
    result = CopResult(
        record=record, options=o, foot=foot, loads=loads, centre=centre, plate=curves, comparison=comparison
    )
    _summarise(result)
    return result


def _loads(record: Record, foot: Foot, o: CopOptions) -> SphereLoads:
    if len(foot.motion) == 1 and foot.law.needs_velocity:
        record.warn(f"{o.motion} has one frame: the foot is taken to stand still")
    rate = pose_rate(foot.motion.time, foot.motion.poses)
    try:
        with record.listener.preparing():
            loads = sphere_loads(foot.sole, foot.law, foot.motion.poses, rate, foot.ground)
    except ValueError as error:
        raise InputError(o.motion, "", str(error), REMEDY) from error
    _say_what_is_odd(record, foot, loads, o)
    return loads


def _say_what_is_odd(record: Record, foot: Foot, loads: SphereLoads, o: CopOptions) -> None:
    touching = loads.depth > 0.0
    if not touching.any():
        distance = foot.ground.proximity(loads.centre.reshape(-1, 3)).distance.reshape(loads.depth.shape)
        gap = float((distance - foot.sole.radius).min())
        if gap > NEAR:
            what = f"the foot stays {gap * 1e3:.0f} mm above the ground in every frame"
            raise InputError(o.motion, "", what, REMEDY)
        record.warn(f"no sphere touches the ground; the nearest comes within {gap * 1e3:.2f} mm")
    beneath = (loads.depth > foot.sole.radius).any(axis=1)
    if beneath.any():
        record.warn(f"centres of spheres are under the ground in {int(beneath.sum())} frames: too soft, or misplaced")


def _summarise(r: CopResult) -> None:
    record, c, law = r.record, r.centre, r.foot.law
    found = np.isfinite(c.centre[:, 0])
    if c.pressing.any() and not found.any():
        record.warn(f"no centre of pressure: the normal force stays below the gate of {r.options.gate:g} N")
    record.results["cop"] = {
        "frames": len(r.foot.motion),
        "frames_with_cop": int(found.sum()),
        "peak_normal_N": round(float(c.pressing.max()), 6),
        "point": r.options.point,
        "law": {
            "k": sorted(set(law.stiffness.tolist())),
            "b": sorted(set(law.damping.tolist())),
            "n": law.exponent,
            "delta_full_m": law.full_depth,
            "mu_s": _one_or_all(law.static),
            "mu_k": _one_or_all(law.kinetic),
            "v_th_m_per_s": law.threshold_speed,
        },
    }
    record.say(
        f"normal force up to {c.pressing.max():.1f} N; a centre of pressure in {found.sum()} of {len(found)} frames"
    )
    if r.comparison is not None:
        _tell_comparison(r, root_mean_squares(r.comparison))


def _one_or_all(values: Float[np.ndarray, " n"]) -> float | list[float]:
    """The value that all spheres share, else all that occur."""
    found = sorted(set(values.tolist()))
    return found[0] if len(found) == 1 else found


def _tell_comparison(r: CopResult, differences: dict[str, float | None]) -> None:
    rows = 0 if r.comparison is None else len(r.comparison)
    r.record.results["comparison"] = {"rows": rows, **differences}
    shown = ", ".join(f"{name[4:]} {value:.4g}" for name, value in differences.items() if value is not None)
    r.record.say(f"root mean square difference to the plate: {shown or 'nothing to compare above the gate'}")
