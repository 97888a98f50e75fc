"""The record at the end of a result file (engine/store/README.md): what it says, and with something else said."""
import json
import re
import sys

from program import ROOT

sys.path.insert(0, str(ROOT / "reports"))
sys.dont_write_bytecode = True
from gumshoe_report.record import digest


def parts(path):
    """The content before the record, and the record."""
    content = path.read_bytes()
    length = int(re.search(rb"\ngumshoe record ([0-9a-f]{16}) [0-9a-f]{16}\n$", content)[1], 16)
    return content[:-50 - length], json.loads(content[-50 - length:-50])


def record(path):
    return parts(path)[1]


def reseal(path, **fields):
    content, said = parts(path)
    text = json.dumps({**said, **fields}).encode()
    path.write_bytes(content + text + f"\ngumshoe record {len(text):016x} {digest(text):016x}\n".encode())
