"""What a scaling gives: two models for OpenSim, tables of segments, joints and numbers, the standing pose."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.prosthesis.scale.options import ProsthesisScaleOptions
from geocontact.analyses.prosthesis.scale.page import amputee_page
from geocontact.analyses.result import REPORT, Result
from geocontact.below_knee_prosthesis.both_sides.amputee import Amputee
from geocontact.below_knee_prosthesis.from_markers.sides import of_side
from geocontact.data.multibody.model import Multibody
from geocontact.data.sourced_number import Number
from geocontact.dynamics.inverse_kinematics import Poses
from geocontact.io.opensim.osim_writer import ContactBall, write_osim

if TYPE_CHECKING:
    from geocontact.view.page.content import Page

FREE, HELD = "amputee.osim", "amputee_ik.osim"
NOTE = (
    "Made by geocontact prosthesis scale. Springs of socket and keel are those of one fulcrum; the spheres of both "
    "soles have no force law here. Trunk, head and arms are one rigid body with the pelvis (masses and moments of "
    "inertia: de Leva 1996), upright as while standing, arms hanging: they lean and turn with the pelvis alone, "
    "so that moments on pelvis and hips leave out what a trunk does by itself."
)


@dataclass(frozen=True)
class JointFound:
    """A joint of a person who stands.

    Parameters
    ----------
    how
        Its centre was found.
    place
        In the laboratory [m].
    rms
        How far both segments put it apart [m]; None where no functional trial tells it.
    """

    name: str
    how: str
    place: Float[np.ndarray, " 3"]
    rms: float | None


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class ProsthesisScaleResult(Result):
    """A person with a prosthesis, made to measure.

    Parameters
    ----------
    amputee
        Both legs, as of a right prosthesis.
    model
        Of the person's own side, every coordinate free but two of each knee.
    held
        The same with socket and keel held, for what markers tell.
    pose
        While standing [rad, m].
    moved
        In the functional trial, and how far its markers are from the model [m]; None without such a trial.
    """

    options: ProsthesisScaleOptions
    amputee: Amputee
    model: Multibody
    held: Multibody
    pose: Poses
    moved: Poses | None
    joints: tuple[JointFound, ...]
    numbers: Mapping[str, Number]

    def tables(self) -> dict[str, pd.DataFrame]:
        """`segments`, `joints`, `numbers`, and `markers` of the functional trial where there is one."""
        rows = [(b.name, b.mass, *(1e3 * b.centre), *np.diag(b.inertia)) for b in self.model.bodies]
        axes = ("xx", "yy", "zz")
        names = ["segment", "mass [kg]", *(f"centre_{a} [mm]" for a in "xyz"), *(f"I{a} [kg m^2]" for a in axes)]
        found = [(j.name, j.how, *(1e3 * j.place), np.nan if j.rms is None else 1e3 * j.rms) for j in self.joints]
        joints = ["joint", "how", "x [mm]", "y [mm]", "z [mm]", "off itself [mm]"]
        told = [(name, number.value, number.source, number.note) for name, number in self.numbers.items()]
        tables = {
            "segments": pd.DataFrame(rows, columns=names),
            "joints": pd.DataFrame(found, columns=joints),
            "numbers": pd.DataFrame(told, columns=["number", "value", "source", "note"]),
        }
        if self.moved is not None:
            off = 1e3 * np.sqrt(np.nanmean(self.moved.distances**2, axis=0))
            tables["markers"] = pd.DataFrame({"marker": list(self.moved.markers), "off, rms [mm]": off})
        return tables

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """The standing pose with its markers, segments, joints, numbers."""
        title = f"Model of {self.options.static.name}"
        return {REPORT: amputee_page(title, self.held, self.pose, self.tables(), self.sentences)}

    def write_files(self, folder: Path) -> None:
        """Both models for OpenSim besides."""
        end = f"_{self.options.side[0]}"
        springs = {f"{name}{end}": pair for name, pair in self.amputee.springs().items()}
        write_osim(folder / FREE, self.model, springs=springs, balls=self._balls(), note=NOTE)
        write_osim(folder / HELD, self.held, note=NOTE)
        super().write_files(folder)

    def _balls(self) -> list[ContactBall]:
        """Spheres of both soles on the bodies that carry them."""
        side, keel, sole = self.options.side, self.amputee.foot.keel, self.amputee.foot.sole
        own, other = ("_r", "_l") if side == "right" else ("_l", "_r")
        sets = [(f"keel_{k}{own}" if k else f"calcn{own}", sole.on(k, keel)) for k in range(keel.joints + 1)]
        sets += list(zip((f"calcn{other}", f"toes{other}"), self.amputee.intact.spheres(), strict=True))
        found: list[ContactBall] = []
        for body, spheres in sets:
            if spheres is None:
                continue
            for centre, radius, zone in zip(spheres.centre, spheres.radius, spheres.zone, strict=True):
                found.append(ContactBall(f"{zone}_{len(found) + 1}", body, of_side(centre, side), float(radius)))
        return found
