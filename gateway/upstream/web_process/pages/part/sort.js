// SPDX-License-Identifier: Apache-2.0
// Headings of a table that sort it, by a button each. Promises aria-sort, and that nothing is sorted anew by itself: what is
// pointed at stays until somebody presses again.

import { el, set } from "./dom.js";
import { draw, glyph } from "./glyphs.js";

/**
 * columns: [{name, label, unit, class, sort: item -> number or text}]; `on_sort(compare)` gets a comparison, or null for the
 * order in which things are by themselves.
 */
export function sortable_head(columns, on_sort) {
  let by = null;
  let down = false;
  const cells = columns.map((column) => {
    const unit = column.unit ? el("span", { class: "unit" }, column.unit) : null;
    if (!column.sort) return { node: el("th", { scope: "col", role: "columnheader", class: column.class }, column.label, unit ? [" ", unit] : []) };
    const mark = glyph("up_down", "sort");
    const node = el("th", { scope: "col", role: "columnheader", class: column.class },
                    el("button", { type: "button", class: "sort", on_click: () => press(column) }, column.label, unit ? [" ", unit] : [], mark));
    return { node, mark, column };
  });
  function press(column) {
    if (by !== column) [by, down] = [column, column.first === "down"];
    else down = !down;
    show();
    const sign = down ? -1 : 1;
    on_sort((a, b) => sign * compare(by.sort(a), by.sort(b)));
  }
  function show() {
    for (const cell of cells) {
      if (!cell.mark) continue;
      const mine = by === cell.column;
      draw(cell.mark, mine ? (down ? "descending" : "ascending") : "up_down");
      set(cell.node, "aria-sort", mine ? (down ? "descending" : "ascending") : null);
    }
  }
  return {
    node: el("thead", { role: "rowgroup" }, el("tr", { role: "row" }, cells.map((cell) => cell.node))),
    clear() {
      by = null;
      show();
    },
  };
}

/** Nothing comes last, numbers before texts. */
export function compare(a, b) {
  const none = (x) => x === null || x === undefined || x === "";
  if (none(a) || none(b)) return none(a) - none(b);
  if (typeof a === "number" && typeof b === "number") return a - b;
  return String(a).localeCompare(String(b), "en", { numeric: true });
}
