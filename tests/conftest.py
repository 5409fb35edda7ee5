"""Shapes and types of the package's arguments are checked while tests run; real-data tests are counted.

Checks at every call take about as long as whole diagnoses do. `make test` and `make slow` leave them out
(GEOCONTACT_UNCHECKED), `make shapes` runs the unit tests of most rooms with them, and so does pytest by itself.
"""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Iterator
from contextlib import nullcontext
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import hypothesis
import pytest
from jaxtyping import install_import_hook

from tests.browsers import browser
from tests.drawing import undrawn
from tests.elsewhere import Elsewhere, another_process, here
from tests.one_core import one_core
from tests.recording import close
from tests.scheduling import FileByFile, lasting_first, run_before

__all__ = ["browser"]  # one for all rooms: playwright starts once in a process
ROOT = Path(__file__).resolve().parents[1]
REAL = ROOT / "tests" / "real"
ROOMS_OF_CALLS = {ROOT / "tests" / "analyses", ROOT / "tests" / "cli", ROOT / "tests" / "study"}
PER_CENT = "ignore:.*taken as per cent of a cycle:geocontact.data.errors.InputWarning"
"""Right of DM's fluoroscopy, whose time has no unit."""
UNCHECKED = bool(os.environ.get("GEOCONTACT_UNCHECKED"))
CHECKED = frozenset(os.environ.get("GEOCONTACT_CHECKED", "").split())
"""Folders and files below tests whose quick tests were run with shapes checked, and are left out here."""
COMPILED = "geocontact.geometry.kernels"  # numba reads these functions' own source; nothing may be wrapped around them

one_core()

hypothesis.settings.register_profile("local", deadline=None)
hypothesis.settings.register_profile("ci", deadline=None, derandomize=True)
hypothesis.settings.load_profile("ci" if os.environ.get("CI") else "local")


def checked_modules() -> Iterator[str]:
    """Modules of the package without its kernels, and without options, which take text for paths and coerce it.

    Only leaves, because the hook takes prefixes.
    """
    for file in sorted((ROOT / "geocontact").rglob("*.py")):
        module = ".".join(file.relative_to(ROOT).with_suffix("").parts)
        if file.name not in ("__init__.py", "options.py") and not module.startswith(COMPILED):
            yield module


if not UNCHECKED:
    install_import_hook(list(checked_modules()), "beartype.beartype")


@pytest.fixture(autouse=True)
def closed() -> Iterator[None]:
    """No test hears of the record of another one."""
    yield
    close()


@pytest.fixture(scope="session", autouse=True)
def unhurried() -> Iterator[None]:
    """Kernels are loaded without a word, which depends on the machine; test_process.py asks for the word."""
    from geocontact.cli import show

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(show, "SILENCE", 3600.0)
        yield


@pytest.fixture(autouse=True)
def hurried(request: pytest.FixtureRequest) -> Iterator[None]:
    """Commands and analyses do not draw their figures but in tests marked `drawn`."""
    calls = ROOMS_OF_CALLS & set(request.path.parents)
    with undrawn() if calls and not request.node.get_closest_marker("drawn") else nullcontext():
        yield


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Mark what lies below tests/real, and what asks for the library opensim; files that are slow come first.

    Several processes take file by file; one that is slow and comes last would keep a single process busy at the end.
    """
    for item in items:
        if REAL in item.path.parents:
            item.add_marker(pytest.mark.real)
            item.add_marker(pytest.mark.filterwarnings(PER_CENT))
        if "opensim" in getattr(item, "fixturenames", ()):
            item.add_marker(pytest.mark.oracle)
    slow = {item.path for item in items if item.get_closest_marker("slow")}
    items.sort(key=lambda item: lasting_first(slow, item.path))
    if CHECKED:
        again = [run_before(each.path, each.get_closest_marker("slow") is not None, CHECKED) for each in items]
        config.hook.pytest_deselected(items=[each for each, was in zip(items, again, strict=True) if was])
        items[:] = [each for each, was in zip(items, again, strict=True) if not was]


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> FileByFile | None:
    """With --dist loadscope, as the Makefile asks for; otherwise what was asked for."""
    return FileByFile(config, log) if config.getvalue("dist") == "loadscope" else None


@pytest.hookimpl(tryfirst=True)
def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Say how many real-data tests ran, and why the others did not."""
    ran = [r for key in ("passed", "failed") for r in terminalreporter.getreports(key) if below_real(r)]
    skipped = Counter(reason(r) for r in terminalreporter.getreports("skipped") if below_real(r))
    why = f" ({'; '.join(f'{n} x {r}' if len(skipped) > 1 else r for r, n in skipped.items())})" if skipped else ""
    terminalreporter.write_line(f"real-data tests: {len(ran)} ran, {skipped.total()} skipped{why}")


def below_real(report: pytest.TestReport) -> bool:
    """Whether a report belongs to a test below tests/real."""
    return report.nodeid.startswith("tests/real/")


def reason(report: pytest.TestReport) -> str:
    """Why a test was skipped."""
    place = report.longrepr
    return str(place[2]).removeprefix("Skipped: ") if isinstance(place, tuple) else "no reason given"


@pytest.fixture(scope="session")
def elsewhere() -> Iterator[Elsewhere]:
    """Calls a function without checks of shapes and gives its result; for whole diagnoses and identifications."""
    with nullcontext(here) if UNCHECKED else another_process() as call:
        yield call


@pytest.fixture(scope="session")
def opensim() -> Iterator[Elsewhere]:
    """Calls a function of `tests.opensim_oracle` where the opensim package may be loaded."""
    if find_spec("opensim") is None:
        pytest.skip("the opensim package is the oracle; pip install opensim")
    with another_process() as call:
        yield call
