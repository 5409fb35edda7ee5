"""Soles of more spheres: errors, overshoot at touch-down and cost; and ten seconds of standing still.

    python -m benchmarks.prosthesis.soles [--person 0] [--setting medium] [--machine-code]

Every sole is fitted to the same three compressions (`vsf_foot`) and simulated along the same invented course. The
reference is a sole of 192 spheres on the same keel. Told are the centre of pressure's error over the stance [% of the
foot, root mean square where both are loaded], the resultant's [% BW], the largest vertical force in the first 60 ms
over the reference's, the largest rise within 2 ms [BW], steps and CPU seconds of the simulation alone.

Standing: the other foot carries half of the weight, nothing turns, and the prosthetic foot starts from rest with its
sole on the floor without load. After ten seconds it should carry the other half.
"""

from __future__ import annotations

import argparse
import time
from dataclasses import asdict, dataclass

import numpy as np

from benchmarks.machine import write_results
from geocontact.below_knee_prosthesis.keel.foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.keel.sole import numbers as sole_numbers
from geocontact.below_knee_prosthesis.keel.vsf import SETTINGS, fulcrum_of, vsf_foot
from geocontact.below_knee_prosthesis.leg_tree import GRAVITY
from geocontact.below_knee_prosthesis.simulate import Stance, simulate_stance
from geocontact.below_knee_prosthesis.stance_model import FLOOR
from geocontact.below_knee_prosthesis.standing_still import LASTING, standing_still
from geocontact.geometry.shapes import HalfSpace
from meshes.gait_course import GaitCourse, course
from meshes.gait_persons import PARTICIPANTS, STANCE, true_leg

SOLES = {24: (1, 2), 48: (2, 2), 96: (2, 4), 192: (4, 4)}
"""Factor on the rows of each zone and spheres in a row, by how many spheres that makes; the last is the reference."""
LANDING, RISE = 0.06, 1
"""s from touch-down in which the overshoot is sought; samples of 2 ms over which a rise is."""
TOLERANCE = 1e-5


@dataclass(frozen=True)
class SoleOutcome:
    """One sole beside the reference; shares of the foot and of body weight."""

    spheres: int
    centre: float
    resultant: float
    first: float
    rise: float
    steps: int
    seconds: float


def a_sole(count: int) -> VariableStiffnessFoot:
    """Fitted like the usual one."""
    finer, columns = SOLES[count]
    return vsf_foot(finer=finer, columns=columns)


def outcomes(person: int, setting: str, *, counts: tuple[int, ...], machine_code: bool) -> list[SoleOutcome]:
    """Of soles that were asked for, beside the finest."""
    fulcrum = fulcrum_of(setting, "pinned")
    leg = true_leg(PARTICIPANTS[person], sole_numbers()["below"].value)
    driven = course(leg, vsf_foot(), fulcrum, STANCE[setting])
    reference, _ = _run(driven, a_sole(max(SOLES)), fulcrum, machine_code)
    found = []
    for count in counts:
        stance, seconds = _run(driven, a_sole(count), fulcrum, machine_code)
        found.append(_beside(count, stance, reference, seconds))
    return found


def _run(driven: GaitCourse, foot: VariableStiffnessFoot, fulcrum: float, machine_code: bool) -> tuple[Stance, float]:
    def once() -> Stance:
        return simulate_stance(
            driven.motion, foot, fulcrum, driven.push, driven.span, tolerance=TOLERANCE, machine_code=machine_code
        )

    if machine_code:
        once()  # compiles
    before = time.process_time()
    stance = once()
    return stance, time.process_time() - before


def _beside(count: int, stance: Stance, reference: Stance, seconds: float) -> SoleOutcome:
    weight = stance.motion.leg.person.mass * GRAVITY
    both = stance.on & reference.on
    centre = (stance.along_foot("ground") - reference.along_foot("ground"))[both]
    loaded = stance.on | reference.on
    size = [np.linalg.norm(each.force, axis=1)[loaded] / weight for each in (stance, reference)]
    first = []
    for each in (stance, reference):
        start = float(each.time[each.on][0])
        landing = (each.time >= start) & (each.time <= start + LANDING)
        first.append(float(each.force[landing, 1].max()) / weight)
    rise = float(np.diff(stance.force[::RISE, 1]).max()) / weight
    rms = [float(np.sqrt(np.mean(each**2))) for each in (centre, size[0] - size[1])]
    return SoleOutcome(count, rms[0], rms[1], first[0] - first[1], rise, stance.found.steps, seconds)


def static_share(
    person: int, setting: str, *, lasting: float = LASTING, machine_code: bool, ground: HalfSpace = FLOOR
) -> tuple[float, float, int]:
    """Load that is missing at the end over body weight, how far the foot has slid [m], and steps."""
    leg = true_leg(PARTICIPANTS[person], sole_numbers()["below"].value)
    fulcrum = fulcrum_of(setting, "pinned")
    found = standing_still(leg, vsf_foot(), fulcrum, lasting=lasting, ground=ground, machine_code=machine_code)
    return found.missing, found.slid, found.stance.found.steps


def main() -> None:
    """Print both tables; benchmarks/results/prosthesis_soles.json."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--person", type=int, default=0)
    parser.add_argument("--setting", default="medium", choices=list(SETTINGS))
    parser.add_argument("--machine-code", action="store_true")
    asked = parser.parse_args()
    standing, soles = {}, []
    print("standing for 10 s: load missing [% BW], slid [mm], steps", flush=True)
    for setting in SETTINGS:
        off, slid, steps = static_share(asked.person, setting, machine_code=asked.machine_code)
        standing[setting] = {"missing": off, "slid": slid, "steps": steps}
        print(f"  {setting:8}{100.0 * off:10.4f}{1e3 * slid:8.2f}{steps:7d}", flush=True)
    print("spheres  centre [% foot]  resultant [% BW]  landing [% BW]  rise in 2 ms [BW]  steps  CPU s", flush=True)
    for one in outcomes(asked.person, asked.setting, counts=tuple(SOLES), machine_code=asked.machine_code):
        soles.append(asdict(one))
        row = f"{one.spheres:7d}{100.0 * one.centre:17.2f}{100.0 * one.resultant:18.2f}{100.0 * one.first:16.2f}"
        print(f"{row}{one.rise:19.3f}{one.steps:7d}{one.seconds:7.1f}", flush=True)
    write_results("prosthesis_soles", vars(asked), {"standing": standing, "soles": soles}, {"casadi"})


if __name__ == "__main__":
    main()
