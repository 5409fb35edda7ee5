"""A CasADi function that reads and writes arrays in place: several times as fast as with CasADi's own matrices."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

if TYPE_CHECKING:
    from casadi import Function


class Buffered:
    """Called with arrays, gives arrays that the next call overwrites; outputs must be dense.

    Parameters
    ----------
    function
        Of columns and matrices; these are passed and given column by column.
    """

    def __init__(self, function: Function) -> None:
        self._buffer, self._run = function.buffer()
        self.function = function
        self._inputs = [np.zeros(function.nnz_in(k)) for k in range(function.n_in())]
        self._outputs = [np.zeros(function.nnz_out(k)) for k in range(function.n_out())]
        for k, each in enumerate(self._inputs):
            self._buffer.set_arg(k, memoryview(each))  # type: ignore[call-arg, arg-type]  # its stubs tell another form
        for k, each in enumerate(self._outputs):
            self._buffer.set_res(k, memoryview(each))  # type: ignore[call-arg, arg-type]  # likewise

    def __call__(self, *values: Float[np.ndarray, ...]) -> list[Float[np.ndarray, " k"]]:
        """Outputs, each in one row. ValueError for more or fewer numbers than an input has: one is not for all."""
        for place, value in zip(self._inputs, values, strict=True):
            if value.size != place.size:
                raise ValueError(f"{value.size} numbers for {place.size} symbols")
            place[:] = value.ravel()
        self._run()
        return self._outputs
