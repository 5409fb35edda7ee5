"""`geocontact shoulder`: an exoskeleton that supports raised arms, driven by human motion."""

from __future__ import annotations

from cyclopts import App

shoulder = App(
    name="shoulder",
    help="Shoulder exoskeleton driven by human motion: its arms, forces in its cuffs, support.",
)
shoulder.command("geocontact.cli.shoulder.simulate:simulate", name="simulate")
shoulder.command("geocontact.cli.shoulder.compare:compare", name="compare")
shoulder.command("geocontact.cli.shoulder.study:study", name="study")
shoulder.command("geocontact.cli.shoulder.optimise:optimise", name="optimise")
