"""`geocontact rerun run.json`: run again as recorded, and say what differs."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

from geocontact.analyses.frame.consent import ALLOWED, require_consent
from geocontact.analyses.frame.rerun import EarlierRun, differing, read_run, results_of
from geocontact.analyses.frame.table_forms import TableForms
from geocontact.cli.command import Command
from geocontact.cli.main import app
from geocontact.cli.suggestions import commands
from geocontact.data.errors import InputError
from geocontact.data.version import VERSION

DIFFERENT = 1


def rerun(run: Path, *, out: Path | None = None, run_simulator: bool = False) -> int:
    """Repeat a run from its run.json and compare the results.

    File names start from the present folder, as they did at first. Exit 1 when a file of the results differs.

    Parameters
    ----------
    run
        A run.json, or the folder that it is in.
    out
        Folder for the new results; without it they are only compared, not saved.
    run_simulator
        Start programs and modules that the case of that run names; whatever run.json says, nothing is started without.
    """
    earlier = read_run(run)
    command = _command(earlier, run)
    print(f"geocontact {earlier.command}, {len(earlier.inputs)} inputs, of geocontact {earlier.version}", end="")
    print("" if earlier.version == VERSION else f"; this is {VERSION}")
    changed = earlier.changed()
    for file in changed:
        print(f"input has changed: {file}")
    if earlier.inputs and not changed:
        print("the inputs are the same")
    before = results_of(earlier.folder)
    if out is not None and out.resolve() == earlier.folder.resolve():
        raise InputError(out, "", "holds the results to compare with", "choose another --out, or none")
    with TemporaryDirectory() as scratch:
        folder = out or Path(scratch) / "results"
        parquet, netcdf = (any(name.endswith(ending) for name in before) for ending in (".parquet", ".nc"))
        forms = TableForms(parquet, netcdf, bool(earlier.options.get("excel_safe")))
        with command.respelling():
            typed = {**earlier.options, "out": folder} if earlier.typed else earlier.options
            given = command.in_si(typed) if earlier.typed else earlier.in_si()
            given |= {ALLOWED: run_simulator} if given.get(ALLOWED) else {}
            if named := require_consent(command.options(**given).programs(), run_simulator, run):
                print(named)
            command.execute_in_si(given, typed, folder, forms)
        after = results_of(folder)
        different = differing(before, after, earlier.folder, folder)
    return _report_differences(before, after, different, out)


def _command(earlier: EarlierRun, run: Path) -> Command:
    group = app
    for word in earlier.command.split():
        if word not in commands(group):
            raise InputError(run, "", f"'{earlier.command}' is not a command here", "is it of a newer version?")
        group = group[word]
    found = group.default_command
    if not isinstance(found, Command):
        raise InputError(run, "", f"'{earlier.command}' is not an analysis", "name the run.json of one")
    return found


def _report_differences(before: dict[str, str], after: dict[str, str], different: list[str], out: Path | None) -> int:
    """Say which files differ; the exit code."""
    names = {*before, *after}
    for name in different:
        how = "is new" if name not in before else "is missing now" if name not in after else "differs"
        print(f"{name} {how}")
    same = len(names) - len(different)
    print(f"{same} of {len(names)} files of the results are equal" + ("" if out is None else f"; new ones in {out}"))
    return DIFFERENT if different or not names else 0
