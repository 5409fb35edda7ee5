"""Compiled code between runs: only one's own is run, whatever is wrong with the cache, and it has a limit."""

from __future__ import annotations

import math
import os
import platform
import subprocess
import warnings
from pathlib import Path

import casadi
import numpy as np
import pytest
from casadi import SX, Function

import geocontact as gc
from geocontact.dynamics import code_cache, compiled, machine_code
from geocontact.dynamics.compiled import Buffered, library_of
from geocontact.dynamics.step_loop import SOURCE, step_loop

X = SX.sym("x")
posix = pytest.mark.skipif(not hasattr(os, "getuid"), reason="owners and modes of files")
with_compiler = pytest.mark.skipif(compiled.compiler() is None, reason="no C compiler")


@pytest.fixture(autouse=True)
def _cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("GEOCONTACT_CACHE", str(tmp_path / "cache"))
    code_cache._warn.cache_clear()
    _forget()


def _forget() -> None:
    """As in a new process."""
    machine_code._IN_MEMORY.clear()
    compiled._LOADED.clear()


def cosine() -> float:
    """By machine code, of 1."""
    run = Buffered(Function("f", [X], [casadi.cos(X)]), compiled=True)
    assert run.code is not None
    return float(run(np.array([1.0]))[0][0])


def followed(factor: float, made_of: str, times: list[float]) -> Buffered:
    """`factor` times the sum of two numbers, by a recipe that notes when it is followed."""

    def make() -> Function:
        times.append(factor)
        pair = SX.sym("pair", 2)
        return Function("f", [pair], [factor * casadi.sum1(pair), casadi.vertcat(pair, factor)])

    return Buffered(machine_code.Recipe(made_of, (2,), (1, 3), make), compiled=True)


def test_a_recipe_is_followed_only_where_its_code_is_not_kept(tmp_path: Path) -> None:
    times: list[float] = []
    for factor, made_of, known in ((3.0, "three", 1), (3.0, "three", 1), (4.0, "four", 2), (3.0, "three", 2)):
        _forget()
        run = followed(factor, made_of, times)
        one, three = run(np.array([1.0, 2.0]))
        assert run.code is not None and run.code.work > 0
        assert one.tolist() == [3.0 * factor] and three.tolist() == [1.0, 2.0, factor]
        assert len(times) == known
    for file in (tmp_path / "cache").iterdir():
        file.write_bytes(file.read_bytes()[:-9])
    _forget()
    assert followed(3.0, "three", times)(np.ones(2))[0] == [6.0] and len(times) == 3, "what is damaged is made anew"


def test_a_recipe_without_machine_code_is_left_to_casadi(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(machine_code, "_target", lambda: None)
    run = followed(5.0, "five", [])
    assert run.code is None and run(np.ones(2))[0] == [10.0]


@posix
def test_folder_and_files_are_the_users_alone(tmp_path: Path) -> None:
    before = os.umask(0)
    try:
        assert cosine() == math.cos(1.0)
    finally:
        os.umask(before)
    (file,) = (tmp_path / "cache").iterdir()
    assert (tmp_path / "cache").stat().st_mode & 0o777 == 0o700 and file.stat().st_mode & 0o777 == 0o600


@posix
@pytest.mark.parametrize("mode", [0o720, 0o702, 0o1777])
def test_a_folder_that_others_may_write_is_not_used(tmp_path: Path, mode: int) -> None:
    """One warning, however often it is asked for; results are the same."""
    folder = tmp_path / "cache"
    folder.mkdir()
    folder.chmod(mode)
    with pytest.warns(gc.InputWarning, match="may be written by others: compiled code is not kept; `chmod go-w`"):
        assert cosine() == math.cos(1.0)
    _forget()
    assert cosine() == math.cos(1.0), "a second warning would be an error"
    assert not list(folder.iterdir())
    assert "is not kept" in code_cache.words()


@posix
def test_a_folder_of_another_user_is_not_used(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "cache").mkdir(mode=0o755)
    mine = os.getuid()
    monkeypatch.setattr(os, "getuid", lambda: mine + 1)
    if mine == 0:
        assert cosine() == math.cos(1.0), "the administrator's"
        assert len(list((tmp_path / "cache").iterdir())) == 1
        os.chown(tmp_path / "cache", 12345, -1)
        _forget()
    with pytest.warns(gc.InputWarning, match="belongs to another user"):
        assert cosine() == math.cos(1.0)


@posix
def test_a_file_that_others_may_write_is_made_anew(tmp_path: Path) -> None:
    assert cosine() == math.cos(1.0)
    (file,) = (tmp_path / "cache").iterdir()
    file.chmod(0o666)
    _forget()
    assert cosine() == math.cos(1.0)
    assert file.stat().st_mode & 0o777 == 0o600


def test_another_functions_code_under_a_name_is_not_run(tmp_path: Path) -> None:
    assert cosine() == math.cos(1.0)
    (file,) = (tmp_path / "cache").iterdir()
    machine_code.machine_code(Function("f", [X], [casadi.sin(X)]))
    (other,) = set((tmp_path / "cache").iterdir()) - {file}
    file.write_bytes(other.read_bytes())
    _forget()
    assert cosine() == math.cos(1.0) != math.sin(1.0)


def test_code_stays_in_memory_up_to_a_number(monkeypatch: pytest.MonkeyPatch) -> None:
    function = Function("f", [X], [X + 1.0])
    first = machine_code.machine_code(function)
    assert machine_code.machine_code(function) is first is not None
    monkeypatch.setattr(machine_code, "MOST", 2)
    for k in range(3):
        machine_code.machine_code(Function("f", [X], [X * (k + 2.5)]))
    assert len(machine_code._IN_MEMORY) == 2 and first not in machine_code._IN_MEMORY.values()


def test_the_oldest_files_beyond_a_size_are_deleted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(code_cache, "MOST", 1000)
    for k in range(4):
        code_cache.keep(f"{k}.o", bytes(400 - code_cache.SUM))
        os.utime(tmp_path / "cache" / f"{k}.o", (k, k))
    code_cache.keep("late.so", bytes(200 - code_cache.SUM))
    assert sorted(each.name for each in (tmp_path / "cache").iterdir()) == ["2.o", "3.o", "late.so"]
    assert code_cache.kept("3.o") == bytes(400 - code_cache.SUM) and code_cache.kept("0.o") is None
    assert code_cache.words().endswith("3 files, 0 of 0 MB")


def test_what_an_ended_process_left_is_deleted(tmp_path: Path) -> None:
    for age, name in ((90_000.0, "old"), (0.0, "new")):
        place = tmp_path / "cache" / f"{code_cache.PREFIX}{name}"
        place.mkdir(parents=True)
        (place / "half.o").write_bytes(b"x")
        os.utime(place, (os.stat(place).st_mtime - age,) * 2)
    code_cache.prune(tmp_path / "cache")
    assert [each.name for each in (tmp_path / "cache").iterdir()] == [f"{code_cache.PREFIX}new"]


def test_no_home_is_no_cache(monkeypatch: pytest.MonkeyPatch) -> None:
    def homeless() -> Path:
        raise RuntimeError("Could not determine home directory.")

    for name in ("GEOCONTACT_CACHE", "XDG_CACHE_HOME"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(Path, "home", homeless)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert cosine() == math.cos(1.0)
    assert code_cache.cache_folder() is None and "is not kept: no" in code_cache.words()


@pytest.mark.parametrize("part", ["_emitted", "_placed"])
def test_where_llvm_refuses_casadi_interprets(monkeypatch: pytest.MonkeyPatch, part: str) -> None:
    from llvmlite import binding

    def refuses(*_: object) -> None:
        raise RuntimeError("no memory that may be run")

    monkeypatch.setattr(binding, "parse_assembly" if part == "_emitted" else "create_mcjit_compiler", refuses)
    run = Buffered(Function("f", [X], [casadi.cos(X)]), compiled=True)
    assert run.code is None and run(np.array([1.0]))[0][0] == math.cos(1.0)


def test_sparse_outputs_are_refused() -> None:
    for compile_it in (False, True):
        with pytest.raises(ValueError, match="output o0 of f is sparse"):
            Buffered(Function("f", [X], [casadi.diag(casadi.vertcat(X, 2.0))]), compiled=compile_it)


def _library_file(folder: Path) -> Path:
    (file,) = folder.glob("*.so")
    return file


@with_compiler
@posix
def test_a_damaged_library_where_nothing_can_be_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It is built elsewhere; the administrator, who may write everywhere, has a cache in which nothing can be made."""
    assert library_of(SOURCE) is not None
    file = _library_file(tmp_path / "cache")
    file.write_bytes(b"damaged")
    file.parent.chmod(0o500)
    monkeypatch.setattr(code_cache, "_writable", lambda _: None)
    if os.getuid() == 0:
        monkeypatch.setattr(code_cache, "keep", lambda *_: None)
        monkeypatch.setattr(compiled, "keep", lambda *_: None)
    _forget()
    try:
        assert library_of(SOURCE) is not None and file.read_bytes() == b"damaged"
    finally:
        file.parent.chmod(0o700)


@with_compiler
def test_a_library_of_something_else_is_not_used(tmp_path: Path) -> None:
    """Under the loop's name it is built anew; one that has the name by right but no loop is none."""
    assert library_of(SOURCE) is not None
    file = _library_file(tmp_path / "cache")
    library_of("int other(void) { return 1; }")
    (other,) = set(file.parent.glob("*.so")) - {file}
    file.write_bytes(other.read_bytes())
    _forget()
    code = machine_code.machine_code(Function("f", [X], [casadi.cos(X)]))
    assert code is not None and step_loop(code, 1, 1) is not None
    _forget()
    code_cache.keep(file.name, other.read_bytes()[code_cache.SUM :])
    assert step_loop(code, 1, 1) is None


@with_compiler
def test_a_library_is_of_one_compiler_and_one_machine(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for what, value in ((None, None), ("_version", lambda _: "another"), ("platform", _Platform)):
        if what is not None:
            monkeypatch.setattr(compiled, what, value)
        library_of(SOURCE)
    assert len(list((tmp_path / "cache").glob("*.so"))) == 3


class _Platform:
    @staticmethod
    def machine() -> str:
        return "another"


@with_compiler
@pytest.mark.skipif(platform.machine() not in ("x86_64", "aarch64"), reason="names of fused instructions")
def test_the_loop_has_no_fused_operations(tmp_path: Path) -> None:
    """Also for processors that have them: a product that is not rounded differs from Python's."""
    source, wider = tmp_path / "f.c", ["-mfma"] if platform.machine() == "x86_64" else []
    source.write_text(SOURCE, encoding="utf-8")
    flags = [*(each for each in compiled.FLAGS if each != "-shared"), "-O2"]
    program = compiled.compiler()
    assert program is not None
    made = subprocess.run(
        [program, *flags, *wider, "-S", "-o", "-", str(source)], check=True, capture_output=True, text=True
    )
    assert "mul" in made.stdout and "fmadd" not in made.stdout
