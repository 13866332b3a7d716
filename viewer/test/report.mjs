// A report in headless Chromium: node test/report.mjs PAGE PICTURES
//
// Ends with 77 where there is no Chromium. The pictures are for eyes; nothing compares them.

import assert from "node:assert/strict";
import { mkdirSync, writeFileSync } from "node:fs";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";

import { Browser, findChromium } from "./chromium.mjs";

const NO_BROWSER = 77;

const [page, pictures] = process.argv.slice(2);
const chromium = findChromium();
if (!chromium) {
  console.error("no Chromium");
  process.exit(NO_BROWSER);
}
mkdirSync(pictures, { recursive: true });
const url = pathToFileURL(resolve(page)).href;
const browser = new Browser(chromium);
try {
  for (const [name, look] of [
    ["light", { width: 1280, height: 900 }],
    ["dark", { width: 1280, height: 900, dark: true }],
    ["phone", { width: 390, height: 844 }],
  ]) {
    await browser.openPage(url, look);
    writeFileSync(`${pictures}/report-${name}.png`, await browser.screenshot());
    // Wide tables and drawings scroll by themselves, the page does not.
    const root = "document.documentElement";
    const [wide, room] = await browser.value(`[${root}.scrollWidth, ${root}.clientWidth]`);
    assert.ok(wide <= room, `${name}: ${wide} pixels on a page of ${room}`);
  }

  browser.frames.length = 0;
  await browser.openPage(url, { width: 1280, height: 900 });
  const unseen = await browser.value(
    `[...document.images].filter((it) => !it.complete || it.naturalWidth === 0).length`,
  );
  assert.equal(unseen, 0, "every picture is decoded");
  const mute = await browser.value(`[...document.querySelectorAll("img, svg, iframe")].filter((it) => {
    const said = it.closest("[aria-label]")?.getAttribute("aria-label") || it.alt || it.title;
    return !said;
  }).length`);
  assert.equal(mute, 0, "every figure has a text");

  // The replay, which is not begun before it comes into sight.
  await browser.value(`document.querySelector("iframe").scrollIntoView()`);
  const end = Date.now() + 30e3;
  while (browser.frames.length === 0 && Date.now() < end) await new Promise((done) => setTimeout(done, 50));
  const frame = browser.frames.at(-1);
  assert.ok(frame, "the replay begins");
  await browser.until("window.proneReplay?.stage?.frames > 0", 30, frame);
  // What a frame draws is put into the page a little later.
  await new Promise((done) => setTimeout(done, 1000));
  writeFileSync(`${pictures}/report-replay.png`, await browser.screenshot());
  const origin = await browser.value("self.origin", frame);
  assert.equal(origin, "null", "the frame belongs to nobody");

  const asked = browser.requests.filter((it) => it !== url && !/^(data:|about:|blob:)/.test(it));
  assert.deepEqual(asked, [], "nothing is asked for but the page");
  assert.deepEqual(browser.errors, [], "no complaints");
  console.log("report: as it should be");
} finally {
  browser.close();
}
