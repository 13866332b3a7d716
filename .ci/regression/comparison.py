"""Compares two recordings value by value."""

import json
import re
from collections import defaultdict

from .reading import UNREAD, Unreadable, read
from .recording import MANIFEST

# What every case leaves, whatever was asked for.
ALWAYS = ["exit", "stdout", "stderr"]

# Differences of one file that are printed; of a table that is another there are thousands.
PRINTED = 10


class Comparison:
    """What was found so far."""

    def __init__(self):
        self.values = 0
        self.cases = 0
        self.failures = []
        # Additions by kind, with the cases in which they are.
        self.notes = defaultdict(set)

    def differ(self, *words):
        self.failures.append(" ".join(words))


def compare(home_a, home_b, wanted):
    """Compares those cases of two recordings whose names are wanted."""
    found = Comparison()
    a, b = manifest(home_a), manifest(home_b)
    if home_a.resolve() == home_b.resolve():
        raise SystemExit(f"{home_a} and {home_b} are one folder")
    names = [name for name in [*a, *(name for name in b if name not in a)] if wanted(name)]
    if not names:
        raise SystemExit("no case to compare")
    for name in names:
        if name not in a or name not in b:
            found.differ(f"{name}: is missing in {home_b if name in a else home_a}")
            continue
        if a[name]["arguments"] != b[name]["arguments"]:
            found.notes["what is typed is new"].add(name)
        compare_cases(found, name, home_a / name, home_b / name)
        found.cases += 1
    for home, cases in [(home_a, a), (home_b, b)]:
        for name in names:
            whole = cases.get(name, {}).get("whole")
            if whole and (home / whole).is_dir() and (home / name).is_dir():
                compare_with_whole(found, home, name, whole)
    return found


def manifest(home):
    path = home / MANIFEST
    if not path.is_file():
        raise SystemExit(f"{home} is no recording, or one that was stopped: it has no {MANIFEST}")
    cases = json.loads(path.read_text())["cases"]
    if not cases:
        raise SystemExit(f"{home} has no cases")
    return cases


def compare_cases(found, name, folder_a, folder_b):
    absent = [
        path for folder in (folder_a, folder_b) for path in (folder / one for one in ALWAYS) if not path.is_file()
    ]
    if absent:
        found.differ(f"{name}: {', '.join(map(str, absent))} missing")
        return
    files_a, files_b = files(folder_a), files(folder_b)
    before = found.values
    for file in files_a:
        if file not in files_b:
            found.differ(f"{name}: {file} is missing")
        else:
            compare_files(found, name, file, folder_a / file, folder_b / file)
    for file in files_b:
        if file not in files_a:
            found.notes[f"{file} is new"].add(name)
    # An exit code alone says nothing of what was computed.
    if found.values - before <= len((folder_a / "exit").read_text().split()) + 1:
        found.differ(f"{name}: has no values")


def files(folder):
    """Files that are compared. What is said on the way is not, unless it is why there is no result."""
    found = sorted(path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file())
    succeeded = (folder / "exit").read_text().split()[-1:] == ["0"]
    left_out = UNREAD | ({"stderr"} if succeeded else set())
    return [file for file in found if file.rsplit("/", 1)[-1] not in left_out]


def compare_files(found, name, file, path_a, path_b):
    try:
        a = read(path_a)
        b = a if path_a.read_bytes() == path_b.read_bytes() else read(path_b)
    except Unreadable as error:
        found.differ(f"{name}: {file}: cannot be read: {error}")
        return
    different = [place for place, value in a.items() if b.get(place) != value]
    for place in different[:PRINTED]:
        now = b[place] if place in b else "is missing"
        found.differ(f"{name}: {file}: {place}: {a[place]} | {now}")
    if len(different) > PRINTED:
        found.differ(f"{name}: {file}: {len(different) - PRINTED} more")
    for place in b.keys() - a.keys():
        # One note for a key or a column, not one for each row.
        found.notes[f"{file}: {re.sub(r'[0-9]+', '…', place)} is new"].add(name)
    found.values += len(a)


def compare_with_whole(found, home, name, whole):
    """What was interrupted must end in the same bytes as what was not."""
    parts, complete = home / name, home / whole
    one, other = result(parts), result(complete)
    for file in sorted(one.keys() | other.keys()):
        if one.get(file) != other.get(file):
            found.differ(f"{name}: {file} is not that of {whole} in {home}")
    if not other:
        found.differ(f"{whole}: has no result in {home}")


def result(folder):
    return {
        path.relative_to(folder).as_posix(): path.read_bytes()
        for path in folder.rglob("*")
        if path.is_file() and path.name not in UNREAD | {"stderr", "exit"}
    }
