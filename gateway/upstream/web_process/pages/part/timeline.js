// SPDX-License-Identifier: Apache-2.0
// What a hand does on a plot: wheel, drag, pinch and keys move its view; two cursors; marks at instants. It lies over the plot and
// knows nothing of what draws it. Promises that all of it can be done by keyboard, and that a finger still scrolls the page.

import { el, list, put, set } from "./dom.js";
import { left_px, right_px } from "./graph.js";
import { time_text } from "../state/scale.js";
import { shifted, zoomed } from "../state/view.js";
import { moved } from "../state/cursors.js";

const WHEEL = 0.0016, KEY_ZOOM = 1.5, KEY_MOVE = 0.1, DRAGGED_PX = 5;
const HELP = "Plot. Arrow keys move in time, plus and minus zoom, Space pauses and goes on, C sets cursors, Home and End go to the oldest and the newest.";

/**
 * hooks: view() is {from, to}; change(view) is what a hand wants; cursor(i, at); point(at or null); command("toggle", "cursors",
 * "oldest" or "newest").
 */
export function timeline(plot, hooks) {
  const band = el("i", { class: "band" });
  const pointer = el("i", { class: "pointer" });
  const marks = el("div", { class: "marks" });
  const handles = [0, 1].map((i) => cursor(i));
  const over = el("div", { class: "over", tabindex: 0, role: "application", "aria-label": HELP }, band, pointer, marks);
  const rack = el("div", { class: "cursors" }, handles.map((handle) => handle.node));
  const node = el("div", { class: "timeline" }, plot, over, rack);
  const held = new Map(); // pointers that are down: id, x
  let begun = null; // {x, view, how}
  band.hidden = pointer.hidden = true;

  const width = () => Math.max(1, over.clientWidth);
  const x_of = (event) => event.clientX - over.getBoundingClientRect().left;
  const share_of = (at) => (at - hooks.view().from) / (hooks.view().to - hooks.view().from);
  const at_of = (x, view = hooks.view()) => view.from + (x / width()) * (view.to - view.from);

  over.addEventListener("wheel", (event) => {
    event.preventDefault();
    const by = event.deltaMode === 1 ? 16 : 1;
    if (event.shiftKey || Math.abs(event.deltaX) > Math.abs(event.deltaY)) hooks.change(shifted(hooks.view(), ((event.deltaX || event.deltaY) * by) / width()));
    else hooks.change(zoomed(hooks.view(), at_of(x_of(event)), Math.exp(event.deltaY * by * WHEEL)));
  }, { passive: false });
  over.addEventListener("dblclick", (event) => hooks.change(zoomed(hooks.view(), at_of(x_of(event)), 2)));

  over.addEventListener("pointerdown", (event) => {
    if (event.button > 1) return;
    over.setPointerCapture(event.pointerId);
    held.set(event.pointerId, x_of(event));
    begin(event);
    if (event.button === 1) event.preventDefault();
  });
  /** One finger moves, two pinch; a mouse marks what to see, and moves with Shift or its middle button. */
  function begin(event) {
    const how = held.size > 1 ? "pinch" : event.pointerType === "touch" || event.shiftKey || event.button === 1 ? "move" : "mark";
    begun = { x: x_of(event), view: hooks.view(), how, at: new Map(held) };
  }
  over.addEventListener("pointermove", (event) => {
    const x = x_of(event);
    if (event.pointerType !== "touch") hooks.point(at_of(x));
    if (!held.has(event.pointerId) || !begun) return;
    held.set(event.pointerId, x);
    if (begun.how === "move") hooks.change(shifted(begun.view, (begun.x - x) / width()));
    else if (begun.how === "pinch") pinch();
    else show_band(x);
  });
  function pinch() {
    const [first, second] = held.keys();
    const [a, b] = [begun.at.get(first), begun.at.get(second)];
    const [now_a, now_b] = [held.get(first), held.get(second)];
    if (a === undefined || b === undefined || Math.abs(now_a - now_b) < DRAGGED_PX) return;
    const factor = Math.abs(a - b) / Math.abs(now_a - now_b);
    const wide = zoomed(begun.view, at_of((a + b) / 2, begun.view), factor);
    hooks.change(shifted(wide, ((a + b) / 2 - (now_a + now_b) / 2) / width()));
  }
  function show_band(x) {
    band.hidden = Math.abs(x - begun.x) < DRAGGED_PX;
    band.style.left = `${Math.max(0, Math.min(x, begun.x))}px`;
    band.style.width = `${Math.min(width(), Math.max(x, begun.x)) - Math.max(0, Math.min(x, begun.x))}px`;
  }
  function release(event, taken) {
    if (!held.delete(event.pointerId) || !begun) return;
    const x = Math.max(0, Math.min(width(), x_of(event)));
    if (taken && begun.how === "mark" && Math.abs(x - begun.x) >= DRAGGED_PX) hooks.change({ from: at_of(Math.min(x, begun.x)), to: at_of(Math.max(x, begun.x)) });
    band.hidden = true;
    begun = null;
  }
  over.addEventListener("pointerup", (event) => release(event, true));
  over.addEventListener("pointercancel", (event) => release(event, false));
  over.addEventListener("pointerleave", () => hooks.point(null));

  over.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const view = hooks.view(), middle = (view.from + view.to) / 2;
    const far = event.shiftKey ? 5 : 1;
    const does = {
      ArrowLeft: () => hooks.change(shifted(view, -KEY_MOVE * far)), ArrowRight: () => hooks.change(shifted(view, KEY_MOVE * far)),
      "+": () => hooks.change(zoomed(view, middle, 1 / KEY_ZOOM)), "-": () => hooks.change(zoomed(view, middle, KEY_ZOOM)),
      Home: () => hooks.command("oldest"), End: () => hooks.command("newest"), " ": () => hooks.command("toggle"), c: () => hooks.command("cursors"),
    }[event.key === "=" ? "+" : event.key];
    if (!does) return;
    event.preventDefault();
    does();
  });

  function cursor(i) {
    const flag = el("b", {}, `X${i + 1}`);
    const handle = el("div", { class: "cursor", tabindex: 0, role: "slider", "aria-label": `Cursor X${i + 1}`, "aria-orientation": "horizontal", "data-cursor": i + 1 }, flag);
    let down = false;
    handle.addEventListener("pointerdown", (event) => {
      down = true;
      handle.setPointerCapture(event.pointerId);
      event.stopPropagation();
    });
    handle.addEventListener("pointermove", (event) => { if (down) hooks.cursor(i, at_of(Math.max(0, Math.min(width(), x_of(event))))); });
    for (const end of ["pointerup", "pointercancel"]) handle.addEventListener(end, () => { down = false; });
    handle.addEventListener("keydown", (event) => {
      const at = moved(handle.instant, event.key, event.shiftKey, hooks.view());
      if (at === null) return;
      event.preventDefault();
      hooks.cursor(i, at);
    });
    return {
      node: handle,
      show(at, view) {
        handle.hidden = at === null;
        if (at === null) return;
        handle.instant = at;
        const share = (at - view.from) / (view.to - view.from);
        handle.style.left = `${Math.max(0, Math.min(1, share)) * 100}%`;
        set(handle, "data-outside", share < 0 || share > 1);
        set(handle, "aria-valuemin", 0);
        set(handle, "aria-valuemax", Math.round(view.to - view.from));
        set(handle, "aria-valuenow", Math.round(Math.max(0, Math.min(1, share)) * (view.to - view.from)));
        set(handle, "aria-valuetext", time_text(at, 1));
      },
    };
  }

  return {
    node,
    /** marks: [{key, at, text, tone}] */
    show(view, cursors, pointed, all_marks) {
      for (const part of [over, rack]) {
        part.style.left = `${left_px()}px`;
        part.style.right = `${right_px()}px`;
      }
      handles.forEach((handle, i) => handle.show(cursors ? cursors[i] : null, view));
      pointer.hidden = pointed === null;
      if (pointed !== null) pointer.style.left = `${share_of(pointed) * 100}%`;
      list(marks, all_marks.filter((mark) => mark.at >= view.from && mark.at <= view.to), (mark) => mark.key, (mark) => {
        const word = el("span");
        const line = el("div", { class: "instant" }, word);
        return {
          node: line,
          show(next) {
            put(word, next.text);
            set(line, "data-tone", next.tone);
            line.style.left = `${share_of(next.at) * 100}%`;
          },
        };
      });
    },
  };
}
