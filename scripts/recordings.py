"""Errors of QuadEdge and of other systems on whole recordings (scripts/measure.py --only evidence).

Peers run in the same call, on pairs that OpenCV has rectified (alpha 0); their poses are turned back to the recorded
left camera. QuadEdge gets the recording as it is, with "learned rig" each half of it with the calibration that
`quadedge calibrate` learned from the other half. A peer that fails is named with the reason; one that is not given
keeps what evidence.json has but the times of its machine, a recording that is missing keeps everything.
"""

import json
import math
import os
import re
import statistics
import sys

from harness import REPOSITORY, Problem, commit, positions, report

# Name, official name, lengths of sub-paths [m], source, features of ORB-SLAM3's own settings. Karlsruhe's truth has no
# usable orientation: its length is compared with that of the inertial system's positions [m] in path_length.txt.
RECORDINGS = {
    "street": ("KITTI street", "KITTI raw, 2011_09_26, 14:05, unrectified cameras 0 and 1", (10, 20, 50, 100, 200),
               "https://www.cvlibs.net/datasets/kitti/raw_data.php", 2000),
    "karlsruhe": ("Karlsruhe", "Karlsruhe sequences, 2010_03_09_drive_0019", (),
                  "https://www.cvlibs.net/datasets/karlsruhe_sequences/", 2000),
    "mh_01": ("EuRoC MH_01", "EuRoC MAV, MH_01_easy", (0.5, 1, 2, 5),
              "https://projects.asl.ethz.ch/datasets/euroc-mav/", 1200),
}
HALVES = {"street": 200}  # first frame of the second half, where a rig learned from one half is taken for the other
# The order of the rows; with their arguments, those of QuadEdge. Times with --calibrate would be those of two programs.
QUADEDGE = {"QuadEdge": [], "QuadEdge, learned rig": ["--calibration", "RIG"],
            "QuadEdge, --calibrate": ["--calibrate"], "QuadEdge, --loops": ["--loops"],
            "QuadEdge, fast": ["--preset", "fast"]}
PEERS = {"viso2": "VISO2 PAIRS/image_0 PAIRS/image_1 F CU CV BASELINE POSES",
         "viso2, learned rig": "VISO2 PAIRS/image_0 PAIRS/image_1 F CU CV BASELINE POSES",
         "orb_slam3": "PYTHON scripts/evidence_peers.py PAIRS POSES FEATURES",
         "orb_slam3, learned rig": "PYTHON scripts/evidence_peers.py PAIRS POSES FEATURES"}
ONE_RUN = ("viso2", "viso2, learned rig", "QuadEdge, --calibrate", "QuadEdge, --loops")  # of others one per seed
SYSTEMS = (*QUADEDGE, *PEERS)


class Recording:
    """A folder with a recording, or frames of it, and its rectified pairs, which are made in `work` at first use.
    `rig`: another calibration, in OpenCV's form."""

    def __init__(self, name, folder, work, frames=slice(None), rig=None):
        self.name, self.folder, self.work, self.frames, self.rig = name, folder, work, frames, rig
        self.pairs, self.rotation = work / "rectified", None  # rectified_from_left, if images had to be rectified
        truth, length = folder / "truth.txt", folder / "path_length.txt"
        self.truth = truth if truth.exists() else None
        self.true_length = float(length.read_text(encoding="ascii")) if length.exists() else None
        left = sorted((folder / "mav0/cam0/data").glob("*.png"))
        stamps = [int(file.stem) for file in left] if left else [
            round(float(line) * 1e9) for line in (folder / "times.txt").read_text().split()]
        self.stamps = stamps[frames]

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
        if self.rig:
            file = cv2.FileStorage(str(self.rig), cv2.FILE_STORAGE_READ)
            M1, D1, M2, D2, R, T = (file.getNode(name).mat() for name in ("M1", "D1", "M2", "D2", "R", "T"))
            lenses, right_from_left = [(M1, D1), (M2, D2)], numpy.block([[R, T.reshape(3, 1)], [0, 0, 0, 1]])
        turn_0, turn_1, made_0, made_1, *_ = cv2.stereoRectify(
            *lenses[0], *lenses[1], size, right_from_left[:3, :3], right_from_left[:3, 3:], alpha=0)
        self.rotation = turn_0
        for camera, (matrix, lens), turn, made in zip((0, 1), lenses, (turn_0, turn_1), (made_0, made_1)):
            out = self.pairs / f"image_{camera}"
            if out.exists():
                continue
            out.mkdir(parents=True)
            maps = cv2.initUndistortRectifyMap(matrix, lens, turn, made, size, cv2.CV_32FC1)
            for image in sorted((self.folder / f"mav0/cam{camera}/data").glob("*.png"))[self.frames]:
                pixels = cv2.imread(str(image), cv2.IMREAD_GRAYSCALE)
                cv2.imwrite(str(out / image.name), cv2.remap(pixels, *maps, cv2.INTER_LINEAR))
        rows = [" ".join(repr(float(value)) for value in made.ravel()) for made in (made_0, made_1)]
        (self.pairs / "calib.txt").write_text(f"P0: {rows[0]}\nP1: {rows[1]}\n")
        (self.pairs / "times.txt").write_text("".join(f"{stamp * 1e-9:.9f}\n" for stamp in self.stamps))

    def turn_back(self, found, file):
        """Writes poses (stamp [ns], 4 x 4) of the rectified camera as those of the recorded one, in TUM's format."""
        import numpy
        import quadedge

        turn = numpy.eye(4)
        if self.rotation is not None:
            turn[:3, :3] = self.rotation
        poses = numpy.reshape([pose for _, pose in found], (-1, 4, 4)) @ turn
        quadedge.Trajectory(numpy.array([stamp for stamp, _ in found], numpy.int64), poses).write_tum(file)


def halves(programs, recording):
    """Both halves of a recording, each with the calibration learned from the other: that in OpenCV's form in `rig`, and
    with the suffix .yaml in the program's own."""
    middle, work = HALVES[recording.name], recording.work
    for name, frames, other in (("first", slice(0, middle), f"{middle}:"),
                                ("second", slice(middle, None), f"0:{middle}")):
        rig = work / f"rig_{name}.yml"
        if not rig.exists():
            work.mkdir(parents=True, exist_ok=True)
            programs.call([programs.options.quadedge, "calibrate", recording.folder, "--frames", other, "--opencv", rig,
                           "-o", rig.with_suffix(".yaml"), "--quiet", "--force"])
        yield Recording(recording.name, recording.folder, work / name, frames, rig)


def run_peer(programs, recording, folder, system):
    """Runs a peer on the rectified pairs; the trajectory is that of the recorded camera. Returns its version, and the
    times per frame [ms] and the processor time [s] of its run."""
    import numpy
    import quadedge

    recording.rectify()
    folder.mkdir(parents=True, exist_ok=True)
    rectified = folder / "rectified.txt"
    if system.startswith("viso2"):
        rig = quadedge.open_dataset(recording.pairs).rig
        printed, used = programs.call([programs.options.viso2, recording.pairs / "image_0", recording.pairs / "image_1",
                                       rig.left.fx, rig.left.cx, rig.left.cy, rig.baseline, rectified])
        times = {name: float(value) for name, value in re.findall(r"(median|p99) ([\d.]+) ms", printed)}
        found, version = list(zip(recording.stamps, quadedge.Trajectory.from_file(rectified).poses)), "libviso2"
    else:
        # ORB-SLAM3 reads memory that it has not written; glibc then hands out zeros.
        printed, used = programs.call(
            [programs.options.peers, REPOSITORY / "scripts/evidence_peers.py", recording.pairs, rectified,
             RECORDINGS[recording.name][4]],
            env={**os.environ, "MALLOC_PERTURB_": "255"})
        about = json.loads(printed.strip().splitlines()[-1])
        version, each = about["version"], [1000 * seconds for seconds in about["seconds"]]
        times = {"first": each[0], "median": statistics.median(each[2:]), "p99": numpy.percentile(each[2:], 99)}
        trajectory = quadedge.Trajectory.from_file(rectified)
        found = [(min(recording.stamps, key=lambda of, at=stamp: abs(of - at)), pose)
                 for stamp, pose in zip(trajectory.stamps_ns.tolist(), trajectory.poses)]
    recording.turn_back(found, folder / "trajectory.txt")
    return version, {"latency_ms": times, "processor_s": used}


def over_sub_paths(programs, recording, file, rows):
    """Errors over sub-paths of a trajectory, of which `rows` are written to `file`."""
    file.write_text("".join(rows), encoding="ascii")
    programs.call([programs.options.quadedge, "evaluate", "trajectory", file, recording.truth, "--force", "--lengths",
                   ",".join(map(str, RECORDINGS[recording.name][2])), "--json", file.with_suffix(".json")])
    return json.loads(file.with_suffix(".json").read_text(encoding="utf-8"))["accuracy"]


def pooled(each):
    """Errors over the sub-paths of several trajectories: means and standard deviations over all of them."""
    entries = [entry for accuracy in each for entry in accuracy["sub_paths"]["by_length"]]
    for length in sorted({entry["length_m"] for entry in entries}):
        of = [entry for entry in entries if entry["length_m"] == length]
        count, found = sum(entry["sub_paths"] for entry in of), {}
        for mean, sd in (("t_rel_percent", "t_rel_sd_percent"), ("r_rel_deg_per_m", "r_rel_sd_deg_per_m")):
            found[mean] = sum(entry["sub_paths"] * entry[mean] for entry in of) / count
            square = sum(entry["sub_paths"] * (entry[sd] ** 2 + entry[mean] ** 2) for entry in of) / count
            found[sd] = math.sqrt(max(0, square - found[mean] ** 2))
        yield {"length_m": length, "sub_paths": count, **found}


def judged(programs, recording, folders):
    """Poses and length of a run, and its errors: over the whole recording, if it is one trajectory, and in halves."""
    file = "trajectory_map.txt" if (folders[0] / "trajectory_map.txt").exists() else "trajectory.txt"  # with --loops
    rows = [[row for row in open(folder / file, encoding="ascii") if not row.startswith("#")] for folder in folders]
    paths = [[row[1:] for row in positions(folder)] for folder in folders]
    found = {"poses": sum(map(len, rows)), "length_m": sum(math.dist(*ends) for path in paths
                                                           for ends in zip(path, path[1:]))}
    if recording.truth is None:
        return found
    if len(folders) == 1:
        accuracy = over_sub_paths(programs, recording, folders[0] / "whole.txt", rows[0])
        found |= {"ate_rmse_m": accuracy["ate_rmse_m"], "sub_paths": accuracy["sub_paths"]["by_length"]}
    if recording.name in HALVES and len(recording.stamps) > HALVES[recording.name]:
        middle = recording.stamps[HALVES[recording.name]] * 1e-9 - 1e-6
        parts = rows if len(rows) == 2 else [[row for row in rows[0] if (float(row.split()[0]) < middle) == first]
                                             for first in (True, False)]
        found["in_halves"] = [*pooled([over_sub_paths(programs, recording, folders[0] / f"{name}.txt", part)
                                       for name, part in zip(("first", "second"), parts)])]
    return found


def runs_of(programs, recording, system):
    """The version of a system, the command of its first run and the runs of all seeds."""
    options, runs, version = programs.options, [], None
    command = PEERS.get(system) or " ".join(["quadedge run", recording.name, "-o OUT --seed 1", *QUADEDGE[system]])
    parts = [*halves(programs, recording)] if "learned" in system else [recording]
    for seed in range(1, 2 if system in ONE_RUN else options.seeds + 1):
        folders = [part.work / f"{system.replace(', ', '_').replace(' ', '_')}_{seed}" for part in parts]
        more = {}
        for part, folder in zip(parts, folders):
            if system in QUADEDGE:
                frames = ["--frames", f"{part.frames.start}:{part.frames.stop or ''}"] if part.rig else []
                given = [part.rig.with_suffix(".yaml") if word == "RIG" else word for word in QUADEDGE[system]]
                _, used = programs.track(folder, ["run", part.folder, *frames], given, seed)
                found = report(folder)
                if system in ("QuadEdge", "QuadEdge, fast") and used is not None:
                    more = {"latency_ms": found["latency_ms"], "processor_s": used}
                more |= {"consistency": found.get("accuracy", {}).get("consistency"), "warnings": found["warnings"],
                         "flagged": found["frames_ambiguous"]}
            else:
                file = folder / "peer.json"
                if not (options.keep and file.exists()):
                    version, more = run_peer(programs, part, folder, system)
                    file.write_text(json.dumps([version, more]), encoding="utf-8")
                version, more = json.loads(file.read_text(encoding="utf-8"))
        runs.append({**judged(programs, recording, folders), "seed": seed, **(more if len(parts) == 1 else {})})
    return version, command, runs


def measure_recordings(programs):
    """One row per recording and system, with the runs of all seeds and the commit of each."""
    options, measured = programs.options, commit()
    given = {"viso2": options.viso2, "orb_slam3": options.peers}
    systems = [system for system in SYSTEMS if given.get(system.split(",")[0], True)]
    file = options.out / "evidence.json"
    rows = json.loads(file.read_text(encoding="utf-8"))["rows"] if file.exists() else []
    for name, (_, official, _, source, _) in RECORDINGS.items():
        if not (options.recordings / name).is_dir():
            continue
        recording = Recording(name, options.recordings / name, options.work / "evidence" / name)
        rows = [row for row in rows if row["recording"] != name or row["system"] not in systems]
        for run in sum((row["runs"] for row in rows if row["recording"] == name), []):
            run.pop("latency_ms", None), run.pop("processor_s", None)
        for system in systems:
            if "learned" in system and len(recording.stamps) <= HALVES.get(name, math.inf):
                continue
            version, command, runs, left_out = None, None, [], None
            try:
                version, command, runs = runs_of(programs, recording, system)
            except (Problem, OSError, ImportError, TypeError, ValueError) as error:
                if system in QUADEDGE:
                    raise
                left_out = f"failed: {error}"
            print(f"{name}, {system}: {left_out or len(runs)}", file=sys.stderr)
            rows.append({"commit": measured, "recording": name, "official": official, "source": source,
                         "system": system, "version": version, "command": command, "frames": len(recording.stamps),
                         "first_stamp_ns": recording.stamps[0], "last_stamp_ns": recording.stamps[-1], "runs": runs,
                         "true_length_m": recording.true_length, "left_out": left_out})
    return sorted(rows, key=lambda row: ([*RECORDINGS].index(row["recording"]), SYSTEMS.index(row["system"])))
