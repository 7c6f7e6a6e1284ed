// SPDX-License-Identifier: Apache-2.0
// What a scope waits for: line, crossing, level, where in the window it shall stand, once or again.

import { el, list, put, set } from "./dom.js";
import { told } from "../format.js";
import { KINDS, takes_bit } from "../state/trigger.js";
import { is_bits, is_code, parsed } from "../state/series.js";

const MOST_BIT = 31;

/** hooks: lines() are keys; name(key); arm(wanted), stop(); changed(wanted or null): what stands in the form. */
export function trigger_form(hooks, begun) {
  const series = el("select", { id: "trigger-line", on_change: changed });
  const kind = el("select", { id: "trigger-kind", on_change: changed }, Object.entries(KINDS).map(([name, text]) => el("option", { value: name }, text)));
  const level = el("input", { id: "trigger-level", type: "number", step: "any", value: "0", on_input: changed });
  const unit = el("span", { class: "unit" });
  const position = el("input", { id: "trigger-position", type: "range", min: 0, max: 100, step: 5, value: 20, on_input: changed });
  const shown_position = el("output", { for: "trigger-position" });
  const again = el("input", { id: "trigger-again", type: "checkbox", on_change: changed });
  const hold_off = el("input", { id: "trigger-hold-off", type: "number", min: 0, max: 3600, step: "any", value: "0", on_input: changed });
  const arm = el("button", { type: "submit", class: "button accent", id: "arm" }, "Arm");
  const stop = el("button", { type: "button", class: "button", on_click: () => hooks.stop() }, "Stop");
  const said = el("p", { class: "said", role: "status", id: "trigger-state" });
  const field = (text, ...parts) => el("div", { class: "field" }, el("label", { for: parts[0].id }, text), parts);
  const node = el("form", { class: "trigger", on_submit: submit }, field("When", series), field("Crossing", kind), field("Level", level, unit), field("Stands at", position, shown_position),
    field("Again", again), field("Then not for", hold_off, el("span", { class: "unit" }, "s")), el("div", { class: "buttons" }, arm, stop), said);
  let wanted_line = begun?.series ?? "";
  if (begun) {
    kind.value = begun.kind;
    level.value = String(begun.level);
    position.value = String(begun.position * 100);
    again.checked = begun.again;
    hold_off.value = String(begun.hold_off_ms / 1000);
  }

  /** null: it is not whole, which is said beside the field. */
  function wanted() {
    const bit = takes_bit(kind.value);
    const number = level.value.trim() === "" ? NaN : Number(level.value);
    const fits = Number.isFinite(number) && (!bit || (Number.isInteger(number) && number >= 0 && number <= MOST_BIT));
    level.setCustomValidity(fits ? "" : bit ? `a bit is 0 to ${MOST_BIT}` : "a number");
    const seconds = Number(hold_off.value);
    if (!series.value || !fits || !(seconds >= 0 && seconds <= 3600)) return null;
    return { series: series.value, kind: kind.value, level: number, position: Number(position.value) / 100, again: again.checked, hold_off_ms: seconds * 1000 };
  }
  function changed() {
    if (series.value) wanted_line = series.value;
    show_fields();
    hooks.changed(wanted());
  }
  function submit(event) {
    event.preventDefault();
    const now = wanted();
    if (now) hooks.arm(now);
    else node.reportValidity();
  }
  function show_fields() {
    const name = parsed(series.value)?.name;
    put(unit, takes_bit(kind.value) ? "bit" : name ? told(name)[1] : "");
    put(shown_position, `${position.value} %`);
    hold_off.parentNode.hidden = !again.checked;
    set(level, "max", takes_bit(kind.value) ? MOST_BIT : null);
  }
  return {
    node, wanted,
    /** state: "idle" or of a Trigger; text says it. */
    show(state, text) {
      list(series, hooks.lines(), (key) => key, (key) => {
        const option = el("option", { value: key });
        return { node: option, show() { put(option, hooks.name(key)); } };
      });
      if (wanted_line && series.value !== wanted_line && hooks.lines().includes(wanted_line)) {
        series.value = wanted_line;
      }
      const name = parsed(series.value)?.name;
      for (const option of kind.options) option.hidden = takes_bit(option.value) && Boolean(name) && !is_bits(name) && !is_code(name);
      show_fields();
      const armed = state === "waiting" || state === "filling";
      arm.disabled = hooks.lines().length === 0;
      stop.hidden = !armed;
      put(arm, armed ? "Arm anew" : "Arm");
      set(node, "data-state", state);
      put(said, text);
    },
  };
}
