"""A stance of a below-knee prosthesis: `geocontact prosthesis simulate`, `gc.prosthesis.simulate`.

>>> import geocontact as gc
>>> trial = "meshes/gait_P1_medium_1/"
>>> plates = {"plates": trial + "plates.mot", "plate": "own_force", "other_plate": "other_force"}
>>> result = gc.prosthesis.simulate(trial + "walking.trc", static=trial + "standing.trc", mass=77.3, **plates)
>>> print(result)
stance of 0.73 s at the fulcrum of 117 mm: vertical force up to 1.30 BW, ankle moment up to 100 N m, keel
stores 11.0 J
against the plate: R² 0.92, 7.8% BW; centre of pressure R² 1.00, 1.1% of the foot; stance 6 ms
shorter than measured
warning: the hip's centre comes from a regression; a `functional` trial determines it better
warning: 79 of 142 numbers of leg and foot are invented, see numbers.csv
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.collector import judge, listener, note, reserve, say
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.json_file import plain
from geocontact.analyses.frame.result import REPORT, Result
from geocontact.analyses.prosthesis.quantity_words import NAMES, SAID
from geocontact.analyses.prosthesis.scores import OVER, SCORES
from geocontact.analyses.prosthesis.simulate.options import ProsthesisSimulateOptions
from geocontact.analyses.prosthesis.simulate.show import stance_curves, stance_page
from geocontact.analyses.prosthesis.simulate.strides import (
    MOST,
    ScheduledStance,
    of_longest,
    say_strides,
    scheduled,
    strides_table,
    worst_first,
)
from geocontact.analyses.prosthesis.simulate.walk import (
    MARKER_ERROR,
    RecordedWalk,
    band_of,
    bushing_of,
    read,
    simulated,
    walk_of,
)
from geocontact.analyses.prosthesis.stance_files import (
    counted_twice,
    numbers_table,
    offset_words,
    write_coordinates,
    write_loads,
    write_plane,
    write_spheres,
)
from geocontact.below_knee_prosthesis.evaluation import PlateStance, StanceErrors, at_times, stance_errors
from geocontact.below_knee_prosthesis.foot_numbers import all_numbers
from geocontact.below_knee_prosthesis.from_markers import of_side
from geocontact.below_knee_prosthesis.leg import Side
from geocontact.below_knee_prosthesis.leg_tree import GRAVITY, SOCKET
from geocontact.below_knee_prosthesis.limb_in_socket import LimbInSocket
from geocontact.below_knee_prosthesis.marker_draws import UNITS as UNITS_OF_BAND
from geocontact.below_knee_prosthesis.marker_draws import MarkerBand
from geocontact.below_knee_prosthesis.recorded_walk import Walk
from geocontact.below_knee_prosthesis.simulate import Stance
from geocontact.below_knee_prosthesis.stance_model import FLOOR
from geocontact.below_knee_prosthesis.stance_summary import doubts, summary
from geocontact.below_knee_prosthesis.standing_still import StandingStill, standing_still
from geocontact.data.errors import InputError
from geocontact.data.parameter import Number
from geocontact.identify.goodness_of_fit import Doubt, GoodnessOfFit, of_low_r2, of_range

if TYPE_CHECKING:
    from geocontact.view.curves.declared import CurveSheet
    from geocontact.view.page.content import Page

UNITS = {"impulse": "s"}
"""Units of quantities that are not shares: forces are over body weight, centres of pressure over the foot's length."""


def stance_table(s: Stance, side: Side) -> pd.DataFrame:
    """Over time; forces and places in the laboratory's frame."""
    force, ground, sphere = (of_side(each, side) for each in (s.force, s.centre("ground"), s.centre("sphere")))
    return pd.DataFrame(
        {
            "time [s]": s.time,
            **{f"force_{axis} [N]": column for axis, column in zip("xyz", force.T, strict=True)},
            **{f"cop_{axis} [mm]": 1e3 * column for axis, column in zip("xz", ground[:, ::2].T, strict=True)},
            **{f"sphere_cop_{axis} [mm]": 1e3 * column for axis, column in zip("xz", sphere[:, ::2].T, strict=True)},
            "cop along foot [-]": s.along_foot("ground"),
            "sphere cop along foot [-]": s.along_foot("sphere"),
            "ankle moment [N m]": s.ankle_moment,
            "stored [J]": s.stored,
            "lost [J]": s.lost,
            **({} if s.twist is None else {"keel twist [deg]": np.degrees(s.twist)}),
            **{
                f"{name} [deg]": np.degrees(column)
                for name, column in zip(SOCKET[:3], s.found.q[:, 2:5].T, strict=True)
            },
            **{f"{name} [mm]": 1e3 * column for name, column in zip(SOCKET[3:], s.found.q[:, 5:8].T, strict=True)},
            **{f"{name} moment [N m]": column for name, column in zip(SOCKET[:3], s.socket[:, :3].T, strict=True)},
            **{f"{name} force [N]": column for name, column in zip(SOCKET[3:], s.socket[:, 3:].T, strict=True)},
            **{f"{zone} [N]": s.loads.pressing[:, of].sum(axis=1) for zone, of in s.foot.sole.spheres.zones.items()},
        }
    )


STUDY_STILL = 1e-3
"""Share of body weight that the study's model misses while standing, at most."""


def band_table(band: MarkerBand) -> pd.DataFrame:
    """Curves over time, and lower and upper end of their band of 95 %."""
    columns: dict[str, object] = {"time [s]": band.time}
    for name, unit in UNITS_OF_BAND.items():
        middle, half = band.curves[name], band.half[name]
        columns |= {f"{name} [{unit}]": middle, f"{name} lower [{unit}]": middle - half}
        columns[f"{name} upper [{unit}]"] = middle + half
    return pd.DataFrame(columns)


def errors_table(errors: StanceErrors) -> pd.DataFrame:
    """R² and root mean square error by quantity; of the stance's length the difference, simulated less measured."""
    rows = [(name, UNITS.get(name, "-"), r2, off, np.nan) for name, (r2, off) in errors.table.items()]
    rows.append(("stance", "s", np.nan, np.nan, errors.stance[0] - errors.stance[1]))
    return pd.DataFrame(rows, columns=["quantity", "unit", "r2 [-]", "rmse", "difference"])


def curves_table(errors: StanceErrors) -> pd.DataFrame:
    """Simulated and measured curves over 101 points of the plate's stance."""
    columns = {"stance [-]": errors.share}
    for name, (model, measured) in errors.curves.items():
        unit = UNITS.get(name, "-")
        columns |= {f"{name} [{unit}]": model, f"{name} measured [{unit}]": measured}
    return pd.DataFrame(columns)


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class ProsthesisSimulateResult(Result):
    """A stance of the prosthetic side.

    Parameters
    ----------
    errors
        Beside the plate; None where none was named.
    band
        How far errors of the markers move the curves; None where no draws were asked for.
    still
        Standing still on the foot; None where that was not asked for.
    strides
        Every stance at the fulcrum of its schedule; `stance` is the longest on the plate. None without a schedule.
    """

    options: ProsthesisSimulateOptions
    walk: Walk
    stance: Stance
    errors: StanceErrors | None
    numbers: Mapping[str, Number]
    band: MarkerBand | None = None
    still: StandingStill | None = None
    strides: tuple[ScheduledStance, ...] = ()

    @property
    def time(self) -> Float[np.ndarray, " t"]:
        """Time of the frames of the stance [s]."""
        return self.stance.time

    @property
    def force(self) -> Float[np.ndarray, "t 3"]:
        """Force of the ground on the foot over time, in the frame of the laboratory [N]."""
        return np.asarray(of_side(self.stance.force, self.options.side))

    @property
    def centre_of_pressure(self) -> Float[np.ndarray, "t 3"]:
        """Centre of pressure over time, in the frame of the laboratory [m]; NaN where little presses."""
        return np.asarray(of_side(self.stance.centre("ground"), self.options.side))

    @property
    def ankle_moment(self) -> Float[np.ndarray, " t"]:
        """Moment at the ankle over time [N m]."""
        return self.stance.ankle_moment

    @property
    def stored_energy(self) -> Float[np.ndarray, " t"]:
        """Energy stored in the keel over time [J]."""
        return self.stance.stored

    def tables(self) -> dict[str, pd.DataFrame]:
        """`stance` over time, `numbers`, with a plate `errors` and `curves`, `strides`, `band` of draws."""
        told = {"stance": stance_table(self.stance, self.options.side), "numbers": numbers_table(self.numbers)}
        if self.errors is not None:
            told |= {"errors": errors_table(self.errors), "curves": curves_table(self.errors)}
        if self.strides:
            told["strides"] = strides_table(self.strides)
        if self.band is not None:
            told["band"] = band_table(self.band)
        return told

    def curves(self) -> dict[str, CurveSheet]:
        """`stance`: ground reaction and centre of pressure over time, beside the plate's, and what moves in the leg."""
        return {"stance": stance_curves(self.stance, self.walk.plate, self.band)}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """The moving foot with its forces and the path of the centre of pressure, curves, tables."""
        page = stance_page(self.options, self.stance, self.curves()["stance"], self.tables(), self.sentences)
        return {REPORT: page}

    def write_files(self, folder: Path) -> None:
        """Coordinates and external loads for OpenSim, spheres for ParaView besides; a gap case if on a floor."""
        write_coordinates(folder, self.stance, self.options.side)
        write_loads(folder, self.stance, self.options.side)
        write_spheres(folder / "paraview", self.stance, self.options.side)
        if self.stance.ground == FLOOR:
            seen = self.walk.cluster
            write_plane(folder / "plane", seen.time, seen.poses, self.walk.plate, self.stance)
        super().write_files(folder)


def run(recorded: RecordedWalk, o: ProsthesisSimulateOptions) -> ProsthesisSimulateResult:
    """The walk, and its stance from before touch-down to after toe-off."""
    walk = walk_of(recorded, o)
    strides, which = () if recorded.schedule is None else scheduled(walk, recorded.schedule, o), ""
    if strides:
        longest, which = of_longest(strides)
        walk, limb = longest.walk, longest.limb
        recorded = replace(recorded, fulcrum=walk.fulcrum, plate=walk.plate)
    else:
        limb = simulated(walk, o)
    numbers = all_numbers(walk.leg, walk.foot, walk.fulcrum, bushing_of(o))
    invented = sum(number.source == "invented" for number in numbers.values())
    reserve(f"{invented} of {len(numbers)} numbers of leg and foot are invented, see numbers.csv")
    found = limb.stance
    _doubt({f"stride {each.stride.number}": each.limb for each in worst_first(strides)} or {"": limb}, o)
    errors = None if walk.plate is None else stance_errors(found, walk.plate, SCORES[o.score])
    told = summary(found)
    note("stance", plain(told))
    note("socket", plain({"turns": limb.turns, "change_BW": limb.change, "settled": limb.settled}))
    say(found_words(found, told, which))
    if recorded.schedule is not None:
        say_strides(strides, recorded.schedule.by)
    if errors is not None and walk.plate is not None:
        say(beside_words(errors, which))
        over = OVER[o.score]
        judge(against_each(strides, over) if strides else against_the_plate(found, walk.plate, over))
        note("errors", plain({name: {"r2": r2, "rmse": off} for name, (r2, off) in errors.table.items()}))
    if walk.leg.offset.given:
        say(offset_words(walk.leg.offset))
    band, still = _band(recorded, walk, found, o), _still(walk, o)
    return ProsthesisSimulateResult(
        options=o, walk=walk, stance=found, errors=errors, numbers=numbers, band=band, still=still, strides=strides
    )


def _doubt(limbs: Mapping[str, LimbInSocket], o: ProsthesisSimulateOptions) -> None:
    """Warnings of each stance, by its name or none, worst first; InputError for a foot that never touches the floor."""
    doubted = dict[str, list[str]]()
    for name, limb in limbs.items():
        if not limb.stance.on.any():
            remedy = "is `ground` right, y = 0 without it, and `mass`?"
            raise InputError(o.motion, name, "the foot never touches the floor", remedy)
        lines = [*doubts(limb.stance), *([] if limb.settled else [counted_twice(limb)])]
        if lines:
            doubted[name] = lines
    for name, lines in list(doubted.items())[:MOST]:
        for line in lines:
            reserve(f"{name}: {line}" if name else line)
    if len(doubted) > MOST:
        reserve(f"{', '.join(list(doubted)[MOST:])}: such doubts as well")


def _band(recorded: RecordedWalk, walk: Walk, found: Stance, o: ProsthesisSimulateOptions) -> MarkerBand | None:
    """The band of the draws, and what is said of it."""
    if o.walks is None:
        return None
    with listener().progress("draws", o.walks) as step:
        band = band_of(recorded, found, o, step)
    if band is None:
        return None
    if band.lost:
        reserve(f"{band.lost} of {o.walks} draws of the markers' errors could not be simulated, and are left out")
    moved = {name: band.width(name, found.on) for name in UNITS_OF_BAND}
    note("band", plain({"draws": band.drawn, "half_width": moved}))
    say(
        f"errors of the markers (SD {1e3 * (MARKER_ERROR if o.marker_error is None else o.marker_error):g} mm, "
        f"{band.drawn} draws) move the vertical force by ±{moved['vertical']:.1%} BW and the centre of pressure by "
        f"±{moved['cop_ground']:.1%} of the foot (95 %){_plate_inside(band, walk, found)}"
    )
    return band


def _plate_inside(band: MarkerBand, walk: Walk, found: Stance) -> str:
    """How much of the plate's vertical force the band holds, in words; nothing without a plate."""
    if walk.plate is None:
        return ""
    weight = walk.leg.person.mass * GRAVITY
    seen = at_times(found.time, walk.plate.time, walk.plate.force)[:, 1] / weight
    share = band.inside("vertical", seen, found.on)
    return f"; the plate's force is within that for {share:.0%} of the stance"


def _still(walk: Walk, o: ProsthesisSimulateOptions) -> StandingStill | None:
    """Ten seconds of standing still, and what is said of them; None where that was not asked for."""
    if not o.stand_still:
        return None
    try:
        still = standing_still(walk.leg, walk.foot, walk.fulcrum, bushing=bushing_of(o), machine_code=o.machine_code)
    except ArithmeticError as error:
        raise InputError(o.motion, "`stand_still`", str(error), "check `mass` and `law`, or leave it out") from error
    lasting = still.stance.time[-1]
    note("stand_still", plain({"seconds": lasting, "missing_BW": still.missing, "slid_mm": 1e3 * still.slid}))
    say(
        f"standing still for {lasting:.0f} s: the foot carries {still.missing:+.2%} BW beside the half that it should, "
        f"and slides {1e3 * still.slid:.1f} mm"
    )
    if abs(still.missing) > STUDY_STILL:
        reserve(f"standing still, the force is {still.missing:+.2%} BW off; the study's model is within 0.1 %")
    return still


def found_words(found: Stance, told: Mapping[str, float], which: str = "") -> str:
    """The whole stance in a sentence, by `summary`; `which` follows its length."""
    lasting = f"stance of {told['stance_s']:.2f} s{which}"
    if np.isnan(told["stance_s"]):
        lasting = f"stance that is not over after {found.time[-1] - found.time[found.on][0]:.2f} s{which},"
    return (
        f"{lasting} at the fulcrum of {1e3 * found.fulcrum:.0f} mm: vertical force up to "
        f"{told['vertical_max_BW']:.2f} BW, ankle moment up to {told['ankle_moment_max_N_m']:.0f} N m, keel "
        f"stores {told['stored_max_J']:.1f} J"
    )


def beside_words(errors: StanceErrors, which: str = "") -> str:
    """How far the stance is from its plate in a sentence; `which` stance that is."""
    r2, off = errors.table["resultant"]
    along = errors.table["cop_ground"]
    return (
        f"against the plate{which}: R² {r2:.2f}, {off:.1%} BW; centre of pressure R² {along[0]:.2f}, {along[1]:.1%} of "
        f"the foot; {_lasting(errors)}"
    )


def against_the_plate(found: Stance, plate: PlateStance, over: str = "") -> GoodnessOfFit:
    """`goodness_of` over the stance, whatever is scored: swing agrees by itself."""
    return goodness_of(stance_errors(found, plate), over)


def against_each(strides: Sequence[ScheduledStance], over: str = "") -> GoodnessOfFit:
    """`against_the_plate` of every stride by its number, worst first."""
    doubts, tested = list[Doubt](), tuple[str, ...]()
    for each in worst_first(strides):
        if each.walk.plate is not None:
            fit = against_the_plate(each.limb.stance, each.walk.plate, over)
            doubts += [replace(one, what=f"stride {each.stride.number}, {one.what}") for one in fit.doubts]
            tested = fit.tested
    return GoodnessOfFit(tuple(doubts), tested)


def goodness_of(errors: StanceErrors, over: str = "") -> GoodnessOfFit:
    """Force and centre of pressure beside the plate's: a constant must not describe them better, nor the simulation end
    before the stance does. `over` follows their names.
    """
    tested = {f"{NAMES[name]}{over}": float(r2) for name, (r2, _) in errors.table.items() if name in SAID}
    doubts = [doubt for name, r2 in tested.items() for doubt in of_low_r2(name, r2)]
    doubts += of_range("the simulation has ended for", 1.0 - errors.simulated, "the plate's stance")
    return GoodnessOfFit(tuple(doubts), tuple(tested))


def _lasting(errors: StanceErrors) -> str:
    late = 1e3 * (errors.stance[0] - errors.stance[1])
    if np.isfinite(late):
        size = f"{abs(late):.0f}"
        return "stance as long as measured" if size == "0" else f"stance {size} ms {_longer(late)} than measured"
    return f"over the first {errors.simulated:.0%} of the plate's stance, because the simulation ended before toe-off"


def _longer(late: float) -> str:
    return "longer" if late > 0.0 else "shorter"


simulate = Job("prosthesis simulate", ProsthesisSimulateOptions, read, run)
