"""What is said when input cannot be used, or can be used only with a reservation."""

from __future__ import annotations

import errno
import os
from dataclasses import dataclass
from os import PathLike, fspath

OF_THE_MACHINE = frozenset(
    {errno.ENOSPC, errno.EDQUOT, errno.EMFILE, errno.ENFILE, errno.EIO, errno.ENOMEM, errno.ESTALE}
)
"""Errors of files that no other input mends: an `OSError` of them stays one, and a command ends with 1."""

_NO_MEMORY = (os.strerror(errno.ENOMEM), "failed to map segment")
"""What the loader of shared libraries writes into an `ImportError` where memory is short (glibc)."""


def memory_is_short(error: ImportError) -> bool:
    """Whether a library that is installed could not be loaded for want of memory, which no other input mends."""
    return not isinstance(error, ModuleNotFoundError) and any(each in str(error) for each in _NO_MEMORY)


@dataclass
class InputError(ValueError):
    """Input that cannot be used; one line names the file, the place, what is wrong and the remedy.

    Raised where the value enters. `place` is a line, column, face or option ("line 6", "face 12"), empty when the
    whole file is meant; `remedy` may be empty when there is nothing the user could do differently.

    >>> import geocontact as gc
    >>> try:
    ...     gc.fit_shape("meshes/sphere_r20.stl", shape="sphere", unit="m")
    ... except gc.InputError as error:
    ...     print(error)
    sphere_r20.stl: bounding box 40 x 40 x 40 m is too large for an implant or a body; the file looks like
    millimetres, pass `unit` mm
    """

    file: str | PathLike[str]
    place: str
    what: str
    remedy: str = ""

    def __str__(self) -> str:
        where = " ".join(part for part in (fspath(self.file), self.place) if part)
        line = f"{where}: {self.what}" if where else self.what
        return " ".join((f"{line}; {self.remedy}" if self.remedy else line).split())


class InputWarning(UserWarning):
    """Input that is used although something about it deserves a look; one line, continued afterwards.

    >>> import geocontact as gc, warnings
    >>> with warnings.catch_warnings(record=True) as caught:
    ...     warnings.simplefilter("always")
    ...     result = gc.shoulder.simulate("meshes/overhead_P1T1S100/markers.trc", side="right")
    >>> issubclass(caught[0].category, gc.InputWarning), str(caught[0].message) == result.warnings[0]
    (True, True)
    """
