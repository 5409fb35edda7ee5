"""`geocontact prosthesis`: a below-knee prosthesis with a variable-stiffness foot."""

from __future__ import annotations

from cyclopts import App

prosthesis = App(
    name="prosthesis",
    help="Below-knee prosthesis with a variable-stiffness foot: its sole calibrated on recorded stances.",
)
prosthesis.command("geocontact.cli.prosthesis.calibrate:calibrate", name="calibrate")
