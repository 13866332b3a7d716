"""Check the results of `prone reproduce --durations 1,5`, made twice.

Arguments: result folder, folder of the same run on one thread. Standard library only.
"""

import csv
import json
import math
import re
import sys
from html.parser import HTMLParser
from pathlib import Path
from xml.etree import ElementTree

GAITS = ["nominal", "optimal"]
DURATIONS = [1, 5]
CONTROL_STEP_S = 0.05

FIGURES = [
    "fig-22-nominal-start",
    "fig-23-thesis-nominal-under",
    "fig-25-gait-parameters",
    "fig-26-nominal-chain",
    "fig-27-nominal-frames",
    "fig-28-thesis-nominal-sequence",
    "fig-31-thesis-nominal-angles",
    "fig-34-optimal-chain",
    "fig-35-optimal-frames",
    "fig-36-nominal-torque-by-duration",
    "fig-37-optimal-torque-by-duration",
    "fig-38-nominal-torque-over-time",
    "fig-39-optimal-torque-over-time",
    "fig-40-nominal-transient",
    "fig-41-optimal-transient",
    "fig-42-nominal-torque-over-cycle",
    "fig-43-optimal-torque-over-cycle",
    "fig-44-nominal-against-optimal",
    "fig-45-left-cost",
    "fig-45-right-cost-ratio",
]
# What `prone view` and `prone export` read: the pulls that pictures show, and the shorter crawl.
CRAWL = "crawls/table-9-cycles"
RECORDS = {f"pulls/{gait}-5s": (5.0, 0.05) for gait in GAITS} | {CRAWL: (27.0, 0.02)}
# The version that crawls, where the torques that were published are of another one.
BESIDE = "v4"
RECORD = ["run.json", "model.json", "rows.csv", "contacts.csv", "robot.compiled.json"]

OF_A_CRAWL = ["summary.json", "cycles.csv", "plate-contacts.csv", "motors.csv", "start.json", "commands.csv"]

FILES = sorted(
    ["figures/crawl.png", "report.html", "run.json", "summary.json", "timing.json", "costs.csv", "agreement.csv"]
    + ["chains.csv", "figures.json", "squeeze.csv", f"costs-{BESIDE}.csv"]
    + [
        f"{folder}/{gait}-{duration:04.1f}s.csv"
        for folder in ("torques", f"torques-{BESIDE}")
        for gait in GAITS
        for duration in DURATIONS
    ]
    + [f"figures/{figure}.{kind}" for figure in FIGURES for kind in ("svg", "png")]
    + [f"{folder}/{name}" for folder in RECORDS for name in RECORD]
    + [f"{CRAWL}/{name}" for name in OF_A_CRAWL]
)

TORQUE_HEADER = (
    "time_s,cycle_percent,ankle_nm,knee_nm,hip_nm,shoulder_nm,"
    "ankle_cmd_rad,ankle_rad,knee_cmd_rad,knee_rad,hip_cmd_rad,hip_rad,"
    "shoulder_cmd_rad,shoulder_rad,shoulder_roll_cmd_rad,shoulder_roll_rad,"
    "forearm_upper_cmd_rad,forearm_upper_rad,forearm_lower_cmd_rad,forearm_lower_rad,"
    "toe_n,elbow_n,torso_n,leg_n,top_mm,head_top_mm,squeeze_n"
)
COST_HEADER = "gait,duration_s,cost_n2m2s,published_n2m2s"
SQUEEZE_HEADER = (
    "gait,duration_s,from_percent,ankle_nm_per_n,knee_nm_per_n,hip_nm_per_n,shoulder_nm_per_n,"
    "cost_percent_per_n,ours_squeeze_n,ours_rate_n2m2,ours_rate_without_n2m2,"
    "published_squeeze_n,published_rate_n2m2,published_rate_without_n2m2,"
    "rms_nm,rms_with_its_squeeze_nm"
)
AGREEMENT_HEADER = "gait,duration_s,joint,rms_nm,correlation"

# Published costs at 5 s, N²·m²·s (values behind Figure 45 of the thesis), and how far ours may
# be from them: what a simulation that shares no code with ours reached from 5 s on.
PUBLISHED = {"nominal": 6.114, "optimal": 5.195}
COST_TOLERANCE = {"nominal": 0.10, "optimal": 0.17}
RATIO = (0.84, 0.92)

# Agreement with the recorded torques at 5 s: largest RMS, N·m, and smallest correlation. The
# optimal gait's hip torque hardly varies, so its correlation says nothing.
AGREEMENT = {
    ("nominal", "ankle"): (0.15, 0.90),
    ("nominal", "knee"): (0.15, 0.90),
    ("nominal", "hip"): (0.30, 0.90),
    ("nominal", "shoulder"): (0.20, 0.80),
    ("optimal", "ankle"): (0.15, 0.90),
    ("optimal", "knee"): (0.15, 0.90),
    ("optimal", "hip"): (0.12, None),
    ("optimal", "shoulder"): (0.20, 0.80),
}

# Link masses of the recording scene's robot sum to 5.142 kg, the manufacturer's of the V4 to 5.195 kg.
# Over a slow phase the floor carries the weight; the mean is within 0.1 % of it, single steps within a
# few per cent.
WEIGHT_N = {"torques": 5.142 * 9.81, f"torques-{BESIDE}": 5.195 * 9.81}
WEIGHT_TOLERANCE = 0.01

# Friction 0.05 holds less than this a side: 0.05 of half the weight, on one side of two.
LARGEST_SQUEEZE_N = 0.05 * 5.142 * 9.81 / 2 / 2
# What pressing toes and elbows together by 1 N a side does to the torques in N·m: up to the height of a
# joint, 0.13 m. The three legs' joints and the shoulder have opposite signs.
LARGEST_EFFECT_NM = 0.13

problems = []


def check(condition, message):
    if not condition:
        problems.append(message)


def files(folder):
    return sorted(p.relative_to(folder).as_posix() for p in folder.rglob("*") if p.is_file())


def table(path, header):
    """Rows of a CSV file; its header must be exactly the one given."""
    text = path.read_text(encoding="utf-8")
    first = text.split("\n", 1)[0]
    check(first == header, f"{path}: header is {first!r}")
    return list(csv.DictReader(text.splitlines()))


class Links(HTMLParser):
    """Collects what a page would load or lead to."""

    NAMES = {"src", "href", "xlink:href", "srcset", "action", "data", "poster"}

    def __init__(self):
        super().__init__()
        self.found = []

    def handle_starttag(self, tag, attrs):
        self.found += [value or "" for name, value in attrs if name in self.NAMES]


def check_files(folder):
    found = files(folder)
    for name in FILES:
        check(name in found, f"{folder}: {name} is missing")
    for name in found:
        check(name in FILES, f"{folder}: {name} is not expected")
        check((folder / name).stat().st_size > 0, f"{folder}: {name} is empty")


def check_figures(folder):
    for path in sorted(folder.glob("figures/*.png")):
        check(path.read_bytes()[:8] == b"\x89PNG\r\n\x1a\n", f"{path} is not a PNG file")
    for path in sorted(folder.glob("figures/*.svg")):
        try:
            root = ElementTree.parse(path).getroot()
            check(root.tag.endswith("}svg"), f"{path}: its root is {root.tag}")
        except ElementTree.ParseError as error:
            check(False, f"{path}: {error}")


def check_report(path):
    text = path.read_text(encoding="utf-8")
    links = Links()
    links.feed(text)
    outside = [link[:80] for link in links.found if re.match(r"\s*(https?:|//)", link, re.I)]
    outside += re.findall(r"url\(\s*[\"']?\s*(?:https?:|//)[^)]{0,80}", text, re.I)
    outside += re.findall(r"@import[^;]{0,80}", text, re.I)
    check(not outside, f"{path} has external links: {outside}")


def check_torques(folder, weight_n):
    for gait in GAITS:
        for duration in DURATIONS:
            path = folder / f"{gait}-{duration:04.1f}s.csv"
            rows = table(path, TORQUE_HEADER)
            steps = round(duration / CONTROL_STEP_S)
            check(len(rows) == steps, f"{path}: {len(rows)} rows, not {steps}")
            finite = all(math.isfinite(float(cell)) for row in rows for cell in row.values())
            check(finite, f"{path}: a number is not finite")
            if duration == 5 and rows:
                parts = ("toe_n", "elbow_n", "torso_n", "leg_n")
                mean = sum(float(row[part]) for row in rows for part in parts) / len(rows)
                check(
                    abs(mean / weight_n - 1) <= WEIGHT_TOLERANCE,
                    f"{path}: the floor carries {mean:.2f} N, the robot weighs {weight_n:.2f} N",
                )


def check_squeeze(path):
    """One row per pull; what a newton does has the signs of toes and elbows pressed together."""
    rows = table(path, SQUEEZE_HEADER)
    found = [(row["gait"], float(row["duration_s"])) for row in rows]
    check(found == [(g, float(d)) for g in GAITS for d in DURATIONS], f"{path}: rows {found}")
    for row in rows:
        name = f"{path}: {row['gait']} at {row['duration_s']} s"
        number = {key: float(value) for key, value in row.items() if key != "gait"}
        effects = [-number[f"{joint}_nm_per_n"] for joint in ("ankle", "knee", "hip")]
        effects.append(number["shoulder_nm_per_n"])
        check(all(0 < effect < LARGEST_EFFECT_NM for effect in effects), f"{name}: {effects}")
        check(-50 < number["cost_percent_per_n"] < 0, f"{name}: a newton saves nothing")
        check(abs(number["ours_squeeze_n"]) < LARGEST_SQUEEZE_N, f"{name}: more than friction holds")
        check(number["rms_with_its_squeeze_nm"] < number["rms_nm"], f"{name}: explains nothing")


def check_records(folder):
    """Rows as many as `run.json` says, at equal steps up to the end, contacts as many as rows say."""
    for name, (end_s, step_s) in RECORDS.items():
        said = json.loads((folder / name / "run.json").read_text(encoding="utf-8"))["record"]
        rows = list(csv.DictReader((folder / name / "rows.csv").read_text("utf-8").splitlines()))
        contacts = (folder / name / "contacts.csv").read_text("utf-8").splitlines()[1:]
        path = folder / name
        extent = {key: said[key] for key in ("format", "rows", "row_step_s")}
        expected = {"format": 3, "rows": round(end_s / step_s), "row_step_s": step_s}
        check(extent == expected, f"{path}: {extent}")
        check(len(rows) == said["rows"], f"{path}: {len(rows)} rows, not {said['rows']}")
        for index, row in enumerate(rows):
            due = f"{(index + 1) * step_s:.4f}"
            check(row["time_s"] == due, f"{path}: row {index + 1} is at {row['time_s']}, not {due}")
        counted = sum(int(row["contacts"]) for row in rows)
        check(counted == len(contacts), f"{path}: {len(contacts)} contacts, not {counted}")
        size = sum(file.stat().st_size for file in (folder / name).iterdir())
        largest = 1_000_000 if name.startswith("pulls") else 3_500_000
        check(size < largest, f"{path}: {size} bytes")


def check_table(folder):
    """The crawls under the table say with which force each part touches, and the hardest in one line."""
    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    check(len(summary["table"]) == 2, f"{folder}: {len(summary['table'])} crawls under the table")
    for crawl in summary["table"]:
        ours = crawl["ours"]
        name = f"{folder}: the crawl of {crawl['published']['cycles']} cycles"
        forces = [contact["peak_n"] for contact in ours["contacts"]]
        check(forces and min(forces) > 0, f"{name}: forces {forces}")
        outcome = ours["outcome"]
        check(outcome["touched"] and outcome["largest_contact_n"] == max(forces), f"{name}: {outcome}")


def check_costs(path):
    costs = {
        (row["gait"], float(row["duration_s"])): float(row["cost_n2m2s"])
        for row in table(path, COST_HEADER)
    }
    expected = {(gait, float(duration)) for gait in GAITS for duration in DURATIONS}
    check(set(costs) == expected, f"{path}: rows {sorted(costs)}")
    for gait in GAITS:
        ours, theirs = costs.get((gait, 5.0), math.nan), PUBLISHED[gait]
        near = abs(ours / theirs - 1) <= COST_TOLERANCE[gait]
        check(near, f"{path}: {gait} costs {ours} at 5 s, published {theirs}")
    ratio = costs.get(("optimal", 5.0), math.nan) / costs.get(("nominal", 5.0), math.nan)
    low, high = RATIO
    check(low <= ratio <= high, f"{path}: ratio {ratio:.3f} is outside {low}..{high}")


def check_agreement(path):
    rows = {
        (row["gait"], row["joint"]): row
        for row in table(path, AGREEMENT_HEADER)
        if float(row["duration_s"]) == 5
    }
    for key, (largest_rms, smallest_correlation) in AGREEMENT.items():
        if key not in rows:
            check(False, f"{path}: no row for {key} at 5 s")
            continue
        rms = float(rows[key]["rms_nm"])
        check(rms <= largest_rms, f"{path}: {key} RMS {rms} N·m is above {largest_rms}")
        if smallest_correlation is not None:
            correlation = float(rows[key]["correlation"] or "nan")
            check(
                correlation >= smallest_correlation,
                f"{path}: {key} correlation {correlation} is below {smallest_correlation}",
            )


def check_same(one, other):
    check(files(one) == files(other), f"{one} and {other} hold different files")
    for name in files(one):
        if name == "timing.json" or not (other / name).is_file():
            continue
        same = (one / name).read_bytes() == (other / name).read_bytes()
        check(same, f"{name} depends on the number of threads")


def main(folder, one_thread):
    check_files(folder)
    if not problems:
        for name in ("run.json", "summary.json", "timing.json"):
            json.loads((folder / name).read_text(encoding="utf-8"))
        check_figures(folder)
        check_report(folder / "report.html")
        for torques, weight_n in WEIGHT_N.items():
            check_torques(folder / torques, weight_n)
        check_records(folder)
        check_table(folder)
        for name in ("costs.csv", f"costs-{BESIDE}.csv"):
            check_costs(folder / name)
        check_squeeze(folder / "squeeze.csv")
        check_agreement(folder / "agreement.csv")
        check_same(folder, one_thread)
    for problem in problems:
        print(f"error: {problem}", file=sys.stderr)
    if not problems:
        print(f"{len(FILES)} files in {folder} are as they should be")
    return 1 if problems else 0


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    sys.exit(main(*map(Path, sys.argv[1:])))
