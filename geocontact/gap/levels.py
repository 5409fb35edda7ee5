"""Numbers that more than one room of the diagnosis decides by: how sure is sure, how much is little, how many lead."""

from __future__ import annotations

import numpy as np

SURE = 6.0  # nats below which a gain may be luck: odds of 400 to 1
DEVIATIONS = float(np.sqrt(2.0 * SURE))  # standard deviations of a normal number that are as many nats
SLIGHT = 0.02  # share of an error, of samples or of a gain that makes no difference
WORTH_NAMING = 0.1  # share that is worth a name; of a squared error, a twentieth of the error: nobody would see less
LEFT_OVER = 0.2  # share of what there is to explain that may stay unexplained
LEADING = 3  # models that lead: a second effect is tried on them, everyone is compared under their noise
FEW = 4  # trials, parameters or starts that are few enough to try all
FEWEST = 20  # samples that tell anything
TWOFOLD = float(np.log(2.0))  # standard deviation of the logarithm of what is known to a factor of two
FLAT = float(np.sqrt(12.0))  # range of what is as likely anywhere in it, over its standard deviation
APART = 5.0  # nats from which two answers count as separable
PHASES = 20  # parts of a trial that are compared between trials
DRAWS = 2000  # random draws that a probability is counted in
TURNS = 4  # times that two things that depend on each other are found in turn
INPUT_NOISE = 2e-3  # usual noise of an input, of its half-range
