"""`geocontact elbow`: constraint forces of an exoskeleton whose axis is not the joint's."""

from __future__ import annotations

from cyclopts import App

elbow = App(
    name="elbow",
    help="Constraint forces of an exoskeleton whose axis is not the joint's.",
)
elbow.command("geocontact.cli.elbow.simulate:simulate", name="simulate")
elbow.command("geocontact.cli.elbow.fit:fit", name="fit")
elbow.command("geocontact.cli.elbow.compare:compare", name="compare")
elbow.command("geocontact.cli.elbow.design:design", name="design")
elbow.command("geocontact.cli.elbow.population:population", name="population")
