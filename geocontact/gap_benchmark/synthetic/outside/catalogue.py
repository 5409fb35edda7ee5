"""All effects outside the vocabulary."""

from __future__ import annotations

from geocontact.gap_benchmark.synthetic.outside.burst import BURST
from geocontact.gap_benchmark.synthetic.outside.catch import CATCH
from geocontact.gap_benchmark.synthetic.outside.drift import WANDER
from geocontact.gap_benchmark.synthetic.outside.held_samples import HELD_SAMPLES
from geocontact.gap_benchmark.synthetic.outside.jump import JUMP
from geocontact.gap_benchmark.synthetic.outside.other_carrier import OTHER_CARRIER
from geocontact.gap_benchmark.synthetic.outside.quantisation import QUANTISATION
from geocontact.gap_benchmark.synthetic.outside.ringing import RINGING
from geocontact.gap_benchmark.synthetic.outside.swelling import SWELLING
from geocontact.gap_benchmark.synthetic.outside.tremor import TREMOR
from geocontact.gap_benchmark.synthetic.plan import InjectionPlan

OUTSIDERS: tuple[InjectionPlan, ...] = (
    TREMOR,
    HELD_SAMPLES,
    BURST,
    OTHER_CARRIER,
    QUANTISATION,
    JUMP,
    WANDER,
    RINGING,
    SWELLING,
    CATCH,
)


def unknown_effects(system: str) -> tuple[InjectionPlan, ...]:
    """Those that a system may have."""
    return tuple(one for one in OUTSIDERS if system in one.systems)
