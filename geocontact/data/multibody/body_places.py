"""Places of the body that markers name, and where they are on a segment.

Places lie on the skin of an adult, in the right segment's frame of OpenSim's gait2392 (x forward, y up, z to the
right), rounded to 5 mm from the markers of gait2354, subject01 (Delp et al. 2007), of LaiUhlrich2022 (Uhlrich et al.
2023) and of pyCGM2's set for gait2392 (Leboeuf et al. 2019); the iliac crest 15 mm outside of the internal oblique's
origin on subject01. Own markers of the first two models lie 17 mm from them in the median and 65 mm at most (left thigh
of subject01; bony places 54 mm, the posterior iliac spines), and so does a subject: a place is where a marker begins,
before a static pose moves it.
"""

from __future__ import annotations

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
    "iliac_crest": Place("top of the iliac crest", "pelvis", (-0.045, 0.075, 0.135)),
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
    "clavicle": _soft("medial end of the clavicle", "torso"),
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
