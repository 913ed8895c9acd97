#!/usr/bin/env python3
"""Compares QuadEdge's trajectory errors with those of evo (https://github.com/MichaelGrupp/evo, `pip install evo`).

    compare_with_evo.py ESTIMATE TRUTH ERRORS.json [--from-frame N] [--segment N] [--sequence NAME] [--tolerance 1e-6]

ESTIMATE and TRUTH are both TUM files, or both KITTI files with one pose per frame. ERRORS.json is the output of
`quadedge evaluate trajectory ... --json`, a report.json with the same figures under "accuracy", or with --sequence the
summary.json of a batch. --segment compares one segment of a TUM file, which a comment `# segment N` precedes.
Compares mean, std, rmse and max of all four errors, origin-aligned and SE(3)-aligned, and t_rel and r_rel with the
formula of KITTI's odometry devkit.
Exit code: 0 if they agree, 1 for a difference above the tolerance, 2 if the input cannot be compared.
"""

import argparse
import copy
import json
import math
import sys

import numpy
from evo.core import geometry, metrics, sync
from evo.main_ape import ape
from evo.main_rpe import rpe
from evo.tools import file_interface

ERRORS = {
    "ape_rotation_deg": (ape, metrics.PoseRelation.rotation_angle_deg),
    "ape_translation_m": (ape, metrics.PoseRelation.translation_part),
    "rpe_rotation_deg": (rpe, metrics.PoseRelation.rotation_angle_deg),
    "rpe_translation_m": (rpe, metrics.PoseRelation.translation_part),
}
ALIGNMENTS = {"origin_aligned": {"align_origin": True}, "se3_aligned": {"align": True}}


def columns(path):
    with open(path, encoding="utf-8") as file:
        for line in file:
            if line.strip() and not line.startswith("#"):
                return len(line.split())
    return 0


def poses_of_segment(path, wanted):
    """Indices of the poses of one segment of a TUM file."""
    segment, segments = 0, []
    with open(path, encoding="utf-8") as file:
        for line in file:
            if line.startswith("# segment "):
                segment = int(line.split()[2].rstrip(":"))
            elif line.strip() and not line.startswith("#"):
                segments.append(segment)
    return [i for i, number in enumerate(segments) if number == wanted]


def read_pair(estimate_path, truth_path, from_frame, segment):
    kinds = {columns(estimate_path), columns(truth_path)}
    if kinds == {8}:
        estimate = file_interface.read_tum_trajectory_file(estimate_path)
        truth = file_interface.read_tum_trajectory_file(truth_path)
        kept = range(from_frame, estimate.num_poses) if segment is None else poses_of_segment(estimate_path, segment)
        estimate.reduce_to_ids(list(kept))
        return sync.associate_trajectories(truth, estimate, max_diff=0.01)
    if kinds == {12}:
        estimate = file_interface.read_kitti_poses_file(estimate_path)
        truth = file_interface.read_kitti_poses_file(truth_path)
        kept = list(range(from_frame, min(estimate.num_poses, truth.num_poses)))
        estimate.reduce_to_ids(kept)
        truth.reduce_to_ids(kept)
        return truth, estimate
    raise ValueError(f"{estimate_path} and {truth_path} must both be TUM (8 columns) or both KITTI (12 columns), "
                     f"found {kinds}")


def evo_statistics(compute, relation, truth, estimate, alignment):
    extra = {"delta": 1, "delta_unit": metrics.Unit.frames} if compute is rpe else {}
    try:
        result = compute(copy.deepcopy(truth), copy.deepcopy(estimate), pose_relation=relation, **alignment, **extra)
    except geometry.GeometryException:
        return None  # all positions on one line: evo refuses the SE(3) alignment
    return result.stats


def devkit(truth, estimate, length):
    """Sub-paths, t_rel [%] and r_rel [deg/m] of KITTI's devkit: from every tenth pose to the first one that is farther
    along the true path, with the rotation's angle from its trace."""
    true, found = (numpy.array(poses.poses_se3) for poses in (truth, estimate))
    distance = numpy.append(0, numpy.cumsum(numpy.linalg.norm(numpy.diff(true[:, :3, 3], axis=0), axis=1)))
    errors = []
    for first in range(0, len(true), 10):
        beyond = numpy.nonzero(distance[first:] > distance[first] + length)[0]
        if not len(beyond):
            continue
        last = first + beyond[0]
        steps = [numpy.linalg.inv(poses[first]) @ poses[last] for poses in (true, found)]
        off = numpy.linalg.inv(steps[1]) @ steps[0]
        angle = math.acos(max(min(0.5 * (numpy.trace(off[:3, :3]) - 1), 1), -1))
        errors.append((100 * numpy.linalg.norm(off[:3, 3]) / length, math.degrees(angle) / length))
    return len(errors), *(numpy.mean(errors, axis=0) if errors else (0, 0))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("estimate")
    parser.add_argument("truth")
    parser.add_argument("errors")
    parser.add_argument("--from-frame", type=int, default=0)
    parser.add_argument("--segment", type=int)
    parser.add_argument("--sequence")
    parser.add_argument("--tolerance", type=float, default=1e-6)
    arguments = parser.parse_args()
    try:
        truth, estimate = read_pair(arguments.estimate, arguments.truth, arguments.from_frame, arguments.segment)
        with open(arguments.errors, encoding="utf-8") as file:
            ours = json.load(file)
        if arguments.sequence is not None:
            ours = next(entry for entry in ours["sequences"] if entry["name"] == arguments.sequence)
        ours = ours.get("accuracy", ours)
        if arguments.segment is not None:
            ours = next(entry for entry in ours["segments"] if entry["segment"] == arguments.segment)
        open_rotation = "se3_open_rotation" in ours
        sub_paths = ours["sub_paths"]["by_length"] if arguments.sequence is None else []  # a summary has none
        ours = {(a, e): ours[a][e] for a in ALIGNMENTS for e in ERRORS}
    except (OSError, KeyError, ValueError, StopIteration, file_interface.FileInterfaceException,
            sync.SyncException) as problem:
        print(f"cannot compare: {type(problem).__name__}: {problem}", file=sys.stderr)
        return 2
    worst = 0.0
    for alignment, choice in ALIGNMENTS.items():
        for error, (compute, relation) in ERRORS.items():
            if open_rotation and (alignment, error) == ("se3_aligned", "ape_rotation_deg"):
                continue  # evo takes a rotation that happens to fit the errors
            theirs = evo_statistics(compute, relation, truth, estimate, choice)
            for name in ("mean", "std", "rmse", "max"):
                mine = ours[alignment, error][name]
                if theirs is None or mine is None:
                    difference = 0.0 if theirs is None and mine is None else math.inf
                else:
                    difference = abs(mine - theirs[name])
                worst = max(worst, difference)
                if not difference <= arguments.tolerance:
                    evo_value = None if theirs is None else theirs[name]
                    print(f"{alignment} {error} {name}: QuadEdge {mine}, evo {evo_value}, difference {difference:.3g}")
    for mine in sub_paths:
        count, *theirs = devkit(truth, estimate, mine["length_m"])
        named = zip(("t_rel_percent", "r_rel_deg_per_m"), theirs)
        # Near zero, the angle from a trace has half of a double's digits.
        differences = [abs(mine[name] - value) * (0.1 if name[0] == "r" else 1) for name, value in named]
        worst = max(worst, *differences)
        if count != mine["sub_paths"] or max(differences) > arguments.tolerance:
            print(f"sub-paths of {mine['length_m']} m: QuadEdge {mine}, devkit's formula {count} {theirs}")
            worst = math.inf
    print(f"{estimate.num_poses} poses, largest difference {worst:.3g}, tolerance {arguments.tolerance:g}")
    return 0 if worst <= arguments.tolerance else 1


if __name__ == "__main__":
    sys.exit(main())
