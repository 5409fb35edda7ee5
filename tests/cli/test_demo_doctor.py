"""`geocontact demo` shows the main job; `geocontact doctor` says what works here and how to mend the rest."""

from __future__ import annotations

import shutil
import sys
import time
from pathlib import Path

import pytest

from geocontact.cli import demo, doctor
from geocontact.cli.doctor import Feature
from tests.cli.calls import FEMUR, INSERT, MESHES, call, gait, process


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


@pytest.mark.slow
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
        if lines[at].split()[0] != "ok":
            assert lines[at + 1].split() in (f"fix: {later}{feature.fix}".split() for later in ("", doctor.LATER))
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
    "hangs": (
        Feature("e", "numpy", "x", "import time; time.sleep(60)", "pip install e", needed=True),
        1,
        "no answer within 1 s\n           fix: try again when the machine is less busy; if it stays: ",
    ),
    "crashes": (Feature("f", "numpy", "x", "import os; os.abort()", "apt install f"), 0, "a system library or driver"),
}


@pytest.mark.parametrize(("feature", "code", "said"), PROBES.values(), ids=PROBES.keys())
def test_doctor_names_the_fix_for_what_is_missing(
    monkeypatch: pytest.MonkeyPatch, feature: Feature, code: int, said: str
) -> None:
    monkeypatch.setattr(doctor, "FEATURES", (feature,))
    monkeypatch.setattr(doctor, "PATIENCE", 1.0)
    monkeypatch.setattr(doctor, "ALONE", 1.0)
    result = call("doctor")
    assert result.code == code
    assert said in result.out and f"{feature.fix}\n" in result.out
    last = result.out.splitlines()[-1]
    assert last.startswith("everything an analysis needs works") == (code == 0)
    assert ("not known" in last) == ("no answer" in said)


def test_doctor_says_what_the_cache_of_machine_code_holds(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(doctor, "FEATURES", ())
    monkeypatch.setenv("GEOCONTACT_CACHE", str(tmp_path))
    (tmp_path / "a.o").write_bytes(bytes(2_400_000))
    assert f"machine code of body models is kept in {tmp_path}: 1 files, 2 of 500 MB\n" in call("doctor").out


def test_doctor_asks_again_when_the_others_have_ended(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """What is slow beside others and answers alone is no matter."""
    mark = tmp_path / "asked"
    probe = f"import pathlib, time; mark = pathlib.Path({str(mark)!r}); again = mark.exists(); mark.touch(); "
    slow = Feature("slow", "numpy", "x", f"{probe}time.sleep(0 if again else 60)", "wait", needed=True)
    monkeypatch.setattr(doctor, "FEATURES", (slow,))
    monkeypatch.setattr(doctor, "PATIENCE", 1.0)
    result = call("doctor")
    assert (result.code, result.out.splitlines()[-1]) == (0, "everything an analysis needs works")


def test_a_library_of_an_extra_that_is_not_installed_is_one_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in [each for each in sys.modules if each.partition(".")[0] == "casadi"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "casadi", None)
    wanted = ["numpy>=2", "casadi>=3.7; extra == 'dynamics'"]
    monkeypatch.setattr("geocontact.cli.suggestions.requires", lambda _: wanted)
    done = call("markers", MESHES / "leg_swing.mot", "--model", MESHES / "leg.osim", "--out", tmp_path / "m")
    assert done.code == 0, done.err
    refused = call("ik", tmp_path / "m" / "markers.trc", "--model", MESHES / "leg.osim", "--out", tmp_path / "out")
    assert (refused.code, refused.err) == (
        2,
        "casadi is needed here and not installed; pip install 'geocontact[dynamics]'\n",
    )
    assert not (tmp_path / "out").exists()


def test_a_window_without_its_extra_is_one_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Nor is there what comes with nicegui, which the window imports before it."""
    for name in ("nicegui", "fastapi", "starlette", "uvicorn"):
        for each in [each for each in sys.modules if each.partition(".")[0] == name]:
            monkeypatch.delitem(sys.modules, each)
        monkeypatch.setitem(sys.modules, name, None)
    monkeypatch.setattr("geocontact.cli.suggestions.requires", lambda _: ["nicegui>=3.18; extra == 'app'"])
    refused = call("app", "--no-browser", "--out", tmp_path / "out")
    line = "nicegui is needed here and not installed; pip install 'geocontact[app]'\n"
    assert (refused.code, refused.err) == (2, line)
    assert not (tmp_path / "out").exists()


def test_parquet_without_pyarrow_is_refused_before_anything_is_computed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    fit = ("fit", MESHES / "no.stl", "--shape", "sphere", "--unit", "mm", "--out", tmp_path / "out")
    refused = call(*fit, "--parquet")
    line = "--parquet: needs pyarrow, which is not installed; pip install 'geocontact[parquet]'\n"
    assert (refused.code, refused.err) == (2, line)
    assert "pyarrow" not in call(*fit).err
