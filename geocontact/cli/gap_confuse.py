"""`geocontact gap confuse`: the options of the command; the work is in `gap_confusion`."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

Flag = Parameter(negative="")


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class ConfuseOptions:
    """Options as typed.

    Parameters
    ----------
    out
        Folder for the results.
    effects
        Effects asked about, by name ("damping,time_shift") or candidate ("end_stop.upper"); all by default. Mistakes
        in the data have no size: of them only is told whether base parameters hide them.
    nats
        How visible each effect is taken to be when it is held against the others.
    bare
        Write tables, confuse.json and run.json only: no page, no figures.
    run_simulator
        Allow a case of the system "command" to run the program that it names.
    """

    out: Path
    effects: str | None = None
    nats: float = 50.0
    bare: Annotated[bool, Flag] = False
    run_simulator: Annotated[bool, Flag] = False


def confuse(case: Path, /, *, options: ConfuseOptions) -> int:
    """What the trials of a case can tell: which effects they would show, from which size on, and which look alike.

    Writes confuse.json, separability.csv, detectability.csv, report.html, figures (.png, .svg) and run.json into OUT.

    Parameters
    ----------
    case
        Folder with case.toml and trials, see docs/reference/gap_case.md.
    """
    from geocontact.analyses.gap.discriminability.run import confused  # numpy and friends: not for --help

    return confused(case, options)
