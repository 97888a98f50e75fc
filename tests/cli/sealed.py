"""The record at the end of a result file (engine/store/README.md): what it says, and with something else said."""
import contextlib
import io
import json
import pathlib
import re
import struct
import sys

import h5py

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "reports"))
from gumshoe_report.record import around, digest


def parts(path):
    """The content before the record, and the record."""
    content = path.read_bytes()
    length = int(re.search(rb"\ngumshoe record ([0-9a-f]{16}) [0-9a-f]{16}\n$", content)[1], 16)
    return content[:-50 - length], json.loads(content[-50 - length:-50])


def record(path):
    return parts(path)[1]


def samples_done(path):
    with open(path, "rb") as file:
        file.seek(record(path)["places"]["samples_done"][0])
        return struct.unpack("<Q", file.read(8))[0]


def seal(path, content, said):
    text = json.dumps(said).encode()
    path.write_bytes(content + text + f"\ngumshoe record {len(text):016x} {digest(text):016x}\n".encode())


def reseal(path, **fields):
    """Says something else, of the same content."""
    content, said = parts(path)
    if fields.get("places") == {}:
        fields["digest"] = around(io.BytesIO(content), len(content), [])
    seal(path, content, {**said, **fields})


@contextlib.contextmanager
def changed(path):
    """The file open in h5py; sealed again at the end, as if it had been written so."""
    said = record(path)
    with h5py.File(path, "a") as file:
        yield file
    with h5py.File(path) as file:
        said["places"] = {name: (file[name].id.get_offset(), file[name].id.get_storage_size()) for name in said["places"]}
    content = path.read_bytes()
    said["digest"] = around(io.BytesIO(content), len(content), said["places"].values())
    seal(path, content, said)
