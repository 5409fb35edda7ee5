"""No process that the package starts runs a module of the current folder: each of the places that start one."""

from __future__ import annotations

import ast
import os
import subprocess
import sys
from pathlib import Path

import pytest

from geocontact.analyses.frame import workers
from geocontact.io.text.apart import run_apart

ROOT = Path(__file__).resolve().parents[2]
STRANGERS = (
    *("numpy", "json", "sitecustomize", "geocontact", "signal", "pickle", "struct", "socket", "tempfile"),
    *("dask", "distributed", "pandas", "tomllib", "runpy", "planted"),
)
"""Modules that some process imports while it begins or works; the last is no other's name."""
STARTED_BY = {
    "analyses/frame/workers.py": "processes of an analysis: test_workers_of_an_analysis",
    "study/workers.py": "processes of a study: test_workers_of_a_study",
    "study/cluster.py": "what lists jobs, and jobs: test_jobs",
    "view/surfaces/child.py": "pictures, probes: tests/view/surfaces/test_probe.py",
    "io/mocap/c3d_plates.py": "readers of .c3d",
    "io/opensim/muscle_paths.py": "opensim",
    "io/cases/gap_case.py": "the program of a case, which was allowed",
    "dynamics/compiled.py": "a compiler",
    "cli/doctor.py": "probes, by child.py",
    "io/text/apart.py": "readers of .c3d and .step: tests/io/test_step.py",
    "io/mesh/step.py": "names an error of the former",
    "app/runs.py": "runs of the window: tests/app/test_runs.py",
    "app/files.py": "readers of files that are dropped: tests/app/test_files.py",
    "app/faces.py": "faces that a region chooses: tests/app/test_surface_view.py",
    "app/fields.py": "quotes a line, starts nothing",
}
"""Every module that starts processes, and which."""


NAMES = ("get_context", "Process", "Pool", "ProcessPoolExecutor", "LocalCluster", "forkpty", "fork")
CALLS = {
    "os": ("system", "popen", "fork", "forkpty"),
    "distributed": ("LocalCluster",),
    "multiprocessing": ("Process", "Pool", "get_context"),
    "asyncio": ("create_subprocess_exec", "create_subprocess_shell"),
}
"""What starts a process, by name and by module."""


def starts(tree: ast.AST) -> bool:
    """Whether a module imports subprocess, or calls what starts processes."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import) and any(each.name == "subprocess" for each in node.names):
            return True
        if isinstance(node, ast.ImportFrom) and node.module == "subprocess":
            return True
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            calls = CALLS.get(node.value.id, ())
            if node.attr in calls or (node.value.id == "os" and node.attr.startswith(("spawn", "exec", "posix_spawn"))):
                return True
        if isinstance(node, ast.ImportFrom) and any(each.name in NAMES for each in node.names):
            return True
    return False


def test_all_that_start_processes_are_listed() -> None:
    found = {
        file.relative_to(ROOT / "geocontact").as_posix()
        for file in (ROOT / "geocontact").rglob("*.py")
        if starts(ast.parse(file.read_text(encoding="utf-8")))
    }
    assert found == set(STARTED_BY)


def test_each_python_is_started_without_the_current_folder() -> None:
    """Wherever a list begins with this Python, -P follows; the other two mentions are looked at one by one."""
    lists, others = 0, []
    for file in (ROOT / "geocontact").rglob("*.py"):
        tree = ast.parse(file.read_text(encoding="utf-8"))
        begun = [
            node for node in ast.walk(tree) if isinstance(node, ast.List) and node.elts and is_python(node.elts[0])
        ]
        for one in begun:
            assert isinstance(one.elts[1], ast.Constant) and one.elts[1].value == "-P", file
        mentioned = sum(map(is_python, ast.walk(tree)))
        lists += len(begun)
        others += [file.relative_to(ROOT / "geocontact").as_posix()] * (mentioned - len(begun))
    assert lists == 6
    assert set(others) <= {"study/cluster.py", "io/cases/gap_case.py", "cli/doctor.py"}, others


def is_python(node: ast.AST) -> bool:
    return isinstance(node, ast.Attribute) and node.attr == "executable" and getattr(node.value, "id", "") == "sys"


def strangers(folder: Path) -> Path:
    """Modules that leave a line behind when they are run, and that file."""
    hit = folder / "hit.txt"
    home = folder / "home"
    home.mkdir()
    for name in STRANGERS:
        text = f"open({str(hit)!r}, 'a').write('{name}\\n')\nraise ImportError('a stranger')\n"
        (home / f"{name}.py").write_text(text, encoding="utf-8")
    return hit


STARTERS = {
    "read apart": "from geocontact.io.text.apart import run_apart as run; run('planted', [], 99)",
    "pictures": "from geocontact.view.surfaces.child import start; start('import planted').wait(99)",
    "opensim": """from geocontact.io.opensim import muscle_paths as paths
paths.require_opensim, paths.__name__ = lambda: None, "planted"
try:
    paths.muscle_paths(paths.Path("no.osim"), (), paths.np.zeros((1, 0)), ())
except paths.InputError:
    pass""",
}
"""Each begins a process that asks for a module of the current folder."""


@pytest.mark.parametrize("name", STARTERS)
def test_the_current_folder_on_the_path_is_not_passed_on(tmp_path: Path, name: str) -> None:
    """`gap` adds it for a model of the user's own; a process that began with it could run its sitecustomize.py."""
    hit = strangers(tmp_path)
    script = tmp_path / "start.py"
    script.write_text(f"import os, sys\nsys.path.append(os.getcwd())\n{STARTERS[name]}\n", encoding="utf-8")
    environment = {key: value for key, value in os.environ.items() if key not in ("PYTHONPATH", "PYTHONSAFEPATH")}
    environment["PYTHONPATH"] = str(ROOT)
    words = [sys.executable, str(script)]
    home = tmp_path / "home"
    ran = subprocess.run(words, cwd=home, env=environment, capture_output=True, text=True, check=False, timeout=120)
    assert not ran.returncode, ran.stderr
    assert not hit.exists(), hit.read_text(encoding="utf-8")


def test_other_folders_are_searched_as_here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """In the same order, before others too: libraries that a program keeps beside itself are found."""
    for folder in ("first", "second", "here"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "found_module.py").write_text(f"import sys; print({folder!r}, *sys.argv[1:])")
    monkeypatch.chdir(tmp_path / "here")
    own = [str(tmp_path / "here"), "", str(tmp_path / "first"), "../second"]
    monkeypatch.setattr(sys, "path", [*own, *sys.path])
    assert run_apart("found_module", ["a", "b c"], 60.0).stdout.decode().strip() == "first a b c"
    (tmp_path / "first" / "found_module.py").unlink()
    assert run_apart("found_module", [], 60.0).stdout.decode().strip() == "second"
    (tmp_path / "second" / "found_module.py").unlink()
    assert b"No module named found_module" in run_apart("found_module", [], 60.0).stderr


PIECES = """import os, sys
def main():
    from geocontact.analyses.frame.workers import each
    found = dict(each({work}, ["PYTHONSAFEPATH", "NOTHING"], 2))
    assert found == {{"PYTHONSAFEPATH": {wanted!r}, "NOTHING": None}}, found
    assert os.environ.get("PYTHONSAFEPATH") == {wanted!r}
if __name__ == "__main__":
    main()
"""


@pytest.mark.slow
@pytest.mark.parametrize("given", [None, "1"])
def test_workers_of_an_analysis(tmp_path: Path, given: str | None) -> None:
    """And programs that they start are as free as ever, unless the caller said otherwise."""
    hit = strangers(tmp_path)
    script = tmp_path / "pieces.py"
    script.write_text(PIECES.format(work="os.getenv", wanted=given), encoding="utf-8")
    environment = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "PYTHONSAFEPATH")}
    if given is not None:
        environment["PYTHONSAFEPATH"] = given
    environment["PYTHONPATH"] = str(ROOT)
    ran = subprocess.run(
        [sys.executable, str(script)],
        cwd=tmp_path / "home",
        env=environment,
        capture_output=True,
        text=True,
        check=False,
        timeout=120,
    )
    assert not ran.returncode, ran.stderr
    assert not hit.exists(), hit.read_text(encoding="utf-8")


@pytest.mark.slow
def test_workers_of_a_study(tmp_path: Path) -> None:
    """A study of two trials that is started in the strangers' folder."""
    hit, home = strangers(tmp_path), tmp_path / "home"
    ball = ROOT / "meshes" / "sphere_r20.stl"
    description = f'analysis = "fit"\n[options]\nmesh = "{ball}"\nunit = "mm"\nshape = "sphere"\n'
    (home / "study.toml").write_text(
        f'{description}[[trials]]\nsubject = "A"\n[[trials]]\nsubject = "B"\n', encoding="utf-8"
    )
    starter = tmp_path / "start.py"
    starter.write_text(
        'if __name__ == "__main__":\n    from geocontact.cli.main import main\n\n    main()\n', encoding="utf-8"
    )
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    environment.pop("PYTHONSAFEPATH", None)
    ran = subprocess.run(
        [sys.executable, str(starter), "cohort", "study.toml", "--workers", "1", "--out", "out"],
        cwd=home,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
        timeout=300,
    )
    assert not hit.exists(), hit.read_text(encoding="utf-8")
    assert not ran.returncode, ran.stderr + ran.stdout


def test_the_caller_keeps_its_own_word(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(workers.SAFE_PATH, "1")
    with workers.current_folder_closed():
        workers.leave_programs_their_folder()
        assert os.environ[workers.SAFE_PATH] == "1"
    assert os.environ[workers.SAFE_PATH] == "1"
    monkeypatch.delenv(workers.SAFE_PATH)
    with workers.current_folder_closed():
        assert os.environ[workers.SAFE_PATH] == workers.OURS
    assert workers.SAFE_PATH not in os.environ


@pytest.mark.skipif(sys.platform == "win32", reason="a folder that a process is in stays there")
def test_readers_work_where_the_current_folder_is_gone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "found_module.py").write_text("print('read')")
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    monkeypatch.setattr(sys, "path", ["", str(tmp_path), *sys.path])
    (tmp_path / "here").rmdir()
    assert run_apart("found_module", [], 60.0).stdout.decode().strip() == "read"
