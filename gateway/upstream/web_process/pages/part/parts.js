// SPDX-License-Identifier: Apache-2.0
// Small parts that several pages have: a state with its glyph, a value with its quality, a list of facts, a notice.

import { el, list, put, set } from "./dom.js";
import { draw, glyph } from "./glyphs.js";
import { DASH, duration, value_text } from "../format.js";

/** A word with its shape; `tone` is "act", "look", "move", "calm" or "dim". */
export function state_mark(class_name = "state") {
  const shape = glyph("unknown");
  const word = el("span");
  const node = el("span", { class: class_name }, shape, word);
  return {
    node,
    show(name, tone, text = name) {
      draw(shape, name);
      put(word, text);
      set(node, "data-tone", tone);
    },
  };
}

/**
 * A value in place: good, or grey with its age behind it. `age` is where the age goes: "beside" it, or nowhere since the line
 * has a place of its own for it ("elsewhere").
 */
export function value_mark(tag, name, age = "beside") {
  const shown = el("span", { class: "figure" });
  const since = el("span", { class: "since" });
  const node = el(tag, { class: "value" }, shown, since);
  return {
    node,
    show(reading) {
      const old = !reading.good && reading.value !== null;
      put(shown, reading.value === null ? DASH : value_text(name, reading.value));
      put(since, old && age === "beside" ? duration(reading.age_ms) : "");
      set(node, "data-quality", reading.value === null ? "none" : old ? "old" : "good");
      set(node, "title", old ? (reading.age_ms === null ? "not valid: what it was last" : `not valid: it was so ${duration(reading.age_ms)} ago`) : null);
    },
  };
}

/** Terms and what they are: facts.show([[term, text or node]]). Texts are changed in place. */
export function facts(class_name = "facts") {
  const node = el("dl", { class: class_name });
  return {
    node,
    show(rows) {
      list(node, rows.filter(Boolean), (row) => row[0], (row) => {
        const what = el("dd");
        return {
          node: el("div", {}, el("dt", {}, row[0]), what),
          show([, text]) {
            if (text instanceof Node) {
              if (what.firstChild !== text) what.replaceChildren(text);
            } else put(what, text ?? DASH);
          },
        };
      });
    },
  };
}

/** A line across the page: what it is, what it means, what helps. */
export function notice(tone, title, text = "", link = null) {
  return el("p", { class: "strip", "data-tone": tone }, glyph(tone === "act" ? "error stop" : "warning"),
            el("span", {}, el("strong", {}, title), text ? ` ${text}` : "", link ? [" ", link] : []));
}

export function section(title, ...children) {
  const heading = el("h2", {}, title);
  return el("section", { class: "panel" }, heading, ...children);
}

export function bad_news(message) {
  return el("p", { class: "plain", role: "alert" }, message);
}

/** A thin bar from zero to both sides, -1..1, with a mark for what is asked; null: not there. */
export function meter() {
  const fill = el("i");
  const mark = el("b");
  const node = el("span", { class: "meter", "aria-hidden": "true" }, fill, mark);
  return {
    node,
    show(share, asked = null) {
      node.hidden = share === null;
      if (share === null) return;
      const clipped = Math.max(-1, Math.min(1, share));
      fill.style.left = `${clipped < 0 ? 50 + clipped * 50 : 50}%`;
      fill.style.width = `${Math.abs(clipped) * 50}%`;
      set(node, "data-over", Math.abs(share) > 1);
      mark.hidden = asked === null;
      if (asked !== null) mark.style.left = `${50 + Math.max(-1, Math.min(1, asked)) * 50}%`;
    },
  };
}

/** A bar from the left, 0..1, with a tick where it was planned to end. */
export function load_bar() {
  const fill = el("i");
  const tick = el("b");
  const node = el("span", { class: "load", "aria-hidden": "true" }, fill, tick);
  return {
    node,
    show(share, planned, tone) {
      fill.style.width = `${Math.max(0, Math.min(1, share ?? 0)) * 100}%`;
      tick.hidden = planned === null;
      if (planned !== null) tick.style.left = `${Math.max(0, Math.min(1, planned)) * 100}%`;
      set(node, "data-tone", tone);
    },
  };
}
