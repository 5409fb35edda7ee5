"""What a release says of itself is the same wherever it is said; an installed wheel works, and so do its extras."""

from __future__ import annotations

import datetime as dt
import json
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
import yaml

from geocontact.data.version import VERSION

ROOT = Path(__file__).resolve().parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
CITATION = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
PAGE = ROOT / "geocontact" / "view" / "page"


def test_the_version_is_the_same_everywhere() -> None:
    assert PROJECT["version"] == CITATION["version"] == VERSION
    newest = re.search(r"^## (\S+)(?: \((\S+)\))?$", (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"), re.MULTILINE)
    assert newest is not None
    if newest[1] != "Unreleased":
        assert newest[1] == VERSION
        assert dt.date.fromisoformat(newest[2]) == CITATION["date-released"]


def test_the_citation_says_what_the_package_is() -> None:
    """Required keys of the Citation File Format 1.2.0, and what pyproject.toml says too."""
    assert CITATION["cff-version"] == "1.2.0" and CITATION["type"] == "software"
    assert CITATION["title"] == PROJECT["name"] and CITATION["license"] == PROJECT["license"]
    assert CITATION["keywords"] == PROJECT["keywords"] and CITATION["message"] and CITATION["authors"]
    assert " ".join(CITATION["abstract"].split()).startswith(PROJECT["description"])


def test_every_bundled_part_has_its_notice() -> None:
    """What the lock of the page's front end brings into the bundle: all but what builds it."""
    notice = (ROOT / "NOTICE").read_text(encoding="utf-8")
    lock = json.loads((PAGE / "front" / "package-lock.json").read_text(encoding="utf-8"))["packages"]
    tools = re.compile(r"node_modules/(@esbuild/.+|esbuild)")
    bundled = {
        name.removeprefix("node_modules/"): each for name, each in lock.items() if name and not tools.fullmatch(name)
    }
    assert bundled.keys() == {"three"}, "name it in NOTICE, with its licence"
    assert f"three.js {bundled['three']['version']}, {bundled['three']['license']} licence" in notice
    assert (PAGE / "bundle" / "THREE-LICENSE").read_text(encoding="utf-8").strip() in notice
    assert set(PROJECT["license-files"]) == {"LICENSE", "NOTICE", "geocontact/view/page/bundle/THREE-LICENSE"}


def test_every_extra_is_tried_from_the_wheel() -> None:
    text = (ROOT / ".ci" / "try_wheel.py").read_text(encoding="utf-8")
    tried = set(re.findall(r'^    "(\w+)": Extra\(', text, re.MULTILINE))
    assert tried == set(PROJECT["optional-dependencies"]) - {"all", "test", "oracle"}


@pytest.mark.slow
@pytest.mark.long
def test_an_installed_wheel_works_with_and_without_its_extras(tmp_path: Path) -> None:
    """Ten minutes and the network: packages are installed from where pip finds them."""
    if subprocess.run(
        [sys.executable, "-m", "pip", "download", "--no-deps", "-d", tmp_path, "six"], capture_output=True
    ).returncode:
        pytest.skip("pip finds no packages from here")
    script = ROOT / ".ci"
    dist = tmp_path / "dist"
    for command in (
        [script / "build_release.py", dist],
        [script / "try_wheel.py", dist / f"geocontact-{VERSION}-py3-none-any.whl"],
    ):
        done = subprocess.run([sys.executable, *map(str, command)], capture_output=True, text=True, cwd=tmp_path)
        assert done.returncode == 0, done.stdout + done.stderr
