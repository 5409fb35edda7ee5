"""Marker sets of gait laboratories: which place of the body each label names.

Labels are those of public files and manuals; `MarkerSet.source` says which, and whether a file was compared. `{s}` in a
label stands for the side, r or l; case and the signs . _ - and blanks do not count.
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
_CORTEX = {
    "{s}.ASIS": "asis",
    "{s}.PSIS": "psis",
    "{s}.Knee": "knee_lateral",
    "{s}.Knee.Medial": "knee_medial",
    "{s}.Ankle": "ankle_lateral",
    "{s}.Ankle.Medial": "ankle_medial",
    "{s}.Heel": "heel",
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

KEYPOINTS = "opencap-keypoints"
"""Set whose joints are centres, found in video; markers of these names may be on the skin."""

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
        "Leardini et al. 2007; labels of the paper, those of the leg as in BMClab's BiomecII2018_gait_n.txt",
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
        "Leardini et al. 2007; labels of Qualisys' project for gait, their codes as in the list of RRIS40",
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
    "ior-bmclab": MarkerSet(
        "Istituto Ortopedico Rizzoli, labels of BMClab in Cortex",
        "Leardini et al. 2007; BMClab's public walk.trc, the protocol of Fukuchi et al. 2018",
        {
            **_CORTEX,
            "{s}.Iliac.Crest": "sacrum_cluster",
            "{s}.GTR": "trochanter",
            "{s}.HF": "fibula_head",
            "{s}.TT": "tuberosity",
            "{s}.MT1": "metatarsal_1",
            "{s}.MT2": "metatarsal_2",
            "{s}.MT5": "metatarsal_5",
        },
    ),
    "helen-hayes-cortex": MarkerSet(
        "Helen Hayes, labels of Motion Analysis' Cortex",
        "Kadaba et al. 1990; labels of Cortex as public readers of .trc list them, medial ones as in BMClab's walk.trc",
        {
            **_CORTEX,
            "V.Sacral": "sacrum",
            "{s}.Thigh": "thigh_wand",
            "{s}.Shank": "shank_wand",
            "{s}.Toe": "metatarsal_2",
            "{s}.Foot": "foot_cluster",
            "Top.Head": "head",
            "{s}.Shoulder": "acromion",
            "{s}.Bicep": "arm",
            "{s}.Elbow": "elbow_lateral",
            "{s}.ForeArm": "forearm",
            "{s}.Radius": "wrist_radial",
            "{s}.Ulna": "wrist_ulnar",
            "{s}.Thumb": "hand",
            "{s}.Pinky": "hand",
        },
    ),
    "rris40": MarkerSet(
        "RRIS40, full body",
        "Rehabilitation Research Institute of Singapore; public list rris40, markers.md",
        {
            "{s}ASIS": "asis",
            "{s}PSIS": "psis",
            "{s}FLE": "knee_lateral",
            "{s}FME": "knee_medial",
            "{s}FAL": "ankle_lateral",
            "{s}TAM": "ankle_medial",
            "{s}FCC": "heel",
            "{s}FMT1": "metatarsal_1",
            "{s}FMT2": "metatarsal_2",
            "{s}FMT5": "metatarsal_5",
            "{s}ACR": "acromion",
            "{s}HLE": "elbow_lateral",
            "{s}HME": "elbow_medial",
            "{s}RSP": "wrist_radial",
            "{s}USP": "wrist_ulnar",
            "{s}CAP": "hand",
            "{s}HMC2": "hand",
            "{s}TEMP": "head",
            "{s}HEAD": "head",
            "C7": "c7",
            "T8": "t8",
            "T10": "t10",
            "STER": "incisura",
            "XPRO": "xiphoid",
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
    KEYPOINTS: MarkerSet(
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
        "Rajagopal et al. 2016; labels and places of its model, Rajagopal2016.osim of opensim-models",
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
            "{s}TOE": "toe_medial",
            "{s}MT5": "metatarsal_5",
            "{s}ACR": "acromion",
            "{s}LEL": "elbow_lateral",
            "{s}MEL": "elbow_medial",
            "{s}SJC": "shoulder_centre",
            "{s}EJC": "elbow_centre",
            "{s}FAradius": "wrist_radial",
            "{s}FAulna": "wrist_ulnar",
            "C7": "c7",
            "CLAV": "incisura",
            **{f"{{s}}UA{k}": "arm" for k in (1, 2, 3)},
            **{f"{{s}}TH{k}": "thigh_cluster" for k in (1, 2, 3)},
            **{f"{{s}}TB{k}": "shank_cluster" for k in (1, 2, 3)},
        },
    ),
    "rajagopal-walk": MarkerSet(
        "Walk of Rajagopal 2016, with clusters, labels of Cortex",
        "Rajagopal et al. 2016; labels of markers_walk.trc, example3DWalking of opensim-core, with the toe's "
        "marker 0.3 m from the heel's",
        {
            **{label: place for label, place in _CORTEX.items() if "Medial" not in label},
            "S2": "sacrum",
            "{s}.Toe": "toe_tip",
            "{s}.MT5": "metatarsal_5",
            "{s}.Shoulder": "acromion",
            "{s}.Clavicle": "clavicle",
            "{s}.Biceps": "arm",
            "{s}.Elbow": "elbow_lateral",
            "{s}.Forearm": "forearm",
            "{s}.Wrist": "wrist",
            **{f"{{s}}.TH{k}": "thigh_cluster" for k in range(1, 5)},
            **{f"{{s}}.SH{k}": "shank_cluster" for k in range(1, 5)},
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
