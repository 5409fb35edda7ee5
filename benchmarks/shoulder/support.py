"""Support profiles of the shoulder exoskeleton: `python -m benchmarks.shoulder.support [--draws 200] [--seeds 40]`.

Phases detected beside true ones under noise and delay; the best profile beside the paper's table 3; persons held out
with intervals, by what their profile keeps; multiples of the best profile in the simulation; CPU seconds of one core.
All persons and trials are synthetic.
"""

from __future__ import annotations

import argparse
import json
import statistics
import time
from pathlib import Path
from typing import Any

from benchmarks.one_core import pin

HERE = Path(__file__).resolve().parents[1]
CERTAIN = 0.95
SETTINGS: tuple[tuple[str, dict[str, float]], ...] = (
    ("certainty 95%", {"certainty": CERTAIN}),
    *((f"reserve {share:.0%}", {"reserve": share}) for share in (0.0, 0.1, 0.2, 0.3)),
)
HELD_OUT: tuple[tuple[str, dict[str, float], bool], ...] = (
    ("certainty 95%", {"certainty": CERTAIN}, True),
    ("reserve 20%", {"reserve": 0.2}, True),
    ("reserve 20%, same factors", {"reserve": 0.2}, False),
)
SCALES = (0.95, 1.0, 1.05, 1.1, 1.15)
ONSETS = (0.05, 0.10)
ROUNDS = 5


def main() -> None:
    """Measure, print, write the JSON."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.shoulder.support", description=__doc__.splitlines()[0])
    parser.add_argument("--draws", type=int, default=200)
    parser.add_argument("--seeds", type=int, default=40)
    parser.add_argument("--out", type=Path, default=HERE / "results")
    options = parser.parse_args()
    pin()
    from benchmarks.machine import machine, versions

    report = {
        "machine": machine(),
        "versions": versions({"numpy", "scipy"}),
        "phases": phases(options.seeds),
        "profiles": profiles(options.draws),
        "simulated": simulated(options.seeds // 8),
    }
    options.out.mkdir(parents=True, exist_ok=True)
    (options.out / "shoulder_support.json").write_text(json.dumps(report, indent=2) + "\n", encoding="utf-8")
    print(json.dumps(report, indent=2))


def phases(seeds: int) -> dict[str, Any]:
    """Wrong share by onset, share that perfect sensors would tell otherwise, chatter, median latencies."""
    from itertools import product

    import numpy as np

    from geocontact.shoulder_exoskeleton.support.phase_machine import (
        Sensing,
        detected,
        phase_check,
        phases_by_onset,
        sensed,
    )
    from geocontact.shoulder_exoskeleton.synthetic import CONDITIONS, PARTICIPANTS, TASKS, synthetic_trial

    wrong: dict[float, list[float]] = {onset: [] for onset in ONSETS}
    otherwise, latencies, chatter = [], [], 0
    for trial in (synthetic_trial(*each) for each in product(PARTICIPANTS, TASKS, CONDITIONS)):
        for course in trial.courses.values():
            at, angle = trial.markers.time, course.elevation
            ideal = detected(at, angle, trial.current)
            true = {onset: phases_by_onset(at, angle, trial.phase, onset) for onset in ONSETS}
            for seed in range(seeds):
                found = detected(at, *sensed(at, angle, trial.current, Sensing(), np.random.default_rng(seed)))
                checks = {onset: phase_check(at, found, each) for onset, each in true.items()}
                for onset, check in checks.items():
                    wrong[onset].append(check.wrong)
                chatter += checks[ONSETS[-1]].chatter
                latencies.append(checks[ONSETS[-1]].latencies)
                otherwise.append(float(np.mean(found != ideal)))
    same = [each for each in latencies if each]
    return {
        "detections": len(otherwise),
        "chatter": int(chatter),
        **{f"wrong, onset at {onset:.0%} of the peak rate": float(np.mean(each)) for onset, each in wrong.items()},
        "otherwise than with perfect sensors": float(np.mean(otherwise)),
        "latencies [s]": np.median(same, axis=0).round(3).tolist(),
    }


def profiles(draws: int) -> dict[str, Any]:
    """Factors by certainty, what they take away, held-out persons, seconds of a linear program and of a closed loop."""
    from geocontact.shoulder_exoskeleton.device import lucy_new_cylinder
    from geocontact.shoulder_exoskeleton.support.arm_trial import scales_of, support_case, support_of
    from geocontact.shoulder_exoskeleton.support.best_profile import best_profile, uniform_profile
    from geocontact.shoulder_exoskeleton.support.closed_loop_profile import ClosedLoop
    from geocontact.shoulder_exoskeleton.support.held_out import judged
    from geocontact.shoulder_exoskeleton.support.outcome import TABLE_3
    from geocontact.shoulder_exoskeleton.support.profile_limits import Limits
    from geocontact.shoulder_exoskeleton.synthetic import all_arms

    trials, device = all_arms(), lucy_new_cylinder()
    support = support_of(device)
    cases = [support_case(trial, support) for trial in trials]
    seconds = []
    for _ in range(ROUNDS):
        start = time.process_time()
        best_profile(cases)
        seconds.append(time.process_time() - start)
    loop = ClosedLoop(device, support, Limits(certainty=CERTAIN))
    start = time.process_time()
    best = loop.settled(trials)
    taken = time.process_time() - start
    one = loop.settled(trials, uniform_profile)
    moments = {trial.person: trial.arm_moment for trial in trials}
    persons = dict.fromkeys(trial.person for trial in trials)
    paper, single = dict.fromkeys(persons, TABLE_3), dict.fromkeys(persons, one.profile.factors)
    table_3 = judged(trials, support, paper, single, draws=draws, reaches=loop.transfer)
    found: dict[str, Any] = {
        "factors": {f"{k.task} {k.hand} {k.phase}": [round(x, 3), TABLE_3[k]] for k, x in best.profile.factors.items()},
        "planned": best.profile.value,
        "taken away": best.value,
        "taken away by one factor": one.value,
        "one factor": max(one.profile.factors.values()),
        "taken away by arm weight": loop.settled(trials, scales=scales_of(moments, persons)).value,
        "moments of the arms' weight [N m]": moments,
        "CPU seconds": statistics.median(seconds),
        "CPU seconds, closed loop": taken,
        "table 3": {p: told(each) for p, each in table_3.items()},
    }
    for name, limits, by_arm in HELD_OUT:
        found[f"held out, {name}"] = held_out_by(trials, ClosedLoop(device, support, Limits(**limits)), by_arm, draws)
    return found


def held_out_by(trials: Any, loop: Any, by_arm: bool, draws: int) -> dict[str, Any]:
    """By person, with the profile that the others make in closed loop."""
    from geocontact.shoulder_exoskeleton.support.arm_trial import scales_of
    from geocontact.shoulder_exoskeleton.support.best_profile import best_profile, scaled, uniform_profile
    from geocontact.shoulder_exoskeleton.support.held_out import held_out

    def maker(make: Any) -> Any:
        def made(others: Any, own: Any) -> Any:
            moments = {each.person: each.arm_moment for each in (*others, *own)}
            scales = scales_of(moments, {each.person for each in others}) if by_arm else {}
            factors = loop.settled(others, make, scales).profile.factors
            return scaled(factors, scales.get(own[0].person, 1.0))

        return made

    found = held_out(
        trials, loop.support, maker(best_profile), maker(uniform_profile), draws=draws, reaches=loop.transfer
    )
    return {person: told(each) for person, each in found.items()}


def simulated(seeds: int) -> dict[str, Any]:
    """The group's profiles in closed loop: what is left of them, and phases of the device's own arm beside true ones.

    Sensors are noisy and late. Of what is taken away the mean over arms and seeds, of all else the largest. Beside it
    the plan without a simulation, as the human elevation has it, and what a simulation with exact sensors leaves of it.
    """
    import numpy as np

    from geocontact.shoulder_exoskeleton.device import lucy_new_cylinder
    from geocontact.shoulder_exoskeleton.support.arm_trial import support_case, support_of
    from geocontact.shoulder_exoskeleton.support.best_profile import best_profile, scaled
    from geocontact.shoulder_exoskeleton.support.closed_loop_profile import ClosedLoop
    from geocontact.shoulder_exoskeleton.support.controlled_arm import simulated_support
    from geocontact.shoulder_exoskeleton.support.phase_machine import Sensing, phase_check, phases_by_onset
    from geocontact.shoulder_exoskeleton.support.profile_limits import Limits
    from geocontact.shoulder_exoskeleton.synthetic import CONDITIONS, PARTICIPANTS, TASKS, arms_of, synthetic_trial

    device = lucy_new_cylinder()
    support = support_of(device)
    works = [synthetic_trial(person, task, CONDITIONS[0]) for person in PARTICIPANTS for task in TASKS]
    arms = [(work, arm) for work in works for arm in arms_of(work)]
    trials = [arm for _, arm in arms]
    found: dict[str, Any] = {}

    for name, limits in SETTINGS:
        loop = ClosedLoop(device, support, Limits(**limits))
        best = loop.settled(trials)
        plan = best_profile([support_case(arm, support) for arm in trials], Limits(reserve=loop.limits.reserve))
        outcomes, checks = [], []
        for work, arm in arms:
            true = phases_by_onset(arm.motion.time, work.courses[arm.motion.side].elevation, work.phase)
            for seed in range(seeds):
                one = simulated_support(arm, device, best.profile.factors, Sensing(), seed)
                outcomes.append(one.outcome)
                checks.append(phase_check(arm.motion.time, one.arm.phase, true))
        scales = {f"times {scale}": left(trials, loop, scaled(best.profile.factors, scale)) for scale in SCALES}
        found[name] = {
            "plan without simulation": plan.value,
            "of which is left": left(trials, loop, plan.factors)[0],
            "planned": best.profile.value,
            "simulated": best.value,
            "share taken away and excess above the reserve [N m]": scales,
            "taken away": float(np.mean([each.reduction for each in outcomes])),
            **{name: max(getattr(o, name) for o in outcomes) for name in ("pushed_up", "excess", "force", "rate")},
            "wrong phase, mean": float(np.mean([each.wrong for each in checks])),
            "wrong phase, largest": max(each.wrong for each in checks),
            "chatter": sum(each.chatter for each in checks),
            "detections": len(checks),
        }
    return found


def left(trials: Any, loop: Any, factors: Any) -> tuple[float, float]:
    """Share that is taken away with exact sensors, and largest excess above the need less the reserve [N m]."""
    import numpy as np

    runs = [(arm, loop.run(arm, factors)) for arm in trials]
    over = [
        np.max((run.torque - (1.0 - loop.limits.reserve) * np.maximum(arm.needed.total, 0.0))[run.torque > 0.05])
        for arm, run in runs
    ]
    return float(np.mean([run.outcome.reduction for _, run in runs])), float(max(over))


def told(judgement: Any) -> dict[str, Any]:
    """Of a person held out."""
    names = ("reduction", "interval", "gain", "gain_interval", "pushed_up", "excess")
    return {name: getattr(judgement, name) for name in names}


if __name__ == "__main__":
    main()
