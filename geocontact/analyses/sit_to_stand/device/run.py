"""Parameters by linear least squares, whether the motion tells each by itself, and the torque of a trial."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.analyses.run_record import Record
from geocontact.analyses.sit_to_stand.device.options import StandingDeviceOptions
from geocontact.analyses.sit_to_stand.device.read import DeviceRecordings
from geocontact.analyses.sit_to_stand.device.result import StandingDeviceResult
from geocontact.standing_up.exoskeleton import EXO_JOINTS
from geocontact.standing_up.exoskeleton_torque import identified

POORLY = 0.2
"""Of the torque's own spread: a residual above it says that the motion is not this model's."""


def run(given: DeviceRecordings, o: StandingDeviceOptions, record: Record) -> StandingDeviceResult:
    """Fit, doubt, tell."""
    of = given.unloaded
    # what passes a filter at fc is correlated: of white noise 2 fc dt of the variance is left, in as many independent
    # samples, so that the variance of the unfiltered torque is that of the residual over 2 fc dt
    left = min(2.0 * o.cutoff * of.step, 1.0)
    inner = of.inner(o.cutoff)

    def through(values: Float[np.ndarray, "t ..."]) -> Float[np.ndarray, "s ..."]:
        return np.asarray(of.smooth(values, o.cutoff)[inner])

    dynamics = identified(given.subject, of.q, of.u, of.a, of.motors, through=through, independent=left)
    spread = float(np.std(of.motors, axis=0).max())
    if dynamics.residual > POORLY * spread:
        record.warn(
            f"{dynamics.residual:.2g} N m are left of the motors' torques, whose spread is {spread:.2g} N m: check the "
            "names of the hinges, the signs and that nobody wears it"
        )
    still = [name for name, rate in zip(EXO_JOINTS, np.abs(of.u).max(axis=0), strict=True) if rate < np.radians(5.0)]
    if still:
        record.warn(f"{', '.join(still)} turned at less than 5 deg/s: its friction is hardly told")
    result = StandingDeviceResult(record=record, options=o, given=given, dynamics=dynamics)
    table = result.table("parameters")
    alone = table[table["told"] == "by itself"]
    record.say(
        f"{dynamics.rank} combinations of {len(table)} parameters told, {len(alone)} parameters by themselves; "
        f"{dynamics.residual:.2g} N m are left of the motors' torques (root mean square)"
    )
    record.results["device"] = {
        "rank": dynamics.rank,
        "residual_Nm": dynamics.residual,
        "parameters": dict(zip(table["parameter"], table["value"], strict=True)),
    }
    if given.trial is not None:
        own = result.trial_torque
        sizes = ", ".join(f"{n} {v:.1f}" for n, v in zip(EXO_JOINTS, np.abs(own).max(axis=0), strict=True))
        record.say(f"largest torque of the exoskeleton in the trial [N m]: {sizes}")
    return result
