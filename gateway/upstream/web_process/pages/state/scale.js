// SPDX-License-Identifier: Apache-2.0
// Scales: round steps, ranges that stay quiet, times of day as marks. Pure.

const ROOM = 0.08; // above and below what is drawn
const LEAST_USED = 0.4; // of a range: with less it is taken anew
const SECONDS = [1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 900, 1800, 3600, 7200];

/** Round steps of which up to `most` fit: {found, decimals}. */
export function steps(low, high, most = 7) {
  const raw = (high - low) / most;
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 2.5, 5, 10].map((n) => n * power).find((n) => n >= raw);
  const found = [];
  for (let at = Math.ceil(low / step - 1e-9) * step; at <= high + step * 1e-9; at += step) found.push(Math.abs(at) < step * 1e-9 ? 0 : at);
  return { found, decimals: Math.max(0, Math.min(6, -Math.floor(Math.log10(step) + 1e-9) + (step / power === 2.5 ? 1 : 0))) };
}

/** A range around [low, high], `least` at least; the one before stays while it fits. */
export function range(before, extent, least) {
  if (!extent) return before ?? [-least / 2, least / 2];
  let [low, high] = extent;
  if (high - low < least) [low, high] = [(low + high - least) / 2, (low + high + least) / 2];
  if (before && extent[0] >= before[0] && extent[1] <= before[1] && high - low >= LEAST_USED * (before[1] - before[0])) return before;
  const room = (high - low) * ROOM;
  return [low - room, high + room];
}

/** Of a code that has words: each of them has its place. */
export const range_of_codes = (extent) => [Math.min(0, extent?.[0] ?? 0) - 0.5, (extent?.[1] ?? 1) + 0.5];

const two = (n) => String(n).padStart(2, "0");

/** The local time of day, with the decimals of a second that `step_ms` needs. */
export function time_text(at, step_ms = 1) {
  const decimals = step_ms >= 1000 ? 0 : step_ms >= 100 ? 1 : step_ms >= 10 ? 2 : step_ms >= 1 ? 3 : 6;
  const unit = 10 ** (3 - decimals);
  const rounded = Math.round(at / unit) * unit;
  const date = new Date(rounded);
  const fraction = ((rounded % 60000) + 60000) % 60000 / 1000;
  return `${two(date.getHours())}:${two(date.getMinutes())}:${(fraction % 60).toFixed(decimals).padStart(decimals > 0 ? decimals + 3 : 2, "0")}`;
}

/** Marks of a time line: [{at, text}], round in local time, `most` at the most. */
export function time_marks(from, to, most) {
  const raw = (to - from) / Math.max(1, most);
  const step = raw >= 1000 ? (SECONDS.find((s) => s * 1000 >= raw) ?? 14400 * Math.ceil(raw / 14400000)) * 1000 : fine_step(raw);
  const shift = new Date(from).getTimezoneOffset() * 60000;
  const found = [];
  for (let n = Math.ceil((from - shift) / step); n * step + shift <= to && found.length <= most + 1; ++n) found.push({ at: n * step + shift, text: time_text(n * step + shift, step) });
  return found;
}

function fine_step(raw) {
  const power = 10 ** Math.floor(Math.log10(raw));
  return [1, 2, 5, 10].map((n) => n * power).find((n) => n >= raw * (1 - 1e-9));
}

/** "1.234 s", "12.3 ms": a time between two instants. */
export function difference_text(ms) {
  const size = Math.abs(ms);
  const sign = ms < 0 ? "−" : "";
  if (size === 0) return "0 s";
  if (size < 1) return `${sign}${(size * 1000).toFixed(0)} µs`;
  if (size < 1000) return `${sign}${size.toFixed(size < 100 ? 2 : 1)} ms`;
  return size < 60000 ? `${sign}${(size / 1000).toFixed(3)} s` : `${sign}${Math.floor(size / 60000)}:${((size % 60000) / 1000).toFixed(2).padStart(5, "0")} min`;
}

