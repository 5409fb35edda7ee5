"""All base models."""

from __future__ import annotations

from geocontact.chain.system import System
from geocontact.data.gap.case import COMMAND, GapCase
from geocontact.systems.base import Base
from geocontact.systems.elbow.model import ELBOW
from geocontact.systems.external.program import program_system
from geocontact.systems.external.python_model import python_system
from geocontact.systems.foot.model import FOOT
from geocontact.systems.knee.model import KNEE
from geocontact.systems.shoulder.model import SHOULDER
from geocontact.systems.sit_to_stand.model import SIT_TO_STAND
from geocontact.systems.validate import refusal, validated

SYSTEMS: tuple[Base, ...] = (ELBOW, FOOT, SHOULDER, KNEE, SIT_TO_STAND)


def system_of(case: GapCase) -> System:
    """Base model of a case, its scale taken from the calibration trials.

    InputError when the system is not known, when the case lacks a number, table or channel that it needs, or when it
    fails on a trial; "package.module:OBJECT" is imported.
    """
    if ":" in case.system:
        return python_system(case).scaled(case.calibration)
    if case.system == COMMAND:
        return validated(program_system(case), case).scaled(case.calibration)
    base = next((one for one in SYSTEMS if one.name == case.system), None)
    if base is None:
        known = ", ".join(one.name for one in SYSTEMS)
        raise refusal(case, "has no base model here", f'there are {known}, and "package.module:OBJECT" for your own')
    try:
        system = base.made(case)
    except ValueError as error:
        raise refusal(case, str(error), "") from error
    return validated(system, case).scaled(case.calibration)
