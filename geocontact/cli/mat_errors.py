"""What the uncertainty of a mat's wrench rests on: what was stated, and what its registration tells."""

from __future__ import annotations

import numpy as np

from geocontact.cli import quantities
from geocontact.cli.mat import MatOptions
from geocontact.cli.record import Record
from geocontact.geometry.register.quality import Registration
from geocontact.loads.mat_errors import MatErrors
from geocontact.loads.mat_map import MatMap


def stated_errors(record: Record, placed: MatMap, registration: Registration | None, o: MatOptions) -> MatErrors:
    """Errors of cells, and of the place: as --registration states it, else as the residual of a registration tells."""
    cell = quantities.fraction(o.accuracy, "--accuracy")
    gain = 0.0 if o.gain is None else quantities.fraction(o.gain, "--gain")
    told: dict[str, object] = {"cell": cell, "gain": gain, "place": "not stated: no --registration, no registration"}
    record.results["uncertainty"] = told
    if o.registration is not None:
        shift, turn = quantities.registration(o.registration)
        told.update(
            {"place": "--registration", "sd_shift_mm": [shift * 1e3] * 3, "sd_turn_deg": [np.degrees(turn)] * 3}
        )
        return MatErrors(cell, gain, shift, turn)
    if registration is None or registration.covariance is None:
        return MatErrors(cell, gain)
    middle = (placed.area @ placed.centre) / placed.area.sum()
    sd = np.sqrt(np.maximum(np.diag(registration.covariance.at(middle)), 0.0))
    told.update(
        {
            "place": f"residual of the registration by {'landmarks' if registration.names else 'shape'}",
            "sd_shift_mm": (sd[:3] * 1e3).tolist(),
            "sd_turn_deg": np.degrees(sd[3:]).tolist(),
            "degrees_of_freedom": registration.covariance.freedom,
        }
    )
    return MatErrors(cell, gain, pose=registration.covariance)
