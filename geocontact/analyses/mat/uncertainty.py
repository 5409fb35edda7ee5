"""What the uncertainty of a mat's wrench rests on: what was stated, and what its registration tells."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.analyses.mat.options import MatOptions
from geocontact.analyses.run_record import Record
from geocontact.geometry.register.quality import Registration
from geocontact.geometry.register.uncertainty import PoseCovariance
from geocontact.loads.mat.errors import MatErrors
from geocontact.loads.mat.map import MatMap


def stated_errors(
    record: Record, placed: MatMap, registration: Registration | None, slip: PoseCovariance | None, o: MatOptions
) -> MatErrors:
    """Errors of cells, and of the place: as `registration` states it, else as the residuals tell.

    Those are of the registration, if there is one, and of the mat's landmarks (`slip`); they are independent.
    """
    cell, gain = o.accuracy, o.gain or 0.0
    nothing = record.spell("not stated: no `registration`, and no residual")
    told: dict[str, object] = {"cell": cell, "gain": gain, "place": nothing}
    record.results["uncertainty"] = told
    if o.registration is not None:
        shift, turn = o.registration
        told["place"] = record.spell("`registration`")
        told.update({"sd_shift_mm": [shift * 1e3] * 3, "sd_turn_deg": [np.degrees(turn)] * 3})
        return MatErrors(cell, gain, shift, turn)
    middle = (placed.area @ placed.centre) / placed.area.sum()
    known = None if registration is None else registration.covariance
    if registration is not None and known is not None:
        way = "landmarks" if registration.names else "shape"
        told.update(_told(f"residual of the registration by {way}", known, middle))
    if slip is not None:
        own = _told("residual of the mat's landmarks", slip, middle)
        told.update(own if known is None else {"mat_on_scan": own})
        known = slip if known is None else known.plus(slip)
    return MatErrors(cell, gain, pose=known)


def _told(place: str, covariance: PoseCovariance, middle: Float[np.ndarray, " 3"]) -> dict[str, object]:
    """At the middle of the mat."""
    sd = np.sqrt(np.maximum(np.diag(covariance.at(middle)), 0.0))
    return {
        "place": place,
        "sd_shift_mm": (sd[:3] * 1e3).tolist(),
        "sd_turn_deg": np.degrees(sd[3:]).tolist(),
        "degrees_of_freedom": covariance.freedom,
    }
