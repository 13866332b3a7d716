#!/usr/bin/env python3
"""Records what the program computes, and compares two recordings value by value.

    python3 .ci/values.py record PROGRAM DIR     run every case, leave a folder for each in DIR
    python3 .ci/values.py compare DIR_A DIR_B    every number, string and picture of them
    python3 .ci/values.py list                   the cases and what is typed for each

Record once before a change that must not move a number, once after it, and compare. Exit code 1:
something differs, a case is missing, or a case did not run as it is meant to. What the second
recording has more than the first (a key, a column, a file) is a note.

Not compared: commit, folder and hash of the robot, folders of other files, the text of pages,
wall times, the order of keys, usage that follows an error's message. Standard library only.
"""

import argparse
import fnmatch
import os
import sys
from pathlib import Path

sys.dont_write_bytecode = True

from regression.cases import all_cases  # noqa: E402
from regression.comparison import compare  # noqa: E402
from regression.recording import ROBOT, record  # noqa: E402


def main():
    args = arguments()
    wanted = (lambda name: fnmatch.fnmatchcase(name, args.only)) if args.only else (lambda name: True)
    if args.action == "list":
        for case in all_cases():
            if wanted(case.name):
                print(f"{case.name}: prone {' '.join(case.arguments)}")
        return 0
    if args.action == "record":
        return recorded(args, with_needed(all_cases(), wanted))
    return compared(compare(args.dir_a, args.dir_b, wanted))


def arguments():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    actions = parser.add_subparsers(dest="action", required=True)
    recording = actions.add_parser("record", help="run the cases and keep what they give")
    recording.add_argument("program", type=Path)
    recording.add_argument("dir", type=Path, help="made; must be empty")
    recording.add_argument("--threads", type=int, help="worker threads of each run [default: the program's]")
    recording.add_argument("--jobs", type=int, default=os.cpu_count(), help="cases at a time [default: cores]")
    recording.add_argument(
        "--robot",
        type=Path,
        default=ROBOT,
        help="robot folder that the program can read [default: robots/nao of this checkout]",
    )
    comparing = actions.add_parser("compare", help="compare two recordings")
    comparing.add_argument("dir_a", type=Path, help="the recording that is right")
    comparing.add_argument("dir_b", type=Path)
    listing = actions.add_parser("list", help="print the cases")
    for action in (recording, comparing, listing):
        action.add_argument("--only", metavar="PATTERN", help="cases whose names match, such as 'crawl.low-*'")
    return parser.parse_args()


def with_needed(cases, wanted):
    """The cases that are wanted, and those whose results they read or must equal."""
    by_name = {case.name: case for case in cases}
    chosen = [case.name for case in cases if wanted(case.name)]
    for name in chosen:
        case = by_name[name]
        needed = case.needs + ([case.interruption.whole] if case.interruption else [])
        chosen += [one for one in needed if one not in chosen]
    return [case for case in cases if case.name in chosen]


def recorded(args, cases):
    if not cases:
        sys.exit(f"no case matches {args.only}")
    problems = record(args.program, args.dir, cases, args.threads, args.jobs, args.robot)
    for name, problem in problems.items():
        print(f"problem: {name}: {problem}", file=sys.stderr)
    print(f"{len(cases)} cases recorded in {args.dir}, {len(problems)} not as meant")
    return 1 if problems else 0


def compared(found):
    for note, cases in sorted(found.notes.items()):
        print(f"note: {note} ({len(cases)} cases, such as {min(cases)})")
    for failure in found.failures:
        print(f"difference: {failure}")
    if not found.values and not found.failures:
        sys.exit("not one value was compared")
    if found.failures:
        print(f"{len(found.failures)} differences in {found.cases} cases")
        return 1
    print(f"{found.values:,} values of {found.cases} cases are the same")
    return 0


if __name__ == "__main__":
    sys.exit(main())
