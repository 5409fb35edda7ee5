"""`geocontact prosthesis design`."""

from __future__ import annotations

from geocontact.analyses.prosthesis.design.options import ProsthesisDesignOptions
from geocontact.cli.command import Command

HELP = """Fulcrum, alignment or stiffness of a prosthetic foot that suits a person best, and whether that can be told.

Writes answers.csv (best value and interval for every aim), sweep.csv (outcomes with bands, angles or torques kept),
ranges.csv (between which ends each outcome lies), shapes.csv (roll-over shapes, ankle moment, energy), with --intact
intact.csv (what a step of the intact foot has), numbers.csv (leg and foot as the trial is read with them), a figure,
report.html and run.json into OUT.
"""

design = Command("geocontact.analyses.prosthesis.design.result:design", ProsthesisDesignOptions, HELP)
