"""What the markers are called, on a right leg; those of a left one begin with L."""

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
MAP = "name them with `markers_map`"


def mirrored_name(name: str) -> str:
    """The same marker on the other side: a first letter R becomes L and the other way round."""
    return {"R": "L", "L": "R"}.get(name[:1], name[:1]) + name[1:]
