// SPDX-License-Identifier: Apache-2.0
// What runs here, since when, with which programs; and this page's own stream.

import { el, list, put, say } from "../part/dom.js";
import { facts, section, state_mark } from "../part/parts.js";
import { DASH, clock, number, spoken, uptime } from "../format.js";

export function open(context) {
  const { store, stream } = context;
  const gateway = facts(), service = facts(), page = facts();
  const programs = el("tbody");
  const alarms = el("ul", { class: "alarms" });
  const lines = [["GET", "api/v1/gateway", "name, version, alarms, programs"], ["GET", "api/v1/axes", "everything of each axis"], ["GET", "api/v1/buses", "load, counters, exchange times"],
    ["GET", "api/v1/events", "the newest 1,000"], ["GET", "api/v1/map", "the register map, also as CSV"], ["GET", "api/v1/words", "the words"], ["GET", "api/v1/health", "200, or 503"], ["GET", "api/v1/openapi.json", "all of it, described"]];
  const node = el("div", { class: "page" }, el("div", { class: "page-head" }, el("h1", {}, "About")),
    el("p", { class: "safety" }, el("strong", {}, "No function of axisgate is a safety function."), " Emergency stop and STO are wired. This page shows; it commands nothing, and no request of a browser costs a drive anything."),
    el("div", { class: "columns even" }, section("Gateway", gateway.node), section("How it serves", service.node),
      section("Programs beside it", el("table", { class: "grid small" }, el("caption", { class: "unseen" }, "Programs"), el("thead", {}, el("tr", {}, el("th", { scope: "col" }, "Program"), el("th", { scope: "col" }, "State"), el("th", { scope: "col", class: "number" }, "Restarts"))), programs)),
      section("Alarms of the gateway", alarms), section("This page", page.node),
      section("The same for programs", el("table", { class: "grid small api" }, el("caption", { class: "unseen" }, "Addresses of the API"), el("tbody", {}, lines.map(([, path, what]) => el("tr", {}, el("th", { scope: "row" }, el("a", { href: path }, `/${path}`)), el("td", {}, what))))),
        el("p", { class: "hint" }, "Live: /api/v1/stream, server-sent events."))));
  return {
    node,
    update() {
      const g = store.gateway ?? {};
      const yes = (value, good, bad) => (value === undefined ? DASH : value ? good : bad);
      gateway.show([["Name", g.name || "none"], ["Version", g.version], ["State", g.state], ["Axes", g.axis_count === undefined ? DASH : `${g.axes_online} of ${g.axis_count} online`], ["Started", clock(g.started)], ["Up", uptime(g.uptime_s)], ["Boot", g.boot === undefined ? DASH : String(g.boot)]]);
      const refused = Object.entries(g.web?.refused ?? {}).filter(([, times]) => times > 0).map(([reason, times]) => `${number(times)} ${spoken(reason)}`).join(", ");
      service.show([["Modbus clients", g.clients === undefined ? DASH : `${number(g.clients)}, ${number(g.clients_refused)} refused so far`],
        ["Web", g.web ? `${number(g.web.connections)} connections, ${number(g.web.streams)} of them streams` : DASH], ["Web requests", g.web ? `${number(g.web.requests)}; refused: ${refused || "none"}` : DASH],
        ["Lost on their way", g.events_lost === undefined ? DASH : `${number(g.events_lost)} events, ${number(g.gaps)} samples`], ["Its loop", typeof g.worst_turn_ms === "number" ? `${number(g.worst_turn_ms, 2)} ms late at most, in the last second` : DASH],
        ["Encryption", yes(g.insecure, "none, and open to other computers", "none: this computer alone")], ["Confined", yes(g.confined, "yes: it cannot open a socket or a program", "no: this kernel has no seccomp")]]);
      page.show([["Stream", stream.state], ["Frames", number(stream.frames)], ["Received", `${number(stream.bytes / 1024)} KiB`], ["Period", store.hello?.period_ms ? `${store.hello.period_ms} ms` : DASH], ["Times are", Intl.DateTimeFormat().resolvedOptions().timeZone || "local"]]);
      const known = g.programs ?? [];
      list(programs, known.length > 0 ? known : [{ name: "" }], (one) => one.name, (one) => {
        if (one.name === "") return { node: el("tr", {}, el("td", { colspan: 3, class: "hint" }, "none")), show() {} };
        const state = state_mark(), restarts = el("td", { class: "number" });
        return {
          node: el("tr", {}, el("th", { scope: "row" }, one.name), el("td", {}, state.node), restarts),
          show(now) {
            state.show(now.running ? "up" : "down", now.running ? "dim" : "look", now.running ? "runs" : "does not run");
            put(restarts, number(now.restarts));
          },
        };
      });
      const rows = g.alarms ?? [];
      list(alarms, rows.length > 0 ? rows : [{ word: "" }], (alarm) => alarm.word, (alarm) => {
        if (alarm.word === "") return { node: el("li", { class: "hint" }, "none"), show() {} };
        const remedy = el("p", { class: "remedy" });
        say(remedy, alarm.remedy);
        return { node: el("li", {}, el("p", {}, el("a", { href: `#words/${encodeURIComponent(alarm.word)}` }, alarm.word), " ", alarm.meaning), remedy), show() {} };
      });
    },
    title: () => "About",
  };
}
