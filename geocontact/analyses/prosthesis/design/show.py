"""What is shown of a choice: outcomes over what is varied with bands, answers, roll-over shapes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd

from geocontact.analyses.frame.pages import INPUTS, OPTIONS
from geocontact.analyses.frame.words import NOT_A_DEVICE, headline
from geocontact.analyses.prosthesis.design.sweep import DIGITS, SHOWN, UNITS, shown_values
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
        "Rate of loading: stiffness of the landing foot times its speed; the sole's damping, whose numbers are "
        "invented, is not in it."
    ),
]


def design_page(curves: CurveSheet, sweep: Sweep, tables: Mapping[str, pd.DataFrame], sentences: Sequence[str]) -> Page:
    """Outcomes, answers, what they hang on, numbers; `curves` are those of `design_curves`."""
    sections: list[Section] = [
        *curves.panels,
        frame_table("What is best, and whether the data identify it", tables["answers"], 3),
        *(frame_table(INTACT, tables["intact"], 3) for _ in range("intact" in tables)),
        *(frame_table(PAIRS, tables["pairs"], 3) for _ in range("pairs" in tables)),
        frame_table("Between which ends each outcome lies, whatever the person keeps", tables["ranges"], 3),
        frame_table("Sensitivities of the outcomes of the present foot", tables["sensitivities"], 3),
        frame_table("Numbers of leg and foot in SI, and where they are from", tables["numbers"]),
        INPUTS,
        OPTIONS,
        Words("What the numbers do and do not contain", [*LIMITS, NOT_A_DEVICE]),
    ]
    vary, where = sweep.knob.vary, words(sweep.knob.terrain)
    place = f"; {where}" if where else ""
    return Page(
        title=f"Which {vary} of the foot suits this person",
        subtitle=f"Recorded at the fulcrum of {1e3 * sweep.knob.fulcrum:.0f} mm; {len(sweep.drawn)} draws{place}",
        time=shown_values(sweep),
        time_label=f"{vary} [{UNITS[vary]}]",
        headline=headline(sentences, most=2),
        sections=tuple(sections),
        plays=False,
    )
