// What stands around the robot: the floor with its grid, plates, panels, ramps, rough ground, the
// marker, and the light.

import {
  BoxGeometry,
  BufferAttribute,
  BufferGeometry,
  CircleGeometry,
  Color,
  DirectionalLight,
  DoubleSide,
  EdgesGeometry,
  Group,
  HemisphereLight,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  PlaneGeometry,
  ShaderMaterial,
} from "three";
import type { Model, RoughModel } from "./data";
import { quaternion } from "./kinematics";
import { SUN } from "./robot";
import type { Theme } from "./theme";

/** What one sees through, so that the robot below is seen. */
const GLASS = ["plate", "panel"];

/** Half an edge of the floor that is drawn, m. */
const REACH = 12;

export class Scenery {
  readonly group = new Group();
  private readonly floor: ShaderMaterial;
  private readonly glass = new MeshLambertMaterial({
    transparent: true,
    opacity: 0.2,
    depthWrite: false,
    side: DoubleSide,
  });
  private readonly solid = new MeshLambertMaterial();
  private readonly edge = new LineBasicMaterial();
  private readonly ground = new MeshLambertMaterial({ flatShading: true, side: DoubleSide });

  constructor(model: Model) {
    const sun = new DirectionalLight(0xffffff, 2.1);
    sun.position.copy(SUN);
    this.group.add(sun, new HemisphereLight(0xffffff, 0x9aa3aa, 1.5));
    this.floor = floorMaterial();
    const plane = new Mesh(new PlaneGeometry(2 * REACH, 2 * REACH), this.floor);
    plane.renderOrder = -1;
    this.group.add(plane);
    for (const obstacle of model.obstacles) {
      const [x, y, z] = obstacle.half_edges;
      const box = new BoxGeometry(2 * x, 2 * y, 2 * z);
      const glass = GLASS.includes(obstacle.kind);
      const mesh = new Mesh(box, glass ? this.glass : this.solid);
      mesh.renderOrder = glass ? 3 : 0;
      mesh.add(new LineSegments(new EdgesGeometry(box), this.edge));
      mesh.position.fromArray(obstacle.position);
      mesh.quaternion.copy(quaternion(obstacle.quaternion));
      this.group.add(mesh);
    }
    if (model.rough) this.group.add(new Mesh(roughGround(model.rough), this.ground));
    if (model.marker) {
      const { position, radius, facing } = model.marker;
      const disc = new Mesh(
        new CircleGeometry(radius, 32),
        new MeshBasicMaterial({ color: 0xd3202a, side: DoubleSide }),
      );
      disc.position.fromArray(position);
      // A circle faces +z; the marker's normal is horizontal.
      disc.rotation.set(0, Math.PI / 2, facing, "ZYX");
      this.group.add(disc);
    }
  }

  paint(theme: Theme): void {
    const colours: [string, number][] = [
      ["ground", theme.floor],
      ["far", theme.background],
      ["light", theme.line],
      ["heavy", theme.heavyLine],
    ];
    for (const [name, colour] of colours) {
      (this.floor.uniforms[name]?.value as Color).set(colour);
    }
    this.glass.color.set(theme.glass);
    this.edge.color.set(theme.heavyLine);
    this.solid.color.set(theme.solid);
    this.ground.color.set(theme.solid);
  }
}

/** Lines 100 mm apart, every fifth heavy; they fade with the distance, where they would flicker. */
function floorMaterial(): ShaderMaterial {
  return new ShaderMaterial({
    uniforms: {
      ground: { value: new Color() },
      far: { value: new Color() },
      light: { value: new Color() },
      heavy: { value: new Color() },
    },
    vertexShader: `
      varying vec2 place;
      varying float away;
      void main() {
        place = position.xy;
        vec4 seen = modelViewMatrix * vec4(position, 1.0);
        away = -seen.z;
        gl_Position = projectionMatrix * seen;
      }`,
    fragmentShader: `
      uniform vec3 ground, far, light, heavy;
      varying vec2 place;
      varying float away;
      float lines(float step, float width) {
        vec2 at = place / step;
        vec2 size = fwidth(at);
        vec2 near = abs(fract(at - 0.5) - 0.5) / size;
        vec2 line = clamp(width - near + 0.5, 0.0, 1.0) * clamp(1.0 - 2.5 * size, 0.0, 1.0);
        return max(line.x, line.y);
      }
      void main() {
        vec3 colour = mix(ground, light, lines(0.1, 0.5));
        colour = mix(colour, heavy, lines(0.5, 0.8));
        gl_FragColor = vec4(mix(colour, far, smoothstep(3.0, 9.0, away)), 1.0);
        #include <colorspace_fragment>
      }`,
  });
}

/** The grid of heights, its middle line on y = 0; row by row towards +y, each towards +x. */
function roughGround(rough: RoughModel): BufferGeometry {
  const { rows, columns } = rough;
  const corners = new Float32Array(3 * rows * columns);
  const faces: number[] = [];
  for (let row = 0; row < rows; row++) {
    for (let column = 0; column < columns; column++) {
      const here = row * columns + column;
      corners[3 * here] = rough.from_x + (rough.length * column) / (columns - 1);
      corners[3 * here + 1] = rough.width * (row / (rows - 1) - 0.5);
      corners[3 * here + 2] = (rough.heights[here] ?? 0) + 0.0002;
      if (row + 1 < rows && column + 1 < columns) {
        const above = here + columns;
        faces.push(here, here + 1, above, above, here + 1, above + 1);
      }
    }
  }
  const made = new BufferGeometry();
  made.setAttribute("position", new BufferAttribute(corners, 3));
  made.setIndex(faces);
  made.computeVertexNormals();
  return made;
}
