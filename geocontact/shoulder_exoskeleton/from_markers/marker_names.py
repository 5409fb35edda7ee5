"""What the markers are called: those of the exoskeleton's paper, and those of Vicon's Plug-in Gait for people."""

from __future__ import annotations

from geocontact.shoulder_exoskeleton.arm_motion import Side

MIDDLE, LEFT_OF_MIDDLE, T10 = "Lucy_MC", "Lucy_Mleft", "T10"
"""Reference markers of the device's frame; Yao et al. (2024), Robotics 13:27, fig. 3."""
UPPER: dict[Side, str] = {"right": "humerus_rup", "left": "humerus_lup"}
LOWER: dict[Side, str] = {"right": "humerus_rdn", "left": "humerus_ldn"}
"""Of the upper arms; the lower one is the centre of the sphere in the cuff."""
SHOULDER: dict[Side, str] = {"right": "RSHO", "left": "LSHO"}
ELBOW: dict[Side, str] = {"right": "RELB", "left": "LELB"}
WRIST: dict[Side, str] = {"right": "RWRI", "left": "LWRI"}
FINGER: dict[Side, str] = {"right": "RFIN", "left": "LFIN"}
C7, STERNUM, CLAVICLES, T8 = "C7", "STRN", "CLAV", "T8"
PELVIS = ("RASI", "LASI", "RPSI", "LPSI")
"""Of people, with or without the device; T8 in place of T10 as the ISB's thorax has it (Wu et al. 2005)."""
