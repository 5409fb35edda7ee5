"""What the repository promises about itself: two commands, pinned locks, no addresses, links that lead somewhere."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
TEXTS = sorted(
    path
    for pattern in ("*.md", "*.toml", "Makefile", "*.lock", ".pre-commit-config.yaml", ".ci/*", "docs/**/*.md")
    for path in ROOT.glob(pattern)
    if path.is_file()
)
PAGES = [path for path in TEXTS if path.suffix == ".md"]


def named(path: Path) -> str:
    return path.relative_to(ROOT).as_posix()


def pins(lock: str) -> dict[str, str]:
    """Pin lines by name and marker, with the hashes that follow."""
    text = (ROOT / lock).read_text(encoding="utf-8")
    return {
        entry.split("\\\n")[0].strip(): entry for entry in re.findall(r"^[a-z].*\n(?:[ \t]+.*\n)*", text, re.MULTILINE)
    }


def test_quick_start_is_two_commands() -> None:
    section = (ROOT / "README.md").read_text(encoding="utf-8").split("\n## Quick start\n")[1].split("\n## ")[0]
    blocks = re.findall(r"^```\w*\n(.*?)^```$", section, re.MULTILINE | re.DOTALL)
    assert "".join(blocks).split("\n") == ["make demo", "make test", ""]


@pytest.mark.parametrize(("page", "lines"), [("VISION.md", 10), ("README.md", 120)])
def test_it_is_short(page: str, lines: int) -> None:
    assert len((ROOT / page).read_text(encoding="utf-8").splitlines()) <= lines


@pytest.mark.parametrize("path", PAGES, ids=named)
def test_links_lead_somewhere(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    for target in re.findall(r"\]\(([^)\s]+)\)", text):
        file, _, anchor = target.partition("#")
        if re.match(r"[a-z]+:", file):
            continue
        there = (path.parent / file).resolve() if file else path
        assert there.exists(), target
        headings = re.findall(r"^#+ (.*)$", there.read_text(encoding="utf-8"), re.MULTILINE) if anchor else []
        assert not anchor or anchor in {anchor_of(heading) for heading in headings}, target


def anchor_of(heading: str) -> str:
    """As GitHub and the site make it: small letters, blanks to hyphens, and no punctuation."""
    return re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-")


@pytest.mark.parametrize("path", TEXTS, ids=named)
def test_names_no_package_index_and_no_home(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    assert not re.search(r"https?://\S*(pypi|simple|pythonhosted|artifact|conda)", text)
    assert not re.search(r"^\s*--?(i|f|index-url|extra-index-url|find-links)[ =]", text, re.MULTILINE)
    assert not re.search(r"(^|[\s\"'(])/(home|root|work|Users|opt)/", text)


@pytest.mark.parametrize("lock", ["requirements.lock", "requirements-oracle.lock"])
def test_every_pin_has_a_hash(lock: str) -> None:
    for pin, entry in pins(lock).items():
        assert re.fullmatch(r"[a-z0-9-]+==[^\s;]+( ; .+)?", pin), pin
        assert "--hash=sha256:" in entry, pin


def test_locks_agree() -> None:
    both = pins("requirements-oracle.lock")
    assert {pin: both.get(pin) for pin in pins("requirements.lock")} == pins("requirements.lock")


def test_locks_hold_every_requirement() -> None:
    extras = PROJECT["project"]["optional-dependencies"]
    wanted = [*PROJECT["project"]["dependencies"], *PROJECT["dependency-groups"]["build"]]
    for lock, more in (("requirements.lock", set(extras) - {"oracle"}), ("requirements-oracle.lock", set(extras))):
        direct = [*wanted, *(line for extra in more for line in extras[extra] if not line.startswith("geocontact"))]
        names = {re.split(r"[^A-Za-z0-9-]", line)[0].lower() for line in direct}
        assert names <= {pin.partition("==")[0] for pin in pins(lock)}


def test_every_extra_is_used() -> None:
    """Each package that an extra of the program brings is imported somewhere; a probe of `doctor` does not count."""
    extras = PROJECT["project"]["optional-dependencies"]
    lines = [line for extra in set(extras) - {"all", "docs", "test", "oracle"} for line in extras[extra]]
    texts = [file.read_text(encoding="utf-8") for file in ROOT.glob("geocontact/**/*.py") if file.stem != "doctor"]
    imported = {name for text in texts for name in re.findall(r"^\s*(?:from|import) (\w+)", text, re.MULTILINE)}
    assert {re.split(r"[^A-Za-z0-9-]", line)[0].replace("-", "_") for line in lines} <= imported


def test_every_ignored_lint_rule_has_a_reason() -> None:
    text = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    rules = text.split("\nignore = [\n")[1].split("\n]\n")[0]
    assert all(re.search(r"#\s+\w+", line) for line in rules.splitlines()), rules


def test_version_is_one() -> None:
    import geocontact

    assert geocontact.__version__ == PROJECT["project"]["version"]


def test_a_class_name_stands_for_one_thing() -> None:
    """`gc.chain.Motion` is a link of a model of one's own, `gc.Motion` poses over time: both names are public."""
    found: dict[str, list[str]] = {}
    for file in sorted(ROOT.glob("geocontact/**/*.py")):
        for name in re.findall(r"^class (\w+)", file.read_text(encoding="utf-8"), re.MULTILINE):
            found.setdefault(name, []).append(named(file))
    assert {name: files for name, files in found.items() if len(files) > 1}.keys() <= {"Motion"}
