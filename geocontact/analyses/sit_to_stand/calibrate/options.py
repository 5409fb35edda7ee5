"""What a calibration of contacts while standing up may be asked for."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import Annotated, ClassVar

from geocontact.analyses.frame.marks import Fraction, Spelled
from geocontact.analyses.sit_to_stand.search_options import NODES, StandingSearchOptions, within
from geocontact.data.errors import InputError
from geocontact.data.plausible import SEARCH

MOST_STARTS, MOST_POINTS = 1000, 20


@dataclass(frozen=True)
class StandingCalibrateOptions(StandingSearchOptions):
    """Calibrate foot and ground contact from sit-to-stand trials, from several trials at once.

    Parameters
    ----------
    study
        Person, noise and trials (.toml).

    The search
    ----------
    starts
        Further starts, drawn from the prior of the parameters.
    resamples
        Calibrations of trials simulated from the result; their mean error is subtracted; fewer than two for none.
    seed
        Seed of starts and resamples.
    level
        Probability of the intervals.
    select
        Free those parameters that these trials identify together, instead of the usual ones or `free` of the study.
    profiles
        Points to either side of each parameter, up to three standard deviations away, where all else is refitted.
    """

    writes: ClassVar[str] = """
    Writes parameters.csv (value, interval, and whether the trials identify it), errors.csv (error of each channel),
    selection.csv (which parameters the trials identify together), rmsd_by_trial.csv (in the form of the study's Table
    II), certificate.csv (of the motion), correlation.csv, numbers.csv and mesh.csv (all that ran), model.osim, a table
    over time and a trajectory for OpenSim's Moco for each trial, figures (forces, kinematics, moments, contact laws),
    report.html and run.json into OUT.

    Ctrl-C stops the optimisation and saves its last iterate.
    """

    study: Path
    _: KW_ONLY
    nodes: Annotated[float, NODES] = 30.0
    time_limit: Annotated[float, SEARCH] = 600.0
    starts: int = 0
    resamples: int = 6
    seed: int = 0
    level: Annotated[Fraction, Spelled(default="0.95")] = 0.95
    profiles: int = 0
    select: bool = False

    def refuse_impossible(self) -> None:
        """Numbers without a search, a probability that is none."""
        super().refuse_impossible()
        within("starts", self.starts, 0, MOST_STARTS, 20)
        within("resamples", self.resamples, 0, MOST_STARTS, 6)
        within("profiles", self.profiles, 0, MOST_POINTS, 3)
        if not 0.0 < self.level < 1.0:
            raise InputError("", "`level`", f"{self.level:g} is not between 0 and 1", "give for example 0.95")
