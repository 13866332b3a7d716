// node test/replay.mjs ONE.html TWO.html [PICTURES]
//
// Opens a page of one run and a page of two in Chromium and checks what a reader sees. Prints what
// it measures. Exit code 0: all is well; 1: something is not, and is said; 77: there is no browser.

import assert from "node:assert/strict";
import { mkdirSync, writeFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { Browser, findChromium } from "./chromium.mjs";

const [one, two, pictures] = process.argv.slice(2);
const chromium = findChromium();
if (!chromium) {
  console.log("there is no Chromium");
  process.exit(77);
}
const browser = new Browser(chromium);
const address = (file, hash = "") => pathToFileURL(resolve(file)).href + hash;
const DESKTOP = { width: 1280, height: 800 };
const NARROWER = { width: 1010, height: 800 };

/** The share of pixels about each run's bodies that differ from the same picture without robot. */
const ROBOT_PIXELS = `(async () => {
  const { stage } = proneReplay;
  const take = () => {
    stage.render();
    const copy = new OffscreenCanvas(stage.canvas.width, stage.canvas.height).getContext("2d");
    copy.drawImage(stage.canvas, 0, 0);
    return copy.getImageData(0, 0, copy.canvas.width, copy.canvas.height);
  };
  const scale = stage.canvas.width / stage.canvas.clientWidth;
  return stage.actors.map((actor, index) => {
    const robot = stage.ghosted && index > 0 ? actor.ghost : actor.robot.group;
    const withRobot = take();
    robot.visible = false;
    const without = take();
    robot.visible = true;
    stage.render();
    const places = stage.bodiesInPicture(index);
    const differs = places.filter(({ x, y }) => {
      const at = 4 * (Math.round(y * scale) * withRobot.width + Math.round(x * scale));
      return [0, 1, 2].some((i) => Math.abs(withRobot.data[at + i] - without.data[at + i]) > 3);
    });
    let all = 0;
    for (let i = 0; i < withRobot.data.length; i += 4) {
      if (Math.abs(withRobot.data[i] - without.data[i]) > 3) all += 1;
    }
    return { bodies: differs.length / places.length, pixels: all };
  });
})()`;

/** How often a second the scene can be drawn at 800 × 450, pictures finished. */
const FRAMES_PER_SECOND = `(async () => {
  const { stage, clock } = proneReplay;
  stage.canvas.parentElement.style.cssText = "width: 800px; height: 450px; flex: none";
  await new Promise((done) => setTimeout(done, 300));
  const context = stage.renderer.getContext();
  const finish = () => context.readPixels(0, 0, 1, 1, context.RGBA, context.UNSIGNED_BYTE, new Uint8Array(4));
  const begin = performance.now();
  let count = 0;
  while (performance.now() - begin < 2000) {
    stage.time = clock.begin + (count % 100) * 0.02;
    stage.render();
    finish();
    count += 1;
  }
  return { size: [stage.canvas.width, stage.canvas.height], rate: (1e3 * count) / (performance.now() - begin) };
})()`;

/** Each chart and the cell that it stands in, once a picture with all changes has been shown. */
const PLOTS = `(async () => {
  for (let i = 0; i < 2; i += 1) await new Promise(requestAnimationFrame);
  return [...document.querySelectorAll(".plot")].map((cell) => {
    const chart = cell.querySelector("canvas").getBoundingClientRect();
    const area = cell.querySelector(".area").getBoundingClientRect();
    const { right } = cell.getBoundingClientRect();
    return { width: chart.width, height: chart.height, right: chart.right, room: area.width, high: area.height, end: right };
  });
})()`;

/** A chart is drawn in whole pixels; a cell may end between two. */
const PIXEL = 1;

const time = () => browser.value("proneReplay.clock.time");

async function keep(name) {
  if (!pictures) return;
  mkdirSync(pictures, { recursive: true });
  writeFileSync(join(pictures, `${name}.png`), await browser.screenshot());
}

/** All charts are equally wide, fill their cells and do not stick out of them. */
async function plotsFit(when) {
  const plots = await browser.value(PLOTS);
  assert.ok(plots.length >= 3, `${when}: ${plots.length} plots`);
  const said = `${when}: ${JSON.stringify(plots)}`;
  for (const { width, height, right, room, high, end } of plots) {
    assert.ok(Math.abs(width - plots[0].width) <= PIXEL, `plots are not equally wide ${said}`);
    assert.ok(right <= end + PIXEL, `a plot ends outside its cell ${said}`);
    assert.ok(Math.abs(width - room) <= PIXEL && Math.abs(height - high) <= PIXEL, `a plot does not fill its cell ${said}`);
  }
}

/** Does what makes the plots anew, and waits until the page has heard of it. */
async function madeAnew(change) {
  await browser.value(`void (window.plotBefore = document.querySelector(".plot"))`);
  await change();
  await browser.until("!window.plotBefore.isConnected");
}

/** Everything that makes the plots anew, or changes the room that they have, while the page is open. */
async function plotsStayFitted(file) {
  await browser.open(address(file, "#t=1.2"), DESKTOP);
  await plotsFit("at first");
  const title = `document.querySelector(".plot h2 button")`;
  const click = () => browser.value(`${title}.click()`);
  for (const side of ["right", "left"]) {
    await madeAnew(click);
    assert.ok((await browser.value(`${title}.textContent`)).includes(side), `the title leads to the ${side} side`);
    await plotsFit(`after a click that leads to the ${side} side`);
  }
  const ink = `getComputedStyle(document.body).color`;
  const light = await browser.value(ink);
  await madeAnew(() => browser.scheme(true));
  await plotsFit("after a change to dark colours");
  assert.notEqual(await browser.value(ink), light, "the colours have changed");
  await keep("changed-to-dark");
  await madeAnew(click);
  await plotsFit("after a click on the dark page");
  await madeAnew(() => browser.scheme(false));
  await plotsFit("after a change to light colours");
  await browser.send("Emulation.setDeviceMetricsOverride", { ...NARROWER, deviceScaleFactor: 1, mobile: false });
  await plotsFit("in a narrower window");
}

async function oneRun() {
  await browser.open(address(one, "#t=1.5&view=side"), DESKTOP);
  assert.equal(await time(), 1.5, "the link says the instant");
  assert.equal(await browser.value("proneReplay.stage.eye.view"), "side", "the link says the view");
  for (const key of ["3", "1", "2"]) {
    await browser.key(key);
    await browser.value("new Promise(requestAnimationFrame)");
    const [robot] = await browser.value(ROBOT_PIXELS);
    assert.ok(robot.bodies > 0.6, `view ${key}: ${robot.bodies} of the bodies are seen`);
    assert.ok(robot.pixels > 5000, `view ${key}: the robot has ${robot.pixels} pixels`);
  }
  assert.equal(await browser.value("location.hash"), "#t=1.5&view=follow", "the link is kept up");

  // It plays at the speed of the clock, and stops.
  await browser.key(" ");
  assert.ok(await browser.value("proneReplay.clock.playing"), "space plays");
  await browser.until("proneReplay.clock.time > 2");
  await browser.key(" ");
  assert.ok(!(await browser.value("proneReplay.clock.playing")), "space stops");
  const stopped = await time();
  await browser.value("new Promise((done) => setTimeout(done, 200))");
  assert.equal(await time(), stopped, "stopped is stopped");

  // Slider, robot and cursors show one instant.
  const root = "(proneReplay.stage.render(), proneReplay.stage.actors[0].posture.root.x)";
  await browser.key("Home");
  const from = await browser.value(root);
  const slider = await browser.value(`(() => {
    const { left, top, width, height } = document.querySelector("input[type=range]").getBoundingClientRect();
    return [left + 0.75 * width, top + height / 2];
  })()`);
  await browser.mouse("mousePressed", ...slider);
  await browser.mouse("mouseReleased", ...slider);
  const moved = await time();
  const end = await browser.value("proneReplay.clock.end");
  assert.ok(moved > 0.6 * end && moved < 0.9 * end, `the slider leads to ${moved} of ${end} s`);
  assert.ok((await browser.value(root)) > from + 0.1, "the robot has come forward");
  const cursors = await browser.value("proneReplay.plots.cursors()");
  assert.ok(cursors.length >= 3, "there are curves");
  for (const cursor of cursors) assert.ok(Math.abs(cursor - moved) < 0.02, `cursor at ${cursor}, not ${moved}`);

  // Curves lead the robot as well.
  const curve = await browser.value(`(() => {
    const { left, top, width, height } = document.querySelector(".u-over").getBoundingClientRect();
    return [left + 0.5 * width, top + height / 2];
  })()`);
  await browser.mouse("mousePressed", ...curve);
  await browser.mouse("mouseReleased", ...curve);
  assert.ok((await time()) < moved - 0.5, "a click in a curve leads back");

  for (const key of ["c", "f", "m", "r", "?"]) await browser.key(key);
  assert.ok(await browser.value("document.querySelector('dialog').open"), "? helps");
  await browser.value("document.querySelector('dialog').close()");
  assert.deepEqual(await browser.value("Object.values(proneReplay.stage.shown)"), [true, false, false, false]);
  for (const key of ["f", "m", "r"]) await browser.key(key);
  await browser.key("3");
  await keep("side");
  await browser.open(address(one, "#t=1.2"), { ...DESKTOP, dark: true });
  await keep("dark");
  await browser.open(address(one, "#t=1.2"), { width: 390, height: 844, scale: 2 });
  const wide = await browser.value("document.documentElement.scrollWidth");
  assert.ok(wide <= 390, `a phone shows it whole: ${wide} pixels wide`);
  await keep("phone");
}

async function twoRuns() {
  await browser.open(address(two, "#t=1.2"), DESKTOP);
  await keep("two");
  for (const robot of await browser.value(ROBOT_PIXELS)) {
    assert.ok(robot.bodies > 0.6 && robot.pixels > 5000, `side by side: ${JSON.stringify(robot)}`);
  }
  await browser.key("g");
  const both = await browser.value(ROBOT_PIXELS);
  assert.equal(both.length, 2);
  for (const robot of both) assert.ok(robot.pixels > 2000, `ghost: ${JSON.stringify(robot)}`);
  await browser.value("new Promise(requestAnimationFrame)");
  await keep("ghost");
}

async function measure() {
  await browser.open(address(one), DESKTOP);
  const first = await browser.value("proneReplay.stage.firstPicture");
  await browser.until("performance.getEntriesByName('first-contentful-paint').length > 0");
  const painted = await browser.value("performance.getEntriesByName('first-contentful-paint')[0].startTime");
  const { size, rate } = await browser.value(FRAMES_PER_SECOND);
  console.log(`first picture asked of WebGL ${first.toFixed(0)} ms, seen ${painted.toFixed(0)} ms after the page was asked for`);
  console.log(`${rate.toFixed(1)} pictures per second at ${size.join(" × ")}`);
}

let failed = false;
try {
  await oneRun();
  await twoRuns();
  for (const file of [one, two]) await plotsStayFitted(file);
  await measure();
  const strangers = browser.requests.filter((url) => !/^(file:.*\.html(#.*)?|about:blank|data:,)$/.test(url));
  assert.deepEqual(strangers, [], "no request but the page itself");
  assert.deepEqual(browser.errors, [], "no complaint in the console");
} catch (error) {
  failed = true;
  console.error(error.message);
  await keep("failed").catch(() => {});
} finally {
  browser.close();
}
process.exitCode = failed ? 1 : 0;
