"""What is shown of a choice: outcomes over what is varied with bands, answers, roll-over shapes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd

from geocontact.analyses.frame.collector import contradicted
from geocontact.analyses.frame.pages import INPUTS, OPTIONS
from geocontact.analyses.frame.words import NOT_A_DEVICE, headline
from geocontact.analyses.prosthesis.design.sweep import DIGITS, SHOWN, UNITS, shown_values, value_words
from geocontact.analyses.prosthesis.number_units import with_units
from geocontact.below_knee_prosthesis.design.foot_map import CarriedLoad
from geocontact.below_knee_prosthesis.design.foot_task import words
from geocontact.below_knee_prosthesis.design.knob import AIMS, RESPONSES, Knob, Response
from geocontact.below_knee_prosthesis.design.outcomes import MEASURES, shank_path
from geocontact.below_knee_prosthesis.design.sweep import AimAnswer, Sweep
from geocontact.data.motion import Course
from geocontact.view.curves.declared import Curve, Curves, CurveSheet, Points, Shade, stroke
from geocontact.view.page.content import Page, Section, Words
from geocontact.view.page.tables import frame_table

STROKES = (stroke(0), stroke(1, 1), stroke(3, 3))
"""Blue, orange and pink, of the responses; green is left to what is best."""
SHAPE = "Roll-over shape in the shank, above the ankle"


def design_curves(
    sweep: Sweep,
    answers: Sequence[AimAnswer],
    ends: Knob,
    shapes: Mapping[Response, tuple[CarriedLoad, ...]],
) -> CurveSheet:
    """Outcomes over what is varied with bands, the present value, the interval of the best; roll-over shapes."""
    vary, factor, bands = sweep.knob.vary, SHOWN[sweep.knob.vary][0], sweep.bands
    present = Shade("present value", factor * sweep.knob.present, factor * sweep.knob.present)
    panels = []
    for k, answer in enumerate(answers):
        curves = [
            Curve(response, bands[0, j, :, k], bands[1, j, :, k], bands[2, j, :, k], STROKES[j])
            for j, response in enumerate(RESPONSES)
        ]
        best = answer.choice
        spans = [Shade("interval of the best", factor * best.lower, factor * best.upper)] if best.told else []
        measure = MEASURES[AIMS[k]]
        title = f"{measure.words[:1].upper()}{measure.words[1:]}"
        panels.append(Curves(title, measure.unit, curves, spans=[*spans, present], words="" if k else FIGURE))
    return CurveSheet([*panels, _shapes(ends, shapes["angles kept"])], Course(vary, UNITS[vary], shown_values(sweep)))


def _shapes(ends: Knob, carried: Sequence[CarriedLoad]) -> Curves:
    factor, unit = SHOWN[ends.vary]
    paths = [1e3 * shank_path(found) for found in carried]
    lines = [
        Points(
            f"{factor * value:.{DIGITS[ends.vary]}f} {unit}".strip(), path[:, 0], path[:, 1], stroke(4, k), joined=True
        )
        for k, (value, path) in enumerate(zip(ends.settings, paths, strict=True))
    ]
    x = np.concatenate([path[:, 0] for path in paths])
    reach = np.array([np.nanmin(x), np.nanmax(x)])
    return Curves(SHAPE, "mm", [], points=lines, over=Course("forward of the ankle", "mm", reach))


def stance_share(found: CarriedLoad) -> np.ndarray:
    """Share of the loaded stance, 0 to 1."""
    time = found.task.time
    return np.asarray((time - time[0]) / (time[-1] - time[0]))


FIGURE = "Medians and bands over the draws, by what the person keeps."
ANSWERS = "What is best, and whether the data identify it"
PAIRS = "The foot turned on the socket as well: what the best pair gains over the best value alone"
INTACT = "What a step of the intact foot has, which is aimed at"
LIMITS = [
    (
        "What a person does on another foot is not known. With angles kept the socket turns as recorded; with torque "
        "kept the foot turns until the ankle has the moment of the recorded foot; in both the load over time is the "
        "recorded one; inertia is neglected. With joint torques kept, hip and knee have those of the recorded "
        "foot, and leg and load follow by forward dynamics. Real behaviour is assumed to lie between these."
    ),
    (
        "Joint torques alone do not hold a leg on another foot: a spring of 2 N m/rad per kg of body mass and a damper "
        "at hip and knee, invented numbers, hold it near the recorded angles."
    ),
    (
        "Bands include the uncertainty of the sole, rounding of the keel's compressions, the count of spheres in the "
        "model, errors of markers and plate. They omit the variation from step to step."
    ),
    "A value is identified where its interval is narrower than 60 % of the range in every response that it matters in.",
    (
        "Moments of knee and hip: inverse dynamics in the sagittal plane. The metabolic proxy is the work of both "
        "over the stance, positive over 0.25, negative over 1.2 (Margaria 1968): no measurement, and nothing of the "
        "other leg. The map's error in these three was not measured and is not in the bands."
    ),
    (
        "Rate of loading: stiffness of the landing foot times its speed; the sole's damping, whose numbers are "
        "invented, is not in it."
    ),
]


def best_words(answer: AimAnswer, sweep: Sweep) -> str:
    """The best value for one aim with its interval, and whether that is an end of what can be set."""
    vary, choice = sweep.knob.vary, answer.choice
    if not choice.told:
        return "no effect" if _without_effect(answer) else "not identified"
    ends = sweep.knob.settings[[0, -1]]
    at_end = ", the end of the range" if np.isclose(choice.best, ends).any() else ""
    best, upper = (value_words(vary, each) for each in (choice.best, choice.upper))
    lower = f"{SHOWN[vary][0] * choice.lower:.{DIGITS[vary]}f}"
    return f"{best} ({lower} to {upper}{at_end})"


def _without_effect(answer: AimAnswer) -> bool:
    return all(side.verdict == "no effect" for side in answer.choice.sides.values())


def others_words(answers: Sequence[AimAnswer], aim: str, sweep: Sweep) -> list[str]:
    """The best values for the aims that were not asked for, as far as they are identified."""
    found = [
        f"{MEASURES[each.aim].words.partition(',')[0]}, {each.wanted}: {best_words(each, sweep)}"
        for each in answers
        if each.aim != aim and each.choice.told
    ]
    return [f"Identified for other aims: {'; '.join(found)}."] if found else ["No other aim has a best value either."]


def answers_in_words(answers: Sequence[AimAnswer], sweep: Sweep) -> pd.DataFrame:
    """One row for each aim, as the page shows it; answers.csv has the gains by response."""
    present = value_words(sweep.knob.vary, sweep.knob.present)
    rows = []
    for each in answers:
        choice = each.choice
        better = ("yes" if choice.better else "not shown") if choice.told else ""
        row = {"outcome": MEASURES[each.aim].words, "wanted": each.wanted}
        row |= {f"best {sweep.knob.vary}": best_words(each, sweep), f"better than {present}": better, "why": choice.why}
        rows.append(row | {response: side.verdict for response, side in choice.sides.items()})
    return pd.DataFrame(rows)


def _outcomes_in_words(table: pd.DataFrame) -> pd.DataFrame:
    names = {aim: measure.words.partition(",")[0] for aim, measure in MEASURES.items()}
    return table.assign(outcome=[names.get(each, each) for each in table["outcome"]])


def design_page(
    curves: CurveSheet,
    sweep: Sweep,
    answers: Sequence[AimAnswer],
    aim: str,
    tables: Mapping[str, pd.DataFrame],
    sentences: Sequence[str],
) -> Page:
    """Outcomes, answers, what they hang on, numbers.

    Parameters
    ----------
    curves
        Those of `design_curves`; outcomes without any effect are left out.
    aim
        What was asked for.
    """
    vary, where = sweep.knob.vary, words(sweep.knob.terrain)
    flat = [each for each in answers if _without_effect(each)]
    idle = [f"There is no curve of the {MEASURES[each.aim].words}: the {vary} has no effect on it." for each in flat]
    panels = [panel for panel, each in zip(curves.panels, [*answers, None], strict=True) if each not in flat]
    paired = "pairs" in tables and not contradicted()
    told = next(each for each in answers if each.aim == aim).choice.told
    sections: list[Section] = [
        *panels,
        *([] if contradicted() else [frame_table(ANSWERS, answers_in_words(answers, sweep), 3)]),
        *(frame_table(INTACT, _outcomes_in_words(tables["intact"]), 3) for _ in range("intact" in tables)),
        *(frame_table(PAIRS, _outcomes_in_words(tables["pairs"]), 3) for _ in range(paired)),
        frame_table(
            "Between which ends each outcome lies, whatever the person keeps", _outcomes_in_words(tables["ranges"]), 3
        ),
        frame_table(
            "Sensitivities of the outcomes of the present foot", _outcomes_in_words(tables["sensitivities"]), 3
        ),
        frame_table("Numbers of leg and foot in SI, and where they are from", with_units(tables["numbers"])),
        INPUTS,
        OPTIONS,
        Words("What the numbers do and do not contain", [*LIMITS, *idle, NOT_A_DEVICE]),
    ]
    place = f"; {where}" if where else ""
    return Page(
        title=f"Which {vary} of the foot suits this person",
        subtitle=f"Recorded at the fulcrum of {1e3 * sweep.knob.fulcrum:.0f} mm; {len(sweep.drawn)} draws{place}",
        time=shown_values(sweep),
        time_label=f"{vary} [{UNITS[vary]}]",
        headline=[]
        if contradicted()
        else [*headline(sentences, most=2 if told else 1), *others_words(answers, aim, sweep)],
        facts=[
            (f"{MEASURES[each.aim].words.partition(',')[0]}, {each.wanted}", best_words(each, sweep))
            for each in (() if contradicted() else answers)
        ],
        sections=tuple(sections),
        start_frame=int(np.argmin(np.abs(sweep.knob.settings - sweep.knob.present))),
        plays=False,
    )
