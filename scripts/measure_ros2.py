"""Latency, dropped pairs and memory of python -m quadedge.ros2 on the loopback (scripts/measure.py --only ros2).

This program publishes pairs at a constant rate, each image with the time at which it is sent; the time of a pose is the
source time stamp that DDS gives it.
"""

import csv
import os
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy

import quadedge
from quadedge.ros2.domain import Domain
from quadedge.ros_messages import header, message_store, stamp_ns

SENT, RATES, PRESETS, MEMORY_PAIRS = 120, (20, 30, 60), ("fast", "default"), 5000
NOTE = "shared with the sender of the images, nothing else running"  # on the machine


def flight(data: Path, _):
    folder = data / "euroc_mh_01_easy"
    frames = list(quadedge.open_dataset(folder, last_frame=SENT))
    return frames, ",".join(str(folder / "mav0" / camera / "sensor.yaml") for camera in ("cam0", "cam1"))


def room(_, work: Path):
    """Rendered: 20 frames forward and back."""
    rendered, file = quadedge.synthetic(frames=20, width=1280, height=720), work / "room.yaml"
    frames, lens = list(rendered), rendered.rig.left
    lenses = "".join(f"{side}_model: radtan\n{side}_size: [1280, 720]\n{side}_coefficients: [0, 0, 0, 0]\n"
                     f"{side}_intrinsics: [{lens.fx!r}, {lens.fy!r}, {lens.cx!r}, {lens.cy!r}]\n"
                     for side in ("left", "right"))
    file.write_text(f"{lenses}rotation: [0, 0, 0]\ntranslation: [{-rendered.rig.baseline!r}, 0, 0]\n")
    turn = [*frames, *frames[-2:0:-1]]
    return [turn[i % len(turn)] for i in range(SENT)], str(file)


def image_message(pixels: numpy.ndarray):
    height, width = pixels.shape
    return message_store().types["sensor_msgs/msg/Image"](header(time.time_ns(), "camera"), height, width, "mono8", 0,
                                                          width, numpy.ascontiguousarray(pixels).reshape(-1))


class Measurement:
    """One run of the program with a publisher beside it. Leaves the program running until close()."""

    def __init__(self, number: int, calibration: str, work: Path, *options: str):
        self.domain = Domain(number, loopback=True)
        self.images = [self.domain.advertise(f"/{side}/image_raw", "sensor_msgs/msg/Image")
                       for side in ("left", "right")]
        self.odometry = self.domain.subscribe("/quadedge/odometry", "nav_msgs/msg/Odometry", reliable=True, depth=1000)
        environment = {**os.environ, "ROS_DOMAIN_ID": str(number), "ROS_LOCALHOST_ONLY": "1"}
        self.log = work / f"{number}.txt"
        with self.log.open("wb") as log:
            self.process = subprocess.Popen([sys.executable, "-m", "quadedge.ros2", "--calibration", calibration,
                                             *options], env=environment, stderr=log)
        while "left /left/image_raw" not in self.log.read_text():
            assert self.process.poll() is None, self.log.read_text()
            time.sleep(0.1)
        self.poses: dict[int, int] = {}

    def send(self, frame) -> tuple[int, int]:
        """Sends a pair and returns both stamps [ns]."""
        messages = []
        for publisher, pixels in zip(self.images, (frame.left, frame.right)):
            messages.append(image_message(pixels))
            publisher.publish(messages[-1])
        return tuple(map(stamp_ns, messages))

    def listen(self) -> int:
        """Keeps the times at which poses were published, by the stamp of the left image. Returns their number."""
        self.poses |= {stamp_ns(sample.message): sample.sample_info.source_timestamp
                       for sample in self.odometry.samples()}
        return len(self.poses)

    def warm_up(self, frames) -> None:
        """Sends frames until ten are tracked: kernels are built, memory is touched."""
        for frame in frames * 10:
            self.send(frame)
            time.sleep(0.3)
            if self.listen() >= 10:
                return
        raise RuntimeError(self.log.read_text())

    def resident_mb(self) -> float:
        words = Path(f"/proc/{self.process.pid}/statm").read_text().split()
        return int(words[1]) * os.sysconf("SC_PAGE_SIZE") / 2**20

    def close(self) -> float:
        """Interrupts the program and returns the seconds that it took to end."""
        start = time.monotonic()
        self.process.send_signal(signal.SIGINT)
        self.process.wait(30)
        return time.monotonic() - start


def percentiles(values_ms: list[float]) -> list[float]:
    return [round(float(value), 2) for value in numpy.percentile(values_ms, [50, 99])]


def measured(number: int, frames, calibration: str, preset: str, rate: int, work: Path) -> dict:
    out = work / f"out_{number}"
    run = Measurement(number, calibration, work, "--preset", preset, "-o", str(out))
    try:
        run.warm_up(frames[:10])
        stamps, start = {}, time.monotonic()
        for turn, frame in enumerate(frames):
            time.sleep(max(0.0, start + turn / rate - time.monotonic()))
            left, right = run.send(frame)
            stamps[left] = right
        time.sleep(1)
        run.listen()
    finally:
        end_s = run.close()
    with (out / "frames.csv").open() as file:
        track_ms = {int(row["stamp_s"].replace(".", "")): float(row["latency_ms"]) for row in csv.DictReader(file)}
    came = {left: (run.poses[left] - right) / 1e6 for left, right in stamps.items() if left in run.poses}
    beyond = [latency - track_ms[left] for left, latency in came.items()]
    return {"preset": preset, "width": frames[0].left.shape[1], "height": frames[0].left.shape[0], "rate_hz": rate,
            "sent": len(frames), "dropped": len(frames) - len(came), "latency_ms": percentiles(list(came.values())),
            "beyond_track_ms": percentiles(beyond), "end_s": round(end_s, 2),
            "mean_track_ms": round(float(numpy.mean([track_ms[left] for left in came])), 1)}


def memory(number: int, frames, calibration: str, count: int, work: Path) -> list:
    """Resident memory [MB] at ten times during ``count`` pairs, each sent when the one before is tracked."""
    run = Measurement(number, calibration, work, "--preset", "fast")
    found = []
    try:
        run.warm_up(frames[:10])
        for sent in range(count):
            before, end = run.listen(), time.monotonic() + 1
            run.send(frames[sent % len(frames)])
            while run.listen() == before and time.monotonic() < end:
                time.sleep(0.001)
            if (sent + 1) % (count // 10) == 0:
                found.append([sent + 1, round(run.resident_mb(), 1)])
                run.poses.clear()
    finally:
        run.close()
    return found


def measure_topics(programs) -> dict:
    """The content of ros2.json."""
    rows, numbers = [], iter(range(20, 230))
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        for source in (flight, room):
            frames, calibration = source(programs.options.data, work)
            for preset in PRESETS:
                for rate in RATES:
                    rows.append(measured(next(numbers), frames, calibration, preset, rate, work))
                    print(rows[-1], f"load {os.getloadavg()[0]:.1f}", flush=True)
            if source is flight:
                kept = memory(next(numbers), frames, calibration, MEMORY_PAIRS, work)
                print(kept, flush=True)
    return {"cores": os.cpu_count(), "note": NOTE, "rows": rows, "memory_mb": kept}
