"""`geocontact knee`: a knee implant under load."""

from __future__ import annotations

from cyclopts import App

knee = App(name="knee", help="Knee implant under load: where it comes to rest, pressures and forces of its sides.")
knee.command("geocontact.cli.knee.settle:settle", name="settle")
