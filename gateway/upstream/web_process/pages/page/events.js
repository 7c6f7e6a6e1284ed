// SPDX-License-Identifier: Apache-2.0
// What happened: who, what, why, newest first. Promises that nothing moves under a pointer: what comes while somebody reads
// waits behind a button.

import { get } from "../api.js";
import { el, put } from "../part/dom.js";
import { event_rows } from "../part/event_rows.js";
import { count } from "../format.js";

const KINDS = ["fault", "warning", "link", "lease", "homed", "boot", "command", "position_wrapped"];
const SHOWN_AT_ONCE = 200;

export function open(context, of_axis) {
  const { store } = context;
  let most = SHOWN_AT_ONCE;
  let held = null; // the newest event that is shown while somebody reads; null: all
  let shown = 0; // the newest that was shown
  let signature = "";
  const rows = event_rows(true);
  const kind = el("select", { "aria-label": "Kind", on_change: changed }, el("option", { value: "" }, "Every kind"), KINDS.map((name) => el("option", { value: name }, name.replace("_", " "))));
  const axis = el("select", { "aria-label": "Axis", on_change: changed }, el("option", { value: "" }, "Every axis"), el("option", { value: "0" }, "Gateway and buses"));
  const text = el("input", { type: "search", placeholder: "Text", "aria-label": "Show only events with this text", on_input: changed });
  const waiting = el("button", { type: "button", class: "button accent", on_click: release });
  const more = el("button", { type: "button", class: "button", on_click: () => { most += SHOWN_AT_ONCE; changed(); } }, "Older ones");
  const said = el("p", { class: "plain" });
  const table = el("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": "Table of events" }, rows.node);
  const node = el("div", { class: "page" }, el("div", { class: "page-head" }, el("h1", {}, "Events"), el("p", { class: "waiting" }, waiting), el("div", { class: "tools" }, axis, kind, text)), table, said, more);
  let pointed = false;
  table.addEventListener("pointerenter", () => { pointed = true; });
  table.addEventListener("pointerleave", () => { pointed = false; release(); });
  get("events?limit=1000").then((body) => {
    store.take_events(body.events ?? []);
    changed();
  }, (refusal) => { put(said, refusal.message); said.hidden = false; });

  function changed() {
    signature = "";
    update();
  }
  function release() {
    held = null;
    shown = 0;
    changed();
  }
  const reads = () => pointed || table.contains(document.activeElement) && document.activeElement !== table || window.scrollY > 80;

  function fill_axes() {
    const known = new Set([...axis.options].map((option) => option.value));
    for (const each of store.sorted_axes()) if (!known.has(String(each.axis))) axis.append(el("option", { value: String(each.axis) }, `${each.axis} ${each.name}`));
    if (of_axis && axis.value === "" && [...axis.options].some((option) => option.value === of_axis)) {
      axis.value = of_axis;
      of_axis = null;
      signature = "";
    }
  }

  function update() {
    fill_axes();
    const newest = store.events.at(-1)?.number ?? 0;
    if (!reads()) held = null;
    else held ??= shown || newest;
    const upto = held ?? newest;
    shown = upto;
    const come = store.events.filter((event) => event.number > upto).length;
    waiting.parentNode.hidden = come === 0;
    put(waiting, `${come} newer`);
    const now = `${upto} ${store.events.length} ${most}`;
    if (now === signature) return;
    signature = now;
    const wanted = text.value.trim().toLowerCase();
    const found = store.events.filter((event) => event.number <= upto && (kind.value === "" || event.kind === kind.value)
      && (axis.value === "" || Number(axis.value) === (event.axis ?? 0))
      && (wanted === "" || `${event.text} ${event.axis_name} ${event.cause} ${event.remedy}`.toLowerCase().includes(wanted))).reverse();
    rows.show(found.slice(0, most));
    table.hidden = found.length === 0;
    more.hidden = found.length <= most;
    said.hidden = found.length > 0;
    if (found.length === 0) put(said, store.events.length === 0 ? "No events yet." : "No event is like that.");
  }
  return { node, update, title: () => `${count(store.events.length, "event")}` };
}
