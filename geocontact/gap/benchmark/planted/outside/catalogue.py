"""All effects outside the vocabulary."""

from __future__ import annotations

from geocontact.gap.benchmark.planted.outside.burst import BURST
from geocontact.gap.benchmark.planted.outside.catch import CATCH
from geocontact.gap.benchmark.planted.outside.held_samples import HELD_SAMPLES
from geocontact.gap.benchmark.planted.outside.jump import JUMP
from geocontact.gap.benchmark.planted.outside.other_carrier import OTHER_CARRIER
from geocontact.gap.benchmark.planted.outside.quantisation import QUANTISATION
from geocontact.gap.benchmark.planted.outside.ringing import RINGING
from geocontact.gap.benchmark.planted.outside.swelling import SWELLING
from geocontact.gap.benchmark.planted.outside.tremor import TREMOR
from geocontact.gap.benchmark.planted.outside.wander import WANDER
from geocontact.gap.benchmark.planted.plan import Plan

OUTSIDERS: tuple[Plan, ...] = (
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


def outsiders(system: str) -> tuple[Plan, ...]:
    """Those that a system may have."""
    return tuple(one for one in OUTSIDERS if system in one.systems)
