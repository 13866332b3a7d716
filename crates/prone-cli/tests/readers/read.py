"""Reads an export with a program of somebody else and prints what it found as one JSON object.

    python3 read.py FORMAT FILE [FILE]

Nothing here knows prone: libraries only are asked.
"""

import json
import os
import re
import subprocess
import sys
import tempfile


def mcap(path):
    from mcap.reader import make_reader
    from mcap_ros2.decoder import DecoderFactory

    with open(path, "rb") as stream:
        reader = make_reader(stream, validate_crcs=True, decoder_factories=[DecoderFactory()])
        summary = reader.get_summary()
        topics = {}
        for schema, channel, message, decoded in reader.iter_decoded_messages():
            topic = topics.setdefault(
                channel.topic,
                {"schema": schema.name, "schema_encoding": schema.encoding, "metadata": channel.metadata,
                 "encoding": channel.message_encoding, "count": 0, "times": [], "first": None},
            )
            topic["count"] += 1
            topic["times"].append(message.log_time)
            plain = as_plain(decoded)
            topic["first"] = topic["first"] or plain
            topic["last"] = plain
        for topic in topics.values():
            times = topic.pop("times")
            topic["in_order"] = times == sorted(times)
            topic["begin_ns"], topic["end_ns"] = times[0], times[-1]
        header = reader.get_header()
        return {
            "profile": header.profile,
            "library": header.library,
            "messages": summary.statistics.message_count,
            "chunks": summary.statistics.chunk_count,
            "channels": sorted(channel.topic for channel in summary.channels.values()),
            "topics": topics,
        }


def as_plain(message):
    if hasattr(message, "__slots__"):
        return {name: as_plain(getattr(message, name)) for name in message.__slots__}
    if isinstance(message, (str, bytes, int, float)):
        return message
    return [as_plain(part) for part in message]


def rosbags(path):
    """A log by itself or a bag's folder, through the reader that takes the one or the other."""
    from rosbags.rosbag2 import Reader
    from rosbags.typesys import Stores, get_typestore, get_types_from_msg

    with Reader(path) as reader:
        types = get_typestore(Stores.EMPTY)
        for connection in reader.connections:
            types.register(get_types_from_msg(connection.msgdef.data, connection.msgtype))
        counts = {}
        for connection, _, raw in reader.messages():
            types.deserialize_cdr(raw, connection.msgtype)
            counts[connection.topic] = counts.get(connection.topic, 0) + 1
        return {
            "messages": reader.message_count,
            "begin_ns": reader.start_time,
            # The end is the first instant after the last message.
            "end_ns": reader.end_time - 1,
            "topics": {
                connection.topic: {
                    "read": counts[connection.topic],
                    "count": connection.msgcount,
                    "type": connection.msgtype,
                    "qos": [
                        [profile.history.name, profile.depth, profile.reliability.name, profile.durability.name]
                        for profile in connection.ext.offered_qos_profiles
                    ],
                }
                for connection in reader.connections
            },
        }


def rerun(path):
    """What Rerun's own converter makes of the log: rows of each scalar of the joint states."""
    from importlib.metadata import version

    version("rerun-sdk")
    program = os.path.join(os.path.dirname(sys.executable), "rerun")
    with tempfile.TemporaryDirectory() as home:
        def run(*arguments):
            # Its settings are kept apart: it greets a new user and asks about statistics.
            environment = {**os.environ, "HOME": home, "XDG_CONFIG_HOME": home}
            command = [program, *arguments]
            done = subprocess.run(command, env=environment, check=True, capture_output=True, text=True)
            return done.stdout

        recording = os.path.join(home, "run.rrd")
        run("mcap", "check", "--full", path)
        run("mcap", "convert", path, "-o", recording)
        run("rrd", "verify", recording)
        found = {}
        for field in ["position", "velocity", "effort"]:
            shown = run("rrd", "print", "-vvv", "--entity", f"/joint_states/{field}", recording)
            # Wide lists are cut off after some numbers.
            lines = re.findall(r"row_\w+ +┆ (1970\S+) +┆ \S+ +┆ \S+ +┆ \[([^\]┆]*)", shown)
            number = r"-?\d+(?:\.\d+)?(?:e-?\d+)?(?=[,\]])"
            rows = sorted((time, [float(v) for v in re.findall(number, cells)]) for time, cells in lines)
            found[field] = {"count": len(rows), "first": rows[0], "last": rows[-1]}
        return found


def npz(path):
    import numpy

    with numpy.load(path, allow_pickle=False) as archive:
        return {
            name: {
                "kind": archive[name].dtype.kind,
                "shape": list(archive[name].shape),
                "first": archive[name][:1].tolist(),
                "last": archive[name][-1:].tolist(),
                "whole": archive[name].tolist() if archive[name].size < 100 else None,
            }
            for name in archive.files
        }


def urdf(path):
    import pybullet

    client = pybullet.connect(pybullet.DIRECT)
    robot = pybullet.loadURDF(path, flags=pybullet.URDF_USE_INERTIA_FROM_FILE)
    count = pybullet.getNumJoints(robot)
    joints = [pybullet.getJointInfo(robot, index) for index in range(count)]
    names = [joint[1].decode() for joint in joints]
    angles = {name: 0.1 * ((7 * index) % 5 - 2) for index, name in enumerate(names)}
    for index, name in enumerate(names):
        pybullet.resetJointState(robot, index, angles[name])
    # Frames of links, not of centres of mass; of the root pybullet tells the latter.
    base_at, base_turn = pybullet.getBasePositionAndOrientation(robot)
    inertial = pybullet.getDynamicsInfo(robot, -1)
    inverse = pybullet.invertTransform(inertial[3], inertial[4])
    base = pybullet.multiplyTransforms(base_at, base_turn, *inverse)
    ground = pybullet.invertTransform(*base)
    states = [pybullet.getLinkState(robot, index, computeForwardKinematics=True) for index in range(count)]
    places = [pybullet.multiplyTransforms(*ground, state[4], state[5])[0] for state in states]
    found = {
        "root": pybullet.getBodyInfo(robot)[0].decode(),
        "mass": sum(pybullet.getDynamicsInfo(robot, index)[0] for index in range(-1, count)),
        "joints": [
            {"name": joint[1].decode(), "kind": joint[2], "link": joint[12].decode(),
             "lower": joint[8], "upper": joint[9], "effort": joint[10], "speed": joint[11],
             "axis": joint[13], "angle": angles[joint[1].decode()], "place": place}
            for joint, place in zip(joints, places)
        ],
        "collisions": sum(len(pybullet.getCollisionShapeData(robot, index)) for index in range(-1, count)),
        "visuals": len(pybullet.getVisualShapeData(robot)),
    }
    pybullet.disconnect(client)
    return found


def dynamics(path, engine_path):
    """Pinocchio's URDF beside MuJoCo's model: mass matrix and gravity torques in some postures."""
    import mujoco
    import numpy
    import pinocchio

    with open(path, encoding="utf-8") as file:
        text = file.read()
    floating = pinocchio.JointModelFreeFlyer()
    urdf = pinocchio.buildModelFromXML(text, floating)
    data = urdf.createData()
    model = mujoco.MjModel.from_xml_path(engine_path)
    # URDF has no rotors, and a mass matrix knows no springs.
    model.dof_armature[:] = 0.0
    engine = mujoco.MjData(model)
    hinges = [joint for joint in range(model.njnt) if model.jnt_type[joint] == mujoco.mjtJoint.mjJNT_HINGE]
    random = numpy.random.default_rng(1)
    masses, torques = 0.0, 0.0
    for _ in range(5):
        turn = random.normal(size=4)
        turn /= numpy.linalg.norm(turn)
        engine.qpos[:3], engine.qpos[3:7] = random.normal(size=3), turn
        posture = pinocchio.neutral(urdf)
        posture[:3], posture[3:7] = engine.qpos[:3], [*turn[1:], turn[0]]
        # Speeds of MuJoCo from those of Pinocchio, whose root also moves along its own axes.
        speeds = numpy.zeros((model.nv, urdf.nv))
        rotation = numpy.zeros(9)
        mujoco.mju_quat2Mat(rotation, turn)
        speeds[:3, :3], speeds[3:6, 3:6] = rotation.reshape(3, 3), numpy.eye(3)
        for hinge in hinges:
            ours = urdf.joints[urdf.getJointId(model.joint(hinge).name)]
            angle = random.uniform(*model.jnt_range[hinge])
            engine.qpos[model.jnt_qposadr[hinge]] = posture[ours.idx_q] = angle
            speeds[model.jnt_dofadr[hinge], ours.idx_v] = 1.0
        mujoco.mj_forward(model, engine)
        expected = numpy.zeros((model.nv, model.nv))
        mujoco.mj_fullM(model, engine, expected)
        upper = numpy.triu(pinocchio.crba(urdf, data, posture))
        found = upper + numpy.triu(upper, 1).T
        masses = max(masses, abs(speeds.T @ expected @ speeds - found).max())
        found = pinocchio.computeGeneralizedGravity(urdf, data, posture)
        torques = max(torques, abs(speeds.T @ engine.qfrc_bias - found).max())
    coupled = pinocchio.buildModelFromXML(text, floating, mimic=True)
    return {
        "mass": sum(inertia.mass for inertia in urdf.inertias),
        "engine_mass": float(model.body_mass.sum()),
        "freedoms": urdf.nv,
        "freedoms_with_mimic": coupled.nv,
        "mass_matrix_differs": float(masses),
        "gravity_differs": float(torques),
    }


def mujoco_import(path):
    """The URDF through MuJoCo's own importer."""
    import mujoco

    model = mujoco.MjModel.from_xml_path(path)
    return {"mass": float(model.body_mass.sum()), "bodies": model.nbody, "joints": model.njnt,
            "equalities": model.neq}


def yourdfpy(path):
    import logging

    import yourdfpy as library

    class Kept(logging.Handler):
        def emit(self, record):
            said.append(record.getMessage())

    said = []
    logging.getLogger().addHandler(Kept(level=logging.WARNING))
    robot = library.URDF.load(path)
    elements = [robot.robot.links, robot.robot.joints, robot.robot.materials]
    names = [[element.name for element in listed] for listed in elements]
    return {
        "valid": robot.validate(),
        "said": said + [str(error) for error in robot.errors],
        # Of links, joints and materials.
        "counts": [len(found) for found in names],
        "distinct": [len(set(found) - {"", None}) for found in names],
        "joints": robot.num_actuated_joints,
        "mimic": {joint.name: [joint.mimic.joint, joint.mimic.multiplier, joint.mimic.offset]
                  for joint in robot.robot.joints if joint.mimic},
    }


def xar(path):
    import xml.etree.ElementTree as tree

    root = tree.parse(path).getroot()
    space = {"c": "http://www.aldebaran-robotics.com/schema/choregraphe/project.xsd"}
    timeline = root.find(".//c:Box/c:Timeline[@enable='1']", space)
    curves = timeline.findall("c:ActuatorList/c:ActuatorCurve", space)
    return {
        "root": root.tag,
        "version": root.get("xar_version"),
        "tooltips": [box.get("tooltip") for box in root.iter("{%s}Box" % space["c"])],
        "fps": timeline.get("fps"),
        "size": timeline.get("size"),
        "links": len(root.findall(".//c:Link", space)),
        "tangents": sorted({t.get("interpType") for t in root.iter("{%s}Tangent" % space["c"])}),
        "curves": {
            curve.get("actuator"): {
                "unit": curve.get("unit"),
                "keys": [[int(key.get("frame")), float(key.get("value"))] for key in curve.findall("c:Key", space)],
            }
            for curve in curves
        },
    }


def picture(path):
    from PIL import Image, ImageSequence

    with Image.open(path) as image:
        frames = [(frame.convert("RGB"), frame.info.get("duration")) for frame in ImageSequence.Iterator(image)]
        return {
            "format": image.format,
            "size": list(image.size),
            "count": len(frames),
            "milliseconds": sum(duration or 0 for _, duration in frames),
            "loop": image.info.get("loop"),
            "corner": frames[0][0].getpixel((2, 2)),
            "colours": len(frames[0][0].getcolors(1 << 24)),
            "changed": sum(a != b for a, b in zip(frames[0][0].tobytes(), frames[-1][0].tobytes())),
        }


def video(path):
    import imageio_ffmpeg

    frames = imageio_ffmpeg.read_frames(path)
    head = next(frames)
    pictures = list(frames)
    return {
        "size": list(head["size"]),
        "fps": head["fps"],
        "codec": head["codec"],
        "count": len(pictures),
        "moves": pictures[0] != pictures[-1],
    }


def ffmpeg(_):
    """Where an ffmpeg is."""
    import imageio_ffmpeg

    return {"path": imageio_ffmpeg.get_ffmpeg_exe()}


READERS = {"mcap": mcap, "rosbags": rosbags, "rerun": rerun, "npz": npz, "urdf": urdf, "dynamics": dynamics,
           "mujoco": mujoco_import, "yourdfpy": yourdfpy, "xar": xar, "gif": picture, "webp": picture,
           "mp4": video, "ffmpeg": ffmpeg}

if __name__ == "__main__":
    kind, *files = sys.argv[1:]
    try:
        # pybullet greets on standard output.
        found = READERS[kind](*files)
    except ModuleNotFoundError as error:
        print(f"no {error.name}", file=sys.stderr)
        sys.exit(77)
    print("\nFOUND " + json.dumps(found))
