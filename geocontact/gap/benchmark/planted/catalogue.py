"""Every planted effect of the vocabulary; mistakes in the data are exact and stand in `faults`."""

from __future__ import annotations

from geocontact.gap.benchmark.planted.effects.asymmetry import ASYMMETRY
from geocontact.gap.benchmark.planted.effects.axis_migration import AXIS_MIGRATION
from geocontact.gap.benchmark.planted.effects.contact_loss import CONTACT_LOSS
from geocontact.gap.benchmark.planted.effects.crosstalk import CROSSTALK
from geocontact.gap.benchmark.planted.effects.damping import DAMPING
from geocontact.gap.benchmark.planted.effects.dead_zone import DEAD_ZONE
from geocontact.gap.benchmark.planted.effects.dry_friction import DRY_FRICTION
from geocontact.gap.benchmark.planted.effects.end_stop import END_STOP
from geocontact.gap.benchmark.planted.effects.event_load import EVENT_LOAD
from geocontact.gap.benchmark.planted.effects.filter_lag import FILTER_LAG
from geocontact.gap.benchmark.planted.effects.gravity_load import GRAVITY_LOAD
from geocontact.gap.benchmark.planted.effects.inertia_load import INERTIA_LOAD
from geocontact.gap.benchmark.planted.effects.motion_offset import MOTION_OFFSET
from geocontact.gap.benchmark.planted.effects.preload import PRELOAD
from geocontact.gap.benchmark.planted.effects.relaxation import RELAXATION
from geocontact.gap.benchmark.planted.effects.saturation import SATURATION
from geocontact.gap.benchmark.planted.effects.sensor_drift import SENSOR_DRIFT
from geocontact.gap.benchmark.planted.effects.sensor_gain import SENSOR_GAIN
from geocontact.gap.benchmark.planted.effects.sensor_offset import SENSOR_OFFSET
from geocontact.gap.benchmark.planted.effects.series_compliance import SERIES_COMPLIANCE
from geocontact.gap.benchmark.planted.effects.slip import SLIP
from geocontact.gap.benchmark.planted.effects.stiffening import STIFFENING
from geocontact.gap.benchmark.planted.effects.time_shift import TIME_SHIFT
from geocontact.gap.benchmark.planted.plan import Plan

PLANS: tuple[Plan, ...] = (
    TIME_SHIFT,
    FILTER_LAG,
    MOTION_OFFSET,
    AXIS_MIGRATION,
    SERIES_COMPLIANCE,
    STIFFENING,
    DAMPING,
    RELAXATION,
    DRY_FRICTION,
    DEAD_ZONE,
    END_STOP,
    PRELOAD,
    SLIP,
    CONTACT_LOSS,
    ASYMMETRY,
    EVENT_LOAD,
    GRAVITY_LOAD,
    INERTIA_LOAD,
    SENSOR_GAIN,
    SENSOR_OFFSET,
    SENSOR_DRIFT,
    SATURATION,
    CROSSTALK,
)

TABLE: tuple[tuple[str, str, str], ...] = tuple((one.name, one.planted, one.candidate) for one in PLANS)
"""Name, equation planted, equation of the candidate: no two are alike."""

SWALLOWED = {
    "elbow": (
        "series_compliance",
        "preload",
        "gravity_load",
        "axis_migration",
        "motion_offset",
        "sensor_gain",
        "sensor_offset",
    ),
    "foot": ("sensor_gain",),
    "shoulder": ("damping", "gravity_load", "series_compliance"),
    "knee": ("sensor_gain",),
    "sit_to_stand": ("sensor_gain", "series_compliance"),
}
"""Effects that base parameters imitate nearly, if they are of a plain form."""

NO_GAP = {"elbow": SWALLOWED["elbow"], "sit_to_stand": ("sensor_gain",)}
"""Those that leave no visible gap of their own kind at all: never planted as a single one or in a pair."""


def plans(system: str) -> tuple[Plan, ...]:
    """Those that apply to a system."""
    return tuple(one for one in PLANS if system in one.systems)
