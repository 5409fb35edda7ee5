"""How a marker set names places of the body, and groups of labels that several sets share.

`{s}` in a label stands for the side, r or l; case and the signs . _ - and blanks do not count.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

from geocontact.data.multibody.body_places import Side


@dataclass(frozen=True)
class MarkerSet:
    """A set of labels.

    Parameters
    ----------
    words
        As people call it.
    source
        Paper or public file of the labels.
    labels
        Key of the place by label; alternatives for one place are several labels.
    """

    words: str
    source: str
    labels: Mapping[str, str]

    def places(self) -> dict[str, tuple[str, Side]]:
        """Place and side by normalised label."""
        found: dict[str, tuple[str, Side]] = {}
        for label, place in self.labels.items():
            for side in "rl" if "{s}" in label else ("",):
                found[normalised(label.replace("{s}", side))] = place, side
        return found


def normalised(label: str) -> str:
    """A label as it is compared: without the subject before a colon, in lower case, without . _ - and blanks.

    >>> normalised("JW:R.ASIS"), normalised("r_ankle_study")
    ('rasis', 'ranklestudy')
    """
    return re.sub(r"[\s._-]", "", label.rpartition(":")[2].lower())


LEG = {
    "{s}ASI": "asis",
    "{s}THI": "thigh_wand",
    "{s}KNE": "knee_lateral",
    "{s}ANK": "ankle_lateral",
    "{s}HEE": "heel",
    "{s}TOE": "metatarsal_2",
}
PLUG_IN = {**LEG, "{s}PSI": "psis", "{s}TIB": "shank_wand"}
CGM2 = {
    **PLUG_IN,
    "{s}THAP": "thigh_proximal",
    "{s}THAD": "thigh_distal",
    "{s}TIAP": "shank_proximal",
    "{s}TIAD": "shank_distal",
    "{s}KNM": "knee_medial",
    "{s}MED": "ankle_medial",
}
TRIPLES = {
    f"{{s}}{body}{where}": f"{place}_{where.lower()}"
    for body, place in (("Thigh", "thigh"), ("Shank", "shank"))
    for where in ("Upper", "Front", "Rear")
}
CLUSTERS = {
    f"{{s}}{name}{k}": place
    for name, place in (("TH", "thigh_cluster"), ("SK", "shank_cluster"), ("FT", "foot_cluster"))
    for k in range(1, 5)
}
GRAND = {
    f"{{s}}{body}{where}": place
    for body, place in (("Thigh", "thigh_cluster"), ("Shank", "shank_cluster"))
    for where in ("Superior", "Inferior", "Lateral")
}
CORTEX = {
    "{s}.ASIS": "asis",
    "{s}.PSIS": "psis",
    "{s}.Knee": "knee_lateral",
    "{s}.Knee.Medial": "knee_medial",
    "{s}.Ankle": "ankle_lateral",
    "{s}.Ankle.Medial": "ankle_medial",
    "{s}.Heel": "heel",
}
OPENCAP = {
    f"{{s}}{name}study": place
    for name, place in {
        "ASIS": "asis",
        "PSIS": "psis",
        "knee": "knee_lateral",
        "mknee": "knee_medial",
        "ankle": "ankle_lateral",
        "mankle": "ankle_medial",
        "toe": "metatarsal_2",
        "5meta": "metatarsal_5",
        "calc": "heel",
        "shoulder": "acromion",
        "lelbow": "elbow_lateral",
        "melbow": "elbow_medial",
        "lwrist": "wrist_radial",
        "mwrist": "wrist_ulnar",
        "HJC": "hip_centre",
    }.items()
}
