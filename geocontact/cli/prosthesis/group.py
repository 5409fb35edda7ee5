"""`geocontact prosthesis`: a below-knee prosthesis with a foot of variable stiffness."""

from __future__ import annotations

from cyclopts import App

prosthesis = App(
    name="prosthesis",
    help="Below-knee prosthesis with a variable-stiffness foot: scaled, calibrated, simulated, and which one for whom.",
)
prosthesis.command("geocontact.cli.prosthesis.calibrate:calibrate", name="calibrate")
prosthesis.command("geocontact.cli.prosthesis.compare:compare", name="compare")
prosthesis.command("geocontact.cli.prosthesis.design:design", name="design")
prosthesis.command("geocontact.cli.prosthesis.scale:scale", name="scale")
prosthesis.command("geocontact.cli.prosthesis.simulate:simulate", name="simulate")
