"""A prosthetic foot as it is simulated: a keel on its sole, with what is known of it besides."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from geocontact.below_knee_prosthesis.keel.keel import Keel
from geocontact.below_knee_prosthesis.keel.quasi_static import QuasiStaticKeel
from geocontact.below_knee_prosthesis.keel.sole import KeelSole
from geocontact.data.parameter import Number
from geocontact.loads.sphere_set import SoleLaw


@dataclass(frozen=True)
class FootRecord:
    """Everything of a foot that is not in its equations.

    Parameters
    ----------
    name
        As sentences have it.
    below
        From the keel's axis to the lowest point of the sole [m].
    settings
        Fulcrum of each setting by its name [m].
    origin
        Numbers by their names in `foot_numbers`, with where they are from; `sole places` is for the spheres' places.
    actuator
        Speed at which the fulcrum can be moved without load [m/s]; None where it is not known.
    """

    name: str
    below: float
    settings: Mapping[str, float] = field(default_factory=dict)
    origin: Mapping[str, Number] = field(default_factory=dict)
    actuator: float | None = None


@dataclass(frozen=True)
class VariableStiffnessFoot:
    """A keel on its sole, at no fulcrum in particular."""

    keel: Keel
    sole: KeelSole
    law: SoleLaw
    record: FootRecord

    def at(self, fulcrum: float) -> QuasiStaticKeel:
        """At a fulcrum [m], without inertia."""
        return QuasiStaticKeel(self.keel, fulcrum, self.sole, self.law)
