// Surfaces in the light of a sun and a sky. Colours are those of the screen from end to end, with
// no conversion between: so they are as written, and cheap where there is no graphics card.

import { Color, ColorManagement, DoubleSide, Matrix4, ShaderMaterial, Vector3 } from "three";

ColorManagement.enabled = false;

/** Where the sun stands, in the ground frame. */
export const SUN = new Vector3(-0.35, -0.5, 1);

const FRAGMENT = `
  uniform vec3 sun;
  uniform float opacity;
  varying vec3 shade, normalInGround, place;
  void main() {
    vec3 n = normalize(normalInGround);
    vec3 eye = normalize(cameraPosition - place);
    if (dot(n, eye) < 0.0) n = -n;
    float gloss = max(dot(n, normalize(sun + eye)), 0.0);
    gloss *= gloss; gloss *= gloss; gloss *= gloss; gloss *= gloss;
    float light = 0.5 + 0.2 * n.z + 0.38 * max(dot(n, sun), 0.0);
    gl_FragColor = vec4(min(shade * light + 0.1 * gloss, 1.0), opacity);
  }`;

/** A surface of one colour that stays where it is. */
export function litSurface(look: { opacity: number }): ShaderMaterial {
  return new ShaderMaterial({
    uniforms: uniforms(look.opacity, { colour: { value: new Color() } }),
    vertexShader: `
      uniform vec3 colour;
      varying vec3 shade, normalInGround, place;
      void main() {
        vec4 at = modelMatrix * vec4(position, 1.0);
        place = at.xyz;
        normalInGround = mat3(modelMatrix) * normal;
        shade = colour;
        gl_Position = projectionMatrix * viewMatrix * at;
      }`,
    fragmentShader: FRAGMENT,
    transparent: look.opacity < 1,
    depthWrite: look.opacity === 1,
    side: DoubleSide,
  });
}

/** Attribute `body` says which of `bodies` moves a corner. */
const MOVED = (bodies: number) => `
  uniform mat4 bodies[${bodies}];
  attribute float body;
  vec4 moved() { return bodies[int(body)] * vec4(position, 1.0); }`;

/** The surfaces of bodies that move, each corner with its colour, or all with that of a ghost. */
export function litBodies(bodies: Matrix4[], look: { ghost: boolean }): ShaderMaterial {
  return new ShaderMaterial({
    uniforms: uniforms(look.ghost ? 0.4 : 1, {
      bodies: { value: bodies },
      colour: { value: new Color() },
    }),
    vertexShader: `
      uniform vec3 colour;
      attribute vec3 paint;
      varying vec3 shade, normalInGround, place;
      ${MOVED(bodies.length)}
      void main() {
        vec4 at = moved();
        place = at.xyz;
        normalInGround = mat3(bodies[int(body)]) * normal;
        shade = ${look.ghost ? "colour" : "paint"};
        gl_Position = projectionMatrix * viewMatrix * at;
      }`,
    fragmentShader: FRAGMENT,
    transparent: look.ghost,
  });
}

/** The shadow of bodies on the floor, a little above its lines. */
export function shadowOfBodies(bodies: Matrix4[]): ShaderMaterial {
  return new ShaderMaterial({
    uniforms: {
      bodies: { value: bodies },
      sun: { value: SUN },
      colour: { value: new Color() },
    },
    vertexShader: `
      uniform vec3 sun;
      ${MOVED(bodies.length)}
      void main() {
        vec4 at = moved();
        at.xy -= sun.xy / sun.z * at.z;
        at.z = 0.0008;
        gl_Position = projectionMatrix * viewMatrix * at;
      }`,
    fragmentShader: `
      uniform vec3 colour;
      void main() { gl_FragColor = vec4(colour, 0.26); }`,
    transparent: true,
    // Seen from above, what faces the sun before it is flat faces the eye after: half is enough.
    depthWrite: false,
  });
}

/** Sets a material's colour. */
export function tint(material: ShaderMaterial, colour: number): void {
  (material.uniforms["colour"]?.value as Color).set(colour);
}

function uniforms(opacity: number, more: Record<string, { value: unknown }>) {
  return { sun: { value: SUN.clone().normalize() }, opacity: { value: opacity }, ...more };
}
