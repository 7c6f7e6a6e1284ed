// SPDX-License-Identifier: Apache-2.0
// All axes, one line each. Promises that a line stays where it is until somebody sorts.

import { el, list, put, say, set } from "../part/dom.js";
import { meter, state_mark, value_mark } from "../part/parts.js";
import { glyph } from "../part/glyphs.js";
import { spark } from "../part/plot.js";
import { sortable_head } from "../part/sort.js";
import { clock, duration } from "../format.js";
import { CALM, age_of, attention, is_out_of_reach, rank, reading, remark, sums, tone_of_link, tone_of_state, troubles } from "../state/judge.js";

const SPARKS_EACH_MS = 500;
const MOST_TROUBLES = 8;
const FILTER_FROM = 9; // axes; fewer are seen at a glance

const value_of = (name) => (axis) => axis.values?.[name] ?? axis.last?.[name]?.value ?? null;

const COLUMNS = [
  { label: "#", class: "number key", sort: (axis) => axis.axis },
  { label: "Axis", class: "name", sort: (axis) => axis.name },
  { label: "Drive", class: "drive at-wide", sort: (axis) => axis.drive },
  { label: "State", class: "of-state", sort: (axis) => axis.axis_state },
  { label: "Link", class: "of-link", sort: (axis) => axis.link_state },
  { label: "Position", unit: "rev", class: "number of-position", sort: value_of("position_rev") },
  { label: "Velocity", unit: "rpm", class: "number of-velocity", sort: value_of("velocity_rpm"), first: "down" },
  { label: "Torque", unit: "%", class: "number of-torque", sort: value_of("torque_percent"), first: "down" },
  { label: "Current", unit: "A", class: "number of-current", sort: value_of("current_a"), first: "down" },
  { label: "Velocity, 60 s", class: "of-spark at-huge" },
  { label: "Age", class: "number of-age", sort: (axis) => axis.age_ms, first: "down" },
  { label: "Owner", class: "of-owner at-mid", sort: (axis) => axis.owner },
  { label: "Remarks", class: "remarks", sort: (axis) => remark(axis) },
];

export function open(context) {
  const { store } = context;
  let order = null; // axis numbers as somebody has sorted them; null: as they count
  let drawn = 0; // when the small lines were drawn

  const totals = el("ul", { class: "sums" });
  const worst = el("button", { type: "button", class: "button", id: "worst-first", on_click: sort_worst }, "Worst first");
  const counted = el("button", { type: "button", class: "button", on_click: sort_by_number }, "By number");
  const sorted_at = el("span", { class: "hint" });
  const filter = el("input", { type: "search", placeholder: "Name, drive, bus, state", "aria-label": "Show only axes with this text", on_input: () => update() });
  const filter_box = el("div", { class: "filter" }, filter);
  const head = sortable_head(COLUMNS, (compare) => keep_order([...shown_axes()].sort(compare)));
  const rows = el("tbody", { role: "rowgroup" });
  const table = el("table", { class: "grid axes", role: "table" }, el("caption", { class: "unseen" }, "All axes, live. Grey values are not valid: they are what was known last."), head.node, rows);
  const nothing = el("p", { class: "plain" });
  const trouble_list = el("ul", { class: "troubles" });
  const more = el("p", { class: "hint" });
  const calm = el("p", { class: "hint" }, "Nothing does.");
  const node = el("div", { class: "page with-side" },
    el("div", { class: "page-head" }, el("h1", {}, "Axes"), totals, el("div", { class: "tools" }, filter_box, sorted_at, worst, counted)),
    el("div", { class: "main-part" }, el("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": "Table of all axes" }, table), nothing),
    el("section", { class: "panel side", "aria-labelledby": "troubles-title" }, el("h2", { id: "troubles-title" }, "Asks for attention"), trouble_list, more, calm));

  function keep_order(axes) {
    order = axes.map((axis) => axis.axis);
    put(sorted_at, "");
    update();
  }
  function sort_worst() {
    head.clear();
    keep_order(store.sorted_axes().sort((a, b) => rank(a) - rank(b) || a.axis - b.axis));
    put(sorted_at, `worst first as of ${clock(new Date())}`);
  }
  function sort_by_number() {
    head.clear();
    order = null;
    put(sorted_at, "");
    update();
  }
  function shown_axes() {
    const wanted = filter.value.trim().toLowerCase();
    const matches = (axis) => `${axis.axis} ${axis.name} ${axis.drive} ${axis.bus} ${axis.axis_state} ${axis.link_state} ${remark(axis)}`.toLowerCase().includes(wanted);
    const all = store.sorted_axes();
    const found = wanted === "" ? all : all.filter(matches);
    if (!order) return found;
    const place = new Map(order.map((number, at) => [number, at]));
    return found.sort((a, b) => (place.get(a.axis) ?? Infinity) - (place.get(b.axis) ?? Infinity) || a.axis - b.axis);
  }

  function update() {
    const now = performance.now();
    const seen = context.seen();
    const all = store.sorted_axes();
    const axes = shown_axes();
    const redraw = now - drawn > SPARKS_EACH_MS;
    if (redraw) drawn = now;
    list(rows, axes, (axis) => axis.axis, () => axis_row(store));
    for (const part of rows.kept.values()) part.live(seen, now);
    filter_box.hidden = all.length < FILTER_FROM && filter.value === "";
    table.hidden = axes.length === 0;
    nothing.hidden = axes.length > 0;
    put(nothing, all.length > 0 ? "No axis has this text." : store.heard === null ? "Waiting for the gateway …" : "This gateway has no axes.");
    show_sums(all, seen);
    show_troubles(all, seen);
    // Behind all texts: a size that is asked for between two changes is reckoned anew each time.
    if (redraw) for (const part of rows.kept.values()) part.draw(now);
  }

  function show_sums(all, seen) {
    const told = [[all.length === 1 ? "axis" : "axes", all.length, "calm"], ...sums(all)];
    list(totals, told, ([word]) => word, () => {
      const figure = el("b"), word = el("span");
      const item = el("li", {}, figure, " ", word);
      return {
        node: item,
        show([text, how_many, tone]) {
          put(figure, how_many);
          put(word, text);
          set(item, "data-tone", seen ? tone : "dim");
        },
      };
    });
  }

  function show_troubles(all, seen) {
    const found = [];
    if (seen) for (const alarm of (store.gateway?.alarms ?? []).filter((one) => OF_GATEWAY.includes(one.word))) {
      found.push({ key: `g ${alarm.word}`, level: 2, who: "gateway", title: alarm.word, text: alarm.meaning, remedy: alarm.remedy });
    }
    for (const axis of all) {
      for (const one of troubles(axis)) found.push({ key: `${axis.axis} ${one.title}`, axis, who: `${axis.axis} ${axis.name}`, ...one });
    }
    found.sort((a, b) => a.level - b.level || (a.axis?.axis ?? 0) - (b.axis?.axis ?? 0));
    list(trouble_list, found.slice(0, MOST_TROUBLES), (one) => one.key, trouble_item);
    put(more, found.length > MOST_TROUBLES ? `and ${found.length - MOST_TROUBLES} more` : "");
    more.hidden = found.length <= MOST_TROUBLES;
    calm.hidden = found.length > 0;
  }

  return {
    node,
    update,
    /** Milliseconds between two drawings: nobody reads a hundred lines ten times a second. */
    pace: () => (store.axes.size > 100 ? 500 : store.axes.size > 24 ? 200 : 0),
    title() {
      const bad = sums(store.sorted_axes()).filter(([, , tone]) => tone === "act").map(([word, how_many]) => `${how_many} ${word}`);
      return bad.length > 0 ? `${bad.join(", ")} – axes` : "Axes";
    },
  };
}

// What no axis tells by itself.
const OF_GATEWAY = ["DDS process down", "configuration changed", "event loop slow", "bus overloaded", "name taken", "listener down"];

function trouble_item() {
  const who = el("span", { class: "who" });
  const title = el("strong");
  const text = el("p");
  const remedy = el("p", { class: "remedy" });
  const shape = glyph("warning");
  const node = el("li", {}, shape, el("div", {}, el("p", {}, who, " ", title), text, remedy));
  return {
    node,
    show(one) {
      if (one.axis && !who.firstElementChild) who.append(el("a", { href: `#axis/${one.axis.axis}` }, one.who));
      else if (!one.axis) put(who, one.who);
      put(title, one.title);
      say(text, one.text);
      text.hidden = !one.text;
      say(remedy, one.remedy);
      remedy.hidden = !one.remedy;
      set(node, "data-tone", one.level < 2 ? "act" : "look");
    },
  };
}

function axis_row(store) {
  const state = state_mark(), link = state_mark("state link");
  const values = ["position_rev", "velocity_rpm", "torque_percent", "current_a"].map((name) => [name, value_mark("span", name, "elsewhere")]);
  const bar = meter();
  const line = spark("velocity_rpm");
  const label = el("a");
  const drive = el("td", { role: "cell", class: "drive at-wide" });
  const age = el("td", { role: "cell", class: "number of-age", "data-label": "age" });
  const owner_text = el("span");
  const owner_shape = glyph("owner");
  const owner = el("td", { role: "cell", class: "of-owner at-mid" }, owner_shape, owner_text);
  const remarks = el("td", { role: "cell", class: "remarks" });
  const number = el("td", { role: "cell", class: "number key" });
  const LABELS = { position_rev: "rev", velocity_rpm: "rpm", torque_percent: "%", current_a: "A" };
  const cells = values.map(([name, mark]) => el("td", { role: "cell", class: `number of-${name}`, "data-unit": LABELS[name] }, mark.node, name === "velocity_rpm" ? bar.node : []));
  const node = el("tr", { role: "row" }, number, el("th", { scope: "row", role: "rowheader", class: "name" }, label), drive,
    el("td", { role: "cell", class: "of-state" }, state.node), el("td", { role: "cell", class: "of-link" }, link.node), cells,
    el("td", { role: "cell", class: "of-spark at-huge" }, line.node), age, owner, remarks);
  let axis = null;
  return {
    node,
    show(next) {
      axis = next;
      put(number, axis.axis);
      put(label, axis.name || `axis ${axis.axis}`);
      set(label, "href", `#axis/${axis.axis}`);
      set(node, "id", `axis-${axis.axis}`);
      put(drive, `${axis.drive} · ${axis.bus} ${axis.node}`);
      set(drive, "title", `${axis.drive} (${axis.profile}), node ${axis.node} on ${axis.bus}`);
      put(owner_text, axis.owner ?? "");
      owner_shape.style.visibility = axis.owner ? "visible" : "hidden";
      set(owner, "data-none", !axis.owner);
      const text = remark(axis);
      put(remarks, text);
      set(remarks, "title", text || null);
    },
    live(seen, now) {
      state.show(axis.axis_state, seen ? tone_of_state(axis) : "dim");
      link.show(axis.link_state, seen ? tone_of_link(axis.link_state) : "dim", axis.link_state.replace("_", " "));
      set(node, "data-attention", seen ? attention(axis) : CALM);
      for (const [name, mark] of values) mark.show(reading(axis, name, seen, now));
      const speed = reading(axis, "velocity_rpm", seen, now);
      const full = axis.rated_speed_rpm ?? axis.limits?.target_velocity_rpm?.max ?? null;
      bar.show(speed.good && full ? speed.value / full : null);
      put(age, duration(age_of(axis, seen, now)));
      set(age, "data-quality", seen && !is_out_of_reach(axis) ? "good" : "old");
    },
    draw: (now) => line.show(store.history(axis.axis), now),
  };
}
