"""The head of the page of a centre of pressure: how hard, how far, how near to the plate."""

from __future__ import annotations

import numpy as np

from geocontact.analyses.cop.foot_loads import FootLoads
from geocontact.analyses.cop.force_plate import root_mean_squares
from geocontact.analyses.cop.page_plans import MM, path_length, travel
from geocontact.analyses.page_words import counted, rounded
from geocontact.data.seconds import seconds

AXES = "xyz"
NO_MOMENT = 1e-6  # N m; less is what rounding leaves


def headline(r: FootLoads) -> list[str]:
    """Largest force and way of the centre; in how many frames there is one; the plate's difference."""
    time, c = r.foot.motion.time, r.centre
    found = np.isfinite(c.centre[:, 0])
    if not c.pressing.any():
        return ["No sphere touches the ground: there is no force and no centre of pressure."]
    k = int(np.argmax(c.pressing))
    said = f"The ground presses on the foot with up to {rounded(c.pressing[k], 3)} N, at {_at(time[k])}"
    if not found.any():
        return [f"{said}: too little for a centre of pressure, which asks for {r.options.gate:g} N."]
    way, along = travel(r)
    lines = [f"{said}; its centre of pressure goes {way * MM:.0f} mm along {along}."]
    if not found.all():
        lines.append(
            f"There is a centre of pressure in {found.sum()} of {counted(len(found), 'frame')}; "
            f"in the others the normal force is below {r.options.gate:g} N."
        )
    return lines + _beside(r)


def _beside(r: FootLoads) -> list[str]:
    """Difference to the plate as one distance and one force."""
    if r.comparison is None:
        return []
    rms = root_mean_squares(r.comparison)
    force = [rms[f"rms_force_{axis} [N]"] for axis in AXES]
    centre = [rms[f"rms_cop_{axis} [m]"] for axis in AXES]
    told = [f"the force differs by {_length(force):.3g} N"]
    if None not in centre:
        told.append(f"the centre of pressure by {_length(centre) * MM:.3g} mm")
    return [f"Beside the force plate {' and '.join(told)} (root mean square)."]


def _at(time: float) -> str:
    return f"{seconds(round(float(time), 3))} s"


def _length(parts: list[float | None]) -> float:
    return float(np.sqrt(sum(part**2 for part in parts if part is not None)))


def facts(r: FootLoads) -> list[tuple[str, str]]:
    """How much, for how long, under what, how far, and how it turns."""
    time, c = r.foot.motion.time, r.centre
    found, touching = np.isfinite(c.centre[:, 0]), c.pressing > 0.0
    k = int(np.argmax(c.pressing))
    lines = [("Largest normal force", f"{c.pressing[k]:.0f} N at {_at(time[k])}")]
    if touching.any():
        first, last = time[np.flatnonzero(touching)[[0, -1]]]
        lines.append(("On the ground", f"{_at(first)} to {_at(last)}"))
        zones = {name: float(force.sum()) for name, force in r.zones.items()}
        most = max(zones, key=lambda name: zones[name])
        lines.append(("Zone that bears most", f"{most}, {zones[most] / sum(zones.values()):.0%} of all force"))
    if found.any():
        lines.append(("Length of the path", f"{path_length(c.centre) * MM:.0f} mm"))
        turn = c.free_moment[found]
        if np.abs(turn).max() > NO_MOMENT:
            lines.append(("Free moment", f"{turn.min():.2g} … {turn.max():.2g} N m"))
    return lines
