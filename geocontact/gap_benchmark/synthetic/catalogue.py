"""Every injected effect of the vocabulary; mistakes in the data are exact and stand in `data_errors`."""

from __future__ import annotations

from geocontact.gap_benchmark.synthetic.effects.measurement.crosstalk import CROSSTALK
from geocontact.gap_benchmark.synthetic.effects.measurement.filter_lag import FILTER_LAG
from geocontact.gap_benchmark.synthetic.effects.measurement.saturation import SATURATION
from geocontact.gap_benchmark.synthetic.effects.measurement.sensor_drift import SENSOR_DRIFT
from geocontact.gap_benchmark.synthetic.effects.measurement.sensor_gain import SENSOR_GAIN
from geocontact.gap_benchmark.synthetic.effects.measurement.sensor_offset import SENSOR_OFFSET
from geocontact.gap_benchmark.synthetic.effects.measurement.time_shift import TIME_SHIFT
from geocontact.gap_benchmark.synthetic.effects.mechanical.asymmetry import ASYMMETRY
from geocontact.gap_benchmark.synthetic.effects.mechanical.axis_migration import AXIS_MIGRATION
from geocontact.gap_benchmark.synthetic.effects.mechanical.contact_loss import CONTACT_LOSS
from geocontact.gap_benchmark.synthetic.effects.mechanical.damping import DAMPING
from geocontact.gap_benchmark.synthetic.effects.mechanical.dead_zone import DEAD_ZONE
from geocontact.gap_benchmark.synthetic.effects.mechanical.dry_friction import DRY_FRICTION
from geocontact.gap_benchmark.synthetic.effects.mechanical.end_stop import END_STOP
from geocontact.gap_benchmark.synthetic.effects.mechanical.event_load import EVENT_LOAD
from geocontact.gap_benchmark.synthetic.effects.mechanical.gravity_load import GRAVITY_LOAD
from geocontact.gap_benchmark.synthetic.effects.mechanical.inertia_load import INERTIA_LOAD
from geocontact.gap_benchmark.synthetic.effects.mechanical.motion_offset import MOTION_OFFSET
from geocontact.gap_benchmark.synthetic.effects.mechanical.preload import PRELOAD
from geocontact.gap_benchmark.synthetic.effects.mechanical.relaxation import RELAXATION
from geocontact.gap_benchmark.synthetic.effects.mechanical.series_compliance import SERIES_COMPLIANCE
from geocontact.gap_benchmark.synthetic.effects.mechanical.slip import SLIP
from geocontact.gap_benchmark.synthetic.effects.mechanical.stiffening import STIFFENING
from geocontact.gap_benchmark.synthetic.effects.second.measurement import AVERAGING, LEANING, ONE_SIDED, SMALL_LOADS
from geocontact.gap_benchmark.synthetic.effects.second.mechanical import CREEPING, LOCKING, STICKING, THINNING
from geocontact.gap_benchmark.synthetic.equipment.laboratory import Forms
from geocontact.gap_benchmark.synthetic.plan import InjectionPlan

PLANS: tuple[InjectionPlan, ...] = (
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

CONFOUNDED = {
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
"""Effects that base parameters reproduce nearly, if they are of a plain form."""

NO_GAP = {"elbow": CONFOUNDED["elbow"], "sit_to_stand": ("sensor_gain",)}
"""Those that leave no visible gap of their own kind at all: never planted as a single one or in a pair."""


SECOND = {one.name: one for one in (AVERAGING, LEANING, ONE_SIDED, SMALL_LOADS, CREEPING, LOCKING, STICKING, THINNING)}
"""Effects that have a second family of equations; the others are of the first in either."""


def plans(system: str, forms: Forms = "first") -> tuple[InjectionPlan, ...]:
    """Those that apply to a system, in one family of equations."""
    known = PLANS if forms == "first" else tuple(SECOND.get(one.name, one) for one in PLANS)
    return tuple(one for one in known if system in one.systems)
