// SPDX-License-Identifier: Apache-2.0
// Times of the API, UTC with microseconds, as ms since 1970 with fractions, and back. Pure.

export function utc_ms(text) {
  const parts = /^(\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d)(\.\d+)?Z$/.exec(text ?? "");
  return parts ? Date.parse(`${parts[1]}Z`) + Number(parts[2] ?? 0) * 1000 : NaN;
}

export function utc_text(ms) {
  const whole = Math.floor(ms / 1000) * 1000;
  const micros = Math.min(999999, Math.round((ms - whole) * 1000));
  return `${new Date(whole).toISOString().slice(0, 19)}.${String(micros).padStart(6, "0")}Z`;
}
