"""The controllers of both arms, from the profile that the options name and the tool's current."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.analyses.run_record import Record
from geocontact.analyses.shoulder.simulate.options import ShoulderSimulateOptions
from geocontact.analyses.shoulder.support_profiles import read_profiles
from geocontact.analyses.shoulder.tool import current_at
from geocontact.data.errors import InputError
from geocontact.shoulder_exoskeleton.arm_motion import Side
from geocontact.shoulder_exoskeleton.from_markers.arm_motions import SIDES
from geocontact.shoulder_exoskeleton.support.controlled_arm import Controller
from geocontact.shoulder_exoskeleton.support.outcome import Factors
from geocontact.shoulder_exoskeleton.support.phase_machine import Thresholds
from geocontact.shoulder_exoskeleton.support.support_case import FactorKey, Hand
from geocontact.shoulder_exoskeleton.work_phases import PHASES


def controllers(
    o: ShoulderSimulateOptions, time: Float[np.ndarray, " t"], record: Record
) -> Mapping[Side, Controller] | None:
    """By side; None where the support is constant."""
    if o.profile is None or o.tool is None:
        return None
    profiles = read_profiles(o.profile)
    record.add_input("`profile`", o.profile, profiles=len(profiles))
    name = next(iter(profiles)) if o.profile_name is None else o.profile_name
    if name not in profiles:
        raise InputError(o.profile, "`profile_name`", f"no profile {name!r}", f"there are {', '.join(profiles)}")
    factors = profiles[name]
    task = _task(o.profile, factors, o.task)
    record.results["profile"] = {"name": name, "task": task}
    current = current_at(o.tool, time)
    found: dict[Side, Controller] = {}
    for side in SIDES if o.side == "both" else (o.side,):
        hand: Hand = "dominant" if side == (o.dominant or "right") else "other"
        keys = [FactorKey(task, hand, phase) for phase in PHASES]
        if not any(key in factors for key in keys):
            raise InputError(o.profile, name, f"no factors of the {hand} hand for {task}", "add a row")
        found[side] = Controller(np.array([factors.get(key, 0.0) for key in keys]), current, Thresholds())
    return found


def _task(file: Path, factors: Factors, named: str | None) -> str:
    tasks = tuple(dict.fromkeys(key.task for key in factors))
    if named is None and len(tasks) > 1:
        raise InputError(file, "`task`", f"factors of {len(tasks)} tasks", f"say which: {', '.join(tasks)}")
    if named is not None and named not in tasks:
        raise InputError(file, "`task`", f"no factors of {named!r}", f"there are {', '.join(tasks)}")
    return tasks[0] if named is None else named
