#!/usr/bin/env python3
"""Plays the commands of recorded crawls in Bullet, another engine, and compares how far and how high they go.

    pip install pybullet==3.2.7 numpy
    prone crawl run low-175 --cycles 4 --record out/low-175
    python docs/replay_in_bullet.py out/low-175 --ceiling-mm 178

Contacts, joints and solver are Bullet's. Of prone it uses the robot as URDF, which `prone export` makes of
the record, and these files of the record:

    run.json             friction, and the figures of each motor
    start.json           pose, posture and speeds when the first pull begins
    commands.csv         every command to the joints, with the time at which it was given
    robot.compiled.json  which bodies are the head
    rows.csv             every 20 ms, for comparison: pose of the root, highest points, force on the head

The crawl begins in that state and gets those commands. Nothing that was measured later is fed back.
What is supposed:

    motors     u = clip(K e, ± supply), torque = clip(u - b w, ± current limit), at each step of Bullet.
               Joints that one motor turns share its torque
    rotors     URDF has no rotor inertia: each joint gets a rotor with that of robot.xml, as a link that is
               geared to the joint. The motor turns the rotor
    contacts   hard, without restitution; Coulomb's cone with the friction of the record. What overlaps
               is parted with a time constant of 20 ms. Parts of the robot do not touch one another, as
               in prone
    heights    of the URDF's collision shapes. Spheres stand in for ellipsoids: on the NAO they are at most
               0.2 mm lower on the head and 1.2 mm on the chest

Exit code: 0 where the engines agree, 1 where the advance of a record differs by more than --within-percent
or its highest point is over the ceiling by more than --ceiling-within-mm, 2 where this script cannot play
a record.
"""

import argparse
import contextlib
import csv
import ctypes
import json
import os
import shlex
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np

FORMAT = 3
ROOT = Path(__file__).resolve().parents[1]
# A rotor is a link that turns GEAR times as fast as its joint. The ratios of the NAO are 51 to 201; which one it is
# hardly matters, as the rotor weighs next to nothing and its inertia at the joint is given.
GEAR, ROTOR, ROTOR_KG = 100.0, " rotor", 1e-6
# More than any gear has to hold, as torque on the rotor.
GEAR_NM = 1e3
# With 50 the advance is the same to 0.1 mm.
ITERATIONS = 100
# Bullet takes a share of a penetration away at each step; it is to be the same in time, whatever the step.
RECOVERY_S = 0.02
HEAD_TOUCHES_N = 1.0


@contextlib.contextmanager
def quiet():
    """Sends to standard error what a library writes to standard output: Bullet greets there."""
    sys.stdout.flush()
    kept = os.dup(1)
    os.dup2(2, 1)
    try:
        yield
    finally:
        ctypes.CDLL(None).fflush(None)
        os.dup2(kept, 1)
        os.close(kept)


with quiet():
    import pybullet as bullet


class Motor:
    """A direct-current motor and its controller, with the figures of run.json. It may turn two joints."""

    def __init__(self, name, figures):
        if figures["law"] != "dc-motor":
            raise ValueError(f"the law of {name} is {figures['law']}, and this script knows motors only")
        self.joints = figures["joints"]
        self.stiffness = figures["stiffness_nm_rad"]
        self.supply = figures["supply_torque_nm"]
        self.limit = figures["current_torque_nm"]
        self.back_emf = figures["back_emf_nms_rad"]

    def torque(self, error, speed):
        """Torque on each of its joints, N·m, from their position errors and speeds."""
        supplied = np.clip(self.stiffness * error.mean(), -self.supply, self.supply)
        return np.clip(supplied - self.back_emf * speed.mean(), -self.limit, self.limit) / len(self.joints)


class Shapes:
    """The collision shapes of a URDF, to find the highest point of them."""

    def __init__(self, urdf, links):
        self.links, places, turns, self.reaches = [], [], [], []
        for link in urdf.iter("link"):
            for shape in link.iter("collision"):
                place, turn = origin_of(shape)
                solid = shape.find("geometry")[0]
                self.links.append(links[link.get("name")])
                places.append(place)
                turns.append(turn)
                self.reaches.append(reach_of(solid))
        self.places, self.turns = np.array(places), np.array(turns)

    def top(self, origins, rotations):
        """Height of the highest point, m, from origin and rotation matrix of each link."""
        up = rotations[self.links, 2]  # the world's z in the link's frame
        centres = origins[self.links, 2] + np.einsum("ij,ij->i", up, self.places)
        along = np.einsum("ij,ijk->ik", up, self.turns)  # the world's z in the shape's frame
        return max(centre + reach(z) for centre, reach, z in zip(centres, self.reaches, along))


def reach_of(solid):
    """How far a solid reaches from its middle along a unit vector of its own frame, as a function, m."""
    if solid.tag == "sphere":
        radius = float(solid.get("radius"))
        return lambda z: radius
    if solid.tag == "box":
        half = np.array(numbers(solid.get("size"))) / 2
        return lambda z: np.abs(z) @ half
    if solid.tag == "cylinder":
        radius, half = float(solid.get("radius")), float(solid.get("length")) / 2
        return lambda z: radius * np.hypot(z[0], z[1]) + half * abs(z[2])
    raise ValueError(f"the URDF has a shape that this script does not know: {solid.tag}")


def numbers(text):
    return [float(part) for part in text.split()]


def origin_of(element):
    """Place and rotation matrix of a URDF element in its link."""
    origin = element.find("origin")
    turn = bullet.getQuaternionFromEuler(numbers(origin.get("rpy")))
    return np.array(numbers(origin.get("xyz"))), matrix_of(turn)


def matrix_of(quaternion_xyzw):
    return np.array(bullet.getMatrixFromQuaternion(quaternion_xyzw)).reshape(3, 3)


def rotor_inertias(robot_xml):
    """Rotor inertia of each joint, kg·m², as the MJCF file says it."""
    tree = ElementTree.parse(robot_xml).getroot()
    if tree.find("default/default/joint") is not None:
        raise ValueError(f"{robot_xml} has classes of joints, which this script does not read")
    common = tree.find("default/joint")
    common = 0.0 if common is None else float(common.get("armature", 0.0))
    joints = tree.find("worldbody").iter("joint")
    return {joint.get("name"): float(joint.get("armature", common)) for joint in joints}


def with_rotors(urdf, rotors):
    """Gives each hinge a rotor beside it, a ball of its own on the same axis; takes out what is drawn.

    Its kinetic energy is A (q' + s / GEAR)² / 2, with rotor inertia A at the joint, the joint's speed q' and
    the parent link's speed s about the axis.
    """
    for link in urdf.iter("link"):
        for drawn in link.findall("visual"):
            link.remove(drawn)
    robot = urdf.getroot()
    for joint in [joint for joint in urdf.iter("joint") if joint.get("type") == "revolute"]:
        name = joint.get("name")
        link = ElementTree.SubElement(robot, "link", name=name + ROTOR)
        inertial = ElementTree.SubElement(link, "inertial")
        ElementTree.SubElement(inertial, "origin", xyz="0 0 0", rpy="0 0 0")
        ElementTree.SubElement(inertial, "mass", value=str(ROTOR_KG))
        own = str(rotors[name] / GEAR**2)
        ElementTree.SubElement(inertial, "inertia", ixx=own, iyy=own, izz=own, ixy="0", ixz="0", iyz="0")
        rotor = ElementTree.SubElement(robot, "joint", name=name + ROTOR, type="continuous")
        ElementTree.SubElement(rotor, "child", link=name + ROTOR)
        rotor.extend(joint.find(part) for part in ("origin", "parent", "axis"))


def export(record, prone, folder):
    """The robot of a record as URDF, by the program."""
    path = Path(folder) / "robot.urdf"
    command = [*prone, "export", str(record), "--format", "urdf", "--out", str(path)]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        raise ValueError(f"{shlex.join(command)}: {done.stderr.strip()}")
    return path


class World:
    """The robot on a level floor in Bullet, in the state in which a record begins."""

    def __init__(self, urdf_path, robot_xml, start, friction, gravity, step):
        urdf = ElementTree.parse(urdf_path)
        with_rotors(urdf, rotor_inertias(robot_xml))
        bullet.resetSimulation()
        bullet.setGravity(*gravity)
        bullet.setPhysicsEngineParameter(
            fixedTimeStep=step,
            numSubSteps=0,
            numSolverIterations=ITERATIONS,
            solverResidualThreshold=0,
            erp=step / RECOVERY_S,
            contactERP=step / RECOVERY_S,
            frictionERP=step / RECOVERY_S,
            enableConeFriction=1,
            deterministicOverlappingPairs=1,
            enableFileCaching=0,
        )
        self.floor = bullet.createMultiBody(0, bullet.createCollisionShape(bullet.GEOM_PLANE))
        bullet.changeDynamics(self.floor, -1, lateralFriction=1.0, restitution=0.0)
        with tempfile.NamedTemporaryFile(suffix=".urdf") as file:
            urdf.write(file.name)
            # Without a flag for it, links of one robot do not touch one another.
            self.robot = bullet.loadURDF(file.name, flags=bullet.URDF_USE_INERTIA_FROM_FILE)
        infos = [bullet.getJointInfo(self.robot, link) for link in range(bullet.getNumJoints(self.robot))]
        self.links = {bullet.getBodyInfo(self.robot)[0].decode(): -1}
        self.links |= {info[12].decode(): info[0] for info in infos}
        # Index 0 is the root in `poses`, so a link's index is one more than Bullet's.
        self.shapes = Shapes(urdf, {name: link + 1 for name, link in self.links.items()})
        hinges = [info for info in infos if info[2] == bullet.JOINT_REVOLUTE]
        hinges = {info[1].decode(): info[0] for info in hinges}
        self.joints = {name: link for name, link in hinges.items() if not name.endswith(ROTOR)}
        self.rotors = {name: hinges[name + ROTOR] for name in self.joints}
        masses = [bullet.getDynamicsInfo(self.robot, link)[0] for link in self.links.values()]
        self.mass = sum(masses) - ROTOR_KG * len(self.rotors)
        for link in self.links.values():
            # Bullet multiplies the friction of both bodies. Damping of its own is not wanted.
            bullet.changeDynamics(
                self.robot,
                link,
                lateralFriction=friction,
                spinningFriction=0.0,
                rollingFriction=0.0,
                restitution=0.0,
                linearDamping=0.0,
                angularDamping=0.0,
                jointDamping=0.0,
                maxJointVelocity=1e5,
            )
        for name, link in self.joints.items():
            rotor = self.rotors[name]
            for hinge in (link, rotor):  # A motor that holds every hinge is there from the beginning.
                bullet.setJointMotorControl2(self.robot, hinge, bullet.VELOCITY_CONTROL, force=0.0)
            here = [0.0, 0.0, 0.0]
            gear = bullet.createConstraint(
                self.robot, rotor, self.robot, link, bullet.JOINT_GEAR, [0.0, 0.0, 1.0], here, here
            )
            # Speeds alone are geared: at which angle a rotor is does not matter.
            bullet.changeConstraint(gear, gearRatio=-GEAR, maxForce=GEAR_NM, erp=0.0)
        self.root_from_centre = bullet.getDynamicsInfo(self.robot, -1)[3:5]
        self.begin(start)

    def begin(self, start):
        for joint, link in self.joints.items():
            speed = start["speeds_rad_s"][joint]
            bullet.resetJointState(self.robot, link, start["angles_rad"][joint], speed)
            bullet.resetJointState(self.robot, self.rotors[joint], 0.0, GEAR * speed)
        w, x, y, z = start["quaternion_wxyz"]
        root = (start["position_m"], (x, y, z, w))
        # Bullet means the centre of mass of the root; the engine of the record its origin, and turns in its axes.
        bullet.resetBasePositionAndOrientation(
            self.robot, *bullet.multiplyTransforms(*root, *self.root_from_centre)
        )
        matrix = matrix_of(root[1])
        turning = matrix @ start["angular_velocity_rad_s"]
        of_centre = start["velocity_m_s"] + np.cross(turning, matrix @ self.root_from_centre[0])
        bullet.resetBaseVelocity(self.robot, of_centre, turning)

    def poses(self):
        """Origins, m, and rotation matrices of all links, the root first."""
        centre = bullet.getBasePositionAndOrientation(self.robot)
        root = bullet.multiplyTransforms(*centre, *bullet.invertTransform(*self.root_from_centre))
        states = bullet.getLinkStates(
            self.robot, range(bullet.getNumJoints(self.robot)), computeForwardKinematics=True
        )
        all_of_them = [root, *(state[4:6] for state in states)]
        return np.array([at for at, _ in all_of_them]), np.array([matrix_of(turn) for _, turn in all_of_them])

    def force_on(self, links):
        """Normal force of the floor on these links over the last step, N."""
        points = (point for link in links for point in bullet.getContactPoints(self.floor, self.robot, -1, link))
        return sum(point[9] for point in points)


def play(world, motors, names, given, commands, time, step, head):
    """Root place and matrix at the start and each row; highest point, m, and force on the head, N, of each row."""
    step_of_row = np.rint(np.concatenate([[0.0], time]) / step).astype(int)
    # A command holds from the instant at which it is given until the next one.
    of_step = np.searchsorted(given, step * np.arange(step_of_row[-1]) + 1e-6, side="right") - 1
    links = [world.joints[name] for name in names]
    rotors = [world.rotors[name] for name in names]
    of_motor = [[names.index(name) for name in motor.joints] for motor in motors]
    poses, tops, forces = [world.poses()], [], []
    torque = np.zeros(len(names))
    for begin, end in zip(step_of_row, step_of_row[1:]):
        force = 0.0
        for k in range(begin, end):
            states = bullet.getJointStates(world.robot, links)
            angles, speeds = np.array([state[:2] for state in states]).T
            errors = commands[of_step[k]] - angles
            for motor, its in zip(motors, of_motor):
                torque[its] = motor.torque(errors[its], speeds[its])
            bullet.setJointMotorControlArray(world.robot, rotors, bullet.TORQUE_CONTROL, forces=torque / GEAR)
            bullet.stepSimulation()
            force += world.force_on(head)
        poses.append(world.poses())
        tops.append(world.shapes.top(*poses[-1]))
        forces.append(force / (end - begin))
    roots = [(origins[0], rotations[0]) for origins, rotations in poses]
    return roots, np.array(tops), np.array(forces)


def heading_of(matrix):
    """Where the root's z axis, the trunk's top, points on the floor, as a unit vector."""
    return matrix[:2, 2] / np.linalg.norm(matrix[:2, 2])


def measure(cycle, roots, tops, forces):
    """Advance of each cycle along the heading with which it begins, and what is compared of the whole."""
    advances, turned = [], 0.0
    for number in np.unique(cycle):
        rows = np.flatnonzero(cycle == number)
        (start, matrix), (end, matrix_after) = roots[rows[0]], roots[rows[-1] + 1]  # root 0 is the start
        before, after = heading_of(matrix), heading_of(matrix_after)
        advances.append((end - start)[:2] @ before * 1e3)
        turned += np.degrees(np.arctan2(before[0] * after[1] - before[1] * after[0], before @ after))
    return {
        "advance_mm": float(np.mean(advances)),
        "advance_of_cycles_mm": [float(advance) for advance in advances],
        "top_mm": float(tops.max() * 1e3),
        "yaw_deg": float(turned),
        "head_peak_n": float(forces.max()),
        "head_share_of_time": float(np.mean(forces > HEAD_TOUCHES_N)),
    }


def check(run):
    """Refuses what this script does not model."""
    if run["record"].get("format") != FORMAT:
        raise ValueError(f"its format is {run['record'].get('format')}, and this script reads {FORMAT}")
    if run["command"] != "crawl run":
        raise ValueError(f"it is no crawl: `prone {run['command']}` wrote it")
    origin, scene = run["origin"], run["scene"]
    if origin["kind"] != "simulated":
        raise ValueError(f"it was not simulated: its origin is {origin['kind']}")
    if origin["stops"] != "the manufacturer's":
        raise ValueError("its stops are not those of the URDF")
    if scene["obstacles"] or scene["rough"] or scene["slope_deg"]:
        raise ValueError("its floor is not level and empty")
    if scene["friction_left"] != scene["friction_right"]:
        raise ValueError("its friction differs between left and right")
    if any(run["options"].get("joint_offsets_rad", [])):
        raise ValueError("its joints have calibration errors, which recorded commands are without")


def read_json(path):
    """What a file of the record holds; an error names the file."""
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except ValueError as problem:
        raise ValueError(f"{path.name}: {problem}") from problem


def read_table(path, lines=None):
    """Columns of a table by name, as numbers where they are asked for."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    if not rows or None in rows[-1].values() or lines not in (None, len(rows)):
        raise ValueError(f"{path.name} was cut off")

    def columns(names):
        try:
            values = np.array([[float(row[name]) for name in names] for row in rows])
        except ValueError as problem:
            raise ValueError(f"{path.name}: {problem}") from problem
        if not np.isfinite(values).all():
            raise ValueError(f"{path.name} has what is no number in {', '.join(names[:3])} …")
        return values

    return columns, list(rows[0])


def play_and_measure(record, args, folder):
    """What was recorded, and what Bullet makes of the same commands."""
    run = read_json(record / "run.json")
    check(run)
    step = args.step_ms / 1e3
    robot = read_json(record / "robot.compiled.json")["robot"]
    robot_xml = args.robot_xml or ROOT / run["robot"]["folder"] / "robot.xml"
    urdf = args.urdf or export(record, args.prone, folder)
    friction, gravity = run["scene"]["friction_left"], run["origin"]["gravity_m_s2"]
    world = World(urdf, robot_xml, read_json(record / "start.json"), friction, gravity, step)
    kg = sum(body["mass_kg"] for body in robot["bodies"])
    if abs(kg - world.mass) > 1e-4:  # masses have six decimals in the URDF
        raise ValueError(f"its robot weighs {kg:.4f} kg, and that of {urdf} {world.mass:.4f} kg")
    head = [world.links[body["name"]] for body in robot["bodies"] if body["contact_group"] == "head"]
    motors = [Motor(name, figures) for name, figures in run["origin"]["servos"].items()]
    names = [joint["name"] for joint in robot["joints"]]
    if sorted(joint for motor in motors for joint in motor.joints) != sorted(names):
        raise ValueError("its motors are not those of all joints")

    rows, titles = read_table(record / "rows.csv", run["record"]["rows"])
    commands, _ = read_table(record / "commands.csv")
    time, cycle = rows(["time_s", "cycle"]).T
    given = commands(["time_s"])[:, 0]
    if np.any(np.diff(time) <= 0) or np.any(np.diff(given) <= 0) or given[0] > 0:
        raise ValueError("times do not grow row by row from the start of the crawl")
    sent = commands([name + "_cmd_rad" for name in names])

    at, turns = rows(["x_mm", "y_mm", "z_mm"]) / 1e3, rows(["qx", "qy", "qz", "qw"])
    begin = world.poses()
    recorded_roots = [(begin[0][0], begin[1][0]), *zip(at, map(matrix_of, turns))]
    recorded_tops = rows([title for title in titles if title.endswith("_top_mm")]).max(axis=1) / 1e3
    recorded = measure(cycle, recorded_roots, recorded_tops, rows(["head_n"])[:, 0])
    played = measure(cycle, *play(world, motors, names, given, sent, time, step, head))
    return {
        "record": str(record),
        "gait": run["gait"]["name"],
        "friction": friction,
        "cycles": len(np.unique(cycle)),
        "recorded": recorded,
        "bullet": played,
        "advance_differs_percent": 100 * (played["advance_mm"] / recorded["advance_mm"] - 1),
        "top_differs_mm": played["top_mm"] - recorded["top_mm"],
    }


def judge(found, args):
    """Says whether the engines agree, and whether Bullet keeps the ceiling."""
    found["agrees"] = abs(found["advance_differs_percent"]) <= args.within_percent  # not where it is NaN
    if args.ceiling_mm is not None:
        found["ceiling_kept"] = found["bullet"]["top_mm"] <= args.ceiling_mm + args.ceiling_within_mm
        found["agrees"] = found["agrees"] and found["ceiling_kept"]


HEAD = """\
                      mm per cycle          highest, mm        yaw, deg    head, peak N    head, % of time
gait              Bullet record differs  Bullet record differs  Bullet record  Bullet record  Bullet record"""


def line(found):
    its, was = found["bullet"], found["recorded"]
    text = f"{found['gait']:<16}"
    text += f"{its['advance_mm']:8.1f}{was['advance_mm']:7.1f}{found['advance_differs_percent']:+7.1f}%"
    text += f"{its['top_mm']:8.1f}{was['top_mm']:7.1f}{found['top_differs_mm']:+8.1f}"
    for measure, scale in (("yaw_deg", 1), ("head_peak_n", 1), ("head_share_of_time", 100)):
        text += f"{scale * its[measure]:8.1f}{scale * was[measure]:7.1f}"
    if "ceiling_kept" in found:
        text += "  ceiling kept" if found["ceiling_kept"] else "  ceiling not kept"
    return text if found["agrees"] else text + "  differs"


def main():
    parser = argparse.ArgumentParser(description="Plays recorded crawls in Bullet and compares.")
    parser.add_argument("records", type=Path, nargs="+", metavar="RECORD", help="folder that `prone crawl run --record` wrote")
    parser.add_argument("--prone", type=shlex.split, metavar="COMMAND", help="the program that exports the URDF; default: prone on PATH, or else `cargo run --release --`")
    parser.add_argument("--urdf", type=Path, help="the robot of all records, in place of an export")
    parser.add_argument("--robot-xml", type=Path, help="for rotor inertias; default: that of the robot's folder in this repository")
    parser.add_argument("--step-ms", type=float, default=1.0, help="Bullet's step; default 1")
    parser.add_argument("--within-percent", type=float, default=25.0, help="largest difference of the advance; default 25")
    parser.add_argument("--ceiling-mm", type=float, help="also asks whether this height is kept in Bullet")
    parser.add_argument("--ceiling-within-mm", type=float, default=3.0, help="by how much it may be exceeded; default 3")
    parser.add_argument("--json", action="store_true", help="prints JSON in place of the table")
    args = parser.parse_args()
    if args.step_ms not in (1.0, 0.5, 0.25, 0.125):
        parser.error("--step-ms must be 1, 0.5, 0.25 or 0.125: commands are given at whole milliseconds")
    if args.prone is None:
        cargo = ["cargo", "run", "--quiet", "--release", "--manifest-path", str(ROOT / "Cargo.toml"), "--"]
        args.prone = ["prone"] if shutil.which("prone") else cargo

    if not args.json:
        print(HEAD)
    results = []
    with tempfile.TemporaryDirectory() as folder:
        for record in args.records:
            try:
                with quiet():
                    bullet.connect(bullet.DIRECT)
                    found = play_and_measure(record, args, folder)
                    bullet.disconnect()
            except (OSError, ValueError, KeyError, TypeError, IndexError, AttributeError, ElementTree.ParseError) as problem:
                reason = f"it has no {problem}" if isinstance(problem, KeyError) else problem
                print(f"{record}: this script cannot play it: {reason}", file=sys.stderr)
                return 2
            judge(found, args)
            results.append(found)
            if not args.json:
                print(line(found), flush=True)
    if args.json:
        print(json.dumps(results, indent=2))
    return 0 if all(found["agrees"] for found in results) else 1


if __name__ == "__main__":
    sys.exit(main())
