// SPDX-License-Identifier: Apache-2.0
// Samples of several lines as rows of a picture that has so many columns: of each column the lowest and the highest of each
// line, in the order in which they were. Promises that a spike of one sample is seen, that a gap is one, and that what is
// drawn between `from` and the first sample within is the line from the one before. Pure.

const SLOTS = 3; // of a column: two values, and the beginning of a gap

/** What a line is at the edge `at` between samples i and i + 1; null: nothing is known there. */
function at_edge(samples, i, at, holds) {
  if (i < 0 || i + 1 >= samples.length) return null;
  const before = samples.values[i], after = samples.values[i + 1];
  if (Number.isNaN(before) || (Number.isNaN(after) && !holds)) return null;
  const span = samples.at[i + 1] - samples.at[i];
  return holds || span <= 0 ? before : before + ((after - before) * (at - samples.at[i])) / span;
}

/** What lies within a column, from sample i on: where its lowest and its highest are; where the next column begins. */
function look(samples, i, end) {
  let low = -1, high = -1, gap = false;
  const { at, values } = samples;
  for (const first = i; i < at.length && (at[i] < end || i === first); ++i) {
    const value = values[i];
    if (value !== value) gap = true; // NaN
    else {
      if (low < 0 || value < values[low]) low = i;
      if (high < 0 || value >= values[high]) high = i;
    }
  }
  return { low, high, gap, next: i };
}

/** Rows that are made as they are needed. */
class Rows {
  constructor(lines, from, to, columns) {
    this.lines = lines;
    this.from = from;
    this.to = to;
    this.slice = (to - from) / Math.max(1, columns);
    this.begin = Math.floor(from / this.slice); // columns stand where they stand in time: what is drawn does not change as it moves
    this.kept = new Array((columns + 2) * SLOTS);
    this.edges = [from, to].map((at) => [at, ...new Array(lines).fill(null)]);
  }

  at(column, slot) {
    const place = (column - this.begin) * SLOTS + slot;
    if (!this.kept[place]) {
      const row = new Array(this.lines + 1).fill(null);
      row[0] = Math.min(this.to, Math.max(this.from, (column + slot / SLOTS) * this.slice));
      this.kept[place] = row;
    }
    return this.kept[place];
  }

  all() {
    const [first, last] = this.edges.map((row) => (row.some((value, i) => i > 0 && value !== null) ? [row] : []));
    return [...first, ...this.kept.filter(Boolean), ...last];
  }
}

function draw_line(rows, place, { samples, holds }) {
  const { from, to, slice } = rows;
  let i = samples.index(from);
  if (i >= 0 && samples.at[i] < from) {
    rows.edges[0][place] = at_edge(samples, i, from, holds);
    ++i;
  }
  for (i = Math.max(0, i); i < samples.length && samples.at[i] <= to;) {
    const column = Math.floor(samples.at[i] / slice);
    const { low, high, gap, next } = look(samples, i, (column + 1) * slice);
    if (low >= 0) {
      const first = Math.min(low, high), second = Math.max(low, high);
      const late = first === second && samples.at[first] - column * slice >= slice / 2;
      rows.at(column, late ? 1 : 0)[place] = samples.values[first];
      if (first !== second) rows.at(column, 1)[place] = samples.values[second];
    }
    if (gap) rows.at(column, 2)[place] = NaN;
    i = next;
  }
  if (i < samples.length) rows.edges[1][place] = at_edge(samples, i - 1, to, holds);
}

/** [[at, value of each line], ...]: null is nothing new, NaN is a gap. `lines` are [{samples, holds}]. */
export function rows_of(lines, from, to, columns) {
  const rows = new Rows(lines.length, from, to, columns);
  lines.forEach((line, i) => draw_line(rows, i + 1, line));
  return rows.all();
}
