"""Before and around the analysis: help, version, demo, doctor, the word about compiling; as a process of its own."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

import pytest

from geocontact import __version__
from geocontact.cli import demo, doctor, patience
from geocontact.cli.doctor import Feature
from geocontact.cli.maps import DistanceMaps
from tests.cli.calls import FEMUR, INSERT, MESHES, PLATE, ROOT, SPHERE, area, call, done, gait, inventory, poses

HELP = [["--help"], ["area", "--help"], ["demo", "--help"], ["doctor", "--help"], ["--version"]]
HEAVY = {"numba", "trimesh", "pyvista", "vtk", "matplotlib", "igl", "fcl", "pandas", "scipy", "open3d"}
each_help = pytest.mark.parametrize("arguments", HELP, ids=" ".join)


def process(*arguments: object, cwd: Path = ROOT) -> subprocess.CompletedProcess[str]:
    """The program as a user starts it from a checkout."""
    command = [sys.executable, str(ROOT / "cli.py"), *map(str, arguments)]
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
    return subprocess.run(command, cwd=cwd, env=environment, capture_output=True, encoding="utf-8", timeout=300)


# --- help -----------------------------------------------------------------------------------------------------------


@each_help
def test_help_takes_less_than_half_a_second_of_the_processor(arguments: list[str]) -> None:
    pytest.importorskip("resource", reason="processor time of a child is measured on Unix")
    child = subprocess.Popen([sys.executable, "cli.py", *arguments], cwd=ROOT, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    assert child.returncode == 0
    assert usage.ru_utime + usage.ru_stime < 0.5


@each_help
def test_help_imports_nothing_heavy(arguments: list[str]) -> None:
    program = f"import sys; from geocontact.cli.main import run; code = run({arguments!r}); sys.stderr.write("
    program += "f'{code} ' + ' '.join({name.partition('.')[0] for name in sys.modules}))"
    child = subprocess.run([sys.executable, "-c", program], cwd=ROOT, capture_output=True, encoding="utf-8")
    code, *modules = child.stderr.split()
    assert code == "0"
    assert not HEAVY & set(modules)


def test_help_names_the_commands_and_every_option_of_the_contract() -> None:
    assert all(name in call("--help").out for name in ("area", "demo", "doctor"))
    promised = (
        "motion unit threshold out osim joint moving map order angles sweep axis place-moving place-fixed convention side "
        "split medial region region-moving compare tolerance bounds save-map assume-closed parquet"
    )
    told = call("area", "--help").out
    assert not [option for option in promised.split() if f"--{option}" not in told]


def test_version() -> None:
    result = call("--version")
    assert (result.code, result.out.strip(), result.err) == (0, __version__, "")


# --- as a process ---------------------------------------------------------------------------------------------------


def test_from_another_folder_with_relative_paths(tmp_path: Path) -> None:
    """Inputs, the result folder and a path that looks like an option are relative to where the user stands."""
    for file, name in ((FEMUR, "-x.stl"), (INSERT, "insert.stl")):
        shutil.copy(file, tmp_path / name)
    gait(tmp_path, [0])
    result = process("area", "./-x.stl", "insert.stl", "--unit=mm", "--motion=gait.csv", "--out=out/1", cwd=tmp_path)
    assert (result.returncode, result.stderr) == (0, ""), result.stderr
    assert set(inventory(tmp_path / "out/1")) == {"area.csv", "area.png", "area.svg", "run.json"}
    assert "out/1" in result.stdout


def test_refusal_is_one_line_and_exit_2(tmp_path: Path) -> None:
    result = process(
        "area", tmp_path / "no.stl", PLATE, "--unit", "mm", "--sweep", "a=0:1:1", "--out", tmp_path / "out"
    )
    assert result.returncode == 2
    assert result.stderr.count("\n") == 1 and "no such file; check the path" in result.stderr
    assert inventory(tmp_path) == {}


def test_refusal_with_a_name_that_the_terminal_cannot_show(tmp_path: Path) -> None:
    """Written with what the terminal has instead of failing on the way out."""
    command = [
        sys.executable,
        "cli.py",
        "area",
        str(tmp_path / "膝 ≤ – é.stl"),
        str(PLATE),
        "--unit=mm",
        "--sweep=a=0:1:1",
    ]
    environment = os.environ | {"PYTHONIOENCODING": "ascii"}
    result = subprocess.run([*command, f"--out={tmp_path / 'out'}"], cwd=ROOT, env=environment, capture_output=True)
    assert result.returncode == 2
    assert result.stderr.count(b"\n") == 1 and b"no such file" in result.stderr


def test_summary_on_a_terminal_without_unicode(tmp_path: Path) -> None:
    """Results are announced with an ellipsis and end up in an ASCII log all the same."""
    command = [
        "area",
        SPHERE,
        PLATE,
        f"--motion={poses(tmp_path, (0, 20, 0))}",
        "--unit=mm",
        f"--out={tmp_path / 'out'}",
    ]
    environment = os.environ | {"PYTHONIOENCODING": "ascii"}
    result = subprocess.run(
        [sys.executable, "cli.py", *map(str, command)], cwd=ROOT, env=environment, capture_output=True
    )
    assert result.returncode == 0, result.stderr
    assert (tmp_path / "out/area.csv").is_file()


def test_results_are_there_when_nobody_reads_the_summary(tmp_path: Path) -> None:
    """`geocontact area … | head -1`: the pipe is closed before the run has said everything."""
    if os.name != "posix":
        pytest.skip("a pipe without a reader is made on Unix")
    command = [
        "area",
        SPHERE,
        PLATE,
        f"--motion={poses(tmp_path, (0, 20, 0))}",
        "--unit=mm",
        f"--out={tmp_path / 'out'}",
    ]
    reader, writer = os.pipe()
    os.close(reader)
    result = subprocess.run(
        [sys.executable, "-u", "cli.py", *map(str, command)], cwd=ROOT, stdout=writer, stderr=subprocess.PIPE
    )
    os.close(writer)
    assert b"Traceback" not in result.stderr
    assert (tmp_path / "out/area.csv").is_file()


def test_module_and_script_are_the_same_program() -> None:
    """The installed command calls what cli.py calls."""
    pyproject = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    assert 'geocontact = "geocontact.cli.main:main"' in pyproject
    assert "from geocontact.cli.main import main" in (ROOT / "cli.py").read_text(encoding="utf-8")


# --- demo and doctor ------------------------------------------------------------------------------------------------


def test_demo_runs_to_the_end_and_names_what_to_open(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The shipped pair, here coarser and with two frames, because all of it takes half a minute."""
    small = tmp_path / "meshes"
    small.mkdir()
    shutil.copy(FEMUR, small / "femoral_component_right_medium.stl")
    shutil.copy(INSERT, small / "tibial_insert_right_medium.stl")
    gait(small)
    monkeypatch.setattr(demo, "sample_folder", lambda: small)
    monkeypatch.chdir(tmp_path)
    result = call("demo")
    assert (result.code, result.complaints) == (0, []), result.err
    (named,) = [line for line in result.out.splitlines() if line.startswith("open ")]
    opened = [Path(word) for word in named.split() if "." in word]
    assert opened and all(file.is_file() for file in opened)
    assert call("demo", "--out", tmp_path / "elsewhere").code == 0 and (tmp_path / "elsewhere/area.csv").is_file()


def test_demo_finds_the_shipped_files() -> None:
    assert demo.sample_folder() == MESHES
    names = ("femoral_component_right_medium.stl", "tibial_insert_right_medium.stl", "gait.csv")
    assert all((MESHES / name).is_file() for name in names)


def test_doctor_on_this_machine() -> None:
    """Every feature has its line; what is missing is followed by its fix; all that is needed works here."""
    start = time.perf_counter()
    result = process("doctor")
    assert result.returncode == 0, result.stdout
    assert result.stderr == ""
    assert time.perf_counter() - start < 60.0
    lines = result.stdout.splitlines()
    for feature in doctor.FEATURES:
        (at,) = [k for k, line in enumerate(lines) if line[11:].startswith(f"{feature.name:20} ")]
        if not lines[at].split()[0] == "ok":
            assert lines[at + 1].split() == f"fix: {feature.fix}".split()
    assert lines[-1] == "everything an analysis needs works"


PROBES = {
    "not installed": (
        Feature("a", "no-such-package-1", "x", "pass", "pip install a", needed=False),
        0,
        "not installed",
    ),
    "needed": (Feature("b", "no-such-package-2", "x", "pass", "pip install b", needed=True), 1, "not installed"),
    "raises": (
        Feature("c", "numpy", "x", "import no_such_module", "pip install c"),
        0,
        "No module named 'no_such_module'",
    ),
    "exits": (Feature("d", "numpy", "x", "raise SystemExit(3)", "pip install d"), 0, "exit code 3"),
    "hangs": (Feature("e", "numpy", "x", "import time; time.sleep(60)", "pip install e"), 0, "no answer within"),
    "crashes": (Feature("f", "numpy", "x", "import os; os.abort()", "apt install f"), 0, "a system library or driver"),
}


@pytest.mark.parametrize(("feature", "code", "said"), PROBES.values(), ids=PROBES.keys())
def test_doctor_names_the_fix_for_what_is_missing(
    monkeypatch: pytest.MonkeyPatch, feature: Feature, code: int, said: str
) -> None:
    monkeypatch.setattr(doctor, "FEATURES", (feature,))
    monkeypatch.setattr(doctor, "PATIENCE", 1.0)
    result = call("doctor")
    assert result.code == code
    assert said in result.out and f"fix: {feature.fix}\n" in result.out
    assert ("cannot run here" in result.out) == bool(code)


# --- patience -------------------------------------------------------------------------------------------------------


def test_compiling_is_announced_when_the_first_frame_keeps_the_user_waiting(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(patience, "SILENCE", 0.0)
    with patience.preparing():
        pass
    add = DistanceMaps.add
    monkeypatch.setattr(DistanceMaps, "add", lambda *given, **named: (time.sleep(0.3), add(*given, **named))[1])
    monkeypatch.setattr(patience, "SILENCE", 1e-4)
    result = area(tmp_path / "out", moving=SPHERE, fixed=PLATE, motion=poses(tmp_path, (0, 20, 0)))
    (line,) = result.complaints
    assert line.startswith("compiling the distance kernels, once on this machine") and result.code == 0


def test_many_frames_are_not_mistaken_for_compiling(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Once a frame is there the kernels are compiled, however long the others take."""
    rows = [(0, 20 + k / 10, 0) for k in range(4)]
    done(area(tmp_path / "warm", moving=SPHERE, fixed=PLATE, motion=poses(tmp_path, *rows)))
    add = DistanceMaps.add
    monkeypatch.setattr(DistanceMaps, "add", lambda *given, **named: (time.sleep(0.6), add(*given, **named))[1])
    monkeypatch.setattr(patience, "SILENCE", 2.0)
    done(area(tmp_path / "out", moving=SPHERE, fixed=PLATE, motion=poses(tmp_path, *rows)))
