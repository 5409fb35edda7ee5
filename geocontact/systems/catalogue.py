"""All base models."""

from __future__ import annotations

from geocontact.chain.system import System
from geocontact.data.gap_case import COMMAND, GapCase
from geocontact.systems.base import Base
from geocontact.systems.elbow import ELBOW
from geocontact.systems.foot import FOOT
from geocontact.systems.knee import KNEE
from geocontact.systems.python_model import python_system
from geocontact.systems.shoulder import SHOULDER
from geocontact.systems.simulator import program_system
from geocontact.systems.sit_to_stand import SIT_TO_STAND
from geocontact.systems.validate import refusal, validated

SYSTEMS: tuple[Base, ...] = (ELBOW, FOOT, SHOULDER, KNEE, SIT_TO_STAND)


def system_of(case: GapCase) -> System:
    r"""Base model of a case, its scale taken from the calibration trials.

    Parameters
    ----------
    case
        Its `system` is the name of a listed one, "command", or "package.module:OBJECT", which is imported.

    Raises
    ------
    InputError
        The system is not known, the case lacks a number, table or channel that it needs, or it fails on a trial.

    Examples
    --------
    >>> import geocontact as gc, numpy as np, pandas as pd
    >>> from pathlib import Path
    >>> Path("case/trials").mkdir(parents=True)
    >>> time, noise = 0.04 * np.arange(160), np.random.default_rng(3)
    >>> for k in range(1, 6):
    ...     angle = 0.3 * np.sin((2.0 + 0.4 * k) * time) + 0.08 * np.sin((5.0 + k) * time)
    ...     torque = 60.0 * angle + 3.0 * np.gradient(angle, time) + noise.normal(0.0, 0.2, 160)
    ...     trial = pd.DataFrame({"time [s]": time, "angle [rad]": angle, "torque [N m]": torque})
    ...     trial.to_csv(f"case/trials/t{k}.csv", index=False)
    >>> text = 'format = 1\nsystem = "geocontact.systems.elastic_joint:JOINT"\n'
    >>> text += 'calibration = ["t1", "t2", "t3"]\nevaluation = ["t4", "t5"]\n[noise]\ntorque = 0.2\n'
    >>> text += '[parameters.k]\nstart = 50.0\nlower = 10.0\nupper = 200.0\nunit = "N m/rad"\n'
    >>> _ = Path("case/case.toml").write_text(text)
    >>> system = gc.system_of(gc.read_gap_case("case"))
    >>> system.name, [one.name for one in system.parameters]
    ('elastic_joint', ['k'])
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
