"""Every analysis by the name of its command, and own ones by where they are: "package.module:OBJECT"."""

from __future__ import annotations

from difflib import get_close_matches
from importlib import import_module
from typing import Any

from geocontact.analyses.job import Job
from geocontact.data.errors import InputError

PLACES = {
    "area": "area.result:area",
    "cop": "cop.result:centre_of_pressure",
    "elbow compare": "misalignment.compare.result:compare",
    "elbow design": "misalignment.design.result:design",
    "elbow fit": "misalignment.identify.result:identify",
    "elbow population": "misalignment.population.result:population",
    "elbow simulate": "misalignment.simulate.result:simulate",
    "fit": "shape.result:fit_shape",
    "gap benchmark": "gap.benchmark.result:benchmark",
    "gap diagnose": "gap.diagnose.result:diagnose",
    "gap discriminability": "gap.discriminability.result:discriminability",
    "gap gather": "gap.gather.result:gather",
    "gap inject": "gap.inject.result:inject",
    "id": "motion.inverse_dynamics.result:inverse_dynamics",
    "ik": "motion.inverse_kinematics.result:inverse_kinematics",
    "joint": "motion.functional_joint.result:functional_joint",
    "knee settle": "knee.settle.result:settle",
    "loadcells": "loadcells.result:load_cells",
    "markers": "motion.virtual_markers.result:virtual_markers",
    "mat": "mat.result:mat",
    "modulus": "modulus.result:modulus",
    "prosthesis calibrate": "prosthesis.calibrate.result:calibrate",
    "prosthesis compare": "prosthesis.compare.result:compare",
    "prosthesis design": "prosthesis.design.result:design",
    "prosthesis scale": "prosthesis.scale.result:scale",
    "prosthesis simulate": "prosthesis.simulate.result:simulate",
    "scale": "motion.scale.result:scale",
    "shoulder compare": "shoulder.compare.result:compare",
    "shoulder optimise": "shoulder.optimise.result:optimise",
    "shoulder simulate": "shoulder.simulate.result:simulate",
    "shoulder study": "shoulder.study.result:study",
    "sit-to-stand calibrate": "sit_to_stand.calibrate.result:calibrate",
    "sit-to-stand compare": "sit_to_stand.compare.result:compare",
    "sit-to-stand design": "sit_to_stand.design.result:design",
    "sit-to-stand device": "sit_to_stand.device.result:device",
    "sit-to-stand predict": "sit_to_stand.predict.result:predict",
}


def job_named(name: str) -> Job[Any, Any]:
    """The analysis of a command; InputError where there is none of that name."""
    if ":" in name:
        return _own(name)
    if name not in PLACES:
        near = get_close_matches(name, PLACES, n=1)
        raise InputError("", "", f"there is no analysis {name!r}", f"did you mean {near[0]!r}?" if near else _names())
    place, _, attribute = PLACES[name].partition(":")
    found: Job[Any, Any] = getattr(import_module(f"geocontact.analyses.{place}"), attribute)
    return found


def _own(name: str) -> Job[Any, Any]:
    """An analysis of somebody else's module, which is imported."""
    place, _, attribute = name.partition(":")
    try:
        found = getattr(import_module(place), attribute)
    except (ImportError, AttributeError, ValueError) as error:
        what = f"no analysis at {name!r} ({type(error).__name__}: {error})"
        raise InputError("", "", what, "put its folder into PYTHONPATH, on the workers too") from error
    if not isinstance(found, Job):
        raise InputError("", "", f"{name!r} is a {type(found).__name__}", "name a geocontact.analyses.job.Job")
    return found


def _names() -> str:
    return f"there are {', '.join(PLACES)}"
