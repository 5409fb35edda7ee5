"""Both groups of simulations of a study, and how far they are from logger, mat and each other."""

from __future__ import annotations

import numpy as np

from geocontact.analyses.json_file import plain
from geocontact.analyses.run_record import Record
from geocontact.analyses.shoulder.phase_errors import phase_errors
from geocontact.analyses.shoulder.recorded_channels import ELEVATION, FORCE, Channels
from geocontact.analyses.shoulder.reservations import out_of_cuff_clause, warn_of
from geocontact.analyses.shoulder.simulate.read import Worn
from geocontact.analyses.shoulder.simulate.simulated_arm import SimulatedArm
from geocontact.analyses.shoulder.study.case import COPIED, StudyCase
from geocontact.analyses.shoulder.study.options import StudyOptions
from geocontact.analyses.shoulder.study.read import StudyTrialInputs
from geocontact.analyses.shoulder.study.result import StudyResult
from geocontact.analyses.shoulder.study.tables import difference_table, summary_table
from geocontact.data.errors import InputError
from geocontact.identify.signals.agreement import Agreement
from geocontact.identify.signals.even_times import at_times, even_times
from geocontact.shoulder_exoskeleton.arm_motion import ArmMotion
from geocontact.shoulder_exoskeleton.in_cuff import OutOfCuffError
from geocontact.shoulder_exoskeleton.simulate import simulate_arm
from geocontact.shoulder_exoskeleton.work_phases import PHASES, work_phases


def run(trials: tuple[StudyTrialInputs, ...], o: StudyOptions, record: Record) -> StudyResult:
    """Trial by trial, arm by arm; each is 0.03 s of work."""
    cases = []
    with record.listener.progress("trials", len(trials)) as step:
        for each in trials:
            cases += [_case(each, arm, o, record) for arm in each.within.arms]
            step()
    device = trials[0].within.device
    invented = sum(number.source == "invented" for number in device.numbers.values())
    record.warn(f"{device.name}: {invented} of {len(device.numbers)} numbers are invented")
    result = StudyResult(record=record, options=o, cases=tuple(cases), device=device)
    within = [case.within.simulation for case in cases]
    without = [case.without.simulation for case in cases if case.without is not None]
    out, out_of_both = out_of_cuff_clause(*within), out_of_cuff_clause(*within, *without)
    for row in summary_table(result.cases).to_dict("records"):
        if row["part"] in ("all", "work"):
            record.say(
                f"{row['channel']}, {row['part']}: MAE {row['mae']:.3g}, RMSD {row['rmsd']:.3g} {row['unit']} "
                f"over {row['arms']} arms in their trials{out}"
            )
    for row in difference_table(result.cases).to_dict("records"):
        if row["trial"] == "mean":
            record.say(
                f"screw-in, motion in the device against without it, mean size over the arms: "
                f"exoskeleton {row['exoskeleton [deg]']:.3g} deg, shoulder {row['shoulder [deg]']:.3g} deg, "
                f"force {row['force [N]']:.3g} N; shoulder less exoskeleton "
                f"{row['shoulder less exoskeleton [deg]']:.3g} deg{out_of_both}"
            )
    record.results["study"] = plain(
        {c.name: {ch: {part: vars(a) for part, a in e.items()} for ch, e in c.errors.items()} for c in cases}
    )
    return result


def _case(each: StudyTrialInputs, arm: ArmMotion, o: StudyOptions, record: Record) -> StudyCase:
    within = _simulated(each, each.within, arm, o)
    bare = () if each.without is None else each.without.arms
    same = next((one for one in bare if one.side == arm.side), None)
    without = None if each.without is None or same is None else _simulated(each, each.without, same, o)
    warn_of(within.simulation, record, each.trial.name)
    if without is not None:
        warn_of(without.simulation, record, f"{each.trial.name} as {each.trial.without}")
    recorded = each.recorded.get(arm.side)
    errors = {} if recorded is None else _errors(each, within, recorded, record)
    return StudyCase(each.trial, within, without, recorded, errors)


def _simulated(each: StudyTrialInputs, worn: Worn, arm: ArmMotion, o: StudyOptions) -> SimulatedArm:
    try:
        found = simulate_arm(arm, worn.device, worn.wearer, each.level)
        return SimulatedArm(found, work_phases(arm.elevation, worn.tool))
    except OutOfCuffError as error:
        raise InputError(
            o.study, f"[[trials]] {each.trial.name}", f"{arm.side} arm: {error.what}", error.cause
        ) from error
    except (ArithmeticError, ValueError) as error:
        remedy = "look at it alone with shoulder simulate"
        what = f"{arm.side} arm: {error}"
        raise InputError(o.study, f"[[trials]] {each.trial.name}", what, remedy) from error


def _errors(
    each: StudyTrialInputs, within: SimulatedArm, recorded: Channels, record: Record
) -> dict[str, dict[str, Agreement]]:
    s = within.simulation
    time, step = even_times(s.motion.time)
    inside = (time >= recorded.time[0] - 1e-9) & (time <= recorded.time[-1] + 1e-9)
    if inside.sum() < 2:
        what = f"was recorded from {recorded.time[0]:g} to {recorded.time[-1]:g} s"
        remedy = f"its markers are from {time[0]:g} to {time[-1]:g} s"
        raise InputError("", f"{each.trial.name}, {s.motion.side} arm", what, remedy)
    if not inside.all():
        record.warn(f"{each.trial.name}, {s.motion.side} arm: {inside.mean():.0%} of the simulated time was recorded")
    words = np.array(PHASES)[within.phase]
    _, recorded_step = even_times(recorded.time)
    models = {
        ELEVATION: (ELEVATION, s.elevation),
        COPIED: (ELEVATION, s.motion.elevation),
        FORCE: (FORCE, s.supporting),
    }
    found = {}
    for name, (channel, model) in models.items():
        if channel in recorded.values:
            measured = at_times(recorded.time, recorded.values[channel], time, recorded_step)
            found[name] = phase_errors(model, measured, step, words, inside)
    return found
