// Curves over time below the picture, with a cursor at the instant that is shown.

import uPlot from "uplot";
import type { Clock } from "./clock";
import { BODY_PARTS, CONTACT_GROUPS, type Run } from "./data";
import { Ruler } from "./ruler";
import { theme } from "./theme";

interface Curve {
  label: string;
  /** What a run has of it. */
  of: (run: Run) => Float32Array | undefined;
}

interface Kind {
  title: string;
  digits: number;
  curves: Curve[];
}

const SIDES = ["left", "right"] as const;
type Side = (typeof SIDES)[number];
const JOINTS = ["ankle", "knee", "hip", "shoulder"] as const;

function jointCurves(side: Side, suffix: string): Curve[] {
  return JOINTS.map((joint) => ({
    label: joint,
    of: (run) => run.channel(`${run.model.chain[side][joint]}_${suffix}`),
  }));
}

function columns(names: readonly string[], suffix: string): Curve[] {
  return names.map((label) => ({ label, of: (run) => run.channel(`${label}_${suffix}`) }));
}

const CEILING: Curve = {
  label: "ceiling",
  of: (run) => {
    const { lowest } = new Ruler(run.model);
    return Number.isFinite(lowest) ? new Float32Array(run.rows).fill(lowest * 1e3) : undefined;
  },
};

function kinds(side: Side): Kind[] {
  return [
    { title: `Motor torque, ${side} (N·m)`, digits: 2, curves: jointCurves(side, "nm") },
    { title: `Motor current, ${side} (A)`, digits: 2, curves: jointCurves(side, "a") },
    {
      title: "Highest points (mm)",
      digits: 0,
      curves: [...columns(BODY_PARTS, "top_mm"), CEILING],
    },
    { title: "Force of the floor (N)", digits: 0, curves: columns(CONTACT_GROUPS, "n") },
  ];
}

/** A longer run is shown in pages of this length, s. */
const PAGE = 12;

export class Plots {
  /** The whole run instead of a page of it. */
  whole = false;
  private readonly host: HTMLElement;
  private readonly runs: Run[];
  private readonly clock: Clock;
  private plots: Plot[] = [];
  private side: Side = "left";

  constructor(host: HTMLElement, runs: Run[], clock: Clock) {
    this.host = host;
    this.runs = runs;
    this.clock = clock;
    this.build();
  }

  /** Anew, in the colours of the page. */
  build(): void {
    for (const plot of this.plots) plot.remove();
    const wanted = kinds(this.side).filter(({ curves }) =>
      curves.some(({ of }) => this.runs.some((run) => of(run))),
    );
    this.plots = wanted.map((kind) => new Plot(this.host, kind, this.runs, this.clock, this.window()));
    for (const plot of this.plots) {
      plot.onTitle(() => {
        this.side = this.side === "left" ? "right" : "left";
        this.build();
      });
    }
    this.show();
  }

  show(): void {
    for (const plot of this.plots) plot.show(this.clock.time, this.window());
  }

  private window(): [number, number] {
    const { begin, end, time } = this.clock;
    if (this.whole || end - begin <= PAGE * 1.5) return [begin, end];
    const page = Math.floor((Math.min(time, end - 1e-3) - begin) / PAGE);
    return [begin + page * PAGE, begin + (page + 1) * PAGE];
  }

  /** Where the cursors are, seconds: what a reader sees, read back from the page. */
  cursors(): number[] {
    return this.plots.map((plot) => plot.cursorTime());
  }
}

class Plot {
  private readonly box = document.createElement("section");
  private readonly area = document.createElement("div");
  private readonly title = document.createElement("h2");
  private readonly cursor = document.createElement("div");
  private readonly values: { out: HTMLElement; run: Run; data: Float32Array }[] = [];
  private readonly chart: uPlot;
  /** How wide a plot is depends on those beside it, how high on how its legend wraps: its own room tells. */
  private readonly room = new ResizeObserver(() => this.chart.setSize(this.size()));
  private readonly digits: number;
  private readonly sided: boolean;

  private window: [number, number];
  private range: [number, number] = [Infinity, -Infinity];

  constructor(host: HTMLElement, kind: Kind, runs: Run[], clock: Clock, window: [number, number]) {
    this.window = window;
    this.digits = kind.digits;
    this.sided = kind.title.includes(", ");
    this.box.className = "plot";
    this.area.className = "area";
    this.title.textContent = kind.title;
    const legend = document.createElement("div");
    legend.className = "legend";
    const head = document.createElement("header");
    head.append(this.title, legend);
    this.box.append(head, this.area);
    host.append(this.box);

    const colours = theme();
    const tables: uPlot.AlignedData[] = [];
    const series: uPlot.Series[] = [{}];
    runs.forEach((run, number) => {
      const table: (number | null)[][] = [Array.from(run.time)];
      kind.curves.forEach((curve, index) => {
        const data = curve.of(run);
        if (!data) return;
        const stroke = curve === CEILING ? colours.ink : (colours.series[index] ?? colours.ink);
        table.push(Array.from(data, (value) => (Number.isNaN(value) ? null : value)));
        const dash = number > 0 ? [5, 3] : curve === CEILING ? [2, 4] : [];
        series.push({ label: curve.label, stroke, width: 1.5, dash, spanGaps: runs.length > 1, points: { show: false } });
        for (const value of data) {
          // Not a number is neither.
          if (value < this.range[0]) this.range[0] = value;
          if (value > this.range[1]) this.range[1] = value;
        }
        this.values.push({ out: chip(legend, curve.label, stroke, number), run, data });
      });
      tables.push(table as uPlot.AlignedData);
    });
    const room = 0.06 * (this.range[1] - this.range[0]) || 1;
    this.range = [this.range[0] - room, this.range[1] + room];
    const axis = {
      stroke: colours.ink,
      grid: { stroke: colours.faint, width: 1 },
      ticks: { stroke: colours.faint, width: 1, size: 4 },
      font: "11px system-ui, sans-serif",
    };
    this.chart = new uPlot(
      {
        ...this.size(),
        legend: { show: false },
        cursor: { show: false },
        scales: {
          x: { time: false, range: () => this.window },
          // The same on every page.
          y: { range: () => this.range },
        },
        axes: [
          { ...axis, size: 24, gap: 2, values: (_, ticks) => ticks.map((tick) => `${tick} s`) },
          { ...axis, size: 40, gap: 3 },
        ],
        padding: [6, 14, 0, 0],
        series,
        // Only now, and after each change of size, it is known where an instant is.
        hooks: { draw: [() => this.point(clock.time)] },
      },
      tables.length > 1 ? uPlot.join(tables) : (tables[0] ?? [[]]),
      this.area,
    );
    this.cursor.className = "cursor";
    this.chart.over.append(this.cursor);
    this.scrub(clock);
    // The first call comes before the page is shown, with all plots in their places.
    this.room.observe(this.area);
  }

  show(time: number, window: [number, number]): void {
    if (window[0] !== this.window[0] || window[1] !== this.window[1]) {
      this.window = window;
      this.chart.setScale("x", { min: window[0], max: window[1] });
    }
    this.point(time);
    for (const { out, run, data } of this.values) {
      const value = data[run.nearest(time)] ?? NaN;
      const text = Number.isNaN(value) || time > run.end + 1e-6 ? "–" : value.toFixed(this.digits);
      if (out.textContent !== text) out.textContent = text.replace("-", "−");
    }
  }

  private point(time: number): void {
    // The first drawing may come before the constructor is done.
    if (!this.chart) return;
    this.cursor.style.transform = `translateX(${this.chart.valToPos(time, "x").toFixed(2)}px)`;
  }

  cursorTime(): number {
    const [, at] = /translateX\((.*)px\)/.exec(this.cursor.style.transform) ?? [];
    return this.chart.posToVal(Number(at), "x");
  }

  /** Joints have two sides; the title changes from one to the other. */
  onTitle(changed: () => void): void {
    if (!this.sided) return;
    const button = document.createElement("button");
    button.textContent = this.title.textContent;
    button.title = "The other side";
    button.addEventListener("click", changed);
    this.title.replaceChildren(button);
  }

  remove(): void {
    this.room.disconnect();
    this.chart.destroy();
    this.box.remove();
  }

  private size(): { width: number; height: number } {
    return { width: Math.max(this.area.clientWidth, 80), height: Math.max(this.area.clientHeight, 60) };
  }

  private scrub(clock: Clock): void {
    const { over } = this.chart;
    over.style.touchAction = "pan-y";
    const seek = (event: PointerEvent) => {
      const at = event.clientX - over.getBoundingClientRect().left;
      clock.seek(this.chart.posToVal(at, "x"));
    };
    over.addEventListener("pointerdown", (event) => {
      over.setPointerCapture(event.pointerId);
      clock.pause();
      seek(event);
    });
    over.addEventListener("pointermove", (event) => {
      if (over.hasPointerCapture(event.pointerId)) seek(event);
    });
  }
}

/** A curve's name and its value; curves of the second run have no name of their own. */
function chip(legend: HTMLElement, label: string, colour: string, run: number): HTMLElement {
  const value = document.createElement("b");
  const found = [...legend.children].find((child) => child.getAttribute("data-label") === label);
  if (found) {
    found.append(" ¦ ", value);
    return value;
  }
  const made = document.createElement("span");
  made.dataset["label"] = label;
  made.style.setProperty("--colour", colour);
  made.append(`${label} `, value);
  if (run > 0) made.prepend("¦ ");
  legend.append(made);
  return value;
}
