"""The world of one case before anything is planted: a system, numbers, movements, noise, trial-to-trial variation."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.data.parameter import Parameter
from geocontact.gap_benchmark.synthetic.course import InputCourse, Path
from geocontact.gap_benchmark.synthetic.hooks import BASE, Hooks, Outputs, Values
from geocontact.gap_benchmark.synthetic.laboratory import HOME, Laboratory
from geocontact.gap_benchmark.synthetic.noise import Coloured, NoiseFilter, SensorNoise
from geocontact.gap_benchmark.synthetic.plan import EffectNumbers

Numbers = Mapping[str, float]


@dataclass(frozen=True)
class Site:
    """One of several interfaces: its name, the output and the input angle that are its own, by row."""

    name: str
    output: int
    angle: int


@dataclass(frozen=True)
class SyntheticSystem:
    """A base model written a second time from its definition, with its hooks.

    Parameters
    ----------
    respond
        (course, numbers, hooks) → the truth.
    base_model
        (course, constants) → outputs of the base model as a function of its parameters.
    motion
        (course, numbers) → deflections of the base model and their rates, "... t" with one row per interface.
    effects
        Which effects may be injected, and their numbers.
    loads
        Outputs that are forces.
    normal
        Those of them whose largest is the load of the interface.
    places
        Interfaces at each of which an effect may sit alone; () where there is but one, or where all are alike.
    spare
        Inputs that the base model does not use.
    quotients
        Outputs that a laboratory gets by a division, and by which output it divides.
    lengths
        Constants that are a length of how something sits.
    patchy
        Outputs of which a sample may be missing now and then.
    passed_on
        (course, numbers, row of an input, small noise of it "t q") → its part in the outputs "c t q"; None where
        outputs follow the inputs and their rates of the moment.
    fine
        Steps of the truth per sample to begin with.
    quickest
        How much quicker than at home it may move, so that a high rate does not make too many samples.
    recorded
        Outputs as a laboratory has them: NaN where nothing is measured.
    """

    respond: Callable[[InputCourse, Numbers, Hooks], Outputs]
    base_model: Callable[[InputCourse, Numbers], Callable[[Values], Values]]
    motion: Callable[[InputCourse, Numbers], tuple[Values, Values]]
    effects: EffectNumbers
    loads: tuple[int, ...] = (0,)
    normal: tuple[int, ...] = (0,)
    places: tuple[Site, ...] = ()
    spare: tuple[str, ...] = ()
    quotients: Mapping[int, int] = field(default_factory=dict)
    lengths: tuple[str, ...] = ()
    patchy: tuple[int, ...] = ()
    passed_on: Callable[[InputCourse, Numbers, int, Values], Values] | None = None
    fine: int = 10
    quickest: float = 1.0
    recorded: Callable[[Float[np.ndarray, "c t"]], Float[np.ndarray, "c t"]] = np.asarray


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
