"""Marker sets of gait laboratories: which place of the body each label names, and where that is on a segment.

Labels are those of public files and manuals; `MarkerSet.source` says which, and whether a file was compared. `{s}` in a
label stands for the side, r or l; case and the signs . _ - and blanks do not count.

Places lie on the skin of an adult, in the right segment's frame of OpenSim's gait2392 (x forward, y up, z to the
right), rounded to 5 mm from the markers of gait2354, subject01 (Delp et al. 2007), of LaiUhlrich2022 (Uhlrich et al.
2023) and of pyCGM2's set for gait2392 (Leboeuf et al. 2019). These three differ by 1 to 3 cm from each other, and so
does a subject: a place is where a marker begins, before a static pose moves it.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

Side = str
"""r, l, or empty for the middle of the body."""


@dataclass(frozen=True)
class Place:
    """A place of the body.

    Parameters
    ----------
    words
        In anatomical terms.
    segment
        Body of gait2392 without its side.
    at
        On the right segment, in its frame [m]; None where sets leave it to whoever puts the marker there.
    bony
        Whether it is felt through the skin, or a centre of a joint; wands and clusters are not.
    """

    words: str
    segment: str
    at: tuple[float, float, float] | None = None
    bony: bool = True


def _soft(words: str, segment: str, at: tuple[float, float, float] | None = None) -> Place:
    return Place(words, segment, at, bony=False)


PLACES: Mapping[str, Place] = {
    "asis": Place("anterior superior iliac spine", "pelvis", (0.02, 0.02, 0.13)),
    "psis": Place("posterior superior iliac spine", "pelvis", (-0.18, 0.05, 0.06)),
    "sacrum": Place("middle of the posterior superior iliac spines", "pelvis", (-0.18, 0.05, 0.0)),
    "hip_centre": Place("hip joint centre", "pelvis", (-0.07, -0.065, 0.085)),
    "sacrum_cluster": _soft("pelvis, no named place", "pelvis"),
    "hips_middle": Place("middle of the hip joint centres", "pelvis", (-0.07, -0.065, 0.0)),
    "trochanter": Place("greater trochanter", "femur", (-0.02, -0.005, 0.085)),
    "knee_lateral": Place("lateral femoral epicondyle", "femur", (0.0, -0.405, 0.055)),
    "knee_medial": Place("medial femoral epicondyle", "femur", (0.0, -0.405, -0.055)),
    "knee_centre": Place("knee joint centre", "femur", (0.0, -0.395, 0.0)),
    "thigh_wand": _soft("lateral thigh, on a wand or on skin", "femur", (0.005, -0.22, 0.1)),
    "thigh_upper": _soft("upper marker of the thigh's three", "femur", (0.045, -0.215, 0.09)),
    "thigh_front": _soft("front marker of the thigh's three", "femur", (0.11, -0.265, 0.005)),
    "thigh_rear": _soft("rear marker of the thigh's three", "femur", (0.035, -0.33, 0.08)),
    "thigh_proximal": _soft("anterior thigh, proximal", "femur", (0.05, -0.135, -0.02)),
    "thigh_distal": _soft("anterior thigh, distal", "femur", (0.06, -0.28, -0.01)),
    "thigh_cluster": _soft("thigh, no named place", "femur"),
    "patella": _soft("patella", "femur", (0.055, -0.395, 0.0)),
    "fibula_head": Place("head of the fibula", "tibia", (-0.02, -0.05, 0.055)),
    "tuberosity": Place("tibial tuberosity", "tibia", (0.045, -0.06, 0.0)),
    "shank_wand": _soft("lateral shank, on a wand or on skin", "tibia", (0.0, -0.2, 0.075)),
    "shank_upper": _soft("upper marker of the shank's three", "tibia", (-0.01, -0.065, 0.075)),
    "shank_front": _soft("front marker of the shank's three", "tibia", (0.05, -0.11, 0.02)),
    "shank_rear": _soft("rear marker of the shank's three", "tibia", (-0.01, -0.13, 0.085)),
    "shank_proximal": _soft("anterior shank, proximal", "tibia", (0.045, -0.16, -0.01)),
    "shank_distal": _soft("anterior shank, distal", "tibia", (0.05, -0.305, 0.01)),
    "shank_cluster": _soft("shank, no named place", "tibia"),
    "ankle_lateral": Place("lateral malleolus", "tibia", (-0.005, -0.425, 0.05)),
    "ankle_medial": Place("medial malleolus", "tibia", (0.005, -0.41, -0.035)),
    "ankle_centre": Place("ankle joint centre", "tibia", (0.0, -0.43, 0.0)),
    "heel": Place("posterior calcaneus", "calcn", (-0.02, 0.02, 0.0)),
    "midfoot_top": _soft("top of the midfoot", "calcn", (0.125, 0.03, -0.035)),
    "midfoot_lateral": _soft("lateral midfoot", "calcn", (0.12, 0.015, 0.065)),
    "foot_cluster": _soft("foot, no named place", "calcn"),
    "metatarsal_1": Place("first metatarsal head", "calcn", (0.18, 0.005, -0.03)),
    "metatarsal_2": Place("second metatarsal head", "calcn", (0.175, 0.015, 0.0)),
    "metatarsal_5": Place("fifth metatarsal head", "calcn", (0.145, 0.005, 0.06)),
    "toe_lateral": Place("lateral side of the toes", "calcn", (0.195, 0.0, 0.075)),
    "toe_medial": Place("medial side of the toes", "calcn", (0.205, 0.005, -0.03)),
    "toe_tip": Place("tip of the toes", "calcn", (0.26, 0.005, 0.0)),
    "acromion": Place("acromion", "torso", (-0.01, 0.41, 0.16)),
    "c7": Place("spinous process of C7", "torso", (-0.075, 0.4, 0.0)),
    "t8": Place("spinous process of T8", "torso", (-0.115, 0.27, 0.0)),
    "t10": Place("spinous process of T10", "torso", (-0.105, 0.22, 0.0)),
    "incisura": Place("incisura jugularis", "torso", (0.045, 0.355, 0.0)),
    "sternum": Place("sternum", "torso", (0.1, 0.31, 0.0)),
    "xiphoid": Place("xiphoid process", "torso", (0.115, 0.22, 0.0)),
    "back_offset": _soft("scapula, to mark the right side", "torso"),
    "neck": _soft("middle of the shoulder joint centres", "torso", (-0.01, 0.37, 0.0)),
    "shoulder_centre": Place("shoulder joint centre", "torso", (-0.005, 0.365, 0.165)),
    "head": _soft("head", "head"),
    "arm": _soft("upper arm, no named place", "humerus"),
    "elbow_lateral": Place("lateral humeral epicondyle", "humerus", (0.01, -0.29, 0.045)),
    "elbow_medial": Place("medial humeral epicondyle", "humerus", (0.005, -0.29, -0.05)),
    "elbow_centre": Place("elbow joint centre", "humerus", (0.005, -0.29, 0.0)),
    "forearm": _soft("forearm, no named place", "radius"),
    "wrist_radial": Place("radial styloid", "radius", (0.0, -0.235, 0.055)),
    "wrist_ulnar": Place("ulnar styloid", "radius", (-0.025, -0.235, -0.025)),
    "wrist": _soft("wrist, no named side", "radius"),
    "hand": _soft("hand", "hand"),
}
"""By key; a set gives a label to some of them."""


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


_LEG = {
    "{s}ASI": "asis",
    "{s}THI": "thigh_wand",
    "{s}KNE": "knee_lateral",
    "{s}ANK": "ankle_lateral",
    "{s}HEE": "heel",
    "{s}TOE": "metatarsal_2",
}
_PLUG_IN = {**_LEG, "{s}PSI": "psis", "{s}TIB": "shank_wand"}
_CGM2 = {
    **_PLUG_IN,
    "{s}THAP": "thigh_proximal",
    "{s}THAD": "thigh_distal",
    "{s}TIAP": "shank_proximal",
    "{s}TIAD": "shank_distal",
    "{s}KNM": "knee_medial",
    "{s}MED": "ankle_medial",
}
_TRIPLES = {
    f"{{s}}{body}{where}": f"{place}_{where.lower()}"
    for body, place in (("Thigh", "thigh"), ("Shank", "shank"))
    for where in ("Upper", "Front", "Rear")
}
_CLUSTERS = {
    f"{{s}}{name}{k}": place
    for name, place in (("TH", "thigh_cluster"), ("SK", "shank_cluster"), ("FT", "foot_cluster"))
    for k in range(1, 5)
}
_GRAND = {
    f"{{s}}{body}{where}": place
    for body, place in (("Thigh", "thigh_cluster"), ("Shank", "shank_cluster"))
    for where in ("Superior", "Inferior", "Lateral")
}
_OPENCAP = {
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

MARKER_SETS: Mapping[str, MarkerSet] = {
    "plug-in-gait-lower": MarkerSet(
        "Plug-in Gait, lower body",
        "Davis et al. 1991, Kadaba et al. 1990; labels as in pyCGM2, CGM1.translators",
        _PLUG_IN,
    ),
    "plug-in-gait": MarkerSet(
        "Plug-in Gait, full body",
        "Vicon's manual of Plug-in Gait; labels as in pyCGM2, CGM2_5.translators",
        {
            **_PLUG_IN,
            "{s}SHO": "acromion",
            "{s}UPA": "arm",
            "{s}ELB": "elbow_lateral",
            "{s}FRM": "forearm",
            "{s}WRA": "wrist_radial",
            "{s}WRB": "wrist_ulnar",
            "{s}FIN": "hand",
            "{s}FHD": "head",
            "{s}BHD": "head",
            "C7": "c7",
            "T10": "t10",
            "CLAV": "incisura",
            "STRN": "xiphoid",
            "RBAK": "back_offset",
        },
    ),
    "cgm2.3": MarkerSet("CGM2.1 to 2.3", "Leboeuf et al. 2019; pyCGM2, cgm2_3-markerset.xml", _CGM2),
    "cgm2.4": MarkerSet(
        "CGM2.4 and 2.5",
        "Leboeuf et al. 2019; pyCGM2, CGM2_5.translators (beside SMH, the place of TOE is not stated there)",
        {
            **_CGM2,
            "{s}FMH": "metatarsal_1",
            "{s}SMH": "metatarsal_2",
            "{s}VMH": "metatarsal_5",
            "{s}TOE": "foot_cluster",
        },
    ),
    "helen-hayes": MarkerSet(
        "Helen Hayes, labels of three and four letters",
        "Kadaba et al. 1990; BMClab's public Gait.c3d",
        {
            **_LEG,
            "VSAC": "sacrum",
            "{s}SHA": "shank_wand",
            "{s}SHO": "acromion",
            "{s}ELB": "elbow_lateral",
            "{s}WRI": "wrist",
            "ROFF": "back_offset",
        },
    ),
    "cleveland": MarkerSet(
        "Cleveland Clinic with three markers on each thigh and shank, as OpenSim's gait2354 and gait2392",
        "opensim-models, gait2354_Scale_MarkerSet.xml",
        {
            **_TRIPLES,
            "{s}ASIS": "asis",
            "V.Sacral": "sacrum",
            "{s}Knee.Lat": "knee_lateral",
            "{s}Knee.Med": "knee_medial",
            "{s}Ankle.Lat": "ankle_lateral",
            "{s}Ankle.Med": "ankle_medial",
            "{s}Heel": "heel",
            "{s}Midfoot.Sup": "midfoot_top",
            "{s}Midfoot.Lat": "midfoot_lateral",
            "{s}Toe.Lat": "toe_lateral",
            "{s}Toe.Med": "toe_medial",
            "{s}Toe.Tip": "toe_tip",
            "{s}Acromium": "acromion",
            "Sternum": "sternum",
            "Top.Head": "head",
            "{s}Temple": "head",
            "{s}Bicep": "arm",
            "{s}Elbow": "elbow_lateral",
            "{s}Wrist.Med": "wrist_ulnar",
            "{s}Wrist.Lat": "wrist_radial",
        },
    ),
    "grand-challenge": MarkerSet(
        "Grand challenge of knee loads, patellae and triples",
        "Fregly et al. 2012; public .trc and .c3d of subjects JW and DM",
        {
            **_GRAND,
            "{s}Asis": "asis",
            "{s}Psis": "psis",
            "Sacral": "sacrum",
            "{s}Patella": "patella",
            "{s}KneeLateral": "knee_lateral",
            "{s}KneeMedial": "knee_medial",
            "{s}AnkleLateral": "ankle_lateral",
            "{s}AnkleMedial": "ankle_medial",
            "{s}Heel": "heel",
            "{s}Toe": "toe_tip",
            "{s}ToeMedial": "metatarsal_1",
            "{s}ToeLateral": "metatarsal_5",
            "{s}MidfootMedial": "foot_cluster",
            "{s}MidfootLateral": "midfoot_lateral",
            "{s}MidfootSuperior": "midfoot_top",
            "{s}Hindfoot": "foot_cluster",
            "{s}Shoulder": "acromion",
            "{s}Elbow": "elbow_lateral",
            "{s}ElbowMedial": "elbow_medial",
            "{s}Radius": "wrist_radial",
            "{s}Ulna": "wrist_ulnar",
            "{s}Wrist": "wrist",
            "Neck": "c7",
            "Sternum": "incisura",
            "Xiphoid": "xiphoid",
        },
    ),
    "ior": MarkerSet(
        "Istituto Ortopedico Rizzoli, lower limb",
        "Leardini et al. 2007; labels from the paper, no public file was compared",
        {
            "{s}ASIS": "asis",
            "{s}PSIS": "psis",
            "{s}GT": "trochanter",
            "{s}LE": "knee_lateral",
            "{s}ME": "knee_medial",
            "{s}HF": "fibula_head",
            "{s}TT": "tuberosity",
            "{s}LM": "ankle_lateral",
            "{s}MM": "ankle_medial",
            "{s}CA": "heel",
            "{s}FM": "metatarsal_1",
            "{s}SM": "metatarsal_2",
            "{s}VM": "metatarsal_5",
        },
    ),
    "ior-qualisys": MarkerSet(
        "Istituto Ortopedico Rizzoli, labels of Qualisys",
        "Leardini et al. 2007; labels of Qualisys' project for gait, no public file was compared",
        {
            "{s}_IAS": "asis",
            "{s}_IPS": "psis",
            "{s}_FTC": "trochanter",
            "{s}_FLE": "knee_lateral",
            "{s}_FME": "knee_medial",
            "{s}_FAX": "fibula_head",
            "{s}_TTC": "tuberosity",
            "{s}_FAL": "ankle_lateral",
            "{s}_TAM": "ankle_medial",
            "{s}_FCC": "heel",
            "{s}_FM1": "metatarsal_1",
            "{s}_FM2": "metatarsal_2",
            "{s}_FM5": "metatarsal_5",
        },
    ),
    "opencap": MarkerSet(
        "OpenCap's anatomical markers",
        "Uhlrich et al. 2023; public model LaiArnoldModified2017",
        {
            **_OPENCAP,
            "C7study": "c7",
            **{f"{{s}}thigh{k}study": "thigh_cluster" for k in (1, 2, 3)},
            **{f"{{s}}sh{k}study": "shank_cluster" for k in (1, 2, 3)},
        },
    ),
    "opencap-keypoints": MarkerSet(
        "OpenCap's keypoints of video",
        "Uhlrich et al. 2023; OpenPose BODY_25 without the face",
        {
            "Neck": "neck",
            "midHip": "hips_middle",
            "{s}Hip": "hip_centre",
            "{s}Knee": "knee_centre",
            "{s}Ankle": "ankle_centre",
            "{s}BigToe": "metatarsal_1",
            "{s}SmallToe": "metatarsal_5",
            "{s}Heel": "heel",
            "{s}Shoulder": "shoulder_centre",
            "{s}Elbow": "elbow_centre",
            "{s}Wrist": "wrist",
        },
    ),
    "rajagopal": MarkerSet(
        "Rajagopal 2016",
        "Rajagopal et al. 2016; labels from its model, no public file was compared",
        {
            "{s}ASI": "asis",
            "{s}PSI": "psis",
            "{s}HJC": "hip_centre",
            "{s}KJC": "knee_centre",
            "{s}AJC": "ankle_centre",
            "{s}LFC": "knee_lateral",
            "{s}MFC": "knee_medial",
            "{s}LMAL": "ankle_lateral",
            "{s}MMAL": "ankle_medial",
            "{s}CAL": "heel",
            "{s}TOE": "toe_tip",
            "{s}MT5": "metatarsal_5",
            "{s}ACR": "acromion",
            "{s}LEL": "elbow_lateral",
            "{s}MEL": "elbow_medial",
            "C7": "c7",
            "CLAV": "incisura",
            **{f"{{s}}TH{k}": "thigh_cluster" for k in (1, 2, 3)},
            **{f"{{s}}TB{k}": "shank_cluster" for k in (1, 2, 3)},
        },
    ),
    "cast-clusters": MarkerSet(
        "Clusters on thigh, shank and foot, as in CAST: no anatomical place",
        "Cappozzo et al. 1995; labels of public Eb015pr.c3d",
        {**_CLUSTERS, **{f"PV{k}": "sacrum_cluster" for k in range(1, 5)}},
    ),
    "isb-trunk": MarkerSet(
        "Trunk of the ISB", "Wu et al. 2005", {"C7": "c7", "T8": "t8", "IJ": "incisura", "PX": "xiphoid"}
    ),
}
"""By the name that `naming` takes."""
