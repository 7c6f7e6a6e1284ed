// SPDX-License-Identifier: Apache-2.0
// What stretch of time is seen: {from, to} in ms. Moved, narrowed, widened; never shorter than a few exchanges, never longer than
// a history can be, never beyond it. Pure.

export const SHORTEST_MS = 5, LONGEST_MS = 2 * 3600 * 1000;

/** Within the bounds, and within [oldest, newest] where those are known; a view that is longer than them ends with the newest. */
export function bounded(view, oldest = null, newest = null) {
  const span = Math.min(LONGEST_MS, Math.max(SHORTEST_MS, view.to - view.from));
  let to = (view.from + view.to) / 2 + span / 2;
  if (oldest !== null && to - span < oldest) to = oldest + span;
  if (newest !== null && to > newest) to = newest;
  return { from: to - span, to };
}

/** `factor` below 1 narrows; `around` stays where it is. */
export function zoomed(view, around, factor) {
  const wanted = (view.to - view.from) * factor;
  const span = Math.min(LONGEST_MS, Math.max(SHORTEST_MS, wanted));
  const share = (around - view.from) / (view.to - view.from);
  return { from: around - share * span, to: around + (1 - share) * span };
}

/** By that share of what is seen; 1 is a whole one to later. */
export function shifted(view, share) {
  const by = (view.to - view.from) * share;
  return { from: view.from + by, to: view.to + by };
}
