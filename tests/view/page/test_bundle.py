"""The built front end is what its record says, was built from these sources, and asks nobody for anything."""

from __future__ import annotations

import hashlib
import json
import re
import tomllib
from pathlib import Path

import pytest

from geocontact.view.page.write import page_html
from tests.view.page.examples import small_page

PAGE = Path(__file__).resolve().parents[3] / "geocontact" / "view" / "page"
FRONT, BUNDLE = PAGE / "front", PAGE / "bundle"
RECORD = tomllib.loads((BUNDLE / "bundle.toml").read_text(encoding="utf-8"))
SCRIPT = (BUNDLE / "page.js").read_text(encoding="utf-8")


def sha256(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


@pytest.mark.parametrize("name", sorted(RECORD["built"]))
def test_built_files_are_those_of_the_record(name: str) -> None:
    assert sha256(BUNDLE / name) == RECORD["built"][name]


def test_sources_are_unchanged_since_the_build() -> None:
    now = {name: sha256(FRONT / name) for name in RECORD["sources"]}
    assert now == RECORD["sources"], "build again: npm ci && npm run build in geocontact/view/page/front"


def test_every_source_is_in_the_record() -> None:
    assert {f"src/{file.name}" for file in (FRONT / "src").iterdir()} <= set(RECORD["sources"])
    assert {file.name for file in BUNDLE.iterdir()} == {*RECORD["built"], "bundle.toml"}


def test_three_is_named_with_version_and_licence() -> None:
    lock = json.loads((FRONT / "package-lock.json").read_text(encoding="utf-8"))
    assert lock["packages"]["node_modules/three"]["version"] == RECORD["three"]
    assert RECORD["licence"] == "MIT"
    assert "MIT" in (BUNDLE / "THREE-LICENSE").read_text(encoding="utf-8")
    assert f"three.js {RECORD['three']}, MIT" in SCRIPT[:200]


def test_every_page_carries_the_whole_licence_of_three() -> None:
    licence = (BUNDLE / "THREE-LICENSE").read_text(encoding="utf-8").strip()
    assert "above copyright notice and this permission notice shall be included" in licence
    assert licence in SCRIPT[:1500]
    assert licence in page_html(small_page())


def test_the_lock_names_no_address() -> None:
    text = (FRONT / "package-lock.json").read_text(encoding="utf-8")
    assert "resolved" not in text
    assert not re.search(r"https?://(?!opencollective|github)", text)


def test_the_script_stands_in_html_as_it_is() -> None:
    assert not re.search(r"<!--|</script|\r", SCRIPT, re.IGNORECASE)


def test_the_script_can_ask_nobody() -> None:
    names = set(re.findall(r"https?://[^\s\"'`)]*", SCRIPT))
    assert all(name.startswith("http://www.w3.org/") for name in names), "names of XML kinds, never fetched"
    ways = r"\bfetch\(|XMLHttpRequest|WebSocket|EventSource|sendBeacon|importScripts|new Worker|\bimport\("
    assert not re.search(ways, SCRIPT)


def test_the_script_makes_no_code_and_no_markup_from_text() -> None:
    assert not re.search(r"\beval\(|new Function|innerHTML|outerHTML|insertAdjacentHTML|document\.write", SCRIPT)
