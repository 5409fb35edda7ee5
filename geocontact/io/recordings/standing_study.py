"""Description of trials of standing up from a chair.

    mass = { value = 70, unit = "kg" }
    height = { value = 1.75, unit = "m" }

    [noise]
    length = { value = 0.5, unit = "mm" }
    angle = { value = 0.3, unit = "deg" }
    rate = { value = 0.02, unit = "rad/s" }
    force = { value = 2, unit = "N" }
    centre = { value = 1, unit = "mm" }

    [[trials]]
    name = "T1"
    coordinates = "T1_coordinates.sto"
    rates = "T1_rates.sto"
    plates = "T1_plates.mot"
    feet = "feet"
    chair = "chair"

Files are looked for beside the description. With `sitting = true` a trial begins while the person still sits, and the
chair's force is a load on the model. With `exoskeleton = true` a trial also has `torques` and at least one of the
straps, whose force on the person is positive forwards: `time [s], normal [N]`, or the wrench.csv of a mat on a scan, x
forwards. A list of files, such as mats in front and behind, has the sum of their forces. `shear [N]` in the thigh's is
the measured force along it, which is compared with the predicted one.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated

from pydantic import Field, model_validator

from geocontact.data.plausible import KG, Plausible
from geocontact.data.text import same_place
from geocontact.data.units import m
from geocontact.io.documents import (
    Document,
    File,
    FileName,
    Files,
    Listed,
    Names,
    Some,
    WithUnit,
    Word,
    read_document,
    refusal,
)

BODY = Plausible("the mass of a person", KG, (20.0, 300.0))
TALL = Plausible("the height of a person", m, (0.8, 2.5))
NOISE = {"length": "m", "angle": "rad", "rate": "rad/s", "force": "N", "centre": "m"}
NOISE |= {"torque": "N m", "strap": "N", "shear": "N"}
"""SI units of the standard deviations."""
Deviation = {name: Annotated[float, WithUnit(unit), Field(gt=0.0)] for name, unit in NOISE.items()}
Time = Annotated[float, WithUnit("s", bare=True)]


class StandingTrialFiles(Document):
    """A trial as it is described.

    Parameters
    ----------
    name
        Its own for each.
    coordinates, rates
        Joint angles and their rates: .sto or .mot.
    plates
        Force plates.
    torques
        Torques of all joints of both legs: .sto, [N m].
    strap
        Normal force on the thigh: .csv of the mat of one leg, `normal [N]`, or `wrench.csv` of a mat on a scan; with
        load cells or a two-axis mat also `shear [N]`, along the thigh, towards the hip, which is compared only.
    strap_shank, strap_pelvis
        The same of further straps; the pelvis has the force of the whole module.
    feet, chair
        Plates by name or number.
    sitting
        Whether the trial begins before seat-off, with the chair's force as a load.
    start, end
        Times between which the trial is used.
    """

    name: FileName
    coordinates: File
    rates: File | None = None
    plates: File | None = None
    torques: File | None = None
    strap: Files = ()
    strap_shank: Files = ()
    strap_pelvis: Files = ()
    feet: Word | None = None
    chair: Word | None = None
    sitting: bool = False
    start: Time | None = None
    end: Time | None = None

    @property
    def elsewhere(self) -> Mapping[str, tuple[Path, ...]]:
        """Files of the straps besides the thigh's, by site, of those that were recorded."""
        straps = {"shank": self.strap_shank, "pelvis": self.strap_pelvis}
        return {site: files for site, files in straps.items() if files}

    @model_validator(mode="after")
    def _require_chair(self) -> StandingTrialFiles:
        if self.sitting and (self.chair is None or self.plates is None):
            raise refusal("sitting needs the force of a chair", "name plates, with a chair among them")
        return self


class StandingStudy(Document):
    """Everything in the description.

    Parameters
    ----------
    mass
        Body mass.
    height
        Body height.
    exoskeleton
        Whether it was worn.
    noise
        Standard deviation of one sample; `rate` is that of turns and, in m/s, of the foot's place.
    free
        Names of parameters that are fitted; the usual ones by default.
    tracks
        Names of what the motion follows, `coordinates` among them; all that was recorded by default.
    trials
        All trials.
    """

    mass: Annotated[float, WithUnit(BODY)]
    height: Annotated[float, WithUnit(TALL)]
    exoskeleton: bool = False
    noise: Annotated[Mapping[str, float], Some(Deviation)] = {}
    free: Names | None = None
    tracks: Names | None = None
    trials: Annotated[tuple[StandingTrialFiles, ...], Listed("T{number}", same_place)]


def read_standing_study(path: Path) -> StandingStudy:
    """The description; InputError for what is missing or cannot be."""
    return read_document(path, StandingStudy)
