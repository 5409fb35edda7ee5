"""The calibrated law as a file of the form that `geocontact cop` reads: SI, friction, stiffness and damping by zone."""

from __future__ import annotations

import numpy as np

from geocontact.below_knee_prosthesis.calibration.calibrate import SoleCalibration
from geocontact.below_knee_prosthesis.calibration.whole_calibration import WholeCalibration

HEAD = """\
# Force law of the sole, calibrated on one stance; SI units. Numbers marked unknown were never loaded; those marked
# not identified the stance hardly tells: the prior has most of the say.
"""


def law_toml(found: SoleCalibration | WholeCalibration) -> str:
    """Text of the file."""
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
    return "\n".join(lines) + "\n"
