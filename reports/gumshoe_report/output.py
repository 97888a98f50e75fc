"""Output files: whole or not at all, all together, and nothing replaced that is not ours (engine/store/README.md)."""
import fcntl
import os


class Refused(Exception):
    """The message names the file, why it is left and what to do."""


def signature(r):
    """What a page contains, by which it may be replaced."""
    return f"gumshoe report {r.scenario_place}"


def check(page, tables, r, force):
    """Refuses what the report would replace and did not write: a page of something else, tables without a page."""
    def stands(path):
        return path.exists() and path.stat().st_size > 0

    if force:
        return
    remedy = "Choose another name, or use --force to replace it?"
    if stands(page):
        if signature(r).encode() not in page.read_bytes():
            raise Refused(f"'{page}': not overwritten (it is not the report of this scenario). {remedy}")
        return
    for path in tables:
        if stands(path):
            raise Refused(f"'{path}': not overwritten (there is no report that it belongs to). {remedy}")


class Claim:
    """The right to write a file, as store::Claim."""

    def __init__(self, path):
        self.path, self.name = path, f"{os.path.realpath(path)}.gumshoe-lock"

    def __enter__(self):
        self.file = os.open(self.name, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW | os.O_CLOEXEC, 0o666)
        try:
            fcntl.flock(self.file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            os.close(self.file)
            raise Refused(f"'{self.path}': another process is writing this file. Wait until it has finished?") from None

    def __exit__(self, *_):
        os.unlink(self.name)
        os.close(self.file)


def publish(files):
    """Writes the contents of every file next to its place and then moves all of them there."""
    drafts = {path: f"{os.path.realpath(path)}.{os.getpid()}.gumshoe-new" for path in files}
    try:
        for path, content in files.items():
            number = os.open(drafts[path], os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW | os.O_CLOEXEC, 0o666)
            with open(number, "wb") as file:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
                file.write(content)
                file.flush()
                os.fsync(file.fileno())
        for path, draft in drafts.items():
            os.replace(draft, os.path.realpath(path))
    finally:
        for draft in drafts.values():
            if os.path.exists(draft):
                os.unlink(draft)
