// SPDX-License-Identifier: Apache-2.0
// Two instants of a plot, and what lies between: for each line what was in force at either, and the difference. Pure.
// Promises a sample that was, never one between two.

/** {first, second, difference} of Samples at two instants; null where nothing was known. A code has no difference. */
export function between(samples, instants, is_code) {
  const [first, second] = instants.map((at) => samples.held(at));
  return { first, second, difference: first === null || second === null || is_code ? null : second - first };
}

/** Where cursors stand at first: a quarter and three quarters of what is seen. */
export const placed = ({ from, to }) => [from + (to - from) / 4, from + (3 * (to - from)) / 4];

// Of what is seen.
const STEPS = { ArrowLeft: -0.002, ArrowRight: 0.002, PageDown: -0.05, PageUp: 0.05 };

/** Where a key moves a cursor; null: it is no such key. `far`: ten times as far. */
export function moved(at, key, far, { from, to }) {
  if (key === "Home") return from;
  if (key === "End") return to;
  const step = STEPS[key];
  return step === undefined ? null : Math.min(to, Math.max(from, at + step * (far ? 10 : 1) * (to - from)));
}
