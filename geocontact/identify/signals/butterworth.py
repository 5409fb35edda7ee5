"""Butterworth's low-pass of order two and three as `scipy.signal` has it, to the last digit.

`scipy.signal` takes 0.4 s to import, and numba with one kernel 0.3: longer than many a recording takes to be filtered.
"""

from __future__ import annotations

import sys

import numpy as np
from jaxtyping import Float, Shaped

DOUBLE, SINGLE = np.array([1.0, 2.0, 1.0]), np.array([1.0, 1.0, 0.0])
"""Numerators of sections: two zeros at Nyquist's frequency, or one there and one at the origin."""
FEW = 5000
"""Rows that take less time one after the other, 6 us each, than numba takes to be imported."""


def sections(order: int, corner: float, step: float) -> Float[np.ndarray, "s six"]:
    """Low-pass of a corner [Hz] at samples a step [s] apart: b0 b1 b2 1 a1 a2 of each section of second order.

    Poles of the analogue filter on a circle, warped and mapped by the bilinear transform (Oppenheim & Schafer 2010,
    Discrete-Time Signal Processing, sec. 7.2); half the power passes at the corner. ValueError for an order other than
    two and three.
    """
    if order not in (2, 3):
        raise ValueError(f"a low-pass of order 2 or 3 is designed, not {order}")
    warped = 4.0 * np.tan(np.pi * (2.0 * corner / (1.0 / step)) / 2.0)
    poles = warped * -np.exp(1j * np.pi * np.arange(1.0 - order, order, 2.0) / (2.0 * order))
    gain = warped**order * np.real(1.0 / np.prod(4.0 - poles))
    mapped = (4.0 + poles) / (4.0 - poles)
    pole = 0.5 * (mapped[-1] + np.conj(mapped[0]))
    swinging = np.poly([pole, np.conj(pole)]).real
    if order == 2:
        return np.array([[*gain * DOUBLE, *swinging]])
    settling = np.poly([mapped[1].real, 0.0])
    zeros = (DOUBLE, SINGLE) if pole.real > -0.5 else (SINGLE, DOUBLE)  # a pole goes with the zeros that are nearest
    return np.array([[*gain * zeros[0], *settling], [*zeros[1], *swinging]])


def settled(filters: Float[np.ndarray, "s six"]) -> Float[np.ndarray, "s two"]:
    """State of each section after a long time at an input of 1, that of the section before it going in.

    The state z of one section with the input 1 and the output y = b0 + z1 stays as it is:
    z1 = b1 - a1 y + z2 and z2 = b2 - a2 y.
    """
    found, level = np.empty((len(filters), 2)), 1.0
    for k, (b0, b1, b2, _, a1, a2) in enumerate(filters):
        found[k] = level * np.linalg.solve([[1.0 + a1, -1.0], [a2, 1.0]], [b1 - a1 * b0, b2 - a2 * b0])
        level *= (b0 + b1 + b2) / (1.0 + a1 + a2)
    return found


def filtered(
    filters: Float[np.ndarray, "s six"], values: Shaped[np.ndarray, "t n"], state: Float[np.ndarray, "s two n"]
) -> tuple[Float[np.ndarray, "t n"], Float[np.ndarray, "s two n"]]:
    """Values after all sections, and their state afterwards, in double precision; neither argument is changed."""
    found, left = np.array(values, float, order="C"), np.array(state, float, order="C")
    if len(filters) * len(found) <= FEW and "numba" not in sys.modules:
        _row_by_row(filters, found, left)
    else:
        from geocontact.identify.signals.butterworth_kernel import pass_through  # late: numba

        pass_through(np.ascontiguousarray(filters), found, left)
    return found, left


def _row_by_row(
    filters: Float[np.ndarray, "s six"], values: Float[np.ndarray, "t n"], state: Float[np.ndarray, "s two n"]
) -> None:
    """What `butterworth_kernel.pass_through` does, in the same order of operations: equal to the last digit."""
    y, product = np.empty((2, values.shape[1]))
    with np.errstate(all="ignore"):  # as silent as the kernel
        for (b0, b1, b2, _, a1, a2), (first, second) in zip(filters, state, strict=True):
            for x in values:
                np.multiply(x, b0, out=y)
                y += first
                np.multiply(x, b1, out=first)
                first -= np.multiply(y, a1, out=product)
                first += second
                np.multiply(x, b2, out=second)
                second -= np.multiply(y, a2, out=product)
                x[:] = y
