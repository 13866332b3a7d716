#!/usr/bin/env python3
"""Replays a recorded crawl in plain MuJoCo and compares the replay with the record.

    pip install mujoco==3.17.0 numpy
    prone crawl run thesis-nominal --cycles 3 --record out/nominal
    python docs/replay_in_mujoco.py out/nominal

This is a second implementation of what a record means. It uses the robot's model and these files of
the record, and nothing of prone:

    run.json             options of the engine, friction, and the law and figures of each motor
    robot.compiled.json  nominal torque of each motor
    start.json           pose, posture and speeds when the first pull begins
    commands.csv         every command to the joints, with the time at which it reached the servos
    rows.csv             every 20 ms: pose of the root; heat and work of each motor since the row before

The replay begins in that state and gets those commands. Nothing that was measured later is fed back.
A robot with other masses, other stiffness, play in its gears or late commands is replayed as it was:
run.json has the factor of the masses, the stiffness and the play of each motor, and commands that were
late stand where they arrived. A record with calibration errors of the joints is refused.
Of both, three things are measured between the same rows: advance along the heading with which a
cycle begins, motor heat, and positive work. They do not agree to the digit: numbers in the tables are
rounded, and where limbs and trunk land on the floor, contacts amplify small differences, more so with
stiff servos.

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

FORMAT = 3
ROOT = Path(__file__).resolve().parents[1]
BOUNDS_PERCENT = {"advance, mm": 1.0, "heat, s": 2.0, "work, J": np.inf}


class Motor:
    """A motor and its controller, with the law and the figures of run.json. It may turn two joints."""

    def __init__(self, name, figures, robot):
        if figures["law"] not in ("dc-motor", "velocity"):
            raise ValueError(f"the law of {name} is {figures['law']}")
        motor = next(joint["motor"] for joint in robot["joints"] if joint["name"] == name)
        if motor is None:
            raise ValueError(f"{name} has no figures of a motor, and no heat")
        self.joints = figures["joints"]
        self.figures = figures
        self.nominal = motor["nominal_nm"]

    def control(self, error, speed):
        """What its actuators are told before an engine step, from position errors and speeds."""
        f = self.figures
        if f["law"] == "velocity":  # the speed that each joint is to have, rad/s
            return np.clip(f["rate_per_s"] * error, -f["speed_rad_s"], f["speed_rad_s"])
        # Within ± half the play of the gear no torque passes; outside, the error counts from its edge.
        half_play = f.get("backlash_rad", 0.0) / 2
        beyond = error.mean() - np.clip(error.mean(), -half_play, half_play)
        # A torque in N·m, cut first by the supply and then by the current limit; the joints share it.
        torque = np.clip(f["stiffness_nm_rad"] * beyond, -f["supply_torque_nm"], f["supply_torque_nm"])
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


def build_model(robot_xml, origin, motors, mass_factor):
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
    if mass_factor != 1.0:  # of masses and inertias, not of the joints' armature
        mujoco.mj_setTotalmass(model, mass_factor * model.body_mass.sum())
        mujoco.mj_setConst(model, mujoco.MjData(model))
    # The back-EMF of a motor is damping of its joints. It acts with the speed after the step.
    for joint, damping in origin["joint_damping_nms_rad"].items():
        model.dof_damping[model.joint(joint).dofadr] = damping
    return model


def begin(model, start):
    """The engine's state when the first pull begins."""
    data = mujoco.MjData(model)
    joints = [model.joint(index).name for index in range(1, model.njnt)]  # 0 is the root
    of = [start["angles_rad"][joint] for joint in joints]
    data.qpos = [*start["position_m"], *start["quaternion_wxyz"], *of]
    speeds = [start["speeds_rad_s"][joint] for joint in joints]
    data.qvel = [*start["velocity_m_s"], *start["angular_velocity_rad_s"], *speeds]
    return data


def replay(model, motors, data, given, commands, time):
    """Pose at the start and at each row, and heat and work of all motors over each row."""
    step = model.opt.timestep
    step_of_row = np.rint(np.concatenate([[0.0], time]) / step).astype(int)
    # A command holds from the instant at which it is given until the next one.
    of_step = np.searchsorted(given, step * np.arange(step_of_row[-1]) + 1e-6, side="right") - 1
    joints = [[model.joint(name).id - 1 for name in motor.joints] for motor in motors]
    actuators = [[model.actuator(name).id for name in motor.joints] for motor in motors]
    poses = np.tile(data.qpos, (len(time) + 1, 1))
    heat, work = np.zeros(len(time)), np.zeros(len(time))
    for row in range(len(time)):
        for k in range(step_of_row[row], step_of_row[row + 1]):
            error, before = commands[of_step[k]] - data.qpos[7:], data.qvel[6:].copy()
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
        poses[row + 1] = data.qpos
    return poses, heat, work


def by_cycle(cycle, poses, heat, work):
    """Advance, heat and work of each cycle and of all, between its last row and that of the one before."""
    sums = []
    for number in np.unique(cycle):
        rows = np.flatnonzero(cycle == number)
        start, end = poses[rows[0]], poses[rows[-1] + 1]  # pose 0 is the start, before the first row
        w, x, y, z = start[3:7]
        heading = np.array([x * z + w * y, y * z - w * x])  # where the root's z axis, the trunk's top, points
        advance = (end - start)[:2] @ heading / np.linalg.norm(heading)
        sums.append([advance * 1e3, heat[rows].sum(), work[rows].sum()])
    return np.array([*sums, np.sum(sums, axis=0)])


def check(run):
    """Refuses what this script does not model."""
    if run["record"].get("format") != FORMAT:
        raise ValueError(f"its format is {run['record'].get('format')}, and this script reads {FORMAT}")
    if run["command"] != "crawl run":
        raise ValueError(f"it is no crawl: `prone {run['command']}` wrote it")
    origin, scene = run["origin"], run["scene"]
    if not origin.get("time_step_s", 1.0) > 0:
        raise ValueError(f"its engine step is {origin['time_step_s']} s")
    if origin["kind"] != "simulated":
        raise ValueError(f"it was not simulated: its origin is {origin['kind']}")
    if scene["obstacles"] or scene["rough"] or scene["slope_deg"]:
        raise ValueError("its floor is not level and empty")
    if {scene["friction_left"], scene["friction_right"]} != {origin["friction"]}:
        raise ValueError("its scene has a friction of its own")
    if not run["options"].get("mass_factor", 1.0) > 0:
        raise ValueError(f"its masses are times {run['options']['mass_factor']}")
    if run["options"].get("backlash_deg", 0) and not any("backlash_rad" in it for it in origin["servos"].values()):
        raise ValueError("its gears have play, and the figures of its motors do not say how much")
    if any(run["options"].get("joint_offsets_rad", [])):
        raise ValueError("its joints have calibration errors, which recorded commands are without")


def read_json(path):
    """What a file of the record holds; an error names the file."""
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except ValueError as problem:
        raise ValueError(f"{path.name}: {problem}") from problem


def replay_and_measure(record, robot_xml):
    """Cycle numbers, and advance, heat and work by cycle and of all: recorded and replayed."""
    run = read_json(record / "run.json")
    check(run)
    origin = run["origin"]
    robot = read_json(record / "robot.compiled.json")["robot"]
    motors = [Motor(name, figures, robot) for name, figures in origin["servos"].items()]
    if robot_xml is None:
        robot_xml = ROOT / run["robot"]["folder"] / "robot.xml"
    mass_factor = run["options"].get("mass_factor", 1.0)
    model = build_model(robot_xml.read_text(encoding="utf-8"), origin, motors, mass_factor)
    # robot.compiled.json has the robot as its model says.
    recorded_kg, kg = sum(body["mass_kg"] for body in robot["bodies"]), model.body_mass.sum() / mass_factor
    if abs(kg - recorded_kg) > 1e-6:
        raise ValueError(f"its robot weighs {recorded_kg:.4f} kg, and that of {robot_xml} {kg:.4f} kg: see --robot-xml")
    if origin["engine"] != f"MuJoCo {mujoco.__version__}":
        print(f"recorded with {origin['engine']}, replayed with {mujoco.__version__}", file=sys.stderr)

    def read(name, lines=None):
        with open(record / name, newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        if not rows or None in rows[-1].values() or lines not in (None, len(rows)):
            raise ValueError(f"{name} was cut off")

        def numbers(*columns):
            try:
                values = np.array([[float(row[column]) for column in columns] for row in rows])
            except ValueError as problem:
                raise ValueError(f"{name}: {problem}") from problem
            if not np.isfinite(values).all():
                raise ValueError(f"{name} has what is no number in {', '.join(columns[:3])} …")
            return values

        return numbers

    joints = [model.joint(index).name for index in range(1, model.njnt)]
    rows, commands = read("rows.csv", run["record"]["rows"]), read("commands.csv")
    time, cycle = rows("time_s", "cycle").T
    given = commands("time_s")[:, 0]
    for name, times in (("rows.csv", time), ("commands.csv", given)):
        if np.any(np.diff(times) <= 0) or times[0] < 0 or times[-1] > time[0] + run["record"]["row_step_s"] * len(time):
            raise ValueError(f"times in {name} do not grow row by row")
    if given[0] > 0:
        raise ValueError("commands.csv does not begin with the crawl")
    data = begin(model, read_json(record / "start.json"))
    poses = np.hstack([rows("x_mm", "y_mm", "z_mm") / 1e3, rows("qw", "qx", "qy", "qz")])
    recorded = (
        np.vstack([data.qpos[:7], poses]),
        rows(*(joint + "_heat_s" for joint in joints)).sum(axis=1),
        rows(*(joint + "_work_j" for joint in joints)).sum(axis=1),
    )
    sent = commands(*(joint + "_cmd_rad" for joint in joints))
    replayed = replay(model, motors, data, given, sent, time)
    return np.unique(cycle), by_cycle(cycle, *recorded), by_cycle(cycle, *replayed)


def main():
    parser = argparse.ArgumentParser(description="Replays a recorded crawl in plain MuJoCo.")
    parser.add_argument("record", type=Path, help="folder that `prone crawl run --record` wrote")
    parser.add_argument("--robot-xml", type=Path, help="default: that of the robot's folder in this repository")
    args = parser.parse_args()
    try:
        cycles, recorded, replayed = replay_and_measure(args.record, args.robot_xml)
    except (OSError, ValueError, KeyError, TypeError, IndexError, AttributeError, ZeroDivisionError) as problem:
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
