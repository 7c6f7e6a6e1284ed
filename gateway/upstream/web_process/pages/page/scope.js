// SPDX-License-Identifier: Apache-2.0
// The scope: any values of any axes on one time line. Promises that it is live until somebody moves it or a trigger holds it, and
// that what it looks back to is the gateway's own history. What it shows stands in its address.

import { get } from "../api.js";
import { el, put, set } from "../part/dom.js";
import { draw as draw_glyph, glyph } from "../part/glyphs.js";
import { line_picker } from "../part/line_picker.js";
import { section } from "../part/parts.js";
import { plot_view } from "../part/plot_view.js";
import { trigger_form } from "../part/trigger_form.js";
import { count, duration, told } from "../format.js";
import { Recording, lines_of } from "../state/recording.js";
import { from_words, to_hash } from "../state/scope_link.js";
import { Samples } from "../state/samples.js";
import { MOST, choices, pane_of, parsed } from "../state/series.js";
import { KINDS, Trigger, takes_bit } from "../state/trigger.js";
import { difference_text, time_text } from "../state/scale.js";
import { utc_ms, utc_text } from "../state/utc.js";
import { bounded, zoomed } from "../state/view.js";

const SPANS_S = [0.5, 1, 2, 5, 10, 20, 30, 60, 120, 300, 600, 1800];
const MOST_POINTS = 4000, ALL_POINTS = 15000; // slices of a line, and of all: an answer has an end
const LOOK_AGAIN_MS = 120, LINK_AGAIN_MS = 400, CALM_MS = 1000, SETTLED_MS = 1500;
const ZOOM = 2, ROOM = 1.2;
const points = (keys) => Math.min(MOST_POINTS, Math.floor(ALL_POINTS / keys.length));
const HOW = "Drag to zoom · Shift and drag to move · wheel, pinch · keys ← → + − Space C";
const NOTHING = new Samples();

let left_at = null; // what was shown when somebody went to another page

export function open(context, ...words) {
  const { store, stream } = context;
  const begun = words.length === 0 && left_at ? left_at : from_words(words);
  const keys = [...begun.series];
  const recording = new Recording();
  let span_ms = begun.span_ms;
  let view = begun.view; // null: live
  let past = null; // lines of the history, for where somebody looks back to
  let closed = false;
  let trigger = null, wanted = begun.trigger;
  let held = null; // the view in which a single trigger has shown what it waited for
  let drawn = "", version = 0, drawn_at = 0, timers = {}, asked = 0, all = [], all_of = "", names = new Set();
  const calm = matchMedia("(prefers-reduced-motion: reduce)");

  // --- What is seen --------------------------------------------------------------------------------------------------

  const live = () => view === null;
  function seen() {
    if (view) return view;
    if (trigger?.shown) return trigger.shown;
    const to = recording.newest ?? Date.now();
    return { from: to - span_ms, to };
  }
  function change(next) {
    view = bounded(next, recording.oldest, recording.newest);
    look_back();
    changed();
  }
  function go_live() {
    view = past = null;
    if (trigger?.state === "done") trigger = null;
    changed();
  }
  function pause() {
    change(seen());
  }
  function changed() {
    if (closed) return; // an answer that came late
    ++version;
    later("link", LINK_AGAIN_MS, keep_link);
    context.soon();
  }
  function later(name, ms, what) {
    clearTimeout(timers[name]);
    timers[name] = setTimeout(what, ms);
  }
  const state = () => ({ series: keys, span_ms, trigger: wanted, view });
  function keep_link() {
    left_at = { ...state(), series: [...keys] };
    const hash = to_hash(state());
    if (location.hash.startsWith("#scope") && location.hash !== hash) history.replaceState(null, "", hash);
  }

  // --- What is known -------------------------------------------------------------------------------------------------

  function listen(kind, data) {
    if (kind === "hello") begin();
    else if (kind === "axes") recording.heard(utc_ms(data.at));
    else if (kind === "scope") {
      recording.take(data, (key, at, value) => { if (trigger && trigger.wanted.series === key) trigger.take(at, value); });
      trigger?.look(recording.newest);
      if (trigger?.state !== "done" || held) return;
      held = view = { from: trigger.shown.from, to: trigger.shown.to };
      changed();
    }
  }
  /** A stream begins: what was before it is asked of the history. */
  function begin() {
    if (keys.length === 0 || !stream.query) return;
    recording.begin(keys);
    trigger?.take(recording.newest, null); // nothing crosses what was not heard
    const mine = ++asked;
    get(`history?series=${keys.join(",")}&from=-${Math.ceil((ROOM * span_ms) / 1000)}&points=${points(keys)}`).then((answer) => answer, (refusal) => {
      put(said, refusal.message);
      return null;
    }).then((answer) => {
      if (mine !== asked) return;
      recording.take_past(answer);
      changed();
    });
    if (view) look_back();
  }
  /** Where the page has not every sample itself. */
  function look_back() {
    if (!view || !stream.query || recording.covers(view)) return;
    later("past", LOOK_AGAIN_MS, () => {
      const wanted_view = view && { ...view }, of = [...keys];
      if (!wanted_view) return;
      const room = (wanted_view.to - wanted_view.from) / 4; // so that a small move needs no other answer
      get(`history?series=${of.join(",")}&from=${utc_text(wanted_view.from - room)}&to=${utc_text(wanted_view.to + room)}&points=${points(of)}`).then((answer) => {
        if (answer.oldest) recording.oldest = utc_ms(answer.oldest);
        if (!view) return;
        past = lines_of(answer, of);
        put(said, "");
        changed();
      }, (refusal) => put(said, refusal.message));
    });
  }
  function samples_of(key) {
    const looked_up = view && !recording.covers(view) ? past?.get(key) : null;
    return looked_up ?? recording.lines.get(key) ?? recording.coming?.get(key) ?? NOTHING;
  }

  // --- What is chosen ------------------------------------------------------------------------------------------------

  function choose(next) {
    keys.splice(0, keys.length, ...next.slice(0, MOST));
    if (trigger && !keys.includes(trigger.wanted.series)) trigger = null;
    changed();
  }
  function toggle(key) {
    choose(keys.includes(key) ? keys.filter((one) => one !== key) : [...keys, key]);
  }
  /** Of what this gateway has: a link may be another's. */
  function ask() {
    if (store.told || all_choices().length === 0) return; // it has not told of all its axes yet
    const strange = keys.filter((key) => !names.has(key));
    if (strange.length > 0) {
      choose(keys.filter((key) => names.has(key)));
      put(said, `This gateway has no ${strange.join(", ")}.`);
    }
    stream.ask(keys.length > 0 ? `series=${keys.join(",")}` : "");
  }
  function all_choices() {
    const axes = store.sorted_axes();
    const now = axes.map((axis) => `${axis.axis}${axis.name}${axis.supported?.length}`).join();
    if (now !== all_of) {
      [all, all_of] = [choices(axes), now];
      names = new Set(all.map((one) => one.key));
    }
    return all;
  }
  const axis_name = (number) => store.axes.get(number)?.name ?? "";
  const line_name = (key) => `${parsed(key).axis} ${axis_name(parsed(key).axis)} · ${told(parsed(key).name)[0]}`;
  const of_each_axis = (name) => choose(store.sorted_axes().filter((axis) => axis.supported?.includes(name)).map((axis) => `${axis.axis}.${name}`));

  // --- Trigger -------------------------------------------------------------------------------------------------------

  function arm(asked_for) {
    wanted = asked_for;
    trigger = new Trigger(asked_for, span_ms);
    held = null;
    view = past = null;
    changed();
  }
  function trigger_text() {
    if (!trigger) return keys.length === 0 ? "Choose a line first." : "Not armed.";
    const { series, kind, level } = trigger.wanted;
    const what = `${line_name(series)} ${KINDS[kind]} ${level}${takes_bit(kind) ? "" : ` ${told(parsed(series).name)[1]}`}`;
    const last = trigger.fired_at === null ? "" : ` Fired at ${time_text(trigger.fired_at, 1)}${trigger.count > 1 ? `, ${trigger.count} times` : ""}.`;
    if (trigger.state === "done") return `Held.${last}`;
    return trigger.state === "filling" ? `${last.trim()} What follows is coming.` : `Waiting: ${what}.${last}`;
  }

  // --- The page ------------------------------------------------------------------------------------------------------

  const plot = plot_view({
    view: seen, change, changed, axis_name,
    remove(key) {
      const other = [...plot.legend.querySelectorAll("tr[data-key]")].find((row) => row.dataset.key !== key);
      other?.querySelector(".remove").focus({ preventScroll: true }); // the button that was pressed goes away
      toggle(key);
    },
    command(name) {
      if (name === "toggle") press();
      else if (name === "newest") go_live();
      else if (recording.oldest !== null) change({ from: recording.oldest, to: recording.oldest + (seen().to - seen().from) });
    },
  });
  function press() {
    if (live()) pause();
    else go_live();
  }
  const mode_glyph = glyph("pause"), mode_text = el("span");
  const mode = el("button", { type: "button", class: "button accent", id: "pause", on_click: press }, mode_glyph, mode_text);
  const spans = el("select", { "aria-label": "Length of the window", on_change() { set_span(Number(spans.value) * 1000); } }, [...new Set([...SPANS_S, span_ms / 1000])].sort((a, b) => a - b).map((s) => el("option", { value: s }, `${duration(s * 1000)}`)));
  spans.value = String(span_ms / 1000);
  function set_span(next) {
    span_ms = next;
    trigger = trigger && trigger.state !== "done" ? new Trigger(trigger.wanted, span_ms) : null;
    held = null;
    view = past = null;
    if (!recording.covers({ from: (recording.newest ?? 0) - span_ms, to: recording.newest ?? 0 })) begin(); // the same stream, and more of what was before
    changed();
  }
  const zoom = (factor) => () => change(zoomed(seen(), (seen().from + seen().to) / 2, factor));
  const csv = el("a", { class: "button", id: "csv", download: "scope.csv", on_click: point_csv }, "CSV");
  function point_csv() {
    const { from, to } = seen();
    set(csv, "href", `api/v1/history.csv?series=${keys.join(",")}&from=${utc_text(from)}&to=${utc_text(to)}`);
  }
  const said = el("p", { class: "hint", role: "status" });
  const where = el("span");
  const picker = line_picker({ all: all_choices, chosen: () => keys, toggle, name: (one) => `${one.axis} ${axis_name(one.axis)}` });
  const form = trigger_form({ lines: () => keys, name: line_name, arm, stop() { trigger = null; changed(); }, changed(next) { wanted = next; later("link", LINK_AGAIN_MS, keep_link); } }, wanted);
  const empty = el("div", { class: "plain empty" }, el("p", {}, "Nothing is chosen yet. Search a line beside this, or begin with"),
    el("p", { class: "buttons" }, [["velocity_rpm", "Velocity of each axis"], ["position_rev", "Position of each axis"]].map(([name, text]) => el("button", { type: "button", class: "button", on_click: () => of_each_axis(name) }, text))));
  const tools = el("div", { class: "tools" }, el("button", { type: "button", class: "button", "aria-label": "Narrower", on_click: zoom(1 / ZOOM) }, "+"), el("button", { type: "button", class: "button", "aria-label": "Wider", on_click: zoom(ZOOM) }, "−"), spans, plot.button, csv, mode);
  const plotted = el("div", { class: "plotted" }, el("p", { class: "where" }, where, el("span", { class: "how" }, HOW)), plot.plot);
  const node = el("div", { class: "page scope" }, el("div", { class: "page-head" }, el("h1", {}, "Scope"), said, tools),
    el("div", { class: "scope-body" }, el("div", { class: "scope-main" }, empty, plotted, plot.legend, plot.table),
      el("div", { class: "scope-side" }, section("Lines", picker.node), section("Trigger", form.node))));
  const stop_listening = store.listen(listen);
  later("link", LINK_AGAIN_MS, keep_link);

  function update() {
    ask();
    picker.show();
    form.show(trigger?.state ?? "idle", trigger_text());
    const is_seen = context.seen();
    draw_glyph(mode_glyph, live() ? "pause" : "play");
    put(mode_text, live() ? "Pause" : "Live");
    set(mode, "aria-label", live() ? "Pause, and look back" : "Go back to live");
    empty.hidden = keys.length > 0;
    plotted.hidden = plot.legend.hidden = plot.table.hidden = tools.hidden = keys.length === 0;
    set(node, "data-live", live() && is_seen);
    const moves = live() || view.to > recording.newest - SETTLED_MS;
    const now = `${moves ? recording.newest : ""} ${is_seen} ${version} ${document.documentElement.dataset.theme} ${innerWidth}`;
    if (now === drawn || keys.length === 0 || (calm.matches && live() && performance.now() - drawn_at < CALM_MS)) return;
    drawn = now;
    drawn_at = performance.now();
    draw();
  }
  function draw() {
    const shown = seen();
    const lines = keys.map((key) => ({ ...parsed(key), samples: samples_of(key) }));
    point_csv();
    const at = trigger?.fired_at ?? null;
    const marks = at === null ? [] : [{ key: "trigger", at, text: "T", tone: "look" }];
    const level = trigger && !takes_bit(trigger.wanted.kind) && keys.includes(trigger.wanted.series) ? [{ pane: pane_of(parsed(trigger.wanted.series).name), value: trigger.wanted.level }] : [];
    put(where, `${live() ? (trigger?.shown ? "Trigger" : context.seen() ? "Live" : "As it was") : view === held ? "Held by the trigger" : "Paused"} · ${time_text(shown.from, 10)} to ${time_text(shown.to, 10)} · ${difference_text(shown.to - shown.from)}`);
    const rolls = live() && !trigger?.shown;
    plot.show(lines, shown, { marks, levels: level, now: rolls ? recording.newest ?? shown.to : shown.to, now_text: rolls ? "Now" : "At the end" });
  }
  return {
    node, update,
    title: () => (keys.length === 0 ? "Scope" : `${live() ? "" : "Paused: "}${count(keys.length, "line")}`),
    close() {
      closed = true;
      for (const timer of Object.values(timers)) clearTimeout(timer);
      left_at = { ...state(), series: [...keys] };
      stop_listening();
      stream.ask("");
      plot.close();
    },
  };
}
