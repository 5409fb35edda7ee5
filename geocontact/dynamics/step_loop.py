"""The loop over steps in C, around a step that is machine code: inputs by polynomials, the wanted times by cubics.

What `simulate.Stepper` does in Python, statement by statement, its splines in the form of SciPy's: with and without a
compiler results are equal but for signs of zero. In Python the loop costs as much as the steps.
"""

from __future__ import annotations

import ctypes
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.dynamics.compiled import library_of
from geocontact.dynamics.machine_code import MachineCode
from geocontact.dynamics.recorded_inputs import RecordedInputs

Vector = Float[np.ndarray, " _"]
REACHED, TOO_SHORT, NO_MEMORY = range(3)
ROOM = 40000
"""Steps whose ends are kept; a motion of more of them is run again with more room."""

SOURCE = r"""
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef void step_function(const double **, double **, double *);

typedef struct {
  const double *breaks, *coefficients;
  long pieces, count, powers, at;
} course;

static void look_up(course *c, double t, double *value, double *slope) {
  while (c->at + 1 < c->pieces && t >= c->breaks[c->at + 1]) c->at++;
  while (c->at > 0 && t < c->breaks[c->at]) c->at--;
  double s = t - c->breaks[c->at];
  const double *a = c->coefficients + c->at * c->count * c->powers;
  for (long i = 0; i < c->count; i++, a += c->powers) {
    double v = 0.0, d = 0.0;
    for (long j = 0; j < c->powers; j++) {
      d = d * s + v;
      v = v * s + a[j];
    }
    value[i] = v;
    slope[i] = d;
  }
}

static double size_of(long nx, const double *off, const double *x, const double *found, double tolerance) {
  double size = 0.0;
  for (long i = 0; i < nx; i++) {
    if (!isfinite(found[i]) || !isfinite(off[i])) return INFINITY;
    double share = fabs(off[i]) / (tolerance * (1.0 + fmax(fabs(x[i]), fabs(found[i]))));
    if (share > size) size = share;
  }
  return size;
}

static long between(long nx, double t0, double t1, const double *x0, const double *x1, const double *r0,
                    const double *r1, const double *time, long wanted, long done, int last, double *out) {
  double h = t1 - t0;
  for (; done < wanted && (last || time[done] < t1); done++) {
    double s = time[done] - t0, ss = s * s, sss = ss * s;
    for (long i = 0; i < nx; i++) {
      double slope = (x1[i] - x0[i]) / h, bend = (r0[i] + r1[i] - 2.0 * slope) / h;
      out[done * nx + i] = x0[i] + r0[i] * s + ((slope - r0[i]) / h - bend) * ss + bend / h * sss;
    }
  }
  return done;
}

int simulate(step_function *step, const double *breaks, const double *coefficients, const long *sizes,
             const double *numbers, const double *start, const double *p, const double *time, double *out,
             double *error, long *counts, double *reached, double *ends) {
  long pieces = sizes[0], inputs = sizes[1], powers = sizes[2], nx = sizes[3], n = sizes[4], wanted = sizes[5];
  long steps = sizes[6], room = sizes[7], nw = sizes[8], taken = 0, refused = 0, done = 0, known = 0;
  double tolerance = numbers[0], longest = numbers[2], safe = numbers[3], shrink = numbers[4], grow = numbers[5];
  double smallest = numbers[6], order = numbers[7];
  course c = {breaks, coefficients, pieces, inputs, powers, 0};
  double *memory = malloc((nw + 7 * nx + 4 * inputs + 1) * sizeof(double)), *res[3];
  const double *arg[6];
  if (!memory) return 2;
  double *x = memory + nw, *found = x + nx, *off = found + nx, *rate = off + nx, *x0 = rate + nx, *r0 = x0 + nx;
  double *spare = r0 + nx, *given = spare + nx, *slope = given + inputs, *later = slope + inputs;
  double *later_slope = later + inputs, t0 = time[0], now = time[0], end = time[wanted - 1], span = end - now;
  double h = steps ? span / steps : fmin(fmin(numbers[1], longest), span);
  int state = 0;
  memcpy(x, start, nx * sizeof(double));
  memset(error, 0, n * sizeof(double));
  if (inputs) look_up(&c, now, given, slope);
  while (now < end) {
    if (!steps && h > end - now) h = end - now;
    double there = steps && taken + 1 == steps ? end : now + h;
    if (inputs) look_up(&c, there, later, later_slope);
    arg[0] = x; arg[1] = &h; arg[2] = given; arg[3] = later; arg[4] = slope; arg[5] = p;
    res[0] = found; res[1] = off; res[2] = rate;
    step(arg, res, memory);
    if (known) done = between(nx, t0, now, x0, x, r0, rate, time, wanted, done, 0, out), known = 0;
    double size = size_of(nx, off, x, found, tolerance);
    if (steps && isfinite(size)) size = 0.0;
    if (size <= 1.0) {
      memcpy(x0, x, nx * sizeof(double));
      memcpy(r0, rate, nx * sizeof(double));
      memcpy(x, found, nx * sizeof(double));
      t0 = now;
      now = end - there > smallest * span ? there : end;
      known = 1;
      for (long i = 0; i < n; i++) error[i] += fabs(off[i]);
      if (taken < room) ends[taken] = now;
      taken++;
      memcpy(given, later, inputs * sizeof(double));
      memcpy(slope, later_slope, inputs * sizeof(double));
    } else refused++;
    if (!steps) {
      double allowed = size > 0.0 ? safe * pow(size, -1.0 / order) : grow;
      h = fmin(h * fmin(fmax(allowed, shrink), grow), longest);
    }
    if (h < smallest * span || (steps && size > 1.0)) { state = 1; break; }
  }
  if (!state) {
    arg[0] = x; arg[1] = &h; arg[2] = given; arg[3] = given; arg[4] = slope; arg[5] = p;
    res[0] = found; res[1] = off; res[2] = rate;
    step(arg, res, memory);
    between(nx, t0, now, x0, x, r0, rate, time, wanted, done, 1, out);
  }
  counts[0] = taken; counts[1] = refused; *reached = now;
  free(memory);
  return state;
}
"""


@dataclass(frozen=True)
class StepControl:
    """How long steps are: see `simulate.Stepper.simulate`."""

    tolerance: float
    first: float
    longest: float
    steps: int | None
    safe: float
    shrink: float
    grow: float
    smallest: float
    order: int


@dataclass(frozen=True)
class Looped:
    """States at the wanted times, summed errors, ends of steps [s], steps refused, how it ended at what time [s]."""

    states: Float[np.ndarray, "t x"]
    error: Vector
    ends: Float[np.ndarray, " s"]
    refused: int
    end: int
    reached: float


def step_loop(code: MachineCode, states: int, coordinates: int) -> StepLoop | None:
    """The loop of one step; None where there is no compiler, or its library has no such loop."""
    library = library_of(SOURCE)
    if library is None:
        return None
    try:
        return StepLoop(library, code, states, coordinates)
    except AttributeError:
        return None


class StepLoop:
    """The loop of one step in machine code.

    Parameters
    ----------
    library
        Made of `SOURCE`.
    code
        Of the step.
    states, coordinates
        Sizes of the state and of the part of it whose errors are summed.

    AttributeError for a library without the loop.
    """

    def __init__(self, library: ctypes.CDLL, code: MachineCode, states: int, coordinates: int) -> None:
        self._run = library.simulate
        self._run.restype = ctypes.c_int
        self._run.argtypes = [ctypes.c_void_p] * 13
        self.code = code
        self.states, self.coordinates, self.room = states, coordinates, ROOM

    def run(
        self,
        start: Vector,
        time: Float[np.ndarray, " t"],
        inputs: RecordedInputs | None,
        parameters: Vector,
        control: StepControl,
    ) -> Looped:
        """Motion from a state at `time[0]` to `time[-1]`."""
        given = inputs or RecordedInputs(np.zeros(1), np.zeros((0, 0, 1)))
        pieces, count, powers = given.coefficients.shape
        sizes = [pieces, count, powers, self.states, self.coordinates, len(time), control.steps or 0]
        sizes += [self.room, self.code.work]
        c = control
        numbers = [c.tolerance, c.first, c.longest, c.safe, c.shrink, c.grow, c.smallest, float(c.order)]
        out, error = np.empty((len(time), self.states)), np.empty(self.coordinates)
        counts, reached, ends = np.zeros(2, ctypes.c_long), np.zeros(1), np.empty(self.room)
        arrays = [
            np.ascontiguousarray(given.breaks, float),
            np.ascontiguousarray(given.coefficients, float),
            np.array(sizes, ctypes.c_long),
            np.array(numbers, float),
            np.ascontiguousarray(start, float),
            np.ascontiguousarray(parameters, float),
            np.ascontiguousarray(time, float),
            out,
            error,
            counts,
            reached,
            ends,
        ]
        end = self._run(self.code.address, *(each.ctypes.data for each in arrays))
        if end == NO_MEMORY:
            raise MemoryError("no memory for a step")
        taken = int(counts[0])
        if taken > self.room:
            self.room = 2 * taken
            return self.run(start, time, inputs, parameters, control)
        return Looped(out, error, ends[:taken].copy(), int(counts[1]), end, float(reached[0]))
