"""A viscoelastic solid with two times.

planted:   F += sum g_j (F_el - z_j), z_j' = (F_el - z_j)/tau_j, two branches a factor 7..14 apart in time (knee,
           shoulder, straps 15..30)
           knee, shoulder, straps: of F_el (1 + e (|F_el|/F - 1/2)), e = 0.5..0.8
candidate: one Maxwell branch
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.gap_benchmark.synthetic.compile import loop
from geocontact.gap_benchmark.synthetic.hooks import Hooks, Pull, Values
from geocontact.gap_benchmark.synthetic.plan import ALL, Draw, InjectionPlan, Rng, SyntheticMagnitudes

QUICK = {
    "elbow": (0.1, 0.5),
    "foot": (0.01, 0.03),
    "shoulder": (0.06, 0.12),
    "knee": (0.02, 0.04),
    "sit_to_stand": (0.04, 0.08),
}
"""Range of the shorter time [s]."""
APART = {
    "elbow": (7.0, 14.0),
    "foot": (7.0, 14.0),
    "shoulder": (15.0, 30.0),
    "knee": (15.0, 30.0),
    "sit_to_stand": (15.0, 30.0),
}


@loop
def settled(elastic: Float[np.ndarray, "t n"], h: float, tau: float) -> Float[np.ndarray, "t n"]:
    """z' = (F_el - z)/tau by the trapezoidal rule, at rest in the beginning."""
    out = np.empty(elastic.shape)
    out[0] = elastic[0]
    a = 0.5 * h / tau
    for i in range(1, elastic.shape[0]):
        for j in range(elastic.shape[1]):
            out[i, j] = ((1.0 - a) * out[i - 1, j] + a * (elastic[i, j] + elastic[i - 1, j])) / (1.0 + a)
    return out


def draw(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Amplitude: the share g that relaxes [-]."""
    apart = rng.uniform(*APART[scale.system])
    quick = rng.uniform(*QUICK[scale.system])
    first = rng.uniform(0.4, 0.65)
    bend = rng.uniform(0.5, 0.8) if scale.system in ("shoulder", "knee", "sit_to_stand") else 0.0

    def hooks(g: float) -> Hooks:
        def branches(p: Pull) -> Values:
            h = float(p.time[1] - p.time[0])
            elastic = p.elastic.reshape(len(p.time), -1)
            elastic = elastic * (1.0 + bend * (np.abs(elastic) / scale.force - 0.5))
            total = g * first * (elastic - settled(elastic, h, quick))
            total = total + g * (1.0 - first) * (elastic - settled(elastic, h, apart * quick))
            return np.asarray(total.reshape(p.elastic.shape))

        return Hooks(beside=(branches,))

    def words(g: float) -> str:
        return f"{g:.3g} of the elastic force relaxes, with {quick:.2g} s and {apart * quick:.2g} s"

    return Draw(1e-4, 1.2, hooks, words)


RELAXATION = InjectionPlan(
    "relaxation",
    ALL,
    "two Prony branches",
    "one Maxwell branch",
    draw,
    placed=True,
    together=True,
)
