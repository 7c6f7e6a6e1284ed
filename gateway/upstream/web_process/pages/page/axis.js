// SPDX-License-Identifier: Apache-2.0
// One axis, all of it.

import { get } from "../api.js";
import { el, list, put, say, set } from "../part/dom.js";
import { facts, section, state_mark, value_mark } from "../part/parts.js";
import { glyph } from "../part/glyphs.js";
import { plot } from "../part/plot.js";
import { readout } from "../part/readout.js";
import { event_rows } from "../part/event_rows.js";
import { DASH, clock, duration, hex, number, spoken, told, value_text } from "../format.js";
import { age_of, reading, tone_of_link, tone_of_state } from "../state/judge.js";
import { SPAN_MS } from "../state/history.js";
import { to_hash } from "../state/scope_link.js";
import { MAIN } from "../state/series.js";

const READOUTS = ["position_rev", "velocity_rpm", "torque_percent", "current_a", "following_error_rev", "dc_voltage_v", "drive_temperature_c", "motor_temperature_c"];
const INPUTS = ["online", "ready", "enabled", "fault", "warning", "target_reached", "homed", "moving", "limit_active", "quick_stop_active", "following_error", "stop_latched"];
const EVENTS = 12;

export function open(context, which) {
  const { store } = context;
  const wanted = Number(which);
  const absent = el("p", { class: "plain" });
  const body = el("div", { class: "axis-body" });
  const parts = [head(context), fault_panel(), blocked_panel(), readouts(), plots(store), command_panel(), inputs_panel(), drive_panel(), values_panel(), events_panel(store)];
  // Those of before; what comes now the stream brings.
  get(`events?axis=${encodeURIComponent(which)}&limit=${EVENTS}`).then((body) => store.take_events(body.events ?? []), () => { /* the panel says that there are none yet */ });
  const [top, fault, blocked, figures, drawn, command, inputs, drive, values, events] = parts;
  body.append(top.node, fault.node, el("div", { class: "columns" },
    el("div", { class: "column broad" }, figures.node, drawn.node, events.node, values.node),
    el("div", { class: "column" }, blocked.node, command.node, inputs.node, drive.node)));
  const node = el("div", { class: "page" }, absent, body);
  return {
    node,
    update() {
      const axis = store.axes.get(wanted);
      absent.hidden = Boolean(axis);
      body.hidden = !axis;
      if (!axis) {
        put(absent, store.heard === null ? "Waiting for the gateway …" : `This gateway has no axis ${which ?? ""}.`);
        return;
      }
      const seen = context.seen();
      for (const part of parts) part.show(axis, seen);
    },
    title() {
      const axis = store.axes.get(wanted);
      return axis ? `${axis.fault ? "Fault: " : ""}${axis.axis} ${axis.name} ${axis.axis_state}` : `Axis ${which ?? ""}`;
    },
  };
}

function head({ store }) {
  const title = el("h1");
  const state = state_mark("state large"), link = state_mark("state");
  const what = el("p", { class: "what" });
  const before = el("a", { class: "button", rel: "prev" }, glyph("previous"), el("span")), after = el("a", { class: "button", rel: "next" }, el("span"), glyph("next"));
  const node = el("div", { class: "page-head axis-head" }, el("div", {}, title, what), el("div", { class: "states" }, state.node, link.node), el("nav", { class: "tools", "aria-label": "Other axes" }, before, after));
  return {
    node,
    show(axis, seen) {
      put(title, `${axis.axis}  ${axis.name}`);
      put(what, `${axis.drive} · node ${axis.node} on ${axis.bus}`);
      state.show(axis.axis_state, seen ? tone_of_state(axis) : "dim");
      link.show(axis.link_state, seen ? tone_of_link(axis.link_state) : "dim", axis.link_state.replace("_", " "));
      set(node, "id", "axis-head");
      const all = store.sorted_axes();
      const at = all.findIndex((one) => one.axis === axis.axis);
      show_link(before, all[at - 1], "Axis before");
      show_link(after, all[at + 1], "Next axis");
    },
  };
  function show_link(button, other, label) {
    set(button, "href", other ? `#axis/${other.axis}` : null);
    button.hidden = !other;
    set(button, "aria-label", other ? `${label}: ${other.axis} ${other.name}` : null);
    put(button.querySelector("span"), other ? `${other.axis} ${other.name}` : "");
  }
}

function fault_panel() {
  const title = el("strong"), codes = el("span", { class: "codes" });
  const cause = el("dd"), remedy = el("dd"), since = el("dd");
  const rows = [["Cause", cause], ["Remedy", remedy], ["Since", since]].map(([term, what]) => el("div", {}, el("dt", {}, term), what));
  const before = el("a", { class: "button", id: "before" }, glyph("previous"), "What happened before");
  const node = el("section", { class: "fault", id: "fault", "aria-label": "Fault" }, glyph("error stop", "big"), el("div", {}, el("h2", {}, "Fault: ", title, " ", codes), el("dl", { class: "facts" }, rows), before));
  return {
    node,
    show(axis) {
      const fault = axis.fault;
      node.hidden = !fault;
      if (!fault) return;
      put(title, fault.text || "its cause is being read");
      before.hidden = !axis.capture;
      set(before, "href", axis.capture ? `#captures/${encodeURIComponent(axis.capture)}` : null);
      put(codes, [hex(fault.code, 4), fault.vendor_code ? `drive's own ${hex(fault.vendor_code, 4)}` : ""].filter(Boolean).join(", "));
      [[cause, fault.cause], [remedy, fault.remedy], [since, fault.since ? clock(fault.since) : ""]].forEach(([what, text]) => {
        say(what, text);
        what.parentNode.hidden = !text;
      });
    },
  };
}

function blocked_panel() {
  const rows = el("ol", { class: "blocked" });
  const free = el("p", { class: "hint" });
  const node = section("What stands against a motion", rows, free);
  set(node, "id", "blocked");
  return {
    node,
    show(axis, seen) {
      const found = seen || axis.joined === false ? axis.blocked_by ?? [] : []; // what the gateway says of itself stays
      put(free, seen ? "Nothing: a motion would be started." : "Not known: the gateway is not seen.");
      rows.hidden = found.length === 0;
      free.hidden = found.length > 0;
      list(rows, found, (one) => one.word, () => {
        const word = el("strong"), text = el("span"), remedy = el("p", { class: "remedy" });
        const item = el("li", {}, el("p", {}, word, " ", text), remedy);
        return {
          node: item,
          show(one) {
            put(word, spoken(one.word));
            say(text, one.text === one.word ? "" : one.text);
            say(remedy, one.remedy);
            remedy.hidden = !one.remedy;
          },
        };
      });
    },
  };
}

function readouts() {
  const tiles = el("div", { class: "tiles" });
  const node = el("section", { class: "readouts" }, el("h2", { class: "unseen" }, "Values"), tiles);
  return {
    node,
    show(axis, seen) {
      const names = READOUTS.filter((name) => !axis.supported || axis.supported.includes(name));
      list(tiles, names, (name) => name, readout);
      for (const part of tiles.kept.values()) part.live(axis, seen);
    },
  };
}

function plots(store) {
  const velocity = plot("velocity_rpm", "Velocity", "rpm", 1, 2);
  const position = plot("position_rev", "Position", "rev", 4, 0.01);
  const rows = el("tbody");
  const table = el("table", { class: "grid small" }, el("caption", { class: "unseen" }, "Velocity and position of the last minute, one line for two seconds"),
    el("thead", {}, el("tr", {}, ["Seconds ago", "Velocity rpm", "Position rev"].map((text) => el("th", { scope: "col", class: "number" }, text)))), rows);
  const behind = el("details", {}, el("summary", {}, "The same as a table"), table);
  const position_box = el("figure", {}, el("figcaption", {}, "Position ", el("span", { class: "unit" }, "rev")), position.node);
  const velocity_box = el("figure", {}, el("figcaption", {}, "Velocity ", el("span", { class: "unit" }, "rpm")), velocity.node);
  const more = el("a", { class: "hint" }, "In the scope");
  const node = section("The last minute, as this page has seen it", more, velocity_box, position_box, behind);
  node.classList.add("plots");
  const calm = matchMedia("(prefers-reduced-motion: reduce)");
  let drawn = 0, told_at = 0;
  return {
    node,
    show(axis) {
      const now = performance.now();
      if (calm.matches && now - drawn < 1000) return;
      drawn = now;
      const history = store.history(axis.axis);
      set(more, "href", to_hash({ series: MAIN.filter((name) => !axis.supported || axis.supported.includes(name)).map((name) => `${axis.axis}.${name}`), span_ms: SPAN_MS }));
      velocity_box.hidden = Boolean(axis.supported) && !axis.supported.includes("velocity_rpm");
      position_box.hidden = Boolean(axis.supported) && !axis.supported.includes("position_rev");
      velocity.show(history, now);
      position.show(history, now);
      if (!behind.open || now - told_at < 2000) return;
      told_at = now;
      const slices = new Map();
      for (const series of ["velocity_rpm", "position_rev"]) {
        history.each(series, now - SPAN_MS, (at, value) => {
          const back = Math.floor((now - at) / 2000) * 2;
          slices.set(back, { ...slices.get(back), [series]: Number.isNaN(value) ? null : value });
        });
      }
      const sorted = [...slices].sort((a, b) => a[0] - b[0]);
      list(rows, sorted, ([back]) => back, ([back]) => {
        const cells = [el("td", { class: "number" }), el("td", { class: "number" })];
        return {
          node: el("tr", {}, el("td", { class: "number" }, String(back)), cells),
          show([, slice]) {
            put(cells[0], value_text("velocity_rpm", slice.velocity_rpm));
            put(cells[1], value_text("position_rev", slice.position_rev));
          },
        };
      });
    },
  };
}

const TONES = { "done": "calm", "pending": "calm", "none": "dim" };

function command_panel() {
  const result = state_mark("state");
  const owner = facts(), last = facts();
  const node = section("Who commands", owner.node, el("h3", {}, "Last command"), last.node);
  node.classList.add("commands");
  return {
    node,
    show(axis, seen) {
      const lease = axis.lease_ms === null || axis.lease_ms === undefined ? "none runs" : `${number(axis.lease_ms)} ms left`;
      owner.show([
        ["Owner", axis.owner ?? "nobody"],
        axis.owner && ["Lease", seen ? lease : DASH],
        ["Motion", `${spoken(axis.motion_state)}${axis.motion_id ? `, id ${axis.motion_id}` : ""}`],
        ["Mode", axis.mode_text],
      ]);
      const command = axis.last_result;
      if (!command) {
        last.show([["Result", "none since the gateway's start"]]);
        return;
      }
      result.node.classList.add("in-facts");
      result.show(command.result === "done" ? "online" : command.result === "pending" ? "setup" : "warning", TONES[command.result] ?? "look", spoken(command.result));
      last.show([
        ["What", spoken(command.what)],
        ["Who", command.who],
        ["Result", result.node],
        command.text && command.text !== command.result && ["Why", command.text],
        ["When", clock(command.at)],
      ]);
    },
  };
}

function inputs_panel() {
  const lamps = el("ul", { class: "lamps" });
  const node = section("Inputs as a PLC reads them", lamps);
  return {
    node,
    show(axis, seen) {
      const on = new Set(axis.inputs ?? []);
      list(lamps, INPUTS, (name) => name, (name) => {
        const lamp = state_mark("lamp");
        const item = el("li", {}, lamp.node);
        return {
          node: item,
          show() {},
          live(on, dead) {
            const bad = ["fault", "limit_active"].includes(name), odd = ["warning", "quick_stop_active", "stop_latched", "following_error"].includes(name);
            lamp.show(on.has(name) ? "on" : "off", dead || !on.has(name) ? "dim" : bad ? "act" : odd ? "look" : name === "moving" ? "move" : "calm", spoken(name));
            set(item, "aria-label", `${spoken(name)}: ${on.has(name) ? "1" : "0"}`);
          },
        };
      });
      for (const part of lamps.kept.values()) part.live(on, !seen);
    },
  };
}

function loss_text(ms) {
  if (ms === null || ms === undefined) return "not known: it was not set up by this gateway";
  return ms === 0 ? "IT GOES ON with what it was told last" : `it begins to stop by itself within ${number(ms)} ms`;
}

function drive_panel() {
  const shown = facts();
  const alarms = el("ul", { class: "alarms" });
  const node = section("Drive", shown.node, el("h3", {}, "Alarms"), alarms);
  return {
    node,
    show(axis) {
      shown.show([
        ["If the gateway dies", loss_text(axis.loss_stop_ms)],
        ["Profile", axis.profile],
        ["Units", `${number(axis.units_per_rev, Number.isInteger(axis.units_per_rev) ? 0 : 3)} a turn`],
        ["Rated speed", axis.rated_speed_rpm ? `${number(axis.rated_speed_rpm)} rpm` : "not known"],
        ["Modes", (axis.supported_modes ?? []).join(", ")],
        ["Commands", (axis.commands ?? []).map(spoken).join(", ")],
      ]);
      const rows = axis.alarms ?? [];
      list(alarms, rows.length > 0 ? rows : [{ word: "" }], (alarm) => alarm.word, (alarm) => {
        if (alarm.word === "") return { node: el("li", { class: "hint" }, "none"), show() {} };
        const meaning = el("span"), remedy = el("p", { class: "remedy" });
        return {
          node: el("li", {}, el("p", {}, el("a", { href: `#words/${encodeURIComponent(alarm.word)}` }, spoken(alarm.word)), " ", meaning), remedy),
          show(one) {
            say(meaning, one.meaning);
            say(remedy, one.remedy);
          },
        };
      });
    },
  };
}

function values_panel() {
  const rows = el("tbody");
  const table = el("table", { class: "grid small" }, el("caption", { class: "unseen" }, "All values of this axis"),
    el("thead", {}, el("tr", {}, [["Value", ""], ["Now", "number"], ["Unit", ""], ["Quality", "quality"], ["Least", "number"], ["Most", "number"]].map(([text, kind]) => el("th", { scope: "col", class: kind }, text)))), rows);
  const oldest = el("p", { class: "hint" });
  const node = section("All values", oldest, el("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": "Table of all values" }, table));
  node.classList.add("values");
  return {
    node,
    show(axis, seen) {
      const names = axis.supported ?? Object.keys(axis.values ?? {});
      put(oldest, `The oldest of those that are polled fast is ${duration(age_of(axis, seen, performance.now()))} old.`);
      list(rows, names, (name) => name, (name) => {
        const [label, unit] = told(name);
        const now = value_mark("td", name, "elsewhere"), quality = el("td", { class: "quality" }), least = el("td", { class: "number" }), most = el("td", { class: "number" });
        now.node.classList.add("number");
        return {
          node: el("tr", {}, el("th", { scope: "row" }, label), now.node, el("td", { class: "unit" }, unit), quality, least, most),
          show() {},
          live(of, is_seen) {
            const read = reading(of, name, is_seen, performance.now());
            now.show(read);
            put(quality, read.good ? "valid" : read.value === null ? "no value" : read.age_ms === null ? "not valid" : `not valid, ${duration(read.age_ms)} old`);
            put(least, value_text(name, of.limits?.[name]?.min));
            put(most, value_text(name, of.limits?.[name]?.max));
          },
        };
      });
      for (const part of rows.kept.values()) part.live(axis, seen);
    },
  };
}

function events_panel(store) {
  const rows = event_rows(false);
  const none = el("p", { class: "hint" }, "None.");
  const node = section("Events of this axis", rows.node, none);
  return {
    node,
    show(axis) {
      const found = store.events.filter((event) => event.axis === axis.axis).slice(-EVENTS).reverse();
      rows.show(found);
      rows.node.hidden = found.length === 0;
      none.hidden = found.length > 0;
    },
  };
}
