#!/usr/bin/env python3
"""Tests scripts/download_eth3d.py against a local server with the layout of the official one.

test_download_eth3d.py DOWNLOAD_SCRIPT QUADEDGE [UNITTEST OPTION...]
"""

import hashlib
import http.server
import io
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import zipfile
from pathlib import Path

SCRIPT, QUADEDGE = sys.argv[1:3]


def zipped(folder, names, prefix):
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_STORED) as file:
        for name in names:
            for path in sorted(folder.glob(name)):
                file.write(path, f"{prefix}/{path.relative_to(folder)}")
    return buffer.getvalue()


def seven_zipped(folder):
    archive = folder.with_suffix(".7z")
    subprocess.run(["7z", "a", "-bso0", "-bsp0", archive, *sorted(folder.iterdir())], check=True)
    return archive.read_bytes()


class Server(http.server.ThreadingHTTPServer):
    """Serves bytes by path; `faults[path]` lists the faults of the next requests for that path."""

    daemon_threads = True

    def __init__(self, files):
        super().__init__(("127.0.0.1", 0), Handler)
        self.files, self.faults, self.requests, self.sent = dict(files), {}, [], {}
        self.ranges = True
        threading.Thread(target=self.serve_forever, args=(0.01,), daemon=True).start()

    @property
    def address(self):
        return f"http://127.0.0.1:{self.server_port}/data"

    def handle_error(self, request, client_address):
        pass  # a killed client breaks its connection


class Handler(http.server.BaseHTTPRequestHandler):
    def log_message(self, *_):
        pass

    def do_GET(self):
        server, path = self.server, self.path.removeprefix("/data/")
        asked = self.headers.get("Range")
        server.requests.append((path, asked))
        content = server.files.get(path)
        fault = server.faults[path].pop(0) if server.faults.get(path) else None
        if content is None or fault == "unavailable":
            self.send_error(404 if content is None else 503)
            return
        begin = 0
        if asked and server.ranges:
            begin = int(re.fullmatch(r"bytes=(\d+)-", asked)[1])
            if begin >= len(content):
                self.send_response(416)
                self.send_header("Content-Range", f"bytes */{len(content)}")
                self.send_header("Content-Length", "0")
                self.end_headers()
                return
        body = content[begin:]
        self.send_response(206 if begin else 200)
        if begin:
            self.send_header("Content-Range", f"bytes {begin}-{len(content) - 1}/{len(content)}")
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        if fault == "corrupt":
            middle = len(body) // 2
            body = body[:middle] + bytes([body[middle] ^ 255]) + body[middle + 1 :]
        cut = len(body) // 2 if fault in ("break", "stall") else len(body)
        self.wfile.write(body[:cut])
        server.sent[path] = server.sent.get(path, 0) + cut
        if fault == "stall":
            self.wfile.flush()
            time.sleep(30)
        self.close_connection = True


class Download(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.source = Path(tempfile.mkdtemp())
        cls.files = {"slam/dataset_list_training.txt": b"cables_1\nroom_2\n"}
        for seed, name in enumerate(("cables_1", "room_2")):
            folder = cls.source / name
            subprocess.run(
                [QUADEDGE, "synth", folder, "--frames", "2", "--size", "160x100", "--seed", str(seed), "--quiet"],
                check=True,
            )
            mono = ["rgb/*", "rgb.txt", "calibration.txt", "groundtruth.txt"]
            cls.files[f"slam/datasets/{name}_mono.zip"] = zipped(folder, mono, name)
            cls.files[f"slam/datasets/{name}_stereo.zip"] = zipped(
                folder, ["rgb2/*", "calibration2.txt", "extrinsics_1_2.txt"], name
            )
        images, truth = cls.source / "two_view_training", cls.source / "two_view_training_gt"
        for scene in ("forest_1s", "terrace_2s"):
            (images / scene).mkdir(parents=True)
            (truth / scene).mkdir(parents=True)
            for number, camera in enumerate(("rgb2", "rgb")):
                shutil.copy(sorted((cls.source / "room_2" / camera).iterdir())[0], images / scene / f"im{number}.png")
            (truth / scene / "disp0GT.pfm").write_bytes(b"Pf\n1 1\n-1\n\0\0\0\0")
        cls.files["two_view_training.7z"] = seven_zipped(images)
        cls.files["two_view_training_gt.7z"] = seven_zipped(truth)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.source)

    def setUp(self):
        self.server = Server(self.files)
        self.target = Path(tempfile.mkdtemp()) / "eth3d"

    def tearDown(self):
        self.server.shutdown()
        self.server.server_close()
        shutil.rmtree(self.target.parent)

    def command(self, *options):
        return [
            sys.executable,
            SCRIPT,
            str(self.target),
            "--address",
            self.server.address,
            "--wait",
            "0",
            "--attempts",
            "3",
            *options,
        ]

    def load(self, *options):
        return subprocess.run(self.command(*options), capture_output=True, text=True, timeout=60)

    def loaded(self, name):
        folder = self.target / "slam" / "training" / name
        return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}

    def published(self, name):
        """The files in a sequence's archives."""
        content = {}
        for part in ("mono", "stereo"):
            with zipfile.ZipFile(io.BytesIO(self.files[f"slam/datasets/{name}_{part}.zip"])) as file:
                content.update({entry.removeprefix(name + "/"): file.read(entry) for entry in file.namelist()})
        return content

    def requests(self, path):
        return [asked for requested, asked in self.server.requests if requested == path]

    def test_everything_is_downloaded_once_and_passes_the_check(self):
        result = self.load()
        self.assertEqual(result.returncode, 0, result.stderr)
        for name in ("cables_1", "room_2"):
            self.assertEqual(self.loaded(name), self.published(name))
        self.assertTrue((self.target / "two_view_training" / "forest_1s" / "im1.png").is_file())
        self.assertTrue((self.target / "two_view_training_gt" / "terrace_2s" / "disp0GT.pfm").is_file())
        self.assertFalse((self.target / "archives").exists())
        before = len(self.server.requests)
        self.assertEqual(self.load().returncode, 0)
        self.assertEqual(self.server.requests[before:], [("slam/dataset_list_training.txt", None)])
        check = subprocess.run([QUADEDGE, "check", self.target], capture_output=True, text=True)
        self.assertEqual(check.returncode, 0, check.stderr)
        self.assertIn(
            "there    slam/training/cables_1: eth3d-slam, 2 frames, 160 x 100 px, ground truth of 2 of 2 frames",
            check.stdout,
        )
        self.assertIn("there    two_view_training/terrace_2s: eth3d-two-view, 1 frame", check.stdout)
        self.assertIn("4 there, 0 of them damaged, 0 published ones missing", check.stdout)

    def test_check_reports_missing_and_damaged_sequences(self):
        self.assertEqual(self.load("cables_1").returncode, 0)
        check = subprocess.run([QUADEDGE, "check", self.target], capture_output=True, text=True)
        self.assertEqual(check.returncode, 0, check.stderr)
        self.assertIn(
            "missing  slam/training/room_2\n1 there, 0 of them damaged, 1 published ones missing", check.stdout
        )
        listing = self.load("--list").stdout
        self.assertIn("there    slam/training/cables_1", listing)
        self.assertIn("missing  slam/training/room_2", listing)
        next((self.target / "slam/training/cables_1/rgb2").iterdir()).unlink()
        check = subprocess.run([QUADEDGE, "check", self.target], capture_output=True, text=True)
        self.assertEqual(check.returncode, 3)
        self.assertIn("DAMAGED  slam/training/cables_1", check.stdout)

    def test_a_broken_transfer_resumes_where_it_stopped(self):
        path = "slam/datasets/room_2_mono.zip"
        self.server.faults[path] = ["break", "unavailable", "break"]
        result = self.load("room_2")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("broke off", result.stderr)
        self.assertEqual(self.loaded("room_2"), self.published("room_2"))
        size = len(self.files[path])
        first = size // 2
        second = first + (size - first) // 2
        self.assertEqual(self.requests(path), [None, f"bytes={first}-", f"bytes={first}-", f"bytes={second}-"])
        self.assertEqual(self.server.sent[path], size)  # no byte twice

    def test_a_killed_download_resumes_when_started_again(self):
        path = "slam/datasets/room_2_stereo.zip"
        self.server.faults[path] = ["stall"]
        part = self.target / "archives" / "room_2_stereo.zip.part"
        with subprocess.Popen(self.command("room_2"), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
            deadline = time.monotonic() + 20
            while (
                not (part.exists() and part.stat().st_size == len(self.files[path]) // 2)
                and time.monotonic() < deadline
            ):
                time.sleep(0.02)
            process.send_signal(signal.SIGKILL)
        self.assertEqual(part.stat().st_size, len(self.files[path]) // 2)
        self.assertFalse((self.target / "slam/training/room_2").exists())
        result = self.load("room_2")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(self.requests(path)[-1], f"bytes={len(self.files[path]) // 2}-")
        self.assertEqual(len(self.requests("slam/datasets/room_2_mono.zip")), 1)  # that one was complete
        self.assertEqual(self.loaded("room_2"), self.published("room_2"))

    def test_versions_of_a_file_are_never_mixed(self):
        path = "slam/datasets/room_2_mono.zip"
        self.server.faults[path] = ["break", "unavailable", "unavailable", "unavailable"]
        self.assertEqual(self.load("room_2").returncode, 1)
        self.server.files[path] = zipped(self.source / "room_2", ["rgb.txt", "calibration.txt", "rgb/*"], "room_2")
        result = self.load("room_2")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertRegex(result.stderr, "room_2_mono.zip: (wrong checksum|damaged)")
        self.assertNotIn("groundtruth.txt", self.loaded("room_2"))

    def test_a_partial_file_longer_than_the_file_is_discarded(self):
        part = self.target / "archives" / "room_2_mono.zip.part"
        part.parent.mkdir(parents=True)
        part.write_bytes(b"x" * (len(self.files["slam/datasets/room_2_mono.zip"]) + 1))
        result = self.load("room_2")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(self.loaded("room_2"), self.published("room_2"))

    def test_a_complete_partial_file_is_not_downloaded_again(self):
        path = "slam/datasets/room_2_mono.zip"
        part = self.target / "archives" / "room_2_mono.zip.part"
        part.parent.mkdir(parents=True)
        part.write_bytes(self.files[path])
        result = self.load("room_2")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(self.server.sent.get(path, 0), 0)
        self.assertEqual(self.loaded("room_2"), self.published("room_2"))

    def test_a_server_without_ranges_sends_everything_again(self):
        path = "slam/datasets/cables_1_mono.zip"
        self.server.ranges = False
        self.server.faults[path] = ["break"]
        result = self.load("cables_1")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(self.loaded("cables_1"), self.published("cables_1"))

    def test_a_wrong_byte_is_found_and_the_archive_downloaded_again(self):
        for path in ("slam/datasets/cables_1_mono.zip", "two_view_training.7z"):
            self.server.faults[path] = ["corrupt"]
        result = self.load()
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertRegex(result.stderr, "cables_1_mono.zip: (wrong checksum|damaged)")
        self.assertRegex(result.stderr, "two_view_training.7z: damaged")
        self.assertEqual(self.loaded("cables_1"), self.published("cables_1"))

    def test_a_wrong_checksum_is_refused_and_the_others_continue(self):
        sums = self.target.parent / "sums"
        good = hashlib.sha256(self.files["slam/datasets/room_2_mono.zip"]).hexdigest()
        sums.write_text(f"{'0' * 64}  cables_1_mono.zip\n{good} *room_2_mono.zip\n")
        result = self.load("--slam", "--checksums", str(sums))
        self.assertEqual(result.returncode, 1)
        self.assertIn("cables_1_mono.zip: wrong checksum", result.stderr)
        self.assertEqual(len(self.requests("slam/datasets/cables_1_mono.zip")), 2)
        self.assertFalse((self.target / "slam/training/cables_1").exists())
        self.assertEqual(self.loaded("room_2"), self.published("room_2"))

    def test_an_archive_that_changed_since_the_first_download_is_detected(self):
        self.assertEqual(self.load("room_2").returncode, 0)
        shutil.rmtree(self.target / "slam/training/room_2")
        self.server.files["slam/datasets/room_2_mono.zip"] = zipped(self.source / "room_2", ["rgb/*"], "room_2")
        result = self.load("room_2")
        self.assertEqual(result.returncode, 1)
        self.assertIn("room_2_mono.zip: wrong checksum", result.stderr)

    def test_a_missing_file_is_reported_and_the_others_continue(self):
        del self.server.files["slam/datasets/cables_1_stereo.zip"]
        result = self.load("--slam")
        self.assertEqual(result.returncode, 1)
        self.assertIn("cables_1_stereo.zip: HTTP status 404", result.stderr)
        self.assertEqual(len(self.requests("slam/datasets/cables_1_stereo.zip")), 1)
        self.assertFalse((self.target / "slam/training/cables_1").exists())
        self.assertEqual(self.loaded("room_2"), self.published("room_2"))

    def assert_refused(self, result, message, code=1):
        self.assertEqual(result.returncode, code, result.stderr)
        self.assertRegex(result.stderr, message)
        self.assertNotIn("Traceback", result.stderr)

    def test_an_encrypted_archive_is_refused(self):
        folder = self.target.parent / "secret"
        shutil.copytree(self.source / "room_2", folder / "room_2")
        for archive in ("room_2_mono.zip", "two_view_training.7z"):
            subprocess.run(["7z", "a", "-bso0", "-bsp0", "-psecret", folder / archive, folder / "room_2"], check=True)
        self.server.files["slam/datasets/room_2_mono.zip"] = (folder / "room_2_mono.zip").read_bytes()
        self.server.files["two_view_training.7z"] = (folder / "two_view_training.7z").read_bytes()
        self.assert_refused(self.load("room_2"), "room_2_mono.zip: damaged archive: .*encrypted")
        self.assertFalse((self.target / "slam/training/room_2").exists())
        self.assert_refused(self.load("--two-view"), "two_view_training.7z: damaged archive")
        self.assertFalse((self.target / "two_view_training").exists())

    def test_an_archive_with_another_folder_is_refused(self):
        self.server.files["slam/datasets/room_2_mono.zip"] = self.files["slam/datasets/cables_1_mono.zip"]
        self.assert_refused(
            self.load("room_2"),
            "room_2_mono.zip and room_2_stereo.zip: found cables_1, room_2, expected a folder room_2",
        )
        self.assertFalse((self.target / "slam/training/room_2").exists())
        self.assertFalse((self.target / "slam/training/.room_2.part").exists())

    def test_archives_without_a_top_folder_are_unpacked_too(self):
        for part, names in (("mono", ["rgb/*", "rgb.txt"]), ("stereo", ["rgb2/*"])):
            self.server.files[f"slam/datasets/room_2_{part}.zip"] = zipped(self.source / "room_2", names, ".")
        result = self.load("room_2")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("rgb.txt", self.loaded("room_2"))

    def test_lists_that_are_not_text_are_refused(self):
        self.server.files["slam/dataset_list_training.txt"] = b"room_2\n\xff\xfe\n"
        self.assert_refused(self.load("room_2"), "dataset_list_training.txt: not a text file")
        self.server.files["slam/dataset_list_training.txt"] = b"<html><a href='/login'></html>"
        self.assert_refused(self.load("room_2"), "dataset_list_training.txt: not a list of sequences")
        sums = self.target.parent / "sums"
        for content, message in (
            (b"\xff\n", "sums: not a text file"),
            (b"abc room_2_mono.zip\n", "sums:1: expected a SHA-256"),
        ):
            sums.write_bytes(content)
            self.assert_refused(self.load("room_2", "--checksums", str(sums)), message)
        self.assert_refused(self.load("room_2", "--checksums", str(self.target)), "No such file")

    def test_an_invalid_address_is_refused(self):
        for address in ("hello", "file:///etc", ""):
            self.assert_refused(self.load("--address", address), "expected http://", 2)
        self.assert_refused(self.load("--address", "http://127.0.0.1:1/data"), "127.0.0.1:1/data.*curl's exit code 7")

    def test_wrong_names_and_folders_are_refused(self):
        self.assertEqual(self.load("no_such_sequence").returncode, 2)
        self.assertEqual(self.load("room_2", "--two-view").returncode, 2)
        self.target = Path(os.devnull) / "eth3d"
        result = self.load("room_2")
        self.assertEqual(result.returncode, 1)
        self.assertIn("error: ", result.stderr)
        self.target = Path(tempfile.mkdtemp()) / "eth3d"


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
