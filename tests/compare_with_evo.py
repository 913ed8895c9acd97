#!/usr/bin/env python3
"""Compares QuadEdge's trajectory errors with those of evo (https://github.com/MichaelGrupp/evo, `pip install evo`).

    compare_with_evo.py ESTIMATE TRUTH ERRORS.json [--from-frame N] [--segment N] [--sequence NAME] [--tolerance 1e-6]

ESTIMATE and TRUTH are both TUM files, or both KITTI files with one pose per frame. ERRORS.json is the output of
`quadedge evaluate trajectory ... --json`, a report.json with the same figures under "accuracy", or with --sequence the
summary.json of a batch. --segment compares one segment of a TUM file, which a comment `# segment N` precedes.
Compares mean, std, rmse and max of all four errors, origin-aligned and SE(3)-aligned.
Exit code: 0 if they agree, 1 for a difference above the tolerance, 2 if the input cannot be compared.
"""

import argparse
import copy
import json
import math
import sys

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
    print(f"{estimate.num_poses} poses, largest difference {worst:.3g}, tolerance {arguments.tolerance:g}")
    return 0 if worst <= arguments.tolerance else 1


if __name__ == "__main__":
    sys.exit(main())
