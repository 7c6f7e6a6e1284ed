// SPDX-License-Identifier: Apache-2.0
// Lines of the last minute on a canvas: small ones for a row, large ones with scales and a pointer. Promises a gap where
// nothing was known. Knows of no axis: it is given a History and a series.

import { el } from "./dom.js";
import { number } from "../format.js";
import { SPAN_MS } from "../state/history.js";
import { steps } from "../state/scale.js";

let colours = null;
window.addEventListener("themechange", () => { colours = null; });

function colour(name) {
  if (!colours) {
    const style = getComputedStyle(document.documentElement);
    colours = Object.fromEntries(["line", "muted", "accent", "text", "faint"].map((each) => [each, style.getPropertyValue(`--${each}`).trim()]));
  }
  return colours[name];
}

/** Its drawing surface in real pixels; null while it has no size. */
function surface(canvas) {
  const scale = window.devicePixelRatio || 1;
  const width = Math.round(canvas.clientWidth * scale), height = Math.round(canvas.clientHeight * scale);
  if (width === 0 || height === 0) return null;
  if (canvas.width !== width) canvas.width = width;
  if (canvas.height !== height) canvas.height = height;
  const pen = canvas.getContext("2d");
  pen.setTransform(scale, 0, 0, scale, 0, 0);
  pen.clearRect(0, 0, width, height);
  return pen;
}

function line(pen, history, series, from, x_of, y_of) {
  let open = false;
  pen.beginPath();
  history.each(series, from, (at, value) => {
    if (Number.isNaN(value)) {
      open = false;
      return;
    }
    if (open) pen.lineTo(x_of(at), y_of(value));
    else pen.moveTo(x_of(at), y_of(value));
    open = true;
  });
  pen.stroke();
}

function extent(history, series, from) {
  let low = Infinity, high = -Infinity;
  history.each(series, from, (at, value) => {
    if (value < low) low = value;
    if (value > high) high = value;
  });
  return low > high ? null : [low, high];
}

/** A row's: zero in the middle, ± `scale` or what was there at most. */
export function spark(series) {
  const node = el("canvas", { class: "spark", "aria-hidden": "true" });
  return {
    node,
    show(history, now) {
      const pen = surface(node);
      if (!pen) return;
      const width = node.clientWidth, height = node.clientHeight, middle = height / 2;
      pen.strokeStyle = colour("line");
      pen.lineWidth = 1;
      pen.beginPath();
      pen.moveTo(0, Math.round(middle) + 0.5);
      pen.lineTo(width, Math.round(middle) + 0.5);
      pen.stroke();
      const found = extent(history, series, now - SPAN_MS);
      if (!found) return;
      const most = Math.max(1, Math.abs(found[0]), Math.abs(found[1]));
      pen.strokeStyle = colour("accent");
      pen.lineWidth = 1.25;
      pen.lineJoin = "round";
      line(pen, history, series, now - SPAN_MS, (at) => width * (1 - (now - at) / SPAN_MS), (value) => middle - (value / most) * (middle - 2));
    },
  };
}

const LEFT = 64, BELOW = 20, ABOVE = 8, RIGHT = 10;

/** With scales; `least` is the smallest range that is drawn, so that noise does not fill the picture. */
export function plot(series, label, unit, decimals, least) {
  const node = el("canvas", { class: "plot", role: "img", "aria-label": `${label} of the last minute; the same as a table is below` });
  let pointed = null;
  node.addEventListener("pointermove", (event) => { pointed = event.offsetX; });
  node.addEventListener("pointerleave", () => { pointed = null; });
  return {
    node,
    show(history, now) {
      const pen = surface(node);
      if (!pen) return;
      const width = node.clientWidth - LEFT - RIGHT, height = node.clientHeight - BELOW - ABOVE;
      const style = getComputedStyle(node);
      pen.font = `${style.fontSize} ${style.fontFamily}`;
      const from = now - SPAN_MS;
      const known = extent(history, series, from);
      let [low, high] = known ?? [0, 0];
      if (high - low < least) [low, high] = [(low + high - least) / 2, (low + high + least) / 2];
      const room = (high - low) * 0.08;
      [low, high] = [low - room, high + room];
      const x_of = (at) => LEFT + width * (1 - (now - at) / SPAN_MS);
      const y_of = (value) => ABOVE + height * (1 - (value - low) / (high - low));

      pen.lineWidth = 1;
      pen.textBaseline = "middle";
      if (!known) {
        pen.fillStyle = colour("muted");
        pen.textAlign = "center";
        pen.fillText("no valid value in this time", LEFT + width / 2, ABOVE + height / 2);
      }
      pen.textAlign = "right";
      const scale = steps(low, high);
      for (const value of known ? scale.found : []) {
        const y = Math.round(y_of(value)) + 0.5;
        pen.strokeStyle = value === 0 ? colour("faint") : colour("line");
        pen.beginPath();
        pen.moveTo(LEFT, y);
        pen.lineTo(LEFT + width, y);
        pen.stroke();
        pen.fillStyle = colour("muted");
        pen.fillText(number(value, scale.decimals), LEFT - 8, y);
      }
      pen.textBaseline = "alphabetic";
      for (let back = 0; back <= SPAN_MS; back += 15000) {
        const x = Math.round(x_of(now - back)) + 0.5;
        pen.strokeStyle = colour("line");
        pen.beginPath();
        pen.moveTo(x, ABOVE);
        pen.lineTo(x, ABOVE + height);
        pen.stroke();
        pen.fillStyle = colour("muted");
        pen.textAlign = back === 0 ? "right" : back === SPAN_MS ? "left" : "center";
        pen.fillText(back === 0 ? "now" : `−${back / 1000} s`, back === 0 ? LEFT + width : x, ABOVE + height + 15);
      }
      pen.save();
      pen.beginPath();
      pen.rect(LEFT, 0, width, ABOVE + height + 1);
      pen.clip();
      pen.strokeStyle = colour("accent");
      pen.lineWidth = 1.5;
      pen.lineJoin = "round";
      line(pen, history, series, from - 1000, x_of, y_of);
      pen.restore();
      if (pointed !== null && pointed >= LEFT && pointed <= LEFT + width) cursor(pen, history, now - SPAN_MS * (1 - (pointed - LEFT) / width), x_of, y_of);
    },
  };

  function cursor(pen, history, wanted, x_of, y_of) {
    let best = null;
    history.each(series, wanted - 2000, (at, value) => {
      if (!Number.isNaN(value) && (best === null || Math.abs(at - wanted) < Math.abs(best[0] - wanted))) best = [at, value];
    });
    if (!best || Math.abs(best[0] - wanted) > 1000) return;
    const [x, y] = [x_of(best[0]), y_of(best[1])];
    pen.strokeStyle = colour("faint");
    pen.beginPath();
    pen.moveTo(Math.round(x) + 0.5, ABOVE);
    pen.lineTo(Math.round(x) + 0.5, node.clientHeight - BELOW);
    pen.stroke();
    pen.fillStyle = colour("text");
    pen.beginPath();
    pen.arc(x, y, 3, 0, 7);
    pen.fill();
    pen.textBaseline = "middle";
    pen.textAlign = x > node.clientWidth / 2 ? "right" : "left";
    pen.fillText(`${number(best[1], decimals)} ${unit}`, x + (x > node.clientWidth / 2 ? -9 : 9), Math.max(ABOVE + 8, y - 12));
  }
}
