// SPDX-License-Identifier: Apache-2.0
// The stream /api/v1/stream: opened, read, watched and opened again. Promises that a silence of a second and a half is told,
// and that a hidden page holds no stream. Read by fetch and not by EventSource, which hides the lines that say "I live", and
// why it was refused.

const QUIET_MS = 1600; // the gateway says something each second
const LOOK_MS = 200;
const FIRST_WAIT_MS = 300, LONGEST_WAIT_MS = 3000;

/** Text of server-sent events, piece by piece: calls `frame(kind, text, id)`. */
export class FrameReader {
  constructor(frame) {
    this.frame = frame;
    this.rest = "";
    this.clear();
  }

  clear() {
    this.kind = "message";
    this.data = [];
    this.id = null;
  }

  take(text) {
    const lines = (this.rest + text).split("\n");
    this.rest = lines.pop();
    for (const line of lines) this.take_line(line.endsWith("\r") ? line.slice(0, -1) : line);
  }

  take_line(line) {
    if (line === "") {
      if (this.data.length > 0) this.frame(this.kind, this.data.join("\n"), this.id);
      this.clear();
      return;
    }
    const colon = line.indexOf(":");
    if (colon === 0) return; // a comment
    const name = colon < 0 ? line : line.slice(0, colon);
    const value = colon < 0 ? "" : line.slice(colon + 1).replace(/^ /, "");
    if (name === "event") this.kind = value;
    else if (name === "data") this.data.push(value);
    else if (name === "id") this.id = value;
  }
}

/** Tells `store` what comes. `state` is "opening", "live", "quiet", "lost", "refused" or "hidden". */
export class Stream {
  constructor(store, on_state) {
    this.store = store;
    this.on_state = on_state;
    this.state = "opening";
    this.heard = null; // when anything came; performance.now()
    this.heard_at = null; // the same as a Date
    this.refusal = null; // {status, detail}
    this.last_id = null;
    this.wait = FIRST_WAIT_MS;
    this.query = ""; // what is asked of it beside what every page needs
    this.frames = 0;
    this.bytes = 0;
  }

  start() {
    document.addEventListener("visibilitychange", () => this.look());
    window.addEventListener("pagehide", () => this.close("hidden"));
    window.addEventListener("pageshow", () => this.look());
    setInterval(() => this.watch(), LOOK_MS);
    this.look();
  }

  look() {
    if (document.visibilityState === "hidden") this.close("hidden");
    else if (!this.abort) this.open();
  }

  /** Of another page: "series=1.velocity_rpm", "". What is known stays until the same stream, asked so, has told of it anew. */
  ask(query) {
    if (query === this.query) return;
    this.query = query;
    if (!this.abort) return;
    this.abort.abort();
    this.open(true);
  }

  tell(state) {
    if (this.state === state) return;
    this.state = state;
    this.on_state();
  }

  watch() {
    if (this.state === "live" && performance.now() - this.heard > QUIET_MS) this.tell("quiet");
    // A connection that says nothing for long is dead, whatever the system believes.
    if (this.state === "quiet" && performance.now() - this.heard > 3 * QUIET_MS) this.abort?.abort();
  }

  close(state) {
    clearTimeout(this.timer);
    this.timer = null;
    const abort = this.abort;
    this.abort = null;
    abort?.abort();
    this.tell(state);
  }

  async open(goes_on = false) {
    clearTimeout(this.timer);
    const abort = new AbortController();
    this.abort = abort;
    if (!goes_on) this.store.begin();
    let wait = null;
    let was_refused = false;
    try {
      const headers = this.last_id ? { "Last-Event-ID": this.last_id } : {};
      const answer = await fetch(`api/v1/stream${this.query ? `?${this.query}` : ""}`, { headers, signal: abort.signal, cache: "no-store" });
      if (answer.ok) await this.read(answer.body.getReader());
      else was_refused = true;
      if (was_refused) wait = await this.refused(answer);
    } catch { /* aborted, or there is nobody: both are said below */ }
    if (this.abort !== abort) return; // closed on purpose, or opened anew
    this.abort = null;
    if (!was_refused) this.tell("lost");
    this.timer = setTimeout(() => this.look(), wait ?? this.wait);
    this.wait = Math.min(LONGEST_WAIT_MS, this.wait * 2);
  }

  async refused(answer) {
    let detail = answer.statusText;
    try {
      const problem = await answer.json();
      detail = problem.detail ?? problem.title ?? detail;
    } catch { /* the status says enough */ }
    this.refusal = { status: answer.status, detail };
    this.state = "refused";
    this.on_state();
    const seconds = Number(answer.headers.get("Retry-After"));
    return seconds > 0 ? Math.min(seconds, 60) * 1000 : null;
  }

  async read(reader) {
    const decoder = new TextDecoder();
    const frames = new FrameReader((kind, text, id) => this.frame(kind, text, id));
    for (;;) {
      const { done, value } = await reader.read();
      if (done) return;
      this.heard = performance.now();
      this.heard_at = new Date();
      this.bytes += value.length;
      this.wait = FIRST_WAIT_MS;
      this.tell("live");
      frames.take(decoder.decode(value, { stream: true }));
    }
  }

  frame(kind, text, id) {
    ++this.frames;
    if (id) this.last_id = id;
    if (kind === "bye") return; // the end of the stream follows
    try {
      this.store.take(kind, JSON.parse(text), id, performance.now());
    } catch (error) {
      console.error(`axisgate: a frame "${kind}" that cannot be read`, error);
    }
  }
}
