// SPDX-License-Identifier: Apache-2.0
// Lines over time as somebody reads them: the plot, a table with the value of each line, cursors with differences, and the same as a
// table of instants. Scope and captures have it both.

import { el, list, put, set } from "./dom.js";
import { graph } from "./graph.js";
import { timeline } from "./timeline.js";
import { DASH, told, value_text } from "../format.js";
import { get } from "../api.js";
import { rows_of } from "../state/columns.js";
import { between, placed } from "../state/cursors.js";
import { difference_text, range, range_of_codes, time_text } from "../state/scale.js";
import { LETTERS, holds, is_code, least_of, pane_of } from "../state/series.js";

const TABLE_ROWS = 40;
const TABLE_EACH_MS = 2000;
const WORDS_OF = { axis_state: "axis state", motion_state: "motion state", link_state: "link state", mode: "mode", mode_asked: "mode" };

let words = null; // kind: Map of number and name; they do not change while the gateway runs as it is
function load_words(then) {
  if (words) return;
  get("words").then((body) => {
    words = new Map();
    for (const word of body.words ?? []) {
      if (!words.has(word.kind)) words.set(word.kind, new Map());
      words.get(word.kind).set(word.number, word.name);
    }
    then();
  }, () => { /* numbers say it too */ });
}
const words_of = (name) => words?.get(WORDS_OF[name]) ?? null;

/** With its word, where it has one. */
function shown(name, value) {
  return (value === null ? null : words_of(name)?.get(value)) ?? value_text(name, value);
}

function difference(name, value) {
  return value === null ? DASH : `${value > 0 ? "+" : ""}${value_text(name, value)}`;
}

/**
 * A line is {key, axis, name, samples}; its letter is its place's. hooks: view(), change(view), command(name) as a timeline has
 * them, changed(): draw again; remove(key), where lines can be taken away; axis_name(number).
 */
export function plot_view(hooks) {
  const drawing = graph();
  const ranges = new Map();
  let cursors = null, pointed = null, lines = [], told_at = 0, has_words = words !== null;
  load_words(() => { has_words = true; hooks.changed(); });
  const line = timeline(drawing.node, {
    ...hooks,
    cursor(i, at) { cursors[i] = at; hooks.changed(); },
    point(at) {
      if (at === null && pointed === null) return;
      pointed = at;
      hooks.changed();
    },
    command(name) {
      if (name === "cursors") toggle_cursors();
      else hooks.command(name);
    },
  });
  const button = el("button", { type: "button", class: "button", "aria-pressed": "false", on_click: toggle_cursors }, "Cursors");
  const legend = legend_table(hooks);
  const behind = instants_table();

  function toggle_cursors() {
    cursors = cursors ? null : placed(hooks.view());
    set(button, "aria-pressed", String(cursors !== null));
    hooks.changed();
  }

  function panes(view, levels) {
    const groups = new Map();
    lines.forEach((each, place) => {
      const key = pane_of(each.name);
      if (!groups.has(key)) groups.set(key, []);
      groups.get(key).push({ ...each, place });
    });
    const keys = [...groups.keys()];
    return keys.map((key) => {
      const of = groups.get(key);
      const rows = rows_of(of.map((each) => ({ samples: each.samples, holds: holds(each.name) })), view.from, view.to, drawing.columns());
      const extent = extent_of(rows, levels.filter((level) => level.pane === key).map((level) => level.value));
      const names = [...new Set(of.map((each) => told(each.name)[0]))];
      const of_words = has_words && of.every((each) => words_of(each.name)) ? words_of(of[0].name) : null;
      ranges.set(key, of_words ? range_of_codes(extent) : range(ranges.get(key) ?? null, extent, least_of(of[0].name)));
      return {
        shape: { key, title: `${names.join(", ")}${told(of[0].name)[1] ? ` · ${told(of[0].name)[1]}` : ""}`, words: of_words, is_last: key === keys.at(-1),
                 lines: of.map((each) => ({ key: each.key, letter: LETTERS[each.place], place: each.place, holds: holds(each.name) })) },
        rows, range: ranges.get(key), levels: levels.filter((level) => level.pane === key).map((level) => level.value),
      };
    });
  }

  return {
    plot: line.node, legend: legend.node, table: behind.node, button,
    /** now: the instant of the values where no pointer asks for another, now_text says which that is; levels: [{pane, value}] */
    show(next, view, { marks = [], levels = [], now, now_text }) {
      lines = next;
      const took = drawing.show(panes(view, levels), view);
      const at = pointed ?? now;
      line.show(view, cursors, pointed, marks);
      legend.show(lines, view, at, pointed === null ? now_text : `At ${time_text(at, 1)}`, cursors);
      if (performance.now() - told_at > TABLE_EACH_MS) {
        told_at = performance.now();
        behind.show(lines, view);
      }
      return took;
    },
    close: () => drawing.close(),
  };
}

function extent_of(rows, levels) {
  let low = Math.min(...levels, Infinity), high = Math.max(...levels, -Infinity);
  for (const row of rows) {
    for (let i = 1; i < row.length; ++i) {
      if (row[i] === null) continue;
      if (row[i] < low) low = row[i];
      if (row[i] > high) high = row[i];
    }
  }
  return low > high ? null : [low, high];
}

function legend_table(hooks) {
  const at = el("span"), apart = el("span");
  const heads = [["Line", ""], ["", "number"], ["Unit", "unit"], ["Lowest", "number extra"], ["Highest", "number extra"], ["X1", "number of-cursor"], ["X2", "number of-cursor"], ["X2 − X1", "number of-cursor"], ["", "of-button"]]
    .map(([text, kind], i) => el("th", { scope: "col", class: kind }, i === 1 ? at : i === 8 ? el("span", { class: "unseen" }, "Take away") : text));
  const rows = el("tbody");
  const table = el("table", { class: "grid small legend" }, el("caption", { class: "unseen" }, "Lines of the plot, with their values"), el("thead", {}, el("tr", {}, heads)), rows);
  const node = el("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": "Values of the lines" }, table, apart);
  apart.className = "apart";
  apart.setAttribute("aria-live", "off");
  return {
    node,
    show(lines, view, instant, instant_text, cursors) {
      put(at, instant_text);
      set(table, "data-cursors", String(cursors !== null));
      put(apart, cursors ? `X1 ${time_text(cursors[0], 1)}   X2 ${time_text(cursors[1], 1)}   X2 − X1 ${difference_text(cursors[1] - cursors[0])}${cursors[0] === cursors[1] ? "" : ` (${(1000 / Math.abs(cursors[1] - cursors[0])).toPrecision(3)} Hz)`}` : "");
      apart.hidden = !cursors;
      list(rows, lines.map((line, place) => ({ ...line, place })), (line) => line.key, (line) => legend_row(line, hooks));
      for (const part of rows.kept.values()) part.live(view, instant, cursors);
    },
  };
}

function legend_row(line, hooks) {
  const chip = el("span", { class: "tag" });
  const axis = el("a", { href: `#axis/${line.axis}` });
  const [label, unit] = told(line.name);
  const cells = ["number figure", "number extra", "number extra", "number of-cursor", "number of-cursor", "number of-cursor"].map((kind) => el("td", { class: kind }));
  const away = hooks.remove ? el("button", { type: "button", class: "remove", "aria-label": `Take away axis ${line.axis}, ${label}`, on_click: () => hooks.remove(line.key) }, "×") : null;
  let now = line;
  return {
    node: el("tr", { "data-key": line.key }, el("th", { scope: "row" }, chip, " ", axis, " ", el("span", { class: "what" }, label)), cells[0], el("td", { class: "unit" }, unit), cells.slice(1), el("td", { class: "of-button" }, away)),
    show(next) {
      now = next;
      put(chip, LETTERS[next.place]);
      set(chip, "data-line", next.place + 1);
      put(axis, `${next.axis} ${hooks.axis_name(next.axis)}`);
    },
    live(view, instant, cursors) {
      const value = now.samples.held(instant);
      const extent = now.samples.extent(view.from, view.to);
      const parts = cursors ? between(now.samples, cursors, is_code(now.name)) : null;
      const texts = [shown(now.name, value), shown(now.name, extent?.[0] ?? null), shown(now.name, extent?.[1] ?? null),
                     parts ? shown(now.name, parts.first) : "", parts ? shown(now.name, parts.second) : "", parts ? difference(now.name, parts.difference) : ""];
      texts.forEach((text, i) => put(cells[i], text));
    },
  };
}

/** What the plot shows, for those who do not see it. */
function instants_table() {
  const head = el("tr"), rows = el("tbody");
  const table = el("table", { class: "grid small" }, el("caption", { class: "unseen" }, "What the plot shows, at instants that are equally far apart"), el("thead", {}, head), rows);
  const node = el("details", { class: "panel" }, el("summary", {}, "The same as a table"), el("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": "Table of what the plot shows" }, table));
  let now = null;
  node.addEventListener("toggle", () => now && fill(...now));
  function fill(lines, view) {
    if (!node.open) return;
    list(head, [{ key: "time", label: "Time" }, ...lines], (line) => line.key, (line) => {
      const cell = el("th", { scope: "col", class: line.name ? "number" : "" });
      return { node: cell, show(each) { put(cell, each.name ? `${each.axis} ${told(each.name)[0]} ${told(each.name)[1]}` : each.label); } };
    });
    const step = (view.to - view.from) / TABLE_ROWS;
    rows.replaceChildren(...Array.from({ length: TABLE_ROWS + 1 }, (_, i) => view.from + i * step).map((at) => el("tr", {},
      el("th", { scope: "row" }, time_text(at, Math.min(100, step))), lines.map((line) => el("td", { class: "number" }, shown(line.name, line.samples.held(at)))))));
  }
  return {
    node,
    show(lines, view) {
      now = [lines, view];
      fill(lines, view);
    },
  };
}
