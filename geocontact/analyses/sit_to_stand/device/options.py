"""What the exoskeleton's own dynamics may be asked for."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import Annotated, ClassVar

from geocontact.analyses.frame.marks import Fraction, Requires, Spelled
from geocontact.analyses.frame.options import Options
from geocontact.data.errors import InputError
from geocontact.data.plausible import HZ, TALL, Plausible

CUTOFF = Plausible("the cut-off of angles and torques", HZ, (0.5, 100.0), (2.0, 20.0))


@dataclass(frozen=True)
class StandingDeviceOptions(Options):
    """Dynamic parameters of a leg exoskeleton from a motion without a person, and its own torque in a trial.

    Parameters
    ----------
    unloaded
        Angles exo_ankle, exo_knee and exo_hip while the exoskeleton moves alone, its foot plate on the ground
        (.sto, .mot).
    motors
        Torques of its motors meanwhile, columns of the same names, of both legs [N m].
    height
        Height of the wearer, which says how long its parts are [m].
    cutoff
        Cut-off of the low-pass of angles and torques [Hz].
    level
        Probability of the intervals.
    device
        Description of the exoskeleton (.toml) into which device.toml merges what is identified; its lengths count
        before those that follow from `height`.

    A trial
    -------
    trial
        Coordinates of a trial with a person (.sto, .mot).
    trial_motors
        Torques of the motors in it [N m].
    together
        forces.csv of `geocontact id` of that trial, of person and exoskeleton rigidly coupled: the person's torques are
        these less the exoskeleton's.
    """

    writes: ClassVar[str] = """
    Writes parameters.csv (value, interval, and whether the motion identifies it by itself), unloaded.csv (torques of
    the motors and of the fit), numbers.csv (all that ran), device.toml (the exoskeleton for `calibrate`, `predict`,
    `compare` and `design`), with a trial torque.csv and torques.sto, a figure,
    report.html and run.json into OUT.
    """

    over_time = True

    unloaded: Path
    _: KW_ONLY
    motors: Path
    height: Annotated[float, TALL] = 1.75
    cutoff: Annotated[float, CUTOFF] = 6.0
    level: Annotated[Fraction, Spelled(default="0.95")] = 0.95
    device: Path | None = None
    trial: Annotated[Path | None, Requires("trial_motors")] = None
    trial_motors: Annotated[Path | None, Requires("trial")] = None
    together: Annotated[Path | None, Requires("trial")] = None

    def refuse_impossible(self) -> None:
        """A probability that is none."""
        if not 0.0 < self.level < 1.0:
            raise InputError("", "`level`", f"{self.level:g} is not between 0 and 1", "give for example 0.95")
