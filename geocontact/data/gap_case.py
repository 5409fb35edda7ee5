"""A gap case: a model that somebody trusts, trials that were measured, and what is known of both."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import pandas as pd

from geocontact.data.gap_cells import CellChannels
from geocontact.data.mesh import Mesh
from geocontact.data.parameter import Parameter
from geocontact.data.simulator import Simulator
from geocontact.data.trial import Trial

LISTED_SYSTEMS = ("elbow", "foot", "shoulder", "knee", "sit_to_stand")
"""Names that `system` may have besides "package.module:OBJECT"; the vocabulary of effects is stated for these."""

COMMAND = "command"
"""The name of a system that a program simulates."""


@dataclass(frozen=True)
class CaseMesh:
    """A surface that a case brings, and which of its faces count.

    Parameters
    ----------
    mesh
        As it was read, vertices in m.
    region
        Expression in x y z (face centroid) and nx ny nz (`geometry.regions.faces_where`); "" for all faces.
    metres_per_number
        Of x, y, z in it: the unit of the mesh's file.
    """

    mesh: Mesh
    region: str = ""
    metres_per_number: float = 1.0


@dataclass(frozen=True)
class GapCase:
    """Everything that goes into a diagnosis, SI units.

    Parameters
    ----------
    name
        Of the case; no part of the answer depends on it.
    system
        Name of the base model, or "package.module:OBJECT" for one of the user's own.
    calibration, evaluation
        Trials that parameters may be fitted to, and those held out.
    parameters
        Of the base model.
    constants
        Known and exact as far as anyone knows.
    noise
        Standard deviation of the sensor noise of some measured channels, in the channel's SI unit.
    tables
        Further tables by their key in case.toml ("spheres", "support"), units in the column names, SI.
    meshes
        Surfaces by their name in case.toml ("moving", "fixed").
    cells
        Cells of pressure mats by the site's name in case.toml ("thigh").
    simulator
        Where the system is "command": the program that simulates it.
    """

    name: str
    system: str
    calibration: tuple[Trial, ...]
    evaluation: tuple[Trial, ...]
    parameters: tuple[Parameter, ...]
    constants: Mapping[str, float] = field(default_factory=dict)
    noise: Mapping[str, float] = field(default_factory=dict)
    tables: Mapping[str, pd.DataFrame] = field(default_factory=dict)
    meshes: Mapping[str, CaseMesh] = field(default_factory=dict)
    cells: Mapping[str, CellChannels] = field(default_factory=dict)
    simulator: Simulator | None = None
