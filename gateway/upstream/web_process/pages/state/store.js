// SPDX-License-Identifier: Apache-2.0
// What is known of the gateway, as its stream has told it. Promises that a frame is merged as the stream means it: a nested
// object brings what changed, a list replaces the one before. Knows no socket and no element; instants are given to it.

import { History } from "./history.js";

const KEPT_EVENTS = 1000;

// Of these the stream tells the members that changed; everything else it tells whole.
const NESTED = ["values", "last", "limits"];

/** What changed of an axis, into what was known of it. */
export function merge(axis, change) {
  for (const [name, value] of Object.entries(change)) {
    if (NESTED.includes(name) && value && axis[name]) Object.assign(axis[name], value);
    else axis[name] = value;
  }
  return axis;
}

export class Store {
  constructor() {
    this.hello = null;
    this.gateway = null;
    this.buses = [];
    this.axes = new Map();
    this.events = []; // newest last
    this.joined = false;
    this.at = null; // of the newest frame, by the gateway's clock
    this.heard = null; // ms of this page's clock: when that frame came; null: none yet
    this.histories = new Map();
    this.told = null; // behind a `hello`: the axes that were told whole so far
    this.listeners = new Set();
  }

  /** `listener(kind)` is called behind each frame. */
  listen(listener) {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  }

  /** A frame of the stream: its event's name, its data, its id, and when it came. */
  take(kind, data, id, now) {
    if (kind === "hello") this.take_hello(data);
    else if (kind === "axes") this.take_axes(data, now);
    else if (kind === "buses") this.buses = data.buses ?? [];
    else if (kind === "gateway") this.take_gateway(data);
    else if (kind === "event") this.take_events([data]);
    else if (kind !== "scope" && kind !== "capture") return; // those are the pages' that listen
    for (const listener of this.listeners) listener(kind, data);
  }

  /** A stream is opened: until it tells of axes, nothing that is known is what is. */
  begin() {
    this.joined = false;
  }

  take_hello(data) {
    if (this.hello && this.hello.boot !== data.boot) {
      this.events = []; // numbers begin anew with each start of the gateway
      this.gateway = null;
    }
    this.hello = data;
    this.told = new Set();
  }

  /** The first one behind a `hello` comes when all axes were told. */
  take_gateway(data) {
    this.gateway = data;
    if (this.told) for (const number of this.axes.keys()) if (!this.told.has(number)) this.axes.delete(number);
    this.told = null;
  }

  take_axes(data, now) {
    const told = data.axes ?? [];
    this.at = data.at ?? this.at;
    this.heard = now;
    if (data.joined !== undefined) this.joined = data.joined;
    for (const axis of told) {
      const known = this.told && !this.told.has(axis.axis) ? null : this.axes.get(axis.axis);
      this.told?.add(axis.axis);
      if (known) merge(known, axis).taken = now;
      else this.axes.set(axis.axis, { ...axis, taken: now });
    }
    for (const axis of this.axes.values()) this.history(axis.axis).add(now, axis.values ?? {});
  }

  /** Those that are known already are left out: ids are unique. */
  take_events(events) {
    const known = new Set(this.events.map((event) => event.id));
    const fresh = events.filter((event) => !known.has(event.id));
    if (fresh.length === 0) return;
    this.events = [...this.events, ...fresh].sort((a, b) => a.number - b.number).slice(-KEPT_EVENTS);
  }

  history(number) {
    if (!this.histories.has(number)) this.histories.set(number, new History());
    return this.histories.get(number);
  }

  sorted_axes() {
    return [...this.axes.values()].sort((a, b) => a.axis - b.axis);
  }
}
