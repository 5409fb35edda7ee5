"""What a choice shows: the chosen exoskeleton moving, strap and knee by design, and the front."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd

from geocontact.analyses.sit_to_stand.show import PARTS, at_parts, motion_page, standing_scene
from geocontact.data.motion import Course
from geocontact.standing_up.assisted_model import KNEE
from geocontact.standing_up.assisted_movement import UNITS
from geocontact.standing_up.chain import Subject
from geocontact.standing_up.help_search import CertifiedDesign
from geocontact.view.curves.declared import INK, Curve, Curves, CurveSheet, Points, stroke
from geocontact.view.page.content import Page, Section
from geocontact.view.page.tables import frame_table

MODEL = [
    "The person stands up as in the trial with little jerk and torque, and does not give way to spare the strap.",
    "The exoskeleton helps at the knee with a share of the person's torque, most at one time of the movement.",
    "Smooth peaks are the norm of order 24 over the movement. Largest values are true peaks, also between the points.",
    "Without help the strap carries the exoskeleton's weight. A share lifts it, a larger one presses the other way.",
    "The limit of the knee is a part of its true peak without help, and holds at every time.",
    "Both legs are one chain; a strap's force is for one leg.",
    "What can be built, the width of the help and the sizes of the person's habit are invented.",
    "Shear is the strap's force along the thigh: predicted only, as a mat cannot measure it.",
    "Sensitivities are derivatives of the least aim, with all variables optimised again; draws include no model error.",
]
NAMES = {
    "designs": "Designs",
    "chosen": "What was chosen, and between which values",
    "sensitivity": "How the minimum changes with the fixed numbers",
    "front": "The best at further limits of the knee",
    "draws": "With drawn parameters",
    "certificate": "Between and beyond the collocation points",
}
FRONT = "Least {}, {}, over the limit of the knee"


def choice_page(
    sentences: Sequence[str],
    facts: Sequence[tuple[str, str]],
    subject: Subject,
    designs: Sequence[CertifiedDesign],
    curves: CurveSheet,
    tables: Mapping[str, pd.DataFrame],
) -> Page:
    """The chosen exoskeleton moving, curves of all (those of `design_curves`), tables."""
    best = designs[-1]
    sections: list[Section] = [
        standing_scene(subject, best.trials),
        *curves.panels,
        *(frame_table(title, shown(tables[name]), 3) for name, title in NAMES.items() if name in tables),
    ]
    titles = (
        "An exoskeleton chosen for standing up",
        f"{', '.join(t.recorded.name for t in best.trials)}; {subject.mass:g} kg, {subject.height:g} m",
    )
    return motion_page(titles, sentences, sections, MODEL, facts)


STIFFNESSES = ("normal", "tangential", "turning")


def shown(table: pd.DataFrame) -> pd.DataFrame:
    """The table as it is read: lengths in mm, stiffnesses by their name, no columns without a value.

    Of a change by a step (1 mm, 10 %) the derivative is left to the file.
    """
    found = table.dropna(axis=1, how="all")
    if "step" in found.columns:
        found = found.drop(columns=["per", *(name for name in found.columns if name.startswith("change ["))])
    if {"unit", "value", "least", "most"} <= set(found.columns):
        found, metres = found.copy(), found["unit"] == "m"
        found.loc[metres, ["value", "least", "most"]] *= 1e3
        found["unit"] = found["unit"].where(~metres, "mm")
        found["name"] = [f"{name} stiffness" if name in STIFFNESSES else name for name in found["name"]]
    named = {
        name: f"{kind} stiffness{name[len(kind) :]}"
        for name in found.columns
        for kind in STIFFNESSES
        if name.startswith(f"{kind} [")
    }
    return found.rename(columns=named)


def design_curves(designs: Sequence[CertifiedDesign], front: Sequence[CertifiedDesign], aim: str) -> CurveSheet:
    """Strap and knee in the first trial by each design, in ink without help; the front where it was asked for."""
    strap, knee = [], []
    for k, one in enumerate(designs):
        trial, own = one.trials[0], stroke(k - 1, k - 1) if k else INK
        if trial.model.strap is None or trial.model.torque is None:
            raise ValueError("no strap or torque")
        strap.append(Curve(one.name, at_parts(trial, trial.model.strap), stroke=own))
        knee.append(Curve(one.name, at_parts(trial, trial.model.torque[:, KNEE]), stroke=own))
    panels = [
        Curves("Normal force of one strap, forwards", "N", strap),
        Curves("Knee torque of both legs", "N m", knee),
    ]
    return CurveSheet([*panels, *([_front([*front, designs[-1]], aim)] if front else [])], PARTS)


def _front(each: Sequence[CertifiedDesign], aim: str) -> Curves:
    limits = 100.0 * np.array([one.limit for one in each])
    values = np.array([one.movement.asked.at(aim) for one in each])
    over = Course("limit of the knee's true peak", "% of without help", np.array([limits.min(), limits.max()]))
    title = FRONT.format(aim, "mean" if aim == "energy" else "smooth peak")
    points = [Points("best", limits, values, joined=True), Points("designs", limits, values)]
    return Curves(title, UNITS[aim], [], points=points, over=over)
