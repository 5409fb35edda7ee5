"""A chained study of real analyses that takes little: coordinates of a leg → markers → angles → joint moments.

Each subject is one file, `S0000.mot`: the shipped swing of a leg at 25 Hz, its angles times a factor of that subject.
`markers` puts the virtual markers of `leg.osim` along it, `ik` finds the angles again, `id` the moments. The subjects
are synthetic. Benchmarks and tests of chained studies share it.
"""

from __future__ import annotations

import json
import re
import resource
import shutil
import subprocess
import sys
import time
from collections.abc import Sequence
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass
from io import StringIO
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
MESHES = ROOT / "meshes"
MODEL = "leg.osim"
STEPS = {"markers": "markers", "ik": "ik", "id": "id"}
"""Analyses by the name of their step, in their order."""
EVERY = 4
"""Frames of the shipped swing, of 100 Hz, of which one is kept."""
TURNED = ("tilt", "hip_x", "hip_y", "hip_z", "knee", "ankle")
STUDY = """title = "Moments of a leg's swing"
files = "{subject}.mot"
analysis = "id"
pages = false
figures = false
options = { coordinates = "{ik:ik.mot}", model = "leg.osim" }

[steps.markers]
analysis = "markers"
options = { coordinates = "{file}", model = "leg.osim" }

[steps.ik]
analysis = "ik"
options = { markers = "{markers:markers.trc}", model = "leg.osim" }
"""


def made(folder: Path, subjects: int, more: str = "") -> Path:
    """The study of so many subjects in a folder, `more` after its description."""
    shutil.copy(MESHES / MODEL, folder)
    for k in range(subjects):
        swing(folder / f"{name(k)}.mot", factor(k))
    file = folder / "study.toml"
    file.write_text(STUDY + more, encoding="utf-8")
    return file


def name(subject: int) -> str:
    """Of a subject."""
    return f"S{subject:04d}"


def factor(subject: int) -> float:
    """What a subject's angles are multiplied with: no two of 500 have the same."""
    return 0.6 + 0.001 * subject


def swing(file: Path, times: float) -> None:
    """The shipped swing at 25 Hz, its angles multiplied."""
    text = (MESHES / "leg_swing.mot").read_text(encoding="utf-8").splitlines()
    at = text.index("endheader")
    names = text[at + 1].split("\t")
    rows = [
        "\t".join(
            f"{times * float(cell):.9f}" if column in TURNED else cell
            for column, cell in zip(names, row.split("\t"), strict=True)
        )
        for row in text[at + 2 :: EVERY]
    ]
    head = [re.sub("nRows=.*", f"nRows={len(rows)}", line) for line in text[: at + 2]]
    file.write_text("\n".join([*head, *rows]) + "\n", encoding="utf-8")


def command(file: Path, out: Path, workers: int = 2, more: Sequence[str] = ()) -> list[str]:
    """The study as it is typed."""
    return [sys.executable, str(ROOT / "cli.py"), "cohort", str(file), "--out", str(out), f"--workers={workers}", *more]


@dataclass(frozen=True)
class Measured:
    """One run: wall and CPU time with that of its workers, how many evaluations of each step were new, its code."""

    seconds: float
    cpu_seconds: float
    new: dict[str, int]
    code: int
    err: str

    @property
    def all_new(self) -> int:
        """Of all steps."""
        return sum(self.new.values())


def measured(file: Path, out: Path, workers: int = 2, more: Sequence[str] = ()) -> Measured:
    """Run the study; CPU time is that of all processes that it started and ended."""
    before, started = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    done = subprocess.run(command(file, out, workers, more), cwd=ROOT, check=False, capture_output=True, text=True)
    after, whole = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter() - started
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return Measured(whole, cpu, new_of(done.stdout), done.returncode, done.stderr)


def new_of(told: str) -> dict[str, int]:
    """How many evaluations of each step were new, as a run says."""
    found = re.findall(r"\d+ of \d+ trials? of (\w+) have results, (\d+) of them new", told)
    return {step: int(count) for step, count in found}


def typed_here(file: Path, out: Path, scheduler: str) -> Measured:
    """The same command in this process, on workers that are there."""
    from geocontact.cli.main import run

    said, err, started = StringIO(), StringIO(), (time.perf_counter(), time.process_time())
    with redirect_stdout(said), redirect_stderr(err):
        code = run(["cohort", str(file), "--out", str(out), "--scheduler", scheduler])
    spent = time.perf_counter() - started[0], time.process_time() - started[1]
    return Measured(*spent, new_of(said.getvalue()), code, err.getvalue())


def work_of(out: Path) -> tuple[float, float]:
    """Seconds from the first evaluation given out to the last one back, and those of all evaluations together."""
    found = json.loads((out / "run.json").read_text(encoding="utf-8"))["results"]
    return found["work"]["seconds"], found["one_by_one"]["seconds"]


def tables(out: Path) -> dict[str, bytes]:
    """Content of all tables of the study and of its manifest, by path."""
    files = [file for file in [*sorted((out / "tables").rglob("*")), *sorted(out.glob("*.csv"))] if file.is_file()]
    return {file.relative_to(out).as_posix(): file.read_bytes() for file in files}
