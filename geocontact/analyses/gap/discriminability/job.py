"""What trials can tell: `geocontact gap discriminability`, `gc.discriminability`."""

from __future__ import annotations

from geocontact.analyses.gap.discriminability.options import DiscriminabilityOptions
from geocontact.analyses.gap.discriminability.read import read
from geocontact.analyses.gap.discriminability.run import run
from geocontact.analyses.job import Job

discriminability = Job("gap confuse", DiscriminabilityOptions, read, run)
