"""Tables of what trials can tell."""

from __future__ import annotations

import numpy as np
import pandas as pd

from geocontact.gap.identifiability.discriminability import Discriminability


def separability_table(found: Discriminability) -> pd.DataFrame:
    """A row per pair: who is there, at which amplitude, who is fitted instead, what that leaves, how it was found."""
    own = {one.candidate.label: one for one in found.effects}
    rows = [
        {
            "effect": each.true,
            "parameter": own[each.true].candidate.parameters[0].name,
            "amplitude": own[each.true].amplitude,
            "unit": own[each.true].candidate.parameters[0].unit,
            "visible [nats]": own[each.true].visible,
            "imitator": each.confounder,
            "separation [nats]": each.nats,
            "way": each.way,
        }
        for each in found.separations
    ]
    return pd.DataFrame(rows)


def detectability_table(found: Discriminability) -> pd.DataFrame:
    """A row per effect: the smallest amplitude that is seen, empty where none is, and what is visible of it there."""
    rows = [
        {
            "effect": one.candidate.label,
            "parameter": one.candidate.parameters[0].name,
            "smallest": np.nan if one.smallest is None else one.smallest,
            "unit": one.candidate.parameters[0].unit,
            "power [-]": one.power,
            "visible [nats]": one.at.visible,
            "absorbed [nats]": one.at.absorbed,
        }
        for one in found.detectabilities
    ]
    return pd.DataFrame(rows)
