"""The law of a sole from a file, such as a calibration leaves one, and how its foot is beside its standing trial."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from geocontact.analyses.run_record import Record
from geocontact.analyses.stale_results import digest
from geocontact.below_knee_prosthesis.keel.vsf_foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.model.foot_offset import AS_STOOD, FootOffset
from geocontact.data.errors import InputError
from geocontact.io.recordings.spheres import read_law
from geocontact.loads.sphere_set import SoleLaw


def foot_with_law(record: Record, foot: VariableStiffnessFoot, file: Path | None) -> VariableStiffnessFoot:
    """The foot with the numbers that a file gives, for all spheres or by zone; the rest are as they were."""
    if file is None:
        return foot
    told, zones = read_law(file), foot.sole.spheres.zones
    record.add_input("`law`", file)
    strange = sorted(set(told.zone) - set(zones))
    if strange:
        raise InputError(file, f"zone.{strange[0]}", "no sphere is in that zone", f"zones are: {', '.join(zones)}")
    count, law = len(foot.sole.spheres), foot.law
    usual = {"k": law.stiffness, "b": law.damping, "mu_s": law.static, "mu_k": law.kinetic}
    found = {}
    for key, values in usual.items():
        all_spheres = getattr(told, key)
        found[key] = np.array(np.broadcast_to(values if all_spheres is None else all_spheres, count), float)
        for zone, numbers in told.zone.items():
            if (value := getattr(numbers, key)) is not None:
                found[key][zones[zone]] = value
    shared = {"exponent": told.n, "full_depth": told.delta_full, "threshold_speed": told.v_th}
    given = {name: value for name, value in shared.items() if value is not None}
    try:
        new: SoleLaw = replace(
            law, stiffness=found["k"], damping=found["b"], static=found["mu_s"], kinetic=found["mu_k"], **given
        )
    except ValueError as error:
        raise InputError(file, "force law", str(error), "correct the number") from error
    return replace(foot, law=new)


def offset_of_law(record: Record, file: Path | None, standing: Path) -> FootOffset:
    """How the foot is beside a standing trial; none where the file does not say, or says it of another trial."""
    told = None if file is None else read_law(file).foot
    if told is None:
        return AS_STOOD
    if told.standing is not None and told.standing != digest(standing):
        record.warn(
            f"{file}: [foot] was found beside another standing trial than `static`, and is left out: height and pitch "
            "are errors of that trial (if it is the same in another file, take the line `standing` out of the law)"
        )
        return AS_STOOD
    return FootOffset(told.height, told.pitch, told.height_sd, told.pitch_sd)


def offset_words(offset: FootOffset) -> str:
    """What was taken over, in a sentence."""
    return f"the foot is {offset.words} beside where its standing trial has it, as the law's file says"
