"""Held-out trials sought by every predictor with calibrated parameters: what is read, the searches, and tables."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.collector import add_input, listener, reserve, say
from geocontact.analyses.sit_to_stand.predict.options import StandingPredictOptions
from geocontact.analyses.sit_to_stand.recorded_beside import doubt_straps
from geocontact.analyses.sit_to_stand.standing_trials import refuse_stances, standing_trials
from geocontact.analyses.sit_to_stand.trial_tables import certificate_rows, mesh_table, not_certified
from geocontact.data.errors import InputError
from geocontact.dynamics.collocation.solve import SolverOptions, stopped_by_ctrl_c
from geocontact.io.recordings.spheres import read_contact_parameters
from geocontact.standing_up.calibrated_phase import INTERRUPTED
from geocontact.standing_up.exoskeleton import strapped
from geocontact.standing_up.phases import TRACKS_C, WITHIN
from geocontact.standing_up.prediction import ALL, GIVEN, PredictedTrial, contact_parameters, predicted_trial
from geocontact.standing_up.standing_model import StandingModel
from geocontact.standing_up.strap_sites import SPRINGS, searched
from geocontact.standing_up.trials import StandingTrial, StandingUpTrials

MEAN = "mean of the calibration"
STRAPS = "straps"
"""Stiffnesses of all straps together."""
TOLERANCE = 1e-7


@dataclass(frozen=True, eq=False)
class Predictor:
    """Phase C with something.

    Parameters
    ----------
    name
        As tables call it.
    tracks
        Channels that it is given.
    p
        What is searched of all parameters, which are held.
    """

    name: str
    tracks: tuple[str, ...]
    p: Float[np.ndarray, " p"]


@dataclass(frozen=True, eq=False)
class HeldOutTrials:
    """Trials to predict.

    Parameters
    ----------
    p
        What is searched of all parameters.
    known
        Trials of the calibration, which say where straps are.
    predictors
        Whatever predicts each of them.
    """

    trials: StandingUpTrials
    p: Float[np.ndarray, " p"]
    known: StandingUpTrials
    predictors: tuple[Predictor, ...]

    @property
    def values(self) -> dict[str, float]:
        """Values of all parameters by name, in SI."""
        every = contact_parameters(self.known.sites)
        return {each.name: each.value(float(p)) for each, p in zip(every, self.p, strict=True)}


def read(o: StandingPredictOptions) -> HeldOutTrials:
    """Everything the options name; InputError where trials are not of one model."""
    trials = standing_trials(o.study, "study", o.c3d_unit, o.axes, o.device)
    refuse_stances(trials, o.study)
    known = standing_trials(o.against, "`against`", o.c3d_unit, o.axes, o.device)
    for file, study in ((o.study, trials), (o.against, known)):
        if not study.exoskeleton or not {"force", "centre", "torque", "strap"} <= set(study.tracks):
            what = "is not of a person with an exoskeleton, with force, centre, torque and strap"
            raise InputError(file, "", what, "write exoskeleton = true, and name torques and strap of each trial")
    if trials.subject != known.subject:
        person = (trials.subject.mass, trials.subject.height) != (known.subject.mass, known.subject.height)
        what = "is another person's" if person else "and device are another exoskeleton's"
        what, remedy = f"{what} than the calibration's", "predict trials of one person with one exoskeleton"
        raise InputError(o.study, "mass" if person else "[masses], device", what, remedy)
    dashpots = [(of.sites[0].damping, of.sites[0].turning_damping) for of in (trials, known)]
    if dashpots[0] != dashpots[1]:
        raise InputError(o.study, "[straps]", "are damped otherwise than the calibration's", "write the same in both")
    lacking = {site.name for site in trials.sites} - {site.name for site in known.sites}
    if lacking:
        what = f"has a strap at the {min(lacking)}, which the calibration does not have"
        raise InputError(o.study, "", what, f"leave strap_{min(lacking)} out, or calibrate with it")
    warn_of_known(trials.trials, known.trials)
    every = contact_parameters(known.sites)
    bounds = {each.name: (each.least, each.most) for each in every}
    values = read_contact_parameters(o.parameters, {each.name: each.unit for each in every}, bounds)
    add_input("`parameters`", o.parameters, parameters=len(values))
    doubt_straps(o.study, trials, values)
    p = searched(every, [values[each.name] for each in every])
    predictors = [Predictor(name, tracks, p) for name, tracks in GIVEN.items()]
    if o.perturb:
        scaled = perturbed(values, o.perturb, [site.names for site in known.sites])
        name = ", ".join(f"{each} × {factor:g}" for each, factor in o.perturb.items())
        predictors.append(Predictor(name, TRACKS_C, searched(every, [scaled[each.name] for each in every])))
    return HeldOutTrials(trials, p, known, tuple(predictors))


def perturbed(
    values: Mapping[str, float], factors: Mapping[str, float], straps: Sequence[Sequence[str]]
) -> dict[str, float]:
    """Values of parameters times factors, as phase C2 of the study has those of the straps.

    Deviation from the print, which multiplies "the parameters": `STRAPS` are the stiffnesses of all straps; their
    places and their damping stay.

    Parameters
    ----------
    straps
        Names of each site's parameters, its `SPRINGS` first.
    """
    scaled = dict(values)
    for name, factor in factors.items():
        chosen = [each for site in straps for each in site[: len(SPRINGS)]] if name == STRAPS else [name]
        for each in chosen:
            if each not in values:
                names = ", ".join((STRAPS, *values))
                raise InputError("", "`perturb`", f"there is no parameter {each!r}", f"give one of {names}")
            scaled[each] *= factor
    return scaled


def warn_of_known(held_out: Sequence[StandingTrial], known: Sequence[StandingTrial]) -> None:
    """Trials of the calibration among those that are to be predicted: the same recording under any name.

    Or a single channel of one, as where a file of a calibration's trial was named.
    """
    for trial in held_out:
        for channel in ("strap", "torque", "force"):
            own = getattr(trial, channel)
            same = [one.name for one in known if own is not None and np.array_equal(getattr(one, channel), own)]
            if same and not any(np.array_equal(one.q, trial.q) for one in known):
                reserve(f"{trial.name}: its {channel} is that of {same[0]} in `against`; name its own file")
        same = [one.name for one in known if one.q.shape == trial.q.shape and np.array_equal(one.q, trial.q)]
        if same:
            reserve(
                f"{trial.name}: the same recording is {same[0]} in `against`: it is not held out, and errors of "
                "prediction and baselines are too small"
            )


def trials_begun(predictions: Sequence[PredictedTrial]) -> tuple[StandingTrial, ...]:
    """Recordings of the trials that are predicted, each once."""
    return tuple({one.trial.recorded.name: one.trial.recorded for one in predictions}.values())


Keep = Callable[[Sequence[PredictedTrial]], None]
"""Called with all predictions that there are, as soon as a trial is done."""


@dataclass
class _Asked:
    """Whether Ctrl-C was pressed, also between two searches."""

    stop: bool = False


def predicted(given: HeldOutTrials, o: StandingPredictOptions, keep: Keep) -> tuple[PredictedTrial, ...]:
    """Trials outer, predictors inner; searches without an answer and motions without a certificate are warned of.

    Ctrl-C ends the search that is going on, keeps its last iterate and begins no other.
    """
    model, predictions = (
        strapped(given.trials.subject, given.known.sites, seated=given.trials.seated),
        list[PredictedTrial](),
    )
    trials, asked = given.trials.trials, _Asked()
    with listener().stages("predicting") as stage, stopped_by_ctrl_c(asked):
        for k, trial in enumerate(trials, 1):
            for predictor in given.predictors:
                where = f"trial {k} of {len(trials)}, {trial.name} {predictor.name}"
                one = _predicted(model, given, trial, predictor, o, partial(_at, stage, where))
                predictions.append(one)
                asked.stop |= one.ending.startswith(INTERRUPTED)
                if asked.stop:
                    break
            if asked.stop:
                break
            keep(predictions)
    _doubt(predictions, given)
    return tuple(predictions)


def _at(stage: Callable[[str], None], where: str, told: str) -> None:
    stage(f"{where}, {told}")


def complete(predictions: Sequence[PredictedTrial], given: HeldOutTrials) -> bool:
    """Whether every trial is predicted by every predictor, and every motion is certified."""
    wanted = len(given.trials.trials) * len(given.predictors)
    return len(predictions) == wanted and all(one.certified for one in predictions)


def say_unplaced(given: HeldOutTrials) -> None:
    """Predictors whose place along the ground follows from nothing that they are given, and how far off it may be.

    The ground's forces do not change with it, and without a centre of pressure only the bounds of the first and the
    last posture hold it: the search may end anywhere between them.
    """
    names = ", ".join(one.name for one in given.predictors if "centre" not in one.tracks)
    off = f"foot_x and centre may be off by {WITHIN * given.trials.noise.length * 1e3:.2g} mm"
    if names:
        say(f"{names}: nothing given determines the place along the ground; {off}")


def shown_alike(predictions: Sequence[PredictedTrial]) -> list[PredictedTrial]:
    """Predictions that are given everything: by calibrated contacts, and by perturbed ones."""
    return [one for one in predictions if one.name == ALL or one.name not in GIVEN]


def _doubt(predictions: Sequence[PredictedTrial], given: HeldOutTrials) -> None:
    trials, each = len(given.trials.trials), len(given.predictors)
    for one in predictions:
        place = f"{one.trial.recorded.name} {one.name}"
        if not one.solved:
            reserve(f"{place} did not converge: {one.ending}; this is its last iterate")
        elif one.trial.judged.certificate is not None and not one.trial.judged.certificate.converged:
            reserve(not_certified(place, one.trial.judged.certificate))
    if len(predictions) < trials * each:
        last, ended = predictions[-1], [one for one in predictions if not one.ending.startswith(INTERRUPTED)]
        where = f"the last search was {last.trial.recorded.name} {last.name}"
        reserve(f"interrupted: {len(ended) // each} of {trials} trials have every predictor; {where}")


def _predicted(
    model: StandingModel,
    given: HeldOutTrials,
    trial: StandingTrial,
    predictor: Predictor,
    o: StandingPredictOptions,
    stage: Callable[[str], None],
) -> PredictedTrial:
    options = SolverOptions("radau", o.degree, 1, TOLERANCE, o.iterations, o.time_limit)

    def tell(iteration: int, objective: float, residual: float) -> None:
        stage(f"iteration {iteration}, objective {objective:.5g}, residual {residual:.2g}")

    known = predictor.name, model, given.trials.subject, trial, given.trials.noise, predictor.p
    tracks, weights = predictor.tracks, given.trials.weights
    return predicted_trial(*known, options, nodes=o.nodes, tracks=tracks, weights=weights, progress=tell)


def predicted_meshes(predictions: Sequence[PredictedTrial]) -> pd.DataFrame:
    """Ends of the intervals of every motion."""
    return mesh_table("predictor", [(one.name, [one.motion]) for one in predictions])


def certificates_table(predictions: Sequence[PredictedTrial]) -> pd.DataFrame:
    """What lies between and beyond the points of every motion."""
    rows = []
    for one in predictions:
        rows += certificate_rows(one.name, [one.trial.recorded.name], [one.trial.judged])
    return pd.DataFrame(rows).rename(columns={"phase": "predictor"})
