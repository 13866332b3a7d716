#!/usr/bin/env python3
"""Checks the record of a crawl under a plate: past it, straight, without a touch."""

import json
import sys
from pathlib import Path


def main() -> None:
    folder = Path(sys.argv[1])
    run = json.loads((folder / "run.json").read_text())
    missing = [name for name in run["artefacts"] if not (folder / name).is_file()]
    assert not missing, f"missing files: {missing}"
    summary = json.loads((folder / "summary.json").read_text())
    assert summary["arrived"], "it did not get past the plate"
    assert summary["plate_contacts"] == 0, summary["contacts"]
    assert abs(summary["lateral_mm"]) < 50, summary["lateral_mm"]
    assert summary["mm_per_cycle"] > 110, summary["mm_per_cycle"]
    steps = sum(cycle["advance_mm"] for cycle in summary["per_cycle"])
    # Each along its own heading, the whole along the first.
    assert abs(steps - summary["distance_mm"]) < 0.02 * steps, (steps, summary["distance_mm"])
    print(
        f"{summary['cycles']} cycles, {summary['mm_per_cycle']:.1f} mm each,"
        f" {summary['lateral_mm']:+.1f} mm off the line: as it should be"
    )


main()
