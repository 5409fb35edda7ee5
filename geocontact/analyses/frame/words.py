"""Words that several pages share."""

from __future__ import annotations

from collections.abc import Sequence

NOT_A_DEVICE = (
    "A research result, not a clinical device: it must not be used to diagnose, "
    "to plan treatment or to select an implant for a patient."
)


MOST = 3  # sentences of a headline; more are left to the page
SIDES = "medial is "  # how the note on sides begins: it explains the answer and is none


def headline(sentences: Sequence[str], most: int = MOST) -> tuple[str, ...]:
    """Sentences of a run as a page's headline: those of one line, with a capital and a full stop; sides come last."""
    answers = sorted(sentences, key=lambda line: line.startswith(SIDES))
    lines = [line for line in answers if line and "\n" not in line][:most]
    return tuple(_sentence(line.replace("mm^2", "mm²")) for line in lines)


def _sentence(line: str) -> str:
    first = line.split(maxsplit=1)[0]
    word = first.rstrip(":,;")
    start = line[0].upper() if len(word) > 1 and word.isalpha() else line[0]  # symbols and files keep their letters
    return f"{start}{line[1:]}" + ("" if line.endswith((".", "!", "?")) else ".")


def rounded(value: float, digits: int = 4) -> str:
    """So many significant digits, without an exponent: "160500", "0.0213"."""
    return f"{float(f'{value:.{digits}g}'):.10g}"


def counted(count: int, noun: str) -> str:
    """ "1 frame", "6 frames": of nouns that take an s."""
    return f"{count} {noun}{'' if count == 1 else 's'}"
