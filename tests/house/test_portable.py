"""What holds on one system only: found in the sources, and the paths of other systems by their own rules."""

from __future__ import annotations

import ast
import re
import tomllib
from collections.abc import Iterable, Iterator
from pathlib import Path, PurePosixPath, PureWindowsPath

import pytest

from geocontact.data.text import cannot_be_named, same_place
from geocontact.study.trials import expression_of, split_pattern

ROOT = Path(__file__).resolve().parents[2]
POSIX_ONLY = {
    "modules": {"fcntl", "grp", "posix", "pty", "pwd", "resource", "termios", "tty"},
    "os": {
        "fork",
        "forkpty",
        "getuid",
        "geteuid",
        "kill",
        "killpg",
        "mkfifo",
        "nice",
        "sched_getaffinity",
        "setsid",
        "statvfs",
    },
    "signal": {"SIGALRM", "SIGHUP", "SIGKILL", "SIGUSR1", "SIGUSR2", "alarm", "pthread_kill"},
}
PLACES = ("/tmp", "/dev/", "/proc/", "/var/", "/usr/", "/etc/")
TEXT = {"open", "read_text", "write_text"}


def sources(words: Iterable[str]) -> Iterator[tuple[str, ast.Module]]:
    """Name and syntax tree of each file of the package in which one of the words stands."""
    for file in sorted(ROOT.glob("geocontact/**/*.py")):
        text = file.read_text(encoding="utf-8")
        if any(word in text for word in words):
            yield file.relative_to(ROOT).as_posix(), ast.parse(text)


def modules(node: ast.AST) -> set[str]:
    if isinstance(node, ast.Import):
        return {one.name.partition(".")[0] for one in node.names}
    return {(node.module or "").partition(".")[0]} if isinstance(node, ast.ImportFrom) else set()


def posix(node: ast.AST) -> str:
    """What in a node of the syntax tree only POSIX has, "" if nothing."""
    if found := modules(node) & POSIX_ONLY["modules"]:
        return f"import {found.pop()}"
    if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
        own = POSIX_ONLY.get(node.value.id, set())
        return f"{node.value.id}.{node.attr}" if node.attr in own else ""
    if isinstance(node, ast.Constant) and isinstance(node.value, str) and node.value.startswith(PLACES):
        return node.value
    if isinstance(node, ast.Call) and getattr(node.func, "attr", "") == "get_context":
        told = [one.value for one in node.args if isinstance(one, ast.Constant)]
        return "" if told == ["spawn"] else "a way to start processes that Windows has not"
    return ""


def of_every_system(tree: ast.AST) -> Iterator[ast.AST]:
    """Nodes of the syntax tree but those that ask first which system it is."""
    for node in ast.iter_child_nodes(tree):
        if not (isinstance(node, ast.If) and ast.unparse(node.test).startswith("sys.platform")):
            yield node
            yield from of_every_system(node)


def without_encoding(node: ast.AST) -> bool:
    """Whether text is read or written as the system would: Windows does not take UTF-8."""
    if not isinstance(node, ast.Call):
        return False
    name = getattr(node.func, "attr", getattr(node.func, "id", ""))
    if name not in TEXT or any(one.arg == "encoding" for one in node.keywords):
        return False
    words = [one.value for one in [*node.args, *(k.value for k in node.keywords)] if isinstance(one, ast.Constant)]
    binary = any(isinstance(word, str) and "b" in word and len(word) <= 3 for word in words)
    return not binary and not (name == "open" and isinstance(node.func, ast.Attribute) and _of_a_library(node.func))


def _of_a_library(function: ast.Attribute) -> bool:
    return isinstance(function.value, ast.Name) and function.value.id in (
        "os",
        "webbrowser",
        "tarfile",
        "zipfile",
        "archive",
    )


def test_nothing_of_one_system_is_taken_for_granted() -> None:
    """Processes are spawned, never forked; no folder of a system is named; text is UTF-8."""
    words = (*POSIX_ONLY["modules"], *POSIX_ONLY["os"], *POSIX_ONLY["signal"], *PLACES, "get_context")
    odd = [
        f"{file}:{node.lineno} {word}"
        for file, tree in sources(words)
        for node in of_every_system(tree)
        if (word := posix(node))
    ]
    assert odd == []
    bare = [f"{f}:{node.lineno}" for f, tree in sources(TEXT) for node in ast.walk(tree) if without_encoding(node)]
    assert bare == [], "give encoding"


def test_no_two_files_of_the_repository_differ_in_capitals_alone() -> None:
    files = [f for room in ("geocontact", "tests", "docs", "meshes") for f in (ROOT / room).rglob("*")]
    names = [f.relative_to(ROOT).as_posix() for f in files if not {"__pycache__", "node_modules"} & set(f.parts)]
    assert same_place(names) is None
    assert [name for name in names if cannot_be_named(PurePosixPath(name).name)] == []
    assert max(map(len, names)) < 120, "with a folder of the user in front, Windows has room for 260"


@pytest.mark.parametrize(
    "name", ["", ".", "..", "con", "CON", "nul.txt", "Com1", "lpt9.old.csv", "aux ", "walk.", "walk "]
)
def test_names_that_windows_refuses(name: str) -> None:
    assert cannot_be_named(name)


@pytest.mark.parametrize("name", ["walk", "console", "com", "com10", "Gehen – schnell", "a.b", ".hidden", "Prüfung 1"])
def test_names_that_every_system_takes(name: str) -> None:
    assert not cannot_be_named(name)


def test_names_that_some_system_takes_for_one() -> None:
    assert same_place(["walk", "Walk"]) == "Walk"
    assert same_place(["Füße", "FÜSSE"]) == "FÜSSE"
    assert same_place(["u\u0308ben", "\u00fcben"]) == "\u00fcben"  # composed and not: one file on macOS
    assert same_place(["walk_1", "walk_2", "run"]) is None


@pytest.mark.parametrize(
    ("pattern", "start", "rest"),
    [
        ("data/{subject}/walk.csv", "", "data/{subject}/walk.csv"),
        ("data\\{subject}\\walk.csv", "", "data/{subject}/walk.csv"),
        ("C:\\Messung 3\\{subject}.csv", "C:/", "Messung 3/{subject}.csv"),
        ("d:/Prüfstand/{subject}/*.csv", "d:/", "Prüfstand/{subject}/*.csv"),
        ("\\\\server\\share\\{subject}.csv", "//server/share/", "{subject}.csv"),
        ("..\\other\\{subject}.csv", "", "../other/{subject}.csv"),
    ],
)
def test_patterns_of_a_study_on_windows(pattern: str, start: str, rest: str) -> None:
    assert split_pattern(pattern, PureWindowsPath) == (start, rest)
    assert split_pattern(rest, PurePosixPath) == ("", rest)


def test_patterns_fit_paths_as_their_system_compares_them() -> None:
    pattern = "Data/{subject}/{subject}_*.CSV"
    for path, windows, others in (
        ("Data/P1/P1_a.CSV", True, True),
        ("data/P1/P1_a.csv", True, False),
        ("Data/P1/P2_a.CSV", False, False),
    ):
        assert bool(expression_of(pattern, PureWindowsPath).fullmatch(path)) is windows
        assert bool(expression_of(pattern, PurePosixPath).fullmatch(path)) is others


def test_oldest_python_is_the_same_wherever_it_is_promised() -> None:
    """What pip, the Makefile, README and docs say; `.ci/run` tests under it where the system has it."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    oldest = project["requires-python"].removeprefix(">=")
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    asked = set(re.findall(r"sys\.version_info < \(([\d, ]+)\)", makefile))
    assert {name.replace(", ", ".") for name in asked} == {oldest}
    for file in ("Makefile", "README.md", "docs/index.md"):
        assert f"Python {oldest} or newer" in (ROOT / file).read_text(encoding="utf-8"), file
    assert "python3.11" in (ROOT / ".ci" / "run").read_text(encoding="utf-8")
