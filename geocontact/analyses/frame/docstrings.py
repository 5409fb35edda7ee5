"""What the docstring of options says of each of them, and the heading that it stands under."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise


@dataclass
class Documented:
    """One option in its docstring.

    Parameters
    ----------
    section
        Heading above it in the list of parameters, "" where there is none.
    lines
        Its text.
    """

    section: str
    lines: list[str] = field(default_factory=list)

    @property
    def words(self) -> str:
        """The text in one line."""
        return " ".join(self.lines)


def documented(docstring: str) -> dict[str, Documented]:
    """What the section Parameters of a numpy docstring says of each name; names may share a text.

    A line above dashes, as far to the left as the names, is a heading: what follows belongs together, down to the next
    one.
    """
    found: dict[str, Documented] = {}
    names: tuple[str, ...] = ()
    heading = ""
    _, _, section = docstring.partition("Parameters\n")
    lines = [line for line in section.splitlines()[1:] if line.strip()]
    margin = min((_indent(line) for line in lines), default=0)
    for line, below in pairwise([*lines, ""]):
        if _indent(line) > margin:
            for name in names:
                found[name].lines.append(line.strip())
        elif _dashes(below):
            heading, names = line.strip(), ()
        elif not _dashes(line):
            names = tuple(part.strip() for part in line.split(","))
            found |= {name: Documented(heading) for name in names}
    return found


def _indent(line: str) -> int:
    return len(line) - len(line.lstrip())


def _dashes(line: str) -> bool:
    return bool(line.strip()) and not line.strip().strip("-")
