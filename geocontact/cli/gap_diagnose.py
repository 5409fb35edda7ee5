"""`geocontact gap diagnose`: the options of the command; the work is in `gap_analysis`."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

Flag = Parameter(negative="")


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class DiagnoseOptions:
    """Options of a diagnosis as typed.

    Parameters
    ----------
    out
        Folder for the results.
    many
        CASE is a folder of cases: every sub-folder with a case.toml is diagnosed, results in OUT/<case>.
    bare
        Write tables, diagnosis.json and run.json only: no page, no figures.
    workers
        Processes with --many; as many as there are cores by default. Results do not depend on it.
    run_simulator
        Allow a case of the system "command" to run the program that it names.
    """

    out: Path
    many: Annotated[bool, Flag] = False
    bare: Annotated[bool, Flag] = False
    workers: int | None = None
    run_simulator: Annotated[bool, Flag] = False


def diagnose(case: Path, /, *, options: DiagnoseOptions) -> int:
    """Diagnose a gap case: which effect the model lacks, where it shows, how far the gap shrinks with it.

    Writes diagnosis.json, report.html, gap_map.csv, ranking.csv, held_out.csv, trials.csv where something is named,
    figures (.png, .svg) and run.json into OUT. With --many a case that cannot be used is one line on stderr and exit 2;
    the others are diagnosed all the same.

    Parameters
    ----------
    case
        Folder with case.toml and trials, see docs/reference/gap_case.md.
    """
    if options.many:
        from geocontact.analyses.gap.diagnose.many import diagnose_many

        return diagnose_many(case, options)
    from geocontact.analyses.gap.diagnose.run import diagnose_one  # numpy and friends: not for --help

    return diagnose_one(case, options)
