"""Install a wheel into an environment of its own and use it there, with and without each of its extras.

`python .ci/try_wheel.py WHEEL` makes a virtual environment outside of the checkout, installs the wheel at the pinned
versions of requirements.lock, and runs commands on the files that the wheel brings and on what they write. Then each
extra in turn: before it is installed its commands say in one line what to install, afterwards they work; what came with
it is removed before the next one. At last pip is asked whether all of them go together. `--extras view,excel` tries
these only, `--folder DIR` keeps everything in DIR.
"""

from __future__ import annotations

import argparse
import os
import runpy
import subprocess
import sys
import tempfile
import time
import venv
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
from core_lock import pins

ROOT = Path(__file__).resolve().parents[1]
LEGS = "{m}/amputee_P1"
DEVICE = "{m}/standing_up_exoskeleton/unloaded"
KNEE = "{m}/femoral_component_right_coarse.stl {m}/tibial_insert_right_coarse.stl --unit mm"
THIGH = "mat {m}/mat_thigh_16x8/frames.csv --layout {m}/mat_thigh_16x8/layout.toml --surface {m}/thigh.stl --unit mm"
LANDMARKS = "--landmarks {m}/mat_thigh_16x8/landmarks.csv --cutoff 0"
SEGMENTS = "--axis --first femur_r0,femur_r1,femur_r2 --second tibia_r0,tibia_r1,tibia_r2"
CORE = (
    "--version",
    "doctor",
    "demo",
    "rerun demo-result/run.json",
    f"area {KNEE} --motion two.csv --pressure --modulus 500MPa --poisson 0.46 --netcdf --out area",
    "fit {m}/femoral_component_right_coarse.stl --shape cylinder --unit mm --out fit",
    "markers {m}/leg_swing.mot --model {m}/leg.osim --out markers",
    f"joint markers/markers.trc {SEGMENTS} --out joint",
    f"{THIGH} {LANDMARKS} --out mat",
    "elbow simulate --seconds 20 --rate 50 --noise 0.2 --trials 4 --case --out elbow",
    "elbow fit elbow/locked_1.csv elbow/locked_2.csv --known l=169,z=127 --bootstrap 0 --out elbow_fit",
    "gap diagnose elbow/case --bare --out gap",
)
"""What works without any extra; `{m}` is the folder of the sample files in the wheel."""
STUDY = """\
analysis = "area"
[options]
moving = "{m}/femoral_component_right_coarse.stl"
fixed = "{m}/tibial_insert_right_coarse.stl"
unit = "mm"
motion = "two.csv"
[sweep]
threshold = [2, 4]
"""
PREPARE = """\
import pathlib, sys
from geocontact.cli.demo import sample_folder
m = sample_folder()
lines = (m / "gait.csv").read_text("utf-8").splitlines()
pathlib.Path("two.csv").write_text("\\n".join(lines[:3]) + "\\n", "utf-8")
pathlib.Path("study.toml").write_text(sys.argv[1].replace("{m}", m.as_posix()), "utf-8")
rows = [line.split(",") for line in (m / "mat_thigh_16x8/landmarks.csv").read_text("utf-8").splitlines()[1:] if line]
head = "id, x [mm], y [mm], z [mm], body_x [mm], body_y [mm], body_z [mm]"
pathlib.Path("pairs.csv").write_text("\\n".join([head, *(",".join([r[0], *r[3:6], *r[3:6]]) for r in rows)]), "utf-8")
print(m)
"""
WORKBOOK = """\
import pandas as pd
table = pd.read_csv("two.csv", skipinitialspace=True)
table.to_excel("two.xlsx", index=False)
"""
RECORDING = """\
import ezc3d, numpy as np, re
lines = open("markers/markers.trc", encoding="utf-8").read().splitlines()
names = [n for n in lines[3].split("\\t")[2:] if n]
values = np.array([[float(x) for x in line.split("\\t")[2:] if x] for line in lines[5:] if line.strip()])
rate = float(lines[2].split("\\t")[0])
c = ezc3d.c3d()
c["parameters"]["POINT"]["RATE"]["value"] = [rate]
c["parameters"]["POINT"]["UNITS"]["value"] = ["mm"]
c["parameters"]["POINT"]["LABELS"]["value"] = names
points = np.ones((4, len(names), len(values)))
points[:3] = values.reshape(len(values), -1, 3).transpose(2, 1, 0)
c["data"]["points"] = points
c.write("walk.c3d")
"""


MUSCULAR = """\
import pathlib
from geocontact.cli.demo import sample_folder
place = "<socket_parent_frame>/bodyset/{0}</socket_parent_frame><location>{1}</location>"
point = f"<PathPoint name='{{0}}'>{place}</PathPoint>"
path = point.format("femur_r", "0.05 -0.1 0") + point.format("tibia_r", "0.05 -0.05 0")
muscle = "<Thelen2003Muscle name='extensor'><max_isometric_force>5000</max_isometric_force><GeometryPath><PathPointSet>"
muscle += f"<objects>{path}</objects></PathPointSet></GeometryPath></Thelen2003Muscle>"
model = (sample_folder() / "leg.osim").read_text("utf-8")
model = model.replace("</Model>", f"<ForceSet><objects>{muscle}</objects></ForceSet></Model>")
pathlib.Path("muscular.osim").write_text(model, "utf-8")
"""


BALL = runpy.run_path(str(ROOT / "tests" / "step_files.py"))["sphere"](20.0, "mm")
BEGINNINGS = {".c3d": b"\x02P" + bytes(1022), ".xlsx": b"PK\x03\x04", ".osim": b"<?xml", ".step": BALL.encode()}
"""What files begin with that are to look like one before the extra can make them; a text needs none."""


@dataclass(frozen=True)
class Extra:
    """What an extra is for.

    Parameters
    ----------
    command
        Needs it.
    refused
        Stands in the one line that the command says without it.
    prepare, input
        Script that makes the command's input with the extra, and the file that it makes.
    more
        Commands that are run after it.
    serves
        Whether the command prints an address and lasts until it is ended.
    """

    command: str
    refused: str
    prepare: str = ""
    input: str = ""
    more: tuple[str, ...] = ()
    serves: bool = False


EXTRAS = {
    "view": Extra(f"area {KNEE} --motion two.csv --paraview --out view", "geocontact[view]"),
    "scan": Extra(
        f"{THIGH} {LANDMARKS} --body-landmarks pairs.csv --body {{m}}/thigh.stl --body-unit mm --icp"
        " --icp-engine open3d --out scan",
        "open3d",
    ),
    "dynamics": Extra(
        "ik markers/markers.trc --model {m}/leg.osim --out ik",
        "geocontact[dynamics]",
        more=(
            "id ik/ik.mot --model {m}/leg.osim --out id",
            f"prosthesis scale {LEGS}/standing.trc --functional {LEGS}/functional.trc --mass 77.3 --out amputee",
            f"sit-to-stand device {DEVICE}_coordinates.sto --motors {DEVICE}_motors.sto --out device",
        ),
    ),
    "mocap": Extra(f"joint walk.c3d {SEGMENTS} --out c3d", "geocontact[mocap]", RECORDING, "walk.c3d"),
    "excel": Extra(f"area {KNEE} --motion two.xlsx --out excel", "openpyxl", WORKBOOK, "two.xlsx"),
    "cohort": Extra("cohort study.toml --workers 1 --out study", "geocontact[cohort]"),
    "parquet": Extra(f"area {KNEE} --motion two.csv --parquet --out parquet", "geocontact[parquet]"),
    "step": Extra("fit ball.step --shape sphere --unit mm --out step", "geocontact[step]", input="ball.step"),
    "app": Extra("app --no-browser --out window", "geocontact[app]", serves=True),
    "muscles": Extra(
        "id {m}/leg_swing.mot --model muscular.osim --muscles --across tibia_r --out muscles",
        "geocontact[muscles]",
        MUSCULAR,
        "muscular.osim",
    ),
}


class Environment:
    """A virtual environment that sees nothing of the checkout, and a folder in which its commands run."""

    def __init__(self, folder: Path) -> None:
        self.work = folder / "work"
        self.work.mkdir(parents=True)
        venv.create(folder / "environment", with_pip=True)
        self.bin = folder / "environment" / ("Scripts" if os.name == "nt" else "bin")
        self.pins = folder / "pins.txt"
        self.pins.write_text(pins((ROOT / "requirements.lock").read_text(encoding="utf-8")), encoding="utf-8")
        hidden = ("PYTHONPATH", "PYTHONHOME", "GEOCONTACT_UNCHECKED", "NUMBA_CACHE_DIR")
        self.variables = {name: value for name, value in os.environ.items() if name not in hidden}

    def run(self, program: str, *words: str) -> subprocess.CompletedProcess[str]:
        """One of its programs, in the working folder."""
        command = [str(self.bin / program), *words]
        return subprocess.run(command, check=False, cwd=self.work, env=self.variables, capture_output=True, text=True)

    def must(self, program: str, *words: str) -> str:
        """What it prints; the end where it fails."""
        done = self.run(program, *words)
        if done.returncode:
            sys.exit(f"{program} {' '.join(words)[:300]}: exit code {done.returncode}\n{done.stdout}{done.stderr}")
        return done.stdout

    def served(self, *words: str) -> str:
        """What a command that lasts prints first; it is ended then."""
        command = [str(self.bin / "geocontact"), *words]
        with subprocess.Popen(command, cwd=self.work, env=self.variables, stdout=subprocess.PIPE, text=True) as process:
            line = process.stdout.readline() if process.stdout else ""
            process.terminate()
        return line if line.startswith("http://127.0.0.1:") else sys.exit(f"geocontact {' '.join(words)}: {line!r}")

    def install(self, what: str, *options: str) -> None:
        """At the versions of the lock."""
        pip = ("python", "-m", "pip", "install", "--quiet", "--no-input", "--constraint", str(self.pins))
        self.must(*pip, *options, what)

    def packages(self) -> set[str]:
        """Names of what is installed."""
        listed = self.must("python", "-m", "pip", "list", "--format", "freeze", "--disable-pip-version-check")
        return {line.partition("==")[0] for line in listed.splitlines()}

    def remove(self, names: set[str]) -> None:
        """Of packages."""
        if names:
            self.must("python", "-m", "pip", "uninstall", "--quiet", "--yes", *sorted(names))


def try_core(there: Environment) -> str:
    """Every command that needs no extra; the folder of the sample files."""
    where = there.must("python", "-c", "import geocontact; print(geocontact.__file__)").strip()
    if str(ROOT) in where:
        sys.exit(f"the package is read from {where}, the checkout")
    meshes = there.must("python", "-c", PREPARE, STUDY).strip()
    for command in CORE:
        told(command, there.must("geocontact", *command.format(m=meshes).split()))
    return meshes


def try_extra(there: Environment, wheel: Path, name: str, meshes: str) -> None:
    """Its command without it, then with it."""
    extra, before = EXTRAS[name], there.packages()
    words = extra.command.format(m=meshes).split()
    if extra.input:
        (there.work / extra.input).write_bytes(BEGINNINGS[Path(extra.input).suffix])
    refused = there.run("geocontact", *words)
    lines = refused.stderr.strip().splitlines()
    if refused.returncode != 2 or len(lines) != 1 or extra.refused not in lines[0]:
        sys.exit(f"without {name}: exit code {refused.returncode}\n{refused.stderr}")
    there.install(f"{wheel}[{name}]")
    if extra.prepare:
        there.must("python", "-c", extra.prepare)
    if extra.serves:
        told(f"[{name}] {extra.command}", there.served(*words))
    for command in extra.more if extra.serves else (extra.command, *extra.more):
        told(f"[{name}] {command}", there.must("geocontact", *command.format(m=meshes).split()))
    there.remove(there.packages() - before)


def told(command: str, printed: str) -> None:
    """A line for what was run, and the first that it printed."""
    first = next((line for line in printed.splitlines() if line.strip()), "")
    print(f"ok  {command.replace('{m}/', '')[:70]:70}  {first[:70]}", flush=True)


def main() -> int:
    """The core, then the extras that are asked for."""
    parser = argparse.ArgumentParser(description="Use a wheel in an environment of its own.")
    parser.add_argument("wheel", type=Path)
    parser.add_argument("--extras", default=",".join(EXTRAS))
    parser.add_argument("--folder", type=Path)
    asked = parser.parse_args()
    wheel, started = asked.wheel.resolve(), time.perf_counter()
    with tempfile.TemporaryDirectory(prefix="geocontact-wheel-") as scratch:
        there = Environment((asked.folder or Path(scratch)).resolve())
        there.install(str(wheel))
        meshes = try_core(there)
        for name in filter(None, asked.extras.split(",")):
            try_extra(there, wheel, name, meshes)
        there.install(f"{wheel}[all]", "--dry-run")
        told("[all]", "goes together at the versions of the lock")
    print(f"all commands work from {wheel.name} ({time.perf_counter() - started:.0f} s)")
    return 0


if __name__ == "__main__":
    sys.exit(main())
