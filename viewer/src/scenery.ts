// What stands around the robot: the floor with its grid, plates, panels, ramps, rough ground, the
// marker.

import {
  BoxGeometry,
  BufferAttribute,
  BufferGeometry,
  CircleGeometry,
  Color,
  DoubleSide,
  EdgesGeometry,
  Group,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshBasicMaterial,
  PlaneGeometry,
  ShaderMaterial,
} from "three";
import type { Model, RoughModel } from "./data";
import { quaternion } from "./kinematics";
import { litSurface, tint } from "./light";
import type { Theme } from "./theme";

/** What one sees through, so that the robot below is seen. */
const GLASS = ["plate", "panel"];

/** Half an edge of the floor that is drawn, m. */
const REACH = 12;

/** How far behind the robot what is below the floor is drawn, and how deep, m. */
const CUT_BEHIND = 4;
const CUT_DEPTH = 2;

export class Scenery {
  readonly group = new Group();
  private readonly floor: ShaderMaterial;
  private readonly glass = litSurface({ opacity: 0.2 });
  private readonly solid = litSurface({ opacity: 1 });
  private readonly edge = new LineBasicMaterial();
  

  /** What is below the floor, for a look along it, from which the floor itself is a line. */
  private readonly cut = new Mesh(new PlaneGeometry(2 * REACH, CUT_DEPTH), new MeshBasicMaterial());

  constructor(model: Model) {
    this.floor = floorMaterial();
    const plane = new Mesh(new PlaneGeometry(2 * REACH, 2 * REACH), this.floor);
    plane.renderOrder = -1;
    this.cut.rotation.x = Math.PI / 2;
    this.cut.position.set(0, CUT_BEHIND, -CUT_DEPTH / 2);
    this.group.add(plane, this.cut);
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
    if (model.rough) this.group.add(new Mesh(roughGround(model.rough), this.solid));
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

  /** Whether one looks along the floor. */
  setLevel(level: boolean): void {
    this.cut.visible = level;
  }

  paint(theme: Theme): void {
    this.cut.material.color.set(theme.earth);
    const colours: [string, number][] = [
      ["ground", theme.floor],
      ["far", theme.background],
      ["light", theme.line],
      ["heavy", theme.heavyLine],
    ];
    for (const [name, colour] of colours) {
      (this.floor.uniforms[name]?.value as Color).set(colour);
    }
    tint(this.glass, theme.glass);
    this.edge.color.set(theme.heavyLine);
    tint(this.solid, theme.solid);
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
      float lines(vec2 at, vec2 size, float width) {
        vec2 near = abs(fract(at - 0.5) - 0.5) / size;
        vec2 line = clamp(width - near + 0.5, 0.0, 1.0) * clamp(1.0 - 2.5 * size, 0.0, 1.0);
        return max(line.x, line.y);
      }
      void main() {
        vec2 size = fwidth(place);
        vec3 colour = mix(ground, light, lines(place * 10.0, size * 10.0, 0.5));
        colour = mix(colour, heavy, lines(place * 2.0, size * 2.0, 0.8));
        gl_FragColor = vec4(mix(colour, far, smoothstep(3.0, 9.0, away)), 1.0);
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
