// SPDX-License-Identifier: Apache-2.0
// Which lines are drawn: a list of what there is, searched as it is typed.

import { el, list, put } from "./dom.js";
import { told } from "../format.js";
import { MOST, searched } from "../state/series.js";

const SHOWN = 60;

/** hooks: all() are choices; chosen() are keys; toggle(key); name(choice) is what it is of, empty: that is plain. */
export function line_picker(hooks) {
  const text = el("input", { type: "search", placeholder: "Axis, value, drive, bus", "aria-label": "Search what can be drawn", on_input: () => show(true) });
  const rows = el("ul", { class: "choices" });
  const said = el("p", { class: "hint", role: "status" });
  const node = el("div", { class: "picker" }, text, said, rows);
  let before = "";
  function show(anew) {
    const chosen = hooks.chosen(), all = hooks.all();
    const now = `${chosen.join()} ${all.length} ${all[0]?.key} ${text.value}`;
    if (!anew && now === before) return;
    before = now;
    const found = searched(all, text.value);
    const first = found.filter((one) => chosen.includes(one.key));
    const shown = [...first, ...found.filter((one) => !chosen.includes(one.key))].slice(0, Math.max(SHOWN, first.length));
    list(rows, shown, (one) => one.key, (one) => choice(one));
    for (const part of rows.kept.values()) part.live(chosen);
    put(said, chosen.length >= MOST ? `${MOST} lines at most: take one away first` : found.length === 0 ? "Nothing is called so." : `${chosen.length} chosen · ${found.length > shown.length ? `${shown.length} of ${found.length}` : found.length} shown`);
  }
  function choice(one) {
    const box = el("input", { type: "checkbox", on_change: () => hooks.toggle(one.key) });
    const of = hooks.name(one);
    const [label, unit] = told(one.name);
    return {
      node: el("li", {}, el("label", {}, box, el("span", { class: "of" }, of), el("span", {}, label), el("span", { class: "unit" }, unit))),
      show() {},
      live(chosen) {
        box.checked = chosen.includes(one.key);
        box.disabled = !box.checked && chosen.length >= MOST;
      },
    };
  }
  return { node, show: () => show(false), field: text };
}
