"""Planted best fulcrums: `python -m benchmarks.prosthesis.design [--persons 50] [--feet 6] [--walks 4] [--minutes M]`.

Invented persons walk on a finer foot (12 joints, 72 spheres) whose numbers differ from the usual ones by as much as is
said to be known of them, and answer to another fulcrum somewhere between keeping angles and keeping torque. For each,
a fulcrum is planted: what the finer foot does there is what is wanted. The design sees markers and a plate at the
present setting, with errors, and the coarser usual foot. Found is a planted fulcrum that lies within the told interval.
"Blind" is the same with a sole of which nothing is known and a foot that stood within 3 degrees of flat: there an
answer has to be wide or none. The rate of loading does not hang on the fulcrum, so that no answer is the right one.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.interpolate import make_interp_spline
from scipy.spatial.transform import RigidTransform, Rotation

from benchmarks.machine import write_results
from geocontact.analyses.frame.workers import each
from geocontact.below_knee_prosthesis.calibration.zone_parameters import ZoneParameters
from geocontact.below_knee_prosthesis.design.aims import Aim
from geocontact.below_knee_prosthesis.design.choice import FootChoice, choose
from geocontact.below_knee_prosthesis.design.drawn import (
    KEEL,
    RecordedTrial,
    TrialErrors,
    drawn_foot,
    draws,
    task_again,
)
from geocontact.below_knee_prosthesis.design.foot_map import (
    REACH,
    CarriedLoad,
    foot_map,
    needed,
    with_angles_kept,
    with_torque_kept,
)
from geocontact.below_knee_prosthesis.design.foot_task import LOADED, FootTask, needed_of, sagittal_leg
from geocontact.below_knee_prosthesis.design.knob import AIMS, Knob
from geocontact.below_knee_prosthesis.design.outcomes import MEASURES, outcomes
from geocontact.below_knee_prosthesis.evaluation import PlateStance
from geocontact.below_knee_prosthesis.from_markers import STANDING
from geocontact.below_knee_prosthesis.keel.sole import numbers as sole_numbers
from geocontact.below_knee_prosthesis.keel.vsf import fulcrum_of, vsf_foot
from geocontact.below_knee_prosthesis.leg import Leg, Person
from geocontact.below_knee_prosthesis.leg_tree import GRAVITY, recorded_tree
from geocontact.data.body_segments import body_segments
from geocontact.data.multibody.markers import MarkerTrajectories
from meshes.gait_course import course, reactions
from meshes.gait_persons import Walker, marker_places, true_leg
from meshes.gait_trial import CAMERA_NOISE, FORCE_NOISE, OFFSET, standing_places

KNOWN = TrialErrors()
BLIND = replace(KNOWN, pitch=np.radians(3.0))
SD = {"known": (0.25, 0.5, 0.3), "blind": (1.1, 2.0, 0.7)}
"""Standard deviation of the logarithms of stiffness, damping and friction."""
JOINTS, FINER = 12, 3
"""Of the true foot: neither is among those that are drawn (8 joints; 1, 2 and 4 times the rows of spheres)."""
VALUES = 7
"""Fulcrums of the sweep."""
INSIDE = (0.070, 0.147)
"""m; within which a best fulcrum is planted."""
LEVEL = 0.95


@dataclass(frozen=True)
class Planted:
    """One person: the planted fulcrum, and what the design says of it by aim."""

    number: int
    known: str
    fulcrum: float
    present: float
    choices: Mapping[Aim, FootChoice]
    seconds: float

    def found(self, aim: Aim) -> bool:
        """Whether the told interval holds the planted fulcrum."""
        one = self.choices[aim]
        return one.told and one.lower <= self.fulcrum <= one.upper


def planted(task: tuple[int, str, int, int]) -> Planted:
    """A person by number, what is known, drawn feet and walks."""
    number, known, feet, walks = task
    rng = np.random.default_rng([number, known == "blind"])
    below, foot, errors = sole_numbers()["below"].value, vsf_foot(), KNOWN if known == "known" else BLIND
    person = Walker("invented", rng.uniform(55.0, 110.0), rng.uniform(1.58, 1.92), "right", "male")
    setting = ("low", "medium", "high")[int(rng.integers(3))]
    present, best = fulcrum_of(setting), float(rng.uniform(*INSIDE))
    sd = np.repeat(SD[known], len(ZoneParameters(foot.sole, foot.law).zones))
    true = drawn_foot(vsf_foot(joints=JOINTS, finer=FINER), sd, KEEL, rng)
    leg = true_leg(person, below)
    exact, poses, time_ = _walk(leg, present, rng)
    rows = needed(exact.pitch, exact.load, REACH)
    before = foot_map(true.at(present), *rows)
    share = float(rng.choice([0.0, 1.0, rng.uniform()]))
    wanted = outcomes(_responding(foot_map(true.at(best), *rows), exact, before, share))
    height = np.interp(time_, exact.time, with_angles_kept(before, exact).height)
    trial = _recorded(leg, person, poses, time_, height, exact, present, errors, rng)
    start = time.process_time()
    knob = Knob("fulcrum", np.linspace(0.066, 0.151, VALUES), present)
    given = knob, foot, trial.task(), lambda own: task_again(trial, errors, own), sd
    drawn = draws(*given, feet=feet, walks=walks, seed=number).drawn
    choices = {
        aim: choose(knob.settings, drawn[..., k], MEASURES[aim].sense, wanted[aim], present, LEVEL)
        for k, aim in enumerate(AIMS)
    }
    return Planted(number, known, best, present, choices, time.process_time() - start)


def _walk(leg: Leg, fulcrum: float, rng: np.random.Generator) -> tuple[FootTask, dict[str, RigidTransform], np.ndarray]:
    """The true stance, and poses of pelvis, thigh and keel over the whole trial without the true height."""
    lasting = float(rng.normal(0.71, 0.03))
    one = course(leg, vsf_foot(), fulcrum, lasting, phase=float(0.2 * rng.standard_normal()))
    motion, weight = one.motion, leg.person.mass * GRAVITY
    bodies = recorded_tree(leg).poses(motion.values)
    poses = bodies["shank"] * RigidTransform.from_components(leg.keel, leg.turn)
    up = (bodies["thigh"].translation - bodies["shank"].translation)[:, :2]
    force = weight * reactions(motion.time, lasting)[0]
    kept = force[:, 1] > LOADED * weight
    place, axis = leg.turn.inv(), poses.rotation.apply([1.0, 0.0, 0.0])
    pitch, thigh, bars = np.arcsin(axis[:, 1]), np.arctan2(-up[:, 0], up[:, 1]), sagittal_leg(leg, vsf_foot().keel)
    hip, back = bodies["pelvis"].apply(leg.hip), bodies["pelvis"].rotation.apply([0.0, 1.0, 0.0])
    course_of = np.column_stack([hip[:, :2], thigh, pitch])
    exact = FootTask(
        time=motion.time[kept],
        pitch=pitch[kept],
        thigh=thigh[kept],
        load=force[kept, 1],
        forward=force[kept, 0],
        falling=0.3,
        ankle=place.apply(leg.ankle - leg.keel),
        bushing=place.apply(leg.bushing - leg.keel),
        knee=place.apply(-leg.keel),
        leg=bars,
        leg_length=leg.thigh + leg.shank,
        weight=weight,
        pelvis=np.arctan2(-back[kept, 0], back[kept, 1]),
        needed=needed_of(bars, motion.time, course_of)[kept],
        acceleration=make_interp_spline(motion.time, course_of, k=5)(motion.time, 2)[kept],
    )
    return exact, {"pelvis": bodies["pelvis"], "thigh": bodies["thigh"], "shank": poses}, motion.time


def _responding(new, exact: FootTask, before, share: float) -> CarriedLoad:
    """Turned by that share of what would keep the torque."""
    kept = with_torque_kept(new, exact, with_angles_kept(before, exact).ankle_moment)
    return with_angles_kept(new, replace(exact, pitch=exact.pitch + share * kept.tilt))


def _recorded(
    leg: Leg,
    person: Walker,
    bodies: dict[str, RigidTransform],
    time_: np.ndarray,
    height: np.ndarray,
    exact: FootTask,
    fulcrum: float,
    errors: TrialErrors,
    rng: np.random.Generator,
) -> RecordedTrial:
    """What cameras and a plate see of it; the foot stood not quite flat."""
    up = np.column_stack([0.0 * height, height - bodies["shank"].translation[:, 1], 0.0 * height])
    raised = {body: RigidTransform.from_translation(up) * own for body, own in bodies.items()}
    keel = raised["shank"]
    places = marker_places(leg, vsf_foot().keel.length)
    tilt = Rotation.from_euler("z", float(errors.pitch * rng.standard_normal()))
    seen = np.zeros((len(time_), len(STANDING), 3))
    for body, of in places.items():
        for name, place in of.items():
            own = tilt.apply(leg.turn.inv().apply(place - leg.keel)) if body == "shank" else place
            seen[:, STANDING.index(name)] = raised[body].apply(own) + rng.normal(0.0, CAMERA_NOISE, (len(time_), 3))
    still = standing_places(leg, places, rng)
    gain = 1.0 + errors.gain * rng.standard_normal()
    load = np.zeros((len(time_), 3))
    for column, values in ((0, exact.forward), (1, exact.load)):
        load[:, column] = np.interp(time_, exact.time, values, 0.0, 0.0)
    load = gain * load + rng.normal(0.0, FORCE_NOISE, load.shape) + rng.normal(0.0, OFFSET, 3)
    centre = np.where(load[:, 1:2] > 20.0, keel.translation, np.nan)
    return RecordedTrial(
        MarkerTrajectories(still[0], still[1], STANDING, "synthetic standing"),
        MarkerTrajectories(time_, seen, STANDING, "synthetic walking"),
        PlateStance(time_, load, centre),
        Person(person.mass, body_segments(person.sex)),
        vsf_foot().keel,
        fulcrum,
        sole_numbers()["below"].value,
        15.0,
        0.2,
    )


def _words(one: Planted) -> str:
    """What is told of each aim in mm; a dash where nothing is."""
    rows = []
    for aim, choice in one.choices.items():
        interval = f"{1e3 * choice.lower:.0f}-{1e3 * choice.upper:.0f}{'' if one.found(aim) else ' missed'}"
        rows.append(f"{aim} {interval if choice.told else '-'}")
    return ", ".join(rows)


def told(found: list[Planted]) -> dict[str, Any]:
    """How often the planted fulcrum is found, and how wide the intervals are; printed."""
    figures: dict[str, Any] = {}
    for known in SD:
        own = [one for one in found if one.known == known]
        if not own:
            continue
        seconds = float(np.median([one.seconds for one in own]))
        figures[known] = {"persons": len(own), "seconds": seconds, "aims": {}}
        print(f"{known}: {len(own)} persons, {seconds:.1f} CPU s each (median)")
        for aim in AIMS:
            spoken = [one for one in own if one.choices[aim].told]
            hit = sum(one.found(aim) for one in spoken)
            width = np.median([1e3 * (one.choices[aim].upper - one.choices[aim].lower) for one in spoken] or [np.nan])
            shown = float(width) if spoken else None
            figures[known]["aims"][aim] = {"told": len(spoken), "within": hit, "width_mm": shown}
            words = f"told {len(spoken)}, of them within {hit}"
            print(f"  {aim:14s} {words:28s} interval {width:5.1f} mm (median), cannot tell {len(own) - len(spoken)}")
    return figures


def main() -> None:
    """Print the tables; benchmarks/results/prosthesis_design.json. The number of a person is its seed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--persons", type=int, default=50)
    parser.add_argument("--blind", type=int, default=10)
    parser.add_argument("--feet", type=int, default=6)
    parser.add_argument("--walks", type=int, default=4)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--minutes", type=float, help="after which no more persons are begun")
    asked = parser.parse_args()
    tasks = [
        (k, known, asked.feet, asked.walks)
        for known, n in (("known", asked.persons), ("blind", asked.blind))
        for k in range(n)
    ]
    tasks.sort(key=lambda each: (each[0] + 0.5) / (asked.persons if each[1] == "known" else asked.blind))
    found: list[Planted] = []
    until = np.inf if asked.minutes is None else time.monotonic() + 60.0 * asked.minutes
    for task, became in each(planted, tasks, asked.workers):
        if isinstance(became, BaseException):
            print(f"person {task[0]}, {task[1]}: {became}")
            continue
        found.append(became)
        print(f"person {task[0]}, {task[1]}: planted {1e3 * became.fulcrum:.0f} mm, {_words(became)}", flush=True)
        if time.monotonic() > until:
            break
    write_results("prosthesis_design", vars(asked), told(found))


if __name__ == "__main__":
    main()
