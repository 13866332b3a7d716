"""Check the report of a reproduction, a crawl, a search and a torque map. Argument: its folder.

Its run.json says whether it is arranged as the published chapter, which names figures that no run has.
Standard library only.
"""

import json
import sys
from html.parser import HTMLParser
from pathlib import Path

LARGEST = 6_000_000
# These need a robot.
MISSING = ["29", "30", "32", "33"]


class Page(HTMLParser):
    """Collects ids, what would be loaded, and pictures without a text."""

    def __init__(self):
        super().__init__()
        self.ids, self.loads, self.mute = [], [], 0

    def handle_starttag(self, tag, attrs):
        attrs = dict(attrs)
        if "id" in attrs:
            self.ids.append(attrs["id"])
        self.loads += [attrs[name] for name in ("src", "href") if name in attrs]
        if tag == "img" and not attrs.get("alt"):
            self.mute += 1


def main():
    folder = Path(sys.argv[1])
    text = (folder / "report.html").read_text(encoding="utf-8")
    assert len(text.encode()) <= LARGEST, f"{len(text.encode())} bytes"
    page = Page()
    page.feed(text)
    assert page.mute == 0, f"{page.mute} pictures without a text"
    outside = [link[:60] for link in page.loads if not link.startswith(("data:", "#"))]
    assert not outside, outside
    numbers = json.loads((folder / "report.json").read_text())
    chapter = json.loads((folder / "run.json").read_text())["arrangement"] == "chapter"
    missing = [it["number"] for it in numbers["missing"]]
    assert missing == (MISSING if chapter else []), missing
    places = [it for it in page.ids if it.startswith("place-")]
    assert places == [f"place-{number}" for number in missing], places
    unknown = [link for link in page.loads if link[:1] == "#" and link[1:] not in page.ids]
    assert not unknown, unknown
    assert numbers["shortfalls"] == [], numbers["shortfalls"]
    for figure in numbers["figures"]:
        assert figure["stem"] in page.ids, figure
        for kind in ("svg", "png"):
            assert (folder / f"figures/{figure['stem']}.{kind}").is_file(), figure
    shown = {figure["number"] for figure in numbers["figures"]}
    expected = {str(number) for number in range(22, 46)} - set(MISSING)
    assert expected <= shown, expected - shown
    card = next(card for card in numbers["cards"] if card["gait"] == "low-175")
    assert 0.1 < card["standing_heights_per_s"] < 0.2, card
    assert card["lowest_passage_mm"] < 178, card
    print(f"{len(numbers['figures'])} figures, {len(text) / 1e6:.2f} MB: as it should be")


main()
