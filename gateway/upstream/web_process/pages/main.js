// SPDX-License-Identifier: Apache-2.0
// The frame around every page: header, lines that stand on each page, routes, and the one loop that draws. A page is a module
// with `open(context, ...words of the route)`, which gives {title(), node, update(), close()}.

import { el, list, put, set } from "./part/dom.js";
import { draw, glyph } from "./part/glyphs.js";
import { notice } from "./part/parts.js";
import { clock, uptime } from "./format.js";
import { Store } from "./state/store.js";
import { Stream } from "./stream.js";

const PAGES = ["axes", "axis", "scope", "captures", "buses", "events", "map", "words", "about"]; // ./page/NAME.js, fetched when it is opened first
const IN_HEADER = [["axes", "Axes"], ["scope", "Scope"], ["captures", "Captures"], ["buses", "Buses"], ["events", "Events"], ["map", "Map"], ["words", "Words"], ["about", "About"]];
const TICK_MS = 250; // ages and clocks go on without a frame
const RETRY_MS = 1000;

const store = new Store();
const stream = new Stream(store, () => soon());
const main = document.getElementById("content");

/** What pages get. */
const context = {
  store,
  stream,
  /** Something is to be drawn. */
  soon: () => soon(),
  /** What is shown is what is. */
  seen: () => stream.state === "live" && store.joined,
};

// --- Header ----------------------------------------------------------------------------------------------------------

function make_header() {
  const name = el("span", { class: "cell-name" });
  const links = IN_HEADER.map(([route, label]) => el("a", { href: `#${route}` }, label));
  const state = el("span", { class: "chip", id: "gateway-state" });
  const online = el("span", { class: "chip quiet", id: "axes-online" });
  const up = el("span", { class: "chip quiet wide-only" });
  const life = el("span", { class: "chip life", id: "stream-state" }, el("i"), el("span"));
  const theme_glyph = glyph("auto");
  const theme_button = el("button", { type: "button", class: "theme", id: "theme", on_click: () => window.axisgateTheme.next() }, theme_glyph);
  function show_theme() {
    const chosen = window.axisgateTheme.chosen();
    draw(theme_glyph, chosen);
    set(theme_button, "aria-label", `Colours: ${chosen === "auto" ? "as the system has them" : chosen}. Press for the next`);
    set(theme_button, "title", `Colours: ${chosen}`);
  }
  show_theme();
  window.addEventListener("themechange", show_theme);
  document.getElementById("bar").append(
    el("a", { class: "mark", href: "#axes", "aria-label": "axisgate: all axes" }, el("img", { src: "icon.svg", alt: "", width: 24, height: 24 }), el("span", {}, "axisgate")),
    name, el("nav", { "aria-label": "Pages" }, links), el("div", { class: "status" }, state, online, up, life), theme_button,
  );
  return () => {
    const gateway = store.gateway;
    const dead = !context.seen();
    put(name, gateway?.name ?? "");
    name.hidden = !gateway?.name;
    put(state, gateway?.state ?? "…");
    set(state, "data-tone", dead || !gateway ? "dim" : gateway.state === "running" ? "calm" : "look");
    put(online, gateway ? `${gateway.axes_online} of ${gateway.axis_count} online` : "");
    set(online, "data-tone", !dead && gateway && gateway.axes_online < gateway.axis_count ? "look" : "calm");
    put(up, gateway ? `up ${uptime(gateway.uptime_s)}` : "");
    const words_of = { opening: "opening", live: "live", quiet: "silent", lost: "no contact", refused: "refused", hidden: "paused" };
    const alone = stream.state === "live" && !store.joined; // its web server is here, the gateway is not
    put(life.lastChild, alone ? "no gateway" : words_of[stream.state]);
    set(life, "data-state", alone ? "lost" : stream.state);
    const here = route()[0];
    for (const link of links) {
      const to = link.getAttribute("href").slice(1);
      set(link, "aria-current", to === here ? "page" : to === "axes" && here === "axis" ? "true" : null);
    }
  };
}

// --- Lines on each page ----------------------------------------------------------------------------------------------

/** What stands on each page of a gateway that is as it should not be. */
function standing(gateway) {
  const lines = [];
  if (gateway?.insecure) lines.push(["insecure", "look", "Not encrypted.", "This page is open to other computers without TLS: whoever is on this network can read it."]);
  if (gateway && gateway.confined === false) lines.push(["confined", "look", "Not confined.", "This system's kernel does not hold axisgate-web back (no seccomp)."]);
  return lines;
}

function make_strips() {
  const holder = document.getElementById("strips");
  const lasting = el("div");
  const title = el("strong");
  const rest = el("span");
  const cover = el("p", { class: "cover", id: "not-seen" }, glyph("offline"), el("span", {}, title, " ", rest));
  holder.append(lasting, cover);
  return () => {
    list(lasting, standing(store.gateway), ([key]) => key, ([, tone, head, text]) => ({ node: notice(tone, head, text), show() {} }));
    const shown = !context.seen() && stream.state !== "hidden" && stream.state !== "opening";
    cover.hidden = !shown;
    document.body.classList.toggle("stale", shown);
    if (!shown) return;
    if (stream.state === "refused") {
      put(title, `The gateway refuses this page its stream: ${stream.refusal.status}`);
      put(rest, `${stream.refusal.detail}. It is asked again.`);
      return;
    }
    const alone = stream.state === "live";
    const since = alone ? store.gateway?.seen : stream.heard_at;
    put(title, since ? `Gateway not seen since ${clock(since)}` : "Gateway not seen yet");
    put(rest, alone ? "(its web server is here). What is grey is what it was; this page goes on by itself." : "What is grey is what it was; this page goes on by itself.");
  };
}

// --- Faults, said once -----------------------------------------------------------------------------------------------

function make_announcer() {
  const said = document.getElementById("announcer");
  let known = new Map();
  let was_seen = true;
  return () => {
    const faults = new Map();
    for (const each of store.sorted_axes()) if (each.fault) faults.set(each.axis, `Fault of axis ${each.axis} ${each.name}: ${each.fault.text || "its cause is being read"}.`);
    const fresh = [...faults].filter(([number, text]) => known.get(number) !== text).map(([, text]) => text);
    known = faults;
    const seen = !document.body.classList.contains("stale");
    if (!seen && was_seen) fresh.unshift("Gateway not seen.");
    was_seen = seen;
    if (fresh.length > 0) put(said, fresh.join(" "));
  };
}

// --- Routes ----------------------------------------------------------------------------------------------------------

function route() {
  const parts = location.hash.replace(/^#\/?/, "").split("/").map(decoded);
  return PAGES.includes(parts[0]) ? parts : ["axes"];
}

function decoded(text) {
  try {
    return decodeURIComponent(text);
  } catch {
    return text;
  }
}

let page = null;

async function open_page(by_hand) {
  const [name, ...rest] = route();
  const wanted = location.hash;
  let module;
  try {
    module = await import(`./page/${name}.js`);
  } catch {
    setTimeout(() => { if (location.hash === wanted) open_page(by_hand); }, RETRY_MS); // nobody answers just now
    return;
  }
  if (location.hash !== wanted) return;
  page?.close?.();
  page = module.open(context, ...rest);
  main.replaceChildren(page.node);
  set(document.body, "data-page", name);
  draw_all();
  if (!by_hand) return;
  window.scrollTo(0, 0);
  const heading = main.querySelector("h1");
  if (heading) {
    heading.tabIndex = -1;
    heading.focus({ preventScroll: true });
  }
}

// --- The loop --------------------------------------------------------------------------------------------------------

const parts = [make_header(), make_strips(), make_announcer()];
let asked = false;
let drawn = 0;

function draw_all() {
  for (const part of parts) part();
  page?.update();
  const title = page?.title() ?? "axisgate";
  const from = store.gateway?.name ? ` · ${store.gateway.name}` : "";
  const full = document.body.classList.contains("stale") ? `Not seen – ${title}${from}` : `${title}${from} – axisgate`;
  if (document.title !== full) document.title = full;
}

function soon() {
  if (asked) return;
  asked = true;
  setTimeout(() => requestAnimationFrame(() => {
    asked = false;
    drawn = performance.now();
    draw_all();
  }), Math.max(0, drawn + (page?.pace?.() ?? 0) - performance.now()));
}

document.getElementById("skip").addEventListener("click", (event) => {
  event.preventDefault(); // the hash is the page's name
  main.focus();
});
window.addEventListener("hashchange", () => open_page(true));
window.addEventListener("themechange", soon);
store.listen(soon);
setInterval(soon, TICK_MS);
open_page(false);
stream.start();
