"""Command lines of the documentation: what a page types, what it shows below, and which files it brings."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

from tests.house.first_screens import ROOT

DOCUMENTS = (ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md")))
GUIDES = (ROOT / "docs" / "tutorial.md", *sorted((ROOT / "docs" / "how-to").glob("*.md")))
"""Pages on which every block runs as it stands, from an empty folder."""
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```\n(?:\n```text\n(.*?)^```$)?", re.MULTILINE | re.DOTALL)
NAMED = re.compile(r"# ([\w/.-]+\.\w+)\n")
INLINE = re.compile(r"`(geocontact [^`]*)`")
INDENTED = re.compile(r"^    +(geocontact [^\n]*)", re.MULTILINE)


@dataclass(frozen=True)
class ShellBlock:
    """A block of commands or of Python, from 0 among those of its page, and the output that the page shows below it."""

    page: str
    number: int
    code: str
    shown: tuple[str, ...]

    @property
    def whole(self) -> bool:
        """Whether it can be typed: dots stand for what the reader fills in."""
        return "…" not in self.code


def name_of(page: Path) -> str:
    """Of a page, from the root of the repository."""
    return page.relative_to(ROOT).as_posix()


def shell_blocks(page: Path, language: str = "sh") -> list[ShellBlock]:
    """All blocks in which commands are typed, or of `python`, in the order of the page."""
    found = [match for match in BLOCK.finditer(page.read_text(encoding="utf-8")) if match[1] == language]
    return [ShellBlock(name_of(page), k, m[2], tuple((m[3] or "").splitlines())) for k, m in enumerate(found)]


def files_of(page: Path) -> dict[str, str]:
    """Files whose content the page shows, by the name in their first line: `# people.toml`."""
    blocks = (
        match[2] for match in BLOCK.finditer(page.read_text(encoding="utf-8")) if match[1] not in ("sh", "python")
    )
    return {named[1]: text for text in blocks if (named := NAMED.match(text))}


def calls_of(page: Path) -> list[list[str]]:
    """Words of every call of geocontact on a page: in blocks, indented, or in the running text."""
    text = page.read_text(encoding="utf-8")
    typed = "\n".join(match[2] for match in BLOCK.finditer(text) if match[1] == "sh").replace("\\\n", " ")
    lines = [line for line in typed.splitlines() if line.startswith("geocontact ") and "||" not in line]
    lines += [found[1] for pattern in (INLINE, INDENTED) for found in pattern.finditer(text)]
    return [re.split(r"\s#|[>|;]", line)[0].replace("\n", " ").split()[1:] for line in lines]
