"""Lines of a text mesh, a block at a time, so that a large file never stands in memory as Python objects."""

from __future__ import annotations

import re
import warnings
from array import array
from collections.abc import Iterator

import numpy as np
from jaxtyping import Int

from geocontact.data.errors import InputWarning

BLOCK = 1 << 21
"""Bytes that are split into words at once."""

BYTE_ORDER_MARK = b"\xef\xbb\xbf"

_BLANK = re.compile(rb"\s")
_WITH_COMMA = re.compile(rb"[-+]?[0-9]*,[0-9]+([eE][-+]?[0-9]+)?")
_COMMA = "has a decimal comma"


def lines(data: bytes, start: int = 0) -> Iterator[bytes]:
    """Lines of `data` from byte `start` on, without their ends (LF, CR LF or CR)."""
    while start < len(data):
        cut = data.find(b"\n", start + BLOCK)
        stop = len(data) if cut < 0 else cut + 1
        yield from data[start:stop].splitlines()
        start = stop


def is_number(word: bytes) -> bool:
    """Whether a word is a number; `nan` and `inf` are, Python's `1_000` is not."""
    try:
        float(word)
    except ValueError:
        return False
    return b"_" not in word


def require_numbers(words: list[bytes]) -> None:
    """ValueError names the first word that is no number (`is_number`)."""
    try:
        for _ in map(float, words):
            pass
        plain = not any(b"_" in word for word in words)
    except ValueError:
        plain = False
    if not plain:
        word = next(word for word in words if not is_number(word))
        raise ValueError(f"{shown(word)} {_COMMA if _WITH_COMMA.fullmatch(word) else 'is not a number'}")


def remedy(error: Exception, usual: str) -> str:
    """What to do about numbers that `require_numbers` refused; the usual remedy unless they have decimal commas."""
    return "export it with decimal points" if _COMMA in str(error) else usual


def integer(word: bytes) -> int:
    """A word as an integer; ValueError when it is none. Python's `1_000` is none here."""
    if b"_" in word or len(word) > 18:
        raise ValueError(f"{shown(word)} is not an integer of a mesh")
    return int(word)


def count_of_numbers(text: bytes, *, integers: bool) -> int:
    """How many numbers a text holds that blanks separate; ValueError names the first word that is none."""
    count = start = 0
    while start < len(text):
        cut = _BLANK.search(text, start + BLOCK)
        stop = cut.start() if cut else len(text)
        words = text[start:stop].split()
        count += len(words)
        if integers:
            for word in words:
                integer(word)
        else:
            require_numbers(words)
        start = stop
    return count


def shown(word: bytes) -> str:
    """A word of a file as it is quoted in a message: at most 24 characters, nothing but printable ASCII."""
    text = word[:24].decode("ascii", "backslashreplace")
    return "".join(c if c.isprintable() else f"\\x{ord(c):02x}" for c in text).join("''")


def as_integers(values: array[int]) -> Int[np.ndarray, " n"]:
    """The numbers of an `array("q")`, not copied."""
    return np.frombuffer(values, np.int64) if values else np.empty(0, np.int64)


def warn_open_end(data: bytes, file: str) -> None:
    """Warn when a format without an end mark does not end with a line end: its last number may be cut short."""
    if not data.endswith((b"\n", b"\r")):
        message = f"{file}: the last line has no line end; make sure that the file is complete"
        warnings.warn(InputWarning(message), stacklevel=3)
