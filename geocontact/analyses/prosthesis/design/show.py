"""What is shown of a choice: outcomes over what is varied with bands, answers, roll-over shapes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

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
from geocontact.view.curves.style import DOUBLE, GREY, LINES, PALETTE, in_style, panels
from geocontact.view.page.content import Curve, Curves, Page, Picture, Section, Words
from geocontact.view.page.tables import frame_table

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

HEIGHT = 0.1
"""Height of the drawing [m]."""
HUES = (PALETTE[0], PALETTE[1], PALETTE[3])
"""Blue, orange and pink, of the responses."""


@in_style
def design_figure(
    sweep: Sweep,
    answers: Sequence[AimAnswer],
    ends: Knob,
    shapes: Mapping[Response, tuple[CarriedLoad, ...]],
) -> Figure:
    """One colour for each response of the person; grey the present value, green the interval of the best."""
    figure, axes = panels(2, 3, DOUBLE, HEIGHT)
    factor, bands = SHOWN[sweep.knob.vary][0], sweep.bands
    for k, answer in enumerate(answers):
        panel, measure = axes[k], MEASURES[AIMS[k]]
        for j, response in enumerate(RESPONSES):
            median, lower, upper = bands[:, j, :, k]
            panel.plot(shown_values(sweep), median, color=HUES[j], ls=LINES[j], label=response)
            panel.fill_between(shown_values(sweep), lower, upper, color=HUES[j], alpha=0.2, lw=0)
        panel.axvline(factor * sweep.knob.present, color=GREY, lw=0.7)
        if answer.choice.told:
            panel.axvspan(factor * answer.choice.lower, factor * answer.choice.upper, color=PALETTE[2], alpha=0.2, lw=0)
        panel.set_title(measure.words.partition(",")[0], fontsize=7)
        panel.set_ylabel(measure.unit)
        panel.set_xlabel(f"{sweep.knob.vary} [{UNITS[sweep.knob.vary]}]")
    axes[0].legend(fontsize=6, frameon=False)
    _shapes(axes[-1], ends, shapes["angles kept"])
    return figure


def _shapes(panel: Axes, ends: Knob, carried: Sequence[CarriedLoad]) -> None:
    factor, unit = SHOWN[ends.vary]
    for k, (value, found) in enumerate(zip(ends.settings, carried, strict=True)):
        x, y = 1e3 * shank_path(found).T
        label = f"{factor * value:.{DIGITS[ends.vary]}f} {unit}".strip()
        panel.plot(x, y, color=PALETTE[k], ls=LINES[k], label=label)
    panel.set_aspect("equal", adjustable="datalim")
    panel.set_title("roll-over shape in the shank", fontsize=7)
    panel.set_xlabel("forward of the ankle [mm]")
    panel.set_ylabel("above it [mm]")
    panel.legend(fontsize=6, frameon=False)


def stance_share(found: CarriedLoad) -> np.ndarray:
    """Share of the loaded stance, 0 to 1."""
    time = found.task.time
    return np.asarray((time - time[0]) / (time[-1] - time[0]))


FIGURE = (
    "Blue with the person's angles kept, orange with the ankle's torque kept, pink with the torques of hip and knee; "
    "bands over the draws. A grey line is the present value, green the interval of the best one."
)
PAIRS = "The foot turned on the socket as well: what the best pair gains over the best value alone"
INTACT = "What a step of the intact foot has, which is aimed at"
LIMITS = [
    (
        "What a person does on another foot is not known. With angles kept the socket turns as recorded; with torque "
        "kept the foot turns until the ankle has the moment of the recorded foot; in both the load over time is the "
        "recorded one, and nothing has inertia. With joint torques kept, hip and knee have the torques of the recorded "
        "foot, and leg and load follow by forward dynamics. What people do is taken to lie between."
    ),
    (
        "Joint torques alone do not hold a leg on another foot: a spring of 2 N m/rad per kg of body mass and a damper "
        "at hip and knee, invented numbers, hold it near the recorded angles."
    ),
    (
        "Bands hold what is not known of the sole, rounding of the keel's compressions, the count of spheres in the "
        "model, errors of markers and plate. How a person differs from step to step is not in them."
    ),
    "A best value is told where its interval is narrower than 60 % of the range in every response that it matters in.",
    (
        "Rate of loading: stiffness of the landing foot times its speed; the sole's damping, whose numbers are "
        "invented, is not in it."
    ),
]


def design_page(drawn: bytes, sweep: Sweep, tables: Mapping[str, pd.DataFrame], sentences: Sequence[str]) -> Page:
    """Outcomes, answers, what they hang on, numbers; `drawn` is the figure (SVG)."""
    bands = sweep.bands
    curves = [
        Curves(
            f"{MEASURES[aim].words[:1].upper()}{MEASURES[aim].words[1:]}",
            MEASURES[aim].unit,
            [Curve(response, *bands[:, j, :, k]) for j, response in enumerate(RESPONSES)],
        )
        for k, aim in enumerate(AIMS)
    ]
    sections: list[Section] = [
        Picture("Outcomes and roll-over shapes", FIGURE, drawn, wide=True),
        frame_table("What is best, and whether that can be told", tables["answers"], 3),
        *(frame_table(INTACT, tables["intact"], 3) for _ in range("intact" in tables)),
        *(frame_table(PAIRS, tables["pairs"], 3) for _ in range("pairs" in tables)),
        frame_table("Between which ends each outcome lies, whatever the person keeps", tables["ranges"], 3),
        frame_table("On what the outcomes of the present foot hang", tables["sensitivities"], 3),
        *curves,
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
