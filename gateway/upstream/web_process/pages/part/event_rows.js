// SPDX-License-Identifier: Apache-2.0
// Events as rows: when, of which axis, what, and what helps.

import { el, list, say } from "./dom.js";
import { glyph } from "./glyphs.js";
import { clock, hex, spoken } from "../format.js";
import { difference_text } from "../state/scale.js";
import { utc_ms } from "../state/utc.js";

const SHAPES = { fault: "error stop", warning: "warning", link: "offline", lease: "owner", homed: "homing", boot: "up", command: "next", position_wrapped: "note" };
const ONLINE = 2, SUSPECT = 3; // codes of link events are link states
const TONES = { fault: "act", warning: "look", link: "look" };

/** `with_axis`: a column says whose it is; `zero`: an instant in ms, from which times are counted. */
export function event_rows(with_axis, zero = null) {
  const body = el("tbody", { role: "rowgroup" });
  const heads = ["Time", ...(with_axis ? ["Axis"] : []), "Kind", "What"].map((text) => el("th", { scope: "col", role: "columnheader" }, text));
  const node = el("table", { class: "grid events", role: "table" }, el("caption", { class: "unseen" }, zero === null ? "Events, newest first" : "Events, oldest first"), el("thead", { role: "rowgroup" }, el("tr", { role: "row" }, heads)), body);
  return {
    node,
    show(events) {
      list(body, events, (event) => event.id ?? event.number, (event) => ({ node: row(event, with_axis, zero), show() {} }));
    },
  };
}

const apart = (ms) => (ms > 0 ? "+" : "") + difference_text(ms);

function row(event, with_axis, zero) {
  const of = event.axis === null || event.axis === 0 || event.axis === undefined ? "gateway" : el("a", { href: `#axis/${event.axis}` }, `${event.axis} ${event.axis_name ?? ""}`);
  const more = [["cause", event.cause], ["remedy", event.remedy]].filter(([, text]) => text).map(([name, text]) => {
    const words = el("span");
    say(words, text);
    return el("p", { class: "remedy" }, el("span", { class: "term" }, name), words);
  });
  const back = event.kind === "link" && event.code < SUSPECT;
  const tone = back ? "dim" : TONES[event.kind] ?? "dim";
  const code = event.code && event.kind === "fault" ? el("span", { class: "codes" }, ` ${hex(event.code, 4)}`) : [];
  return el("tr", { role: "row", "data-tone": tone },
    el("td", { role: "cell", class: "time" }, el("time", { datetime: event.at }, zero === null ? clock(event.at, true) : apart(utc_ms(event.at) - zero))),
    with_axis ? el("td", { role: "cell", class: "of-axis" }, of) : [],
    el("td", { role: "cell", class: "of-kind" }, el("span", { class: "state", "data-tone": tone }, glyph(back ? (event.code === ONLINE ? "online" : "setup") : SHAPES[event.kind] ?? "note"), el("span", {}, spoken(event.kind)))),
    el("td", { role: "cell", class: "what" }, el("p", {}, event.text, code), more));
}
