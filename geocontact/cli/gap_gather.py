"""`geocontact gap gather`: the options of the command; the work is in `gap_gathered`."""

from __future__ import annotations

from pathlib import Path


def gather(settings: Path, /, *, out: Path) -> int:
    """Make a gap case of recordings whose outputs are pressure mats on a body surface.

    Writes case.toml, trials/<id>.csv with a channel <site>_force, trials/<id>_<site>_cells.csv, <site>_layout.csv, the
    tables that SETTINGS names, and run.json into OUT, ready for `geocontact gap diagnose OUT`.

    Parameters
    ----------
    settings
        A case.toml with a table [from.<trial>] for each trial: inputs = "inputs.csv" (time and input channels) and
        <site> = "folder" that `geocontact mat --out` wrote, for each site.
    out
        Folder for the case.
    """
    from geocontact.cli.gap_gathered import gathered  # numpy and friends: not for --help

    return gathered(settings, out)
