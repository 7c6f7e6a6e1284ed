// SPDX-License-Identifier: Apache-2.0
// What a scope shows, as words of its address, so that it can be sent to somebody: lines, length, trigger, and where it looks
// back to. Pure. Promises that a word that is only nearly right is as if it were not there.

import { listed, parsed } from "./series.js";
import { KINDS, takes_bit } from "./trigger.js";
import { LONGEST_MS, SHORTEST_MS } from "./view.js";

export const SPAN_MS = 10000;
const MOST_BIT = 31, MOST_HOLD_OFF_MS = 3600000;

const within = (text, low, high) => (/^-?\d+(\.\d+)?(e-?\d+)?$/.test(text ?? "") && Number(text) >= low && Number(text) <= high ? Number(text) : null);

function trigger_of(text) {
  const [series, kind, level, position, how, hold_off] = (text ?? "").split(",");
  if (!parsed(series) || !Object.hasOwn(KINDS, kind)) return null;
  const found = { series, kind, level: takes_bit(kind) ? within(level, 0, MOST_BIT) : within(level, -1e12, 1e12), position: within(position, 0, 100),
                  again: how === "repeat", hold_off_ms: within(hold_off ?? "0", 0, MOST_HOLD_OFF_MS) };
  if (found.level === null || found.position === null || found.hold_off_ms === null || (takes_bit(kind) && !Number.isInteger(found.level))) return null;
  return { ...found, position: found.position / 100 };
}

/** {series, span_ms, trigger, view}: of the words behind "scope". */
export function from_words(words) {
  const of = Object.fromEntries(words.map((word) => [word.slice(0, word.indexOf("=")), word.slice(word.indexOf("=") + 1)]));
  const seconds = within(of.w, SHORTEST_MS / 1000, LONGEST_MS / 1000);
  const from = within(of.from, 0, 1e15), to = within(of.to, 0, 1e15);
  const back = from !== null && to !== null && to - from >= SHORTEST_MS && to - from <= LONGEST_MS;
  return { series: listed(of.s), span_ms: seconds === null ? SPAN_MS : seconds * 1000, trigger: trigger_of(of.t), view: back ? { from, to } : null };
}

export function to_hash({ series, span_ms, trigger, view }) {
  const words = ["#scope"];
  if (series.length > 0) words.push(`s=${series.join(",")}`);
  if (span_ms !== SPAN_MS) words.push(`w=${span_ms / 1000}`);
  if (trigger) words.push(`t=${[trigger.series, trigger.kind, trigger.level, Math.round(trigger.position * 100), trigger.again ? "repeat" : "single", trigger.hold_off_ms].join(",")}`);
  if (view) words.push(`from=${view.from.toFixed(3)}`, `to=${view.to.toFixed(3)}`);
  return words.join("/");
}
