// SPDX-License-Identifier: Apache-2.0
// What one line was, sample by sample, in the order of time; NaN is where a gap begins. Instants are ms since 1970, with
// fractions. Promises a bound, and that nothing is told of a time that was not heard. Never invents a value between two.

const MOST = 80000; // samples of a line: 13 minutes of 100 Hz
const TAKEN_AWAY = MOST / 4;

export class Samples {
  constructor() {
    this.at = [];
    this.values = [];
  }

  get length() { return this.at.length; }
  get first() { return this.at.length > 0 ? this.at[0] : null; }
  get last() { return this.at.length > 0 ? this.at[this.at.length - 1] : null; }

  /** null: here a gap begins. What is older than the last one is not taken. */
  push(at, value) {
    if (this.at.length > 0 && at < this.last) return;
    const taken = typeof value === "number" ? value : NaN;
    if (Number.isNaN(taken) && this.at.length > 0 && Number.isNaN(this.values[this.values.length - 1])) return; // it goes on
    this.at.push(at);
    this.values.push(taken);
    if (this.at.length <= MOST) return;
    this.at = this.at.slice(TAKEN_AWAY);
    this.values = this.values.slice(TAKEN_AWAY);
  }

  /** Slices [at, low, high] of the time before: those that are older than what is here. */
  put_before(slices) {
    const until = this.first ?? Infinity;
    const past = new Samples();
    for (const [at, low, high] of slices) {
      if (at >= until) break;
      past.push(at, low);
      if (high !== low) past.push(at, high);
    }
    this.at = [...past.at, ...this.at];
    this.values = [...past.values, ...this.values];
  }

  /** Where the newest sample is that is not younger than `at`; -1: none. */
  index(at) {
    let low = 0, high = this.at.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.at[middle] <= at) low = middle + 1;
      else high = middle;
    }
    return low - 1;
  }

  /** What was in force at that instant; null: nothing was known. */
  held(at) {
    const where = this.index(at);
    if (where < 0) return null;
    const value = this.values[where];
    return Number.isNaN(value) ? null : value;
  }

  /** [lowest, highest] within, what was in force at `from` among them; null: nothing was known. */
  extent(from, to) {
    let low = Infinity, high = -Infinity;
    for (let i = Math.max(0, this.index(from)); i < this.at.length && this.at[i] <= to; ++i) {
      if (this.values[i] < low) low = this.values[i];
      if (this.values[i] > high) high = this.values[i];
    }
    return low > high ? null : [low, high];
  }
}

/** Of slices alone, as /history and a capture have them. */
export function of_slices(slices) {
  const found = new Samples();
  found.put_before(slices);
  return found;
}
