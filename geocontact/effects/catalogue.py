"""Every effect, in the order of the vocabulary."""

from __future__ import annotations

from geocontact.chain.candidate import Candidate, Effect
from geocontact.chain.system import System
from geocontact.effects.asymmetry import ASYMMETRY
from geocontact.effects.axis_migration import AXIS_MIGRATION
from geocontact.effects.contact_loss import CONTACT_LOSS
from geocontact.effects.crosstalk import CROSSTALK
from geocontact.effects.damping import DAMPING
from geocontact.effects.dead_zone import DEAD_ZONE
from geocontact.effects.dry_friction import DRY_FRICTION
from geocontact.effects.end_stop import END_STOP
from geocontact.effects.event_load import EVENT_LOAD
from geocontact.effects.filter_lag import FILTER_LAG
from geocontact.effects.gravity_load import GRAVITY_LOAD
from geocontact.effects.inertia_load import INERTIA_LOAD
from geocontact.effects.motion_offset import MOTION_OFFSET
from geocontact.effects.preload import PRELOAD
from geocontact.effects.relaxation import RELAXATION
from geocontact.effects.saturation import SATURATION
from geocontact.effects.sensor_drift import SENSOR_DRIFT
from geocontact.effects.sensor_gain import SENSOR_GAIN
from geocontact.effects.sensor_offset import SENSOR_OFFSET
from geocontact.effects.series_compliance import SERIES_COMPLIANCE
from geocontact.effects.side_swap import SIDE_SWAP
from geocontact.effects.sign_flip import SIGN_FLIP
from geocontact.effects.slip import SLIP
from geocontact.effects.stiffening import STIFFENING
from geocontact.effects.time_shift import TIME_SHIFT
from geocontact.effects.unit_error import UNIT_ERROR

EFFECTS: tuple[Effect, ...] = (
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
    UNIT_ERROR,
    SIGN_FLIP,
    SIDE_SWAP,
)


def candidates(system: System) -> tuple[Candidate, ...]:
    """Every candidate that applies to a system, then those of its own effects; bounds from its scale."""
    return tuple(one for effect in (*EFFECTS, *system.own) for one in effect.candidates(system))
