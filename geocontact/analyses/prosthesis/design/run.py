"""Sweep of one thing about the foot, its bands, and what is best for the person."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from jaxtyping import Float

from geocontact.analyses.json_file import plain
from geocontact.analyses.prosthesis.design.intact_side import OF_ONE_STEP, intact_words
from geocontact.analyses.prosthesis.design.options import ProsthesisDesignOptions
from geocontact.analyses.prosthesis.design.read import FootAndTrial
from geocontact.analyses.prosthesis.design.result import ProsthesisDesignResult
from geocontact.analyses.prosthesis.design.sweep import DIGITS, SHOWN, AimAnswer, Sweep, wanted_of
from geocontact.analyses.prosthesis.design.together import Together, pair_words
from geocontact.analyses.prosthesis.foot_law import offset_words
from geocontact.analyses.prosthesis.simulate.tables import leg_numbers, numbers_without_leg
from geocontact.analyses.run_record import Record
from geocontact.below_knee_prosthesis.design.choice import FootChoice, choose
from geocontact.below_knee_prosthesis.design.drawn import draws
from geocontact.below_knee_prosthesis.design.foot_task import FootTask
from geocontact.below_knee_prosthesis.design.knob import AIMS, Knob, Vary
from geocontact.below_knee_prosthesis.design.outcomes import MEASURES, Aim
from geocontact.below_knee_prosthesis.design.sensitivities import Unknown, sensitivities
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


def run(given: FootAndTrial, o: ProsthesisDesignOptions, record: Record) -> ProsthesisDesignResult:
    """Bands of every outcome over the values, the best value for every aim."""
    trial, terrain = given.trial, Terrain(o.slope, o.edge)
    knob = Knob(o.vary, VALUES[o.vary], trial.fulcrum, terrain)
    pitch = min(o.pitch_error, trial.offset.pitch_sd) if trial.offset.pitch_sd > 0.0 else o.pitch_error
    errors = TrialErrors(marker=o.marker_error, pitch=pitch, force=o.force_noise)
    try:
        task = trial.task()
        with record.listener.progress("feet", o.feet) as step:
            found = draws(
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
        hangs_on = sensitivities(given.foot, task, trial.fulcrum, terrain, unknown)
        maps = _ends(knob).maps(given.foot, task)
        shapes = _ends(knob).carried(maps, task)
        held = _ends(knob).other_feet(maps, task, tracking=0.0).moved().held
    except (ArithmeticError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        remedy = "check `mass`, the plate and how flat the foot stood"
        raise InputError(o.markers, "", str(error), remedy) from error
    sweep = Sweep(knob, found.drawn, found.free, o.level)
    near = {} if given.intact is None else given.intact.outcomes()
    answers = tuple(_answer(sweep, wanted_now(AIMS[k], o, task, near), AIMS[k] in near, k) for k in range(len(AIMS)))
    together = Together.of(knob.settings, ALIGNMENTS, found.beside, answers, o.level) if o.together else None
    result = ProsthesisDesignResult(
        record=record,
        options=o,
        sweep=sweep,
        answers=answers,
        ends=_ends(knob),
        shapes=shapes,
        task=task,
        held=tuple(held.tolist()),
        hangs_on=hangs_on,
        together=together,
        numbers=leg_numbers(trial.leg) | numbers_without_leg(given.foot, trial.fulcrum),
        intact=None if given.intact is None else near,
    )
    if found.lost:
        record.warn(f"{found.lost} of {o.feet} drawn feet found no equilibrium and are left out")
    record.warn(_words_of_torques(result))
    if given.intact is not None:
        record.warn(OF_ONE_STEP)
    record.warn("bands are of one trial: how a person differs from step to step is not in them")
    if o.vary != "alignment":
        record.warn(f"the best {o.vary} is sought with the recorded load; how the load changes is in the bands only")
    if terrain != LEVEL:
        record.warn(f"judged {words(terrain)}: the stance was recorded on a floor, its load and its turns are kept")
    _say(result)
    if trial.offset.given:
        record.say(offset_words(trial.offset))
    return result


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
    factor, unit = SHOWN[knob.vary]

    def shown(value: float) -> str:
        return f"{factor * value:.{DIGITS[knob.vary]}f}{unit and ' '}{unit}"

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
    factor, unit = SHOWN[knob.vary]
    far = [(value, time) for value, time in zip(knob.settings, r.held, strict=True) if time < lasting]
    held = ", ".join(
        f"{time:.2f} s at {factor * value:.{DIGITS[knob.vary]}f}{unit and ' '}{unit}" for value, time in far
    )
    alone = f"torques alone hold the leg for {held}, of {lasting:.2f} s" if far else "torques alone hold the leg here"
    return f"joint torques kept: a weak spring at hip and knee goes with them ({alone})"


def _beside_present(choice: FootChoice, unit: str, present: str) -> str:
    gains = ", ".join(
        f"{name} nearer by {median:.3g} ({lower:.3g} to {upper:.3g}) {unit}"
        for name, (median, lower, upper) in choice.gain.items()
    )
    words = "it is better than" if choice.better else "cannot tell whether it is better than"
    return f"{words} the present {present}: {gains}"
