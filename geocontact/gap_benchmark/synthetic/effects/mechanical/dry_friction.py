"""A strap that rubs, harder where it is pulled tighter; at the shoulder the hinge, harder where it carries more.

planted:   F += F_c (1 + s |u|/D) z, z' = u'/r (1 - |z|^n (g + b sign(u' z))) (Bouc and Wen), n = 1.6..2.5;
           shoulder: T_c (1 + s (|F|/F_most - 0.4)) z at the hinge, z along its angle e
candidate: F_c z, dz/du = (sign(u') - z)/r, or F_c tanh(u'/v); or so at the hinge
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.gap_benchmark.synthetic.compile import loop
from geocontact.gap_benchmark.synthetic.hooks import Hooks, Pull, Swing, Values
from geocontact.gap_benchmark.synthetic.plan import Draw, InjectionPlan, Rng, SyntheticMagnitudes


@loop
def hysteresis(u: Float[np.ndarray, " t"], reach: float, n: float, beta: float) -> Float[np.ndarray, " t"]:
    """z along u, rate-independent: Heun's rule in the displacement, steps far below the reach."""
    z = np.zeros(u.size)
    for i in range(1, u.size):
        du = u[i] - u[i - 1]
        pieces = int(abs(du) / (0.05 * reach)) + 1
        step = du / pieces / reach
        now = z[i - 1]
        for _ in range(pieces):
            first = 1.0 - abs(now) ** n * (1.0 - beta + beta * np.sign(step * now))
            guess = now + step * first
            second = 1.0 - abs(guess) ** n * (1.0 - beta + beta * np.sign(step * guess))
            now = now + 0.5 * step * (first + second)
        z[i] = now
    return z


LEVER = 0.25
"""Between the hinge and where it is loaded [m]."""


def draw(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Amplitude: friction F_c at rest [N]."""
    hinged = scale.system == "shoulder"
    reach = rng.uniform(0.01, 0.05) * (2.0 * scale.span if hinged else scale.high - scale.low)
    n, beta, grip = rng.uniform(1.6, 2.5), rng.uniform(0.5, 0.7), rng.uniform(0.35, 0.6)

    def hooks(limit: float) -> Hooks:
        def rub(p: Pull) -> Values:
            z = hysteresis(p.deflection, reach, n, beta)
            return np.asarray(limit * (1.0 + grip * (np.abs(p.deflection) / scale.stroke - 0.4)) * z)

        def grind(p: Swing) -> Values:
            z = hysteresis(p.angle, reach, n, beta)
            return np.asarray(limit * LEVER * (1.0 + grip * (np.abs(p.load) / scale.force - 0.4)) * z)

        return Hooks(hinge=(grind,)) if hinged else Hooks(beside=(rub,))

    def words(limit: float) -> str:
        size = f"{limit * LEVER:.3g} N m at the hinge" if hinged else f"{limit:.3g} N in the strap"
        return f"dry friction of {size}"

    return Draw(1e-4 * scale.force, 0.4 * scale.force, hooks, words)


DRY_FRICTION = InjectionPlan(
    "dry_friction",
    ("elbow", "shoulder", "sit_to_stand"),
    "Bouc-Wen, limit grows with deflection",
    "Dahl, or tanh of rate",
    draw,
    placed=True,
    together=True,
)
