"""Support profiles of the shoulder exoskeleton: `python -m benchmarks.shoulder_support [--draws 200] [--seeds 40]`.

Phases detected beside true ones under noise and delay; the best profile beside the paper's table 3; persons held out
with intervals, by reserve; CPU seconds of one core, medians. All persons and trials are synthetic.
"""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path
from typing import Any

from benchmarks.one_core import pin

HERE = Path(__file__).resolve().parent
RESERVES = (0.0, 0.1, 0.2, 0.3)
ONSETS = (0.05, 0.10)
ROUNDS = 5


def main() -> None:
    """Measure, print, write the JSON."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.shoulder_support", description=__doc__.splitlines()[0])
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

    from geocontact.shoulder_exoskeleton.support.phase_check import phase_check, phases_by_onset
    from geocontact.shoulder_exoskeleton.support.phase_machine import detected
    from geocontact.shoulder_exoskeleton.support.sensing import Sensing, sensed
    from geocontact.shoulder_exoskeleton.synthetic.design import CONDITIONS, PARTICIPANTS, TASKS
    from geocontact.shoulder_exoskeleton.synthetic.trial import synthetic_trial

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
    """Factors, what they take away, held-out persons by reserve, seconds of a linear program."""
    import statistics
    from functools import partial

    from geocontact.analyses.shoulder.optimise.read import support_of
    from geocontact.shoulder_exoskeleton.lucy import lucy_new_cylinder
    from geocontact.shoulder_exoskeleton.support.arm_trial import support_case
    from geocontact.shoulder_exoskeleton.support.best_profile import Limits, best_profile, uniform_profile
    from geocontact.shoulder_exoskeleton.support.held_out import held_out, judged
    from geocontact.shoulder_exoskeleton.support.outcome import TABLE_3
    from geocontact.shoulder_exoskeleton.synthetic.arm_trials import all_arms

    trials, support = all_arms(), support_of(lucy_new_cylinder())
    cases = [support_case(trial, support) for trial in trials]
    one = uniform_profile(cases)
    seconds = []
    for _ in range(ROUNDS):
        start = time.process_time()
        best = best_profile(cases)
        seconds.append(time.process_time() - start)
    persons = dict.fromkeys(case.person for case in cases)
    found: dict[str, Any] = {
        "factors": {f"{k.task} {k.hand} {k.phase}": [round(x, 3), TABLE_3[k]] for k, x in best.factors.items()},
        "taken away": best.value,
        "taken away by one factor": one.value,
        "CPU seconds": statistics.median(seconds),
        "table 3": {
            p: told(each)
            for p, each in judged(
                trials,
                support,
                dict.fromkeys(persons, TABLE_3),
                dict.fromkeys(persons, one.factors),
                draws=draws,
            ).items()
        },
    }
    for reserve in RESERVES:
        limits = Limits(reserve=reserve)
        make, beside = (partial(by, limits=limits) for by in (best_profile, uniform_profile))
        made = held_out(trials, support, make, beside, draws=draws)
        found[f"held out, reserve {reserve:.0%}"] = {person: told(each) for person, each in made.items()}
    return found


def simulated(seeds: int) -> dict[str, Any]:
    """The group's profiles in closed loop: what is left of them, and phases of the device's own arm beside true ones.

    Sensors are noisy and late. Of what is taken away the mean over arms and seeds, of all else the largest.
    """
    import numpy as np

    from geocontact.analyses.shoulder.optimise.read import support_of
    from geocontact.shoulder_exoskeleton.lucy import lucy_new_cylinder
    from geocontact.shoulder_exoskeleton.support.arm_trial import support_case
    from geocontact.shoulder_exoskeleton.support.best_profile import Limits, best_profile
    from geocontact.shoulder_exoskeleton.support.phase_check import phase_check, phases_by_onset
    from geocontact.shoulder_exoskeleton.support.sensing import Sensing
    from geocontact.shoulder_exoskeleton.support.simulated_support import simulated_support
    from geocontact.shoulder_exoskeleton.synthetic.arm_trials import arms_of
    from geocontact.shoulder_exoskeleton.synthetic.design import CONDITIONS, PARTICIPANTS, TASKS
    from geocontact.shoulder_exoskeleton.synthetic.trial import synthetic_trial

    device = lucy_new_cylinder()
    support = support_of(device)
    works = [synthetic_trial(person, task, CONDITIONS[0]) for person in PARTICIPANTS for task in TASKS]
    arms = [(work, arm) for work in works for arm in arms_of(work)]
    found: dict[str, Any] = {}
    for reserve in RESERVES:
        best = best_profile([support_case(arm, support) for _, arm in arms], Limits(reserve=reserve))
        outcomes, checks = [], []
        for work, arm in arms:
            true = phases_by_onset(arm.motion.time, work.courses[arm.motion.side].elevation, work.phase)
            for seed in range(seeds):
                one = simulated_support(arm, device, best.factors, Sensing(), seed)
                outcomes.append(one.outcome)
                checks.append(phase_check(arm.motion.time, one.arm.phase, true))
        found[f"reserve {reserve:.0%}"] = {
            "planned": best.value,
            "taken away": float(np.mean([each.reduction for each in outcomes])),
            **{name: max(getattr(o, name) for o in outcomes) for name in ("pushed_up", "excess", "force", "rate")},
            "wrong phase, mean": float(np.mean([each.wrong for each in checks])),
            "wrong phase, largest": max(each.wrong for each in checks),
            "chatter": sum(each.chatter for each in checks),
            "detections": len(checks),
        }
    return found


def told(judgement: Any) -> dict[str, Any]:
    """Of a person held out."""
    names = ("reduction", "interval", "gain", "gain_interval", "pushed_up", "excess")
    return {name: getattr(judgement, name) for name in names}


if __name__ == "__main__":
    main()
