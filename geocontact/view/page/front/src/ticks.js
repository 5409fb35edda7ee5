// Round numbers along an axis.

/** Multiples of 1, 2 or 5 powers of ten inside [lower, upper], about `count` of them. */
export function ticks(lower, upper, count) {
  if (lower > upper) [lower, upper] = [upper, lower];
  if (!(upper > lower)) return [lower];
  const rough = (upper - lower) / Math.max(count, 1);
  const power = 10 ** Math.floor(Math.log10(rough));
  const steps = [10, 5, 2, 1, 0.5].map((m) => m * power);
  const multiples = (step) => {
    const found = [];
    for (let k = Math.ceil(lower / step - 1e-9); k * step <= upper + 1e-9 * step; k++) found.push(k * step);
    return found;
  };
  const first = steps.findLastIndex((step) => step >= rough * 0.999);
  let found = multiples(steps[first]);
  if (found.length < Math.min(3, count)) found = multiples(steps[first + 1]); // an axis needs more than one
  return found.map((value) => Number(value.toPrecision(12)));
}

/** A number of at most `digits` significant digits. */
export const brief = (value, digits = 4) =>
  value === null || value === undefined || !Number.isFinite(value) ? "–" : String(Number(value.toPrecision(digits))).replaceAll("-", "−");

/** Ends of a time axis that holds `values`: it runs the way time does, also down, and holds times that come back. */
export function course(values, time = values) {
  const ends = [Math.min(...values), Math.max(...values)];
  return time[0] > time.at(-1) ? ends.reverse() : ends;
}

const LEAST = { mm: 0.1, "mm²": 1, "mm^2": 1, N: 0.1, deg: 0.1, "°": 0.1 }; // less is noise to a reader's eye

/** [least, greatest] of what is finite, with zero where it is near; 1 % of the values wide at least, as is `LEAST`. */
export function extent(values, unit = "") {
  let [lower, upper] = [Infinity, -Infinity];
  for (const value of values) {
    if (value === null || value === undefined) continue;
    lower = Math.min(lower, value);
    upper = Math.max(upper, value);
  }
  if (!(upper >= lower)) return [0, 1];
  if (lower > 0 && lower < 0.4 * upper) lower = 0;
  if (upper < 0 && upper > 0.4 * lower) upper = 0;
  const largest = Math.max(Math.abs(lower), Math.abs(upper));
  const least = Math.max(0.01 * largest, LEAST[unit] ?? (largest ? 1e-9 : 1));
  if (upper - lower < least) {
    const middle = 0.5 * (lower + upper);
    const start = lower >= 0 ? Math.max(0, middle - least / 2) : upper <= 0 ? Math.min(-least, middle - least / 2) : middle - least / 2;
    [lower, upper] = [start, start + least];
  }
  const room = 0.06 * (upper - lower);
  return [lower === 0 ? 0 : lower - room, upper === 0 ? 0 : upper + room];
}

/** [least, greatest] of what is above zero, whole powers of ten at both ends; values that are not have no place. */
export function decades(values) {
  const above = values.filter((value) => value > 0);
  if (!above.length) return [1, 10];
  const [lower, upper] = [Math.floor(Math.log10(Math.min(...above))), Math.ceil(Math.log10(Math.max(...above)))];
  return [10 ** lower, 10 ** (upper > lower ? upper : lower + 1)];
}

/** Powers of ten from `lower` to `upper`, six at most. */
export function powers(lower, upper) {
  const [first, last] = [lower, upper].map((value) => Math.round(Math.log10(value)));
  const step = Math.ceil((last - first) / 5);
  const found = [];
  for (let k = first; k <= last; k += step) found.push(Number((10 ** k).toPrecision(12)));
  return found;
}
