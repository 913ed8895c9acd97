#!/usr/bin/env python3
"""Downloads the published training data of ETH3D (https://www.eth3d.net): the SLAM sequences in stereo, and the
two-view pairs.

    download_eth3d.py TARGET                         everything; the sequences take tens of gigabytes
    download_eth3d.py TARGET cables_1 cables_2       two sequences
    download_eth3d.py TARGET --two-view              only the pairs
    download_eth3d.py TARGET --list                  lists what is published and what TARGET contains

TARGET/slam/training/NAME, TARGET/two_view_training/NAME and TARGET/two_view_training_gt/NAME are created when they are
complete; existing folders are not downloaded again. An interrupted transfer is resumed, either immediately or when the
script is started again. Each archive is verified by its size, its internal checksums, and its SHA-256 if one is known
from --checksums or an earlier download (TARGET/SHA256SUMS). `quadedge check TARGET` reports what is present and
missing, by the list in TARGET/eth3d_published.txt.
Needs the program curl, and for the pairs 7z (Debian: p7zip-full).
Exit code: 0 complete, 1 something could not be downloaded, 2 wrong usage.
"""

import argparse
import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
import time
import urllib.parse
import zipfile
import zlib
from pathlib import Path

ADDRESS = "https://www.eth3d.net/data"
SLAM_LIST = "slam/dataset_list_training.txt"
SLAM_PARTS = ("mono", "stereo")  # rgb/ with calibration and ground truth, then the files of the second camera
TWO_VIEW = ("two_view_training", "two_view_training_gt")

# curl ends with the script, even if the script is killed, so that two never write the same file. Unbuffered, so that a
# kill loses no received data. A minute without a byte ends the attempt.
CURL = "setpriv --pdeathsig KILL curl --disable --fail --location --no-buffer --continue-at - --connect-timeout 60"
CURL = (CURL + " --speed-limit 1 --speed-time 60 --write-out %{http_code}").split()


class Problem(Exception):
    """An error to report to the user."""


def transfer(url, part):
    """One attempt of curl to complete `part`. Returns the error, or None. Raises Problem for errors that another
    attempt cannot fix."""
    progress = ["--progress-bar"] if sys.stderr.isatty() else ["--silent", "--show-error"]
    result = subprocess.run([*CURL, *progress, "--output", part, "--", url], stdout=subprocess.PIPE, text=True)
    status = int(result.stdout or 0)
    # 416: the server has no more data. The check of the archive decides whether the file is complete.
    if result.returncode == 0 or status == 416:
        return None
    if 400 <= status < 500:
        raise Problem(f"{url}: HTTP status {status}")
    if status >= 500:
        return f"HTTP status {status}"
    if result.returncode == 33:  # a server without support for partial transfers
        part.unlink(missing_ok=True)
    return f"the transfer broke off (curl's exit code {result.returncode})"


def fetch(url, archive, attempts, wait):
    """Downloads a whole file; attempts that receive data do not count towards the limit."""
    part = archive.with_name(archive.name + ".part")
    size = lambda: part.stat().st_size if part.exists() else 0
    failures, before = 0, size()
    while problem := transfer(url, part):
        failures = 0 if size() > before else failures + 1
        before = size()
        if failures >= attempts:
            raise Problem(f"{url}: {problem}")
        print(f"{archive.name}: {problem}; trying again", file=sys.stderr)
        time.sleep(wait)
    part.rename(archive)


def sha256(path):
    with open(path, "rb") as file:
        digest = hashlib.sha256()
        while block := file.read(1 << 18):
            digest.update(block)
    return digest.hexdigest()


def read_lines(path, name=None):
    try:
        return path.read_text(encoding="utf-8").splitlines()
    except UnicodeDecodeError as error:
        raise Problem(f"{name or path}: not a text file ({error})") from error


def read_checksums(path):
    """NAME -> SHA-256, from a file in the format of sha256sum."""
    known = {}
    for number, line in enumerate(read_lines(path), 1):
        words = line.split()
        if not words:
            continue
        if len(words) != 2 or len(words[0]) != 64:
            raise Problem(f"{path}:{number}: expected a SHA-256 and a file name")
        known[Path(words[1].lstrip("*")).name] = words[0].lower()
    return known


# What zipfile raises for archives that are truncated, damaged, encrypted, or in an unsupported format.
UNREADABLE = (zipfile.BadZipFile, zlib.error, OSError, ValueError, EOFError, RuntimeError)


def damage(archive, known):
    """The fault of an archive, or None."""
    if archive.name in known and (found := sha256(archive)) != known[archive.name]:
        return f"wrong checksum: SHA-256 {found}, expected {known[archive.name]}"
    if archive.suffix == ".zip":
        try:
            with zipfile.ZipFile(archive) as file:
                bad = file.testzip()
                return f"wrong checksum of {bad} inside it" if bad else None
        except UNREADABLE as error:
            return f"damaged archive: {error}"
    test = subprocess.run(
        ["7z", "t", "-p", "-bso0", "-bsp0", archive], capture_output=True, text=True, errors="replace"
    )
    return None if test.returncode == 0 else f"damaged archive: {' '.join(test.stderr.split())}"


class Downloader:
    def __init__(self, arguments):
        self.target, self.address = arguments.target, arguments.address.rstrip("/")
        self.attempts, self.wait, self.keep = arguments.attempts, arguments.wait, arguments.keep_archives
        self.archives = self.target / "archives"
        self.sums = self.target / "SHA256SUMS"
        self.known = read_checksums(self.sums) if self.sums.exists() else {}
        if arguments.checksums:
            self.known.update(read_checksums(arguments.checksums))

    def published_sequences(self):
        with tempfile.TemporaryDirectory() as folder:
            list_file = Path(folder) / Path(SLAM_LIST).name
            url = f"{self.address}/{SLAM_LIST}"
            fetch(url, list_file, self.attempts, self.wait)
            names = [line.strip() for line in read_lines(list_file, url) if line.strip()]
        if not names or any("/" in name or name.startswith(".") for name in names):
            raise Problem(f"{url}: not a list of sequences")
        return names

    def archive(self, place):
        """A verified archive; downloaded a second time if the first one is damaged."""
        archive = self.archives / Path(place).name
        self.archives.mkdir(parents=True, exist_ok=True)
        for _ in range(2):
            if not archive.exists():
                fetch(f"{self.address}/{place}", archive, self.attempts, self.wait)
            problem = damage(archive, self.known)
            if problem is None:
                self.note_checksum(archive)
                return archive
            print(f"{archive.name}: {problem}; it is deleted", file=sys.stderr)
            archive.unlink()
        raise Problem(f"{self.address}/{place}: {problem}")

    def note_checksum(self, archive):
        if archive.name not in self.known:
            self.known[archive.name] = sha256(archive)
        recorded = read_checksums(self.sums) if self.sums.exists() else {}
        recorded[archive.name] = self.known[archive.name]
        spare = self.sums.with_name("SHA256SUMS.part")
        spare.write_text("".join(f"{value}  {name}\n" for name, value in sorted(recorded.items())))
        spare.rename(self.sums)

    def unpack(self, archives, place, top=None):
        """Unpacks the archives into a folder that is created when it is complete. `top`: name of the top folder inside
        the archives, which is removed from the paths; empty if there is none."""
        spare = place.with_name("." + place.name + ".part")
        shutil.rmtree(spare, ignore_errors=True)
        spare.mkdir(parents=True)
        for archive in archives:
            if archive.suffix == ".zip":
                with zipfile.ZipFile(archive) as file:
                    file.extractall(spare)
            else:
                subprocess.run(["7z", "x", "-y", "-p", "-bso0", "-bsp0", f"-o{spare}", archive], check=True)
        found = sorted(entry.name for entry in spare.iterdir())
        if top and found != [top] and (top in found or "rgb" not in found):
            shutil.rmtree(spare)
            names = " and ".join(archive.name for archive in archives)
            raise Problem(f"{names}: found {', '.join(found) or 'nothing'}, expected a folder {top}")
        (spare / top if found == [top] else spare).rename(place)
        shutil.rmtree(spare, ignore_errors=True)
        if not self.keep:
            for archive in archives:
                archive.unlink()

    def sequence(self, name):
        place = self.target / "slam" / "training" / name
        if place.is_dir():
            return
        archives = [self.archive(f"slam/datasets/{name}_{part}.zip") for part in SLAM_PARTS]
        self.unpack(archives, place, top=name)

    def pairs(self, name):
        place = self.target / name
        if not place.is_dir():
            self.unpack([self.archive(f"{name}.7z")], place)
        return sorted(f"{name}/{entry.name}" for entry in place.iterdir() if entry.is_dir())


def write_published(target, sequences, pairs):
    """Writes the list for `quadedge check`. Pairs are added once their archive is unpacked, and remain in it."""
    path = target / "eth3d_published.txt"
    before = read_lines(path) if path.exists() else []
    pairs = set(pairs) | {line for line in before if line.startswith(TWO_VIEW)}
    lines = ["# Folders that ETH3D publishes; `quadedge check` compares them with what is here."]
    lines += [f"slam/training/{name}" for name in sequences] + sorted(pairs)
    spare = path.with_name(path.name + ".part")
    spare.write_text("\n".join(lines) + "\n")
    spare.rename(path)


def parse_arguments():
    """The options with derived values, and the function that reports a usage error."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("target", type=Path, metavar="TARGET")
    parser.add_argument(
        "sequences", nargs="*", metavar="SEQUENCE", help="names of SLAM sequences; default: all of them"
    )
    parser.add_argument("--slam", action="store_true", help="only the SLAM sequences")
    parser.add_argument("--two-view", action="store_true", help="only the two-view pairs")
    parser.add_argument("--list", action="store_true", help="list what is published; download nothing")
    parser.add_argument("--checksums", type=Path, metavar="FILE", help="SHA-256 of archives (format of sha256sum)")
    parser.add_argument("--keep-archives", action="store_true", help="keep TARGET/archives after unpacking")
    parser.add_argument(
        "--attempts", type=int, default=5, help="consecutive attempts without data before giving up (%(default)s)"
    )
    parser.add_argument("--wait", type=float, default=5, help="seconds between attempts (%(default)s)")
    parser.add_argument("--address", default=ADDRESS, help="address of the data (%(default)s)")
    arguments = parser.parse_intermixed_args()  # options may follow names
    if arguments.slam and arguments.two_view or arguments.sequences and arguments.two_view:
        parser.error("--two-view loads no sequence")
    arguments.with_slam = not arguments.two_view
    arguments.with_pairs = not arguments.slam and not arguments.sequences
    if urllib.parse.urlsplit(arguments.address).scheme not in ("http", "https"):
        parser.error(f"--address {arguments.address}: expected http://... or https://...")
    if shutil.which("curl") is None:
        parser.error("the program curl is missing (Debian: curl)")
    if arguments.with_pairs and not arguments.list and shutil.which("7z") is None:
        parser.error(
            "the two-view pairs need the program 7z (Debian: p7zip-full); --slam loads the sequences without it"
        )
    return arguments, parser.error


def main():
    arguments, complain = parse_arguments()
    with_slam, with_pairs = arguments.with_slam, arguments.with_pairs
    problems = []

    def attempt(work, *values):
        try:
            return work(*values)
        except (Problem, OSError, subprocess.CalledProcessError) as problem:
            print(f"error: {problem}", file=sys.stderr)
            problems.append(problem)
            return []

    downloader = Downloader(arguments)
    published = downloader.published_sequences() if with_slam or arguments.list else []
    if arguments.list:
        for place in [f"slam/training/{name}" for name in published] + list(TWO_VIEW):
            print(f"{'there  ' if (arguments.target / place).is_dir() else 'missing'}  {place}")
        return 0
    unknown = [name for name in arguments.sequences if name not in published]
    if unknown:
        complain(f"no such sequence: {', '.join(unknown)}; --list shows all")
    os.makedirs(arguments.target, exist_ok=True)
    if with_slam:
        write_published(arguments.target, published, [])
    for name in (arguments.sequences or published) if with_slam else []:
        attempt(downloader.sequence, name)
    pairs = [pair for name in TWO_VIEW for pair in attempt(downloader.pairs, name)] if with_pairs else []
    if not with_slam:
        path = arguments.target / "eth3d_published.txt"
        prefix = "slam/training/"
        published = (
            [line[len(prefix) :] for line in read_lines(path) if line.startswith(prefix)] if path.exists() else []
        )
    write_published(arguments.target, published, pairs)
    if not any(downloader.archives.iterdir() if downloader.archives.is_dir() else []):
        shutil.rmtree(downloader.archives, ignore_errors=True)
    print(f"{'complete' if not problems else f'{len(problems)} problems'}: {arguments.target}")
    return 1 if problems else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (Problem, OSError) as problem:
        print(f"error: {problem}", file=sys.stderr)
        sys.exit(1)
    except KeyboardInterrupt:
        print("interrupted; run the same command to resume", file=sys.stderr)
        sys.exit(130)
