// SPDX-License-Identifier: Apache-2.0
// The Modbus register map of this configuration, searchable. It is asked for by axis: all of 499 would be a large answer.

import { get } from "../api.js";
import { el, list, put } from "../part/dom.js";

const SHOWN_AT_ONCE = 400;

export function open(context, which) {
  const { store } = context;
  let rows = [];
  let loaded = null;
  let most = SHOWN_AT_ONCE;
  let wanted = which ?? "";
  const axis = el("select", { "aria-label": "Axis", on_change: () => { wanted = axis.value; load(); } });
  const table_kind = el("select", { "aria-label": "Table", on_change: show }, [["", "Every table"], ["holding", "Registers"], ["coil", "Coils"], ["discrete", "Discrete inputs"]].map(([value, label]) => el("option", { value }, label)));
  const text = el("input", { type: "search", placeholder: "Name or address", "aria-label": "Show only rows with this text", on_input: () => { most = SHOWN_AT_ONCE; show(); } });
  const csv = el("a", { class: "button", download: true }, "CSV");
  const body = el("tbody", { role: "rowgroup" });
  const heads = [["Address", "number"], ["Name"], ["Table"], ["Type"], ["Unit"], ["Access"], ["On this drive", ""]].map(([label, kind]) => el("th", { scope: "col", role: "columnheader", class: kind }, label));
  const table = el("table", { class: "grid small map", role: "table" }, el("caption", { class: "unseen" }, "Register map"), el("thead", { role: "rowgroup" }, el("tr", { role: "row" }, heads)), body);
  const scroll = el("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": "Register map" }, table);
  const said = el("p", { class: "plain" });
  const hint = el("p", { class: "hint" });
  const more = el("button", { type: "button", class: "button", on_click: () => { most += SHOWN_AT_ONCE; show(); } }, "More rows");
  const node = el("div", { class: "page" }, el("div", { class: "page-head" }, el("h1", {}, "Register map"), hint, el("div", { class: "tools" }, axis, table_kind, text, csv)), scroll, said, more);

  async function load() {
    const asked = wanted;
    loaded = asked;
    csv.setAttribute("href", `api/v1/map?axis=${encodeURIComponent(asked)}&format=csv`);
    csv.setAttribute("download", `axisgate-axis-${asked}.csv`);
    try {
      const answer = await get(`map?axis=${encodeURIComponent(asked)}`);
      if (loaded !== asked) return;
      rows = answer.rows ?? answer.entries ?? [];
      put(hint, `Addresses count from 0${answer.word_order ? `, 32-bit values ${answer.word_order.replace("-first", "")} word first` : ""}`);
      show();
    } catch (refusal) {
      rows = [];
      show();
      put(said, refusal.message);
    }
  }

  function show() {
    const searched = text.value.trim().toLowerCase();
    const found = rows.filter((row) => (table_kind.value === "" || row.table === table_kind.value)
      && (searched === "" || `${row.address} ${row.name} ${row.meaning ?? row.note ?? ""}`.toLowerCase().includes(searched)));
    list(body, found.slice(0, most), (row) => `${row.table} ${row.address} ${row.name} ${row.axis}`, map_row);
    scroll.hidden = found.length === 0;
    more.hidden = found.length <= most;
    said.hidden = found.length > 0;
    put(said, rows.length === 0 ? "Waiting for the gateway …" : "No row is like that.");
  }

  return {
    node,
    update() {
      const axes = store.sorted_axes();
      if (axes.length > 0 && axis.options.length !== axes.length) {
        axis.replaceChildren(...axes.map((each) => el("option", { value: String(each.axis) }, `Axis ${each.axis} ${each.name}`)));
        if (!axes.some((each) => String(each.axis) === wanted)) wanted = String(axes[0].axis);
        axis.value = wanted;
      }
      if (wanted !== "" && loaded !== wanted && axes.length > 0) load();
    },
    title: () => "Register map",
  };
}

function map_row(row) {
  const name = el("th", { scope: "row", role: "rowheader" }, row.name);
  const meaning = row.meaning ?? row.note;
  if (meaning) name.append(el("p", { class: "hint" }, meaning));
  const size = row.count > 1 ? `${row.address}–${row.address + row.count - 1}` : String(row.address);
  const cells = [["number", size], ["", row.table === "holding" ? "register" : row.table === "discrete" ? "discrete input" : row.table], ["", row.type], ["unit", row.unit], ["", row.access === "rw" ? "read, write" : "read"], ["", row.supported ? "yes" : "no"]]
    .map(([kind, text], at) => el("td", { role: "cell", class: kind, "data-label": ["address", "table", "type", "unit", "access", "this drive"][at] }, text ?? ""));
  return { node: el("tr", { role: "row", "data-absent": !row.supported }, cells[0], name, cells.slice(1)), show() {} };
}
