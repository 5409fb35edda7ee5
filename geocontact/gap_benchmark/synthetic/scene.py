"""The world of one case before anything is planted: body, numbers, movements, noise, trial-to-trial variation."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.data.parameter import Parameter
from geocontact.gap_benchmark.synthetic.body import SyntheticSystem
from geocontact.gap_benchmark.synthetic.course import InputCourse, Path
from geocontact.gap_benchmark.synthetic.equipment.laboratory import HOME, Laboratory
from geocontact.gap_benchmark.synthetic.hooks import BASE, Hooks, Values
from geocontact.gap_benchmark.synthetic.noise import Coloured, NoiseFilter, SensorNoise

Rng = np.random.Generator


@dataclass(frozen=True)
class SyntheticScene:
    """Everything that is true of a case but the effect.

    Parameters
    ----------
    theta
        Nominal base parameters in the order of `parameters`.
    spread
        Covariance of their trial-to-trial variation.
    noise, input_noise
        Of each output; standard deviation of each measured input.
    step, filters
        Of the recording [s]; what the noise of each input came through.
    path, later
        Draws a movement for the calibration trial of a number; for the evaluation trial of one.
    body
        The system itself.
    begin
        Box from which a refit begins three times more, where it has a wrong basin.
    laboratory
        Who records it.
    """

    system: str
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    units: tuple[str, ...]
    parameters: tuple[Parameter, ...]
    constants: Mapping[str, float]
    tables: Mapping[str, pd.DataFrame]
    theta: Float[np.ndarray, " p"]
    spread: Float[np.ndarray, "p p"]
    noise: tuple[SensorNoise, ...]
    input_noise: Float[np.ndarray, " i"]
    step: float
    filters: tuple[NoiseFilter, ...]
    path: Callable[[Rng, int], Path]
    later: Callable[[Rng, int], Path]
    body: SyntheticSystem
    begin: tuple[tuple[float, ...], tuple[float, ...]] | None = None
    laboratory: Laboratory = HOME

    def numbers(self, theta: Float[np.ndarray, " p"]) -> dict[str, float]:
        """Constants and parameters by name."""
        return {**self.constants, **{p.name: float(v) for p, v in zip(self.parameters, theta, strict=True)}}

    def respond(
        self, course: InputCourse, theta: Float[np.ndarray, " p"], hooks: Hooks = BASE
    ) -> Float[np.ndarray, "c t"]:
        """The truth along a course."""
        return self.body.respond(course, self.numbers(theta), hooks)

    def base_model(self, course: InputCourse) -> Callable[[Values], Values]:
        """The base model along a course as a function of its parameters."""
        return self.body.base_model(course, self.constants)

    def motion(self, course: InputCourse) -> tuple[Values, Values]:
        """Deflections in the base model and their rates, one row per interface."""
        return self.body.motion(course, self.numbers(self.theta))


def colour(rng: Rng, sd: float) -> Coloured:
    """Noise that is a little coloured, sometimes white, sometimes with a slow part."""
    quick = 0.0 if rng.random() < 0.25 else rng.uniform(0.2, 0.55)
    return Coloured(sd, quick, rng.uniform(0.2, 1.0), rng.uniform(0.1, 0.35) if rng.random() < 0.25 else 0.0)
