"""Lines of a text mesh, a block at a time, so that a large file never stands in memory as Python objects."""

from __future__ import annotations

import re
import warnings
from array import array
from collections.abc import Iterator

import numpy as np
from jaxtyping import Float, Int

from geocontact.data.errors import InputWarning

BLOCK = 1 << 21
"""Bytes that are split into words at once."""

BYTE_ORDER_MARK = b"\xef\xbb\xbf"

_BLANK = re.compile(rb"\s")


def lines(data: bytes, start: int = 0) -> Iterator[bytes]:
    """Lines of `data` from byte `start` on, without their ends (LF, CR LF or CR)."""
    while start < len(data):
        cut = data.find(b"\n", start + BLOCK)
        stop = len(data) if cut < 0 else cut + 1
        yield from data[start:stop].splitlines()
        start = stop


def numbers(words: list[bytes]) -> list[float]:
    """Words as numbers; ValueError names the first that is none. `nan` and `inf` pass, Python's `1_000` does not."""
    values = list(map(float, words))
    for word in words:
        if b"_" in word:
            raise ValueError(f"{shown(word)} is not a number")
    return values


def integer(word: bytes) -> int:
    """A word as an integer; ValueError when it is none. Python's `1_000` is none here."""
    if b"_" in word or len(word) > 18:
        raise ValueError(f"{shown(word)} is not an integer of a mesh")
    return int(word)


def as_numbers(text: bytes, *, integers: bool) -> np.ndarray:
    """All numbers of a text that blanks separate, float64 or int64; ValueError names the first that is none."""
    floats, whole = array("d"), array("q")
    start = 0
    while start < len(text):
        cut = _BLANK.search(text, start + BLOCK)
        stop = cut.start() if cut else len(text)
        words = text[start:stop].split()
        if integers:
            whole.extend(map(integer, words))
        else:
            floats.extend(numbers(words))
        start = stop
    return as_integers(whole) if integers else as_floats(floats)


def shown(word: bytes) -> str:
    """A word of a file as it is quoted in a message: at most 24 characters, nothing but printable ASCII."""
    text = word[:24].decode("ascii", "backslashreplace")
    return "".join(c if c.isprintable() else f"\\x{ord(c):02x}" for c in text).join("''")


def as_floats(values: array[float]) -> Float[np.ndarray, " n"]:
    """The numbers of an `array("d")`, not copied."""
    return np.frombuffer(values, np.float64) if values else np.empty(0)


def as_integers(values: array[int]) -> Int[np.ndarray, " n"]:
    """The numbers of an `array("q")`, not copied."""
    return np.frombuffer(values, np.int64) if values else np.empty(0, np.int64)


def warn_open_end(data: bytes, file: str) -> None:
    """Warn when a format without an end mark does not end with a line end: its last number may be cut short."""
    if not data.endswith((b"\n", b"\r")):
        message = f"{file}: the last line has no line end; make sure that the file is complete"
        warnings.warn(InputWarning(message), stacklevel=3)
