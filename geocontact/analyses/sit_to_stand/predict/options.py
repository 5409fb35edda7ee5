"""What a prediction of standing up may be asked for."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass, field
from pathlib import Path
from typing import Annotated, ClassVar

from geocontact.analyses.frame.marks import Spelled, Typed
from geocontact.analyses.sit_to_stand.search_options import StandingSearchOptions
from geocontact.data.errors import InputError

Factors = Annotated[
    Mapping[str, float],
    Typed("-", "named_numbers", '{"straps": 1.4}', kind=tuple[str, ...]),
    Spelled(default=(), each=True),
]


@dataclass(frozen=True)
class StandingPredictOptions(StandingSearchOptions):
    """Movement and strap force of trials that were not used, with calibrated contacts.

    Parameters
    ----------
    study
        The trials (.toml). Their coordinates and strap are compared with, and only the first and last posture is used.
    parameters
        parameters.csv of a calibration with the exoskeleton.
    against
        Study of the trials of the calibration (.toml), whose mean is the trivial predictor.
    perturb
        Factor of a parameter, for a further prediction beside the others; may be repeated: straps=1.4 for the
        stiffnesses of all straps, or a name of `parameters`.
    """

    writes: ClassVar[str] = """
    Writes errors.csv (how far every predictor is off: all given, without ground reaction, without torques, and the mean
    of the calibration's trials), rmsd_by_trial.csv (in the form of the study's Table III), certificate.csv, numbers.csv
    and mesh.csv (all that ran), a table over time and a trajectory for OpenSim's Moco for each trial, figures of the
    strap, of angles and angular velocities, report.html and run.json into OUT.
    """

    study: Path
    _: KW_ONLY
    parameters: Path
    against: Path
    perturb: Factors = field(default_factory=dict)

    def refuse_impossible(self) -> None:
        """Factors that are none."""
        super().refuse_impossible()
        for name, factor in self.perturb.items():
            if not (math.isfinite(factor) and factor > 0.0):
                raise InputError("", "`perturb`", f"{factor:g} is no factor of {name}", "give for example straps=1.4")
