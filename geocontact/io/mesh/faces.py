"""Face-index files: which faces of a mesh are meant."""

from __future__ import annotations

from os import PathLike, fspath
from pathlib import Path

import numpy as np
from jaxtyping import Int

from geocontact.data.errors import InputError
from geocontact.io.text.file_preflight import BYTE_ORDER_MARK, integer, lines, read_text_bytes, shown


def read_face_indices(path: str | PathLike[str], count: int) -> Int[np.ndarray, " k"]:
    """Face numbers of a text file, in its order: 0-based, separated by blanks, commas or line ends; `#` comments.

    Refused with the line: what is no integer, a number outside 0 … `count` − 1 (the faces of the mesh), a number that
    was there before. A file without any number is refused too.
    """
    name = Path(fspath(path)).name
    data = read_text_bytes(path).removeprefix(BYTE_ORDER_MARK)
    seen: dict[int, int] = {}
    for number, line in enumerate(lines(data), start=1):
        for word in line.partition(b"#")[0].replace(b",", b" ").split():
            try:
                face = integer(word)
            except ValueError:
                remedy = "list 0-based face indices, separated by blanks, commas or line ends"
                raise InputError(name, f"line {number}", f"{shown(word)} is not a face index", remedy) from None
            if not 0 <= face < count:
                remedy = "indices start at 0; is the list for another mesh?"
                what = f"face {face} is outside 0 to {count - 1}, the faces of the mesh"
                raise InputError(name, f"line {number}", what, remedy)
            if face in seen:
                what = f"face {face} is listed already in line {seen[face]}"
                raise InputError(name, f"line {number}", what, "list every face once")
            seen[face] = number
    if not seen:
        raise InputError(name, "", "lists no faces", "list 0-based face indices")
    return np.array(list(seen), dtype=np.int64)
