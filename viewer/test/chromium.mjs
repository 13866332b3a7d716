// Headless Chromium, driven through a pipe: Chrome DevTools Protocol, messages that end in a zero
// byte. Needs nothing but node.

import { spawn, spawnSync } from "node:child_process";
import { existsSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

const FLAGS = [
  "--headless",
  "--no-sandbox",
  "--disable-gpu",
  "--disable-quic",
  "--no-first-run",
  "--disable-background-networking",
  "--disable-component-update",
  "--disable-sync",
  // WebGL without a graphics card.
  "--use-angle=swiftshader",
  "--enable-unsafe-swiftshader",
  "--remote-debugging-pipe",
];

/** Where Chromium is, if it is. */
export function findChromium() {
  const named = process.env.CHROMIUM;
  if (named) return existsSync(named) ? named : undefined;
  return ["chromium", "chromium-browser", "google-chrome"]
    .map((name) => spawnSync("sh", ["-c", `command -v ${name}`], { encoding: "utf8" }).stdout.trim())
    .find((path) => path !== "");
}

export class Browser {
  /** All that the pages asked for, and every complaint. */
  requests = [];
  errors = [];
  /** The frames that have appeared in the page, each with a process of its own: what `value` and `until` take. */
  frames = [];
  #profile = mkdtempSync(join(tmpdir(), "prone-chromium-"));
  #process;
  #waiting = new Map();
  #last = 0;
  #session;
  #rest = "";

  constructor(path) {
    this.#process = spawn(path, [...FLAGS, `--user-data-dir=${this.#profile}`, "about:blank"], {
      stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"],
      // A group of its own, so that all its processes end together.
      detached: true,
    });
    this.#process.stdio[4].on("data", (data) => this.#read(data));
    this.#process.on("exit", () => this.#fail(new Error("Chromium has ended")));
  }

  /** Opens a replay, and waits for its first picture. */
  async open(url, options) {
    await this.openPage(url, options);
    await this.until("window.proneReplay?.stage?.frames > 0");
  }

  /** Opens any page. */
  async openPage(url, { width, height, dark = false, scale = 1 }) {
    if (!this.#session) await this.#attach();
    await this.send("Emulation.setDeviceMetricsOverride", {
      width,
      height,
      deviceScaleFactor: scale,
      mobile: width < 500,
    });
    await this.scheme(dark);
    // Away first: a new hash alone loads nothing.
    await this.send("Page.navigate", { url: "about:blank" });
    await this.send("Page.navigate", { url });
    await this.until("document.readyState === 'complete'");
  }

  /** Lets the system prefer dark or light colours; an open page hears of it. */
  async scheme(dark) {
    const features = [{ name: "prefers-color-scheme", value: dark ? "dark" : "light" }];
    await this.send("Emulation.setEmulatedMedia", { features });
  }

  /** What an expression of the page, or of a frame in it, is; promises are waited for. */
  async value(expression, frame = this.#session) {
    const asked = { expression, awaitPromise: true, returnByValue: true };
    const { result, exceptionDetails } = await this.send("Runtime.evaluate", asked, frame);
    if (exceptionDetails) throw new Error(JSON.stringify(exceptionDetails));
    return result.value;
  }

  async until(expression, seconds = 30, frame = this.#session) {
    const end = Date.now() + seconds * 1e3;
    while (!(await this.value(expression, frame))) {
      if (Date.now() > end) throw new Error(`not within ${seconds} s: ${expression}`);
      await new Promise((done) => setTimeout(done, 50));
    }
  }

  async key(key) {
    const text = key.length === 1 ? key : undefined;
    await this.send("Input.dispatchKeyEvent", { type: "keyDown", key, text });
    await this.send("Input.dispatchKeyEvent", { type: "keyUp", key });
  }

  async mouse(type, x, y) {
    await this.send("Input.dispatchMouseEvent", { type, x, y, button: "left", buttons: 1, clickCount: 1 });
  }

  async screenshot() {
    const { data } = await this.send("Page.captureScreenshot", { format: "png" });
    return Buffer.from(data, "base64");
  }

  send(method, params = {}, session = this.#session) {
    const id = ++this.#last;
    const message = { id, method, params, sessionId: session };
    return new Promise((done, failed) => {
      this.#waiting.set(id, { done, failed });
      this.#process.stdio[3].write(`${JSON.stringify(message)}\0`);
    });
  }

  close() {
    this.#process.removeAllListeners("exit");
    this.#process.on("exit", () => {
      rmSync(this.#profile, { recursive: true, force: true, maxRetries: 5, retryDelay: 100 });
    });
    process.kill(-this.#process.pid, "SIGKILL");
  }

  async #attach() {
    const { targetInfos } = await this.send("Target.getTargets");
    const { targetId } = targetInfos.find(({ type }) => type === "page");
    const { sessionId } = await this.send("Target.attachToTarget", { targetId, flatten: true });
    this.#session = sessionId;
    for (const domain of ["Runtime", "Log", "Network", "Page"]) await this.send(`${domain}.enable`);
    const follow = { autoAttach: true, waitForDebuggerOnStart: false, flatten: true };
    await this.send("Target.setAutoAttach", follow);
  }

  async #follow(session) {
    for (const domain of ["Runtime", "Log", "Network"]) await this.send(`${domain}.enable`, {}, session);
    this.frames.push(session);
  }

  #read(data) {
    const parts = (this.#rest + data.toString("utf8")).split("\0");
    this.#rest = parts.pop();
    for (const part of parts) this.#hear(JSON.parse(part));
  }

  #hear({ id, method, params, result, error }) {
    if (id !== undefined) {
      const { done, failed } = this.#waiting.get(id);
      this.#waiting.delete(id);
      if (error) failed(new Error(error.message));
      else done(result);
    } else if (method === "Target.attachedToTarget") {
      // A frame may go again while it is looked at.
      if (params.targetInfo.type === "iframe") this.#follow(params.sessionId).catch(() => {});
    } else if (method === "Network.requestWillBeSent") this.requests.push(params.request.url);
    else if (method === "Runtime.exceptionThrown") this.errors.push(JSON.stringify(params.exceptionDetails));
    else if (method === "Runtime.consoleAPICalled" && ["error", "warning", "assert"].includes(params.type)) {
      this.errors.push(JSON.stringify(params.args));
    } else if (method === "Log.entryAdded" && params.entry.level === "error") {
      this.errors.push(params.entry.text);
    }
  }

  #fail(error) {
    for (const { failed } of this.#waiting.values()) failed(error);
    this.#waiting.clear();
  }
}
