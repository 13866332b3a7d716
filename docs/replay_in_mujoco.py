#!/usr/bin/env python3
"""Replays a recorded crawl in plain MuJoCo and compares it with the record.

    pip install mujoco==3.17.0 numpy
    prone crawl run thesis-nominal --cycles 3 --record out/nominal
    python docs/replay_in_mujoco.py out/nominal --robot-xml robots/nao/v4/robot.xml

This is a second implementation of what a record says, in which nothing of prone is used. It reads
these files of the record:

    run.json             options of the engine, floor, and the law and figures of each motor
    robot.compiled.json  stops of the joints, and nominal torques of their motors
    rows.csv             every 20 ms: commands, angles, pose of the root; heat and work since the row before

The replay begins in the state of the record's second row and is given the recorded commands from
there on; nothing that was measured later is fed back. Advance, heat and positive work are compared
between the same rows, cycle by cycle and over the whole crawl.

Exit code: 0 where the replay agrees, 1 where advance or heat of the whole crawl differ by more than
the bounds below, 2 where the record cannot be replayed here.
"""

import argparse
import csv
import json
import sys
from pathlib import Path

import mujoco
import numpy as np

BOUNDS_PERCENT = {"advance_mm": 1.0, "heat_s": 2.0}
FREE = 6  # speeds of the free root, which come before those of the joints


def main():
    args = argparse.ArgumentParser(description="Replays a recorded crawl in plain MuJoCo.")
    args.add_argument("record", type=Path, help="folder that prone crawl run --record wrote")
    args.add_argument("--robot-xml", type=Path, default=Path("robots/nao/v4/robot.xml"), help="default: %(default)s")
    args = args.parse_args()
    try:
        run = json.loads((args.record / "run.json").read_text())
        robot = json.loads((args.record / "robot.compiled.json").read_text())["robot"]
        with open(args.record / "rows.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        refuse_what_is_not_modelled(run)
        model = build_model(args.robot_xml.read_text(), run, robot)
        recorded, replayed = replay(model, run, robot, rows)
    except (OSError, KeyError, ValueError) as problem:
        sys.exit(f"{args.record} cannot be replayed: {problem!r}") if False else None
        print(f"{args.record} cannot be replayed here: {problem}", file=sys.stderr)
        return 2
    return compare(recorded, replayed)


def refuse_what_is_not_modelled(run):
    """This script has a level floor, without anything on it, and joints that are exact."""
    origin, scene, options = run["origin"], run["scene"], run["options"]
    if origin["kind"] != "simulated":
        raise ValueError(f"it was not simulated but is of kind '{origin['kind']}'")
    if scene["obstacles"] or scene["rough"] or scene["slope_deg"] != 0.0:
        raise ValueError(f"the floor of scene '{scene['name']}' is not level and empty")
    if {scene["friction_left"], scene["friction_right"]} != {origin["friction"]}:
        raise ValueError("the friction of the floor differs from side to side")
    if any(options["joint_offsets_rad"]):
        raise ValueError("its joints have calibration errors, and their commands are recorded without these")


def build_model(robot_xml, run, robot):
    """The robot on a floor, with one actuator per joint that has the joint's name."""
    origin = run["origin"]
    spec = mujoco.MjSpec.from_string(robot_xml)
    option = spec.option
    option.timestep = origin["time_step_s"]
    option.gravity = origin["gravity_m_s2"]
    option.integrator = getattr(mujoco.mjtIntegrator, "mjINT_" + origin["integrator"].upper())
    option.solver = getattr(mujoco.mjtSolver, "mjSOL_" + origin["solver"].upper())
    option.cone = getattr(mujoco.mjtCone, "mjCONE_" + origin["cone"].upper())
    option.iterations = origin["solver_iterations"]
    option.tolerance = origin["solver_tolerance"]
    option.impratio = origin["impratio"]

    # The engine takes the larger friction of two geoms; of three-dimensional contacts (condim 3)
    # only the first figure counts. Geoms of the robot have contype 0 and never touch one another.
    spec.worldbody.add_geom(
        type=mujoco.mjtGeom.mjGEOM_PLANE, size=[5, 5, 0.1], contype=1, conaffinity=1,
        solref=origin["solref"], solimp=origin["solimp"],
    )
    for geom in spec.geoms:
        geom.friction[0] = origin["friction"]
        geom.condim = 3
    for joint, motor in motor_of_joint(origin).items():
        actuator = spec.add_actuator(name=joint, target=joint, trntype=mujoco.mjtTrn.mjTRN_JOINT)
        if motor["law"] == "dc-motor":
            actuator.set_to_motor()
        else:
            actuator.set_to_velocity(motor["gain_nms_rad"])
            actuator.forcelimited = True
            actuator.forcerange = [-motor["limit_nm"], motor["limit_nm"]]
    model = spec.compile()
    # The back-EMF of a motor acts as damping, which the integrator takes at the end of a step.
    for joint, damping in origin["joint_damping_nms_rad"].items():
        model.dof_damping[model.joint(joint).dofadr] = damping
    return model


def motor_of_joint(origin):
    """The motor that turns each joint, by the joint's name; one motor may turn two joints."""
    return {
        joint: {**motor, "name": name}
        for name, motor in origin["servos"].items()
        for joint in motor.get("joints", [name])
    }
