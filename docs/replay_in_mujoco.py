#!/usr/bin/env python3
"""Replays a recorded crawl in plain MuJoCo and compares the replay with the record.

    pip install mujoco==3.17.0 numpy
    prone crawl run thesis-nominal --cycles 3 --record out/nominal
    python docs/replay_in_mujoco.py out/nominal --robot-xml robots/nao/v4/robot.xml

This is a second implementation of what a record means. It uses the robot's model and these files of
the record, and nothing of prone:

    run.json             options of the engine, friction, and the law and figures of each motor
    robot.compiled.json  nominal torque of each motor, motors that turn two joints, stops of a study
    rows.csv             every 20 ms: pose of the root, angles and commands of the joints at that
                         instant; heat and work of each motor since the row before

The replay begins in the state of the record's second row and gets the recorded commands from there
on. Nothing that was measured later is fed back. Of both, three things are measured between the same
rows: advance along the heading with which a cycle begins, motor heat, and positive work.

The two do not agree exactly, for two reasons. Rows are 20 ms apart while the motors get a command
every 10 ms, so that every other command has to be guessed. And where limbs and trunk land on the
floor, contacts amplify small differences: more so with stiff servos.

Exit code: 0 where they agree, 1 where advance or heat of the whole record differ by more than
BOUNDS_PERCENT, 2 where this script cannot replay the record.
"""

import argparse
import csv
import json
import sys
from pathlib import Path

import mujoco
import numpy as np

NAO = Path(__file__).resolve().parents[1] / "robots/nao/v4/robot.xml"
BOUNDS_PERCENT = {"advance, mm": 1.0, "heat, s": 2.0, "work, J": np.inf}


class Motor:
    """A motor and its controller, with the law and the figures of run.json. It may turn two joints."""

    def __init__(self, name, figures, robot):
        shared = {joints[0]: joints for joints in robot["shared_motors"]}
        self.joints = figures.get("joints") or shared.get(name, [name])
        self.figures = figures
        self.nominal = next(joint["motor"]["nominal_nm"] for joint in robot["joints"] if joint["name"] == name)

    def control(self, error, speed):
        """What its actuators are told before an engine step, from position errors and speeds."""
        f = self.figures
        if f["law"] == "velocity":  # the speed that each joint is to have, rad/s
            return np.clip(f["rate_per_s"] * error, -f["speed_rad_s"], f["speed_rad_s"])
        # A torque in N·m, cut first by the supply and then by the current limit; the joints share it.
        torque = np.clip(f["stiffness_nm_rad"] * error.mean(), -f["supply_torque_nm"], f["supply_torque_nm"])
        back_emf, limit = f["back_emf_nms_rad"] * speed.mean(), f["current_torque_nm"]
        return np.clip(torque, back_emf - limit, back_emf + limit) / len(self.joints)

    def applied(self, control, before, after):
        """Torque that it gave to each joint over the step, from the speeds before and after it."""
        f = self.figures
        if f["law"] == "velocity":  # at its limit, the engine takes the damping away
            asked = f["gain_nms_rad"] * (control - before)
            limited = np.clip(asked, -f["limit_nm"], f["limit_nm"])
            return np.where(limited == asked, f["gain_nms_rad"] * (control - after), limited)
        return control - f["back_emf_nms_rad"] / len(self.joints) * after


def build_model(robot_xml, origin, robot, motors):
    """The robot on a level floor, with an actuator for each joint that is named after the joint."""
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
    # Geoms of the robot have contype 0: they touch the floor, whose contype is 1, and never one another.
    floor = spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[5, 5, 0.1], contype=1, conaffinity=1)
    floor.solref, floor.solimp = origin["solref"], origin["solimp"]
    for geom in spec.geoms:
        geom.condim = 3
        geom.friction[0] = origin["friction"]
    for motor in motors:
        for joint in motor.joints:
            actuator = spec.add_actuator(name=joint, target=joint, trntype=mujoco.mjtTrn.mjTRN_JOINT)
            if motor.figures["law"] == "velocity":  # of the study's pulls
                limit = motor.figures["limit_nm"]
                actuator.set_to_velocity(motor.figures["gain_nms_rad"])
                actuator.forcelimited, actuator.forcerange = True, [-limit, limit]
            else:
                actuator.set_to_motor()
    model = spec.compile()
    # The back-EMF of a motor is damping of its joints. It acts with the speed after the step.
    for joint, damping in origin["joint_damping_nms_rad"].items():
        model.dof_damping[model.joint(joint).dofadr] = damping
    if origin["stops"] == "the study's":
        for stop in robot["study"]["stops"]:
            model.joint(stop["joint"]).range = stop["range_rad"]
    return model


def replay(model, motors, command_step, time, poses, commands):
    """Pose at each row, and heat and work of all motors between the rows, from row 1 on."""
    step = model.opt.timestep
    step_of_row = np.rint((time - time[1]) / step).astype(int)
    # A command is the posture that is to be reached when the next command comes. It is known at the
    # rows, and between two rows taken on the straight line.
    ends = time[1] + step * np.arange(1, step_of_row[-1] + 1)
    reached = np.ceil(ends / command_step - 1e-6) * command_step
    command = np.column_stack([np.interp(reached, time, column) for column in commands.T])

    data = mujoco.MjData(model)
    data.qpos = poses[1]
    # Speeds are not recorded; these are the mean ones between the rows before and after.
    mujoco.mj_differentiatePos(model, data.qvel, time[2] - time[0], poses[0], poses[2])
    joints = [[model.joint(name).id - 1 for name in motor.joints] for motor in motors]  # 0 is the root
    actuators = [[model.actuator(name).id for name in motor.joints] for motor in motors]
    poses, heat, work = poses.copy(), np.zeros(len(time)), np.zeros(len(time))
    for row in range(2, len(time)):
        for k in range(step_of_row[row - 1], step_of_row[row]):
            error, before = command[k] - data.qpos[7:], data.qvel[6:].copy()
            controls = [motor.control(error[its], before[its]) for motor, its in zip(motors, joints)]
            for its, control in zip(actuators, controls):
                data.ctrl[its] = control
            mujoco.mj_step(model, data)
            after = data.qvel[6:]
            for motor, its, control in zip(motors, joints, controls):
                torque = motor.applied(control, before[its], after[its])
                power = np.sum(torque * (before[its] + after[its]) / 2)
                heat[row] += (torque.sum() / motor.nominal) ** 2 * step
                work[row] += max(power, 0.0) * step
        poses[row] = data.qpos
    return poses, heat, work


def by_cycle(cycle, poses, heat, work):
    """Advance, heat and work of each cycle and of all, between its last row and that of the one before."""
    sums = []
    for number in np.unique(cycle[2:]):
        rows = np.flatnonzero(cycle == number)
        rows = rows[rows > 1]
        begin, end = poses[rows[0] - 1], poses[rows[-1]]
        w, x, y, z = begin[3:7]
        heading = np.array([x * z + w * y, y * z - w * x])  # where the root's z axis, the trunk's top, points
        advance = (end - begin)[:2] @ heading / np.linalg.norm(heading)
        sums.append([advance * 1e3, heat[rows].sum(), work[rows].sum()])
    return np.array([*sums, np.sum(sums, axis=0)])


def check(run):
    """Refuses what this script does not model."""
    origin, scene = run["origin"], run["scene"]
    if origin["kind"] != "simulated":
        raise ValueError(f"it was not simulated: its origin is {origin['kind']}")
    if scene["obstacles"] or scene["rough"] or scene["slope_deg"]:
        raise ValueError("its floor is not level and empty")
    if {scene["friction_left"], scene["friction_right"]} != {origin["friction"]}:
        raise ValueError("its scene has a friction of its own")
    if any(run["options"].get("joint_offsets_rad", [])):
        raise ValueError("its joints have calibration errors, which recorded commands are without")


def replay_and_measure(record, robot_xml):
    """Cycle numbers, and advance, heat and work by cycle and of all: recorded and replayed."""
    run = json.loads((record / "run.json").read_text(encoding="utf-8"))
    check(run)
    origin = run["origin"]
    robot = json.loads((record / "robot.compiled.json").read_text(encoding="utf-8"))["robot"]
    motors = [Motor(name, figures, robot) for name, figures in origin["servos"].items()]
    model = build_model(robot_xml.read_text(encoding="utf-8"), origin, robot, motors)
    if origin["engine"] != f"MuJoCo {mujoco.__version__}":
        print(f"recorded with {origin['engine']}, replayed with {mujoco.__version__}", file=sys.stderr)

    with open(record / "rows.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    if len(rows) != run["record"]["rows"] or None in rows[-1].values():
        raise ValueError("rows.csv was cut off")

    def table(*columns):
        return np.array([[float(row[column]) for column in columns] for row in rows])

    def of_joints(suffix):
        return table(*(model.joint(index).name + suffix for index in range(1, model.njnt)))

    time, cycle = table("time_s", "cycle").T
    place, turn = table("x_mm", "y_mm", "z_mm") / 1e3, table("qw", "qx", "qy", "qz")
    poses = np.hstack([place, turn, of_joints("_rad")])
    replayed = replay(model, motors, origin["command_step_s"], time, poses, of_joints("_cmd_rad"))
    recorded = poses, of_joints("_heat_s").sum(axis=1), of_joints("_work_j").sum(axis=1)
    return np.unique(cycle[2:]), by_cycle(cycle, *recorded), by_cycle(cycle, *replayed)


def main():
    parser = argparse.ArgumentParser(description="Replays a recorded crawl in plain MuJoCo.")
    parser.add_argument("record", type=Path, help="folder that `prone crawl run --record` wrote")
    parser.add_argument("--robot-xml", type=Path, default=NAO, help="default: %(default)s")
    args = parser.parse_args()
    try:
        cycles, recorded, replayed = replay_and_measure(args.record, args.robot_xml)
    except (OSError, ValueError, KeyError, TypeError, IndexError) as problem:
        reason = f"it has no {problem}" if isinstance(problem, KeyError) else problem
        print(f"{args.record}: this script cannot replay it: {reason}", file=sys.stderr)
        return 2

    percent = 100 * (replayed / recorded - 1)
    print("cycle" + "".join(f"{measure + ' recorded':>22}{'replayed':>10}{'%':>7}" for measure in BOUNDS_PERCENT))
    for label, *measures in zip([*cycles.astype(int), "all"], recorded, replayed, percent):
        print(f"{label:>5}" + "".join(f"{was:22.3f}{now:10.3f}{off:+7.2f}" for was, now, off in zip(*measures)))
    agrees = np.all(np.abs(percent[-1]) <= list(BOUNDS_PERCENT.values()))  # not where it is NaN
    print("The replay agrees with the record." if agrees else "The replay differs from the record.")
    return 0 if agrees else 1


if __name__ == "__main__":
    sys.exit(main())
