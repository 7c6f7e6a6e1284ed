// SPDX-License-Identifier: Apache-2.0
// Numbers, times and names as people read them. Pure: what comes in decides what comes out.

export const DASH = "–";
const NARROW = "\u202f";

// The end of a value's name is its unit: how it is written, and how many decimals are shown.
const UNITS = { rev: ["rev", 4], rpm: ["rpm", 1], rpm_s: ["rpm/s", 1], percent: ["%", 1], a: ["A", 2], v: ["V", 1], c: ["°C", 1], ms: ["ms", 0], s: ["s", 1] };
// What is a code is shown as bits.
const HEX = { statusword: 4, controlword: 4, error_code: 4, vendor_error: 8, inputs: 4, outputs: 4 };
const CALLED = { dc_voltage_v: "DC voltage", inputs: "Digital inputs", outputs: "Digital outputs", mode_asked: "Mode asked for" };

/** [label, unit, decimals] of any value, of one that came later too: what it is called says all. */
export function told(name) {
  const end = /^(.+?)_(rpm_s|rev|rpm|percent|a|v|c|ms|s)$/.exec(name);
  const words = (end ? end[1] : name).replaceAll("_", " ");
  return [CALLED[name] ?? words.charAt(0).toUpperCase() + words.slice(1), ...(end ? UNITS[end[2]] : ["", 0])];
}

/** With its decimals, a true minus, thin gaps from 10 000 on. */
export function number(value, decimals = 0) {
  if (typeof value !== "number" || !Number.isFinite(value)) return DASH;
  const [whole, rest] = Math.abs(value).toFixed(decimals).split(".");
  const sign = value < 0 && Number(value.toFixed(decimals)) !== 0 ? "−" : "";
  const gaps = whole.length > 4 ? whole.replace(/\B(?=(\d{3})+$)/g, NARROW) : whole;
  return sign + gaps + (rest === undefined ? "" : "." + rest);
}

export function hex(value, digits) {
  if (typeof value !== "number") return typeof value === "string" ? value : DASH;
  return "0x" + (value >>> 0).toString(16).toUpperCase().padStart(digits, "0");
}

/** A value by its name, without its unit. */
export function value_text(name, value) {
  if (value === null || value === undefined) return DASH;
  return HEX[name] ? hex(value, HEX[name]) : number(value, told(name)[2]);
}

/** "0.3 s", "12 s", "4 min", "3 h", "2 d": how long ago, or for how long. */
export function duration(ms) {
  if (typeof ms !== "number" || !Number.isFinite(ms) || ms < 0) return DASH;
  if (ms < 1000) return `${Math.round(ms)} ms`;
  const s = ms / 1000;
  if (s < 10) return `${s.toFixed(1)} s`;
  if (s < 120) return `${Math.floor(s)} s`;
  if (s < 7200) return `${Math.floor(s / 60)} min`;
  return s < 172800 ? `${Math.floor(s / 3600)} h` : `${Math.floor(s / 86400)} d`;
}

/** "3 d 04:05:06" */
export function uptime(seconds) {
  if (typeof seconds !== "number") return DASH;
  const two = (n) => String(Math.floor(n)).padStart(2, "0");
  const days = Math.floor(seconds / 86400);
  const clock = `${two((seconds % 86400) / 3600)}:${two((seconds % 3600) / 60)}:${two(seconds % 60)}`;
  return days > 0 ? `${days} d ${clock}` : clock;
}

/** The browser's local time of day; with the date where it is not today. */
export function clock(utc, with_ms = false) {
  const date = utc instanceof Date ? utc : new Date(utc ?? NaN);
  if (Number.isNaN(date.getTime())) return DASH;
  const two = (n) => String(n).padStart(2, "0");
  const time = `${two(date.getHours())}:${two(date.getMinutes())}:${two(date.getSeconds())}`;
  const ms = with_ms ? "." + String(date.getMilliseconds()).padStart(3, "0") : "";
  if (date.toDateString() === new Date().toDateString()) return time + ms;
  return `${date.getFullYear()}-${two(date.getMonth() + 1)}-${two(date.getDate())} ${time}${ms}`;
}

export function count(n, one, many = one + "s") {
  return `${number(n)} ${n === 1 ? one : many}`;
}

/** "stop_latched" as it is said: "stop latched". */
export function spoken(name) {
  return String(name ?? "").replaceAll("_", " ");
}
