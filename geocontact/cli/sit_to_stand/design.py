"""`geocontact sit-to-stand design`."""

from __future__ import annotations

from geocontact.analyses.sit_to_stand.design.options import StandingDesignOptions
from geocontact.cli.command import Command

HELP = """Strap, place and help of an exoskeleton for which the strap presses least while the knee is relieved.

Writes designs.csv (without help, share alone, chosen), chosen.csv, sensitivity.csv (how the least force changes with
what is held), certificate.csv, numbers.csv and mesh.csv (all that ran), front.csv and draws.csv where asked for, a
trajectory for OpenSim's Moco for each trial, a figure, report.html and run.json into OUT.
"""

design = Command("geocontact.analyses.sit_to_stand.design.result:design", StandingDesignOptions, HELP)
