"""What faults do to a study of three steps: each ends in one line or is mended, and the tables are those of no fault.

`python -m benchmarks.robustness.chain_faults` writes results/chain_faults.json; with `--only` those that are run
replace theirs. The study is `benchmarks.study.leg_chain`. Faults of the machine meet a study that has no results yet;
then the fault is taken away and the same command is run again. Faults of what is kept meet a finished study: a file is
damaged, and the same command is run, in one process on a worker that stays. In the end all tables are equal, byte for
byte, to those of an undisturbed run, and no more was evaluated than the fault reaches.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import resource
import shutil
import signal
import subprocess
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from benchmarks.machine import write_results
from benchmarks.study.leg_chain import STEPS, Measured, made, measured, name, tables, typed_here
from geocontact.study.store import REPORT, RESULTS, WORK, Store

SUBJECTS = 2
FEW = 4096
"""Bytes that a file may have where files are limited."""
CLOCK = """import time
_time, _start = time.time, time.monotonic()
time.time = lambda: _time() - (3600.0 if time.monotonic() - _start > 3.0 else 0.0)
"""
"""A module that sets the clock of each process back by an hour, 3 s after it began."""
Outcomes = dict[str, dict[str, object]]
Typed = Callable[[Path, Path], Measured]
"""Runs the study of a file into a folder."""


@dataclass(frozen=True)
class Fault:
    """What is wrong, and how the study is to end.

    Parameters
    ----------
    new
        How many evaluations of each step the last run makes; None where the first run may have made some.
    damage
        Of a finished study, whose folder of results and whose own folder are given.
    machine
        Of the machine, while the first run lasts, on a folder without results.
    code
        Exit code of the first run under a fault of the machine.
    said
        What its lines hold.
    lines
        How many these are.
    """

    new: Mapping[str, int] | None = None
    damage: Callable[[Path, Path], None] | None = None
    machine: Callable[[Path], contextlib.AbstractContextManager[object]] | None = None
    code: int = 0
    said: str = ""
    lines: int = 1


def only(**new: int) -> dict[str, int]:
    """Counts of steps, 0 of those that are not named."""
    return {step: new.get(step, 0) for step in STEPS}


def kept(out: Path, step: str, subject: int = 0) -> Path:
    """Folder of one evaluation's results, as the study's table names it."""
    import pandas as pd

    rows = pd.read_csv(out / "trials.csv")
    (found,) = rows[(rows["step"] == step) & (rows["name"] == name(subject))]["folder"]
    return out / str(found)


def flipped(file: Path) -> None:
    """One bit of a digit in the middle of a file of text: it stays a number."""
    content = bytearray(file.read_bytes())
    at = next(k for k in range(len(content) // 2, len(content)) if chr(content[k]) in "23456789")
    content[at] ^= 1
    file.write_bytes(content)


def cut(file: Path) -> None:
    """What a lost end leaves."""
    file.write_bytes(file.read_bytes()[: file.stat().st_size // 2])


@contextlib.contextmanager
def full_disk(out: Path) -> Iterator[None]:
    """The results are on a tmpfs of 128 kB; PermissionError where none may be mounted."""
    with mounted(out, "size=128k"):
        yield


@contextlib.contextmanager
def read_only(out: Path) -> Iterator[None]:
    """The results are on a file system that is mounted read-only."""
    with mounted(out, "ro,size=128k"):
        yield


@contextlib.contextmanager
def mounted(out: Path, options: str) -> Iterator[None]:
    """A tmpfs at `out`; what was written there is kept when it goes."""
    out.mkdir()
    words = ["mount", "-t", "tmpfs", "-o", options, "tmpfs", str(out)]
    if shutil.which("mount") is None or subprocess.run(words, check=False, capture_output=True).returncode != 0:
        raise PermissionError("no file system can be mounted here")
    aside = out.with_name("aside")
    try:
        yield
        shutil.copytree(out, aside)
    finally:
        subprocess.run(["umount", str(out)], check=True)
    out.rmdir()
    aside.rename(out)


@contextlib.contextmanager
def limited_files(_: Path) -> Iterator[None]:
    """No file beyond a few kB for this process and those that it starts: writing more fails as on a full disk."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    heeds = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (FEW, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
        signal.signal(signal.SIGXFSZ, heeds)


@contextlib.contextmanager
def clock_set_back(out: Path) -> Iterator[None]:
    """Clocks of the study and its workers, which read it by Python, go back by an hour while it runs."""
    place = out.with_name("clock")
    place.mkdir()
    (place / "sitecustomize.py").write_text(CLOCK, encoding="utf-8")
    with environment({"PYTHONPATH": os.pathsep.join([str(place), os.environ.get("PYTHONPATH", "")])}):
        yield


@contextlib.contextmanager
def environment(over: Mapping[str, str]) -> Iterator[None]:
    """Variables of this process and those that it starts."""
    before = dict(os.environ)
    os.environ.update(over)
    try:
        yield
    finally:
        os.environ.clear()
        os.environ.update(before)


def other_times(out: Path, home: Path) -> None:
    """Inputs are newer than results, results older than 1990."""
    for file in (*home.glob("*.mot"), *out.rglob("*")):
        when = 2_000_000_000 if file.suffix == ".mot" and file.parent == home else 600_000_000
        os.utime(file, (when, when))


def left_by_a_kill(out: Path, _: Path) -> None:
    """What a killed run leaves: a draft, a note that a trial was begun, a lock that nobody holds, no joined tables."""
    store = Store(out / RESULTS)
    draft = store.folder / WORK / "0123456789abcdef" / "out"
    draft.mkdir(parents=True)
    (draft / REPORT).write_text("{", encoding="utf-8")
    for each in store.addresses()[:2]:
        (store.folder / WORK / f"fedcba9876543210-{each}").write_bytes(b"...")
    (store.folder / ".lock").write_text("process 1 on elsewhere", encoding="utf-8")
    shutil.rmtree(out / "tables")


def tables_damaged(out: Path, _: Path) -> None:
    """Tables of all trials are cut or gone."""
    for k, file in enumerate(sorted(file for file in (out / "tables").rglob("*") if file.is_file())):
        if k % 2:
            file.unlink()
        else:
            cut(file)


FAULTS: dict[str, Fault] = {
    "the disk is full": Fault(machine=full_disk, code=1, said="No space left on device"),
    "files are limited": Fault(machine=limited_files, code=1, said="File too large", lines=SUBJECTS + 1),
    "the folder is read-only": Fault(machine=read_only, code=2, said="cannot be written to"),
    "the clock is set back": Fault(only(), machine=clock_set_back),
    "a bit of an earlier step's file differs": Fault(only(ik=1), lambda o, _: flipped(kept(o, "ik") / "ik.mot")),
    "an earlier step's file is cut": Fault(only(markers=1), lambda o, _: cut(kept(o, "markers") / "markers.trc")),
    "an earlier step's file is removed": Fault(only(ik=1), lambda o, _: (kept(o, "ik") / "ik.mot").unlink()),
    "an earlier step's results are removed": Fault(only(markers=1), lambda o, _: shutil.rmtree(kept(o, "markers"))),
    "a last table is damaged": Fault(only(id=1), lambda o, _: cut(kept(o, "id") / "forces.parquet")),
    "trial.json is cut": Fault(only(ik=1), lambda o, _: cut(kept(o, "ik") / REPORT)),
    "run.json is cut": Fault(only(id=1), lambda o, _: cut(kept(o, "id") / "run.json")),
    "times of files are wrong": Fault(only(), other_times),
    "a killed run left drafts and a lock": Fault(only(), left_by_a_kill),
    "joined tables are damaged": Fault(only(), tables_damaged),
    "all of these of one subject": Fault(
        only(**dict.fromkeys(STEPS, 1)), lambda o, _: [cut(kept(o, step) / "run.json") for step in STEPS] and None
    ),
}
"""By what is wrong."""


def of_its_own(file: Path, out: Path) -> Measured:
    """A process of the command with one of a worker."""
    return measured(file, out, 1)


@contextlib.contextmanager
def on_one_worker() -> Iterator[Typed]:
    """The command in this process, on a worker that stays."""
    import distributed

    with distributed.LocalCluster(  # type: ignore[no-untyped-call]
        n_workers=1, threads_per_worker=1, processes=True, dashboard_address="127.0.0.1:0", silence_logs="CRITICAL"
    ) as cluster:
        yield lambda file, out: typed_here(file, out, cluster.scheduler_address)


def outcome(fault: Fault, finished: Path, scratch: Path, typed: Typed) -> dict[str, object]:
    """How the runs ended, and whether that is right; `finished` is the folder of an undisturbed study."""
    began, home, runs = time.perf_counter(), scratch / "study", list[Measured]()
    shutil.copytree(finished, home, ignore=shutil.ignore_patterns("out") if fault.machine else None)
    file, out = home / "study.toml", home / "out"
    if fault.machine is not None:
        with fault.machine(out):
            runs.append(of_its_own(file, out))
    if fault.damage is not None:
        fault.damage(out, home)
    runs.append(typed(file, out))
    last, said = runs[-1], " | ".join(words(runs[0].err)).replace(str(scratch), "…")
    right = {
        "same tables": tables(out) == tables(finished / "out"),
        "last code": last.code == 0,
        "evaluated": last.new == fault.new if fault.new is not None else 0 < last.all_new <= SUBJECTS * len(STEPS),
        "first code": len(runs) == 1 or runs[0].code == fault.code,
        "lines": fault.said in said and len(words(runs[0].err)) == (fault.lines if fault.code else 0),
    }
    wrong = [each for each, is_right in right.items() if not is_right]
    return {
        "right": not wrong,
        **({"wrong": wrong} if wrong else {}),
        "codes": [run.code for run in runs],
        "said": said[:300],
        "evaluated_in_the_last_run": last.new,
        "seconds": round(time.perf_counter() - began, 1),
    }


def words(err: str) -> list[str]:
    """Lines but for the progress and the warnings of an undisturbed run."""
    return [line for line in err.splitlines() if not line.startswith(("warning: ", "trials: "))]


def finished_study(folder: Path, typed: Typed) -> Path:
    """The folder of a study that nobody disturbed."""
    first = typed(made(folder, SUBJECTS), folder / "out")
    if first.code or first.new != only(**dict.fromkeys(STEPS, SUBJECTS)):
        raise RuntimeError(f"the study fails without a fault: {first}")
    return folder


def run(names: list[str], typed: Typed, tell: Callable[[Outcomes], None] = lambda _: None) -> Outcomes:
    """Outcomes of these faults."""
    found: Outcomes = {}
    with tempfile.TemporaryDirectory() as folder:
        finished = Path(folder, "finished")
        finished.mkdir()
        finished_study(finished, typed)
        for each in names:
            scratch = Path(folder, "fault")
            scratch.mkdir()
            try:
                found[each] = outcome(FAULTS[each], finished, scratch, typed)
            except PermissionError as error:
                found[each] = {"right": None, "said": str(error)}
            shutil.rmtree(scratch)
            print(each, found[each], flush=True)
            tell(found)
    return found


def main() -> None:
    """All faults."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--only", nargs="*", default=list(FAULTS))
    parser.add_argument("--dry", action="store_true", help="write no results")
    asked = parser.parse_args()
    file = Path(__file__).resolve().parents[1] / "results" / "chain_faults.json"

    def tell(found: Outcomes) -> None:
        if not asked.dry:
            known: Outcomes = json.loads(file.read_text(encoding="utf-8"))["figures"] if file.is_file() else {}
            merged = {**known, **found}
            together = {each: merged[each] for each in FAULTS if each in merged}
            write_results("chain_faults", {"anew": asked.only}, together, {"dask", "distributed", "pyarrow"})

    with on_one_worker() as typed:
        run(asked.only, typed, tell)


if __name__ == "__main__":
    main()
