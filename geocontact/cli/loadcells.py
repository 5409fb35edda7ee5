"""`geocontact loadcells`."""

from __future__ import annotations

from geocontact.analyses.loadcells.options import LoadcellOptions
from geocontact.cli.command import Command

HELP = """Medial and lateral contact force of a tibial tray from its load cells, and their mean over cycles.

Writes forces.csv, loadcells.png, loadcells.svg, report.html and run.json into OUT; with `cycles` also cycles.csv,
ensemble.csv, ensemble.png, ensemble.svg, and styles.csv where there are several gait styles.
"""

loadcells = Command("geocontact.analyses.loadcells.result:load_cells", LoadcellOptions, HELP)
