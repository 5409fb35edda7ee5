"""A benchmark's commit: that of the checkout, and no error where there is none."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from benchmarks.machine import commit, stamp

needs_git = pytest.mark.skipif(shutil.which("git") is None, reason="git is not installed")


def repository(folder: Path) -> str:
    """A repository with one commit; the commit's short name."""
    folder.mkdir()
    (folder / "file").write_text("content", encoding="utf-8")
    person = ["-c", "user.name=A Person", "-c", "user.email=person@example.org"]
    for words in (["init", "-q"], ["add", "file"], [*person, "commit", "-q", "-m", "one"]):
        subprocess.run(["git", *words], cwd=folder, check=True)
    head = (folder / ".git" / "HEAD").read_text(encoding="utf-8").split()[-1]
    return (folder / ".git" / head).read_text(encoding="utf-8").strip()


@needs_git
def test_commit_of_a_checkout_is_read(tmp_path: Path) -> None:
    full = repository(tmp_path / "one")
    found = commit(tmp_path / "one")
    assert len(found) >= 7
    assert full.startswith(found)


@needs_git
def test_copy_inside_of_another_repository_has_no_commit_of_its_own(tmp_path: Path) -> None:
    repository(tmp_path / "one")
    (tmp_path / "one" / "copy").mkdir()
    assert commit(tmp_path / "one" / "copy") == "unknown"


def test_folder_without_a_repository_has_none(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("GIT_CEILING_DIRECTORIES", str(tmp_path.parent))
    assert commit(tmp_path) == "unknown"


def test_results_are_stamped_where_git_is_not_installed(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    assert stamp()["commit"] == "unknown"
