"""ORB-SLAM3 on rectified pairs, in a process of its own: what scripts/recordings.py compares QuadEdge with.

    evidence_peers.py PAIRS OUT FEATURES

PAIRS is a folder with image_0, image_1, calib.txt and times.txt as KITTI has them. OUT receives one row per pose, in
TUM's format, in the coordinates of the rectified left camera; the last line printed is a JSON object with the version
and the seconds per frame. Nothing of ORB-SLAM3 is part of this repository: pyorbslam3 is on PyPI.
"""

import json
import sys
import time
from importlib import metadata
from pathlib import Path

import cv2
import numpy

SLOWER = 10  # than the camera

# What is the same for all recordings, name and value; the program ends without what it does not need.
ORB_SETTINGS = """Camera.type: "PinHole"|Camera.k1: 0.0|Camera.k2: 0.0|Camera.p1: 0.0|Camera.p2: 0.0|Camera.RGB: 1
ThDepth: 35.0|ORBextractor.scaleFactor: 1.2|ORBextractor.nLevels: 8|ORBextractor.iniThFAST: 20|ORBextractor.minThFAST: 7
loopClosing: 0|Viewer.KeyFrameSize: 0.6|Viewer.KeyFrameLineWidth: 2.0|Viewer.GraphLineWidth: 1.0|Viewer.PointSize: 2.0
Viewer.CameraSize: 0.7|Viewer.CameraLineWidth: 3.0|Viewer.ViewpointX: 0.0|Viewer.ViewpointY: -100.0
Viewer.ViewpointZ: -0.1|Viewer.ViewpointF: 2000.0
"""


class Pairs:
    """Rectified pairs: focal length, principal point [px], baseline [m], stamps [s] and images."""

    def __init__(self, folder):
        rows = dict(line.split(":", 1) for line in (folder / "calib.txt").read_text().splitlines() if ":" in line)
        left, right = ([float(value) for value in rows[name].split()] for name in ("P0", "P1"))
        self.f, self.cx, self.cy, self.baseline = left[0], left[2], left[6], -right[3] / right[0]
        self.times = [float(line) for line in (folder / "times.txt").read_text().split()]
        self.files = [sorted((folder / f"image_{k}").glob("*.png")) for k in (0, 1)]

    def __iter__(self):
        for left, right in zip(*self.files):
            yield tuple(cv2.imread(str(file), cv2.IMREAD_GRAYSCALE) for file in (left, right))

    def size(self):
        height, width = cv2.imread(str(self.files[0][0]), cv2.IMREAD_GRAYSCALE).shape
        return width, height


def train_vocabulary(pairs, file, branching=10, levels=3):
    """Writes a vocabulary of ORB descriptors in DBoW2's text form: a tree of the binary means of the images' own."""
    detector = cv2.ORB_create(500)
    words = numpy.concatenate([detector.detectAndCompute(left, None)[1]
                               for index, (left, _) in enumerate(pairs) if index % 10 == 0])
    signs = 1 - 2 * numpy.unpackbits(words, axis=1).astype(numpy.float32)  # product: 256 less twice the distance
    lines, nodes, random = [], [(0, numpy.arange(len(signs)), 0)], numpy.random.default_rng(0)
    while nodes:
        parent, members, depth = nodes.pop(0)
        centres = signs[random.choice(members, min(branching, len(members)), replace=False)]
        for _ in range(5):
            nearest = numpy.argmax(signs[members] @ centres.T, axis=1)
            centres = numpy.array([numpy.where(signs[members[nearest == k]].mean(0) < 0, -1, 1) if (nearest == k).any()
                                   else centres[k] for k in range(len(centres))], dtype=numpy.float32)
        nearest = numpy.argmax(signs[members] @ centres.T, axis=1)
        for k, centre in enumerate(centres):
            inside = members[nearest == k]
            leaf = depth + 1 == levels or len(inside) <= branching
            weight = numpy.log(len(signs) / max(1, len(inside))) if leaf else 0
            values = " ".join(map(str, numpy.packbits(centre < 0)))
            lines.append(f"{parent} {int(leaf)} {values} {weight}")
            if not leaf:
                nodes.append((len(lines), inside, depth + 1))
    file.write_text(f"{branching} {levels} 0 0\n" + "\n".join(lines) + "\n", encoding="ascii")


def orb_slam3(pairs, folder, features):
    """ORB-SLAM3 without loop closing, its camera poses after its local mapping has ended. It gets frames at a tenth of
    the camera's rate, so that its mapping keeps up on two cores."""
    import pyorbslam3

    width, height = pairs.size()
    fps = (len(pairs.times) - 1) / (pairs.times[-1] - pairs.times[0])
    settings, vocabulary = folder / "orb_slam3.yaml", folder.parent / "orb_vocabulary.txt"  # trained once
    camera = {"fx": pairs.f, "fy": pairs.f, "cx": pairs.cx, "cy": pairs.cy, "bf": pairs.f * pairs.baseline,
              "width": width, "height": height, "fps": fps}
    settings.write_text("%YAML:1.0\n" + "".join(f"Camera.{name}: {value}\n" for name, value in camera.items())
                        + f"ORBextractor.nFeatures: {features}\n" + ORB_SETTINGS.replace("|", "\n"))
    if not vocabulary.exists():
        train_vocabulary(pairs, vocabulary)
    slam = pyorbslam3.Slam(vocabulary, settings, pyorbslam3.Sensor.STEREO)
    seconds = []
    for (left, right), stamp in zip(pairs, pairs.times):
        start = time.monotonic()
        slam.track_stereo(left, right, stamp)
        seconds.append(time.monotonic() - start)
        time.sleep(max(0.0, SLOWER / fps - seconds[-1]))
    slam.shutdown()
    file = folder / "orb_slam3.txt"
    slam.save_trajectory_tum(str(file))
    rows = [line.split() for line in file.read_text(encoding="ascii").splitlines()]
    return [(float(row[0]), row[1:]) for row in rows], seconds


def main():
    folder, out, features = Path(sys.argv[1]), Path(sys.argv[2]), int(sys.argv[3])
    out.parent.mkdir(parents=True, exist_ok=True)
    poses, seconds = orb_slam3(Pairs(folder), out.parent, features)
    out.write_text("".join(f"{stamp:.9f} {' '.join(values)}\n" for stamp, values in poses), encoding="ascii")
    print(json.dumps({"version": f"pyorbslam3 {metadata.version('pyorbslam3')}", "seconds": seconds}))


if __name__ == "__main__":
    main()
