"""An exoskeleton's arms along recorded human ones, and what is to be said of them."""

from __future__ import annotations

import numpy as np

from geocontact.analyses.json_file import plain
from geocontact.analyses.run_record import Record
from geocontact.analyses.shoulder.reservations import out_of_cuff_clause, warn_of
from geocontact.analyses.shoulder.simulate.options import ShoulderSimulateOptions
from geocontact.analyses.shoulder.simulate.read import Worn
from geocontact.analyses.shoulder.simulate.result import ShoulderSimulateResult
from geocontact.analyses.shoulder.simulate.simulated_arm import SimulatedArm
from geocontact.data.errors import InputError
from geocontact.shoulder_exoskeleton.arm_motion import ArmMotion
from geocontact.shoulder_exoskeleton.in_cuff import OutOfCuffError
from geocontact.shoulder_exoskeleton.sensitivity import influences
from geocontact.shoulder_exoskeleton.simulate import simulate_arm
from geocontact.shoulder_exoskeleton.support.controlled_arm import controlled_arm
from geocontact.shoulder_exoskeleton.work_phases import PHASES, work_phases


def run(worn: Worn, o: ShoulderSimulateOptions, record: Record) -> ShoulderSimulateResult:
    """Each arm by itself; they share the device's frame only."""
    invented = sum(number.source == "invented" for number in worn.device.numbers.values())
    record.warn(f"{worn.device.name}: {invented} of {len(worn.device.numbers)} numbers are invented, see numbers.csv")
    record.results["device"] = {
        "name": worn.device.name,
        "peak_force_N": worn.device.peak_force,
        "peak_torque_N_m": worn.device.peak_torque,
    }
    arms = tuple(_simulated(worn, arm, o, record) for arm in worn.arms)
    record.results["arms"] = plain({each.side: _summary(each) for each in arms})
    found = {
        each.side: tuple(influences(each.simulation.motion, worn.device, worn.wearer, o.level, o.cuff, each.factor))
        for each in (arms if o.sensitivity else ())
    }
    return ShoulderSimulateResult(
        record=record,
        options=o,
        arms=arms,
        frame=worn.frame,
        markers=worn.markers,
        device=worn.device,
        wearer=worn.wearer,
        influences=found,
    )


def _simulated(worn: Worn, arm: ArmMotion, o: ShoulderSimulateOptions, record: Record) -> SimulatedArm:
    control = None if worn.controllers is None else worn.controllers[arm.side]
    detected, factor = None, None
    try:
        if control is None:
            found = simulate_arm(arm, worn.device, worn.wearer, o.level, cuff=o.cuff)
        else:
            led = controlled_arm(arm, worn.device, worn.wearer, o.level, control, o.cuff)
            found, detected, factor = led.simulation, led.phase, led.factor
    except OutOfCuffError as error:
        raise InputError(o.markers, "", f"{arm.side} arm: {error.what}", error.cause) from error
    except ArithmeticError as error:
        remedy = "check `person`, `device`, and the unit and names of the markers"
        raise InputError(o.markers, "", f"{arm.side} arm: {error}", remedy) from error
    try:
        phase = work_phases(arm.elevation, worn.tool)
    except ValueError as error:
        raise InputError(o.tool or o.markers, "`tool`", f"{arm.side} arm: {error}", "check its clock") from error
    warn_of(found, record)
    one = SimulatedArm(found, phase, detected, factor)
    told = _summary(one)
    record.say(
        f"{arm.side} arm: elevation up to {told['elevation_max_deg']:.1f} deg (shoulder "
        f"{told['shoulder_max_deg']:.1f}), supporting force {told['supporting_min_N']:.1f} … "
        f"{told['supporting_max_N']:.1f} N, slip {told['slip_mm']:.0f} mm{out_of_cuff_clause(found)}"
    )
    if control is not None and detected is not None:
        shares = ", ".join(f"{name} {share:.2f}" for name, share in zip(PHASES, control.factors, strict=True))
        changes = f"{np.count_nonzero(np.diff(detected))} changes"
        record.say(f"{arm.side} arm: support by phase: {shares}; {changes}{out_of_cuff_clause(found)}")
    return one


def _summary(one: SimulatedArm) -> dict[str, float]:
    """Numbers of the whole trial, and means of the screw-in."""
    s = one.simulation
    working = one.phase == PHASES.index("screw-in")
    told = {
        "elevation_max_deg": np.degrees(s.elevation.max()),
        "shoulder_max_deg": np.degrees(s.motion.elevation.max()),
        "supporting_min_N": s.supporting.min(),
        "supporting_max_N": s.supporting.max(),
        "shear_max_N": s.shear.max(),
        "slip_mm": 1e3 * s.slip[-1],
        "support_torque_max_N_m": s.told["support"].max(),
        "out_of_cuff_share": s.out_of_cuff.mean(),
        "steps": float(s.steps),
    }
    if working.any():
        told["screw_in_elevation_deg"] = np.degrees(s.elevation[working].mean())
        told["screw_in_shoulder_minus_exoskeleton_deg"] = np.degrees((s.motion.elevation - s.elevation)[working].mean())
        told["screw_in_supporting_N"] = s.supporting[working].mean()
    return {name: float(value) for name, value in told.items()}
