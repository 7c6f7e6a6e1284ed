// SPDX-License-Identifier: Apache-2.0
// A trigger: which sample of a line it is that a picture is made of. Pure: samples and instants go in. Promises that it fires on
// the sample that crosses, and that nothing crosses a gap: behind one the line has to be seen on its other side first.

export const KINDS = { rising: "rises to", falling: "falls to", above: "is at or above", below: "is at or below", bit_set: "bit becomes 1:", bit_clear: "bit becomes 0:" };
export const takes_bit = (kind) => kind.startsWith("bit_");

const bit_of = (value, bit) => Math.abs(Math.floor(value / 2 ** bit) % 2) === 1;

/** Whether the sample `now` behind `before` (null: nothing was known) is the one. */
export function crosses({ kind, level }, before, now) {
  if (now === null) return false;
  if (kind === "above") return now >= level;
  if (kind === "below") return now <= level;
  if (before === null) return false;
  if (kind === "rising") return before < level && now >= level;
  if (kind === "falling") return before > level && now <= level;
  return kind === "bit_set" ? !bit_of(before, level) && bit_of(now, level) : bit_of(before, level) && !bit_of(now, level);
}

/**
 * wanted: {series, kind, level (in the line's unit; of a bit its number), position (0..1: the share of the window before it),
 * again (it fires more than once), hold_off_ms (for so long behind one it does not)}.
 * `state` is "waiting", "filling" (fired, and what comes behind it is not all there) or "done" (a single one).
 * `shown`: {at, from, to} of the newest whole window; null: none yet.
 */
export class Trigger {
  constructor(wanted, span_ms) {
    this.wanted = wanted;
    this.span_ms = span_ms;
    this.state = "waiting";
    this.before = null;
    this.fired_at = null;
    this.shown = null;
    this.count = 0;
  }

  get window() {
    const from = this.fired_at - this.wanted.position * this.span_ms;
    return { at: this.fired_at, from, to: from + this.span_ms };
  }

  /** A sample of its line; null: a gap begins. */
  take(at, value) {
    const before = this.before;
    this.before = value;
    if (this.state === "filling") this.look(at);
    if (this.state !== "waiting" || !crosses(this.wanted, before, value)) return;
    if (this.fired_at !== null && at < this.fired_at + this.wanted.hold_off_ms) return;
    this.fired_at = at;
    this.state = "filling";
    ++this.count;
  }

  /** So far is known what was. */
  look(newest) {
    if (this.state !== "filling" || newest < this.window.to) return;
    this.shown = this.window;
    this.state = this.wanted.again ? "waiting" : "done";
  }
}
