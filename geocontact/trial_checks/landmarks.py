"""Which landmark of the body a marker's label names, in the sets that gait laboratories use.

Only what checks need: ASIS, PSIS or sacrum, knee, heel, toes, ankle, head and shoulder. A label that is not recognised
is no landmark, and the checks that need it are silent.
"""

from __future__ import annotations

import re

import numpy as np
from jaxtyping import Float

from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.data.multibody.model import Multibody

KINDS = {
    "asis": r"asis?",
    "psis": r"psis?",
    "sacrum": r"(v|l5)?(sacr?(al|um)?|vsac|s2|pelvis)",
    "heel": r"(hee|heel|cal|calc|calcn|calcaneus|ca)\d?",
    "toe": r"(toes?|toe(tip|lateral|medial|lat|med)|hlx|hallux|mt[1-5]|d[15]m|mtp?\d|fm[1-5])",
    "ankle": r"(talus|ank(le)?(lateral|medial|lat|med|m)?|lm|mm|mal(lat|med))",
    "shoulder": r"(sho|shoulder|acr|acromi[ou]n|acromium)",
    "head": r"(fhd|bhd|head|temple|tophead|hd)",
    "c7": r"(c7|neck)",
    "hip": r"(hip|femur)",
    "arm": r"(upa|fra|fin|biceps?|elb(ow)?|wri(st)?|forearm|hand|humerus|radius|ulna)(lateral|medial|lat|med)?",
    "knee": r"(kne|knee(lateral|medial|lat|med)?|tibia)",
}
"""Patterns of labels without their side, in lower case and with letters and digits only."""
MIDDLE = {"sacrum", "c7", "head"}
"""Landmarks that may be on no side."""
FOOT = ("heel", "toe", "ankle")
SIDES = ("right", "left", "")
"""Sides of a foot; "" for the only one, of which nobody says on which side it is."""


def the_foot(side: str) -> str:
    """In words."""
    return f"the {side} foot" if side else "the foot"


def landmark(label: str) -> tuple[str, str]:
    """Landmark and side, "right", "left" or ""; two empty texts for a label that is none of them.

    >>> landmark("R.Toe.Lat"), landmark("LPSI"), landmark("V.Sacral"), landmark("RTH1")
    (('toe', 'right'), ('psis', 'left'), ('sacrum', ''), ('', ''))
    """
    plain = re.sub(r"[^a-z0-9]", "", label.lower())
    for kind in MIDDLE:
        if re.fullmatch(KINDS[kind], plain):
            return kind, ""
    if plain in FOOT:
        return plain, ""
    for word, side in (("right", "right"), ("left", "left"), ("r", "right"), ("l", "left")):
        for rest in (plain.removeprefix(word), plain.removesuffix(word)):
            if rest == plain:
                continue
            for kind, pattern in KINDS.items():
                if re.fullmatch(pattern, rest):
                    return kind, side
    return "", ""


SEEN = 0.5
"""Share of the frames that show the best seen one, in which a marker has to be seen to count."""


def middle(
    seen: MarkerTrajectories, kinds: tuple[str, ...], side: str | None = None
) -> Float[np.ndarray, "t 3"] | None:
    """Mean of the landmarks of these kinds [m], of one side or of all; None where none was recorded.

    Markers that are seen in less than half of the frames in which the best seen one is do not count. NaN in frames in
    which one of the others was not seen, so that the mean does not jump.
    """
    names = tuple(
        name for name in seen.names if landmark(name)[0] in kinds and (side is None or landmark(name)[1] == side)
    )
    places = seen.of(names)
    share = np.isfinite(places).all(axis=2).mean(axis=0)
    often = share > SEEN * share.max(initial=0.0)
    return places[:, often].mean(axis=1) if often.any() else None


def body_points(
    model: Multibody, time: Float[np.ndarray, " t"], values: Float[np.ndarray, "t n"], source: str
) -> MarkerTrajectories:
    """Origins of the bodies of a model [m] along its coordinates [rad, m], as if they were markers.

    In OpenSim's models of people these lie in the middle of the pelvis, in hips and ankles, at heels and toes.
    """
    names = tuple(body.name for body in model.bodies)
    poses = model.poses(values)
    return MarkerTrajectories(time, np.stack([poses[name].translation for name in names], axis=1), names, source)


def points(seen: MarkerTrajectories, kinds: tuple[str, ...], side: str) -> Float[np.ndarray, "t n 3"]:
    """The landmarks of these kinds on one side [m]."""
    return seen.of(tuple(name for name in seen.names if landmark(name)[0] in kinds and landmark(name)[1] == side))
