"""What runs of the command do on a machine where something is wrong: a table of faults, each in a process of its own.

`python -m benchmarks.robustness.faults` writes results/faults.json; with `--only` those that are run replace theirs.
Each fault has to end as it says: in one line with exit code 1 or 2 and nothing half-written, or with the same tables
as an undisturbed run. The full disk is a tmpfs of 256 kB, where this user may mount one.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from benchmarks.machine import write_results

ROOT = Path(__file__).resolve().parents[2]
MESHES = ROOT / "meshes"
PASSED_OVER = ("warning: ", "compiling the distance kernels")
"""Beginnings of lines on stderr that no failure says."""
Outcomes = dict[str, dict[str, object]]
FEW = 4096
"""Bytes that a file may have where files are limited."""


@dataclass(frozen=True)
class Fault:
    """What is wrong, and how a run is to end.

    Parameters
    ----------
    codes
        Exit codes that are right.
    same
        Whether the tables are those of an undisturbed run.
    said
        What stderr holds, in its only line where the code is not 0.
    environment
        Over that of this process.
    before
        Called in the child before the program starts.
    place
        Makes the folder of results in a scratch folder, and undoes it.
    """

    codes: tuple[int, ...] = (0,)
    same: bool = True
    said: str = ""
    environment: Mapping[str, str] = field(default_factory=dict)
    before: Callable[[], None] | None = None
    place: Callable[[Path], contextlib.AbstractContextManager[Path]] | None = None
    without: tuple[str, ...] = ()


@contextlib.contextmanager
def full_disk(scratch: Path) -> Iterator[Path]:
    """A tmpfs of 256 kB; PermissionError where none may be mounted."""
    place = scratch / "small"
    place.mkdir()
    mounted = ["mount", "-t", "tmpfs", "-o", "size=256k", "tmpfs", str(place)]
    if shutil.which("mount") is None or subprocess.run(mounted, check=False, capture_output=True).returncode != 0:
        raise PermissionError("no file system can be mounted here")
    try:
        yield place
    finally:
        subprocess.run(["umount", str(place)], check=True)


@contextlib.contextmanager
def read_only(scratch: Path) -> Iterator[Path]:
    """A folder on a file system that is mounted read-only; /proc, which takes no files, where none may be mounted."""
    place = scratch / "locked"
    place.mkdir()
    mounted = ["mount", "-t", "tmpfs", "-o", "ro,size=256k", "tmpfs", str(place)]
    if shutil.which("mount") is None or subprocess.run(mounted, check=False, capture_output=True).returncode != 0:
        yield Path("/proc")
        return
    try:
        yield place
    finally:
        subprocess.run(["umount", str(place)], check=True)


def limited_files() -> None:
    """No file beyond a few kB, and no signal for it: writing more fails as on a full disk."""
    import signal

    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (FEW, FEW))


FAULTS: dict[str, Fault] = {
    "nothing": Fault(),
    "the disk is full": Fault((1,), False, "No space left on device; nothing was written", place=full_disk),
    "files are limited": Fault((1,), False, "File too large; nothing was written", before=limited_files),
    "the folder is read-only": Fault((2,), False, "cannot be written to", place=read_only),
    "no display": Fault(environment={"DISPLAY": "", "WAYLAND_DISPLAY": "", "MPLBACKEND": ""}),
    "no home": Fault(environment={"HOME": "/proc/none", "XDG_CACHE_HOME": "/proc/none", "MPLCONFIGDIR": "/proc/none"}),
    "decimal commas": Fault(environment={"LC_ALL": "de_DE.UTF-8", "LC_NUMERIC": "de_DE.UTF-8", "LANG": "de_DE.UTF-8"}),
    "no locale": Fault(environment={"LC_ALL": "C", "LANG": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}),
    "another time zone": Fault(environment={"TZ": "Pacific/Apia"}),
    "another order of sets": Fault(environment={"PYTHONHASHSEED": "4711"}),
    "one thread": Fault(environment={"OMP_NUM_THREADS": "1", "NUMBA_NUM_THREADS": "1"}),
    "many threads": Fault(environment={"OMP_NUM_THREADS": "7", "NUMBA_NUM_THREADS": "2"}),
    "no pyvista": Fault(without=("pyvista", "vtk", "vtkmodules")),
    "no casadi, ezc3d, open3d": Fault(without=("casadi", "ezc3d", "open3d", "openpyxl")),
    "no distributed": Fault(without=("distributed", "dask")),
    "no compiled code can be kept": Fault(environment={"NUMBA_CACHE_DIR": "/proc/none"}),
    "no compiler": Fault(environment={"PATH": "/proc/none", "CC": "/proc/none"}),
}
"""By what is wrong; the run is a contact area of a ball on a plate with page, figure and Parquet."""


def command(scratch: Path, out: Path) -> list[str]:
    """A short contact area."""
    motion = scratch / "poses.csv"
    motion.write_text("time [s],tx [mm],ty [mm],tz [mm],qw,qx,qy,qz\n0,0,20,0,1,0,0,0\n0.5,1.5,19.75,0,1,0,0,0\n")
    bodies = [str(MESHES / "sphere_r20.stl"), str(MESHES / "plate_80x80x12.stl")]
    return ["area", *bodies, "--unit=mm", f"--motion={motion}", "--parquet", f"--out={out}"]


def started(fault: Fault, words: list[str], cwd: Path) -> subprocess.CompletedProcess[str]:
    """The program with that fault."""
    hidden = "".join(f"sys.modules[{name!r}] = None; " for name in fault.without)
    program = f"import sys; sys.path.insert(0, {str(ROOT)!r}); {hidden}from geocontact.cli.main import main; main()"
    environment = {**os.environ, **fault.environment}
    return subprocess.run(
        [sys.executable, "-B", "-c", program, *words],
        cwd=cwd,
        check=False,
        env=environment,
        preexec_fn=fault.before,
        capture_output=True,
        encoding="utf-8",
        errors="replace",
    )


def outcome(fault: Fault, scratch: Path, whole: dict[str, bytes]) -> dict[str, object]:
    """How a run ended, and whether that is right."""
    began = time.perf_counter()
    make = fault.place or (lambda folder: contextlib.nullcontext(folder))
    with make(scratch) as place:
        ended = started(fault, command(scratch, place / "out"), scratch)
        found = tables(place / "out")
        left = [file.name for file in place.iterdir() if file.name.startswith((".geocontact", "out"))]
    lines = [line for line in ended.stderr.splitlines() if not line.startswith(PASSED_OVER)]
    right = ended.returncode in fault.codes and fault.said in ended.stderr
    if fault.same:
        right = right and found == (whole or found) and bool(found) and "Traceback" not in ended.stderr
    else:
        right = right and len(lines) == 1 and not left
    said = " | ".join(lines)[:300].replace(str(scratch), "…")
    return {"right": right, "code": ended.returncode, "said": said, "seconds": round(time.perf_counter() - began, 1)}


def tables(folder: Path) -> dict[str, bytes]:
    """What has to be the same in every run: tables and their Parquet."""
    return {file.name: file.read_bytes() for file in sorted(folder.glob("*")) if file.suffix in (".csv", ".parquet")}


def run(names: list[str], tell: Callable[[Outcomes], None] = lambda _: None) -> Outcomes:
    """Outcomes of these faults, the undisturbed run first; those that this machine cannot have are told."""
    found: Outcomes = {}
    whole: dict[str, bytes] = {}
    for name in ["nothing", *(each for each in names if each != "nothing")]:
        with tempfile.TemporaryDirectory() as folder:
            scratch = Path(folder)
            try:
                found[name] = outcome(FAULTS[name], scratch, whole)
            except PermissionError as error:
                found[name] = {"right": None, "said": str(error)}
            whole = whole or tables(scratch / "out")
        print(name, found[name], flush=True)
        tell(found)
    return found


def main() -> None:
    """All faults."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--only", nargs="*", default=list(FAULTS))
    parser.add_argument("--dry", action="store_true", help="write no results")
    asked = parser.parse_args()

    file = ROOT / "benchmarks" / "results" / "faults.json"
    known: Outcomes = json.loads(file.read_text(encoding="utf-8"))["figures"] if file.is_file() else {}

    def tell(found: Outcomes) -> None:
        if not asked.dry:
            together = {name: one for name, one in {**known, **found}.items() if name in FAULTS}
            write_results("faults", {"anew": asked.only}, together, {"pyvista", "pyarrow", "matplotlib"})

    run(asked.only, tell)


if __name__ == "__main__":
    main()
