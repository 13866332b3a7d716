// What is drawn over the robot: contact forces, centre of mass, planar chain.

import {
  ConeGeometry,
  CylinderGeometry,
  Group,
  Mesh,
  MeshBasicMaterial,
  RingGeometry,
  SphereGeometry,
  Vector3,
} from "three";
import type { Contact, Run } from "./data";
import { CHAIN, type Posture } from "./kinematics";
import type { Theme } from "./theme";

/** Length of an arrow, m/N: the robot's weight, 52 N, is 208 mm. */
const METRES_PER_NEWTON = 0.004;

/** Arrows of less are not drawn, N. */
const LEAST_FORCE = 0.5;

const UP = new Vector3(0, 1, 0);

/** A straight piece from one point to another; three.js has cylinders along y. */
function span(mesh: Mesh, from: Vector3, to: Vector3): void {
  way.subVectors(to, from);
  const length = way.length();
  mesh.visible = length > 1e-5;
  if (!mesh.visible) return;
  mesh.position.addVectors(from, to).multiplyScalar(0.5);
  mesh.quaternion.setFromUnitVectors(UP, way.divideScalar(length));
  mesh.scale.set(1, length, 1);
}

const way = new Vector3();
const tip = new Vector3();
const neck = new Vector3();

/** Seen through everything, drawn last. */
function overlay(): MeshBasicMaterial {
  return new MeshBasicMaterial({ depthTest: false, depthWrite: false, transparent: true });
}

/** What the world does to the robot, at each contact. */
export class Forces {
  readonly group = new Group();
  private readonly run: Run;
  private readonly arrows: { shaft: Mesh; head: Mesh }[] = [];
  private readonly floor = overlay();
  private readonly obstacle = overlay();

  constructor(run: Run) {
    this.run = run;
  }

  paint(theme: Theme): void {
    this.floor.color.set(theme.force);
    this.obstacle.color.set(theme.obstacleForce);
  }

  show(row: number): void {
    const contacts = this.run.contacts(row);
    contacts.forEach((contact, index) => this.arrow(contact, this.at(index)));
    for (const { shaft, head } of this.arrows.slice(contacts.length)) {
      shaft.visible = head.visible = false;
    }
  }

  private arrow(contact: Contact, { shaft, head }: { shaft: Mesh; head: Mesh }): void {
    const force = tip.fromArray(contact.force);
    const length = force.length() * METRES_PER_NEWTON;
    shaft.visible = head.visible = length > LEAST_FORCE * METRES_PER_NEWTON;
    if (!shaft.visible) return;
    shaft.material = head.material = contact.other === "floor" ? this.floor : this.obstacle;
    const start = neck.fromArray(contact.at);
    const direction = force.normalize();
    const headLength = Math.min(0.022, length / 2);
    head.quaternion.setFromUnitVectors(UP, direction);
    head.position.copy(start).addScaledVector(direction, length - headLength / 2);
    head.scale.set(headLength / 0.022, headLength, headLength / 0.022);
    const end = head.position.clone().addScaledVector(direction, -headLength / 2);
    span(shaft, start, end);
  }

  private at(index: number): { shaft: Mesh; head: Mesh } {
    let found = this.arrows[index];
    if (!found) {
      found = { shaft: new Mesh(SHAFT, this.floor), head: new Mesh(HEAD, this.floor) };
      found.shaft.renderOrder = found.head.renderOrder = 10;
      this.group.add(found.shaft, found.head);
      this.arrows[index] = found;
    }
    return found;
  }
}

const SHAFT = new CylinderGeometry(0.0028, 0.0028, 1, 8);
const HEAD = new ConeGeometry(0.009, 1, 12);

/** The centre of mass, and where its weight meets the floor. */
export class MassView {
  readonly group = new Group();
  private readonly material = overlay();
  private readonly ball = new Mesh(new SphereGeometry(0.011, 20, 14), this.material);
  private readonly line = new Mesh(new CylinderGeometry(0.0016, 0.0016, 1, 6), this.material);
  private readonly ring = new Mesh(new RingGeometry(0.012, 0.017, 28), this.material);
  private readonly down: Vector3;
  private readonly place = new Vector3();

  constructor(run: Run) {
    const { slope } = run.model;
    this.down = new Vector3(-Math.sin(slope), 0, -Math.cos(slope));
    for (const mesh of [this.line, this.ring, this.ball]) {
      mesh.renderOrder = 11;
      this.group.add(mesh);
    }
  }

  paint(theme: Theme): void {
    this.material.color.set(theme.mass);
  }

  show(posture: Posture): void {
    this.group.visible = posture.centreOfMass(this.place);
    if (!this.group.visible) return;
    this.ball.position.copy(this.place);
    this.ring.position.copy(this.place).addScaledVector(this.down, -this.place.z / this.down.z);
    this.ring.position.z += 0.001;
    span(this.line, this.ball.position, this.ring.position);
  }
}

/** The planar chain, the middle of both sides, closed along the floor. */
export class ChainView {
  readonly group = new Group();
  private readonly material = overlay();
  private readonly points = CHAIN.map(() => new Vector3());
  private readonly links = CHAIN.map(() => new Mesh(new CylinderGeometry(0.004, 0.004, 1, 8), this.material));
  private readonly nodes = CHAIN.map(() => new Mesh(new SphereGeometry(0.0095, 16, 12), this.material));

  constructor() {
    // The link that closes the chain is the ground: thinner.
    const ground = this.links[CHAIN.length - 1];
    if (ground) ground.geometry = new CylinderGeometry(0.0015, 0.0015, 1, 6);
    for (const mesh of [...this.links, ...this.nodes]) {
      mesh.renderOrder = 12;
      this.group.add(mesh);
    }
  }

  paint(theme: Theme): void {
    this.material.color.set(theme.chain);
  }

  show(posture: Posture): void {
    posture.chain(this.points);
    this.points.forEach((from, index) => {
      const to = this.points[(index + 1) % this.points.length];
      const link = this.links[index];
      this.nodes[index]?.position.copy(from);
      if (link && to) span(link, from, to);
    });
  }
}
