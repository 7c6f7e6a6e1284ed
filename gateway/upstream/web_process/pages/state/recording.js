// SPDX-License-Identifier: Apache-2.0
// What a scope knows of its lines: samples as its stream brings them, and what the gateway's history had before. Promises that what
// was not heard is no line: behind each hello all is asked anew, and shown when it is there. Pure: frames and answers go in.

import { Samples, of_slices } from "./samples.js";
import { utc_ms } from "./utc.js";

export class Recording {
  constructor() {
    this.lines = new Map(); // key: Samples, what is shown
    this.coming = null; // the same since the newest hello; null: it is what is shown
    this.newest = null; // instant of the newest frame
    this.oldest = null; // how far the gateway's history reaches back
  }

  /** Another stream begins: keys of its lines. */
  begin(keys) {
    this.coming = new Map(keys.map((key) => [key, new Samples()]));
    for (const key of this.lines.keys()) if (!keys.includes(key)) this.lines.delete(key);
  }

  /** A frame "scope": calls `visit(key, at, value or null)` for each sample. */
  take(frame, visit) {
    const from = utc_ms(frame.from);
    const into = this.coming ?? this.lines;
    for (const [key, samples] of Object.entries(frame.series ?? {})) {
      const line = into.get(key);
      for (const [after, value] of samples) {
        const at = from + after;
        line?.push(at, value);
        visit(key, at, value);
        if (this.newest === null || at > this.newest) this.newest = at;
      }
    }
  }

  /** By the gateway's clock: so far it has told what was. */
  heard(at) {
    if (!Number.isNaN(at) && (this.newest === null || at > this.newest)) this.newest = at;
  }

  /** What was before; null: nobody knows. */
  take_past(answer) {
    if (!this.coming) return;
    if (answer?.oldest) this.oldest = utc_ms(answer.oldest);
    for (const [key, line] of this.coming) line.put_before(slices_of(answer, key));
    this.lines = this.coming;
    this.coming = null;
  }

  /** All of this view is here, sample by sample. */
  covers({ from, to }) {
    return this.newest !== null && to <= this.newest && [...this.lines.values()].every((line) => line.first !== null && line.first <= from);
  }
}

const slices_of = (answer, key) => (answer?.series?.[key] ?? []).map(([at, low, high]) => [utc_ms(at), low, high]);

/** key: Samples of an answer of /history, or of a capture. */
export function lines_of(answer, keys) {
  return new Map(keys.map((key) => [key, of_slices(slices_of(answer, key))]));
}
