"""What a diagnosis may be asked for."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from typing import Annotated, ClassVar

from geocontact.analyses.frame.marks import CaseFolder, Requires
from geocontact.analyses.frame.options import Options
from geocontact.data.errors import InputError


@dataclass(frozen=True)
class DiagnoseOptions(Options):
    """Diagnose a gap case: which effect the model lacks, where it shows, how far the gap shrinks with it.

    Parameters
    ----------
    case
        Folder with case.toml and trials, see docs/reference/gap_case.md.
    bare
        Write tables, diagnosis.json and run.json only: no page, no figures.
    run_simulator
        Allow a case of the system "command" to run the program that it names.
    """

    over_time: ClassVar[bool] = True
    writes: ClassVar[str] = """
    Writes diagnosis.json, report.html, gap_map.csv, budget.csv, ranking.csv, held_out.csv, trials.csv where something
    is named, figures (.png, .svg) and run.json into OUT. With `many` a case that cannot be used is one line on stderr
    and exit 2; the others are diagnosed all the same.
    """

    case: CaseFolder
    _: KW_ONLY
    bare: bool = False
    run_simulator: bool = False

    def programs(self) -> tuple[str, ...]:
        """The program or the module that the case names."""
        from geocontact.analyses.gap.case import programs_of

        return programs_of(self.case)


@dataclass(frozen=True)
class ManyOptions(DiagnoseOptions):
    """Diagnose a gap case: which effect the model lacks, where it shows, how far the gap shrinks with it.

    With `many`, every case in a folder, each by itself.

    Parameters
    ----------
    case
        Folder with case.toml and trials, see docs/reference/gap_case.md.
    many
        `case` is a folder of cases: every sub-folder with a case.toml is diagnosed into a sub-folder of its name.
    bare
        Write tables, diagnosis.json and run.json only: no page, no figures.
    resume
        With `many`, keep what an earlier run into `out` had finished, where case, options and version are the same.
    workers
        Processes with `many`; as many as there are cores by default. Results do not depend on it.
    run_simulator
        Allow a case of the system "command" to run the program that it names.
    """

    _: KW_ONLY
    many: bool = False
    resume: Annotated[bool, Requires("many")] = False
    workers: Annotated[int | None, Requires("many")] = None

    def refuse_impossible(self) -> None:
        """No process at all."""
        if self.workers is not None and self.workers < 1:
            raise InputError("", "`workers`", f"{self.workers} is less than one process", "give 1 or more")

    def programs(self) -> tuple[str, ...]:
        """The same of all cases of a folder with `many`."""
        from geocontact.analyses.gap.case import programs_of

        try:
            folders = sorted(each.parent for each in self.case.glob("*/case.toml")) if self.many else [self.case]
        except OSError:
            return ()
        return tuple(line for folder in folders for line in programs_of(folder))
