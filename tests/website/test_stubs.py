"""Stubs name what packages have: a type checker, an editor and the package itself read the same."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

import geocontact as gc
from geocontact.data.stub_names import names_of_stub, stub_places
from website.stubs import FRONT, ROOT, listed, stubs


def test_they_are_as_the_catalogue_has_it() -> None:
    """`python -m website.stubs` writes them anew."""
    for name, text in stubs(ROOT).items():
        assert (ROOT / name).read_text(encoding="utf-8") == text, name


def test_a_further_name_stays_and_what_is_gone_goes(tmp_path: Path) -> None:
    for name in ("data/units.py", "analyses/cop/result.py"):
        (tmp_path / "geocontact" / name).parent.mkdir(parents=True)
        (tmp_path / "geocontact" / name).touch()
    lines = ["from geocontact.data.units import mm, MPa, LIMIT", "from geocontact.data.gone import old"]
    lines += ["from geocontact.analyses.cop.result import no_job"]
    (tmp_path / FRONT).write_text("\n".join(lines), encoding="utf-8")
    text = stubs(tmp_path)[FRONT]
    assert "from geocontact.data.units import LIMIT, MPa, mm\n" in text
    assert "old" not in text and "no_job" not in text and '    "centre_of_pressure",\n' in text


def test_a_short_list_stands_in_one_line() -> None:
    assert listed(["a", "b"]) == '__all__ = ["a", "b"]'


def test_every_name_is_there() -> None:
    assert len(gc.__all__) > 60 and set(gc.__all__) == set(stub_places(ROOT / FRONT)) <= set(dir(gc))
    for name in gc.__all__:
        assert getattr(gc, name) is getattr(gc, name), name
    with pytest.raises(AttributeError, match="module 'geocontact' has no attribute 'aera'"):
        gc.aera  # noqa: B018


def test_a_type_checker_would_find_its_list() -> None:
    """The stub says by itself which of its names are public."""
    space: dict[str, object] = {}
    text = (ROOT / FRONT).read_text(encoding="utf-8")
    exec(text[text.index("__all__") :], space)
    assert sorted(space["__all__"]) == sorted(gc.__all__)


def test_a_package_without_its_stub_says_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    text = "import sys\nfrom geocontact.data.stub_names import names_of_stub\nnames_of_stub(sys.modules[__name__])\n"
    (tmp_path / "stubless.py").write_text(text, encoding="utf-8")
    monkeypatch.syspath_prepend(str(tmp_path))
    with pytest.raises(ImportError, match=r"stubless.pyi is missing; install the package anew"):
        __import__("stubless")
    assert callable(names_of_stub)


def test_names_are_imported_when_they_are_asked_for() -> None:
    program = "import sys, geocontact as gc; early = 'numpy' in sys.modules; gc.Motion; print(early)"
    done = subprocess.run([sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False"
