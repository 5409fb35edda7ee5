"""A numpy docstring in its parts, and its words as Markdown."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from inspect import cleandoc


@dataclass
class Parts:
    """What a docstring says.

    Parameters
    ----------
    words
        Paragraphs before the first section, without examples.
    sections
        Lines below each heading.
    """

    words: list[str] = field(default_factory=list)
    sections: dict[str, list[str]] = field(default_factory=dict)


def parts(docstring: str) -> Parts:
    """Its paragraphs and sections; what stands between the last entry of a section and the end belongs to the words."""
    lines = cleandoc(docstring).splitlines()
    heads = [i for i, line in enumerate(lines[1:]) if re.fullmatch(r"-{3,}", line)]
    found = Parts(_paragraphs(lines[: heads[0]] if heads else lines))
    for head, end in zip(heads, [*heads, len(lines)][1:], strict=True):
        body = lines[head + 2 : end]
        late = next((i for i, line in enumerate(body) if i and not body[i - 1] and _is_sentence(line)), len(body))
        found.sections[lines[head].strip()] = body[:late]
        found.words += _paragraphs(body[late:])
    return found


def entry_list(lines: list[str]) -> list[tuple[str, str]]:
    """Names and texts of a section; names that share a text stay together."""
    found: list[tuple[str, list[str]]] = []
    for line in lines:
        if line.strip() and not line.startswith(" "):
            found.append((line.strip(), []))
        elif line.strip() and found:
            found[-1][1].append(line.strip())
    return [(name, " ".join(words)) for name, words in found]


def markdown(words: str) -> str:
    """Plain words as Markdown: what is not in backticks loses the meaning that Markdown would give it."""
    pieces = re.split(r"(`[^`]*`)", words)
    return "".join(piece if i % 2 else re.sub(r"([<>*_$|\[\]])", r"\\\1", piece) for i, piece in enumerate(pieces))


def cell(words: str) -> str:
    """The same for a cell of a table."""
    pieces = re.split(r"(`[^`]*`)", words)
    return "".join(piece.replace("|", r"\|") if i % 2 else markdown(piece) for i, piece in enumerate(pieces))


def _is_sentence(line: str) -> bool:
    return bool(re.match(r"[A-Z`].*\s.*[.:]$|[A-Z].{60,}", line))


def _paragraphs(lines: list[str]) -> list[str]:
    told = "\n".join(lines).split("\n\n")
    return [part.strip("\n") for part in told if part.strip() and not part.lstrip().startswith(">>>")]
