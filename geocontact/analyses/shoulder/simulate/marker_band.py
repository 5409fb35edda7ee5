"""Elevation and forces of an arm under errors of its markers: each is drawn once for a recording, fixed on the upper
arm, as a marker that was stuck beside its place is; what skin does during the movement is not in it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.collector import listener, note, reserve, say
from geocontact.analyses.shoulder.simulate.arms import Worn
from geocontact.analyses.shoulder.simulate.options import ShoulderSimulateOptions
from geocontact.data.errors import InputError
from geocontact.shoulder_exoskeleton.arm_motion import ArmMotion
from geocontact.shoulder_exoskeleton.arms_from_markers import elevation
from geocontact.shoulder_exoskeleton.torque_kept import turned
from geocontact.shoulder_exoskeleton.working_arm import SimulatedArm, arm_at_work

DRAWS = 40
ENDS = (0.025, 0.975)
"""Quantiles between which the band holds 95 % of the draws."""
CHANNELS = {"elevation": ("deg", float(np.degrees(1.0))), "supporting": ("N", 1.0), "shear": ("N", 1.0)}
"""Courses of a simulation that have a band, with unit and factor of tables."""


@dataclass(frozen=True, eq=False)
class ArmBand:
    """One arm.

    Parameters
    ----------
    ends
        Lower and upper end over time by channel, in SI.
    used, lost
        Draws that were simulated, and those that ended outside of the cuff or could not be stepped.
    """

    side: str
    time: Float[np.ndarray, " t"]
    ends: Mapping[str, tuple[Float[np.ndarray, " t"], Float[np.ndarray, " t"]]]
    used: int
    lost: int


def displaced(motion: ArmMotion, lower: Float[np.ndarray, " 3"], upper: Float[np.ndarray, " 3"]) -> ArmMotion:
    """The motion with both markers off their places [m], fixed on the arm.

    Axes are those of the device's frame on a hanging arm, turned with the arm along the shortest arc.
    """
    along = motion.interface - motion.shoulder
    along = along / np.linalg.norm(along, axis=1, keepdims=True)
    axis = np.cross([0.0, 0.0, -1.0], along)
    size = np.linalg.norm(axis, axis=1, keepdims=True)
    axis = np.divide(axis, size, out=np.tile([1.0, 0.0, 0.0], (len(axis), 1)), where=size > 0.0)
    angle = np.arctan2(size[:, 0], -along[:, 2])
    interface, shoulder = (
        place + turned(axis, angle, np.broadcast_to(by, place.shape))
        for place, by in ((motion.interface, lower), (motion.shoulder, upper))
    )
    return replace(motion, interface=interface, shoulder=shoulder, elevation=elevation(shoulder, interface))


def marker_bands(worn: Worn, arms: Sequence[SimulatedArm], o: ShoulderSimulateOptions) -> tuple[ArmBand, ...]:
    """Bands of each arm; none where no error is stated. InputError where hardly a draw can be simulated."""
    if o.marker_error is None:
        return ()
    rng = np.random.default_rng(o.seed or 0)
    return tuple(_band(worn, arm, o, o.marker_error, rng) for arm in arms)


def _band(worn: Worn, arm: SimulatedArm, o: ShoulderSimulateOptions, error: float, rng: np.random.Generator) -> ArmBand:
    motion, count = arm.simulation.motion, o.draws or DRAWS
    control = None if worn.controllers is None else worn.controllers[arm.side]
    found: dict[str, list[Float[np.ndarray, " t"]]] = {name: [] for name in CHANNELS}
    with listener().stages(f"{arm.side} arm") as at:
        for k in range(count):
            at(f"draw {k + 1} of {count} of the marker errors")
            moved = displaced(motion, *(error * rng.normal(size=(2, 3))))
            try:
                own = arm_at_work(
                    moved, worn.device, worn.wearer, o.level, tool=worn.tool, controller=control, cuff=o.cuff
                )
            except ArithmeticError:
                continue
            for name, values in found.items():
                values.append(getattr(own.simulation, name))
    used = len(found["elevation"])
    if used < count // 2:
        what = f"{count - used} of {count} draws leave the {arm.side} arm outside of its cuff"
        raise InputError("", "`marker_error`", what, "give a smaller one, or leave it out")
    ends = {name: _ends(np.array(values)) for name, values in found.items()}
    if used < count:
        reserve(f"{arm.side} arm: {count - used} of {count} draws of the marker errors left the cuff and do not count")
    peak = np.quantile([values.max() for values in found["supporting"]], ENDS)
    high = np.degrees(np.quantile([values.max() for values in found["elevation"]], ENDS))
    say(
        f"{arm.side} arm, markers off by {1e3 * error:g} mm (standard deviation): elevation up to {high[0]:.1f} to "
        f"{high[1]:.1f} deg, supporting force up to {peak[0]:.1f} to {peak[1]:.1f} N (95% of {used} draws)"
    )
    note(f"marker errors, {arm.side}", {"supporting_max_N": peak.tolist(), "elevation_max_deg": high.tolist()})
    return ArmBand(arm.side, motion.time, ends, used, count - used)


def _ends(values: Float[np.ndarray, "d t"]) -> tuple[Float[np.ndarray, " t"], Float[np.ndarray, " t"]]:
    lower, upper = np.quantile(values, ENDS, axis=0)
    return lower, upper


def band_table(bands: Sequence[ArmBand]) -> pd.DataFrame:
    """Both ends of every channel over time, one arm below the other."""
    parts = []
    for band in bands:
        columns: dict[str, object] = {"arm": [band.side] * len(band.time), "time [s]": band.time}
        for name, (unit, factor) in CHANNELS.items():
            for end, values in zip(("lower", "upper"), band.ends[name], strict=True):
                columns[f"{name} {end} [{unit}]"] = factor * values
        parts.append(pd.DataFrame(columns))
    return pd.concat(parts, ignore_index=True)
