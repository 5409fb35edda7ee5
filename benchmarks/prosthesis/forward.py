"""The map of a foot beside forward dynamics: one limb motion on several fulcrums, simulated and carried by the map.

    python -m benchmarks.prosthesis.forward

A synthetic walk is simulated on the present foot, which gives the load and the foot's turns that a design starts from,
and along the same turns of pelvis, hip and knee on other fulcrums: the foot with its inertia, dampers and friction, the
pelvis free upwards and forwards. Printed is, for each person and setting, how far the design's outcomes with the angles
kept are from the simulated ones, as logarithms of their ratio. From these are `map_error.py`'s numbers.
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass, replace

import numpy as np

from benchmarks.machine import write_results
from geocontact.below_knee_prosthesis.calibration.recorded_stance import RecordedStance
from geocontact.below_knee_prosthesis.design.drawn import stiffer
from geocontact.below_knee_prosthesis.design.foot_task import LOADED, FootTask, foot_task
from geocontact.below_knee_prosthesis.design.knob import AIMS, Knob
from geocontact.below_knee_prosthesis.design.outcomes import radius_of_path
from geocontact.below_knee_prosthesis.keel.sole import numbers as sole_numbers
from geocontact.below_knee_prosthesis.keel.vsf import fulcrum_of, vsf_foot
from geocontact.below_knee_prosthesis.leg_tree import GRAVITY, recorded_tree
from geocontact.below_knee_prosthesis.simulate import GATE, Stance, simulate_stance
from geocontact.loads.resultant import pose_rate
from meshes.gait_course import course
from meshes.gait_persons import PARTICIPANTS, STANCE, true_leg

BELOW = sole_numbers()["below"].value
OTHERS = (0.0661, 0.090, 0.1509)
"""m; fulcrums beside the present one."""
AFTER = 0.08
"""s; simulated after the stance."""
HARD = 1.25
"""Of the largest load on the present foot: beyond it a foot lands as nobody would let it."""


@dataclass(frozen=True, eq=False)
class ForwardRun:
    """One limb motion on several fulcrums.

    Parameters
    ----------
    task
        What a design starts from: load and turns of the present foot.
    stances
        Simulated, by fulcrum [m].
    """

    present: float
    task: FootTask
    stances: dict[float, Stance]

    def simulated(self) -> dict[float, dict[str, float]]:
        """Outcomes by fulcrum."""
        return {fulcrum: stance_outcomes(stance) for fulcrum, stance in self.stances.items()}

    def walks(self) -> dict[float, bool]:
        """Whether the foot stays on the floor and bears no more than a quarter above what the present one bears."""
        most, found = float(self.stances[self.present].force[:, 1].max()), {}
        for fulcrum, stance in self.stances.items():
            on = np.flatnonzero(stance.force[:, 1] > GATE)
            whole = len(on) == on[-1] - on[0] + 1
            found[fulcrum] = whole and float(stance.force[:, 1].max()) < HARD * most
        return found

    def mapped(self, *, dragged: bool = True) -> dict[float, dict[str, float]]:
        """The same by the map of the foot along the present stance, angles kept."""
        knob = Knob("fulcrum", np.array(sorted(self.stances)), self.present)
        maps = knob.maps(vsf_foot(), self.task)
        if not dragged:
            maps = tuple(replace(each, dragged=0.0 * each.dragged) for each in maps)
        kept = knob.measured_still(maps, self.task)[0]
        return {float(f): dict(zip(AIMS, row, strict=True)) for f, row in zip(knob.settings, kept, strict=True)}


def forward_run(person: int, setting: str, others: tuple[float, ...] = OTHERS) -> ForwardRun:
    """Of a participant whose present foot has that setting."""
    leg, present = true_leg(PARTICIPANTS[person], BELOW), fulcrum_of(setting)
    lasting = STANCE[setting]
    one = course(leg, vsf_foot(), present, lasting)
    span = (-0.06, lasting + AFTER)
    stances = {
        fulcrum: simulate_stance(one.motion, vsf_foot(), fulcrum, one.push, span, tolerance=1e-4, machine_code=False)
        for fulcrum in (present, *others)
        if fulcrum == present or abs(fulcrum - present) > 5e-3
    }
    return ForwardRun(present, task_of(stances[present]), stances)


def task_of(s: Stance) -> FootTask:
    """As `prosthesis design` takes it from a recording, here without any error."""
    leg = s.motion.leg
    values = s.motion.at(s.time)
    values[:, 3:5] = s.found.q[:, :2]
    pelvis = recorded_tree(leg).poses(values)["pelvis"]
    weight = leg.person.mass * GRAVITY
    rate = pose_rate(s.time, s.poses)
    recorded = RecordedStance(s.time, s.poses, rate, s.fulcrum, s.force, s.along_foot("ground"), weight)
    return foot_task(recorded, pelvis, leg, s.foot.keel, BELOW)


def stance_outcomes(s: Stance) -> dict[str, float]:
    """Of a simulated stance while it is loaded, as `design.outcomes` has them but for the rate of loading."""
    weight = s.motion.leg.person.mass * GRAVITY
    loaded = np.flatnonzero(s.force[:, 1] > LOADED * weight)
    on = slice(int(loaded[0]), int(loaded[-1]) + 1)
    stored, lost, at = s.stored[on], s.lost[on], int(np.argmax(s.stored[on]))
    leg, time = s.motion.leg, s.time[on]
    place = leg.turn.inv()
    ankle, knee, bushing = (place.apply(each - leg.keel) for each in (leg.ankle, np.zeros(3), leg.bushing))
    centre = s.poses[on].inv().apply(np.nan_to_num(s.centre("ground")[on]))
    force = s.poses[on].rotation.inv().apply(s.force[on])
    arm = centre - bushing
    up = knee - ankle
    turn = 0.5 * np.pi - np.arctan2(up[1], up[0])
    c, sn = np.cos(turn), np.sin(turn)
    path = (centre - ankle)[:, :2] @ np.array([[c, sn], [-sn, c]])
    return {
        "ankle_moment": float(s.ankle_moment[on].max()),
        "socket_moment": float(np.abs(arm[:, 0] * force[:, 1] - arm[:, 1] * force[:, 0]).max()),
        "energy": float(stored[at] - stored[-1] - (lost[-1] - lost[at])),
        "radius": radius_of_path(time, s.force[on, 1] / weight, path),
    }


def main() -> None:
    """All of it, printed and written."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--persons", type=int, nargs="*", default=[0, 1, 3])
    parser.add_argument("--settings", nargs="*", default=["low", "medium", "high"])
    asked = parser.parse_args()
    rows = []
    for person in asked.persons:
        for setting in asked.settings:
            run = forward_run(person, setting)
            simulated, mapped, plain, walks = run.simulated(), run.mapped(), run.mapped(dragged=False), run.walks()
            away = stiffer(Knob("fulcrum", np.array(sorted(simulated)), run.present), vsf_foot().keel)
            for k, (fulcrum, of) in enumerate(sorted(simulated.items())):
                found = {aim: float(np.log(mapped[fulcrum][aim] / value)) for aim, value in of.items()}
                place = {"person": person, "setting": setting, "fulcrum": fulcrum, "present": fulcrum == run.present}
                rows.append(place | {"stiffer": float(away[k]), "walks": walks[fulcrum], **found})
                rows[-1] |= {"simulated_J": of["energy"], "energy alone": plain[fulcrum]["energy"] / of["energy"]}
                rows[-1] |= {"simulated_m": of["radius"], "radius alone": plain[fulcrum]["radius"] / of["radius"]}
                told = ", ".join(f"{aim} {100.0 * value:+.1f} %" for aim, value in found.items())
                alone = f"energy alone {100.0 * (rows[-1]['energy alone'] - 1.0):+.0f} %"
                here = "walks" if walks[fulcrum] else "does not walk"
                print(f"P{person + 1} {setting} at {1e3 * fulcrum:.0f} mm, {here}: {told}; {alone}", flush=True)
    sizes = {aim: error_sizes(rows, aim) for aim in ("ankle_moment", "socket_moment", "energy", "radius")}
    print(sizes)
    write_results("prosthesis_forward", vars(asked), {"map over simulation": rows, "sizes": sizes})


def error_sizes(rows: list[dict[str, float]], aim: str) -> dict[str, float]:
    """Root mean square on the present foot, and slope of what is added over the logarithm of the stiffness."""
    here = {(row["person"], row["setting"]): row[aim] for row in rows if row["present"]}
    others = [row for row in rows if row["walks"] and not row["present"]]
    more = np.array([row[aim] - here[row["person"], row["setting"]] for row in others])
    far = np.array([row["stiffer"] for row in others])
    size = float(np.sqrt(np.mean(np.square(list(here.values())))))
    return {"here": size, "away": float(np.sqrt(np.sum(more**2) / np.sum(far**2))), "others": float(len(others))}


if __name__ == "__main__":
    main()
