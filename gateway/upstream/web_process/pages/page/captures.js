// SPDX-License-Identifier: Apache-2.0
// What the gateway has kept of the seconds around a fault, a lost link, a stop that nobody expected: as a list, and each as lines with
// the moment of its cause and the events on the same time line.

import { Refusal, get } from "../api.js";
import { el, list, put, set } from "../part/dom.js";
import { event_rows } from "../part/event_rows.js";
import { line_picker } from "../part/line_picker.js";
import { bad_news, section, state_mark } from "../part/parts.js";
import { plot_view } from "../part/plot_view.js";
import { clock, count, number, spoken } from "../format.js";
import { lines_of } from "../state/recording.js";
import { difference_text } from "../state/scale.js";
import { MAIN, MOST, choices, parsed } from "../state/series.js";
import { utc_ms } from "../state/utc.js";
import { bounded, zoomed } from "../state/view.js";

// What begins a capture: in words, its shape and its tone.
const CAUSES = {
  fault: ["Fault", "error stop", "act"], link_lost: ["Link lost", "offline", "act"], lease_stop: ["Stop: the owner's lease ran out", "latched", "look"],
  stranger_stop: ["Stop by another than the owner", "latched", "look"], command_failed: ["Command failed", "warning", "look"],
  unexpected_motion: ["Unexpected motion", "warning", "act"], units_disagree: ["Units disagree", "warning", "look"], trigger: ["Trigger", "next", "calm"],
};
const cause_of = (capture) => CAUSES[capture.cause] ?? [spoken(capture.cause), "note", "calm"];
const link_of = (capture) => `#captures/${encodeURIComponent(capture.id)}`;
const LEAST_POINTS = 16, MOST_POINTS = 4000, ALL_POINTS = 15000; // slices of a line, and of all: an answer has an end
const ZOOM = 2;

export function open(context, id) {
  return id ? one_capture(context, id) : all_captures(context);
}

// --- All ------------------------------------------------------------------------------------------------------------

function all_captures({ store, soon }) {
  let captures = null, problem = "";
  const rows = el("tbody", { role: "rowgroup" });
  const heads = [["Time"], ["Axis"], ["Cause"], ["What"], ["Length", "number"], ["Samples", "number"], ["Kept"]].map(([text, kind]) => el("th", { scope: "col", role: "columnheader", class: kind }, text));
  const table = el("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": "Table of captures" },
    el("table", { class: "grid captures", role: "table" }, el("caption", { class: "unseen" }, "Captures, newest first"), el("thead", { role: "rowgroup" }, el("tr", { role: "row" }, heads)), rows));
  const said = el("p", { class: "plain" });
  const counted = el("p", { class: "hint" });
  const node = el("div", { class: "page" }, el("div", { class: "page-head" }, el("h1", {}, "Captures"), counted), table, said);
  function load() {
    get("captures").then((body) => { captures = body.captures ?? []; problem = ""; soon(); }, (refusal) => { problem = refusal.message; soon(); });
  }
  const stop_listening = store.listen((kind) => { if (kind === "capture" || kind === "hello") load(); });
  load();

  function row() {
    const cause = state_mark("state"), kept = state_mark("state");
    const time = el("a"), axis = el("a"), text = el("td", { role: "cell", class: "what" }), length = el("td", { role: "cell", class: "number" }), samples = el("td", { role: "cell", class: "number" });
    const item = el("tr", { role: "row" }, el("td", { role: "cell", class: "time" }, time), el("td", { role: "cell", class: "of-axis" }, axis), el("td", { role: "cell", class: "of-kind" }, cause.node), text, length, samples, el("td", { role: "cell", class: "of-kept" }, kept.node));
    return {
      node: item,
      show(capture) {
        const [word, shape, tone] = cause_of(capture);
        put(time, clock(capture.at, true));
        set(time, "href", link_of(capture));
        put(axis, `${capture.axis} ${capture.name ?? ""}`);
        set(axis, "href", `#axis/${capture.axis}`);
        cause.show(shape, tone, word);
        put(text, `${capture.text ?? ""}${capture.times > 1 ? ` (${capture.times} times)` : ""}`);
        put(length, capture.complete ? difference_text(utc_ms(capture.to) - utc_ms(capture.from)) : "");
        put(samples, capture.complete ? number(capture.samples) : "");
        kept.show(capture.complete ? "online" : "setup", capture.complete ? "dim" : "move", capture.complete ? "complete" : "under way");
        set(item, "data-tone", tone);
      },
    };
  }
  return {
    node,
    update() {
      list(rows, captures ?? [], (capture) => capture.id, row);
      table.hidden = !captures?.length;
      said.hidden = Boolean(captures?.length);
      put(said, problem || (captures === null ? "Waiting for the gateway …" : "Nothing has happened that is kept: a fault, a lost link, a stop by a lease or by another than the owner, a command that failed, a motion that nobody asked for."));
      put(counted, captures?.length ? `${count(captures.length, "capture")}, newest first` : "");
    },
    title: () => (captures?.length ? count(captures.length, "capture") : "Captures"),
    close: stop_listening,
  };
}

// --- One ------------------------------------------------------------------------------------------------------------

function one_capture({ store, soon }, id) {
  let capture = null, view = null, keys = null, samples = new Map(), problem = null, version = 0, drawn = "", choice = [], choice_of = -1, asked = 0;
  const title = el("h1", {}, "Capture"), what = el("p", { class: "what" });
  const state = state_mark("state");
  const events_holder = section("Events of this time");
  let events = null;
  const base = `captures/${encodeURIComponent(id)}`;

  function load() {
    const mine = ++asked;
    // At first what it is, then its lines.
    const asked_for = keys === null ? `points=${LEAST_POINTS}` : `points=${Math.min(MOST_POINTS, Math.floor(ALL_POINTS / keys.length))}&series=${keys.join(",")}`;
    get(`${base}?${asked_for}`).then((body) => {
      if (mine !== asked) return;
      capture = body;
      problem = null;
      if (keys === null) {
        keys = main_keys();
        view = whole();
        load();
      } else {
        samples = lines_of(body, keys);
        changed();
      }
    }, (refusal) => { problem = refusal; changed(); });
  }
  /** Of its axis what is looked at first, where its drive has it. */
  function main_keys() {
    const supported = store.axes.get(capture.axis)?.supported;
    const there = MAIN.filter((name) => (supported ? supported.includes(name) : capture.series?.[`${capture.axis}.${name}`]));
    return (there.length > 0 ? there : ["axis_state"]).map((name) => `${capture.axis}.${name}`);
  }
  const whole = () => ({ from: utc_ms(capture.from), to: utc_ms(capture.to) });
  function change(next) {
    view = bounded(next, whole().from, whole().to);
    changed();
  }
  function changed() {
    ++version;
    soon();
  }
  function toggle(key) {
    keys = keys.includes(key) ? keys.filter((one) => one !== key) : [...keys, key].slice(0, MOST);
    if (keys.length > 0) load();
    changed();
  }
  const of_then = () => capture?.axes ?? [{ axis: capture?.axis, name: capture?.name }];
  const axis_name = (one) => of_then().find((each) => each.axis === one)?.name ?? "";
  const plot = plot_view({ view: () => view, change, changed, axis_name, remove: toggle, command: () => change(whole()) });
  const picker = line_picker({ all: () => choice, chosen: () => keys ?? [], toggle, name: (one) => `${one.axis} ${axis_name(one.axis)}` });
  const zoom = (factor) => () => change(zoomed(view, (view.from + view.to) / 2, factor));
  const tools = el("div", { class: "tools" }, el("a", { class: "button", href: "#captures" }, "All captures"), el("button", { type: "button", class: "button", "aria-label": "Narrower", on_click: zoom(1 / ZOOM) }, "+"),
    el("button", { type: "button", class: "button", "aria-label": "Wider", on_click: zoom(ZOOM) }, "−"), el("button", { type: "button", class: "button", on_click: () => change(whole()) }, "All of it"), plot.button,
    el("a", { class: "button", id: "csv", href: `api/v1/${base}.csv`, download: `capture-${id}.csv` }, "CSV"));
  const said = bad_news("");
  const body = el("div", { class: "scope-body" }, el("div", { class: "scope-main" }, el("div", { class: "plotted" }, plot.plot), plot.legend, events_holder, plot.table), el("div", { class: "scope-side" }, section("Lines", picker.node)));
  const node = el("div", { class: "page scope" }, el("div", { class: "page-head axis-head" }, el("div", {}, title, what), el("div", { class: "states" }, state.node), tools), said, body);
  const stop_listening = store.listen((kind, data) => { if (kind === "capture" && data.id === id) load(); });
  load();

  function show_events() {
    if (!events) {
      events = event_rows(true, utc_ms(capture.at));
      events_holder.append(events.node);
    }
    events.show(capture.events ?? []);
    events_holder.hidden = (capture.events ?? []).length === 0;
  }
  function marks() {
    const [word] = cause_of(capture);
    const of_events = (capture.events ?? []).map((event) => ({ key: event.id ?? event.number, at: utc_ms(event.at), text: "", tone: "dim" }));
    return [...of_events, { key: "cause", at: utc_ms(capture.at), text: word, tone: "act" }];
  }
  return {
    node,
    update() {
      const absent = problem instanceof Refusal && !capture;
      said.hidden = !absent;
      body.hidden = tools.hidden = !capture || !keys;
      if (absent) put(said, problem.message.startsWith("404") ? "This capture is not kept any more, or it is of another gateway." : problem.message);
      if (!capture || !keys) return;
      const [word] = cause_of(capture);
      put(title, `${word}: ${capture.axis} ${capture.name ?? ""}`);
      put(what, `${clock(capture.at, true)}${capture.text ? ` · ${capture.text}` : ""}`);
      state.show(capture.complete ? "online" : "setup", capture.complete ? "dim" : "move", capture.complete ? `${difference_text(whole().to - whole().from)} kept${capture.cut ? ", cut short: there was no more room" : ""}` : "under way: what follows is still coming");
      if (choice_of !== store.axes.size) [choice, choice_of] = [choices(of_then().map((axis) => ({ ...store.axes.get(axis.axis), ...axis }))), store.axes.size];
      picker.show();
      const now = `${version} ${document.documentElement.dataset.theme} ${innerWidth}`;
      if (now === drawn) return;
      drawn = now;
      show_events();
      plot.show(keys.map((key) => ({ ...parsed(key), samples: samples.get(key) ?? lines_of(null, [key]).get(key) })), view, { marks: marks(), now: utc_ms(capture.at), now_text: "At the cause" });
    },
    title: () => (capture ? `${cause_of(capture)[0]}: ${capture.axis} ${capture.name ?? ""}` : "Capture"),
    close() {
      stop_listening();
      plot.close();
    },
  };
}
