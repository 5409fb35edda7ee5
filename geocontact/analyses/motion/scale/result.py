"""A model made to measure from a static trial: `geocontact scale`, `gc.scale`.

>>> import geocontact as gc
>>> static = gc.virtual_markers("meshes/leg_swing.mot", model="meshes/leg.osim").write("virtual") / "markers.trc"
>>> result = gc.scale(static, model="meshes/leg.osim", mass=24.0)
>>> print(result)
scaled: no body; markers 25.8 mm from the model, root mean square, and 50.3 mm at most, foot_r2 at 0 s
(OpenSim advises less than 10 and 20 mm)
warning: virtual/markers.trc: foot_r2 moves 491 mm away from its mean: is this standing still?
warning: markers are 25.8 mm from the model, root mean square, and 50.3 mm at most, foot_r2 at 0 s (OpenSim
advises less than 10 and 20 mm): check where foot_r2 is on the model and in the recording, the scaling, and
exchanged markers
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.collector import judge, reserve, results, say, seen_from_results
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.json_file import plain, write_json
from geocontact.analyses.frame.result import REPORT, Result
from geocontact.analyses.motion.goodness import goodness_of_poses
from geocontact.analyses.motion.marker_tasks import STANDING, MarkerErrors
from geocontact.analyses.motion.panels import printed
from geocontact.analyses.motion.scale.factors import Standing, labelled, read
from geocontact.analyses.motion.scale.options import ScaleOptions
from geocontact.analyses.motion.scale.show import scaling_page
from geocontact.data.errors import InputError
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.data.multibody.model import Multibody
from geocontact.dynamics.inverse_kinematics import Poses, inverse_kinematics
from geocontact.dynamics.scaling import Factors, scaled
from geocontact.dynamics.tree import tree_of
from geocontact.io.mocap.trc import write_trc
from geocontact.io.opensim.osim_scaler import write_scaled_model
from geocontact.io.opensim.tool_setup_writer import write_scale_setup

if TYPE_CHECKING:
    from geocontact.view.page.content import Page


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class ScaleResult(Result):
    """A scaled model and its static pose.

    Parameters
    ----------
    standing
        The trial and what each marker counts.
    factors
        Of the bodies that were scaled, along their axes.
    model
        The scaled model.
    pose
        Coordinates of the static pose [rad, m], and how far the markers are from it [m].
    seen, modelled
        Markers of the pose as they were seen and as scaling put them, in the ground's frame [m].
    summary
        Numbers of the scaling, with units in their names.
    """

    elsewhere: ClassVar[frozenset[str]] = frozenset({"markers", "factors"})

    options: ScaleOptions
    standing: Standing
    factors: Factors
    model: Multibody
    pose: Poses
    seen: Float[np.ndarray, "m 3"]
    modelled: Float[np.ndarray, "m 3"]
    summary: dict[str, Any]

    @property
    def rms(self) -> float:
        """Distance of the markers from the model in the static pose, root mean square [m]."""
        return 1e-3 * float(self.summary["static_rms_mm"])

    @property
    def distances(self) -> dict[str, float]:
        """Distance of each marker from the model in the static pose [m]."""
        return dict(zip(self.pose.markers, self.pose.distances[0].tolist(), strict=True))

    @property
    def scale_factors(self) -> dict[str, float]:
        """Factor of each body that was scaled [-]; by body and axis where they differ."""
        return labelled(self.factors)

    def tables(self) -> dict[str, pd.DataFrame]:
        """`markers`, how far each is from the scaled model; `factors` by body, or body and axis; `naming`."""
        off = {"marker": list(self.pose.markers), "distance [mm]": 1e3 * self.pose.distances[0]}
        told = labelled(self.factors)
        by = {"body": list(told), "factor [-]": list(told.values())}
        found = {"markers": pd.DataFrame(off), "factors": pd.DataFrame(by)}
        naming = self.standing.naming
        return found if naming is None else {**found, "naming": naming.table()}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """The static pose with its markers, factors, distances."""
        title, both = f"Model scaled to {self.options.static.name}", (self.seen, self.modelled)
        return {REPORT: scaling_page(title, self.model, labelled(self.factors), self.pose, both, self.standing.naming)}

    def write_files(self, folder: Path) -> None:
        """scaled.osim, scale.json and OpenSim's set-up with the static trial as it was read besides."""
        values = np.asarray(self.pose.values)[0].tolist()
        standing = {name: v for name, v in zip(self.pose.names, values, strict=True) if np.isfinite(v)}
        defaults = None if self.options.keep_markers else standing
        write_scaled_model(self.options.model, folder / "scaled.osim", self.model, self.factors, defaults)
        write_json(folder / "scale.json", self.summary)
        self._write_setup(folder)
        super().write_files(folder)

    def _write_setup(self, folder: Path) -> None:
        """With which OpenSim's own tool makes the same model."""
        o, standing = self.options, self.standing
        write_trc(folder / "seen.trc", standing.recorded)
        model = seen_from_results(o.model)
        markers = "" if o.marker_set is None else seen_from_results(o.marker_set)
        if standing.naming is not None:  # OpenSim's tool needs the markers under these labels
            model, markers = "model.osim", ""
            write_scaled_model(o.model, folder / model, standing.model, {})
        write_scale_setup(
            folder / "setup_scale.xml",
            model,
            markers,
            "seen.trc",
            self.factors,
            standing.tasks,
            (float(standing.recorded.time[0]), float(standing.recorded.time[-1])),
            mass=o.mass,
            by_volume=o.mass_by_volume,
            place=not o.keep_markers,
            out="opensim_scaled.osim",
            measured=standing.measured if self._by_known_pairs() else (),
        )

    def _by_known_pairs(self) -> bool:
        """Whether a set-up's pairs gave the factors, in the static trial, and by names that OpenSim's tool can read."""
        o, texts = self.options, self.standing.measured
        alone = self.standing.known is not None and not o.scale and o.sizes is None and o.sizes_time is None
        return alone and bool(texts) and not any(" " in text for text in texts)


def run(given: Standing, o: ScaleOptions) -> ScaleResult:
    """Sizes and mass, the static pose, and markers where they were seen in it."""
    try:
        made = scaled(given.model, given.factors, o.mass, by_volume=o.mass_by_volume)
    except ValueError as error:
        raise InputError(o.model, "", str(error), "correct the model") from error
    _doubt_mass(given, o)
    try:
        pose = inverse_kinematics(tree_of(made), given.markers, given.tasks)
    except ValueError as error:
        raise InputError(o.static, "", str(error), "is it the right file?") from error
    if not pose.settled.all():
        reserve("the static pose did not converge: markers and model may not match")
    moved = made if o.keep_markers else _placed(made, given.markers, pose)
    summary = _summary(given, pose, moved)
    results().update(plain(summary))
    judge(goodness_of_poses(pose, made, STANDING), warned=True)
    _report(given, pose)
    which = [[m.name for m in made.markers].index(name) for name in pose.markers]
    return ScaleResult(
        options=o,
        standing=given,
        factors=given.factors,
        model=moved,
        pose=pose,
        seen=given.markers.of(pose.markers)[0],
        modelled=made.marker_places(pose.values)[0, which],
        summary=summary,
    )


DENSER = 0.5, 2.0
"""Times the mass of the model, grown with the volumes of its bodies, that a subject's may be: from 14 to 50 kg/m² (WHO,
TRS 894), 22 of a usual model, and legs that are 15 % longer or shorter than the body is. Pounds are 2.2 times."""


def _doubt_mass(given: Standing, o: ScaleOptions) -> None:
    """A warning for a mass that a body of the scaled size does not have."""
    if o.mass is None:
        return
    grown = sum(body.mass for body in scaled(given.model, given.factors, None, by_volume=True).bodies)
    if not DENSER[0] * grown <= o.mass <= DENSER[1] * grown:
        what = f"{o.mass:.4g} kg is {o.mass / grown:.2g} times what {given.model.name} has at the size of the subject"
        reserve(f"`mass`: {what}, {grown:.4g} kg; is it in kg, and are factors and mass of one person?")


def _placed(model: Multibody, seen: MarkerTrajectories, pose: Poses) -> Multibody:
    """Markers that were seen where they were, in the static pose; others, and fixed ones, where scaling put them."""
    poses = model.poses(pose.values)
    places = seen.of(tuple(m.name for m in model.markers))[0]
    markers = tuple(
        m if m.fixed or not np.isfinite(place).all() else replace(m, location=poses[m.body][0].inv().apply(place))
        for m, place in zip(model.markers, places, strict=True)
    )
    return replace(model, markers=markers)


def _summary(given: Standing, pose: Poses, made: Multibody) -> dict[str, object]:
    """Numbers of the scaling, as `scale.json` holds them."""
    off = 1e3 * pose.distances[0]
    units = {"rotational": "deg", "translational": "m"}
    values = printed(made.coordinates, pose.values)[0].tolist()
    return {
        "factors": labelled(given.factors),
        "mass_kg": sum(body.mass for body in made.bodies),
        "static_rms_mm": float(np.sqrt(np.nanmean(off**2))),
        "markers_mm": dict(zip(pose.markers, off.tolist(), strict=True)),
        "static_pose": {
            f"{c.name} [{units.get(c.kind, 'rad or m')}]": v for c, v in zip(made.coordinates, values, strict=True)
        },
    }


def _report(given: Standing, pose: Poses) -> None:
    errors = MarkerErrors.of(pose)
    errors.warn(STANDING)
    sizes = ", ".join(f"{name} {by:.3f}" for name, by in labelled(given.factors).items()) or "no body"
    say(f"scaled: {sizes}; markers {errors.words(STANDING)}")


scale = Job("scale", ScaleOptions, read, run)
