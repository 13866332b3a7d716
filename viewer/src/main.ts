// The replay: reads the runs of the page, builds it, and lets keys, buttons and links move it.

import { Vector3 } from "three";
import plotStyle from "uplot/dist/uPlot.min.css";
import type { Shown } from "./actor";
import { VIEWS, type ViewName } from "./camera";
import { Clock, SPEEDS } from "./clock";
import { readRuns, type Run } from "./data";
import { readLink, writeLink } from "./link";
import { buildPage, type Page } from "./page";
import { Plots } from "./plots";
import { Stage } from "./stage";
import style from "./style.css";
import { onThemeChange } from "./theme";

/** How far the arrows with shift go, s. */
const LEAP = 0.5;

const ORIGIN = new Vector3();

class Replay {
  readonly clock: Clock;
  readonly stage: Stage | undefined;
  readonly plots: Plots;
  private readonly runs: Run[];
  private readonly page: Page;

  constructor(app: HTMLElement, runs: Run[]) {
    this.runs = runs;
    this.page = buildPage(app, runs);
    this.clock = new Clock(
      Math.min(...runs.map((run) => run.begin)),
      Math.max(...runs.map((run) => run.end)),
    );
    this.stage = this.makeStage();
    this.plots = new Plots(this.page.plots, runs, this.clock);
    this.wire();
    this.clock.onChange(() => this.show());
    onThemeChange(() => {
      this.stage?.paint();
      this.plots.build();
    });
    window.addEventListener("hashchange", () => this.follow());
    window.addEventListener("keydown", (event) => this.key(event));
    this.follow();
    this.marks();
    this.show();
  }

  choose(view: ViewName): void {
    const posture = this.stage?.actors[0]?.posture;
    posture?.set(this.clock.time);
    this.stage?.eye.choose(view, posture?.root ?? ORIGIN);
    this.stage?.ask();
    this.marks();
    this.remember();
  }

  setGhosted(ghosted: boolean): void {
    this.stage?.setGhosted(ghosted);
    this.marks();
  }

  private makeStage(): Stage | undefined {
    try {
      return new Stage(this.page.stage, this.runs);
    } catch (error) {
      // Curves need no WebGL.
      const message = document.createElement("p");
      message.className = "problem";
      message.textContent = `This browser shows no three-dimensional picture: ${String(error)}`;
      this.page.stage.replaceChildren(message);
      return undefined;
    }
  }

  private wire(): void {
    const { page, clock } = this;
    page.slider.min = `${clock.begin}`;
    page.slider.max = `${clock.end}`;
    page.slider.addEventListener("input", () => {
      // To pause puts the slider where the clock still is.
      const wanted = page.slider.valueAsNumber;
      clock.pause();
      clock.seek(wanted);
    });
    page.play.addEventListener("click", () => clock.toggle());
    page.speed.addEventListener("change", () => {
      clock.speed = Number(page.speed.value);
    });
    for (const view of VIEWS) page.views[view].addEventListener("click", () => this.choose(view));
    for (const name of Object.keys(page.toggles) as (keyof Shown)[]) {
      page.toggles[name].addEventListener("click", () => this.toggle(name));
    }
    page.ghost.addEventListener("click", () => this.setGhosted(!this.stage?.ghosted));
    page.helpButton.addEventListener("click", () => page.help.showModal());
  }

  private toggle(name: keyof Shown): void {
    if (!this.stage || this.page.toggles[name].hidden) return;
    this.stage.shown[name] = !this.stage.shown[name];
    this.stage.ask();
    this.marks();
  }

  private key(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey || this.page.help.open) return;
    const { clock } = this;
    const actions: Record<string, () => void> = {
      " ": () => clock.toggle(),
      ArrowLeft: () => this.step(-1, event.shiftKey),
      ArrowRight: () => this.step(1, event.shiftKey),
      ArrowUp: () => this.faster(1),
      ArrowDown: () => this.faster(-1),
      Home: () => clock.seek(clock.begin),
      End: () => clock.seek(clock.end),
      "1": () => this.choose("orbit"),
      "2": () => this.choose("follow"),
      "3": () => this.choose("side"),
      c: () => this.toggle("chain"),
      f: () => this.toggle("forces"),
      m: () => this.toggle("mass"),
      r: () => this.toggle("ruler"),
      g: () => this.runs.length > 1 && this.setGhosted(!this.stage?.ghosted),
      w: () => {
        this.plots.whole = !this.plots.whole;
        this.plots.show();
      },
      "?": () => this.page.help.showModal(),
    };
    const action = actions[event.key];
    if (!action || event.target instanceof HTMLSelectElement) return;
    event.preventDefault();
    // A button that has the focus must not be pressed by the space bar as well.
    if (event.target instanceof HTMLButtonElement) event.target.blur();
    action();
  }

  private step(direction: 1 | -1, far: boolean): void {
    const { clock } = this;
    clock.pause();
    const run = this.runs.find(({ end }) => end === clock.end);
    if (far || !run) {
      clock.seek(clock.time + direction * LEAP);
      return;
    }
    const { row, part } = run.place(clock.time);
    const next = direction > 0 ? row + 1 : part > 1e-3 ? row : row - 1;
    clock.seek(run.time[Math.max(next, 0)] ?? clock.time);
  }

  private faster(steps: number): void {
    const index = SPEEDS.indexOf(this.clock.speed) + steps;
    this.clock.speed = SPEEDS[Math.min(Math.max(index, 0), SPEEDS.length - 1)] ?? 1;
    this.page.speed.value = `${this.clock.speed}`;
  }

  /** Goes where the link of the page says. */
  private follow(): void {
    const { time, view } = readLink();
    if (time !== undefined) this.clock.seek(time);
    if (view && view !== this.stage?.eye.view) this.choose(view);
  }

  private show(): void {
    const { clock, page } = this;
    this.stage?.show(clock.time);
    this.plots.show();
    page.slider.value = `${clock.time}`;
    page.play.classList.toggle("playing", clock.playing);
    page.play.title = clock.playing ? "Pause (space)" : "Play (space)";
    page.play.setAttribute("aria-label", clock.playing ? "Pause" : "Play");
    page.readout.textContent = this.words();
    if (!clock.playing) this.remember();
  }

  private words(): string {
    const { clock } = this;
    const run = this.runs[0];
    const row = run?.nearest(clock.time) ?? 0;
    const cycle = run?.channel("cycle")?.[row];
    const stage = run?.stage(row) ?? "";
    const phase = run?.channel("s")?.[row] ?? NaN;
    const part = Number.isNaN(phase) || stage !== "pull" ? "" : ` ${(phase * 100).toFixed(0)} %`;
    const where = cycle === undefined ? "" : ` · cycle ${cycle.toFixed(0)} · ${stage}${part}`;
    return `${clock.time.toFixed(2)} / ${clock.end.toFixed(2)} s${where}`;
  }

  private remember(): void {
    if (this.stage) writeLink(this.clock.time, this.stage.eye.view);
  }

  private marks(): void {
    const { page, stage } = this;
    const press = (button: HTMLElement, pressed: boolean) =>
      button.setAttribute("aria-pressed", `${pressed}`);
    for (const view of VIEWS) press(page.views[view], stage?.eye.view === view);
    for (const name of Object.keys(page.toggles) as (keyof Shown)[]) {
      press(page.toggles[name], stage?.shown[name] ?? false);
    }
    press(page.ghost, stage?.ghosted ?? false);
  }
}

function start(): void {
  const sheet = document.createElement("style");
  sheet.textContent = plotStyle + style;
  document.head.append(sheet);
  const app = document.getElementById("app");
  const data = document.getElementById("prone-runs");
  if (!app || !data) return;
  try {
    const replay = new Replay(app, readRuns(data.textContent ?? ""));
    // For whoever drives the page from outside, as its test does.
    Object.assign(window, { proneReplay: replay });
  } catch (error) {
    app.textContent = `This page cannot be shown: ${error instanceof Error ? error.message : String(error)}`;
    throw error;
  }
}

start();
