"""What all searches share: when nothing is gained any more, and how steps are damped."""

from __future__ import annotations

import numpy as np

LIMIT = 200  # steps of a search that ends by itself
CLOSE = 1e-6  # nats, or a share, that is not searched for any further
ROUNDING = float(np.sqrt(np.finfo(float).eps))  # share that half the digits of a number do not show
STEP = float(np.cbrt(np.finfo(float).eps))  # of a magnitude; best for central differences (Numerical Recipes 5.7)

DAMPED = 1e-3  # damping that a search sets out with, as a share of the curvature along each unknown
TENFOLD = 10.0  # factor of the damping after a step that kept its promise and one that did not (Marquardt 1963)
KEPT, BROKEN = 0.75, 0.25  # shares of its promise beyond which damping is lowered, below which it is raised (Moré 1978)
