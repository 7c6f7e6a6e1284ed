// SPDX-License-Identifier: Apache-2.0
// Lines of a scope by name: "3.velocity_rpm" is a quantity, or a state, of an axis. Pure. Promises that a text that is only
// nearly such a name is none.

import { told } from "../format.js";

export const MOST = 16; // lines at once, as the gateway answers them
export const LETTERS = "ABCDEFGHIJKLMNOP"; // a line's name on the picture, so that none is told by its colour alone

/** What is no value and has a line all the same. */
export const STATES = ["axis_state", "motion_state", "link_state", "alarms"];
const ALONE = ["following_error_rev"];
const SET = /^(target|profile|max|homing|quick_stop|position_limit)_/;
const BITS = ["statusword", "controlword", "inputs", "outputs", "alarms"];
// What a person asks for first.
const FIRST = ["velocity_rpm", "target_velocity_rpm", "position_rev", "target_position_rev", "torque_percent", "current_a", "following_error_rev", "axis_state"];
/** Of an axis, as a capture shows it at first. */
export const MAIN = ["velocity_rpm", "target_velocity_rpm", "position_rev", "current_a", "following_error_rev"];
// Below this range a line is not stretched over its pane: it would be noise.
const LEAST = { rev: 0.01, rpm: 2, "rpm/s": 10, "%": 2, A: 0.2, V: 2, "°C": 2 };

export function parsed(text) {
  const parts = /^([1-9]\d{0,4})\.([a-z][a-z0-9_]{0,47})$/.exec(text ?? "");
  return parts ? { key: text, axis: Number(parts[1]), name: parts[2] } : null;
}

/** The first MOST of "1.velocity_rpm,2.position_rev" that are names, each once. */
export function listed(text) {
  const found = (text ?? "").split(",").filter(parsed);
  return [...new Set(found)].slice(0, MOST);
}

export const is_code = (name) => told(name)[1] === "";
/** Codes and states, and what somebody sets: it is what it was until it is another one, with nothing between. */
export const holds = (name) => is_code(name) || SET.test(name);
export const is_bits = (name) => BITS.includes(name);

/** What is drawn on one scale: quantities of one unit; a code has a scale of its own, and what is small beside its unit's others. */
export const pane_of = (name) => (is_code(name) || ALONE.includes(name) ? name : told(name)[1]);
export const least_of = (name) => LEAST[told(name)[1]] ?? 1;

/** Of these, those of an axis that were asked for first in front. */
export function by_use(names) {
  const place = (name) => (FIRST.includes(name) ? FIRST.indexOf(name) : FIRST.length);
  return [...names].sort((a, b) => place(a) - place(b));
}

/** All lines of these axes: [{key, axis, name, text}]; `text` is what a search looks into. */
export function choices(axes) {
  return axes.flatMap((axis) => by_use([...(axis.supported ?? Object.keys(axis.values ?? {})), ...STATES.filter((name) => !(axis.supported ?? []).includes(name))])
    .map((name) => ({ key: `${axis.axis}.${name}`, axis: axis.axis, name, text: `${axis.axis} ${axis.name} ${told(name)[0]} ${told(name)[1]} ${name} ${axis.drive ?? ""} ${axis.bus ?? ""}`.toLowerCase() })));
}

/** Those in which every word of `wanted` stands. */
export function searched(all, wanted) {
  const words = wanted.toLowerCase().split(/\s+/).filter(Boolean);
  return words.length === 0 ? all : all.filter((one) => words.every((word) => one.text.includes(word)));
}
