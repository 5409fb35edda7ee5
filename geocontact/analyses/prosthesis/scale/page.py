"""The page of a scaled person: the standing pose, segments, joints, numbers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd

from geocontact.analyses.finished_page import INPUTS, OPTIONS
from geocontact.analyses.motion.skeleton import MARKER, scene_of, skeleton
from geocontact.analyses.page_words import NOT_A_DEVICE, headline
from geocontact.data.multibody.model import Multibody
from geocontact.dynamics.inverse_kinematics import Poses
from geocontact.view.page.content import IntervalRow, Intervals, Page, Section, Words
from geocontact.view.page.linkage import Linkage
from geocontact.view.page.tables import frame_table

TRUNK = (
    "Trunk, head and arms are one rigid body with the pelvis, upright as while standing, arms hanging (de Leva): it "
    "leans with the pelvis only, and its arms do not swing. Moments on pelvis and hips are those of such a trunk."
)
SKIN = (
    "Markers lie on skin. Centres from a functional trial are off by what skin moves, more if the joint moves little: "
    "how far a joint is off itself tells the first, not the second."
)
HELD_PARTS = (
    "amputee_ik.osim holds socket and keel, of which markers tell nothing; in amputee.osim they are free, with springs "
    "of the fulcrum that was asked for."
)


def amputee_page(
    title: str, model: Multibody, pose: Poses, tables: Mapping[str, pd.DataFrame], sentences: Sequence[str]
) -> Page:
    """The standing pose with its markers, segments, joints, numbers."""
    values = np.asarray(pose.values)
    places = Linkage("markers", model.marker_places(values), np.zeros((0, 2), dtype=np.int64), "seen", MARKER, 0.0)
    sections: list[Section] = [
        scene_of(model, [skeleton(model, values), places]),
        frame_table("Segments", tables["segments"]),
        frame_table("Joints while standing", tables["joints"]),
        *_distances(tables),
        frame_table("Numbers of the segments in SI, and where they are from", tables["numbers"]),
        INPUTS,
        OPTIONS,
        Words("What the numbers do not contain", [TRUNK, SKIN, HELD_PARTS, NOT_A_DEVICE]),
    ]
    return Page(
        title=title,
        subtitle="Both legs of a person with a below-knee prosthesis, standing",
        time=np.zeros(1),
        time_label="",
        headline=headline(sentences),
        facts=[
            ("Mass", f"{model.mass:.4g} kg"),
            ("Coordinates", f"{len(model.coordinates)}"),
        ],
        sections=tuple(sections),
        plays=False,
    )


def _distances(tables: Mapping[str, pd.DataFrame]) -> list[Section]:
    """Of the markers of the functional trial, farthest first."""
    if "markers" not in tables:
        return []
    table = tables["markers"].sort_values("off, rms [mm]", ascending=False)
    rows = [IntervalRow(name, float(off)) for name, off in table.itertuples(index=False)]
    return [Intervals("Markers of the functional trial off the model, root mean square", "mm", rows, bars=True)]
