"""Write the pages of docs/ that are made from other files: `python -m website.pages`; a test keeps them up to date."""

from __future__ import annotations

from collections.abc import Callable

from website import constants, descriptions, limits, trial_checks, validation
from website.stage import ROOT

MADE: dict[str, Callable[[], str]] = {
    validation.PAGE: validation.report,
    limits.PAGE: limits.limits,
    constants.PAGE: constants.constants,
    descriptions.PAGE: descriptions.descriptions,
    trial_checks.PAGE: trial_checks.trial_checks,
}
"""Place of each and what makes its text."""

if __name__ == "__main__":
    for place, text in MADE.items():
        (ROOT / place).write_text(text(), encoding="utf-8")
