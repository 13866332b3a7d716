// The picture: one run, two side by side, or the second as a ghost in the scene of the first.

import { type Camera, LinearSRGBColorSpace, Vector3, WebGLRenderer } from "three";
import { Actor, type Shown } from "./actor";
import { Eye, steer } from "./camera";
import type { Run } from "./data";
import type { Label } from "./ruler";
import { theme } from "./theme";

/** Side by side left and right where the picture is wider than this many heights. */
const WIDE = 1.3;

/** A lower picture, pixels, has no numbers on its ruler. */
const ROOM_FOR_NUMBERS = 240;

export class Stage {
  readonly eye = new Eye();
  readonly actors: Actor[];
  readonly shown: Shown = { chain: false, forces: true, mass: true, ruler: true };
  ghosted = false;
  /** How many pictures were drawn, and when the first was, ms since the page was asked for. */
  frames = 0;
  firstPicture = NaN;
  readonly canvas = document.createElement("canvas");
  private readonly renderer: WebGLRenderer;
  private readonly words: HTMLElement;
  private readonly names: HTMLElement[];
  private readonly host: HTMLElement;
  private readonly pool: HTMLElement[] = [];
  private used = 0;
  private time = 0;
  private waiting = false;
  private width = 0;
  private height = 0;

  /** Throws where there is no WebGL. */
  constructor(host: HTMLElement, runs: Run[]) {
    this.host = host;
    this.renderer = new WebGLRenderer({
      canvas: this.canvas,
      // Where the processor draws, smooth edges cost half of the pictures per second.
      antialias: !drawnByProcessor(),
      stencil: true,
    });
    this.renderer.outputColorSpace = LinearSRGBColorSpace;
    this.renderer.setScissorTest(true);
    this.renderer.autoClear = false;
    this.actors = runs.map((run) => new Actor(run));
    this.words = document.createElement("div");
    this.words.className = "words";
    this.names = runs.map((run, index) => {
      const name = document.createElement("div");
      name.className = `name run${index}`;
      name.textContent = run.title;
      name.hidden = runs.length < 2;
      return name;
    });
    host.append(this.canvas, this.words, ...this.names);
    this.canvas.setAttribute("role", "img");
    this.canvas.setAttribute("aria-label", "The robot and its surroundings in three dimensions");
    steer(this.canvas, this.eye, () => this.ask());
    new ResizeObserver(() => this.resize()).observe(host);
    this.paint();
    this.resize();
  }

  /** Takes the colours of the page. */
  paint(): void {
    for (const actor of this.actors) actor.paint(theme());
    this.ask();
  }

  show(time: number): void {
    this.time = time;
    this.ask();
  }

  setGhosted(ghosted: boolean): void {
    const [first, second] = this.actors;
    if (!first || !second) return;
    this.ghosted = ghosted;
    if (ghosted) first.scene.add(second.ghost);
    else first.scene.remove(second.ghost);
    this.ask();
  }

  /** Draws once, before the next picture of the page. */
  ask(): void {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      if (this.waiting) this.render();
    });
  }

  render(): void {
    this.waiting = false;
    this.used = 0;
    for (const actor of this.actors) actor.show(this.time, this.shown, this.eye.view === "side");
    this.parts().forEach(({ actor, left, top, width, height }, index) => {
      const camera = this.eye.camera(actor.posture.root, width / height);
      const bottom = this.height - top - height;
      this.renderer.setViewport(left, bottom, width, height);
      this.renderer.setScissor(left, bottom, width, height);
      this.renderer.clear();
      this.renderer.render(actor.scene, camera);
      for (const label of actor.ruler.labels) this.word(label, camera, { left, top, width, height });
      const name = this.names[index];
      if (name) name.style.transform = corner(left + width, top);
    });
    const ghost = this.names[1];
    ghost?.classList.toggle("ghost", this.ghosted);
    if (ghost && this.ghosted) ghost.style.transform = corner(this.width, 20);
    for (const rest of this.pool.slice(this.used)) rest.hidden = true;
    this.frames += 1;
    if (this.frames === 1) this.firstPicture = performance.now();
  }

  /** Where the bodies of a run are in the picture, pixels of the page's units from its corner. */
  bodiesInPicture(index: number): { x: number; y: number }[] {
    const part = this.parts()[this.ghosted ? 0 : index];
    const actor = this.actors[index];
    const seenBy = part?.actor;
    if (!part || !actor || !seenBy) return [];
    const camera = this.eye.camera(seenBy.posture.root, part.width / part.height);
    return actor.posture.bodies.map((body) => {
      place.setFromMatrixPosition(body).project(camera);
      return {
        x: part.left + ((place.x + 1) / 2) * part.width,
        y: part.top + ((1 - place.y) / 2) * part.height,
      };
    });
  }

  private parts(): { actor: Actor; left: number; top: number; width: number; height: number }[] {
    const { width, height } = this;
    const [first, second] = this.actors;
    if (!first) return [];
    if (!second || this.ghosted) return [{ actor: first, left: 0, top: 0, width, height }];
    if (width > WIDE * height) {
      const half = Math.floor(width / 2);
      return [
        { actor: first, left: 0, top: 0, width: half - 1, height },
        { actor: second, left: half + 1, top: 0, width: width - half - 1, height },
      ];
    }
    const half = Math.floor(height / 2);
    return [
      { actor: first, left: 0, top: 0, width, height: half - 1 },
      { actor: second, left: 0, top: half + 1, width, height: height - half - 1 },
    ];
  }

  private resize(): void {
    this.width = Math.max(this.host.clientWidth, 1);
    this.height = Math.max(this.host.clientHeight, 1);
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.setSize(this.width, this.height);
    this.render();
  }

  /** Writes a word over the picture where it is in space. */
  private word(
    { text, place: at, kind }: Label,
    camera: Camera,
    part: { left: number; top: number; width: number; height: number },
  ): void {
    place.copy(at).project(camera);
    if (kind === "number" && part.height < ROOM_FOR_NUMBERS && this.eye.view !== "side") return;
    if (Math.abs(place.x) > 1 || Math.abs(place.y) > 1 || place.z > 1) return;
    let word = this.pool[this.used];
    if (!word) {
      word = document.createElement("span");
      this.words.append(word);
      this.pool.push(word);
    }
    this.used += 1;
    word.hidden = false;
    if (word.textContent !== text) word.textContent = text;
    word.className = kind;
    const x = part.left + ((place.x + 1) / 2) * part.width;
    const y = part.top + ((1 - place.y) / 2) * part.height;
    word.style.left = `${x.toFixed(1)}px`;
    word.style.top = `${y.toFixed(1)}px`;
  }
}

const place = new Vector3();

/** Moves a name, which stands at the left, to where its right end is at x. */
function corner(x: number, y: number): string {
  return `translate(calc(${x}px - 100%), ${y}px)`;
}

/** Whether there is no graphics card. */
function drawnByProcessor(): boolean {
  const context = document.createElement("canvas").getContext("webgl");
  const info = context?.getExtension("WEBGL_debug_renderer_info");
  const name: unknown = info && context?.getParameter(info.UNMASKED_RENDERER_WEBGL);
  context?.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|software/i.test(String(name));
}
