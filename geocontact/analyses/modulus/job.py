"""E* of a contact from its area and its force: `geocontact modulus`, `gc.modulus`."""

from __future__ import annotations

from geocontact.analyses.job import Job
from geocontact.analyses.modulus.options import ModulusOptions
from geocontact.analyses.modulus.read import read
from geocontact.analyses.modulus.run import run

modulus = Job("modulus", ModulusOptions, read, run)
