// The robot from its own shapes and colours, with a shadow on the floor; or its ghost.

import {
  BoxGeometry,
  type BufferGeometry,
  CapsuleGeometry,
  Color,
  CylinderGeometry,
  EqualStencilFunc,
  Group,
  IncrementStencilOp,
  type Material,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  MeshPhongMaterial,
  SphereGeometry,
  SRGBColorSpace,
  Vector3,
} from "three";
import type { Model, ShapeModel } from "./data";
import { type Posture, quaternion, vector } from "./kinematics";
import type { Theme } from "./theme";

/** Shapes of a higher group are not for the eye. */
const HIGHEST_GROUP = 2;

/** Where the light comes from, in the ground frame. */
export const SUN = new Vector3(-0.35, -0.5, 1);

/** Height of the shadow above the floor, m: above the lines. */
const SHADOW_HEIGHT = 0.0008;

export class RobotView {
  readonly group = new Group();
  private readonly shadow = new Group();
  private readonly parts: { body: number; mesh: Mesh; local: Matrix4; shadow: Mesh }[] = [];
  private readonly shadowMaterial = new MeshBasicMaterial({
    transparent: true,
    opacity: 0.28,
    depthWrite: false,
    // Where two parts throw a shadow it is no darker.
    stencilWrite: true,
    stencilFunc: EqualStencilFunc,
    stencilRef: 0,
    stencilZPass: IncrementStencilOp,
  });
  private readonly ghostMaterial: MeshPhongMaterial | undefined;

  constructor(model: Model, look: "solid" | "ghost") {
    const materials = new Map<string, Material>();
    if (look === "ghost") {
      this.ghostMaterial = new MeshPhongMaterial({ transparent: true, opacity: 0.38 });
    }
    for (const shape of model.shapes) {
      if (shape.group > HIGHEST_GROUP) continue;
      const made = geometry(shape);
      if (!made) continue;
      const mesh = new Mesh(made, this.ghostMaterial ?? material(shape, materials));
      const local = new Matrix4().compose(
        vector(shape.position),
        quaternion(shape.quaternion),
        shape.type === "ellipsoid"
          ? new Vector3(...(shape.size as [number, number, number]))
          : new Vector3(1, 1, 1),
      );
      mesh.matrixAutoUpdate = false;
      mesh.renderOrder = look === "ghost" ? 2 : 0;
      const shadow = new Mesh(made, this.shadowMaterial);
      shadow.matrixAutoUpdate = false;
      shadow.renderOrder = 1;
      this.parts.push({ body: shape.body, mesh, local, shadow });
      this.group.add(mesh);
      this.shadow.add(shadow);
    }
    this.shadow.visible = look === "solid" && !model.rough;
    this.group.add(this.shadow);
  }

  paint(theme: Theme): void {
    this.shadowMaterial.color.set(theme.shadow);
    this.ghostMaterial?.color.set(theme.ghost);
  }

  pose(posture: Posture): void {
    for (const { body, mesh, local, shadow } of this.parts) {
      const here = posture.bodies[body];
      if (!here) continue;
      mesh.matrix.multiplyMatrices(here, local);
      mesh.matrixWorldNeedsUpdate = true;
      shadow.matrix.multiplyMatrices(FLATTEN, mesh.matrix);
      shadow.matrixWorldNeedsUpdate = true;
    }
  }
}

/** Moves every point along the light to the floor. */
const FLATTEN = new Matrix4().set(
  1, 0, -SUN.x / SUN.z, 0,
  0, 1, -SUN.y / SUN.z, 0,
  0, 0, 0.0001, SHADOW_HEIGHT,
  0, 0, 0, 1,
);

function material(shape: ShapeModel, known: Map<string, Material>): Material {
  const [red, green, blue, opacity] = shape.rgba;
  const key = shape.rgba.join();
  const found = known.get(key);
  if (found) return found;
  const made = new MeshPhongMaterial({
    color: new Color().setRGB(red, green, blue, SRGBColorSpace),
    specular: 0x222222,
    shininess: 40,
    transparent: opacity < 1,
    opacity,
  });
  known.set(key, made);
  return made;
}

/** Round shapes of the model lie along z, those of three.js along y. */
function geometry({ type, size }: ShapeModel): BufferGeometry | undefined {
  const [a = 0, b = 0, c = 0] = size;
  switch (type) {
    case "sphere":
      return new SphereGeometry(a, 28, 20);
    case "ellipsoid":
      return new SphereGeometry(1, 28, 20);
    case "capsule":
      return new CapsuleGeometry(a, 2 * b, 8, 24).rotateX(Math.PI / 2);
    case "cylinder":
      return new CylinderGeometry(a, a, 2 * b, 28).rotateX(Math.PI / 2);
    case "box":
      return new BoxGeometry(2 * a, 2 * b, 2 * c);
    default:
      return undefined;
  }
}
