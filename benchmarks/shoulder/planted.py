"""Recordings of a shoulder exoskeleton with one effect planted, or none: `python -m benchmarks.shoulder.planted OUT`.

Synthetic: finer 3-D code makes logger and mat of four trials of one participant. Two devices: `held`, whose passive
joints are locked and whose arms are raised in a plane, which is what a base model can be asked about; and `free`, the
whole device along the whole motion, cuff of eight rings, the paper's friction. Recordings are kept in OUT; some
minutes of processor time for all.

What the base model cannot have is kept out of `held`, else all cases are one gap: the passive joints are locked, the
arms are raised in the plane of the active joint about a shoulder that stays, gravity lies in it. Cells lie on one ring,
so that the cuff does not clamp, and the cuff is long enough that no arm leaves it; friction is a tenth of the paper's.
The logger has its steps but no lag, which is an effect of its own.
"""

from __future__ import annotations

import argparse
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import Literal

import numpy as np

from benchmarks.shoulder.trials import dominant_arm, wearer_of
from benchmarks.shoulder.truth import LOGGER, Measured, Truth, Withheld, measure
from geocontact.shoulder_exoskeleton.arm_motion import ArmMotion
from geocontact.shoulder_exoskeleton.arm_numbers import adjusted_numbers, slices
from geocontact.shoulder_exoskeleton.device import Device, Wearer, lucy
from geocontact.shoulder_exoskeleton.support.phase_machine import SCREW
from geocontact.shoulder_exoskeleton.synthetic import OverheadTrial, condition, participant, synthetic_trial, task

PERSON = "P1"
TRIALS = {"t01": ("T1", "S50"), "t02": ("T2", "S100"), "t03": ("T1", "S100"), "t04": ("T2", "S50")}
CALIBRATION, EVALUATION = ("t01", "t02"), ("t03", "t04")
PLANTED = {
    "nothing": Withheld(),
    "push force": Withheld(push=0.3),
    "poor contact": Withheld(gap=6e-3),
    "force at zero elevation": Withheld(strap=1.5e-2),
    "jump at lowering": Withheld(seal=0.8),
}
"""What the finer code withholds."""
LOOSE = lucy().having(cuff_length=0.25, mu_s=0.1, mu_k=0.08, passive_1_damping=0.5, passive_2_damping=0.5)
LOCKED = {f"passive_{k}_{end}": sign * np.radians(0.05) for k in (1, 2) for end, sign in (("lower", -1), ("upper", 1))}
HELD = LOOSE.having(**LOCKED, stop_stiffness=1e4, stop_width=1e-3)
"""Its passive joints are held within 0.07 degrees."""
Way = Literal["held", "free"]
DEVICES: dict[Way, Device] = {"held": HELD, "free": lucy()}
DOWN = np.array([0.0, 0.0, -9.81])
STEP = np.radians(LOGGER[0])


def in_plane(motion: ArmMotion, device: Device, wearer: Wearer, still: bool = True) -> ArmMotion:
    """The same elevation in the plane through the cuff's middle, as if the arm were turned forwards.

    `still` holds the shoulder at its mean place.
    """
    p, of = adjusted_numbers(device, wearer, 1.0), slices()
    upper = motion.interface - motion.shoulder
    ahead = np.linalg.norm(upper[:, :2], axis=1)
    shoulder = motion.shoulder.copy()
    shoulder[:, 0] = sum(p[of[part]][0] for part in ("base", "link_1", "link_2", "cuff"))
    if still:
        shoulder[:, 1:] = shoulder[:, 1:].mean(axis=0)
    flat = np.column_stack([0.0 * ahead, -ahead, upper[:, 2]])
    elevation = np.arctan2(ahead, -upper[:, 2])
    return replace(motion, shoulder=shoulder, interface=shoulder + flat, elevation=elevation, gravity=DOWN)


def trial_of(name: str) -> OverheadTrial:
    """The synthetic trial of that name."""
    work, worn = TRIALS[name]
    return synthetic_trial(participant(PERSON), task(work), condition(worn))


def motion_of(trial: OverheadTrial, way: Way) -> ArmMotion:
    """The dominant arm as it moves in this trial."""
    motion = dominant_arm(trial)
    return motion if way == "free" else in_plane(motion, HELD, wearer_of(trial.participant))


def recorded(kept: Path, kind: str, name: str, way: Way) -> Measured:
    """What logger and mat show of one trial; that of an earlier run where its file is there."""
    file = kept / way / f"{kind.replace(' ', '_')}_{name}.npz"
    if file.is_file():
        with np.load(file) as found:
            return Measured(**found)
    trial = trial_of(name)
    truth = Truth(DEVICES[way], wearer_of(trial.participant), float(trial.condition.level or 0.0), PLANTED[kind])
    if way == "held":
        truth.s = 0.0 * truth.s
    pushing = np.where(trial.phase == SCREW, trial.task.push, 0.0)
    seed = 10 * list(TRIALS).index(name) + list(PLANTED).index(kind)
    found = measure(truth, motion_of(trial, way), seed, pushing)
    prompt = replace(found, logger=np.round(found.angles[:, 2] / STEP) * STEP)
    file.parent.mkdir(parents=True, exist_ok=True)
    np.savez_compressed(file, **vars(prompt))
    return prompt


def _made(what: tuple[Path, Way, str, str]) -> str:
    kept, way, kind, name = what
    recorded(kept, kind, name, way)
    return f"{way}: {kind}, {name}"


def main() -> None:
    """Make all that is not there."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.shoulder.planted", description=__doc__.splitlines()[0])
    parser.add_argument("out", type=Path)
    parser.add_argument("--way", choices=list(DEVICES), action="append", help="both by default")
    parser.add_argument("--trial", choices=list(TRIALS), action="append", help="all by default")
    asked = parser.parse_args()
    wanted = product(asked.way or DEVICES, reversed(PLANTED), asked.trial or TRIALS)
    with ProcessPoolExecutor(2) as pool:
        for told in pool.map(_made, [(asked.out, *each) for each in wanted]):
            print(told, flush=True)


if __name__ == "__main__":
    main()
