"""Which foot for whom: `geocontact prosthesis design`, `gc.prosthesis.design`.

>>> import geocontact as gc
>>> trial = "meshes/gait_P1_medium_1/"
>>> given = {"static": trial + "standing.trc", "mass": 77.3, "plates": trial + "plates.mot", "plate": "own_force"}
>>> result = gc.prosthesis.design(trial + "walking.trc", feet=6, walks=1, **given)
>>> print(result.sentences[0])
radius of the roll-over shape, nearest to … m: …
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np
import pandas as pd

from geocontact.analyses.frame.collector import contradicted, judge, note, reserve, say
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.json_file import plain
from geocontact.analyses.frame.result import REPORT, Result
from geocontact.analyses.prosthesis.design.goodness import goodness_of
from geocontact.analyses.prosthesis.design.options import ProsthesisDesignOptions
from geocontact.analyses.prosthesis.design.show import design_curves, design_page, stance_share
from geocontact.analyses.prosthesis.design.sweep import (
    OF_ONE_STEP,
    SHOWN,
    UNITS,
    answers_table,
    difference_words,
    intact_table,
    intact_words,
    pair_words,
    pairs_table,
    ranges_table,
    sensitivities_table,
    shown_values,
    sweep_table,
    together_table,
    value_words,
)
from geocontact.analyses.prosthesis.design.trial import FootAndTrial, read, varied
from geocontact.analyses.prosthesis.stance_files import numbers_table, offset_words
from geocontact.below_knee_prosthesis.design.aims import Aim
from geocontact.below_knee_prosthesis.design.choice import FootChoice
from geocontact.below_knee_prosthesis.design.drawn import without_map_error
from geocontact.below_knee_prosthesis.design.foot_map import CarriedLoad
from geocontact.below_knee_prosthesis.design.foot_task import LEVEL, FootTask, Terrain, words
from geocontact.below_knee_prosthesis.design.knob import RESPONSES, Knob, Response
from geocontact.below_knee_prosthesis.design.outcomes import MEASURES, shank_path
from geocontact.below_knee_prosthesis.design.sensitivities import FootSensitivity
from geocontact.below_knee_prosthesis.design.sweep import AimAnswer, Sweep, Together
from geocontact.below_knee_prosthesis.design.varied import ALIGNMENTS, values_of
from geocontact.below_knee_prosthesis.foot_numbers import leg_numbers, numbers_without_leg
from geocontact.data.parameter import Number

if TYPE_CHECKING:
    from geocontact.view.curves.declared import CurveSheet
    from geocontact.view.page.content import Page


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class ProsthesisDesignResult(Result):
    """A foot varied for one person.

    Parameters
    ----------
    answers
        By aim.
    ends, shapes
        First, present and last value, and the foot along the stance at each, with the numbers as they are.
    task
        What the foot carries.
    held
        How long joint torques alone hold the leg at each of the ends [s].
    hangs_on
        How far outcomes on the present foot hang on each number.
    together
        Alignment varied together with the value; None where it was not asked for.
    numbers
        Of leg and foot as the trial is read with.
    intact
        Outcomes that the intact foot has, in SI; None where its step is not given.
    """

    options: ProsthesisDesignOptions
    sweep: Sweep
    answers: tuple[AimAnswer, ...]
    ends: Knob
    shapes: Mapping[Response, tuple[CarriedLoad, ...]]
    task: FootTask
    held: tuple[float, ...]
    hangs_on: tuple[FootSensitivity, ...]
    together: Together | None = None
    numbers: Mapping[str, Number]
    intact: Mapping[Aim, float] | None = None

    claims: ClassVar[frozenset[str]] = frozenset(
        {"identified", "better than present", "better than alone", "why", *(f"{each}: gain" for each in RESPONSES)}
        | {f"best {vary} [{UNITS[vary]}]{alone}" for vary in UNITS for alone in ("", " alone")}
    )

    @property
    def present(self) -> CarriedLoad | None:
        """The present foot along the recorded stance, angles kept; None on another ground than was recorded."""
        at = np.isclose(self.ends.settings, self.ends.present)
        if self.sweep.knob.terrain != LEVEL or not at.any():
            return None
        return self.shapes["angles kept"][int(np.argmax(at))]

    @property
    def best(self) -> dict[str, float]:
        """Best value of what is varied, by aim: fulcrum [m], alignment [rad], stiffness [-].

        NaN, as its interval, where the present foot is not the one that was recorded.
        """
        return {each.aim: each.choice.best if self.fits else math.nan for each in self.answers}

    @property
    def interval(self) -> dict[str, tuple[float, float]]:
        """Interval of the same at `level` [m, rad, -]."""
        none = (math.nan, math.nan)
        return {each.aim: (each.choice.lower, each.choice.upper) if self.fits else none for each in self.answers}

    def tables(self) -> dict[str, pd.DataFrame]:
        """`answers`, `ranges`, `sensitivities`, `sweep`, `shapes`, `numbers`; `intact`; `pairs` and `together`."""
        vary = self.sweep.knob.vary
        tables = {
            "answers": answers_table(self.answers, vary),
            "ranges": ranges_table(self.sweep),
            "sensitivities": sensitivities_table(self.hangs_on),
            "sweep": sweep_table(self.sweep),
            "shapes": self._shapes(),
            "numbers": numbers_table(self.numbers),
        }
        if self.intact is not None:
            tables["intact"] = intact_table(self.intact)
        if self.together is not None:
            tables["pairs"] = pairs_table(self.together, vary, self.answers)
            tables["together"] = together_table(self.together, vary)
        return tables

    def curves(self) -> dict[str, CurveSheet]:
        """`design`: outcomes with bands, roll-over shapes."""
        return {"design": design_curves(self.sweep, self.answers, self.ends, self.shapes)}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """Outcomes, answers, what they hang on, numbers."""
        drawn, aim = self.curves()["design"], self.options.aim
        return {REPORT: design_page(drawn, self.sweep, self.answers, aim, self.tables(), self.sentences)}

    def _shapes(self) -> pd.DataFrame:
        vary = self.ends.vary
        frames = []
        for response, carried in self.shapes.items():
            for value, found in zip(self.ends.settings, carried, strict=True):
                forward, up = shank_path(found).T
                columns = {
                    f"{vary} [{UNITS[vary]}]": SHOWN[vary][0] * float(value),
                    "response": response,
                    "stance [-]": stance_share(found),
                    "forward of ankle [mm]": 1e3 * forward,
                    "above ankle [mm]": 1e3 * up,
                    "ankle moment [N m]": found.ankle_moment,
                    "stored [J]": found.stored,
                    "turned [deg]": found.tilt * SHOWN["alignment"][0],
                }
                frames.append(pd.DataFrame(columns))
        return pd.concat(frames, ignore_index=True)


def run(given: FootAndTrial, o: ProsthesisDesignOptions) -> ProsthesisDesignResult:
    """Bands of every outcome over the values, the best value for every aim."""
    trial = given.trial
    knob = Knob(o.vary, values_of(o.vary, given.foot.keel), trial.fulcrum, Terrain(o.slope, o.edge))
    found = varied(given, knob, o)
    sweep = Sweep(knob, found.drawn.drawn, found.drawn.free, o.level)
    near = {} if given.intact is None else given.intact.outcomes()
    answers = sweep.answers(found.task, {} if o.target is None else {o.aim: o.target}, near)
    beside = found.drawn.beside
    result = ProsthesisDesignResult(
        options=o,
        sweep=sweep,
        answers=answers,
        ends=found.ends,
        shapes=found.shapes,
        task=found.task,
        held=found.held,
        hangs_on=found.hangs_on,
        together=Together.of(knob.settings, ALIGNMENTS, beside, answers, o.level) if o.together else None,
        numbers=leg_numbers(trial.leg) | numbers_without_leg(given.foot, trial.fulcrum),
        intact=None if given.intact is None else near,
    )
    judge(goodness_of(given.stance, result.present, found.drawn.lost, o))
    _reserve(result)
    _summarise(result)
    if trial.offset.given:
        say(offset_words(trial.offset))
    return result


def _reserve(r: ProsthesisDesignResult) -> None:
    """Reservations."""
    knob = r.sweep.knob
    reserve(_words_of_torques(r))
    if r.intact is not None:
        reserve(OF_ONE_STEP)
    if without_map_error(r.options.aim):
        reserve(f"the map's error in {MEASURES[r.options.aim].words} was not measured: its bands include none")
    reserve("bands are for one trial: they do not include the variation from step to step")
    if knob.vary != "alignment" and r.fits:
        reserve(f"the best {knob.vary} is computed with the recorded load; only the bands include how the load changes")
    if knob.terrain != LEVEL:
        where = words(knob.terrain)
        reserve(f"evaluated {where}: the stance was recorded on a floor, its load and its rotations are used unchanged")


def _summarise(r: ProsthesisDesignResult) -> None:
    """Sentences and results of a choice."""
    knob = r.sweep.knob

    def shown(value: float) -> str:
        return value_words(knob.vary, value)

    chosen = next(each for each in r.answers if each.aim == r.options.aim)
    measure, choice = MEASURES[chosen.aim], chosen.choice
    place = words(knob.terrain)
    what = f"{f'{place}, ' if place else ''}{measure.words}, {chosen.wanted}"
    if contradicted():
        _note(r)
        return
    if not choice.told:
        say(f"{what}: the best {knob.vary} is not identified: {choice.why}")
    else:
        say(
            f"{what}: {knob.vary} {shown(choice.best)} ({shown(choice.lower)} to {shown(choice.upper)}) is best, "
            f"{choice.why}"
        )
        say(_beside_present(choice, measure.unit, shown(knob.present)))
        other = choice.sides["joint torques kept"]
        own = f"{shown(other.best)} ({shown(other.lower)} to {shown(other.upper)})"
        say(f"with the torques of hip and knee unchanged: {own if other.verdict == 'identified' else other.verdict}")
    if r.intact is not None:
        say(intact_words(r.intact))
        note("intact", plain(dict(r.intact)))
    if r.together is not None:
        say(pair_words(knob.vary, chosen, r.together))
    for response, line in difference_words(r.sweep, chosen.aim).items():
        say(f"{response}, {shown(knob.settings[-1])} in place of {shown(knob.settings[0])}: {line}")
    _note(r)


def _note(r: ProsthesisDesignResult) -> None:
    """Figures for run.json; no answer where the present foot is not the one that was recorded."""
    ends = r.sweep.ends
    note("design_values", plain(shown_values(r.sweep).tolist()))
    note("torques_alone_hold_s", plain(r.held))
    note(
        "design",
        plain(
            {
                each.aim: {
                    "identified": each.choice.told and r.fits,
                    "best": r.best[each.aim],
                    "lower": each.choice.lower,
                    "upper": each.choice.upper,
                    "better_than_present": each.choice.better and r.fits,
                    "least": ends[0, :, k].tolist(),
                    "most": ends[1, :, k].tolist(),
                }
                for k, each in enumerate(r.answers)
            }
        ),
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
    words = "it is better than" if choice.better else "not shown to be better than"
    return f"{words} the present {present}: {gains}"


design = Job("prosthesis design", ProsthesisDesignOptions, read, run)
