"""`geocontact gap gather`: the options of the command; the work is in `gap_gathered`."""

from __future__ import annotations

from pathlib import Path


def gather(settings: Path, /, *, out: Path) -> int:
    """Make a gap case of recordings: pressure mats on a body surface, force plates under a foot, loads of a knee.

    Writes case.toml, trials/<id>.csv, for mats trials/<id>_<site>_cells.csv and <site>_layout.csv, the tables that
    SETTINGS names, and run.json into OUT, ready for `geocontact gap diagnose OUT`.

    Parameters
    ----------
    settings
        A case.toml with a table [from.<trial>] for each trial: inputs = "inputs.csv" (time and input channels) and
        what was measured beside them: <site> = "folder" that `geocontact mat --out` wrote, for each site;
        plates = "grf.mot" with plate = "name", for a foot; forces = "forces.csv" and areas = "area.csv", for a knee.
    out
        Folder for the case.
    """
    from geocontact.analyses.gap.gather.run import gathered  # numpy and friends: not for --help

    return gathered(settings, out)
