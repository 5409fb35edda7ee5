"""The page of support profiles: torques, factors, what they do, persons held out, fronts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd

from geocontact.analyses.finished_page import INPUTS, OPTIONS
from geocontact.analyses.page_words import NOT_A_DEVICE, headline
from geocontact.view.page.content import Curve, Curves, Page, Picture, Section, Words
from geocontact.view.page.tables import frame_table

FIGURE = (
    "Dashed the torque that the shoulder needs without support, solid the support torque, dotted the elevation of the "
    "arm; the grey span is the phase screw-in as the controller detects it."
)
MODEL = (
    "Profiles are chosen by linear programs that are corrected by the simulation of every arm until both agree. The "
    "person moves as without the device."
)


def profile_page(figure: bytes, tables: Mapping[str, pd.DataFrame], sentences: Sequence[str]) -> Page:
    """The page of support profiles.

    `figure` is the drawing (SVG), `tables` those of the result.
    """
    front = tables["front"]
    limits, reserves, taken = (front[name].to_numpy(float) for name in front.columns)
    curves = [
        Curve(f"reserve {100.0 * reserve:g} %", 100.0 * taken[reserves == reserve]) for reserve in np.unique(reserves)
    ]
    held = tables["held_out"]
    sections: list[Section] = [
        Picture("Torque needed and support", FIGURE, figure),
        frame_table("Factors of support", tables["factors"], 2),
        *(
            [frame_table("Factors in proportion to the weight of the arm", tables["scales"], 2)]
            if len(tables["scales"])
            else []
        ),
        *([frame_table("Made for the others, judged on this person", held, 3)] if len(held) else []),
        frame_table("Simulated with the device's own motion", tables["simulated"], 3),
        frame_table("What each profile does, as planned around the profile of all persons", tables["outcomes"], 3),
        Curves("Taken away over the limit of interface force", "%", curves),
        INPUTS,
        OPTIONS,
        Words("What the numbers do not contain", [MODEL, NOT_A_DEVICE]),
    ]
    return Page(
        title="Support profile of a shoulder exoskeleton",
        subtitle="Factors by work phase, hand and task that never push the arm up",
        time=np.unique(limits),
        time_label="force limit [N]",
        headline=headline(sentences),
        sections=tuple(sections),
        plays=False,
    )
