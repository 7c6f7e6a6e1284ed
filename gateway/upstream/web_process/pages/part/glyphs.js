// SPDX-License-Identifier: Apache-2.0
// A shape for each state, so that none is told by its colour alone. The word stands beside it always: a glyph is hidden from
// screen readers.

import { svg } from "./dom.js";

// 16 x 16; "f" is filled, "s" is drawn with a line.
const SHAPES = {
  disabled: [["s", "M8 2.5a5.5 5.5 0 1 0 .01 0z"]],
  standstill: [["f", "M8 2a6 6 0 1 0 .01 0z"]],
  "discrete motion": [["s", "M2 8h8M7 4.5 10.5 8 7 11.5M13.5 3v10"]],
  "continuous motion": [["s", "M2.5 4 6.5 8l-4 4M8.5 4l4 4-4 4"]],
  homing: [["s", "M2 8.2 8 3l6 5.2M4 7v6h8V7"]],
  stopping: [["s", "M2 4h4.5L12 11.5h2"]],
  latched: [["f", "M3.5 7.5h9v6h-9z"], ["s", "M5.5 7.5V5.2a2.5 2.5 0 0 1 5 0v2.3"]],
  "error stop": [["f", "M8 1.5 15.2 14H.8zM7.1 6v4.2h1.8V6zM7.1 11.2v1.7h1.8v-1.7z"]],
  unknown: [["s", "M5.4 5.6a2.6 2.6 0 1 1 3.9 2.3C8.4 8.5 8 9 8 10"], ["f", "M7.1 11.6h1.8v1.8H7.1z"]],
  online: [["s", "M2.5 8.5 6.5 12.5 13.5 4"]],
  up: [["s", "M2.5 8.5 6.5 12.5 13.5 4"]],
  setup: [["s", "M8 2.5v3M8 10.5v3M2.5 8h3M10.5 8h3"]],
  suspect: [["s", "M2 10c2-5 4-5 6-2s4 3 6-2"]],
  offline: [["s", "M1.5 8H5M11 8h3.5M6 5l4 6M10 5l-4 6"]],
  link_down: [["s", "M1.5 8H5M11 8h3.5M6 5l4 6M10 5l-4 6"]],
  down: [["s", "M1.5 8H5M11 8h3.5M6 5l4 6M10 5l-4 6"]],
  owner: [["s", "M4 14V2.5h8.5L10 5.5l2.5 3H4"]],
  note: [["s", "M8 2.5a5.5 5.5 0 1 0 .01 0zM8 7.2v4"], ["f", "M7.2 4.6h1.6v1.5H7.2z"]],
  warning: [["s", "M8 2.2 14.5 13.5h-13zM8 6.5V10"], ["f", "M7.2 11h1.6v1.4H7.2z"]],
  on: [["f", "M3 3h10v10H3z"]],
  off: [["s", "M3.7 3.7h8.6v8.6H3.7z"]],
  light: [["s", "M8 5.2a2.8 2.8 0 1 0 .01 0zM8 1v1.8M8 13.2V15M1 8h1.8M13.2 8H15M3 3l1.3 1.3M11.7 11.7 13 13M13 3l-1.3 1.3M4.3 11.7 3 13"]],
  dark: [["s", "M13 9.7A5.6 5.6 0 0 1 6.3 3a5.6 5.6 0 1 0 6.7 6.7z"]],
  auto: [["s", "M8 2.5a5.5 5.5 0 1 0 .01 0z"], ["f", "M8 2.5a5.5 5.5 0 0 1 0 11z"]],
  up_down: [["s", "M5 6.5 8 3.5l3 3M5 9.5l3 3 3-3"]],
  ascending: [["s", "M4.5 9.5 8 6l3.5 3.5"]],
  descending: [["s", "M4.5 6.5 8 10l3.5-3.5"]],
  pause: [["f", "M4 3h3v10H4zM9 3h3v10H9z"]],
  play: [["f", "M4.5 2.5 13 8l-8.5 5.5z"]],
  previous: [["s", "M10 3.5 5.5 8l4.5 4.5"]],
  next: [["s", "M6 3.5 10.5 8 6 12.5"]],
};

export function glyph(name, ...classes) {
  const drawing = svg("svg", { class: ["glyph", ...classes].join(" "), viewBox: "0 0 16 16", "aria-hidden": "true", focusable: "false" });
  draw(drawing, name);
  return drawing;
}

export function draw(drawing, name) {
  if (drawing.dataset.name === name) return;
  drawing.dataset.name = name;
  const shapes = SHAPES[name] ?? SHAPES.unknown;
  drawing.replaceChildren(...shapes.map(([how, path]) => svg("path", { d: path, class: how === "f" ? "full" : "line", "fill-rule": "evenodd" })));
}
