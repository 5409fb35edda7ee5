"""Who hears of the work while it goes on: nobody, unless the command line brings somebody along."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext


class Listener:
    """Hears nothing; whoever shows something overrides what it hears."""

    def warn(self, line: str) -> None:
        """A reservation, as soon as it is known."""

    def fail(self, line: str) -> None:
        """A part of the work that could not be done, in one line; the rest goes on."""

    def preparing(self) -> AbstractContextManager[None]:
        """Kernels may be compiled in this block, which takes a while once on a machine."""
        return nullcontext()

    def progress(self, label: str, total: int) -> AbstractContextManager[Callable[[], None]]:
        """A block that calls what it is given after each of `total` steps."""
        return nullcontext(lambda: None)

    def stages(self, label: str) -> AbstractContextManager[Callable[[str], None]]:
        """A block that names the stages of its work as they begin."""
        return nullcontext(lambda _: None)
