"""The sources of the site: a copy of the pages in which what is generated stands beside what is written.

Pages keep their places, so that a link that works in the repository works on the site.
"""

from __future__ import annotations

import re
import shutil
from pathlib import Path

from website.contents import with_contents

ROOT = Path(__file__).resolve().parents[1]
PAGES = ("docs/**/*.md", "notebooks/*.ipynb")
LINK = re.compile(r"\]\(([^)\s#]+)[^)\s]*\)")
INDEX = "docs/index.md"
PRINTED = re.compile(r"^```text\n(.*?^```)$", re.MULTILINE | re.DOTALL)
COLUMNS = re.compile(r"\S {2,}\S.* {2,}\S")
"""A line of a table that a command prints."""


def pages() -> list[Path]:
    """Pages and notebooks of the repository, relative to it."""
    return sorted(path.relative_to(ROOT) for pattern in PAGES for path in ROOT.glob(pattern))


def stage(out: Path, generated: dict[str, str]) -> None:
    """Fill `out` with the pages, the files that they link to, and the `generated` ones (place: text)."""
    shutil.rmtree(out, ignore_errors=True)
    for page in pages():
        _copy(page, out)
        if page.suffix == ".md":
            staged = out / page
            staged.write_text(with_tables_marked(staged.read_text(encoding="utf-8")), encoding="utf-8")
        for file in linked_files(page):
            _copy(file, out)
    for place, text in generated.items():
        target = out / place
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(text, encoding="utf-8")
    index = out / INDEX
    index.write_text(with_contents(index.read_text(encoding="utf-8"), generated), encoding="utf-8")


def with_tables_marked(text: str) -> str:
    """A page in which what commands print in columns is marked as such: its lines are not broken."""
    marked = "```{code-block} text\n:class: columns\n\n"
    return PRINTED.sub(lambda one: marked + one[1] if COLUMNS.search(one[1]) else one[0], text)


def linked_files(page: Path) -> list[Path]:
    """Files of the repository that a page links to and that are no pages: figures, scripts."""
    targets = LINK.findall((ROOT / page).read_text(encoding="utf-8"))
    found = [(ROOT / page.parent / target).resolve() for target in targets if ":" not in target]
    return [file.relative_to(ROOT) for file in found if file.is_file() and file.suffix not in {".md", ".ipynb"}]


def _copy(file: Path, out: Path) -> None:
    target = out / file
    target.parent.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(ROOT / file, target)
