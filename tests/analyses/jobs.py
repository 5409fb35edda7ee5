"""Every analysis of the package."""

from __future__ import annotations

import geocontact as gc
from geocontact.analyses.gap.benchmark.result import benchmark
from geocontact.analyses.job import Job

JOBS: tuple[Job, ...] = (
    gc.area,
    gc.cohort,
    gc.pressure,
    gc.centre_of_pressure,
    gc.fit_shape,
    gc.knee.settle,
    gc.load_cells,
    gc.modulus,
    gc.mat,
    gc.scale,
    gc.inverse_kinematics,
    gc.inverse_dynamics,
    gc.virtual_markers,
    gc.functional_joint,
    gc.misalignment.simulate,
    gc.misalignment.identify,
    gc.misalignment.compare,
    gc.misalignment.design,
    gc.misalignment.population,
    gc.prosthesis.calibrate,
    gc.prosthesis.scale,
    gc.prosthesis.compare,
    gc.prosthesis.design,
    gc.prosthesis.simulate,
    gc.shoulder.simulate,
    gc.shoulder.compare,
    gc.shoulder.study,
    gc.shoulder.optimise,
    gc.sit_to_stand.calibrate,
    gc.sit_to_stand.compare,
    gc.sit_to_stand.design,
    gc.sit_to_stand.device,
    gc.sit_to_stand.predict,
    gc.diagnose,
    gc.discriminability,
    gc.inject,
    gc.gather,
    benchmark,
)
