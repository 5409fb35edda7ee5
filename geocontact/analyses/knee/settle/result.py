r"""A contact equilibrium of a knee implant under load: `geocontact knee settle`, `gc.knee.settle`.

>>> import geocontact as gc
>>> from pathlib import Path
>>> rows = Path("meshes/gait.csv").read_text().splitlines()[:2]
>>> _ = Path("first.csv").write_text("\n".join(rows))
>>> moving, fixed = (f"meshes/{name}_right_coarse.stl" for name in ("femoral_component", "tibial_insert"))
>>> layer = {"modulus": gc.MPa(463), "poisson": 0.46, "region": "ny>0.25"}
>>> result = gc.knee.settle(moving, fixed, unit="mm", motion="first.csv", side="right", load=2000.0, **layer)
>>> print(f"{result.table()['peak [MPa]'][0]:.1f} MPa")
31.8 MPa
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.collector import judge, listener, note, reserve, say
from geocontact.analyses.frame.contact_pressures import PressureMap, pressure_figure, write_contact_loads
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.pages import Thinned
from geocontact.analyses.frame.published import beside_published_areas
from geocontact.analyses.frame.result import REPORT, Result
from geocontact.analyses.frame.shared_options import medial_side
from geocontact.analyses.knee.settle.equilibrium import SIDES, Settled, SettleInputs, read
from geocontact.analyses.knee.settle.options import SettleOptions
from geocontact.analyses.knee.settle.pose_error import settle_error
from geocontact.analyses.knee.settle.show import thinned_page
from geocontact.data.errors import InputError
from geocontact.data.plausible import BEARING
from geocontact.geometry.contact_area.published import KneeRun
from geocontact.identify.goodness_of_fit import MUCH, Doubt, GoodnessOfFit, of_range, of_size
from geocontact.io.opensim.storage_writer import write_storage
from geocontact.loads.settling import EnergyBalance, Frame, energy_balance, not_held, settle_along
from geocontact.loads.settling_potential import NAMES, coordinates_of
from geocontact.view.surfaces.vtp_series import PressureSeries, write_pressure_series

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from geocontact.loads.pressure_pose_error import PressureUncertainty


MM, MM2, MPA = 1e3, 1e6, 1e-6
LIFTED = 0.01
"""Share of the force that a condyle carries, below which it has lifted off, or the sides meet elsewhere."""


def settle_table(s: Settled) -> pd.DataFrame:
    """A row per frame; cells are empty where it did not come to rest."""
    flexion, adduction, rotation = np.degrees(s.knee_angles).T
    columns: dict[str, object] = {
        s.inputs.clock: s.inputs.motion.time,
        "load [N]": s.inputs.load,
        "flexion [deg]": flexion,
        "adduction [deg]": adduction,
        "rotation [deg]": rotation,
    }
    columns |= {f"{name} [mm]": s.coordinates[:, k] * MM for k, name in enumerate(NAMES[:3])}
    columns |= {"contact_area [mm^2]": s.areas * MM2, "peak [MPa]": s.peaks * MPA}
    for side in SIDES:
        columns[f"force_{side} [N]"] = s.forces(side)
    for side in SIDES:
        centre = s.centres(side) * MM
        columns |= {f"cop_{side}_{letter} [mm]": centre[:, axis] for axis, letter in enumerate("xyz")}
    steps = [np.nan if frame.rest is None else frame.rest.steps for frame in s.frames]
    columns |= {"stored_energy [J]": s.stored, "residual [N]": s.residuals, "newton_steps [-]": steps}
    return pd.DataFrame(columns)


def pose_table(s: Settled) -> pd.DataFrame:
    """Poses of MOVING in FIXED in the frames at rest, as `area` reads them."""
    poses = s.poses
    shift, turn = poses.translation * MM, poses.rotation.as_quat(scalar_first=True)
    columns: dict[str, object] = {s.inputs.clock: s.inputs.motion.time[s.kept]}
    columns |= {f"t{letter} [mm]": shift[:, axis] for axis, letter in enumerate("xyz")}
    columns |= {f"q{letter} [-]": turn[:, k] for k, letter in enumerate("wxyz")}
    return pd.DataFrame(columns)


COORDINATES = ("flexion", "adduction", "rotation", "tx", "ty", "tz")
"""Columns of settled.mot, as `area` reads them by the convention of Grood and Suntay."""


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class SettleResult(Result):
    """Contact equilibrium over a motion.

    Parameters
    ----------
    settled
        Every frame.
    balance
        Work of the load and stored energy in the frame with the largest load; None where that was not found.
    published
        Published areas beside these; None unless asked for.
    pose_error
        What the error of the poses does; None without one.
    """

    options: SettleOptions
    settled: Settled
    balance: EnergyBalance | None
    published: pd.DataFrame | None = None
    pose_error: PressureUncertainty | None = None

    @property
    def force(self) -> dict[str, Float[np.ndarray, " t"]]:
        """Force of "medial", "lateral" and "total" along the load in every frame [N]; NaN where nothing is at rest."""
        return {side: self.settled.forces(side) for side in SIDES}

    @property
    def pressure(self) -> Float[np.ndarray, " t"]:
        """Largest contact pressure in every frame [Pa]."""
        return self.settled.peaks

    @property
    def area(self) -> Float[np.ndarray, " t"]:
        """Contact area of FIXED in every frame [m^2]."""
        return self.settled.areas

    def tables(self) -> dict[str, pd.DataFrame]:
        """`settle`, a row per frame, `poses` of those at rest, and `literature` where it was asked for."""
        found = {"settle": settle_table(self.settled), "poses": pose_table(self.settled)}
        if self.pose_error is not None:
            found["settle_error"] = self.pose_error.table(self.settled.inputs.motion.time)
        return found if self.published is None else {**found, "literature": self.published}

    def figures(self) -> dict[str, Figure]:
        """`settle`: forces and largest pressure over the motion, and the pressures at the largest load."""
        s, k = self.settled, self.settled.heaviest
        pressure = s.face_pressure(k)
        largest = max(float(s.face_pressure(int(j)).max()) for j in s.kept)
        at = PressureMap(s.inputs.fixed.vertices, s.inputs.fixed.faces, pressure, s.centres("total"), k, largest)
        forces = {side: s.forces(side) for side in SIDES}
        return {"settle": pressure_figure(s.inputs.motion.course, forces, s.peaks, at)}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Thinned]:
        """Both bodies with pressures, curves and numbers over time."""
        return {REPORT: thinned_page(self.settled, self.sentences)}

    def write_files(self, folder: Path) -> None:
        """settled.mot besides, and what was asked for: loads for OpenSim, a series for ParaView."""
        s = self.settled
        time, poses = s.inputs.motion.time[s.kept], s.poses
        values = np.hstack([np.degrees(s.knee_angles[s.kept]), poses.translation])
        write_storage(folder / "settled.mot", time, COORDINATES, values, title=s.inputs.title, degrees=True)
        if self.options.bodies is not None:
            found = [load for load in s.loads if load is not None]
            loads = {side: [load[side] for load in found] for side in SIDES[:2]}
            write_contact_loads(folder, time, loads, *self.options.bodies)
        if self.options.paraview:
            write_pressure_series(self._series(), folder / "paraview")
        super().write_files(folder)

    def _series(self) -> PressureSeries:
        s = self.settled
        fixed, moving, kept = s.inputs.fixed, s.inputs.bed.moving, s.kept
        return PressureSeries(
            s.inputs.motion.time[kept],
            (fixed.vertices, fixed.faces),
            (moving.vertices, moving.faces),
            s.poses,
            lambda k: s.face_pressure(int(kept[k])),
        )


BALANCED = 0.01  # of the work; a larger difference is a reservation
STRAINED = 0.2  # largest strain that the linear law is trusted to
WHOLE = 1.0  # strain at which nothing is left of the layer
UNBALANCED = 0.1  # of the work; from a larger difference on the equilibrium is none
SATURATED = 0.99  # of the layer's area
NAMED = 8  # frames that a warning names


def run(i: SettleInputs, o: SettleOptions) -> SettleResult:
    """Every frame after the other, then the balance of energy in that with the largest load."""
    wanted = coordinates_of(i.motion.poses, i.bed.point)
    with listener().progress("equilibrium", len(wanted)) as step:

        def each(frame: Frame) -> None:
            _refuse_indeterminate(i, frame)
            step()

        frames = settle_along(i.bed, i.fixed, wanted, i.load, i.springs, i.free, each)
    settled = Settled(i, tuple(frames), o.side)
    _refuse_nowhere(i, settled)
    heaviest = settled.heaviest
    rest = frames[heaviest].rest
    balance = None if rest is None else energy_balance(i.bed, frames[heaviest].pull, rest, i.free)
    judge(goodness_of(i, settled, balance))
    shares = settled.forces("medial") / settled.forces("total")
    lifted = float(np.mean((shares > 1.0 - LIFTED) | (shares < LIFTED)))
    if lifted >= MUCH:
        what = f"in {lifted:.0%} of the frames all of the force is medial, or all lateral"
        reserve(f"{what}: unless there is one condyle, are `split`, `load_point` and `springs` right?")
    _summarise(i, settled, balance)
    say(f"medial is {medial_side(o.split, o.side, None).words} of {i.fixed.name}")
    published = None if o.compare is None else beside_published_areas(_knee_run(settled))
    error = settle_error(i, o, heaviest)
    return SettleResult(options=o, settled=settled, balance=balance, published=published, pose_error=error)


def _knee_run(s: Settled) -> KneeRun:
    """Flexion, load and contact area of the frames at rest."""
    kept = s.kept
    return KneeRun(s.knee_angles[kept, 0], s.inputs.load[kept], {"total": s.areas[kept]})


def _refuse_indeterminate(i: SettleInputs, frame: Frame) -> None:
    """InputError where contact and springs leave a free coordinate anywhere."""
    if frame.rest is None:
        return
    loose = not_held(frame.rest.total.stiffness, i.free, frame.pull.load)
    if loose and (frame.rest.converged or not i.springs.any()):
        what = f"nothing holds {' and '.join(loose)}: the contact has no stiffness along it"
        raise InputError("", "`free`", what, f"leave out one of them, or give `springs` {loose[0]}=…")


def _refuse_nowhere(i: SettleInputs, s: Settled) -> None:
    """InputError where no frame has an equilibrium."""
    if s.converged.any():
        return
    if all(frame.rest is None for frame in s.frames):
        what = f"{i.bed.moving.name} misses the layer of {i.fixed.name} along -y in every frame: no contact found"
        raise InputError("", "", what, "check motion, unit, `moving_body` and `region`")
    residual = min(frame.rest.residual for frame in s.frames if frame.rest is not None)
    what = f"no frame came to rest; at best {residual:.3g} N of residual force remained"
    raise InputError(
        "",
        "`free`",
        what,
        "let fewer coordinates settle, give `springs`, or check units of `modulus` and load, and `load_point`",
    )


def goodness_of(i: SettleInputs, s: Settled, balance: EnergyBalance | None) -> GoodnessOfFit:
    """Frames without rest, strains beyond the law, a layer that is pressed all over, energy that is not balanced."""
    missed = [k for k, frame in enumerate(s.frames) if frame.rest is None]
    stuck = [k for k, frame in enumerate(s.frames) if frame.rest is not None and not frame.converged]
    most = len(missed) + len(stuck) >= MUCH * len(s.frames)
    doubts = []
    for frames, what in ((missed, "no contact found"), (stuck, "did not come to rest")):
        if frames:
            times = ", ".join(f"{i.motion.time[k]:g}" for k in frames[:NAMED])
            more = ", …" if len(frames) > NAMED else ""
            line = f"{len(frames)} of {len(s.frames)} frames: {what} (at {times}{more} s); their rows are empty"
            doubts.append(Doubt(line, most, len(frames) / len(s.frames)))
    strain = s.largest_strain
    if i.bed.layer.law == "linear" and strain > STRAINED:
        line = f"the strain of the layer is up to {strain:.0%}: use `foundation` logarithmic"
        doubts.append(Doubt(line, strain >= WHOLE, strain))
    whole = float(np.sum(i.bed.layer.pieces.area))
    saturated = float(np.mean(s.areas[s.kept] >= SATURATED * whole))
    doubts += of_range("all of the layer is under pressure, so that the contact ends with it, for", saturated)
    if balance is not None and balance.difference > BALANCED:
        line = f"work and stored energy differ by {balance.difference:.1%}; give a smaller `piece`"
        doubts.append(Doubt(line, balance.difference > UNBALANCED, balance.difference))
    if np.isfinite(s.peaks).any():
        peak = float(np.nanmax(s.peaks))
        doubts += [
            replace(each, what=f"{each.what}; check `modulus`, `poisson`, `thickness` and the load")
            for each in of_size("the largest pressure", (peak, peak), BEARING)
        ]
    return GoodnessOfFit(tuple(doubts), ("frames at rest", "strain", "area", "pressure", "energy"))


def _between(values: Float[np.ndarray, " t"], form: str) -> str:
    """Smallest and largest in words, once where they are written alike."""
    low, high = format(np.nanmin(values), form), format(np.nanmax(values), form)
    return low if low == high else f"{low} … {high}"


def _summarise(i: SettleInputs, s: Settled, balance: EnergyBalance | None) -> None:
    peak, area = s.peaks * 1e-6, s.areas * 1e6
    shares = s.forces("medial") / s.forces("total")
    say(
        f"{int(s.converged.sum())} of {len(s.frames)} frames at rest under {_between(i.load, '.0f')} N: "
        f"contact area {_between(area, '.1f')} mm^2, pressure up to {np.nanmax(peak):.2f} MPa, "
        f"{_between(100.0 * shares, '.0f')} % of the force medial"
    )
    strain = s.largest_strain
    found: dict[str, object] = {
        "frames": len(s.frames),
        "frames_at_rest": int(s.converged.sum()),
        "pieces": len(i.bed.layer.pieces.area),
        "layer_modulus_Pa": i.bed.layer.modulus,
        "largest_pressure_Pa": float(np.nanmax(s.peaks)),
        "largest_strain": round(strain, 6),
        "largest_residual_N": float(np.nanmax(s.residuals)),
        "newton_steps_per_frame": round(float(np.mean([f.rest.steps for f in s.frames if f.rest is not None])), 2),
    }
    if balance is None:
        reserve("the balance of energy was not checked: no equilibrium under smaller loads, not on the axial way")
    else:
        found |= {"work_of_load_J": balance.work, "stored_energy_J": balance.stored, "axial_way_alone": balance.alone}
        way = (
            " on the axial way alone, as smaller loads have no equilibrium with all that is free"
            if balance.alone
            else ""
        )
        say(
            f"work of the load {balance.work * 1e3:.4g} mJ, energy stored {balance.stored * 1e3:.4g} mJ: "
            f"{100.0 * balance.difference:.2g} % apart{way}"
        )
    note("equilibrium", found)


settle = Job("knee settle", SettleOptions, read, run)
