"""Check the result of a short `prone optimize --objective torque --source dynamics` and of its gait.

Argument: result folder. Standard library only.
"""

import csv
import json
import sys
import tomllib
from pathlib import Path

FILES = [
    "chains.csv", "confirmation.csv", "figures.json", "figures/confirmation.png",
    "figures/confirmation.svg", "figures/fig-24-search.png", "figures/fig-24-search.svg", "gait.toml",
    "history.csv",
    "result.json", "run.json", "search.state.json", "timing.json",
]


def check(true, message):
    if not true:
        sys.exit(f"check failed: {message}")


def main():
    folder = Path(sys.argv[1])
    files = sorted(str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file())
    check(files == FILES, f"files are {files}")

    result = json.loads((folder / "result.json").read_text())
    for key in ("cost", "torque", "violations", "evaluations", "seed"):
        check(key in result, f"result.json has no {key}")
    check(result["violations"] == 0.0, f"the found gait has violations {result['violations']}")

    rows = list(csv.DictReader((folder / "history.csv").open()))
    check(int(rows[-1]["evaluations"]) == result["evaluations"], "history and result count differently")
    best = [(float(row["best_violation"]), float(row["best_torque"])) for row in rows]
    check(best == sorted(best, reverse=True), "the best of a run got worse")
    check(abs(best[-1][1] - result["torque"]) < 1e-5, "history and result end differently")

    rows = list(csv.DictReader((folder / "confirmation.csv").open()))
    pulls = {(row["regime"], row["gait"]) for row in rows}
    gaits = {"nominal", "optimal", result["gait"]}
    check(pulls == {(r, g) for r in ("torque-study", "locomotion") for g in gaits}, f"confirmed are {pulls}")
    (own,) = (r for r in rows if r["regime"] == "torque-study" and r["gait"] == result["gait"])
    # The search simulates the same pull; the file prints six decimals.
    check(abs(float(own["objective"]) - result["torque"]) < 1e-5, "search and confirmation differ")

    gait = tomllib.loads((folder / "gait.toml").read_text())
    check(gait["name"] == result["gait"], "gait.toml has another name")
    print(f"a short search: torque {result['torque']:.4f}, {result['evaluations']} evaluations")


if __name__ == "__main__":
    main()
