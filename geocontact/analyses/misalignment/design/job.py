"""Offsets and strokes that keep a force under a limit: `geocontact elbow design`, `gc.misalignment.design`.

>>> import geocontact as gc
>>> link = {"k": 222.43, "l": gc.mm(169), "z": gc.mm(127)}
>>> asked = {"range": gc.deg(0, 120), "limit": 5.0, "stroke": gc.mm(0, 60), "step": gc.mm(4)}
>>> result = gc.misalignment.design(**link, offset=gc.mm(48, 59), **asked)
>>> result
stroke 0 … 60 mm, x = 48 mm, y = 59 mm: |F| up to 8.64 N exceeds the limit of 5 N
offsets within 0 mm: a stroke from -16.35 mm or less to 61.81 mm or more keeps the limit: the lower end must
be decreased by 16.35 mm and the upper end must be increased by 1.81 mm
"""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.misalignment.design.designed import read
from geocontact.analyses.misalignment.design.options import DesignOptions
from geocontact.analyses.misalignment.design.result import run

design = Job("elbow design", DesignOptions, read, run)
