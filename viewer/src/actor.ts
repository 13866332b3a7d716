// A run on its stage: robot, scenery and overlays, all at the same instant.

import { Color, Group, Scene } from "three";
import type { Run } from "./data";
import { Posture } from "./kinematics";
import { ChainView, Forces, MassView } from "./overlays";
import { RobotView } from "./robot";
import { Ruler } from "./ruler";
import { Scenery } from "./scenery";
import type { Theme } from "./theme";

/** What may be shown or hidden. */
export interface Shown {
  chain: boolean;
  forces: boolean;
  mass: boolean;
  ruler: boolean;
}

export class Actor {
  readonly run: Run;
  readonly scene = new Scene();
  readonly posture: Posture;
  readonly ruler: Ruler;
  /** What may appear in the scene of another run. */
  readonly ghost: Group;
  private readonly background = new Color();
  private readonly robot: RobotView;
  private readonly ghostRobot: RobotView;
  private readonly scenery: Scenery;
  private readonly forces: Forces;
  private readonly mass: MassView;
  private readonly chain = new ChainView();

  constructor(run: Run) {
    this.run = run;
    this.posture = new Posture(run);
    this.robot = new RobotView(run.model, this.posture, "solid");
    this.ghostRobot = new RobotView(run.model, this.posture, "ghost");
    this.ghost = this.ghostRobot.group;
    this.scenery = new Scenery(run.model);
    this.forces = new Forces(run);
    this.mass = new MassView(run);
    this.ruler = new Ruler(run.model);
    const { scenery, robot, ruler, forces, mass, chain } = this;
    for (const part of [scenery, robot, ruler, forces, mass, chain]) this.scene.add(part.group);
    this.scene.background = this.background;
  }

  paint(theme: Theme): void {
    this.background.set(theme.background);
    const { scenery, robot, ghostRobot, ruler, forces, mass, chain } = this;
    for (const part of [scenery, robot, ghostRobot, ruler, forces, mass, chain]) part.paint(theme);
  }

  /** Moves everything to an instant; `level` says whether one looks along the floor. */
  show(time: number, shown: Shown, level: boolean): void {
    const { posture } = this;
    this.scenery.setLevel(level);
    posture.set(time);
    this.forces.group.visible = shown.forces;
    if (shown.forces) this.forces.show(this.run.nearest(time));
    this.chain.group.visible = shown.chain;
    if (shown.chain) this.chain.show(posture);
    if (shown.mass) this.mass.show(posture);
    else this.mass.group.visible = false;
    this.ruler.group.visible = shown.ruler;
    this.ruler.show(posture);
  }
}
