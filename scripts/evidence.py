#!/usr/bin/env python3
"""Errors of QuadEdge and of other systems on whole recordings, for README.md and doc/accuracy.md.

    scripts/evidence.py [--street DIR] [--karlsruhe DIR] [--mh_01 DIR] [--quadedge FILE] [--opencv-baseline FILE]
                        [--viso2 FILE] [--peers PYTHON] [--seeds N] [--only SYSTEM] [--work DIR] [--out FILE]

The folders are the recordings of RECORDINGS, which says where they come from; a recording that is not given keeps the
rows of --out with their commit. Peers run on the same machine in the same call:
  --viso2            libviso2 (GPL, no part of this repository): a program of yours that is called as
                     VISO2 LEFT_FOLDER RIGHT_FOLDER F CU CV BASELINE POSES, writes one row of KITTI's format per pair
                     to POSES and prints "median X ms, p99 Y ms"
  --peers            a Python with pyorbslam3, toy-vo, opencv-python-headless and NumPy (evidence_peers.py)
  --opencv-baseline  build/bench/opencv_baseline
--only measures one of QUADEDGE and leaves the other rows, with their commit.
A peer that is not given is left out, one that fails is named with the reason. They get pairs that OpenCV has rectified
(alpha 0); their poses are turned back to the recorded left camera. QuadEdge gets the recording as it is.
Writes doc/results/evidence.json; then scripts/result_tables.py writes the tables.
Exit code: 0 done, 1 a measurement failed, 2 wrong usage.
"""

import argparse
import json
import os
import re
import resource
import statistics
import subprocess
import sys
from pathlib import Path

import result_tables
from stamped import commit, stamped, write

REPOSITORY = Path(__file__).resolve().parent.parent
# Name, official name, part of it (first and last stamp [ns] of the left images), where it comes from, lengths of
# sub-paths [m]. The truth of Karlsruhe has no orientation that could be used, so only its length is compared, with
# that of the inertial system's positions at the frames [m] in path_length.txt.
RECORDINGS = {
    "street": ("KITTI street", "KITTI raw, 2011_09_26, 14:05, unrectified cameras 0 and 1", (10, 20, 50, 100, 200),
               "https://www.cvlibs.net/datasets/kitti/raw_data.php"),
    "karlsruhe": ("Karlsruhe", "Karlsruhe sequences, 2010_03_09_drive_0019", (),
                  "https://www.cvlibs.net/datasets/karlsruhe_sequences/"),
    "mh_01": ("EuRoC MH_01", "EuRoC MAV, MH_01_easy", (0.5, 1, 2, 5),
              "https://projects.asl.ethz.ch/datasets/euroc-mav/"),
}
# The order of the rows; with their arguments, those of QuadEdge. Times with --calibrate would be those of two programs.
QUADEDGE = {"QuadEdge": [], "QuadEdge, --calibrate": ["--calibrate"], "QuadEdge, fast": ["--preset", "fast"]}
SYSTEMS = (*QUADEDGE, "viso2", "orb_slam3", "toy_vo", "OpenCV SIFT + PnP")
PEER_SECONDS = 600  # a peer that takes longer for a recording is left out


class Recording:
    """A folder with a recording, and its rectified pairs, which are made in `work` at first use."""

    def __init__(self, name, folder, work):
        self.name, self.folder, self.pairs = name, folder, work / "rectified"
        self.rotation = None  # rectified_from_left, if the images had to be rectified
        truth = folder / "truth.txt"
        self.truth = truth if truth.exists() else None
        length = folder / "path_length.txt"
        self.true_length = float(length.read_text(encoding="ascii")) if length.exists() else None
        left = sorted((folder / "mav0/cam0/data").glob("*.png"))
        if left:
            self.stamps = [int(file.stem) for file in left]
        else:
            self.stamps = [round(float(line) * 1e9) for line in (folder / "times.txt").read_text().split()]

    def rectify(self):
        """Writes KITTI's layout to `pairs`."""
        import cv2
        import numpy
        import yaml

        if not (self.folder / "mav0").exists():
            self.pairs = self.folder
            return
        texts = [(self.folder / f"mav0/cam{k}/sensor.yaml").read_text() for k in (0, 1)]
        sensors = [yaml.safe_load(text.replace("%YAML:1.0", "")) for text in texts]  # OpenCV's directive is not YAML's
        body = [numpy.reshape(sensor["T_BS"]["data"], (4, 4)) for sensor in sensors]
        right_from_left = numpy.linalg.inv(body[1]) @ body[0]
        lenses = [(numpy.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1]]), numpy.array(sensor["distortion_coefficients"]))
                  for sensor in sensors for fx, fy, cx, cy in [sensor["intrinsics"]]]
        size = tuple(sensors[0]["resolution"])
        turn_0, turn_1, made_0, made_1, *_ = cv2.stereoRectify(
            *lenses[0], *lenses[1], size, right_from_left[:3, :3], right_from_left[:3, 3:], alpha=0)
        self.rotation = turn_0
        for camera, (matrix, lens), turn, made in zip((0, 1), lenses, (turn_0, turn_1), (made_0, made_1)):
            out = self.pairs / f"image_{camera}"
            if out.exists():
                continue
            out.mkdir(parents=True)
            maps = cv2.initUndistortRectifyMap(matrix, lens, turn, made, size, cv2.CV_32FC1)
            for image in sorted((self.folder / f"mav0/cam{camera}/data").glob("*.png")):
                pixels = cv2.imread(str(image), cv2.IMREAD_GRAYSCALE)
                cv2.imwrite(str(out / image.name), cv2.remap(pixels, *maps, cv2.INTER_LINEAR))
        rows = [" ".join(repr(float(value)) for value in made.ravel()) for made in (made_0, made_1)]
        (self.pairs / "calib.txt").write_text(f"P0: {rows[0]}\nP1: {rows[1]}\n")
        (self.pairs / "times.txt").write_text("".join(f"{stamp * 1e-9:.9f}\n" for stamp in self.stamps))

    def turn_back(self, rows):
        """Poses (stamp [ns], 4 x 4) of the rectified camera as rows of TUM's format of the recorded one."""
        import numpy
        from evidence_peers import quaternion

        turn = numpy.eye(4)
        if self.rotation is not None:
            turn[:3, :3] = self.rotation
        lines = []
        for stamp, pose in rows:
            pose = pose @ turn
            values = (*pose[:3, 3], *quaternion(pose[:3, :3]))
            lines.append(f"{stamp // 10**9}.{stamp % 10**9:09d} " + " ".join(f"{value:.9f}" for value in values) + "\n")
        return "".join(lines)


def camera_of(calibration):
    """Focal length, principal point and baseline of KITTI's calib.txt."""
    rows = {name: [float(value) for value in values.split()] for name, values in
            (line.split(":", 1) for line in calibration.read_text(encoding="utf-8").splitlines() if ":" in line)}
    return rows["P0"][0], rows["P0"][2], rows["P0"][6], -rows["P1"][3] / rows["P1"][0]


def call(command, environment=None, seconds=None):
    """What a program prints, and its processor time [s], that of decoding and starting included."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                          check=False, env={**os.environ, **(environment or {})}, timeout=seconds)
    if done.returncode != 0:
        raise RuntimeError(f"{Path(command[0]).name} ended with {done.returncode}: {done.stderr.strip()[-300:]}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return done.stdout, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def run_quadedge(options, recording, folder, seed, arguments):
    """Runs the program. Returns its command, its trajectory, what report.json says of the run, processor time [s]."""
    _, used = call([options.quadedge, "run", recording.folder, "-o", folder, "--force", "--quiet", "--seed", seed,
                    *arguments])
    report = json.loads((folder / "report.json").read_text(encoding="utf-8"))
    shown = ["quadedge", "run", recording.name, "-o", "OUT", "--seed", str(seed), *arguments]
    return " ".join(shown), folder / "trajectory.txt", report, used


def run_peer(options, recording, folder, system):
    """Runs a peer on the rectified pairs. Returns its version, trajectory, times per frame [ms], processor time [s]."""
    import numpy

    recording.rectify()
    folder.mkdir(parents=True, exist_ok=True)
    poses = folder / "rectified.txt"
    if system == "viso2":
        printed, used = call([options.viso2, recording.pairs / "image_0", recording.pairs / "image_1",
                              *camera_of(recording.pairs / "calib.txt"), poses])
        times = {name: float(value) for name, value in re.findall(r"(median|p99) ([\d.]+) ms", printed)}
        matrices = [numpy.vstack([numpy.array(line.split(), float).reshape(3, 4), [0, 0, 0, 1]])
                    for line in poses.read_text().splitlines()]
        stamped_poses, version = list(zip(recording.stamps, matrices)), "libviso2"
    else:
        # ORB-SLAM3 reads memory that it has not written; glibc then hands out zeros.
        printed, used = call([options.peers, REPOSITORY / "scripts/evidence_peers.py", system, recording.pairs, poses],
                       {"MALLOC_PERTURB_": "255"}, PEER_SECONDS)
        about = json.loads(printed.strip().splitlines()[-1])
        version, each = about["version"], [1000 * seconds for seconds in about["seconds"]]
        times = {"first": each[0], "median": statistics.median(each[2:]), "p99": numpy.percentile(each[2:], 99)}
        stamped_poses = []
        for line in poses.read_text().splitlines():
            stamp, *values = map(float, line.split())
            x, y, z, w = values[3:]
            pose = numpy.eye(4)
            pose[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
            pose[:3, 3] = values[:3]
            nearest = min(recording.stamps, key=lambda of, at=stamp * 1e9: abs(of - at))
            stamped_poses.append((nearest, pose))
    trajectory = folder / "trajectory.txt"
    trajectory.write_text(recording.turn_back(stamped_poses), encoding="ascii")
    return version, trajectory, times, used


def judge(options, recording, trajectory):
    """What `quadedge evaluate trajectory` says of a file, and the length of its path [m]."""
    points = [[float(value) for value in line.split()[1:4]] for line in trajectory.read_text().splitlines()
              if line and not line.startswith("#")]
    length = sum(sum((a - b) ** 2 for a, b in zip(one, other)) ** 0.5 for one, other in zip(points, points[1:]))
    judged = {"poses": len(points), "length_m": length}
    if recording.truth is not None:
        file = trajectory.parent / "errors.json"
        lengths = ",".join(map(str, RECORDINGS[recording.name][2]))
        call([options.quadedge, "evaluate", "trajectory", trajectory, recording.truth, "--lengths", lengths, "--json",
              file, "--force"])
        accuracy = json.loads(file.read_text(encoding="utf-8"))["accuracy"]
        judged["errors"] = {"accuracy": {name: accuracy[name] for name in ("ate_rmse_m", "rpe_interval", "sub_paths")}}
    return judged


def measure(options, recording, work):
    """Rows of a recording: one per system, with the runs of all seeds."""
    rows = []

    def add(system, version, runs, command=None, left_out=None):
        rows.append({"recording": recording.name, "official": RECORDINGS[recording.name][1],
                     "source": RECORDINGS[recording.name][3], "system": system, "version": version, "command": command,
                     "frames": len(recording.stamps), "first_stamp_ns": recording.stamps[0],
                     "last_stamp_ns": recording.stamps[-1], "runs": runs,
                     "true_length_m": recording.true_length, "left_out": left_out})
        print(f"{recording.name}, {system}: {left_out or len(runs)}", file=sys.stderr)

    for system, arguments in QUADEDGE.items():
        if options.only not in (None, system):
            continue
        runs, shown = [], None
        for seed in range(1, options.seeds + 1):
            folder = work / f"{system.replace(', ', '_')}_{seed}"
            command, trajectory, report, used = run_quadedge(options, recording, folder, seed, arguments)
            shown = shown or command
            times = {} if "--calibrate" in arguments else {"latency_ms": report["latency_ms"], "processor_s": used}
            runs.append({**judge(options, recording, trajectory), "seed": seed, **times,
                         "consistency": report.get("accuracy", {}).get("consistency"), "warnings": report["warnings"]})
        add(system, None, runs, shown)
    if options.only:
        return rows
    commands = {"viso2": "VISO2 PAIRS/image_0 PAIRS/image_1 F CU CV BASELINE POSES",
                **{peer: f"PYTHON scripts/evidence_peers.py {peer} PAIRS POSES" for peer in ("orb_slam3", "toy_vo")}}
    for system, is_given, repetitions in (("viso2", options.viso2, 1), ("orb_slam3", options.peers, options.seeds),
                                          ("toy_vo", options.peers, 1)):
        if not is_given:
            continue
        runs = []
        try:
            for seed in range(1, repetitions + 1):
                version, trajectory, times, used = run_peer(options, recording, work / f"{system}_{seed}", system)
                runs.append({**judge(options, recording, trajectory), "seed": seed, "latency_ms": times,
                             "processor_s": used})
            add(system, version, runs, commands[system])
        except subprocess.TimeoutExpired:
            add(system, None, [], left_out=f"not finished after {PEER_SECONDS // 60} minutes")
        except (RuntimeError, OSError, ImportError, TypeError, ValueError) as error:
            add(system, None, [], left_out=f"failed: {error}")
    if options.opencv_baseline:
        folder = work / "opencv"
        _, used = call([options.opencv_baseline, recording.folder, "-o", folder, "--force"])
        add("OpenCV SIFT + PnP", None, [{**judge(options, recording, folder / "trajectory.txt"), "seed": 1,
                                         "processor_s": used}],
            f"opencv_baseline {recording.name} -o OUT")
    return rows


def parse():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name, about in RECORDINGS.items():
        parser.add_argument(f"--{name}", type=Path, metavar="DIR", help=about[1])
    parser.add_argument("--quadedge", type=Path, default=REPOSITORY / "build/quadedge", metavar="FILE")
    parser.add_argument("--opencv-baseline", type=Path, metavar="FILE")
    parser.add_argument("--viso2", type=Path, metavar="FILE")
    parser.add_argument("--peers", type=Path, metavar="PYTHON")
    parser.add_argument("--seeds", type=int, default=5, metavar="N")
    parser.add_argument("--only", choices=QUADEDGE, metavar="SYSTEM")
    parser.add_argument("--work", type=Path, default=Path("evidence"), metavar="DIR")
    parser.add_argument("--out", type=Path, default=REPOSITORY / "doc/results/evidence.json", metavar="FILE")
    options = parser.parse_args()
    if options.seeds < 1 or not any(getattr(options, name) for name in RECORDINGS):
        parser.error("expected the folder of a recording, and at least one seed")
    return options


def main():
    options = parse()
    measured = commit()
    before = json.loads(options.out.read_text(encoding="utf-8")) if options.out.exists() else {"rows": []}
    rows = {name: [row for row in before["rows"] if row["recording"] == name] for name in RECORDINGS}
    try:
        for name in RECORDINGS:
            folder = getattr(options, name)
            if folder is None:
                continue
            recording = Recording(name, folder, options.work / name)
            made = [{"commit": measured, **row} for row in measure(options, recording, options.work / name)]
            kept = [row for row in rows[name] if options.only and row["system"] != options.only]
            rows[name] = sorted(kept + made, key=lambda row: SYSTEMS.index(row["system"]))
            whole = [row for part in rows.values() for row in part]
            write({**before, "rows": whole} if options.only else
                  stamped({"seeds": options.seeds, "rows": whole}, measured), options.out)  # nothing measured is lost
    except (RuntimeError, OSError) as error:
        print(f"evidence: {error}", file=sys.stderr)
        return 1
    if options.out.parent == result_tables.RESULTS:
        result_tables.write()
    return 0


if __name__ == "__main__":
    sys.exit(main())
