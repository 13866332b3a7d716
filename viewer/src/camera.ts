// Where one looks from: around a fixed point, around the robot as it goes, or from its side.

import { type Camera, OrthographicCamera, PerspectiveCamera, Vector3 } from "three";

export const VIEWS = ["orbit", "follow", "side"] as const;
export type ViewName = (typeof VIEWS)[number];

/** The point that is looked at, m: its height, and how far behind the root it is, whose robot has
 * longer legs than arms. */
const MIDDLE = 0.09;
const BEHIND = 0.08;

/** What the side view shows of the way, m, and at least of the height. */
const SIDE_LENGTH = 1.15;
const SIDE_HEIGHT = 0.36;

const FIELD_OF_VIEW = 30;

/** Share of a full turn per pixel of a drag. */
const TURN_PER_PIXEL = 0.006;

export class Eye {
  view: ViewName = "follow";
  private azimuth = -1.12;
  private elevation = 0.36;
  private distance = 1.35;
  private zoom = 1;
  private readonly shift = new Vector3();
  private readonly fixed = new Vector3(0, 0, MIDDLE);
  private readonly perspective = new PerspectiveCamera(FIELD_OF_VIEW, 1, 0.05, 40);
  private readonly flat = new OrthographicCamera(-1, 1, 1, -1, 0.01, 40);

  constructor() {
    this.perspective.up.set(0, 0, 1);
    this.flat.up.set(0, 0, 1);
  }

  /** Changes the view; `root` is where the robot is, where a fixed view looks from now on. */
  choose(view: ViewName, root: Vector3): void {
    this.view = view;
    this.shift.set(0, 0, 0);
    this.zoom = 1;
    if (view === "orbit") this.fixed.set(root.x - BEHIND, root.y, MIDDLE);
  }

  /** The camera of a picture of this width over height, for a robot at `root`. */
  camera(root: Vector3, aspect: number): Camera {
    const target = this.view === "orbit" ? this.fixed : goal.set(root.x - BEHIND, root.y, MIDDLE);
    goal.copy(target).add(this.shift);
    return this.view === "side" ? this.fromSide(goal, aspect) : this.around(goal, aspect);
  }

  /** Turns by a drag, pixels. */
  turn(dx: number, dy: number): void {
    if (this.view === "side") {
      this.move(dx, dy, 500);
      return;
    }
    this.azimuth -= dx * TURN_PER_PIXEL;
    this.elevation = clamp(this.elevation + dy * TURN_PER_PIXEL, -0.1, 1.55);
  }

  /** Moves what is looked at with the pointer, pixels of a picture that is `height` high. */
  move(dx: number, dy: number, height: number): void {
    if (this.view === "side") {
      const scale = (this.flat.top - this.flat.bottom) / height;
      this.shift.x -= dx * scale;
      this.shift.z += dy * scale;
      return;
    }
    const scale = (2 * this.distance * Math.tan((FIELD_OF_VIEW * Math.PI) / 360)) / height;
    this.shift.x += scale * (dx * Math.sin(this.azimuth) - dy * Math.cos(this.azimuth));
    this.shift.y += scale * (-dx * Math.cos(this.azimuth) - dy * Math.sin(this.azimuth));
  }

  /** Nearer by a factor. */
  approach(factor: number): void {
    if (this.view === "side") this.zoom = clamp(this.zoom * factor, 0.1, 12);
    else this.distance = clamp(this.distance / factor, 0.25, 12);
  }

  /** From the robot's right: it crawls to the right, as in the figures. */
  private fromSide(target: Vector3, aspect: number): OrthographicCamera {
    const width = Math.max(SIDE_LENGTH, SIDE_HEIGHT * aspect) / this.zoom;
    const camera = this.flat;
    camera.left = -width / 2;
    camera.right = width / 2;
    camera.top = width / 2 / aspect;
    camera.bottom = -camera.top;
    camera.position.set(target.x, target.y - 6, target.z);
    camera.lookAt(target);
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld();
    return camera;
  }

  private around(target: Vector3, aspect: number): PerspectiveCamera {
    const camera = this.perspective;
    // A narrow picture shows the whole robot too.
    const distance = this.distance * Math.max(1, 1.5 / aspect);
    const level = Math.cos(this.elevation) * distance;
    camera.position.set(
      target.x + level * Math.cos(this.azimuth),
      target.y + level * Math.sin(this.azimuth),
      Math.max(target.z + Math.sin(this.elevation) * distance, 0.01),
    );
    camera.aspect = aspect;
    camera.lookAt(target);
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld();
    return camera;
  }
}

const goal = new Vector3();

function clamp(value: number, low: number, high: number): number {
  return Math.min(Math.max(value, low), high);
}

/** Turns, moves and zooms an eye by pointer and wheel. */
export function steer(canvas: HTMLElement, eye: Eye, changed: () => void): void {
  const pointers = new Map<number, { x: number; y: number }>();
  const spread = () => {
    const [a, b] = [...pointers.values()];
    return a && b ? Math.hypot(a.x - b.x, a.y - b.y) : 0;
  };
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
  });
  canvas.addEventListener("pointermove", (event) => {
    const before = pointers.get(event.pointerId);
    if (!before) return;
    const [dx, dy] = [event.clientX - before.x, event.clientY - before.y];
    const apart = spread();
    pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    if (pointers.size > 1) {
      if (apart > 0) eye.approach(spread() / apart);
      eye.move(dx / 2, dy / 2, canvas.clientHeight);
    } else if (event.shiftKey || event.buttons & 2) eye.move(dx, dy, canvas.clientHeight);
    else eye.turn(dx, dy);
    changed();
  });
  const up = (event: PointerEvent) => pointers.delete(event.pointerId);
  canvas.addEventListener("pointerup", up);
  canvas.addEventListener("pointercancel", up);
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      eye.approach(Math.exp(-event.deltaY * 0.0012));
      changed();
    },
    { passive: false },
  );
}
