"""Whether a copy of the joint's model can have the meshes: asked before anything is computed."""

from __future__ import annotations

from pathlib import Path

from geocontact.analyses.area.options import AreaOptions
from geocontact.analyses.frame.collector import results_place
from geocontact.data.errors import InputError
from geocontact.io.opensim.osim import JointModel, read_joint
from geocontact.io.opensim.osim_attached import with_meshes

EXPORT = "export"
"""Folder of the models for other programs."""


def model_to_copy(o: AreaOptions) -> tuple[Path, JointModel] | None:
    """The model that gets the meshes, and its joint; None where no copy of it is asked for.

    InputError where the copy cannot be written, or would take the place of the model.

    Where results go is known before the computation on the command line, and from Python when they are written.
    """
    if "opensim" not in (o.export or ()):
        return None
    if o.osim is None or o.joint is None:
        raise InputError("", "`export`", "opensim needs a joint", "give `osim` and `joint`")
    joint, out = read_joint(o.osim, o.joint), results_place()
    with_meshes(o.osim, {joint.parent: ("", ""), joint.child: ("", "")}, 1.0)
    source = o.osim.resolve()
    if out is not None and source.parent.name == EXPORT and source.is_relative_to(out.resolve()):
        what = f"is a copy in `out` {out}, which this run would replace"
        raise InputError(o.osim, "", what, "choose another `out`, or give the model that it is a copy of")
    return o.osim, joint
