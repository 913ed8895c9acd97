"""Errors of QuadEdge and of other systems on whole recordings (scripts/measure.py --only evidence).

Peers run on the same machine in the same call, on pairs that OpenCV has rectified (alpha 0); their poses are turned
back to the recorded left camera. QuadEdge gets the recording as it is. A peer that is not given is left out, one that
fails is named with the reason. A recording that is missing, and with --only-system all other rows, keep what
evidence.json has, with its commit.
"""

import json
import math
import os
import re
import statistics
import subprocess
import sys

from harness import REPOSITORY, Problem, positions, report
from stamped import commit

# Name, official name, lengths of sub-paths [m], where it comes from. The truth of Karlsruhe has no orientation that
# could be used, so only its length is compared, with that of the inertial system's positions at the frames [m] in
# path_length.txt.
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
PEERS = {"viso2": "VISO2 PAIRS/image_0 PAIRS/image_1 F CU CV BASELINE POSES",
         "orb_slam3": "PYTHON scripts/evidence_peers.py orb_slam3 PAIRS POSES",
         "OpenCV SIFT + PnP": "opencv_baseline RECORDING -o OUT"}
SYSTEMS = (*QUADEDGE, *PEERS)
PEER_SECONDS = 600  # a peer that takes longer for a recording is left out


class Recording:
    """A folder with a recording, and its rectified pairs, which are made in `work` at first use."""

    def __init__(self, name, folder, work):
        self.name, self.folder, self.pairs = name, folder, work / "rectified"
        self.rotation = None  # rectified_from_left, if the images had to be rectified
        truth, length = folder / "truth.txt", folder / "path_length.txt"
        self.truth = truth if truth.exists() else None
        self.true_length = float(length.read_text(encoding="ascii")) if length.exists() else None
        left = sorted((folder / "mav0/cam0/data").glob("*.png"))
        self.stamps = [int(file.stem) for file in left] if left else [
            round(float(line) * 1e9) for line in (folder / "times.txt").read_text().split()]

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


def run_peer(programs, recording, folder, system):
    """Runs a peer on the rectified pairs; the trajectory is that of the recorded camera. Returns its version, and the
    times per frame [ms] and the processor time [s] of its run."""
    import numpy

    recording.rectify()
    folder.mkdir(parents=True, exist_ok=True)
    rectified = folder / "rectified.txt"
    if system == "viso2":
        printed, used = programs.call([programs.options.viso2, recording.pairs / "image_0", recording.pairs / "image_1",
                                       *camera_of(recording.pairs / "calib.txt"), rectified])
        times = {name: float(value) for name, value in re.findall(r"(median|p99) ([\d.]+) ms", printed)}
        matrices = [numpy.vstack([numpy.array(line.split(), float).reshape(3, 4), [0, 0, 0, 1]])
                    for line in rectified.read_text().splitlines()]
        found, version = list(zip(recording.stamps, matrices)), "libviso2"
    else:
        from quadedge.result_files import rotations

        # ORB-SLAM3 reads memory that it has not written; glibc then hands out zeros.
        printed, used = programs.call(
            [programs.options.peers, REPOSITORY / "scripts/evidence_peers.py", system, recording.pairs, rectified],
            env={**os.environ, "MALLOC_PERTURB_": "255"}, timeout=PEER_SECONDS)
        about = json.loads(printed.strip().splitlines()[-1])
        version, each = about["version"], [1000 * seconds for seconds in about["seconds"]]
        times = {"first": each[0], "median": statistics.median(each[2:]), "p99": numpy.percentile(each[2:], 99)}
        found = []
        for row in numpy.loadtxt(rectified, ndmin=2):
            pose = numpy.eye(4)
            pose[:3, :3], pose[:3, 3] = rotations(row[None, 4:])[0], row[1:4]
            found.append((min(recording.stamps, key=lambda of, at=row[0] * 1e9: abs(of - at)), pose))
    (folder / "trajectory.txt").write_text(recording.turn_back(found), encoding="ascii")
    return version, {"latency_ms": times, "processor_s": used}


def judged(programs, recording, folder):
    """What `quadedge evaluate trajectory` says of a run, and the length of its path [m]."""
    points = [row[1:] for row in positions(folder)]
    found = {"poses": len(points), "length_m": sum(map(math.dist, points, points[1:]))}
    if recording.truth is not None:
        lengths = ",".join(map(str, RECORDINGS[recording.name][2]))
        said, _ = programs.evaluate(folder, recording.truth, "--lengths", lengths)
        found["errors"] = {"accuracy": {name: said["accuracy"][name] for name in ("ate_rmse_m", "rpe_interval",
                                                                                   "sub_paths")}}
    return found


def runs_of(programs, recording, system):
    """The version of a system, the command of its first run and the runs of all seeds."""
    options, runs, version = programs.options, [], None
    single = system in ("viso2", "OpenCV SIFT + PnP")
    command = PEERS.get(system) or " ".join(["quadedge run", recording.name, "-o OUT --seed 1", *QUADEDGE[system]])
    for seed in range(1, 2 if single else options.seeds + 1):
        folder = options.work / "evidence" / recording.name / f"{system.replace(', ', '_').replace(' ', '_')}_{seed}"
        more = {}
        if system in QUADEDGE:
            _, used = programs.track(folder, ["run", recording.folder], QUADEDGE[system], seed)
            found = report(folder)
            if "--calibrate" not in QUADEDGE[system] and used is not None:
                more = {"latency_ms": found["latency_ms"], "processor_s": used}
            more |= {"consistency": found.get("accuracy", {}).get("consistency"), "warnings": found["warnings"]}
        elif system.startswith("OpenCV"):
            more = {"processor_s": programs.run(folder, [options.baseline, recording.folder])}
        else:
            version, more = run_peer(programs, recording, folder, system)
        runs.append({**judged(programs, recording, folder), "seed": seed, **more})
    return version, command, runs


def measure_recordings(programs):
    """One row per recording and system, with the runs of all seeds and the commit of each."""
    options, measured = programs.options, commit()
    is_given = dict.fromkeys(QUADEDGE, True) | {
        "viso2": options.viso2, "orb_slam3": options.peers,
        "OpenCV SIFT + PnP": options.baseline.exists()}
    systems = [system for system in SYSTEMS if is_given[system] and options.only_system in (None, system)]
    file = options.out / "evidence.json"
    rows = json.loads(file.read_text(encoding="utf-8"))["rows"] if file.exists() else []
    for name, (_, official, _, source) in RECORDINGS.items():
        if not (options.recordings / name).is_dir():
            continue
        recording = Recording(name, options.recordings / name, options.work / "evidence" / name)
        if not options.only_system:
            rows = [row for row in rows if row["recording"] != name]
        for system in systems:
            version, command, runs, left_out = None, None, [], None
            try:
                version, command, runs = runs_of(programs, recording, system)
            except subprocess.TimeoutExpired:
                left_out = f"not finished after {PEER_SECONDS // 60} minutes"
            except (Problem, OSError, ImportError, TypeError, ValueError) as error:
                if system in QUADEDGE:
                    raise
                left_out = f"failed: {error}"
            print(f"{name}, {system}: {left_out or len(runs)}", file=sys.stderr)
            rows = [row for row in rows if (row["recording"], row["system"]) != (name, system)]
            rows.append({"commit": measured, "recording": name, "official": official, "source": source,
                         "system": system, "version": version, "command": command, "frames": len(recording.stamps),
                         "first_stamp_ns": recording.stamps[0], "last_stamp_ns": recording.stamps[-1], "runs": runs,
                         "true_length_m": recording.true_length, "left_out": left_out})
    return sorted(rows, key=lambda row: ([*RECORDINGS].index(row["recording"]), SYSTEMS.index(row["system"])))
