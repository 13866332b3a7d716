#!/usr/bin/env bash
# Makes the short record, the finished search and the torque map anew, on which mutants lie.
# Usage: fuzz/beds/renew.sh path/to/prone (a release build), from the repository's root.
set -euo pipefail
prone=$(realpath "$1")
beds=$(realpath "$(dirname "${BASH_SOURCE[0]}")")
work=$(mktemp -d)
trap 'rm -r "$work"' EXIT
cd "$work"
"$prone" crawl run thesis-nominal --cycles 1 --record record
"$prone" optimize --objective torque --source statics --duration 1 --seed 1 --budget 40 \
    --confirm-durations 1 --out search
"$prone" torque-map build --source statics --step-deg 10 --theta4-max-deg 10 --out map.csv
python3 - <<'PYTHON'
"""Shortens the record to its first rows: a mutant is read in a millisecond."""
import json

ROWS = 12


def lines(name):
    with open(name, encoding="utf-8") as file:
        return file.readlines()


rows = lines("record/rows.csv")[: ROWS + 1]
header = rows[0].strip().split(",")
touching = sum(int(row.strip().split(",")[header.index("contacts")]) for row in rows[1:])
with open("record/rows.csv", "w", encoding="utf-8") as file:
    file.writelines(rows)
contacts = lines("record/contacts.csv")[: touching + 1]
with open("record/contacts.csv", "w", encoding="utf-8") as file:
    file.writelines(contacts)
with open("record/run.json", encoding="utf-8") as file:
    run = json.load(file)
run["record"]["rows"] = ROWS
with open("record/run.json", "w", encoding="utf-8") as file:
    json.dump(run, file, indent=2, ensure_ascii=False)
PYTHON
rm -rf "$beds/record" "$beds/search"
mkdir "$beds/record" "$beds/search"
cp record/{run.json,model.json,rows.csv,contacts.csv,cycles.csv,summary.json} "$beds/record"
cp search/{run.json,result.json,chains.csv,history.csv,confirmation.csv,search.state.json} "$beds/search"
cp map.csv "$beds/map.csv"
# Pictures are large, and no text.
echo "[]" | tee "$beds/record/figures.json" >"$beds/search/figures.json"
ln -s ../../../robots/nao/v4/robot.compiled.json "$beds/record/robot.compiled.json"
