// Where the bodies are: hinges and the pose of the root, no physics.
//
// ground_from_body = ground_from_parent · parent_from_body · hinge, where the hinge turns by its
// angle about an axis through its anchor, both in the body's own frame.

import { Matrix4, Quaternion, Vector3 } from "three";
import { BODY_PARTS, type BodyModel, type Run, type SideModel, type Site } from "./data";

/** The links of the planar chain, from the toe to the elbow. */
export const CHAIN = ["toe", "ankle", "knee", "hip", "shoulder", "elbow"] as const;

export class Posture {
  /** Ground from body, in the order of the model. */
  readonly bodies: Matrix4[];
  readonly root = new Vector3();
  /** Highest point of the robot, m; not a number where the run does not say. */
  top = NaN;
  private readonly run: Run;
  private readonly fixed: Matrix4[];
  private readonly angles: (Float32Array | undefined)[];
  private readonly jointBody = new Map<string, number>();
  private readonly tops: Float32Array[];

  constructor(run: Run) {
    this.run = run;
    const { bodies } = run.model;
    this.bodies = bodies.map(() => new Matrix4());
    this.fixed = bodies.map((body) =>
      new Matrix4().compose(vector(body.position), quaternion(body.quaternion), ONE),
    );
    this.angles = bodies.map((body, index) => {
      if (!body.joint) return undefined;
      this.jointBody.set(body.joint.name, index);
      return run.channel(`${body.joint.name}_rad`);
    });
    this.tops = BODY_PARTS.map((part) => run.channel(`${part}_top_mm`)).filter(
      (channel) => channel !== undefined,
    );
  }

  /** Moves every body to where it is at a time. */
  set(time: number): void {
    const { row, part } = this.run.place(time);
    const next = Math.min(row + 1, this.run.rows - 1);
    const at = (channel: Float32Array | undefined) => mix(channel, row, next, part);
    const { run } = this;
    this.root.set(at(run.channel("x_mm")), at(run.channel("y_mm")), at(run.channel("z_mm")));
    this.root.divideScalar(1e3);
    turn(run, row, fromTurn).slerp(turn(run, next, toTurn), part);
    this.bodies[0]?.compose(this.root, fromTurn, ONE);
    run.model.bodies.forEach((body, index) => {
      if (body.parent === null) return;
      const here = this.bodies[index];
      const parent = this.bodies[body.parent];
      const fixed = this.fixed[index];
      if (!here || !parent || !fixed) return;
      here.multiplyMatrices(parent, fixed);
      if (body.joint) here.multiply(hinge(body, at(this.angles[index])));
    });
    this.top = this.tops.length ? Math.max(...this.tops.map(at)) / 1e3 : NaN;
  }

  /** Centre of mass, where the model has masses. */
  centreOfMass(out: Vector3): boolean {
    let mass = 0;
    out.set(0, 0, 0);
    this.run.model.bodies.forEach((body, index) => {
      const here = this.bodies[index];
      if (!here || body.mass === undefined || !body.centre_of_mass) return;
      point.fromArray(body.centre_of_mass).applyMatrix4(here);
      out.addScaledVector(point, body.mass);
      mass += body.mass;
    });
    out.divideScalar(mass || 1);
    return mass > 0;
  }

  /** The chain between the two sides: the middle of each pair of points, toe to elbow. */
  chain(out: Vector3[]): void {
    const { left, right } = this.run.model.chain;
    CHAIN.forEach((name, index) => {
      out[index]?.copy(this.chainPoint(left, name)).add(this.chainPoint(right, name, point));
      out[index]?.multiplyScalar(0.5);
    });
  }

  private chainPoint(side: SideModel, name: (typeof CHAIN)[number], out = other): Vector3 {
    if (name === "toe" || name === "elbow") return this.sitePoint(side[name], out);
    const index = this.jointBody.get(side[name]) ?? 0;
    const anchor = this.run.model.bodies[index]?.joint?.anchor ?? [0, 0, 0];
    return this.sitePoint({ body: index, position: anchor }, out);
  }

  private sitePoint(site: Site, out: Vector3): Vector3 {
    out.fromArray(site.position);
    const body = this.bodies[site.body];
    return body ? out.applyMatrix4(body) : out;
  }
}

const ONE = new Vector3(1, 1, 1);
const point = new Vector3();
const other = new Vector3();
const axis = new Vector3();
const fromTurn = new Quaternion();
const toTurn = new Quaternion();
const hingeMatrix = new Matrix4();

function hinge(body: BodyModel, angle: number): Matrix4 {
  const { joint } = body;
  if (!joint || Number.isNaN(angle)) return hingeMatrix.identity();
  hingeMatrix.makeRotationAxis(axis.fromArray(joint.axis), angle);
  // anchor − R · anchor: the anchor stays where it is.
  other.fromArray(joint.anchor);
  point.copy(other).applyMatrix4(hingeMatrix);
  return hingeMatrix.setPosition(other.sub(point));
}

function turn(run: Run, row: number, out: Quaternion): Quaternion {
  const part = (name: string) => run.channel(name)?.[row] ?? (name === "qw" ? 1 : 0);
  return out.set(part("qx"), part("qy"), part("qz"), part("qw")).normalize();
}

function mix(channel: Float32Array | undefined, row: number, next: number, part: number): number {
  const from = channel?.[row] ?? NaN;
  return part === 0 ? from : from + part * ((channel?.[next] ?? NaN) - from);
}

export function vector(values: readonly [number, number, number]): Vector3 {
  return new Vector3(...values);
}

/** From real part first to three.js, which has it last. */
export function quaternion([w, x, y, z]: readonly [number, number, number, number]): Quaternion {
  return new Quaternion(x, y, z, w);
}
