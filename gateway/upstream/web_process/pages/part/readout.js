// SPDX-License-Identifier: Apache-2.0
// One value as an instrument shows it: large, with its unit, what it is measured against, and its age when it is old.

import { el, put, set, svg } from "./dom.js";
import { meter, value_mark } from "./parts.js";
import { duration, told, value_text } from "../format.js";
import { reading } from "../state/judge.js";

const BLUR_RPM = 60; // above, a hand that is drawn ten times a second shows nothing

/** The shaft as it stands, seen from its end. */
function dial() {
  const hand = svg("path", { d: "M20 20V5", class: "hand" });
  const way = svg("path", { d: "M20 4.5a15.5 15.5 0 0 1 13.4 7.7M34.6 7.2l-1 5.4-5.2-1.6", class: "way" });
  const ticks = [0, 90, 180, 270].map((turn) => svg("path", { d: "M20 1.5v3", transform: `rotate(${turn} 20 20)` }));
  const node = svg("svg", { class: "dial", viewBox: "0 0 40 40", "aria-hidden": "true" }, svg("circle", { cx: 20, cy: 20, r: 17 }), ticks, hand, way, svg("circle", { cx: 20, cy: 20, r: 2.2, class: "hub" }));
  return {
    node,
    show(position, velocity) {
      const fast = velocity.good && Math.abs(velocity.value) > BLUR_RPM;
      set(node, "data-quality", position.value === null ? "none" : position.good ? "good" : "old");
      set(hand, "transform", `rotate(${((position.value ?? 0) % 1) * 360} 20 20)`);
      hand.style.visibility = fast || position.value === null ? "hidden" : "visible";
      set(way, "transform", velocity.value < 0 ? "matrix(-1 0 0 1 40 0)" : null);
      way.style.visibility = fast ? "visible" : "hidden";
    },
  };
}

// What is asked of a value, by the mode in which the drive works.
const ASKED = {
  position_rev: { 1: "target_position_rev", 8: "target_position_rev" },
  velocity_rpm: { 1: "profile_velocity_rpm", 3: "target_velocity_rpm", 9: "target_velocity_rpm" },
  torque_percent: { 4: "target_torque_percent", 10: "target_torque_percent" },
};

/** What a value is measured against: its full scale, and the name of what is asked. */
function against(name, axis) {
  const value = (of) => axis.values?.[of] ?? null;
  const full = name === "velocity_rpm" ? value("max_velocity_rpm") || axis.rated_speed_rpm || axis.limits?.target_velocity_rpm?.max || null
    : name === "torque_percent" ? value("max_torque_percent") || 100 : null;
  const asked = ASKED[name]?.[value("mode")] ?? null;
  return { full, asked, target: asked === null ? null : value(asked) };
}

export function readout(name) {
  const [label, unit] = told(name);
  const shown = value_mark("span", name, "elsewhere");
  const bar = meter();
  const below = el("p", { class: "below" });
  const shaft = name === "position_rev" ? dial() : null;
  const node = el("div", { class: "readout" }, el("h3", {}, label), el("p", { class: "big" }, shown.node, el("span", { class: "unit" }, unit)), bar.node, below, shaft ? shaft.node : []);
  set(node, "data-name", name);
  return {
    node,
    show() {},
    live(axis, seen) {
      const now = performance.now();
      const read = reading(axis, name, seen, now);
      shown.show(read);
      const { full, asked, target } = against(name, axis);
      const sign = asked === "profile_velocity_rpm" && read.value < 0 ? -1 : 1;
      bar.show(full && read.good ? read.value / full : full ? 0 : null, full && target !== null && seen ? (sign * target) / full : null);
      if (read.value === null) put(below, "no value");
      else if (!read.good) put(below, read.age_ms === null ? "not valid" : `not valid, ${duration(read.age_ms)} old`);
      else put(below, target === null ? "" : `${told(asked)[0].split(" ")[0].toLowerCase()} ${value_text(asked, target)}`);
      set(node, "data-quality", read.value === null ? "none" : read.good ? "good" : "old");
      shaft?.show(read, reading(axis, "velocity_rpm", seen, now));
    },
  };
}
