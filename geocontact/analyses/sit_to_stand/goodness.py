"""Whether trials that are predicted, and movements that a design rests on, agree with what was recorded.

A channel that the model is given is compared with its stated noise. One that is predicted has the errors of the model
as well: it contradicts the recording where the recording's own mean would describe it better, far beyond the noise.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from geocontact.analyses.sit_to_stand.trial_tables import SHEAR, StandingChannel, channels
from geocontact.identify.goodness_of_fit import FAR, Doubt, GoodnessOfFit, of_r2, of_residual, residual_test
from geocontact.standing_up.chain import COORDINATES
from geocontact.standing_up.prediction import ALL, GIVEN, PredictedTrial
from geocontact.standing_up.trial_result import TrialResult
from geocontact.standing_up.trials import StandingNoise

CONSTANT = 0.1
"""Times the noise: a recording that varies by less has none, and is no recording."""
PREDICTED = ("coordinates", "strap", SHEAR)
SIMULATED = ("force", "centre")


def goodness_of_predictions(predictions: Sequence[PredictedTrial], noise: StandingNoise) -> GoodnessOfFit:
    """The predictor that is given most is tested; those that are given less stand beside it to be compared."""
    return _goodness([one.trial for one in predictions if one.name == ALL], noise, GIVEN[ALL], PREDICTED)


def goodness_of_movement(trials: Sequence[TrialResult], noise: StandingNoise) -> GoodnessOfFit:
    """The movement without help is tested: the person's own coordinates are to be those of the recording.

    The exoskeleton that was worn there may be another one: the ground's force and its centre need not be the same.
    """
    return _goodness(trials, noise, COORDINATES, SIMULATED)


def _goodness(
    trials: Sequence[TrialResult], noise: StandingNoise, given: Sequence[str], predicted: Sequence[str]
) -> GoodnessOfFit:
    doubts: list[Doubt] = []
    tested = []
    for trial in trials:
        for each in channels(trial.recorded, trial.model, noise):
            if each.channel == "rates" or not np.isfinite(each.recorded).all():
                continue
            name = f"{trial.recorded.name} {each.name}"
            if each.channel in given or each.name in given:
                residual = each.factor * (each.recorded - each.model)
                doubts += of_residual(name, each.unit, residual, each.factor * each.noise)
            elif each.channel in predicted:
                doubts += _of_predicted(name, each)
            else:
                continue
            tested.append(name)
    return GoodnessOfFit(tuple(doubts), tuple(tested))


def _of_predicted(name: str, each: StandingChannel) -> Iterable[Doubt]:
    residual = each.recorded - each.model
    spread = float(np.mean((each.recorded - each.recorded.mean()) ** 2))
    if residual_test(residual, each.noise).ratio <= FAR:
        return
    if spread <= (CONSTANT * each.noise) ** 2:
        yield Doubt(f"{name}: the recording has one value throughout: was its sensor off?", True)
    else:
        yield from of_r2(name, 1.0 - float(np.mean(residual**2)) / spread)
