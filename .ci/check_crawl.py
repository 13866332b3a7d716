#!/usr/bin/env python3
"""Checks the record of a crawl under a plate: past it, straight, without a touch; its tables add up."""

import csv
import json
import sys
from pathlib import Path


def table(path: Path) -> list[dict[str, str]]:
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def check_tables(folder: Path, summary: dict) -> None:
    """Rows give heat and work of the summary, contacts the weight of the robot."""
    rows = table(folder / "rows.csv")
    for end, whole in (("_heat_s", summary["heat_s"]), ("_work_j", summary["work_j"])):
        parts = (float(row[name]) for row in rows for name in row if name.endswith(end))
        found = sum(parts)
        # Numbers of the table have eight decimals.
        assert abs(found - whole) < 1e-4 * whole, (end, found, whole)
    times = [0.0] + [float(row["time_s"]) for row in rows]
    lasted = {row["time_s"]: b - a for row, a, b in zip(rows, times, times[1:])}
    force = [0.0, 0.0, 0.0]
    for contact in table(folder / "contacts.csv"):
        for axis, name in enumerate(("fx_n", "fy_n", "fz_n")):
            force[axis] += float(contact[name]) * lasted[contact["time_s"]]
    weight = 9.81 * json.loads((folder / "model.json").read_text())["mass_kg"]
    for axis, needed in enumerate((0.0, 0.0, weight)):
        assert abs(force[axis] / times[-1] - needed) < 0.01 * weight, (axis, force, weight)
    ground = sum(group["mean_n"] for group in summary["ground"].values())
    assert abs(ground - weight) < 0.01 * weight, (ground, weight)


def main() -> None:
    folder = Path(sys.argv[1])
    run = json.loads((folder / "run.json").read_text())
    missing = [name for name in run["artefacts"] if not (folder / name).is_file()]
    assert not missing, f"missing files: {missing}"
    summary = json.loads((folder / "summary.json").read_text())
    assert summary["arrived"], "it did not get past the plate"
    assert summary["plate_contacts"] == 0, summary["contacts"]
    outcome = summary["outcome"]
    assert outcome["passed"] and not outcome["touched"], outcome
    assert outcome["largest_contact_n"] is None, outcome
    # As wide as its elbows are apart at least, and no wider than a plate.
    assert 200 < summary["width_mm"] < 1000, summary["width_mm"]
    assert summary["self_collision"]["distance_mm"] > 0, summary["self_collision"]
    assert abs(summary["lateral_mm"]) < 50, summary["lateral_mm"]
    assert summary["mm_per_cycle"] > 110, summary["mm_per_cycle"]
    steps = sum(cycle["advance_mm"] for cycle in summary["per_cycle"])
    # Each along its own heading, the whole along the first.
    assert abs(steps - summary["distance_mm"]) < 0.02 * steps, (steps, summary["distance_mm"])
    check_tables(folder, summary)
    print(
        f"{summary['cycles']} cycles, {summary['mm_per_cycle']:.1f} mm each,"
        f" {summary['lateral_mm']:+.1f} mm off the line: as it should be"
    )


main()
