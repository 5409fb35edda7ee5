"""Sweep of one thing about the foot, its bands, and what is best for the person."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.analyses.json_file import plain
from geocontact.analyses.prosthesis.design.intact_side import OF_ONE_STEP, intact_words
from geocontact.analyses.prosthesis.design.options import ProsthesisDesignOptions
from geocontact.analyses.prosthesis.design.read import FootAndTrial
from geocontact.analyses.prosthesis.design.result import ProsthesisDesignResult
from geocontact.analyses.prosthesis.design.sweep import AimAnswer, Sweep, value_words, wanted_of
from geocontact.analyses.prosthesis.design.together import Together, pair_words
from geocontact.analyses.prosthesis.foot_law import offset_words
from geocontact.analyses.prosthesis.simulate.tables import leg_numbers, numbers_without_leg
from geocontact.analyses.run_record import Record
from geocontact.below_knee_prosthesis.design.carried_load import CarriedLoad
from geocontact.below_knee_prosthesis.design.choice import FootChoice, choose
from geocontact.below_knee_prosthesis.design.drawn import Draws, draws
from geocontact.below_knee_prosthesis.design.foot_task import FootTask
from geocontact.below_knee_prosthesis.design.knob import AIMS, Knob, Response, Vary
from geocontact.below_knee_prosthesis.design.outcomes import MEASURES, Aim
from geocontact.below_knee_prosthesis.design.sensitivities import FootSensitivity, Unknown, sensitivities
from geocontact.below_knee_prosthesis.design.stance_again import TrialErrors, task_again
from geocontact.below_knee_prosthesis.design.terrain import LEVEL, Terrain, words
from geocontact.data.errors import InputError

VALUES: dict[Vary, Float[np.ndarray, " n"]] = {
    "fulcrum": np.linspace(0.066, 0.151, 9),
    "alignment": np.radians(np.linspace(-6.0, 6.0, 9)),
    "stiffness": np.linspace(0.6, 1.6, 9),
}
ALIGNMENTS = np.radians([-6.0, -3.0, 0.0, 3.0, 6.0])
"""That go together with every value."""


@dataclass(frozen=True, eq=False)
class VariedFoot:
    """A foot varied along a trial.

    Parameters
    ----------
    task
        What the foot carries.
    drawn
        Outcomes over the values, with what is not known drawn.
    ends, shapes
        First, present and last value, and the foot along the stance at each, with the numbers as they are.
    held
        How long joint torques alone hold the leg at each of the ends [s].
    hangs_on
        How far outcomes on the present foot hang on each number.
    """

    task: FootTask
    drawn: Draws
    ends: Knob
    shapes: Mapping[Response, tuple[CarriedLoad, ...]]
    held: tuple[float, ...]
    hangs_on: tuple[FootSensitivity, ...]


def varied_foot(given: FootAndTrial, knob: Knob, o: ProsthesisDesignOptions, record: Record) -> VariedFoot:
    """Draws over the values, and both ends beside the present one; InputError where the foot finds no equilibrium."""
    trial, ends = given.trial, _ends(knob)
    pitch = min(o.pitch_error, trial.offset.pitch_sd) if trial.offset.pitch_sd > 0.0 else o.pitch_error
    errors = TrialErrors(marker=o.marker_error, pitch=pitch, force=o.force_noise)
    try:
        task = trial.task()
        with record.listener.progress("feet", o.feet) as step:
            drawn = draws(
                knob,
                given.foot,
                task,
                lambda rng: task_again(trial, errors, rng),
                given.sd,
                feet=o.feet,
                walks=o.walks,
                seed=o.seed,
                step=step,
                alignments=ALIGNMENTS.tolist() if o.together else (),
            )
        unknown = Unknown(given.sd, errors.pitch, errors.gain)
        hangs_on = sensitivities(given.foot, task, trial.fulcrum, knob.terrain, unknown)
        maps = ends.maps(given.foot, task)
        shapes = ends.carried(maps, task)
        held = ends.other_feet(maps, task, tracking=0.0).moved().held
    except (ArithmeticError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        remedy = "check `mass`, the plate and how flat the foot stood"
        raise InputError(o.markers, "", str(error), remedy) from error
    return VariedFoot(task, drawn, ends, shapes, tuple(held.tolist()), hangs_on)


def run(given: FootAndTrial, o: ProsthesisDesignOptions, record: Record) -> ProsthesisDesignResult:
    """Bands of every outcome over the values, the best value for every aim."""
    trial = given.trial
    knob = Knob(o.vary, VALUES[o.vary], trial.fulcrum, Terrain(o.slope, o.edge))
    varied = varied_foot(given, knob, o, record)
    sweep = Sweep(knob, varied.drawn.drawn, varied.drawn.free, o.level)
    near = {} if given.intact is None else given.intact.outcomes()
    answers = tuple(
        _answer(sweep, wanted_now(AIMS[k], o, varied.task, near), AIMS[k] in near, k) for k in range(len(AIMS))
    )
    beside = varied.drawn.beside
    result = ProsthesisDesignResult(
        record=record,
        options=o,
        sweep=sweep,
        answers=answers,
        ends=varied.ends,
        shapes=varied.shapes,
        task=varied.task,
        held=varied.held,
        hangs_on=varied.hangs_on,
        together=Together.of(knob.settings, ALIGNMENTS, beside, answers, o.level) if o.together else None,
        numbers=leg_numbers(trial.leg) | numbers_without_leg(given.foot, trial.fulcrum),
        intact=None if given.intact is None else near,
    )
    _reserve(result, varied.drawn.lost)
    _say(result)
    if trial.offset.given:
        record.say(offset_words(trial.offset))
    return result


def _reserve(r: ProsthesisDesignResult, lost: int) -> None:
    """What is to be doubted; `lost` draws have no equilibrium."""
    record, knob = r.record, r.sweep.knob
    if lost:
        record.warn(f"{lost} of {r.options.feet} drawn feet found no equilibrium and are left out")
    record.warn(_words_of_torques(r))
    if r.intact is not None:
        record.warn(OF_ONE_STEP)
    record.warn("bands are of one trial: how a person differs from step to step is not in them")
    if knob.vary != "alignment":
        record.warn(f"the best {knob.vary} is sought with the recorded load; how the load changes is in the bands only")
    if knob.terrain != LEVEL:
        where = words(knob.terrain)
        record.warn(f"judged {where}: the stance was recorded on a floor, its load and its turns are kept")


def _ends(knob: Knob) -> Knob:
    """The first value, the present one and the last, in order."""
    return Knob(knob.vary, np.unique([knob.settings[0], knob.present, knob.settings[-1]]), knob.fulcrum, knob.terrain)


def wanted_now(aim: Aim, o: ProsthesisDesignOptions, task: FootTask, near: Mapping[Aim, float]) -> float | None:
    """Value of an aim that is wanted: a given one, else what the intact side has, else the usual one."""
    if aim == o.aim and o.target is not None:
        return o.target
    return near.get(aim, wanted_of(aim, task))


def _answer(sweep: Sweep, target: float | None, of_intact: bool, k: int) -> AimAnswer:
    knob, measure = sweep.knob, MEASURES[AIMS[k]]
    choice = choose(knob.settings, sweep.drawn[..., k], measure.sense, target, knob.present, sweep.level)
    return AimAnswer(AIMS[k], target, choice, of_intact)


def _say(r: ProsthesisDesignResult) -> None:
    record, knob = r.record, r.sweep.knob

    def shown(value: float) -> str:
        return value_words(knob.vary, value)

    chosen = next(each for each in r.answers if each.aim == r.options.aim)
    measure, choice = MEASURES[chosen.aim], chosen.choice
    place = words(knob.terrain)
    what = f"{f'{place}, ' if place else ''}{measure.words}, {chosen.wanted}"
    if not choice.told:
        record.say(f"{what}: cannot tell which {knob.vary} is best: {choice.why}")
    else:
        record.say(
            f"{what}: {knob.vary} {shown(choice.best)} ({shown(choice.lower)} to {shown(choice.upper)}) is best, "
            f"{choice.why}"
        )
        record.say(_beside_present(choice, measure.unit, shown(knob.present)))
        other = choice.sides["joint torques kept"]
        own = f"{shown(other.best)} ({shown(other.lower)} to {shown(other.upper)})"
        record.say(f"with the torques of hip and knee kept: {own if other.verdict == 'told' else other.verdict}")
    if r.intact is not None:
        record.say(intact_words(r.intact))
        record.results["intact"] = plain(dict(r.intact))
    if r.together is not None:
        record.say(pair_words(knob.vary, chosen, r.together))
    for response, rows in r.sweep.differences().items():
        record.say(f"{response}, {shown(knob.settings[-1])} in place of {shown(knob.settings[0])}: {'; '.join(rows)}")
    ends = r.sweep.ends
    record.results["design_values"] = plain(r.sweep.shown.tolist())
    record.results["torques_alone_hold_s"] = plain(r.held)
    record.results["design"] = plain(
        {
            each.aim: {
                "told": each.choice.told,
                "best": each.choice.best,
                "lower": each.choice.lower,
                "upper": each.choice.upper,
                "better_than_present": each.choice.better,
                "least": ends[0, :, k].tolist(),
                "most": ends[1, :, k].tolist(),
            }
            for k, each in enumerate(r.answers)
        }
    )


def _words_of_torques(r: ProsthesisDesignResult) -> str:
    knob, lasting = r.ends, r.task.time[-1] - r.task.time[0]
    far = [(value, time) for value, time in zip(knob.settings, r.held, strict=True) if time < lasting]
    held = ", ".join(f"{time:.2f} s at {value_words(knob.vary, value)}" for value, time in far)
    alone = f"torques alone hold the leg for {held}, of {lasting:.2f} s" if far else "torques alone hold the leg here"
    return f"joint torques kept: a weak spring at hip and knee goes with them ({alone})"


def _beside_present(choice: FootChoice, unit: str, present: str) -> str:
    gains = ", ".join(
        f"{name} nearer by {median:.3g} ({lower:.3g} to {upper:.3g}) {unit}"
        for name, (median, lower, upper) in choice.gain.items()
    )
    words = "it is better than" if choice.better else "cannot tell whether it is better than"
    return f"{words} the present {present}: {gains}"
