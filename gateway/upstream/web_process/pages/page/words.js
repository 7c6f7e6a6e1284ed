// SPDX-License-Identifier: Apache-2.0
// The words: what each number and name that the gateway shows means, what causes it, what helps. The same as `axisgate explain`.

import { get } from "../api.js";
import { el, list, put, say } from "../part/dom.js";
import { hex, spoken } from "../format.js";

const plain = (text) => String(text ?? "").toLowerCase().replace(/[_-]/g, " ");

let words = null; // they do not change while the gateway runs as it is

export function open(context, searched) {
  let explained = null; // what the gateway found for a search that finds nothing here
  let asked = "";
  const text = el("input", { type: "search", placeholder: "Name, number, 0x…", "aria-label": "Search the words", on_input: show });
  text.value = searched ?? "";
  const kind = el("select", { "aria-label": "Kind", on_change: show }, el("option", { value: "" }, "Every kind"));
  const rows = el("tbody", { role: "rowgroup" });
  const heads = [["Word"], ["Kind"], ["Number", "number"], ["Meaning"], ["Causes"], ["Remedy"]].map(([label, of]) => el("th", { scope: "col", role: "columnheader", class: of }, label));
  const table = el("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": "Table of words" },
    el("table", { class: "grid small words", role: "table" }, el("caption", { class: "unseen" }, "What each word means"), el("thead", { role: "rowgroup" }, el("tr", { role: "row" }, heads)), rows));
  table.hidden = true;
  const said = el("p", { class: "plain" }, "Waiting for the gateway …");
  const counted = el("p", { class: "hint" });
  const node = el("div", { class: "page" }, el("div", { class: "page-head" }, el("h1", {}, "Words"), counted, el("div", { class: "tools" }, kind, text)), table, said);

  function fill() {
    if (kind.options.length === 1) for (const name of new Set(words.map((word) => word.kind))) kind.append(el("option", { value: name }, spoken(name)));
    show();
  }
  if (words) fill();
  else get("words").then((body) => { words = body.words ?? []; fill(); }, (refusal) => put(said, refusal.message));

  function number_of(word) {
    if (typeof word.number !== "number") return String(word.number);
    if (word.kind === "term") return "";
    if (word.kind === "ErrorID") return `16#${hex(word.number, 4).slice(2)}`;
    return word.kind.startsWith("abort") ? hex(word.number, 8) : word.kind.startsWith("error") ? hex(word.number, 4) : String(word.number);
  }

  function show() {
    if (!words) return;
    const wanted = plain(text.value.trim());
    const all = words.filter((word) => kind.value === "" || word.kind === kind.value);
    const typed = /^(0x[0-9a-f]+|\d+)$/.test(wanted) ? Number(wanted) : null;
    const hits = (word) => plain(word.name).includes(wanted) || plain(`${word.kind} ${number_of(word)} ${word.meaning} ${word.causes} ${word.remedy}`).includes(wanted) || word.number === typed;
    const weight = (word) => (plain(word.name) === wanted || word.number === typed ? 0 : plain(word.name).startsWith(wanted) ? 1 : plain(word.name).includes(wanted) ? 2 : 3);
    let found = wanted === "" ? all : all.filter(hits).map((word, at) => [weight(word), at, word]).sort((a, b) => a[0] - b[0] || a[1] - b[1]).map(([, , word]) => word);
    if (found.length === 0 && wanted !== "") {
      if (explained?.q === wanted) found = explained.found;
      else explain(wanted);
    }
    list(rows, found, (word) => `${word.kind} ${word.number} ${word.name}`, word_row);
    table.hidden = found.length === 0;
    said.hidden = found.length > 0;
    put(said, "Nothing is called so.");
    put(counted, `${found.length} of ${words.length}`);
  }

  /** The gateway knows classes of error codes, too. */
  async function explain(wanted) {
    if (asked === wanted) return;
    asked = wanted;
    try {
      const body = await get(`explain?q=${encodeURIComponent(wanted)}`);
      explained = { q: wanted, found: body.found ?? [] };
      if (asked === wanted && explained.found.length > 0) show();
    } catch { /* what stands there stays true: nothing here is called so */ }
  }

  function word_row(word) {
    const cells = [["meaning", word.meaning], ["causes", word.causes], ["remedy", word.remedy]].map(([name, text]) => {
      const cell = el("td", { role: "cell", class: "text", "data-label": name });
      say(cell, text);
      return cell;
    });
    return { node: el("tr", { role: "row" }, el("th", { scope: "row", role: "rowheader" }, spoken(word.name)), el("td", { role: "cell", class: "kind" }, spoken(word.kind)), el("td", { role: "cell", class: "number" }, number_of(word)), cells), show() {} };
  }

  return { node, update() {}, title: () => "Words" };
}
