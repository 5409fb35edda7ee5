"""What a choice shows: the chosen exoskeleton moving, strap and knee by design, and the front."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from geocontact.analyses.sit_to_stand.show import at_parts, motion_page, standing_scene
from geocontact.standing_up.assisted_model import KNEE
from geocontact.standing_up.assisted_movement import MEASURES, UNITS
from geocontact.standing_up.chain import Subject
from geocontact.standing_up.help_search import CertifiedDesign
from geocontact.view.curves.style import DOUBLE, GREY, LINES, PALETTE, in_style, panels
from geocontact.view.page.content import Curve, Curves, Page, Picture, Section
from geocontact.view.page.tables import frame_table

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MODEL = [
    "The person stands up as in the trial with little jerk and torque, and does not give way to spare the strap.",
    "The exoskeleton helps at the knee with a share of the person's torque, most at one time of the movement.",
    "Smooth peaks are the norm of order 24 over the movement. Largest values are true peaks, also between the points.",
    "Without help the exoskeleton's weight hangs on the strap. A share lifts it, a larger one presses the other way.",
    "The limit of the knee is a part of its true peak without help, and holds at every time.",
    "Both legs are one chain, a strap is that of one.",
    "What can be built, the width of the help and the sizes of the person's habit are invented.",
    "Shear is the strap's force along the thigh: predicted only, for no mat sees it.",
    "Sensitivities are derivatives of the least aim, everything that is sought following; draws hold no error of form.",
]
NAMES = {
    "designs": "Designs",
    "chosen": "What was chosen, and between which values",
    "sensitivity": "How the least aim changes with what is held",
    "front": "The best at further limits of the knee",
    "draws": "With drawn parameters",
    "certificate": "Between and beyond the collocation points",
}
HEIGHT = 0.06
"""Height of the drawing [m]."""


def choice_page(
    sentences: Sequence[str],
    subject: Subject,
    designs: Sequence[CertifiedDesign],
    drawn: bytes,
    tables: Mapping[str, pd.DataFrame],
) -> Page:
    """The chosen exoskeleton moving, curves of all, tables."""
    best = designs[-1]
    sections: list[Section] = [
        standing_scene(subject, best.trials),
        *_curves(designs),
        Picture("Strap and knee of the first trial", "Grey without help.", drawn, wide=True),
        *(frame_table(title, tables[name], 3) for name, title in NAMES.items() if name in tables),
    ]
    titles = (
        "An exoskeleton chosen for standing up",
        f"{', '.join(t.recorded.name for t in best.trials)}; {subject.mass:g} kg, {subject.height:g} m",
    )
    return motion_page(titles, sentences, sections, MODEL)


def _curves(designs: Sequence[CertifiedDesign]) -> list[Curves]:
    """Strap and knee in the first trial."""
    strap, knee = [], []
    for k, one in enumerate(designs):
        trial = one.trials[0]
        if trial.model.strap is None or trial.model.torque is None:
            raise ValueError("no strap or torque")
        strap.append(Curve(one.name, at_parts(trial, trial.model.strap), stroke=k))
        knee.append(Curve(one.name, at_parts(trial, trial.model.torque[:, KNEE]), stroke=k))
    return [
        Curves("Normal force of one strap, forwards", "N", strap),
        Curves("Knee torque of both legs", "N m", knee),
    ]


@in_style
def design_figure(designs: Sequence[CertifiedDesign], front: Sequence[CertifiedDesign], aim: str) -> Figure:
    """Strap and knee in the first trial, grey without help, and the front."""
    figure, axes = panels(1, 3 if front else 2, DOUBLE, HEIGHT)
    for k, one in enumerate(designs):
        trial = one.trials[0].model
        if trial.torque is None or trial.strap is None:
            raise ValueError("no torque or strap")
        colour, line = GREY if not k else PALETTE[k - 1], LINES[max(k - 1, 0)]
        for ax, values in zip(axes, (trial.strap, trial.torque[:, KNEE]), strict=False):
            ax.plot(trial.time, values, color=colour, ls=line, lw=1.2, label=one.name)
    for ax, label in zip(axes, ("normal force of one strap [N]", "knee torque of both legs [N m]"), strict=False):
        ax.set_xlabel("time since seat-off [s]")
        ax.set_ylabel(label)
    axes[0].legend(fontsize=6, frameon=False)
    if front:
        _front(axes[2], [*front, designs[-1]], aim)
    return figure


def _front(ax: Axes, each: Sequence[CertifiedDesign], aim: str) -> None:
    limits = np.array([one.limit for one in each])
    values = [one.movement.asked.sizes[MEASURES.index(aim)] for one in each]
    ax.plot(100.0 * limits, values, "o-", color=PALETTE[0], ms=3, lw=1.2)
    ax.set_xlabel("limit of the knee's true peak [% of without help]")
    ax.set_ylabel(f"least {aim}, {'mean' if aim == 'energy' else 'smooth peak'} [{UNITS[aim]}]")
