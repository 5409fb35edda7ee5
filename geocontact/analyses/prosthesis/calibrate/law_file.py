"""The calibrated law as a file of the form that `geocontact cop` reads: SI, friction, stiffness and damping by zone."""

from __future__ import annotations

import numpy as np

from geocontact.below_knee_prosthesis.calibration.calibrate import SoleCalibration
from geocontact.below_knee_prosthesis.calibration.whole_calibration import WholeCalibration
from geocontact.below_knee_prosthesis.model.foot_offset import FootOffset

HEAD = """\
# Force law of the sole, calibrated on one stance; SI units. Numbers marked unknown were never loaded; those marked
# not identified the stance hardly tells: the prior has most of the say.
"""
FOOT = """
[foot]  # beside where its standing trial has it, found with the law; `sd` are standard deviations
height = {height!r}  # m, its middle raised
height_sd = {height_sd!r}  # m
pitch = {pitch!r}  # rad, the toes up
pitch_sd = {pitch_sd!r}  # rad
standing = "{standing}"  # SHA-256 of that trial: [foot] holds beside no other"""


def law_toml(found: SoleCalibration | WholeCalibration, standing: str) -> str:
    """Text of the file.

    Parameters
    ----------
    standing
        SHA-256 of the standing trial.
    """
    law = found.law
    lines = [HEAD, f"n = {law.exponent!r}", f"delta_full = {law.full_depth!r}", f"v_th = {law.threshold_speed!r}"]
    verdicts = {each.name: each.verdict for each in found.knowledge.numbers}
    count = len(law.stiffness)
    for zone, chosen in found.residuals.zones.sole.spheres.zones.items():
        k = int(np.flatnonzero(chosen)[0])
        static, kinetic = (float(np.broadcast_to(each, count)[k]) for each in (law.static, law.kinetic))
        lines += ["", f"[zone.{zone}]"]
        lines.append(f"k = {float(law.stiffness[k])!r}  # {verdicts[f'stiffness.{zone}']}")
        lines.append(f"b = {float(law.damping[k])!r}  # {verdicts[f'damping.{zone}']}")
        lines.append(f"mu_s = {static!r}  # its ratio to mu_k is kept")
        lines.append(f"mu_k = {kinetic!r}  # {verdicts[f'friction.{zone}']}")
    lines += [_foot(each, standing) for each in found.offsets[:1]]
    return "\n".join(lines) + "\n"


def _foot(offset: FootOffset, standing: str) -> str:
    names = ("height", "height_sd", "pitch", "pitch_sd")
    return FOOT.format(standing=standing, **{name: float(getattr(offset, name)) for name in names})
