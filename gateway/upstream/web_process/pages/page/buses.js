// SPDX-License-Identifier: Apache-2.0
// Each bus: what `axisgate check` had reckoned beside what is, what was counted, and how long exchanges took.

import { el, list, put, set } from "../part/dom.js";
import { facts, load_bar, state_mark } from "../part/parts.js";
import { DASH, number, spoken } from "../format.js";
import { tone_of_link } from "../state/judge.js";

const CLASSES = ["stop", "fault_cause", "command", "interactive", "setup", "poll"];
const COUNTERS = ["requests", "replies", "timeouts", "bad_frames", "late_replies", "dropped_bytes", "refused", "reconnects", "coalesced", "superseded", "echoes"];
const TROUBLE = ["timeouts", "bad_frames", "late_replies", "dropped_bytes", "reconnects"];
const MINUTE_MS = 60000;

export function open(context) {
  const { store } = context;
  const holder = el("div", { class: "buses" });
  const totals = el("p", { class: "hint" });
  const nothing = el("p", { class: "plain" });
  const node = el("div", { class: "page" }, el("div", { class: "page-head" }, el("h1", {}, "Buses"), totals), holder, nothing);
  const not_up = () => store.buses.filter((bus) => bus.link !== "up").length;
  return {
    node,
    update() {
      const seen = context.seen();
      put(totals, `${store.buses.length} ${store.buses.length === 1 ? "bus" : "buses"}${not_up() > 0 ? `, ${not_up()} not up` : ""}`);
      nothing.hidden = store.buses.length > 0;
      put(nothing, "Waiting for the gateway …");
      list(holder, store.buses, (bus) => bus.bus, () => bus_panel(store));
      for (const part of holder.kept.values()) part.live(seen);
    },
    title: () => (not_up() > 0 ? `${not_up()} not up – buses` : "Buses"),
  };
}

function bus_panel(store) {
  const title = el("h2");
  const link = state_mark("state");
  const what = el("p", { class: "what" });
  const axes = el("p", { class: "what axes-of" });
  const bar = load_bar();
  const load_now = el("td", { class: "number" }), load_planned = el("td", { class: "number" });
  const cycle_now = el("td", { class: "number" }), cycle_planned = el("td", { class: "number" });
  const queue = el("td", { class: "number" });
  const plan = el("table", { class: "grid small plan" }, el("caption", {}, "Plan and reality"),
    el("thead", {}, el("tr", {}, el("td"), ["Now", "Planned"].map((text) => el("th", { scope: "col", class: "number" }, text)))),
    el("tbody", {}, el("tr", {}, el("th", { scope: "row" }, "Load ", el("span", { class: "unit" }, "%")), load_now, load_planned),
      el("tr", {}, el("th", { scope: "row" }, "Cycle ", el("span", { class: "unit" }, "ms")), cycle_now, cycle_planned),
      el("tr", {}, el("th", { scope: "row" }, "Jobs that wait"), queue, el("td", { class: "number" }, DASH))));
  const times = el("tbody");
  const none = el("p", { class: "hint" }, "No exchange in the last minute.");
  const time_table = el("table", { class: "grid small times" }, el("caption", {}, "Exchanges of the last minute"),
    el("thead", {}, el("tr", {}, [["Class"], ["Count", "number"], ["p50 ms", "number"], ["p95 ms", "number"], ["p99 ms", "number"]].map(([text, kind]) => el("th", { scope: "col", class: kind }, text)))), times);
  const counters = facts("facts counters");
  const node = el("section", { class: "panel bus" }, el("div", { class: "bus-head" }, el("div", {}, title, what), link.node), axes,
    el("div", { class: "bus-body" }, el("div", {}, plan, bar.node), el("div", {}, time_table, none), el("div", {}, el("h3", {}, "Counted since the start"), counters.node)));
  const grown = new Map(); // counter: [value, when it was last another one]
  let bus = null;
  return {
    node,
    show(next) { bus = next; },
    live(seen) {
      const dead = !seen;
      put(title, bus.name);
      link.show(bus.link, dead ? "dim" : tone_of_link(bus.link));
      put(what, `${bus.protocol} · ${bus.endpoint}`);
      list(axes, bus.axes ?? [], (one) => one, (one) => {
        const to = el("a", { href: `#axis/${one}` });
        return { node: to, show() { put(to, `${one} ${store.axes.get(one)?.name ?? ""}`); } };
      });
      const planned = bus.planned ?? {};
      const over = bus.load_percent > Math.max(90, planned.load_percent ?? 0);
      put(load_now, number(bus.load_percent, 1));
      put(load_planned, number(planned.load_percent, 1));
      put(cycle_now, number(bus.cycle_ms));
      put(cycle_planned, number(planned.cycle_ms));
      put(queue, number(bus.queue_depth));
      for (const cell of [load_now, cycle_now, queue]) set(cell, "data-quality", dead ? "old" : "good");
      bar.show((bus.load_percent ?? 0) / 100, typeof planned.load_percent === "number" ? planned.load_percent / 100 : null, dead ? "dim" : over ? "look" : "calm");
      const rows = CLASSES.filter((name) => bus.exchange_ms?.[name]?.count > 0);
      time_table.hidden = rows.length === 0;
      none.hidden = rows.length > 0;
      list(times, rows, (name) => name, (name) => {
        const cells = ["count", "p50", "p95", "p99"].map((of) => [of, el("td", { class: "number" })]);
        return {
          node: el("tr", {}, el("th", { scope: "row" }, spoken(name)), cells.map(([, cell]) => cell)),
          show() { for (const [of, cell] of cells) put(cell, number(bus.exchange_ms[name][of], of === "count" ? 0 : 1)); },
        };
      });
      counters.show(COUNTERS.filter((name) => bus.counters?.[name] !== undefined).map((name) => [spoken(name), number(bus.counters[name])]));
      mark_growing();
    },
  };

  /** What should stand still and has grown within the last minute. */
  function mark_growing() {
    const now = performance.now();
    for (const name of TROUBLE) {
      const value = bus.counters?.[name];
      const before = grown.get(name);
      if (!before || before[0] !== value) grown.set(name, [value, before ? now : -Infinity]);
      const part = counters.node.kept.get(spoken(name));
      if (!part) continue;
      const fresh = now - grown.get(name)[1] < MINUTE_MS;
      set(part.node, "data-tone", fresh ? "look" : null);
      set(part.node, "title", fresh ? "has grown within the last minute" : null);
    }
  }
}
