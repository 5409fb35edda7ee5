"""`geocontact elbow`: constraint forces of an exoskeleton whose axis is not the joint's."""

from __future__ import annotations

from cyclopts import App

elbow = App(
    name="elbow",
    help="Constraint forces of an exoskeleton whose axis is not the joint's: simulate, identify, compare, design.",
)
elbow.command("geocontact.cli.elbow_simulate:simulate", name="simulate")
elbow.command("geocontact.cli.elbow_fit:fit", name="fit")
elbow.command("geocontact.cli.elbow_compare:compare", name="compare")
elbow.command("geocontact.cli.elbow_design:design", name="design")
elbow.command("geocontact.cli.elbow_population:population", name="population")
