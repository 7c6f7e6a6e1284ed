// SPDX-License-Identifier: Apache-2.0
// Lines over time, in panes that share their time line: the one module that knows the library that draws them (dygraphs), so
// that it can be exchanged. It is given rows, ranges and marks that are made elsewhere (state/); it decides nothing.

import "../lib/dygraph.min.js";
import { el, list, put, set } from "./dom.js";
import { number } from "../format.js";
import { steps, time_marks } from "../state/scale.js";

const { Dygraph } = window;
// Its legend is not wanted: the page has a better one, and it would need styles in attributes.
Dygraph.PLUGINS = [Dygraph.Plugins.Axes, Dygraph.Plugins.Grid];

const LABELS_REM = 4.6, TICK_PX = 4, PER_MARK_REM = 7, LAST_MARK_REM = 2, PER_STEP_PX = 26, LINE_PX = 1.5;
const MOST_WORDS = 24, LONG_WORD = 12;
const rem = () => parseFloat(getComputedStyle(document.documentElement).fontSize);
/** How far its lines are from its edges. */
export const left_px = () => Math.round(LABELS_REM * rem()) + 2 * TICK_PX;
export const right_px = () => Math.round(1.8 * rem());
/** Below each pane, where the next one has its title. */
const below_px = () => Math.round(1.5 * rem());

let colours = null;
window.addEventListener("themechange", () => { colours = null; });

/** A colour of the page's style: "line", "muted", "s1".. */
export function colour(name) {
  colours ??= new Map();
  if (!colours.has(name)) colours.set(name, getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim());
  return colours.get(name);
}

const escaped = (text) => text.replace(/[&<>"]/g, (sign) => `&#${sign.charCodeAt(0)};`);

/** Marks of a value's scale; a code that has words has theirs. */
function value_ticks(low, high, pixels, words) {
  const most = Math.max(2, Math.floor(pixels / PER_STEP_PX));
  if (words) return [...words].filter(([value]) => value >= low && value <= high).slice(0, MOST_WORDS).map(([v, word]) => ({ v, label: escaped(word.length > LONG_WORD ? word.split(" ")[0] : word) }));
  const few = steps(low, high, Math.min(7, most));
  const { found, decimals } = few.found.length > 1 ? few : steps(low, high, most + 2); // a single number is no scale
  return found.map((v) => ({ v, label: number(v, decimals) }));
}

/** Lines at round times; the lowest pane says which. */
function time_ticks(from, to, pixels, has_words) {
  const last = to - ((to - from) * LAST_MARK_REM * rem()) / pixels; // behind it a word would stand over the edge
  return time_marks(from, to, Math.max(1, Math.floor(pixels / (PER_MARK_REM * rem())))).map(({ at, text }) => ({ v: at, label: has_words && at <= last ? text : undefined }));
}

/** One scale with its lines. `shape`: {key, title, words, lines: [{key, letter, place, holds}]}; `place` is its colour's. */
function pane() {
  const title = el("figcaption");
  const holder = el("div", { class: "pane-plot" });
  const tags = el("div", { class: "tags", "aria-hidden": "true" });
  const node = el("figure", { class: "pane" }, title, holder, tags);
  let drawing = null, made_of = "", data = null, shape = null;

  function options() {
    const axis = { axisLabelWidth: Math.round(LABELS_REM * rem()), axisTickSize: TICK_PX, axisLabelFontSize: Math.round(0.857 * rem()) };
    return {
      labels: ["time", ...shape.lines.map((line) => line.key)],
      colors: shape.lines.map((line) => colour(`s${line.place + 1}`)),
      series: Object.fromEntries(shape.lines.map((line) => [line.key, { stepPlot: line.holds }])),
      axes: { x: { ...axis, axisLabelWidth: Math.round(PER_MARK_REM * rem()), ticker: (from, to, pixels) => time_ticks(from, to, pixels, shape.is_last) }, y: { ...axis, ticker: (low, high, pixels) => value_ticks(low, high, pixels, shape.words) } },
      gridLineColor: colour("line"), axisLineColor: colour("faint"), strokeWidth: LINE_PX, pointSize: 1.5,
      connectSeparatedPoints: true, interactionModel: {}, highlightCircleSize: 0, showLabelsOnHighlight: false, rightGap: right_px(), xAxisHeight: below_px(), xRangePad: 0,
      underlayCallback: (pen, area, of) => draw_under(pen, area, of),
    };
  }

  /** A level that somebody asked for, dashed. */
  function draw_under(pen, area, of) {
    for (const level of data?.levels ?? []) {
      const y = Math.round(of.toDomYCoord(level)) + 0.5;
      pen.save();
      pen.strokeStyle = colour("look");
      pen.setLineDash([6, 4]);
      pen.beginPath();
      pen.moveTo(area.x, y);
      pen.lineTo(area.x + area.w, y);
      pen.stroke();
      pen.restore();
    }
  }

  /** The letter of each line where it ends; those that would lie upon each other are pushed apart. */
  function draw_tags() {
    const rows = data.rows;
    const found = shape.lines.map((line, i) => {
      for (let at = rows.length - 1; at >= 0; --at) if (Number.isFinite(rows[at][i + 1])) return [line, rows[at][i + 1]];
      return [line, NaN];
    }).filter(([, value]) => !Number.isNaN(value)).map(([line, value]) => ({ line, y: drawing.toDomYCoord(value) })).sort((a, b) => a.y - b.y);
    const height = 15, most = holder.clientHeight - below_px();
    found.forEach((tag, i) => { tag.y = Math.max(i > 0 ? found[i - 1].y + height : height / 2, tag.y); });
    for (let i = found.length - 1, low = most - height / 2; i >= 0; --i, low -= height) found[i].y = Math.min(found[i].y, low);
    list(tags, found, (tag) => tag.line.key, (tag) => {
      const mark = el("span", { class: "tag", "data-line": tag.line.place + 1 }, tag.line.letter);
      return { node: mark, show(next) { mark.style.top = `${Math.round(next.y)}px`; } };
    });
  }

  return {
    node,
    show(next) { shape = next.shape; data = next; },
    draw(view) {
      put(title, shape.title);
      if (holder.clientWidth === 0 || holder.clientHeight === 0) return;
      const signature = JSON.stringify([shape.lines, shape.is_last, colour("s1"), rem(), Boolean(shape.words)]);
      const rows = data.rows.length > 0 ? data.rows : [[view.from, ...shape.lines.map(() => null)]];
      const now = { file: rows, dateWindow: [view.from, view.to], valueRange: data.range };
      if (signature !== made_of || !drawing) {
        drawing?.destroy();
        drawing = new Dygraph(holder, rows, { ...options(), ...now });
        made_of = signature;
      } else drawing.updateOptions(now);
      draw_tags();
    },
    resize() { drawing?.resize(); },
    close() { drawing?.destroy(); drawing = null; },
  };
}

/** Panes above each other. */
export function graph() {
  const node = el("div", { class: "graph" });
  let before = "";
  const sizes = new ResizeObserver(() => {
    const size = `${node.clientWidth} ${node.clientHeight}`;
    if (size === before) return;
    before = size;
    for (const part of node.kept?.values() ?? []) part.resize();
  });
  sizes.observe(node);
  return {
    node,
    /** Columns of pixels that lines have. */
    columns: () => Math.max(50, Math.round(node.clientWidth - left_px() - right_px())),
    /** panes: [{shape, rows, range: [low, high], levels}]; returns ms that it took. */
    show(panes, view) {
      const begun = performance.now();
      set(node, "data-panes", panes.length);
      const were = new Map(node.kept ?? []);
      list(node, panes, (each) => each.shape.key, pane);
      for (const [key, part] of were) if (!node.kept.has(key)) part.close();
      for (const part of node.kept.values()) part.draw(view);
      return performance.now() - begun;
    },
    close() {
      sizes.disconnect();
      for (const part of node.kept?.values() ?? []) part.close();
    },
  };
}
