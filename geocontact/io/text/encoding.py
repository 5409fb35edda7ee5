"""How the bytes of a text file are to be read: UTF-8, or Latin-1 as older programs write it."""

from __future__ import annotations

import warnings
from codecs import getincrementaldecoder
from os import PathLike, fspath
from pathlib import Path

from geocontact.data.errors import InputWarning

UTF8, LATIN1 = "utf-8-sig", "latin-1"
PIECE = 1 << 20


def encoding_of(path: str | PathLike[str]) -> str:
    """UTF-8 where the whole file is that; else Latin-1, with a warning that names the first byte that is not."""
    decoder, before = getincrementaldecoder("utf-8")(), 0
    with Path(path).open("rb") as stream:
        while piece := stream.read(PIECE):
            try:
                decoder.decode(piece)
            except UnicodeDecodeError as error:
                _warn(path, before + error.start)
                return LATIN1
            before += len(piece)
    return UTF8


def decoded(data: bytes, path: str | PathLike[str]) -> str:
    """The same of bytes that were read."""
    try:
        return data.decode(UTF8)
    except UnicodeDecodeError as error:
        _warn(path, error.start)
        return data.decode(LATIN1)


def _warn(path: str | PathLike[str], byte: int) -> None:
    what = f"byte {byte} is not UTF-8; the file is read as Latin-1"
    warnings.warn(InputWarning(f"{fspath(path)}: {what}"), stacklevel=4)
