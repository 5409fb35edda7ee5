"""`geocontact elbow`: constraint forces of an exoskeleton whose axis is not the joint's."""

from __future__ import annotations

from cyclopts import App

HELP = """Constraint forces of an exoskeleton whose axis is not the joint's.

* simulate: synthetic recordings after the paper's experiment, or the ideal force along recorded angles.
* fit: stiffness, link and offsets from force and angle, and what these recordings cannot tell.
* compare: a fitted law or a simulation beside recordings.
* design: offsets and strokes of a compensation joint that keep the force under a limit.
* population: how the largest force spreads over people whose offsets differ.
"""

elbow = App(
    name="elbow",
    help=HELP,
)
elbow.command("geocontact.cli.elbow.simulate:simulate", name="simulate")
elbow.command("geocontact.cli.elbow.fit:fit", name="fit")
elbow.command("geocontact.cli.elbow.compare:compare", name="compare")
elbow.command("geocontact.cli.elbow.design:design", name="design")
elbow.command("geocontact.cli.elbow.population:population", name="population")
