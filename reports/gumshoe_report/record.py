"""The record at the end of a result file, checked before HDF5 looks at the file (engine/store/README.md)."""
import json
import re

import numpy as np

FOOT = re.compile(rb"\ngumshoe record ([0-9a-f]{16}) ([0-9a-f]{16})\n")
PART = 1 << 20


class Damaged(Exception):
    """The message says what is damaged."""


def digest(content, first=0):
    """digest64() of engine/base/hash.h: the sum of mixed words of eight bytes, each with its position."""
    words = np.frombuffer(content + bytes(-len(content) % 8), "<u8")
    x = words + np.arange(first, first + len(words), dtype=np.uint64) * np.uint64(0xd6e8feb86659fd93)
    x += np.uint64(0x9e3779b97f4a7c15)
    x = (x ^ x >> np.uint64(30)) * np.uint64(0xbf58476d1ce4e5b9)
    x = (x ^ x >> np.uint64(27)) * np.uint64(0x94d049bb133111eb)
    return int(np.sum(x ^ x >> np.uint64(31), dtype=np.uint64))


def around(file, size, places):
    """Digest of the first `size` bytes without the places that are written after the record."""
    at = position = total = 0
    for offset, length in [*sorted(map(tuple, places)), (size, 0)]:
        while at < offset:
            file.seek(at)
            content = file.read(min(PART, offset - at))
            total += digest(content, position)
            position += -(-len(content) // 8)
            at += len(content)
        at = max(at, offset + length)
    return total % 2**64


def check(path):
    """Raises Damaged unless all but the samples is as it was written."""
    with open(path, "rb") as file:
        size = file.seek(0, 2)
        file.seek(max(0, size - 50))
        foot = FOOT.fullmatch(file.read())
        if not foot:
            raise Damaged("its end is missing: it is truncated, changed by another program, or of another format version")
        length, expected = (int(word, 16) for word in foot.groups())
        begin = size - 50 - length
        file.seek(max(0, begin))
        text = file.read(length) if begin > 0 else b""
        if begin <= 0 or digest(text) != expected:
            raise Damaged("the record at its end is damaged")
        record = json.loads(text)
        if around(file, begin, record["places"].values()) != record["digest"]:
            raise Damaged("its contents are not those that were written")
