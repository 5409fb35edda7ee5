"""What the markers are called, on a right prosthetic and a left intact leg; else R and L change places."""

from __future__ import annotations

PELVIS = ("RASI", "LASI", "RPSI", "LPSI")
"""Front and back spines."""
THIGH = ("RTH1", "RTH2", "RTH3")
KNEE = ("RKNE", "RKNM")
"""Lateral and medial epicondyle; the medial one only while standing."""
SOCKET = ("RSO1", "RSO2", "RSO3")
ANKLE = ("RANK", "RANM")
"""Lateral and medial of the adapter above the foot; the medial one only while standing."""
FOOT = ("RHEE", "RTOE")
"""Over the posterior and the anterior end of the keel; the toe, which bends, only while standing."""
STANDING = (*PELVIS, *THIGH, *KNEE, *SOCKET, *ANKLE, *FOOT)
WALKING = (*PELVIS, *THIGH, KNEE[0], *SOCKET, ANKLE[0], FOOT[0])
BODIES = {
    "pelvis": PELVIS,
    "thigh": (*THIGH, KNEE[0]),
    "shank": (*SOCKET, ANKLE[0], FOOT[0]),
}
"""Markers of a walking trial by the body they are fixed to."""
INTACT_THIGH = ("LTH1", "LTH2", "LTH3")
INTACT_KNEE = ("LKNE", "LKNM")
INTACT_SHANK = ("LSH1", "LSH2", "LSH3")
INTACT_ANKLE = ("LANK", "LANM")
"""Lateral and medial malleolus; the medial one only while standing."""
INTACT_FOOT = ("LHEE", "LMT1", "LMT5")
"""Back of the heel, over the heads of the first and the fifth metatarsal."""
INTACT_TOES = ("LHLX",)
"""Tip of the big toe."""
INTACT_BODIES = {
    "intact_thigh": (*INTACT_THIGH, INTACT_KNEE[0]),
    "intact_shank": (*INTACT_SHANK, INTACT_ANKLE[0]),
    "intact_foot": INTACT_FOOT,
    "intact_toes": INTACT_TOES,
}
"""Markers of the intact leg, a left one, that a moving trial has, by the body they are fixed to."""
INTACT_STANDING = (*INTACT_THIGH, *INTACT_KNEE, *INTACT_SHANK, *INTACT_ANKLE, *INTACT_FOOT, *INTACT_TOES)
MAP = "is `side` right? else name them with `markers_map`"


def mirrored_name(name: str) -> str:
    """The same marker on the other side: a first letter R becomes L and the other way round."""
    return {"R": "L", "L": "R"}.get(name[:1], name[:1]) + name[1:]
