"""A prosthetic stance along a recorded walk, and what is to be said of it."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from geocontact.analyses.json_file import plain
from geocontact.analyses.prosthesis.foot_law import offset_words
from geocontact.analyses.prosthesis.simulate.options import ProsthesisSimulateOptions
from geocontact.analyses.prosthesis.simulate.read import RecordedWalk, Walk, fitted_walk
from geocontact.analyses.prosthesis.simulate.result import ProsthesisSimulateResult
from geocontact.analyses.prosthesis.simulate.tables import all_numbers
from geocontact.analyses.prosthesis.socket_words import counted_twice
from geocontact.analyses.run_record import Record
from geocontact.below_knee_prosthesis.limb_in_socket import LimbInSocket, limb_in_socket
from geocontact.below_knee_prosthesis.model.leg_motion import LegMotion
from geocontact.below_knee_prosthesis.model.leg_tree import GRAVITY
from geocontact.below_knee_prosthesis.simulate import GATE, Stance, simulate_stance
from geocontact.below_knee_prosthesis.stance_errors import StanceErrors, longest_stance, stance_errors
from geocontact.contact.bushing import PISTONING, PRINTED, SOCKET, Bushing
from geocontact.data.errors import InputError

BEFORE, AFTER = 0.12, 0.1
"""s; simulated before the plate's touch-down and after its toe-off, as far as the markers go."""
INSIDE = 2
"""Frames that are left out at both ends: the splines bend there."""
TURNED = np.radians(20.0)
"""rad; of the socket, beyond which its bushing is doubted."""


def run(recorded: RecordedWalk, o: ProsthesisSimulateOptions, record: Record) -> ProsthesisSimulateResult:
    """The walk, and its stance from before touch-down to after toe-off."""
    walk = fitted_walk(recorded, o, record)
    numbers = all_numbers(walk.leg, walk.foot, walk.fulcrum, bushing_of(o))
    invented = sum(number.source == "invented" for number in numbers.values())
    record.warn(f"{invented} of {len(numbers)} numbers of leg and foot are invented, see numbers.csv")
    limb = simulated(walk, o)
    found = limb.stance
    if not found.on.any():
        raise InputError(
            o.markers, "", "the foot never touches the floor", "is `ground` right, y = 0 without it, and `mass`?"
        )
    errors = None if walk.plate is None else stance_errors(found, walk.plate)
    doubt(found, record)
    if not limb.settled:
        record.warn(counted_twice(limb))
    told = summary(found)
    record.results["stance"] = plain(told)
    record.results["socket"] = plain({"turns": limb.turns, "change_BW": limb.change, "settled": limb.settled})
    record.say(found_words(found, told))
    if errors is not None:
        record.say(beside_words(errors))
        record.results["errors"] = plain({name: {"r2": r2, "rmse": off} for name, (r2, off) in errors.table.items()})
    if walk.leg.offset.given:
        record.say(offset_words(walk.leg.offset))
    return ProsthesisSimulateResult(record=record, options=o, walk=walk, stance=found, errors=errors, numbers=numbers)


def bushing_of(o: ProsthesisSimulateOptions) -> Bushing:
    """Socket on the residual limb."""
    return SOCKET if o.socket == "as_meant" else PRINTED


def simulated(walk: Walk, o: ProsthesisSimulateOptions) -> LimbInSocket:
    """From before touch-down to after toe-off, with the socket's motion out of its markers; InputError where not."""
    time = walk.walked.motion.time
    span = (float(time[INSIDE]), float(time[-1 - INSIDE]))
    if walk.plate is not None:
        seen = longest_stance(walk.plate.time, walk.plate.force[:, 1])
        if seen is not None:
            span = max(span[0], seen[0] - BEFORE), min(span[1], seen[1] + AFTER)
    bushing = bushing_of(o)
    given = walk.foot, walk.fulcrum, walk.push, span

    def along(motion: LegMotion) -> Stance:
        return simulate_stance(motion, *given, bushing=bushing, ground=walk.ground, machine_code=o.machine_code)

    cutoff = None if o.cutoff == 0.0 else o.cutoff
    try:
        return limb_in_socket(walk.seen, walk.walked, along, cutoff=cutoff, gap_limit=o.gap_limit, turns=o.socket_turns)
    except (ArithmeticError, ValueError) as error:
        remedy = "check `mass`, `side`, `axes` and the names of the markers; as_printed no gait can be walked"
        raise InputError(o.markers, "", str(error), remedy) from error


def found_words(found: Stance, told: Mapping[str, float]) -> str:
    """The whole stance in a sentence, by `summary`."""
    lasting = f"stance of {told['stance_s']:.2f} s"
    if np.isnan(told["stance_s"]):
        lasting = f"stance that is not over after {found.time[-1] - found.time[found.on][0]:.2f} s,"
    return (
        f"{lasting} at the fulcrum of {1e3 * found.fulcrum:.0f} mm: vertical force up to "
        f"{told['vertical_max_BW']:.2f} BW, ankle moment up to {told['ankle_moment_max_N_m']:.0f} N m, keel "
        f"stores {told['stored_max_J']:.1f} J"
    )


def beside_words(errors: StanceErrors) -> str:
    """How far the stance is from its plate in a sentence."""
    r2, off = errors.table["resultant"]
    along = errors.table["cop_ground"]
    return (
        f"against the plate: R² {r2:.2f}, {off:.1%} BW; centre of pressure R² {along[0]:.2f}, {along[1]:.1%} of the "
        f"foot; {_lasting(errors)}"
    )


def _lasting(errors: StanceErrors) -> str:
    late = 1e3 * (errors.stance[0] - errors.stance[1])
    if np.isfinite(late):
        return f"stance {late:+.0f} ms"
    return f"over the first {errors.simulated:.0%} of the plate's stance, for the simulation ended before toe-off"


def doubt(found: Stance, record: Record) -> None:
    """What speaks against a simulated stance, as reservations."""
    time, loads = found.time, found.loads
    if loads.pressing[0].sum() > GATE:
        record.warn(f"the foot is on the floor at the start, with {loads.pressing[0].sum():.0f} N: begin earlier")
    if found.on[-1]:
        what = f"the foot is still on the floor with {found.force[-1, 1]:.0f} N where the simulation ends"
        record.warn(f"{what}, at {found.time[-1]:.2f} s: is `mass` right, and do the markers go on past toe-off?")
    far, fast = found.beyond
    if far.any():
        most, limit = 1e3 * np.abs(found.pistoning).max(), 1e3 * PISTONING.travel
        record.warn(f"the socket pistons by {most:.0f} mm, past {limit:.0f} mm, first at {time[far][0]:.2f} s")
    if fast.any():
        limit = 1e3 * PISTONING.speed
        record.warn(f"the socket pistons faster than {limit:.0f} mm/s, first at {time[fast][0]:.2f} s")
    turned = np.abs(found.found.q[:, 2:5]).max()
    if turned > TURNED:
        record.warn(f"the socket turns by {np.degrees(turned):.0f} degrees on its bushing")
    sunk = loads.depth > found.foot.sole.spheres.radius
    if sunk.any():
        record.warn(
            f"{int(sunk.any(axis=0).sum())} spheres sink beyond their radius, up to {1e3 * loads.depth.max():.0f} mm"
        )
    idle = [zone for zone, of in found.foot.sole.spheres.zones.items() if not (loads.pressing[:, of] > 0.0).any()]
    if idle:
        record.warn(f"never loaded: {', '.join(idle)}; its numbers stay unknown")


def summary(found: Stance) -> dict[str, float]:
    """Numbers of the whole stance."""
    weight = found.motion.leg.person.mass * GRAVITY
    span = longest_stance(found.time, found.force[:, 1])
    return {
        "stance_s": float("nan") if span is None else span[1] - span[0],
        "vertical_max_BW": float(found.force[:, 1].max() / weight),
        "ankle_moment_max_N_m": float(found.ankle_moment.max()),
        "stored_max_J": float(found.stored.max()),
        "lost_J": float(found.lost[-1]),
        "pistoning_max_mm": float(1e3 * np.abs(found.pistoning).max()),
        "steps": float(found.found.steps),
    }
