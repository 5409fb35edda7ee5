"""`geocontact gap plant`: the options of the command; the work is in `gap_planting`."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

Flag = Parameter(negative="")


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class PlantOptions:
    """Options of planting as typed.

    Parameters
    ----------
    effect
        Name of the vocabulary, with its variant where there are several: damping, sensor_gain.force_x.
    out
        Folder for the results.
    value
        Of a parameter of the effect, SI unit, as often as there are: damping.b=25.
    size
        Gap that the effect makes where its amplitude is not given, root mean square over the noise floor, after the
        base parameters were refitted.
    trial
        For a mistake in the data: a trial that has it, as often as there are; all of them by default.
    bare
        Write no page and no figures.
    run_simulator
        Allow a case of the system "command" to run the program that it names.
    """

    effect: str
    out: Path
    value: tuple[str, ...] = ()
    size: float = 1.0
    trial: tuple[str, ...] = ()
    bare: Annotated[bool, Flag] = False
    run_simulator: Annotated[bool, Flag] = False


def plant(case: Path, /, *, options: PlantOptions) -> int:
    """Put a known effect into the measured trials of a case, diagnose it, and tell whether it was found.

    Writes case/ (the case with the effect in it), diagnosis/ (as `gap diagnose` does), planted.json and run.json into
    OUT. What the trials miss already stays in them.

    Parameters
    ----------
    case
        Folder with case.toml and trials, see docs/reference/gap_case.md.
    """
    from geocontact.analyses.gap.inject.run import planted  # numpy and friends: not for --help

    return planted(case, options)
