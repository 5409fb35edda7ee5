"""The side bar of the site, read from the tables of docs/index.md: a page that the index does not name is a warning."""

from __future__ import annotations

import re
from collections.abc import Iterable

LINK = re.compile(r"\]\(([^)\s#]+\.(?:md|ipynb))[^)\s]*\)")
ROW = re.compile(r"^\| (?!topic|you want|system|-)([^|]+?) \|")
UNBUILT = "`make docs` builds a site with a page for each of them"
"""What the index says of pages that only the site has."""
MORE = "More of it:"
"""Begins links to pages that stand in the rows of their topics."""


def with_contents(index: str, generated: Iterable[str]) -> str:
    """The index with a hidden list of pages for each section, and for each row of a section's table.

    Generated pages below docs/reference/api are listed by their own index.
    """
    lists = [(caption, pages) for caption, pages in listed(index) if pages]
    if "docs/reference/api/index.md" in generated:
        lists.append(("Functions", ["reference/api/index.md"]))
        index = index.replace(UNBUILT, "[a page for each of them](reference/api/index.md)")
    return index + "".join(_toctree(caption, pages) for caption, pages in lists)


def listed(index: str) -> list[tuple[str, list[str]]]:
    """Caption and pages of each list, in the order of the index; a page stands in one list only."""
    seen: set[str] = set()
    found: list[tuple[str, list[str]]] = []
    for part in re.split(r"^## ", index, flags=re.MULTILINE)[1:]:
        heading, _, text = part.partition("\n")
        for line in text.splitlines():
            row = ROW.match(line)
            caption = f"{heading}: {row[1]}" if row and heading != "Tutorial" else heading
            pages = [page for page in dict.fromkeys(LINK.findall(line.partition(MORE)[0])) if page not in seen]
            seen.update(pages)
            if found and found[-1][0] == caption:
                found[-1][1].extend(pages)
            else:
                found.append((caption, pages))
    return found


def _toctree(caption: str, pages: Iterable[str]) -> str:
    names = "\n".join("/" + _from_root(page).rpartition(".")[0] for page in pages)
    return f"\n```{{toctree}}\n:hidden:\n:caption: {caption}\n\n{names}\n```\n"


def _from_root(page: str) -> str:
    return page.removeprefix("../") if page.startswith("../") else f"docs/{page}"
