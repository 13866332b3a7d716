// A ruler behind the robot: heights above the floor, its highest point, the ceiling.

import { BufferAttribute, BufferGeometry, Group, LineBasicMaterial, LineSegments, Vector3 } from "three";
import type { Model } from "./data";
import type { Posture } from "./kinematics";
import type { Theme } from "./theme";

/** Where it stands, seen from the root, m: behind the feet. */
const BEHIND = 0.56;
/** How far its lines reach ahead of the root, m. */
const AHEAD = 0.42;
const TICK = 0.05;
const LEAST_HEIGHT = 0.2;

/** A word beside a height. */
export interface Label {
  text: string;
  place: Vector3;
  kind: "number" | "above" | "below";
}

export class Ruler {
  readonly group = new Group();
  readonly labels: Label[] = [];
  private readonly ceilings: { from: number; to: number; left: number; right: number; z: number }[];
  private readonly height: number;
  private readonly scale: LineSegments;
  private readonly ceiling = line(2);
  private readonly top = line(2);
  private readonly numbers: Label[] = [];

  constructor(model: Model) {
    const above = model.obstacles.filter(({ kind }) => kind === "plate" || kind === "panel");
    this.ceilings = above.map(({ position: [x, y, z], half_edges: [dx, dy, dz] }) => ({
      from: x - dx,
      to: x + dx,
      left: y + dy,
      right: y - dy,
      z: z - dz,
    }));
    const highest = Math.max(LEAST_HEIGHT, ...this.ceilings.map(({ z }) => z));
    this.height = Math.ceil((highest + 0.001) / TICK) * TICK;
    const ticks = Math.round(this.height / TICK);
    this.scale = line(2 * (ticks + 2));
    const points: number[] = [0, 0, 0, 0, 0, this.height];
    for (let tick = 0; tick <= ticks; tick++) {
      const z = tick * TICK;
      points.push(tick % 2 ? -0.008 : -0.016, 0, z, 0, 0, z);
      if (tick % 2 === 0) {
        this.numbers.push({ text: `${Math.round(z * 1e3)}`, place: new Vector3(-0.02, 0, z), kind: "number" });
      }
    }
    put(this.scale, points);
    this.group.add(this.scale, this.ceiling, this.top);
  }

  /** The lowest underside over any part of the robot at `root`, or else of the whole scene, m. */
  ceilingAt(root: Vector3): number {
    const over = this.ceilings.filter(
      ({ from, to, left, right }) =>
        from < root.x + AHEAD && to > root.x - BEHIND && left > root.y - 0.2 && right < root.y + 0.2,
    );
    return Math.min(...(over.length ? over : this.ceilings).map(({ z }) => z));
  }

  /** The lowest underside of the scene, m; infinite under the sky. */
  get lowest(): number {
    return Math.min(...this.ceilings.map(({ z }) => z));
  }

  paint(theme: Theme): void {
    colour(this.scale, theme.heavyLine);
    colour(this.ceiling, theme.obstacleForce);
    colour(this.top, theme.force);
  }

  show(posture: Posture): void {
    const { root, top } = posture;
    this.labels.length = 0;
    if (!this.group.visible) return;
    this.group.position.set(root.x - BEHIND, root.y, 0);
    for (const { text, place, kind } of this.numbers) {
      this.labels.push({ text, kind, place: place.clone().add(this.group.position) });
    }
    const ceiling = this.ceilingAt(root);
    const higher = top > ceiling;
    this.mark(this.ceiling, ceiling, "ceiling", higher ? "below" : "above");
    this.mark(this.top, top, "top", higher ? "above" : "below");
  }

  private mark(mark: LineSegments, z: number, word: string, kind: Label["kind"]): void {
    mark.visible = Number.isFinite(z);
    if (!mark.visible) return;
    put(mark, [0, 0, z, BEHIND + AHEAD, 0, z]);
    const place = new Vector3(0.01, 0, z).add(this.group.position);
    this.labels.push({ text: `${word} ${(z * 1e3).toFixed(0)} mm`, kind, place });
  }
}

function line(points: number): LineSegments {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(3 * points), 3));
  const made = new LineSegments(geometry, new LineBasicMaterial());
  made.frustumCulled = false;
  return made;
}

function put(lines: LineSegments, points: number[]): void {
  const position = lines.geometry.getAttribute("position") as BufferAttribute;
  position.copyArray(points);
  position.needsUpdate = true;
}

function colour(lines: LineSegments, value: number): void {
  (lines.material as LineBasicMaterial).color.set(value);
}
