// SPDX-License-Identifier: Apache-2.0
// The last minute of an axis as this page has seen it: a ring of instants, one column for each series. Promises that a value
// that was not valid is a gap (NaN), and so is a time in which nothing was heard. It is no record: that is the gateway's.

const ROWS = 1200;
export const SPAN_MS = 60000;
export const SERIES = ["velocity_rpm", "position_rev"];
const SILENCE_MS = 1500;

export class History {
  constructor() {
    this.at = new Float64Array(ROWS);
    this.columns = Object.fromEntries(SERIES.map((name) => [name, new Float64Array(ROWS)]));
    this.begin = 0;
    this.length = 0;
  }

  add(now, values) {
    const last = this.length > 0 ? this.at[(this.begin + this.length - 1) % ROWS] : now;
    if (now - last > SILENCE_MS) this.push(last + 1, {});
    this.push(now, values);
  }

  push(now, values) {
    const row = (this.begin + this.length) % ROWS;
    this.at[row] = now;
    for (const name of SERIES) this.columns[name][row] = typeof values[name] === "number" ? values[name] : NaN;
    if (this.length < ROWS) ++this.length;
    else this.begin = (this.begin + 1) % ROWS;
  }

  /** Calls `visit(at, value)` for each row from `from` on, oldest first. */
  each(series, from, visit) {
    const column = this.columns[series];
    for (let i = 0; i < this.length; ++i) {
      const row = (this.begin + i) % ROWS;
      if (this.at[row] >= from) visit(this.at[row], column[row]);
    }
  }
}
