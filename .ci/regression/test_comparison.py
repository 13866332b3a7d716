"""A comparison that cannot fail is worth nothing: each of these plants one change."""

import io
import json
import shutil
import struct
import tempfile
import unittest
import zipfile
from pathlib import Path

from .cases import all_cases
from .comparison import compare
from .recording import MANIFEST


def archive(members):
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w") as written:
        for name, content in members.items():
            written.writestr(zipfile.ZipInfo(name), content)
    return data.getvalue()


def mcap(program, content):
    """A channel, one message in a chunk, and metadata."""

    def string(text):
        return struct.pack("<I", len(text)) + text.encode()

    def record(kind, content):
        return struct.pack("<BQ", kind, len(content)) + content

    channel = record(0x04, struct.pack("<HH", 1, 0) + string("/tf") + string("cdr") + struct.pack("<I", 0))
    inner = channel + record(0x05, struct.pack("<HIQQ", 1, 0, 0, 0) + content)
    chunk = struct.pack("<QQQI", 0, 0, len(inner), 0) + string("") + struct.pack("<Q", len(inner)) + inner
    pairs = string("program") + string(program)
    metadata = string("prone") + struct.pack("<I", len(pairs)) + pairs
    magic = b"\x89MCAP0\r\n"
    return magic + record(0x06, chunk) + record(0x0C, metadata) + magic


class Planted(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.homes = [Path(place.name) / name for name in "ab"]

    def compare(self, file, a, b, **manifest):
        """Two recordings of one case, which differ in one file."""
        return self.compare_files({file: a}, {file: b}, **manifest)

    def compare_files(self, *both, whole=None):
        for home, files in zip(self.homes, both):
            always = {"stdout": b"said\n", "stderr": b"done in 1 s\n", "exit": b"0\n"}
            shutil.rmtree(home / "one", ignore_errors=True)
            self.case(home, "one", always | files)
            cases = {"one": {"arguments": [], "whole": whole}}
            (home / MANIFEST).write_text(json.dumps({"cases": cases}))
        return compare(*self.homes, lambda _: True)

    def case(self, home, name, files):
        for file, content in files.items():
            path = home / name / file
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content)

    def assert_same(self, *arguments):
        found = self.compare(*arguments)
        self.assertEqual(found.failures, [])
        return found

    def assert_found(self, place, *arguments):
        failures = self.compare(*arguments).failures
        self.assertEqual(len(failures), 1, failures)
        self.assertIn(place, failures[0])

    def test_a_digit_is_found_in_every_format(self):
        text = b'[knee]\npolynomial_rad = [0.1, 0.2]\n'
        self.assert_found("/deep/1", "r.json", b'{"deep": [1, 0.10]}', b'{"deep": [1, 0.11]}')
        self.assert_found("/a", "r.json", b'{"a": 1}', b'{"a": "1"}')
        self.assert_found("row 2, y", "r.csv", b"x,y\n1,2\n3,4\n", b"x,y\n1,2\n3,5\n")
        self.assert_found("row 1, 2", "r.csv", b"# map\n1,2\n3,4\n", b"# map\n1,3\n3,4\n")
        self.assert_found("comments, line 1, word 3", "r.csv", b"# step 1\n1\n", b"# step 2\n1\n")
        self.assert_found("line 2, word 4", "r.toml", text, text.replace(b"0.2", b"0.3"))
        self.assert_found("bytes", "r.svg", b"<svg>1</svg>", b"<svg>2</svg>")
        self.assert_found("q.npy", "r.npz", archive({"q.npy": b"1"}), archive({"q.npy": b"2"}))
        self.assert_found("message 1 of /tf", "r.mcap", mcap("prone", b"1"), mcap("prone", b"2"))
        page = b'<h1>1</h1><script type="application/json" id="runs">{"x": [1]}</script>'
        self.assert_found("runs: /x/0", "r.html", page, page.replace(b"[1]", b"[2]"))
        self.assert_found("/x", "stdout", b'{"x": 1}', b'{"x": 2}')

    def test_what_is_missing_is_found(self):
        self.assert_found("/b", "r.json", b'{"a": 1, "b": null}', b'{"a": 1}')
        self.assert_found("length", "r.json", b"[1]", b"[1, 2]")
        self.assert_found("rows", "r.csv", b"x\n1\n", b"x\n1\n2\n")
        self.assertIn("missing", self.compare_files({"r.svg": b"1"}, {}).failures[0])
        self.assert_found("cannot be read", "r.json", b'{"a": 1}', b'{"a": ')

    def test_an_exit_code_and_a_message_are_values(self):
        refused = {"exit": b"2\n", "stdout": b"", "stderr": b"error: 1 is too small\n\nUsage: prone\n"}
        other = refused | {"stderr": b"error: 2 is too small\n"}
        self.assertIn("stderr", self.compare_files(refused, other).failures[0])
        usage = refused | {"stderr": b"error: 1 is too small\n\nUsage: prone [OPTIONS]\n"}
        self.assertEqual(self.compare_files(refused, usage).failures, [])
        self.assertIn("exit", self.compare_files(refused, refused | {"exit": b"1\n"}).failures[0])

    def test_what_is_added_is_a_note(self):
        found = self.assert_same("r.json", b'{"a": 1}', b'{"b": [2], "a": 1}')
        self.assertIn("r.json: /b/length is new", found.notes)
        found = self.assert_same("r.csv", b"x\n1\n", b"y,x\n2,1\n")
        self.assertIn("r.csv: column y is new", found.notes)
        found = self.assert_same("run.json", b'{"artefacts": ["a.csv"]}', b'{"artefacts": ["b.csv", "a.csv"]}')
        self.assertIn("run.json: /artefacts/b.csv is new", found.notes)
        self.assertIn("new.csv is new", self.compare_files({}, {"new.csv": b"x\n1\n"}).notes)

    def test_where_something_was_made_is_not_compared(self):
        self.assert_same(
            "run.json",
            b'{"commit": "a", "robot": {"folder": "robots/nao"}, "gait": "gaits/low-175.toml"}',
            b'{"gait": "robots/nao/gaits/low-175.toml", "robot": {"folder": "nao-h25"}, "commit": "b"}',
        )
        self.assert_same("stdout", b"NAO (robots/nao): 5 kg\n", b"NAO (robots/nao/h25): 5 kg\n")
        commits = b"prone 0.1.0 (0123456789ab), commit 0123456789ab", b"prone 0.1.0 (unknown), commit unknown"
        self.assert_same("stdout", *commits)
        self.assert_same("timing.json", b'{"wall_s": 1}', b'{"wall_s": 2}')
        self.assert_same("r.mcap", mcap("prone 0.1.0 (0123456789ab)", b"1"), mcap("prone 0.1.0 (unknown)", b"1"))

    def test_units_and_ratios_are_no_folders(self):
        self.assert_found("word 2", "stdout", b"2.5 mm/s\n", b"2.5 m/s\n")
        self.assert_found("word 1", "stdout", b"1.25/2.5\n", b"1.26/2.5\n")

    def test_nothing_is_not_the_same_as_nothing(self):
        nothing = {"stdout": b""}
        self.assertIn("no values", self.compare_files(nothing, nothing).failures[0])
        for home in self.homes:
            (home / MANIFEST).write_text('{"cases": {}}')
        with self.assertRaises(SystemExit):
            compare(*self.homes, lambda _: True)
        (self.homes[1] / MANIFEST).unlink()
        with self.assertRaises(SystemExit):
            compare(*self.homes, lambda _: True)

    def test_a_recording_is_not_compared_with_itself(self):
        self.compare_files({}, {})
        with self.assertRaises(SystemExit):
            compare(self.homes[0], self.homes[0], lambda _: True)
        with self.assertRaises(SystemExit):
            compare(*self.homes, lambda name: name == "other")

    def test_a_missing_case_is_found(self):
        self.compare_files({}, {})
        manifest = json.loads((self.homes[0] / MANIFEST).read_text())
        manifest["cases"]["two"] = manifest["cases"]["one"]
        for home in self.homes:
            (home / MANIFEST).write_text(json.dumps(manifest))
        self.case(self.homes[0], "two", {"stdout": b"said", "stderr": b"", "exit": b"0"})
        failures = compare(*self.homes, lambda _: True).failures
        self.assertTrue(all("two" in failure for failure in failures) and failures, failures)

    def test_an_interrupted_case_ends_as_the_whole_one(self):
        for home in self.homes:
            self.case(home, "whole", {"r.csv": b"x\n1\n", "stdout": b"said\n", "exit": b"0\n"})
        same = {"r.csv": b"x\n1\n", "exit": b"130\n-9\n0\n"}
        self.assertEqual(self.compare_files(same, same, whole="whole").failures, [])
        other = same | {"r.csv": b"x\n2\n"}
        self.assertEqual(len(self.compare_files(other, other, whole="whole").failures), 2)

    def test_cases_have_names_of_their_own_and_read_what_is_before_them(self):
        self.assertGreater(len(all_cases()), 300)
