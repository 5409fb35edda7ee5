"""The one table of checks, and all that they find in a trial."""

from __future__ import annotations

import warnings
from collections.abc import Sequence

from geocontact.trial_checks.body_checks import BODY_CHECKS
from geocontact.trial_checks.channel_checks import CHANNEL_CHECKS, LENGTH_CHECKS
from geocontact.trial_checks.foot_checks import FOOT_CHECKS
from geocontact.trial_checks.marker_checks import MARKER_CHECKS
from geocontact.trial_checks.plate_checks import PLATE_CHECKS
from geocontact.trial_checks.recorded import Check, Contradiction, TrialInputs
from geocontact.trial_checks.still_checks import STILL_CHECKS
from geocontact.trial_checks.twice import COPY_CHECKS

CHECKS: tuple[Check, ...] = (
    *COPY_CHECKS,
    *LENGTH_CHECKS,
    *MARKER_CHECKS,
    *PLATE_CHECKS,
    *FOOT_CHECKS,
    *BODY_CHECKS,
    *STILL_CHECKS,
    *CHANNEL_CHECKS,
)
"""Every check of a recorded trial."""
WORK_CHECKS = tuple(check for check in CHECKS if check.name != "level")
"""Those of who works with the hands, which push along the floor as well."""
MOVED_CHECKS = tuple(check for check in CHECKS if check.name in ("jump", "standing trial", "right and left"))
"""Those of a further recording of the person, beside the standing trial."""


def contradictions(trial: TrialInputs, checks: Sequence[Check] = CHECKS) -> list[tuple[Check, Contradiction]]:
    """Whatever any check finds, those that refuse a trial first."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # medians of frames in which nothing was seen
        found = [(check, one) for check in checks for one in check.find(trial)]
    return sorted(found, key=lambda pair: not pair[1].refuse)
