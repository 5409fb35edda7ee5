"""What a system is made of: motion, geometry, law, balance, sensor; and what it means to add an effect to one.

`gc.chain.System(...)` and its parts, for a base model of one's own: docs/how-to/own_model.md.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from geocontact.chain.contact_law import CONTACT_LAW
    from geocontact.chain.effect import Candidate, Effect
    from geocontact.chain.interface_law import INTERFACE_LAW
    from geocontact.chain.links import Balance, ContactSites, Geometry, Law, LawParameters, Modifier, Motion, Sensor
    from geocontact.chain.magnitudes import Magnitudes
    from geocontact.chain.single_deflection import SingleDeflection
    from geocontact.chain.system import System
    from geocontact.chain.traits import Mass, Migration, Traits, Way

_PLACES = {
    "Candidate": "effect",
    "Effect": "effect",
    "CONTACT_LAW": "contact_law",
    "INTERFACE_LAW": "interface_law",
    "LawParameters": "links",
    "Balance": "links",
    "Geometry": "links",
    "Law": "links",
    "Modifier": "links",
    "Motion": "links",
    "ContactSites": "links",
    "Sensor": "links",
    "Magnitudes": "magnitudes",
    "SingleDeflection": "single_deflection",
    "System": "system",
    "Mass": "traits",
    "Migration": "traits",
    "Traits": "traits",
    "Way": "traits",
}

__all__ = [
    "CONTACT_LAW",
    "INTERFACE_LAW",
    "Balance",
    "Candidate",
    "ContactSites",
    "Effect",
    "Geometry",
    "Law",
    "LawParameters",
    "Magnitudes",
    "Mass",
    "Migration",
    "Modifier",
    "Motion",
    "Sensor",
    "SingleDeflection",
    "System",
    "Traits",
    "Way",
]


def __getattr__(name: str) -> Any:
    """Import the part that is asked for."""
    if name in _PLACES:
        return getattr(import_module(f"geocontact.chain.{_PLACES[name]}"), name)
    raise AttributeError(f"module 'geocontact.chain' has no attribute {name!r}")
