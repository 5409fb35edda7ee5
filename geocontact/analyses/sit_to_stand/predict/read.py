"""What a prediction starts from: trials to predict, parameters, and the trials that they are from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.analyses.run_record import Record
from geocontact.analyses.sit_to_stand.predict.options import StandingPredictOptions
from geocontact.analyses.sit_to_stand.standing_trials import StandingUpTrials, standing_trials
from geocontact.data.errors import InputError
from geocontact.io.recordings.contact_parameters import read_contact_parameters
from geocontact.standing_up.contact_parameter import ContactParameter, searched
from geocontact.standing_up.feet import FOOT_PARAMETERS
from geocontact.standing_up.strap_sites import StrapSite


@dataclass(frozen=True, eq=False)
class HeldOutTrials:
    """Trials to predict.

    Parameters
    ----------
    p
        What is searched of all parameters.
    known
        Trials of the calibration, which say where straps are.
    """

    trials: StandingUpTrials
    p: Float[np.ndarray, " p"]
    known: StandingUpTrials

    @property
    def values(self) -> dict[str, float]:
        """Of all parameters by name, in SI."""
        every = _parameters(self.known.sites)
        return {each.name: each.value(float(p)) for each, p in zip(every, self.p, strict=True)}


def _parameters(sites: Sequence[StrapSite]) -> tuple[ContactParameter, ...]:
    return (*FOOT_PARAMETERS, *(each for site in sites for each in site.parameters))


def read(o: StandingPredictOptions, record: Record) -> HeldOutTrials:
    """Everything the options name; InputError where trials are not of one model."""
    trials = standing_trials(o.study, "study", record, o.c3d_unit)
    known = standing_trials(o.against, "`against`", record, o.c3d_unit)
    for file, study in ((o.study, trials), (o.against, known)):
        if not study.exoskeleton or not {"force", "centre", "torque", "strap"} <= set(study.tracks):
            what = "is not of a person with an exoskeleton, with force, centre, torque and strap"
            raise InputError(file, "", what, "write exoskeleton = true, and name torques and strap of each trial")
    if trials.subject != known.subject:
        raise InputError(o.study, "mass", "is another person's than the calibration's", "predict trials of one person")
    lacking = {site.name for site in trials.sites} - {site.name for site in known.sites}
    if lacking:
        what = f"has a strap at the {min(lacking)}, which the calibration has not"
        raise InputError(o.study, "", what, f"leave strap_{min(lacking)} out, or calibrate with it")
    every = _parameters(known.sites)
    bounds = {each.name: (each.least, each.most) for each in every}
    values = read_contact_parameters(o.parameters, {each.name: each.unit for each in every}, bounds)
    record.add_input("`parameters`", o.parameters, parameters=len(values))
    return HeldOutTrials(trials, searched(every, [values[each.name] for each in every]), known)
