"""Reads what a case has left as values: a place in the file, and what stands there as text.

Left out is what may change when nothing that is computed does: commit, folder and hash of the
robot, folders of other files, sizes of pages. Key order goes by itself.
"""

import csv
import hashlib
import io
import json
import re
import struct
import zipfile

# Wall times.
UNREAD = {"timing.json"}

# Values of these keys in JSON say where something was made, not what.
UNREAD_KEYS = {"commit", "sha256", "folder"}

# Folders under which files move between versions.
ROOTS = ("/", "./", "../", "gaits/", "robots/", "scenes/")

PATH = re.compile(r"(?<![\w·/])(?:\.{0,2}/)?(?:[\w.@+-]+/)+[\w.@+-]*")
ENDING = re.compile(r"\.[A-Za-z]\w*$")
OTHERS = [
    (re.compile(r"\bcommit (?:[0-9a-f]{7,40}|unknown)\b"), "commit …"),
    (re.compile(r"\b(prone [0-9.]+) \((?:[0-9a-f]{7,40}|unknown)\)"), r"\1 (…)"),
    (re.compile(r"\bsha256 [0-9a-f]{64}\b"), "sha256 …"),
    # Of a page, whose text is not compared.
    (re.compile(r"\b[0-9.]+ MB\b"), "… MB"),
]


class Number(str):
    """A number as it is written: two numbers are the same if they are so to the last digit."""


class Unreadable(Exception):
    """A file that is not what its name says."""


def read(path):
    """All values of a file, by place."""
    try:
        return reader(path)(path.read_bytes())
    except (ValueError, KeyError, IndexError, csv.Error, struct.error, zipfile.BadZipFile) as error:
        raise Unreadable(f"{path}: {error}") from error


def reader(path):
    readers = {
        ".json": json_values,
        ".csv": csv_values,
        ".html": page_values,
        ".npz": archive_values,
        ".mcap": mcap_values,
        ".toml": text_values,
        ".urdf": text_values,
        ".xar": text_values,
    }
    if path.suffix in readers:
        return readers[path.suffix]
    if path.name == "stdout":
        return printed_values
    if path.name == "stderr":
        return message_values
    if path.name == "exit":
        return text_values
    # Pictures, and whatever is not known.
    return bytes_values


def normal(text):
    """Text without what may change."""
    if "/" in text:
        text = PATH.sub(lambda found: without_folder(found[0]), text)
    for pattern, instead in OTHERS:
        text = pattern.sub(instead, text)
    return text


def without_folder(path):
    name = path.rsplit("/", 1)[1]
    if ENDING.search(name):
        return name
    # Everything else with a stroke in it is a unit, or the name of a figure.
    return "<folder>" if path.startswith(ROOTS) else path


def bytes_values(data):
    return {"bytes": hashlib.sha256(data).hexdigest()[:16]}


def text_values(data):
    """Word by word, so that a column that has become wider is none that has changed."""
    lines = normal(data.decode()).split("\n")
    values = {"lines": Number(len(lines))}
    for row, line in enumerate(lines, 1):
        for column, word in enumerate(line.split(), 1):
            values[f"line {row}, word {column}"] = word
    return values


def printed_values(data):
    if data.lstrip()[:1] in (b"{", b"["):
        return json_values(data)
    # Nothing printed is no value.
    return text_values(data) if data else {}


def message_values(data):
    """An error's message, without the usage that follows it."""
    text = re.split(rb"^(?:Usage:|For more information)", data, maxsplit=1, flags=re.MULTILINE)[0]
    return text_values(text.strip()) if text.strip() else {}


def json_values(data):
    document = json.loads(data, parse_int=Number, parse_float=Number, parse_constant=Number)
    return dict(leaves("", document))


def leaves(place, value):
    if isinstance(value, dict):
        yield f"{place}/", "object"
        for key, inner in value.items():
            if key in UNREAD_KEYS:
                continue
            if key == "artefacts":
                yield from ((f"{place}/{key}/{name}", "listed") for name in inner if name not in UNREAD)
            else:
                yield from leaves(f"{place}/{escaped(key)}", inner)
    elif isinstance(value, list):
        yield f"{place}/length", Number(len(value))
        for index, inner in enumerate(value):
            yield from leaves(f"{place}/{index}", inner)
    elif isinstance(value, str) and not isinstance(value, Number):
        yield place, json.dumps(normal(value), ensure_ascii=False)
    elif isinstance(value, Number):
        yield place, value
    else:
        yield place, json.dumps(value)


def escaped(key):
    """A key in a JSON pointer (RFC 6901)."""
    return key.replace("~", "~0").replace("/", "~1")


def csv_values(data):
    """Comments word by word, cells by row and column."""
    lines = data.decode().split("\n")
    comments = "\n".join(line for line in lines if line.startswith("#"))
    table = [row for row in csv.reader(line for line in lines if not line.startswith("#")) if row]
    values = {}
    for place, word in text_values(comments.encode()).items():
        values[f"comments, {place}"] = word
    # A table without a header, as torque maps are, has numbers in its first row.
    headed = bool(table) and not all(is_number(cell) for cell in table[0])
    columns = table.pop(0) if headed else [str(index + 1) for index in range(len(table[0]) if table else 0)]
    for column in columns:
        values[f"column {column}"] = "there"
    values["rows"] = Number(len(table))
    for number, row in enumerate(table, 1):
        if len(row) != len(columns):
            raise ValueError(f"row {number} has {len(row)} cells, not {len(columns)}")
        for column, cell in zip(columns, row):
            values[f"row {number}, {column}"] = normal(cell) if "/" in cell or "commit" in cell else cell
    return values


def is_number(cell):
    try:
        float(cell)
    except ValueError:
        return False
    return True


def page_values(data):
    """Of a page only the data that it embeds: what a replay shows."""
    text = data.decode()
    values = {"": "page"}
    pattern = r'<script type="application/json"(?: id="([^"]*)")?[^>]*>(.*?)</script>'
    for index, (name, document) in enumerate(re.findall(pattern, text, re.DOTALL)):
        for place, value in json_values(document.encode()).items():
            values[f"{name or index}: {place}"] = value
    return values


def archive_values(data):
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        return {name: bytes_values(archive.read(name))["bytes"] for name in archive.namelist()}


def mcap_values(data):
    """Schemas, channels, messages and metadata (https://mcap.dev/spec), without indices and sums.

    Numbers of schemas and channels are not compared: they follow from what else is in the file.
    """
    magic = b"\x89MCAP0\r\n"
    if not (data.startswith(magic) and data.endswith(magic)):
        raise ValueError("not a whole MCAP file")
    values, topics, counts = {}, {}, {}
    for kind, content in mcap_records(data[len(magic) : -len(magic)]):
        if kind == 0x03:
            name, rest = mcap_string(content[2:])
            values[f"schema {name}"] = bytes_values(rest)["bytes"]
        elif kind == 0x04:
            topic, rest = mcap_string(content[4:])
            topics[content[:2]] = topic
            values[f"channel {topic}"] = bytes_values(rest)["bytes"]
        elif kind == 0x05:
            topic = topics[content[:2]]
            counts[topic] = counts.get(topic, 0) + 1
            values[f"message {counts[topic]} of {topic}"] = bytes_values(content[2:])["bytes"]
        elif kind == 0x0C:
            name, rest = mcap_string(content)
            rest = rest[4:]
            while rest:
                key, rest = mcap_string(rest)
                value, rest = mcap_string(rest)
                values[f"metadata {name}, {key}"] = normal(value)
    for topic, count in counts.items():
        values[f"messages of {topic}"] = Number(count)
    return values


def mcap_records(data):
    """Kind and content of each record, those in chunks too."""
    at = 0
    while at < len(data):
        kind, length = struct.unpack_from("<BQ", data, at)
        content = data[at + 9 : at + 9 + length]
        at += 9 + length
        if kind == 0x06:
            compression, rest = mcap_string(content[28:])
            if compression:
                raise ValueError(f"a chunk is compressed with {compression}")
            yield from mcap_records(rest[8:])
        else:
            yield kind, content


def mcap_string(data):
    """A string, and what follows it."""
    (length,) = struct.unpack_from("<I", data)
    return data[4 : 4 + length].decode(), data[4 + length :]
