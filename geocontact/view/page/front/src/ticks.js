// Round numbers along an axis.

/** Multiples of 1, 2 or 5 powers of ten inside [lower, upper], about `count` of them. */
export function ticks(lower, upper, count) {
  if (!(upper > lower)) return [lower];
  const rough = (upper - lower) / Math.max(count, 1);
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((m) => m * power).find((s) => s >= rough * 0.999);
  const found = [];
  for (let k = Math.ceil(lower / step - 1e-9); k * step <= upper + 1e-9 * step; k++) found.push(k * step);
  return found.map((value) => Number(value.toPrecision(12)));
}

/** A number of at most `digits` significant digits. */
export const brief = (value, digits = 4) =>
  value === null || value === undefined || !Number.isFinite(value) ? "–" : String(Number(value.toPrecision(digits))).replace("-", "−");

/** [least, greatest] of what is finite, with zero where it is near, never of zero width. */
export function extent(values) {
  let [lower, upper] = [Infinity, -Infinity];
  for (const value of values) {
    if (value === null || value === undefined) continue;
    lower = Math.min(lower, value);
    upper = Math.max(upper, value);
  }
  if (!(upper >= lower)) return [0, 1];
  if (lower > 0 && lower < 0.4 * upper) lower = 0;
  if (upper < 0 && upper > 0.4 * lower) upper = 0;
  const room = 0.06 * (upper - lower) || 0.5 * Math.abs(upper) || 0.5;
  return [lower === 0 ? 0 : lower - room, upper === 0 ? 0 : upper + room];
}
