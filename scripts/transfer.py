"""Loads files over HTTP: resumed where a transfer broke off, with a progress bar. Python's standard library alone."""

import http.client
import sys
import time
import urllib.error
import urllib.request

BLOCK = 1 << 18  # bytes
TIMEOUT = 60  # s without a byte


class Problem(Exception):
    """Something that a user should read."""


class Progress:
    """A bar on a terminal, else a line every few seconds, on stderr."""

    def __init__(self, name, done, total):
        self.name, self.total, self.start, self.first, self.shown = name, total, time.monotonic(), done, 0.0
        self.terminal = sys.stderr.isatty()

    def show(self, done, last=False):
        now = time.monotonic()
        if not last and now - self.shown < (0.2 if self.terminal else 5):
            return
        self.shown = now
        rate = (done - self.first) / max(now - self.start, 1e-6)
        share = done / self.total if self.total else 0
        text = f"{self.name}  {done / 1e6:.1f} of {(self.total or done) / 1e6:.1f} MB  {rate / 1e6:.1f} MB/s"
        if self.total and rate > 0 and not last:
            text += f"  {(self.total - done) / rate:.0f} s left"
        if self.terminal:
            bar = "#" * int(24 * share)
            print(f"\r[{bar:<24}] {text}\x1b[K", end="\n" if last else "", file=sys.stderr, flush=True)
        else:
            print(text, file=sys.stderr, flush=True)


def transfer(url, part, tag_file):
    """One attempt to complete `part`. The server's name for the version (ETag or date) is kept beside it, so that two versions of a file
    are never put together."""
    have = part.stat().st_size if part.exists() else 0
    tag = tag_file.read_text() if tag_file.exists() else ""
    request = urllib.request.Request(url, headers={"User-Agent": "quadedge"})
    if have and tag:
        request.add_header("Range", f"bytes={have}-")
        request.add_header("If-Range", tag)
    try:
        answer = urllib.request.urlopen(request, timeout=TIMEOUT)
    except urllib.error.HTTPError as error:
        if error.code == 416:  # nothing behind what is there: it is whole, or another file
            part.unlink()
            raise ConnectionError("the server has no bytes behind those loaded before; starting anew") from error
        raise
    with answer:
        if answer.status != 206:
            have = 0
        length = answer.headers.get("Content-Length")
        total = have + int(length) if length else None
        tag = answer.headers.get("ETag") or answer.headers.get("Last-Modified") or ""
        if tag.startswith("W/"):  # a weak ETag is good for no range
            tag = answer.headers.get("Last-Modified") or ""
        tag_file.write_text(tag)
        progress = Progress(part.name[: -len(".part")], have, total)
        with open(part, "ab" if have else "wb") as file:
            done = have
            while block := answer.read1(BLOCK):  # what has arrived, so that a kill loses nothing of it
                file.write(block)
                file.flush()
                done += len(block)
                progress.show(done)
        progress.show(done, last=True)
    if total is not None and done != total:
        raise ConnectionError(f"the transfer broke off after {done} of {total} bytes")


def fetch(url, archive, attempts, wait):
    """Loads a file completely, in as many attempts as it takes; those that bring something do not count."""
    part, tag_file = archive.with_name(archive.name + ".part"), archive.with_name(archive.name + ".tag")
    failures = 0
    while True:
        before = part.stat().st_size if part.exists() else 0
        try:
            transfer(url, part, tag_file)
            break
        except urllib.error.HTTPError as error:
            if error.code < 500:
                raise Problem(f"{url}: {error.code} {error.reason}") from error
            problem = error
        except (urllib.error.URLError, http.client.HTTPException, ConnectionError, TimeoutError) as error:
            problem = error
        after = part.stat().st_size if part.exists() else 0
        failures = 0 if after > before else failures + 1
        if failures >= attempts:
            raise Problem(f"{url}: {problem}")
        print(f"{archive.name}: {problem}; trying again", file=sys.stderr)
        time.sleep(wait)
    part.rename(archive)
    tag_file.unlink(missing_ok=True)
