"""The part of the lock that `make demo` installs: entries unchanged, nothing missing."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SPEC = importlib.util.spec_from_file_location("core_lock", ROOT / ".ci" / "core_lock.py")
assert SPEC is not None
assert SPEC.loader is not None
core_lock = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(core_lock)

LOCK = """\
numpy==2.4.6 ; python_full_version < '3.12' \\
    --hash=sha256:aa \\
    --hash=sha256:bb
numpy==2.5.5 ; python_full_version >= '3.12' \\
    --hash=sha256:cc
python-fcl==0.7.0.11 \\
    --hash=sha256:dd
vtk==9.7.2 \\
    --hash=sha256:ee
"""


def test_entries_are_kept_whole() -> None:
    assert core_lock.subset(LOCK, ["NumPy", "python_fcl"]) == LOCK[: LOCK.index("vtk")]
    assert core_lock.subset(LOCK, ["numpy", "python-fcl", "vtk"]) == LOCK


def test_pins_carry_versions_and_markers_only() -> None:
    assert core_lock.pins(LOCK).splitlines() == [
        "numpy==2.4.6 ; python_full_version < '3.12'",
        "numpy==2.5.5 ; python_full_version >= '3.12'",
        "python-fcl==0.7.0.11",
        "vtk==9.7.2",
    ]


def test_a_package_without_a_pin_is_refused() -> None:
    with pytest.raises(SystemExit, match=r"lacks scipy: make lock"):
        core_lock.subset(LOCK, ["scipy", "numpy"])


def test_the_real_lock_is_read_completely() -> None:
    text = (ROOT / "requirements.lock").read_text(encoding="utf-8")
    assert "".join(entry for _, entry in core_lock.entries(text)) == text


def test_what_only_builds_is_left_out(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    """pip would bring cython with python-fcl, whose wheel does not import it."""
    monkeypatch.setattr(core_lock, "needed", lambda _direct, _pins: ["numpy", "Cython", "python-fcl"])
    core_lock.main()
    written = [name for name, _ in core_lock.entries(capsys.readouterr().out)]
    assert set(written) == {"numpy", "python-fcl"}
