// The elements of the page around picture and curves.

import { SPEEDS } from "./clock";
import { VIEWS, type ViewName } from "./camera";
import type { Run } from "./data";
import type { Shown } from "./actor";

export const KEYS: [string, string][] = [
  ["space", "play, pause"],
  ["← →", "one row back, forward; with shift half a second"],
  ["home end", "begin, end"],
  ["↑ ↓", "faster, slower"],
  ["1 2 3", "orbit, follow, side view"],
  ["c", "planar chain, toe to elbow"],
  ["f", "contact forces"],
  ["m", "centre of mass and its projection along gravity"],
  ["r", "ruler and ceiling"],
  ["g", "two runs: side by side, or the second as a ghost"],
  ["w", "curves of a long run: 12 s or the whole"],
  ["drag", "turn; two fingers, or with shift, move"],
  ["wheel, pinch", "nearer, farther"],
  ["?", "this help"],
];

export interface Page {
  stage: HTMLElement;
  plots: HTMLElement;
  play: HTMLButtonElement;
  slider: HTMLInputElement;
  readout: HTMLElement;
  speed: HTMLSelectElement;
  views: Record<ViewName, HTMLButtonElement>;
  toggles: Record<keyof Shown, HTMLButtonElement>;
  ghost: HTMLButtonElement;
  help: HTMLDialogElement;
  helpButton: HTMLButtonElement;
}

/** Builds the page for its runs. */
export function buildPage(app: HTMLElement, runs: Run[]): Page {
  const view = (name: ViewName, text: string) => [name, button(text, `${name} view`)] as const;
  const views = Object.fromEntries([
    view("orbit", "Orbit"),
    view("follow", "Follow"),
    view("side", "Side"),
  ]) as Page["views"];
  const toggles = {
    chain: button("Chain", "planar chain, toe to elbow (c)"),
    forces: button("Forces", "contact forces (f)"),
    mass: button("Mass", "centre of mass and its projection (m)"),
    ruler: button("Ruler", "heights and ceiling (r)"),
  };
  const hasMass = runs.some((run) => run.model.bodies.some(({ mass }) => mass !== undefined));
  toggles.mass.hidden = !hasMass;
  toggles.forces.hidden = !runs.some((run) => run.hasContacts);
  const ghost = button("Ghost", "the second run as a ghost (g)");
  ghost.hidden = runs.length < 2;
  const speed = document.createElement("select");
  speed.title = "Speed";
  for (const value of SPEEDS) speed.add(new Option(`${value}×`, `${value}`, value === 1, value === 1));
  const slider = document.createElement("input");
  Object.assign(slider, { type: "range", step: "any" });
  slider.setAttribute("aria-label", "Time");
  const play = button("", "Play");
  play.className = "play";
  const readout = element("output", "readout");
  const help = helpDialog();
  const helpButton = button("?", "Keys (?)");
  const controls = element("div", "controls");
  controls.append(
    group(play, slider, readout, speed),
    group(...VIEWS.map((name) => views[name])),
    group(...Object.values(toggles), ghost, helpButton),
  );
  const stage = element("div", "stage");
  const plots = element("div", "plots");
  app.replaceChildren(heading(runs), stage, controls, plots, help);
  return { stage, plots, play, slider, readout, speed, views, toggles, ghost, help, helpButton };
}

function heading(runs: Run[]): HTMLElement {
  const header = element("header", "top");
  const title = document.createElement("h1");
  title.textContent = runs.map((run) => run.title).join("  |  ");
  header.append(title);
  for (const text of new Set(runs.flatMap((run) => run.notes))) {
    const note = element("p", "note");
    note.textContent = text;
    header.append(note);
  }
  const about = document.createElement("details");
  const summary = document.createElement("summary");
  summary.textContent = "About";
  about.append(summary);
  const body = element("div", "about");
  for (const run of runs) {
    const list = document.createElement("dl");
    for (const [name, value] of run.facts) {
      const term = document.createElement("dt");
      const said = document.createElement("dd");
      term.textContent = name;
      said.textContent = value;
      list.append(term, said);
    }
    body.append(list);
  }
  about.append(body);
  header.append(about);
  return header;
}

function helpDialog(): HTMLDialogElement {
  const dialog = document.createElement("dialog");
  const list = document.createElement("dl");
  for (const [key, text] of KEYS) {
    const term = document.createElement("dt");
    const said = document.createElement("dd");
    term.textContent = key;
    said.textContent = text;
    list.append(term, said);
  }
  const close = button("Close", "Close");
  close.addEventListener("click", () => dialog.close());
  dialog.addEventListener("click", (event) => {
    if (event.target === dialog) dialog.close();
  });
  dialog.append(list, close);
  return dialog;
}

function button(text: string, title: string): HTMLButtonElement {
  const made = document.createElement("button");
  made.textContent = text;
  made.title = title;
  made.type = "button";
  return made;
}

function group(...children: HTMLElement[]): HTMLElement {
  const made = element("div", "group");
  made.append(...children);
  return made;
}

function element(tag: string, name: string): HTMLElement {
  const made = document.createElement(tag);
  made.className = name;
  return made;
}
