"""`geocontact markers`."""

from __future__ import annotations

from geocontact.analyses.motion.virtual_markers.options import MarkersOptions
from geocontact.cli.command import Command

HELP = """Where the markers of a model are along a motion: virtual markers by forward kinematics.

Writes markers.trc [mm] and run.json into OUT.
"""

markers = Command("geocontact.analyses.motion.virtual_markers.result:virtual_markers", MarkersOptions, HELP)
