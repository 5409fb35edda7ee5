"""`geocontact modulus`."""

from __future__ import annotations

from geocontact.analyses.modulus.options import ModulusOptions
from geocontact.cli.command import Command

HELP = """Elastic modulus E* of a contact from the evolution of its area and measured forces, with intervals.

Writes modulus.json, curves.csv, sensitivity.csv, modulus.png, modulus.svg, report.html and run.json into OUT, and
prediction.csv with `predict_area`. Area and force give one number, E* = E/(1 - nu^2): E is told for a stated nu.
"""

modulus = Command("geocontact.analyses.modulus.result:modulus", ModulusOptions, HELP)
