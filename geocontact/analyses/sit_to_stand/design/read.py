"""What a choice starts from: trials of a person, parameters of feet and strap, and how well these are known."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.stats import norm

from geocontact.analyses.run_record import Record
from geocontact.analyses.sit_to_stand.design.options import StandingDesignOptions
from geocontact.analyses.sit_to_stand.standing_trials import StandingUpTrials, standing_trials
from geocontact.data.errors import InputError
from geocontact.io.recordings.contact_parameters import read_contact_intervals, read_contact_parameters
from geocontact.standing_up.assistance.assisted_model import ASSISTANCE_PARAMETERS
from geocontact.standing_up.contact_parameter import searched, usual
from geocontact.standing_up.exoskeleton import WORN_PARAMETERS

LEVEL = 0.95
"""Probability of a calibration's intervals."""


@dataclass(frozen=True, eq=False)
class TrialsToHelp:
    """Trials whose movement is to be kept.

    Parameters
    ----------
    p
        What is searched of all parameters of the assisted model, help as it usually is.
    sd
        Standard deviations of those that the calibration has intervals of, 0 for the others.
    """

    trials: StandingUpTrials
    p: Float[np.ndarray, " p"]
    sd: Float[np.ndarray, " p"]


def read(o: StandingDesignOptions, record: Record) -> TrialsToHelp:
    """Everything the options name; InputError where no exoskeleton is worn or draws lack intervals."""
    trials = standing_trials(o.study, "study", record, o.c3d_unit)
    if not trials.exoskeleton:
        what, remedy = "is not of a person with an exoskeleton", "write exoskeleton = true, and torques and strap"
        raise InputError(o.study, "", what, remedy)
    if len(trials.sites) > 1:
        remedy = f"leave out {', '.join(f'strap_{site.name}' for site in trials.sites[1:])}"
        raise InputError(o.study, "", "a design has one strap, at the thigh", remedy)
    if trials.seated:
        remedy = "leave sitting out: a movement that is kept begins at seat-off"
        raise InputError(o.study, "sitting", "has no effect on a design", remedy)
    bounds = {each.name: (each.least, each.most) for each in WORN_PARAMETERS}
    values = read_contact_parameters(o.parameters, {each.name: each.unit for each in WORN_PARAMETERS}, bounds)
    ends = read_contact_intervals(o.parameters, values)
    record.add_input("`parameters`", o.parameters, parameters=len(values))
    if o.draws and not ends:
        remedy = "give parameters.csv of a calibration, or no draws"
        raise InputError(o.parameters, "lower, upper", "has no intervals to draw from", remedy)
    p = searched(WORN_PARAMETERS, [values[each.name] for each in WORN_PARAMETERS])
    reach = 2.0 * float(norm.ppf(0.5 + 0.5 * LEVEL))
    sd = np.zeros(len(p))
    for k, each in enumerate(WORN_PARAMETERS):
        if each.name in ends:
            low, high = (each.searched(end) for end in ends[each.name])
            sd[k] = (high - low) / reach
    return TrialsToHelp(trials, np.r_[p, usual(ASSISTANCE_PARAMETERS)], np.r_[sd, np.zeros(len(ASSISTANCE_PARAMETERS))])
