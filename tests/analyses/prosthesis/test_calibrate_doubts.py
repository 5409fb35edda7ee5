"""What speaks against a calibrated sole, and what does not."""

from __future__ import annotations

import pytest

from geocontact.analyses.prosthesis.calibrate.result import doubts


@pytest.mark.parametrize(
    ("height", "pitch", "residual", "vertical", "words"),
    [
        (0.5, -1.2, 0.3, 0.01, []),
        (-2.5, 0.0, 0.3, 0.01, ["did the foot stand flat"]),
        (0.0, 2.1, 0.3, 0.01, ["did the foot stand flat"]),
        (0.0, 0.0, 0.4, 0.053, ["missed by 5.3% of body weight, the residual is 0.4 times its noise"]),
        (0.0, 0.0, 2.5, 0.02, ["missed by 2.0% of body weight, the residual is 2.5 times its noise"]),
        (0.0, -3.0, 0.4, 0.2, ["did the foot stand flat", "missed by 20.0% of body weight"]),
    ],
)
def test_a_foot_out_of_flat_and_a_stance_that_is_missed_are_said(
    height: float, pitch: float, residual: float, vertical: float, words: list[str]
) -> None:
    found = doubts(height, pitch, residual, vertical)
    assert len(found) == len(words)
    assert all(each in line for each, line in zip(words, found, strict=True))
