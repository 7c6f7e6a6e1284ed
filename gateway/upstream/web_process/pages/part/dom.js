// SPDX-License-Identifier: Apache-2.0
// Elements, made and changed. Promises that a text is put as text alone, and that what has not changed is not touched: a
// selection, a focus and what is pointed at stay. Never takes markup.

const SVG = "http://www.w3.org/2000/svg";

/** el("td", {class: "number"}, "12", child): attributes that are null or false are left out; on_click hears clicks. */
export function el(tag, attributes = {}, ...children) {
  return filled(document.createElement(tag), attributes, children);
}

export function svg(tag, attributes = {}, ...children) {
  return filled(document.createElementNS(SVG, tag), attributes, children);
}

function filled(node, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on_")) node.addEventListener(name.slice(3), value);
    else set(node, name, value);
  }
  for (const child of children.flat()) if (child !== null && child !== undefined) node.append(child);
  return node;
}

/** An attribute; null or false takes it away. */
export function set(node, name, value) {
  if (value === null || value === undefined || value === false) {
    if (node.hasAttribute(name)) node.removeAttribute(name);
    return;
  }
  const text = value === true ? "" : String(value);
  if (node.getAttribute(name) !== text) node.setAttribute(name, text);
}

export function put(node, text) {
  const shown = text === null || text === undefined ? "" : String(text);
  const only = node.firstChild;
  if (only && only === node.lastChild && only.nodeType === Node.TEXT_NODE) {
    if (only.data !== shown) only.data = shown;
  } else if (shown !== "" || only) {
    node.textContent = shown;
  }
}

/** The gateway's words: what stands in `backquotes` is typed, what stands between *stars* is stressed. */
export function say(node, text) {
  const said = text ?? "";
  if (node.said === said) return;
  node.said = said;
  const marked = { "`": "code", "*": "em" };
  node.replaceChildren(...said.split(/(`[^`]+`|\*[^*]+\*)/).map((part) => (marked[part[0]] && part.length > 2 ? el(marked[part[0]], {}, part.slice(1, -1)) : part)));
}

/**
 * The children of `parent` become one for each item, in this order. A child belongs to its key for good and is changed in
 * place. `made(item)` is {node, show(item)}.
 */
export function list(parent, items, key_of, made) {
  const before = parent.kept ?? new Map();
  const kept = new Map();
  let at = parent.firstChild;
  for (const item of items) {
    const key = key_of(item);
    const part = before.get(key) ?? made(item);
    kept.set(key, part);
    part.show(item);
    if (part.node === at) at = at.nextSibling;
    else parent.insertBefore(part.node, at);
  }
  while (at) {
    const next = at.nextSibling;
    at.remove();
    at = next;
  }
  parent.kept = kept;
}
