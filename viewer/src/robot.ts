// The robot from its own shapes and colours, with a shadow on the floor; or its ghost. All shapes
// are one mesh, whose corners know their body: one call of the graphics driver draws them.

import {
  BoxGeometry,
  BufferAttribute,
  BufferGeometry,
  CapsuleGeometry,
  CylinderGeometry,
  EqualStencilFunc,
  Group,
  IncrementStencilOp,
  Matrix4,
  Mesh,
  type ShaderMaterial,
  SphereGeometry,
  Vector3,
} from "three";
import type { Model, ShapeModel } from "./data";
import { type Posture, quaternion, vector } from "./kinematics";
import { litBodies, shadowOfBodies, tint } from "./light";
import type { Theme } from "./theme";

/** Shapes of a higher group are not for the eye. */
const HIGHEST_GROUP = 2;

/** A radius, m, below which fewer corners make a circle. */
const SMALL = 0.028;

/** Corners of a large circle, of the robot and of its shadow; multiples of eight. */
const ROUND = 24;
const SHADOW_ROUND = 16;

export class RobotView {
  readonly group = new Group();
  private readonly surface: ShaderMaterial;
  private readonly shadow: ShaderMaterial | undefined;
  private readonly ghost: boolean;

  constructor(model: Model, posture: Posture, look: "solid" | "ghost") {
    this.ghost = look === "ghost";
    const eyed = model.shapes.filter(({ group }) => group <= HIGHEST_GROUP);
    this.surface = litBodies(posture.bodies, { ghost: this.ghost });
    this.add(merged(eyed, ROUND), this.surface, this.ghost ? 2 : 0);
    if (this.ghost || model.rough) return;
    this.shadow = shadowOfBodies(posture.bodies);
    // Where two parts throw a shadow it is no darker.
    Object.assign(this.shadow, {
      stencilWrite: true,
      stencilFunc: EqualStencilFunc,
      stencilRef: 0,
      stencilZPass: IncrementStencilOp,
    });
    this.add(merged(eyed, SHADOW_ROUND), this.shadow, 1);
  }

  paint(theme: Theme): void {
    tint(this.surface, theme.ghost);
    if (this.shadow) tint(this.shadow, theme.shadow);
  }

  private add(shapes: BufferGeometry, material: ShaderMaterial, order: number): void {
    const mesh = new Mesh(shapes, material);
    mesh.frustumCulled = false;
    mesh.renderOrder = order;
    this.group.add(mesh);
  }
}

/** All shapes, each in the frame of its body. */
function merged(shapes: ShapeModel[], round: number): BufferGeometry {
  const positions: number[] = [];
  const normals: number[] = [];
  const paint: number[] = [];
  const bodies: number[] = [];
  const faces: number[] = [];
  for (const shape of shapes) {
    const part = geometry(shape, round);
    if (!part) continue;
    const first = bodies.length;
    for (const index of part.index?.array ?? []) faces.push(first + index);
    positions.push(...(part.getAttribute("position").array as Float32Array));
    normals.push(...(part.getAttribute("normal").array as Float32Array));
    for (let corner = 0; corner < part.getAttribute("position").count; corner++) {
      paint.push(...shape.rgba.slice(0, 3));
      bodies.push(shape.body);
    }
  }
  const made = new BufferGeometry();
  const set = (name: string, values: number[], size: number) =>
    made.setAttribute(name, new BufferAttribute(new Float32Array(values), size));
  set("position", positions, 3);
  set("normal", normals, 3);
  set("paint", paint, 3);
  set("body", bodies, 1);
  made.setIndex(faces);
  return made;
}

/** Round shapes of the model lie along z, those of three.js along y. */
function geometry(shape: ShapeModel, most: number): BufferGeometry | undefined {
  const [a = 0, b = 0, c = 0] = shape.size;
  const upright = Math.PI / 2;
  const round = a < SMALL ? most / 2 : most;
  const place = new Matrix4().compose(
    vector(shape.position),
    quaternion(shape.quaternion),
    new Vector3(1, 1, 1),
  );
  const made = (() => {
    switch (shape.type) {
      case "sphere":
        return new SphereGeometry(a, round, round / 2);
      case "ellipsoid":
        return new SphereGeometry(1, round, round / 2).scale(a, b, c);
      case "capsule":
        return new CapsuleGeometry(a, 2 * b, round / 4, round).rotateX(upright);
      case "cylinder":
        return new CylinderGeometry(a, a, 2 * b, round).rotateX(upright);
      case "box":
        return new BoxGeometry(2 * a, 2 * b, 2 * c);
      default:
        return undefined;
    }
  })();
  return made?.applyMatrix4(place);
}
