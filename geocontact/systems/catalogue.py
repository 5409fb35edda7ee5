"""All base models."""

from __future__ import annotations

from geocontact.chain.system import System
from geocontact.data.gap_case import GapCase
from geocontact.systems.base import Base
from geocontact.systems.elbow_exoskeleton import ELBOW
from geocontact.systems.own import own_system
from geocontact.systems.prosthetic_foot import FOOT

SYSTEMS: tuple[Base, ...] = (ELBOW, FOOT)


def system_of(case: GapCase) -> System:
    """Base model of a case, its scale taken from the calibration trials.

    ValueError when the system is not known or lacks a number; "package.module:OBJECT" is imported.
    """
    if ":" in case.system:
        return own_system(case).scaled(case.calibration)
    for base in SYSTEMS:
        if base.name == case.system:
            system = base.build(case.parameters, case.constants, case.tables)
            return system.scaled(case.calibration)
    raise ValueError(f"unknown system {case.system!r}; known are {', '.join(base.name for base in SYSTEMS)}")
