r"""Equilibrium of several bodies on the layers of all pairs: `geocontact settle-pairs`, `gc.settle_pairs`.

>>> import geocontact as gc
>>> from pathlib import Path
>>> text = Path("meshes/resting_knee.toml").read_text().replace('mesh = "', 'mesh = "meshes/')
>>> for name in ("gait.csv", "gait_patella.csv"):
...     _ = Path(name).write_text("\n".join(Path("meshes", name).read_text().splitlines()[:3]))
>>> _ = Path("two_frames.toml").write_text(text)
>>> result = gc.settle_pairs("two_frames.toml")
>>> print(result.sentences[0])
2 of 2 frames at rest: femur, patella
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.area.contact import STRAINED
from geocontact.analyses.area.pairs.equilibrium import (
    PressingBodies,
    RestFrame,
    RestingBodies,
    read,
    refuse_indeterminate,
    settle_frames,
)
from geocontact.analyses.area.pairs.options import SettlePairsOptions
from geocontact.analyses.area.pairs.rest_show import rest_curves, thinned_rest_page
from geocontact.analyses.area.pairs.totals import WRENCH, counted_twice, loads_table
from geocontact.analyses.area.pairs.virtual_work import imbalance
from geocontact.analyses.frame.collector import judge, listener, note, reserve, say
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.pages import Thinned
from geocontact.analyses.frame.result import REPORT, Result
from geocontact.analyses.frame.words import counted
from geocontact.data.errors import InputError
from geocontact.data.plausible import BEARING
from geocontact.identify.goodness_of_fit import MUCH, Doubt, GoodnessOfFit, of_range, of_size
from geocontact.io.text.tables import listed
from geocontact.loads.settling_bodies import COORDINATES
from geocontact.view.curves.declared import CurveSheet

MM, MM2, MPA = 1e3, 1e6, 1e-6
WHOLE = 1.0  # strain at which nothing is left of the layer
NAMED = 8  # frames that a warning names
SATURATED = 0.99  # of the layer's area, as of `knee settle`
ENDS = "all of the layer is under pressure, so that the contact ends with it, for"
BALANCED, UNBALANCED = 0.01, 0.1  # of what a body bears, as work and energy of `knee settle`


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class SettlePairsResult(Result):
    """Equilibrium of several bodies over a motion.

    Parameters
    ----------
    resting
        Every frame.
    """

    options: SettlePairsOptions
    resting: RestingBodies

    @property
    def title(self) -> str:
        """The free bodies."""
        return f"{listed(tuple(self.resting.pressing.free))} at rest"

    @property
    def time(self) -> Float[np.ndarray, " t"]:
        """Time of the frames [s]."""
        return self.resting.pressing.time

    @property
    def force(self) -> dict[str, Float[np.ndarray, " t"]]:
        """Pressure times area of each pair that has a layer [N]; NaN where nothing is at rest."""
        return {name: self.resting.of_contact(name, lambda load: load.pressing) for name in self.resting.contacts}

    @property
    def pressure(self) -> dict[str, Float[np.ndarray, " t"]]:
        """Largest pressure of each of these pairs [Pa]."""
        return {name: self.resting.of_contact(name, lambda load: load.peak) for name in self.resting.contacts}

    @property
    def area(self) -> dict[str, Float[np.ndarray, " t"]]:
        """Area under pressure of each of these pairs [m^2]."""
        return {name: self.resting.of_contact(name, lambda load: load.area) for name in self.resting.contacts}

    @property
    def loads(self) -> dict[str, Float[np.ndarray, "t 6"]]:
        """Force [N] and moment about the common frame's origin [N m] of all contacts on each body, in that frame."""
        return self.resting.loads

    def tables(self) -> dict[str, pd.DataFrame]:
        """`bodies`, `contacts` and `loads`, rows empty where nothing is at rest; `poses_BODY` of the frames at rest."""
        r = self.resting
        found = {"bodies": bodies_table(r), "contacts": contacts_table(r), "loads": loads_table(r.loads, self.time)}
        return found | {f"poses_{body}": poses_table(r, body) for body in r.pressing.free}

    def curves(self) -> Mapping[str, CurveSheet]:
        """Forces, pressures and areas by pair, and coordinates of the free bodies."""
        return {"settled": rest_curves(self.resting)}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Thinned]:
        """All bodies together with pressures."""
        return {REPORT: thinned_rest_page(self.title, self.resting, self.sentences)}


def bodies_table(r: RestingBodies) -> pd.DataFrame:
    """A row per frame: coordinates of each free body and its residual force."""
    columns: dict[str, object] = {"time [s]": r.pressing.time, "at_rest": r.converged.astype(int)}
    for k, body in enumerate(r.pressing.free):
        values = r.coordinates(body)
        columns |= {f"{body}_{name} [mm]": values[:, j] * MM for j, name in enumerate(COORDINATES[:3])}
        columns |= {f"{body}_{name} [deg]": np.degrees(values[:, 3 + j]) for j, name in enumerate(COORDINATES[3:])}
        columns[f"{body}_residual [N]"] = r.residuals[:, k]
    return pd.DataFrame(columns)


def contacts_table(r: RestingBodies) -> pd.DataFrame:
    """A row per pair and frame: what it does to FIXED, in the common frame; MOVING bears the opposite."""
    return pd.concat([_contact(r, name) for name in r.contacts], ignore_index=True)


def _contact(r: RestingBodies, name: str) -> pd.DataFrame:
    pair = r.pressing.pairs[r.pressing.names.index(name)]
    centre = np.full((len(r.frames), 3), np.nan)
    for place, k in enumerate(r.kept):
        load = r.contacts[name][k]
        if load is not None:
            centre[k] = r.poses[pair.fixed][place].apply(load.centre)
    columns: dict[str, object] = {"pair": name, "on": pair.fixed, "time [s]": r.pressing.time}
    columns |= {column: r.wrenches[name][:, k] for k, column in enumerate(WRENCH)}
    columns |= {f"cop_{x} [mm]": centre[:, k] * MM for k, x in enumerate("xyz")}
    columns["force [N]"] = r.of_contact(name, lambda load: load.pressing)
    columns["peak [MPa]"] = r.of_contact(name, lambda load: load.peak) * MPA
    columns["pressed_area [mm^2]"] = r.of_contact(name, lambda load: load.area) * MM2
    return pd.DataFrame(columns)


def poses_table(r: RestingBodies, body: str) -> pd.DataFrame:
    """Poses of a free body in the common frame in the frames at rest, as a `motion`."""
    poses = r.poses[body]
    shift, turn = poses.translation * MM, poses.rotation.as_quat(scalar_first=True)
    columns: dict[str, object] = {"time [s]": r.pressing.time[r.kept]}
    columns |= {f"t{letter} [mm]": shift[:, axis] for axis, letter in enumerate("xyz")}
    columns |= {f"q{letter} [-]": turn[:, k] for k, letter in enumerate("wxyz")}
    return pd.DataFrame(columns)


def run(pressing: PressingBodies, o: SettlePairsOptions) -> SettlePairsResult:
    """Every frame after the other."""
    layered = [pair for pair in pressing.touching.pairs if pair.name in pressing.names]
    for body, one, other, whole in counted_twice(layered):
        if "loads" in whole:
            reserve(f"faces of {body} press in {one} and in {other}: where both touch, they bear twice")
    with listener().progress("equilibrium", len(pressing.time)) as step:

        def each(frame: RestFrame) -> None:
            refuse_indeterminate(frame, o)
            step()

        frames = settle_frames(pressing, each)
    resting = RestingBodies(pressing, tuple(frames))
    _refuse_nowhere(resting, o)
    _name_idle(resting, o)
    judge(goodness_of(resting))
    result = SettlePairsResult(options=o, resting=resting)
    _summarise(result)
    return result


def _refuse_nowhere(r: RestingBodies, o: SettlePairsOptions) -> None:
    """InputError where no frame has an equilibrium."""
    if r.converged.any():
        return
    apart = sorted(set.intersection(*(set(frame.apart) for frame in r.frames)))
    if apart:
        what = f"no frame came to rest: no layer presses on {listed(tuple(apart))} wherever its force leads"
        raise InputError(o.description, "[[free]]", what, "check direction and axes of the force, motions and `region`")
    best = int(np.argmin(r.residuals.max(axis=1)))
    raise InputError(
        o.description,
        "[[free]]",
        f"no frame came to rest; {_how_far(r, best)}",
        "let fewer coordinates settle, or write springs",
    )


def _name_idle(r: RestingBodies, o: SettlePairsOptions) -> None:
    """A reservation for frames in which no force acts: every place without contact is one of rest."""
    idle = [f"{r.pressing.time[k]:g}" for k, frame in enumerate(r.frames) if frame.assembly.load == 0.0]
    if idle:
        times = ", ".join(idle[:NAMED]) + (", …" if len(idle) > NAMED else "")
        reserve(
            f"{o.description}: no force acts at {times} s: bodies stay where the frame before or the motion has them"
        )


def _how_far(r: RestingBodies, k: int) -> str:
    """How far the search of a frame without rest came."""
    frame = r.frames[k]
    worst = int(np.argmax(r.residuals[k]))
    left, borne = r.residuals[k, worst], frame.assembly.borne(frame.rest.total)[worst]
    body, count = list(frame.assembly.bodies)[worst], counted(frame.rest.steps, "step")
    return f"at {r.pressing.time[k]:g} s {left:.3g} N of {borne:.4g} N on {body} remained after {count}"


def goodness_of(r: RestingBodies) -> GoodnessOfFit:
    """Frames without rest, strains beyond the law, pressures that no bearing has."""
    doubts = []
    stuck = [k for k, frame in enumerate(r.frames) if not frame.converged]
    if stuck:
        times = ", ".join(f"{r.pressing.time[k]:g}" for k in stuck[:NAMED]) + (", …" if len(stuck) > NAMED else "")
        apart = sorted({body for k in stuck for body in r.frames[k].apart})
        line = f"{len(stuck)} of {len(r.frames)} frames did not come to rest (at {times} s); their rows are empty"
        line += f"; in some no layer presses on {listed(tuple(apart))}" if apart else ""
        line += f"; {_how_far(r, min(stuck, key=lambda k: r.residuals[k].max()))}"
        share = len(stuck) / len(r.frames)
        doubts.append(Doubt(line, share >= MUCH, share))
    for (name, strain), pair in zip(r.largest_strain.items(), r.pressing.pairs, strict=True):
        if pair.layer.law == "linear" and strain > STRAINED:
            line = f"{name}: the strain of the layer is up to {strain:.0%}: use foundation logarithmic"
            doubts.append(Doubt(line, strain >= WHOLE, strain))
    for name in r.contacts:
        area = r.of_contact(name, lambda load: load.area)[r.kept]
        whole = float(np.sum(r.pressing.pairs[r.pressing.names.index(name)].layer.pieces.area))
        saturated = float(np.mean(area >= SATURATED * whole))
        doubts += of_range(f"{name}: {ENDS}", saturated)
        peak = float(np.nanmax(r.of_contact(name, lambda load: load.peak)))
        if peak > 0.0:
            doubts += of_size(f"the largest pressure of {name}", (peak, peak), BEARING)
    off = float(imbalance(r)[r.kept].max())
    if off > BALANCED:
        line = f"virtual work of contacts and applied forces differs by {off:.1%}; give a smaller piece of the layers"
        doubts.append(Doubt(line, off > UNBALANCED, off))
    return GoodnessOfFit(tuple(doubts), ("frames at rest", "strain", "area under pressure", "pressure", "virtual work"))


def _summarise(result: SettlePairsResult) -> None:
    r = result.resting
    say(f"{int(r.converged.sum())} of {len(r.frames)} frames at rest: {listed(tuple(r.pressing.free))}")
    found: dict[str, object] = {"frames": len(r.frames), "frames_at_rest": int(r.converged.sum())}
    for name, force in result.force.items():
        peak, area = np.nanmax(result.pressure[name]) * MPA, result.area[name] * MM2
        say(
            f"{name}: force up to {np.nanmax(force):.1f} N, pressure up to {peak:.2f} MPa on {np.nanmax(area):.1f} mm^2"
        )
        found[name] = {"largest_force_N": float(np.nanmax(force)), "largest_pressure_MPa": float(peak)}
        if not np.nanmax(force) > 0.0:
            reserve(f"{name}: the bodies never press on each other")
    found["virtual_work_imbalance"] = float(imbalance(r)[r.kept].max())
    found["largest_residual_N"] = float(r.residuals[r.kept].max())
    found["newton_steps_per_frame"] = round(float(np.mean([frame.rest.steps for frame in r.frames])), 2)
    note("equilibrium", found)


settle_pairs = Job("settle-pairs", SettlePairsOptions, read, run)
