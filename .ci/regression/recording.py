"""Runs the cases, and leaves for each a folder with what it gave."""

import json
import os
import shutil
import signal
import subprocess
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

# What a recording holds beside the folders of its cases.
MANIFEST = "recording.json"
INPUTS = "inputs"

REPOSITORY = Path(__file__).resolve().parents[2]
GIVEN = Path(__file__).resolve().parent / INPUTS
# A robot that is given by a folder: the family that ships, as it is in the repository.
ROBOT = REPOSITORY / "robots" / "nao"

# Commands that work on several threads.
THREADED = [
    ["reproduce"],
    ["crawl"],
    ["optimize"],
    ["torque-map", "build"],
    ["report"],
]

# No case takes a tenth of it on two cores; one that hangs does not hold up the rest for ever.
LONGEST_S = 900

# Under `nohup`, and in the background of a script, signals are ignored, and stay so in what is begun
# there; the program then does not listen for any.
LISTENING = ["env", "--default-signal=HUP,INT,TERM"]

# Work that is done between the first sign of it and its interruption.
WORK_S = 0.5


class NotRecorded(Exception):
    """A case that did not run as it is meant to."""


def record(program, home, cases, threads, jobs, robot):
    """Records the cases in an empty folder. Returns what did not go as meant, by case."""
    program = Path(program).resolve()
    if not program.is_file():
        raise SystemExit(f"{program} is no program")
    if home.exists() and any(home.iterdir()):
        raise SystemExit(f"{home} is not empty: a recording is not mixed with an earlier one")
    home.mkdir(parents=True, exist_ok=True)
    shutil.copytree(GIVEN, home / INPUTS)
    shutil.copytree(robot, home / INPUTS / "nao")

    done = {}
    seconds, problems = {}, {}

    def one(case):
        # These are ahead in the queue, so that they are done or at work: nothing waits for itself.
        for needed in case.needs:
            done[needed].result()
        begun = time.monotonic()
        try:
            run_case(program, case, home / case.name, threads)
        except NotRecorded as problem:
            problems[case.name] = str(problem)
        seconds[case.name] = round(time.monotonic() - begun, 2)
        print(f"[{len(seconds)}/{len(cases)}] {seconds[case.name]:6.1f} s  {case.name}", flush=True)

    begun = time.monotonic()
    with ThreadPoolExecutor(jobs) as pool:
        for case in cases:
            done[case.name] = pool.submit(one, case)
    for future in done.values():
        future.result()

    manifest = {
        "program": str(program),
        "threads": threads,
        "seconds": round(time.monotonic() - begun, 1),
        "cases": {
            case.name: {
                "arguments": case.arguments,
                "whole": case.interruption and case.interruption.whole,
                "seconds": seconds[case.name],
            }
            for case in cases
        },
        "problems": problems,
    }
    # Written last: a recording that was stopped has none.
    (home / MANIFEST).write_text(json.dumps(manifest, indent=2, ensure_ascii=False) + "\n")
    return problems


def run_case(program, case, folder, threads):
    """Leaves `stdout`, `stderr`, `exit` and the result; raises where it did not end as meant."""
    folder.mkdir()
    command = [str(program), *case.arguments]
    if threads and any(case.arguments[: len(verb)] == verb for verb in THREADED) and not case.refused:
        command += ["--threads", str(threads)]

    ended = []
    if case.interruption:
        kept = folder / case.interruption.kept
        ended.append(interrupt(command, folder, kept, signal.SIGINT))
        command += case.interruption.resume
        ended.append(interrupt(command, folder, kept, signal.SIGKILL))
    try:
        run = subprocess.run(
            command, cwd=folder, stdin=subprocess.DEVNULL, capture_output=True, timeout=LONGEST_S
        )
    except subprocess.TimeoutExpired:
        raise NotRecorded(f"did not end within {LONGEST_S} s") from None
    ended.append(run.returncode)
    (folder / "stdout").write_bytes(run.stdout)
    (folder / "stderr").write_bytes(run.stderr)
    (folder / "exit").write_text("\n".join(map(str, ended)) + "\n")
    if case.refused == (run.returncode == 0):
        said = run.stderr.decode(errors="replace").strip().split("\n")[0]
        raise NotRecorded(f"ended with exit code {run.returncode}: {said}")


def interrupt(command, folder, kept, number):
    """Begins the program, sends it a signal once it is at work, and returns its exit code."""
    before = changed(kept)
    process = subprocess.Popen(
        [*LISTENING, *command],
        cwd=folder,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    begun = time.monotonic()
    while changed(kept) in (None, before) and process.poll() is None:
        if time.monotonic() - begun > LONGEST_S:
            process.kill()
            raise NotRecorded(f"left no {kept.name} within {LONGEST_S} s")
        time.sleep(0.005)
    try:
        process.wait(WORK_S)
        raise NotRecorded("ended before it could be interrupted: make its work longer")
    except subprocess.TimeoutExpired:
        process.send_signal(number)
    return process.wait(LONGEST_S)


def changed(path):
    """When a file was last written, `None` where there is none."""
    try:
        return os.stat(path).st_mtime_ns
    except FileNotFoundError:
        return None
