// SPDX-License-Identifier: Apache-2.0
// How much an axis asks for somebody's attention, and what of it moves. Pure. The words are the gateway's; their weight is
// that of `axisgate top`, but for alarms that tell how a machine is built, which stand there always.

export const ACT = 0, LOOK = 1, CALM = 2;

const OUT_OF_REACH = ["offline", "link_down"];
const STANDING_ALARMS = ["no_comm_watchdog", "not_homed", "cannot_deenergise"];
const MOTIONS = ["discrete motion", "continuous motion", "homing"];

export const is_faulted = (axis) => axis.axis_state === "error stop" || Boolean(axis.fault);
export const is_out_of_reach = (axis) => OUT_OF_REACH.includes(axis.link_state);
export const is_moving = (axis) => MOTIONS.includes(axis.axis_state) || (axis.inputs ?? []).includes("moving");
export const is_standing_alarm = (word) => STANDING_ALARMS.includes(word);

export function attention(axis) {
  if (is_faulted(axis) || is_out_of_reach(axis)) return ACT;
  if (["suspect", "setup", "unknown"].includes(axis.link_state)) return LOOK;
  if (["stopping", "latched", "unknown"].includes(axis.axis_state)) return LOOK;
  return (axis.alarms ?? []).some((alarm) => !is_standing_alarm(alarm.word)) ? LOOK : CALM;
}

/** Smaller is worse: what somebody must do, what somebody should look at, what moves, the rest. */
export function rank(axis) {
  if (is_faulted(axis)) return 0;
  if (is_out_of_reach(axis)) return 1;
  if (attention(axis) === LOOK) return 2;
  return is_moving(axis) ? 3 : 4;
}

/** Since an axis was told of, its values have become older. */
export const held_ms = (axis, now) => Math.max(0, now - axis.taken);

/**
 * A value, and whether it may be believed: {value, good, age_ms}. age_ms is null where nothing tells it. `seen`: the gateway
 * is heard.
 */
export function reading(axis, name, seen, now) {
  const value = axis.values?.[name] ?? null;
  if (value !== null && seen) return { value, good: !is_speed_of_before(axis, name, value), age_ms: axis.age_ms ?? null };
  const last = value !== null ? { value, age_ms: axis.age_ms } : axis.last?.[name];
  const age = last?.age_ms ?? null;
  return { value: last?.value ?? null, good: false, age_ms: age === null ? null : age + held_ms(axis, now) };
}

/** Of the oldest value that is polled. */
export function age_of(axis, seen, now) {
  if (typeof axis.age_ms !== "number") return null;
  return seen && !is_out_of_reach(axis) ? axis.age_ms : axis.age_ms + held_ms(axis, now);
}

/** Beside "standstill" a speed is that of before: it is read less often than the state. */
function is_speed_of_before(axis, name, value) {
  return name === "velocity_rpm" && axis.axis_state === "standstill" && Math.abs(value) >= 1;
}

/** What somebody should know first of this axis, worst first: [{title, text, remedy, level}]; level is as `rank` counts. */
export function troubles(axis) {
  const found = [];
  const add = (level, title, text, remedy) => {
    if (!found.some((one) => one.title === title)) found.push({ level, title, text: text ?? "", remedy: remedy ?? "" });
  };
  if (axis.fault) add(0, axis.fault.text || "fault", axis.fault.cause, axis.fault.remedy);
  else if (axis.axis_state === "error stop") add(0, "fault", "its cause is being read", "");
  const of_link = (axis.blocked_by ?? []).find((one) => one.word === axis.link_state);
  if (is_out_of_reach(axis) || axis.link_state === "suspect") add(is_out_of_reach(axis) ? 1 : 2, axis.link_state.replace("_", " "), of_link?.text, of_link?.remedy);
  for (const alarm of axis.alarms ?? []) if (!is_standing_alarm(alarm.word)) add(2, alarm.word.replaceAll("_", " "), alarm.meaning, alarm.remedy);
  return found;
}

/** A few words for the end of a line. */
export function remark(axis) {
  const alarms = (axis.alarms ?? []).map((alarm) => alarm.word.replaceAll("_", " "));
  const standing = (word) => is_standing_alarm(word.replaceAll(" ", "_"));
  const sorted = [...alarms.filter((word) => !standing(word)), ...alarms.filter(standing)];
  const first = axis.fault ? [axis.fault.text || "fault"] : is_out_of_reach(axis) ? (axis.blocked_by ?? []).map((one) => one.text) : [];
  return [...first, ...sorted].join(", ");
}

/** "2 faulted", "1 out of reach", ...: [word, how many, tone], those that are none left out. */
export function sums(axes) {
  const rows = [
    ["faulted", axes.filter(is_faulted).length, "act"],
    ["out of reach", axes.filter((axis) => is_out_of_reach(axis) && !is_faulted(axis)).length, "act"],
    ["latched", axes.filter((axis) => axis.axis_state === "latched").length, "look"],
    ["moving", axes.filter((axis) => is_moving(axis) && !is_faulted(axis) && !is_out_of_reach(axis)).length, "move"],
    ["owned", axes.filter((axis) => axis.owner).length, "calm"],
  ];
  return rows.filter(([, how_many]) => how_many > 0);
}

export function tone_of_state(axis) {
  if (is_faulted(axis) || is_out_of_reach(axis)) return "act";
  if (["stopping", "latched", "unknown"].includes(axis.axis_state)) return "look";
  return is_moving(axis) ? "move" : axis.axis_state === "disabled" ? "dim" : "calm";
}

export function tone_of_link(link_state) {
  if (OUT_OF_REACH.includes(link_state) || link_state === "down") return "act";
  return link_state === "online" || link_state === "up" ? "dim" : "look";
}
