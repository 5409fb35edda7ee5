"""The centre of pressure of a foot on spheres: reads, computes, writes, says what it found."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path

import numpy as np

from geocontact.analyses.cop.force_plate import chosen_plate, comparison_table, plate_curves, root_mean_squares
from geocontact.analyses.cop.ground import ground_of
from geocontact.analyses.cop.law import sole_law
from geocontact.analyses.cop.write import Foot, write_results
from geocontact.analyses.progress import preparing
from geocontact.analyses.results_folder import written_whole
from geocontact.analyses.run_record import Record
from geocontact.cli.cop import CopOptions
from geocontact.data.errors import InputError
from geocontact.data.motion import Motion
from geocontact.io.motion.motion import read_motion
from geocontact.io.recordings.spheres import read_spheres
from geocontact.loads.centre_of_pressure import CentreOfPressure, centre_of_pressure
from geocontact.loads.ground import Ground
from geocontact.loads.pose_rate import pose_rate
from geocontact.loads.sphere_loads import SphereLoads, sphere_loads
from geocontact.loads.sphere_set import SoleLaw, SphereSet

NEAR = 20e-3  # m; a foot that never comes this close is a mistake in the input


def analyse(spheres: Path, o: CopOptions) -> int:
    """Run the whole analysis."""
    record = Record("cop", {"spheres": spheres, **asdict(o)})
    _refuse_idle(o)
    with record.catching_warnings(), written_whole(o.out) as draft:
        ground = ground_of(record, o)
        table = read_spheres(spheres)
        record.add_input("spheres", spheres, spheres=len(table.radius))
        sole = SphereSet(table.centre, table.radius, table.zone)
        law = sole_law(record, table, o)
        motion = _motion(record, o)
        plate = chosen_plate(record, o)
        loads = _loads(record, Foot(spheres.name, sole, law, motion), ground, o)
        centre = centre_of_pressure(loads, o.point, o.gate)
        curves = None if plate is None else plate_curves(plate, motion.time, centre, o)
        comparison = None if curves is None else comparison_table(motion.time, centre, curves)
        _summarise(record, motion, centre, law, o)
        if comparison is not None:
            differences = root_mean_squares(comparison)
            record.results["comparison"] = {"rows": len(comparison), **differences}
            shown = ", ".join(f"{name[4:]} {value:.4g}" for name, value in differences.items() if value is not None)
            record.say(f"root mean square difference to the plate: {shown or 'nothing to compare above the gate'}")
        write_results(Foot(spheres.name, sole, law, motion), loads, centre, curves, comparison, o, draft)
        record.write(draft)
        written = sorted(file.name for file in draft.iterdir())
    record.say(f"results in {o.out}: {', '.join(written)}")
    record.speak()
    return 0


def _refuse_idle(o: CopOptions) -> None:
    rows = (
        (not (np.isfinite(o.gate) and o.gate >= 0.0), "--gate", f"{o.gate:g} is not a force of 0 N or more", "e.g. 20"),
        (o.map is not None and o.osim is not None, "--map", "beside --osim names the columns twice", "give one"),
        (o.moving_body is not None and o.osim is None, "--moving", "needs a joint", "give --osim and --joint"),
        (o.order is not None and o.osim is not None, "--order", "does nothing beside --osim", "leave it out"),
    )  # fmt: skip
    for wrong, option, what, remedy in rows:
        if wrong:
            raise InputError("", option, what, remedy)


def _motion(record: Record, o: CopOptions) -> Motion:
    motion = read_motion(
        o.motion, osim=o.osim, joint=o.joint, moving=o.moving_body or "child", mapping=o.map, order=o.order,
        angles=o.angles,
    )  # fmt: skip
    for option, value in (("order", o.order), ("angles", o.angles)):
        if value is not None and option not in motion.heeded:
            raise InputError("", f"--{option}", f"does nothing here: {o.motion} is read without it", "leave it out")
    if motion.time_unit != "s":
        raise InputError(o.motion, "", "time is in per cent of a cycle", "damping and friction need seconds")
    record.add_input("motion", o.motion, frames=len(motion), source=motion.source)
    if o.osim is not None:
        record.add_input("model", o.osim, joint=o.joint)
    return motion


def _loads(record: Record, foot: Foot, ground: Ground, o: CopOptions) -> SphereLoads:
    if len(foot.motion) == 1 and foot.law.needs_velocity:
        record.warn(f"{o.motion} has one frame: the foot is taken to stand still")
    rate = pose_rate(foot.motion.time, foot.motion.poses)
    try:
        with preparing():
            loads = sphere_loads(foot.sole, foot.law, foot.motion.poses, rate, ground)
    except ValueError as error:
        raise InputError(
            o.motion, "", str(error), "check the frame, the unit and which way is up; see --ground"
        ) from error
    _say_what_is_odd(record, foot, loads, ground, o)
    return loads


def _say_what_is_odd(record: Record, foot: Foot, loads: SphereLoads, ground: Ground, o: CopOptions) -> None:
    touching = loads.depth > 0.0
    if not touching.any():
        distance = ground.proximity(loads.centre.reshape(-1, 3)).distance.reshape(loads.depth.shape)
        gap = float((distance - foot.sole.radius).min())
        if gap > NEAR:
            what = f"the foot stays {gap * 1e3:.0f} mm above the ground in every frame"
            raise InputError(o.motion, "", what, "check the frame, the unit and which way is up; see --ground")
        record.warn(f"no sphere touches the ground; the nearest comes within {gap * 1e3:.2f} mm")
    beneath = (loads.depth > foot.sole.radius).any(axis=1)
    if beneath.any():
        record.warn(f"centres of spheres are under the ground in {int(beneath.sum())} frames: too soft, or misplaced")


def _summarise(record: Record, motion: Motion, c: CentreOfPressure, law: SoleLaw, o: CopOptions) -> None:
    found = np.isfinite(c.centre[:, 0])
    if c.pressing.any() and not found.any():
        record.warn(f"no centre of pressure: the normal force stays below the gate of {o.gate:g} N")
    record.results["cop"] = {
        "frames": len(motion),
        "frames_with_cop": int(found.sum()),
        "peak_normal_N": round(float(c.pressing.max()), 6),
        "point": o.point,
        "law": {
            "k": sorted(set(law.stiffness.tolist())), "b": sorted(set(law.damping.tolist())), "n": law.exponent,
            "delta_full_m": law.full_depth, "mu_s": law.static, "mu_k": law.kinetic,
            "v_th_m_per_s": law.threshold_speed,
        },
    }  # fmt: skip
    record.say(
        f"normal force up to {c.pressing.max():.1f} N; a centre of pressure in {found.sum()} of {len(found)} frames"
    )
