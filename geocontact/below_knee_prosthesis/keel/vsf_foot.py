"""The variable-stiffness foot whole: keel, sole and law, fitted together to the study's three compressions."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

from geocontact.below_knee_prosthesis.keel.beam import Support
from geocontact.below_knee_prosthesis.keel.compression import Compressed
from geocontact.below_knee_prosthesis.keel.compression_test import calibrated_on_sole
from geocontact.below_knee_prosthesis.keel.keel import Keel
from geocontact.below_knee_prosthesis.keel.quasi_static import QuasiStaticKeel
from geocontact.below_knee_prosthesis.keel.sole import COLUMNS, KeelSole, law_of, sole_of
from geocontact.below_knee_prosthesis.keel.vsf import SETTINGS, fulcrum_of, vsf_keel
from geocontact.loads.sphere_set import SoleLaw


@dataclass(frozen=True)
class VariableStiffnessFoot:
    """A keel on its sole, at no fulcrum in particular."""

    keel: Keel
    sole: KeelSole
    law: SoleLaw

    def at(self, fulcrum: float, *, torsion: bool = False) -> QuasiStaticKeel:
        """At a fulcrum [m], without inertia."""
        return QuasiStaticKeel(self.keel, fulcrum, self.sole, self.law, torsion)


@lru_cache(maxsize=8)
def vsf_foot(
    support: Support = "pinned", *, joints: int = 8, finer: int = 1, columns: int = COLUMNS
) -> VariableStiffnessFoot:
    """EI and the forefoot's stiffness from low, medium and high; medium where beam theory puts it.

    A plate on the sole presses 8 mm behind the tip, so that EI is less than with the plate on the tip itself. Finer
    soles are fitted anew. `finer` and `columns` as for `sole_of`.
    """
    keel = vsf_keel(support, joints=joints)
    sole = sole_of(keel, finer=finer, columns=columns)
    measured = [Compressed(fulcrum_of(name, support), stiffness) for name, stiffness in SETTINGS.items()]
    bent, law = calibrated_on_sole(keel, sole, law_of(sole), measured)
    return VariableStiffnessFoot(bent, sole, law)
