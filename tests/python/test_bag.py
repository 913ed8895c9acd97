"""Recordings of ROS 1, ROS 2 and MCAP: topics, pairs, images, calibrations, output."""

import json
import os
import subprocess
import sys
from types import SimpleNamespace

import numpy
import pytest

import quadedge

rosbags = pytest.importorskip("rosbags", reason="rosbags is not installed: quadedge.bag cannot be tested")

import quadedge.bag  # noqa: E402
from bags import KINDS, BagWriter  # noqa: E402
from quadedge.estimates import Estimates  # noqa: E402
from quadedge.run_frames import read_frames  # noqa: E402


def poses(source, frames):
    with quadedge.Odometry(source) as odometry:
        return [odometry.track(frame.stamp_ns, frame.left, frame.right) for frame in frames]


def in_bytes(results):
    return [result.world_from_left.tobytes() for result in results]


def write_infos(bag, rig, left="/stereo/left", right="/stereo/right"):
    bag.camera_info(f"{left}/camera_info", 1, rig.left, 0.0)
    bag.camera_info(f"{right}/camera_info", 1, rig.right, -rig.right.fx * rig.baseline)


@pytest.mark.parametrize("kind", KINDS)
def test_the_flight_from_each_kind_of_recording(flight_folder, tmp_path, kind):
    dataset = quadedge.open_dataset(flight_folder, last_frame=12)
    with BagWriter(tmp_path / "flight", kind) as bag:
        for frame in dataset:
            bag.image("/cam0/image_raw", frame.stamp_ns, frame.left)
            bag.image("/cam1/image_raw", frame.stamp_ns, frame.right)
    files = [flight_folder / "mav0" / camera / "sensor.yaml" for camera in ("cam0", "cam1")]
    recording = quadedge.bag.open_bag(bag.path, calibration=files)
    assert len(recording) == 12 and recording.pairing.dropped == 0
    assert (recording.topics.left, recording.topics.right) == ("/cam0/image_raw", "/cam1/image_raw")
    results = poses(recording.rig, recording)
    assert in_bytes(results) == in_bytes(poses(quadedge.Rig.from_file(files), dataset))
    assert sum(result.is_tracked for result in results) == 12


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("compressed", [False, True])
def test_topics_and_calibration_are_recognised(room, room_folder, frames, tmp_path, kind, compressed):
    dataset = quadedge.open_dataset(room_folder)
    ending = "/image_raw/compressed" if compressed else "/image_raw"
    with BagWriter(tmp_path / "room", kind) as bag:
        write_infos(bag, room.rig)
        for frame, files in zip(frames, dataset.frames):
            for side, pixels, file in (("left", frame.left, files.left), ("right", frame.right, files.right)):
                topic = f"/stereo/{side}{ending}"
                if compressed:
                    bag.compressed(topic, frame.stamp_ns + 1, file)
                else:
                    bag.image(topic, frame.stamp_ns + 1, pixels)
            bag.image("/stereo/depth/image_raw", frame.stamp_ns + 1, frame.left)
    recording = quadedge.bag.open_bag(bag.path)
    assert recording.topics.left == f"/stereo/left{ending}"
    assert recording.rig.baseline == pytest.approx(room.rig.baseline, abs=1e-9)
    for read, frame in zip(recording, frames, strict=True):
        assert read.stamp_ns == frame.stamp_ns + 1
        numpy.testing.assert_array_equal(read.left, frame.left)
        numpy.testing.assert_array_equal(read.right, frame.right)


def test_images_are_rectified_to_the_projection_matrix(room, frames, tmp_path):
    with BagWriter(tmp_path / "room", "mcap") as bag:
        write_infos(bag, room.rig)
        for frame in frames[:2]:
            bag.image("/stereo/left/image_rect", frame.stamp_ns + 1, frame.left)
            bag.image("/stereo/right/image_rect", frame.stamp_ns + 1, frame.right)
    recording = quadedge.bag.open_bag(next(bag.path.glob("*.mcap")))  # the file alone works too
    assert recording.rectified and recording.rig.left.fx == room.rig.left.fx


def test_shuffled_missing_and_skewed_stamps(room, frames, tmp_path):
    """Of six frames one has no right image, one no timestamp, one is 80 ms off; two are recorded late."""
    stamps = [frame.stamp_ns + 1_000_000_000 for frame in frames]
    with BagWriter(tmp_path / "room", "ros1") as bag:
        write_infos(bag, room.rig)
        for i in (1, 0, 2, 4, 3, 5):
            bag.image("/stereo/left/image_raw", stamps[i] if i != 2 else 0, frames[i].left)
        for i in (0, 1, 2, 3, 5):
            skew = {0: 3_000_000, 5: 80_000_000}.get(i, -2_000_000)
            bag.image("/stereo/right/image_raw", stamps[i] + skew, frames[i].right)
    falling = f"stamp {stamps[0]} ns after {stamps[1]} ns in message 1 of /stereo/left"
    with pytest.raises(quadedge.DataError, match=falling):
        quadedge.bag.open_bag(bag.path)
    recording = quadedge.bag.open_bag(bag.path, sort_stamps=True)
    read = list(recording)
    assert [frame.stamp_ns for frame in read] == [stamps[0], stamps[1], stamps[3]]
    for frame, i in zip(read, (0, 1, 3)):
        numpy.testing.assert_array_equal(frame.left, frames[i].left)
        numpy.testing.assert_array_equal(frame.right, frames[i].right)
    pairing = recording.pairing
    assert (pairing.left_dropped, pairing.right_dropped, pairing.without_stamp) == (2, 2, 1)
    assert pairing.dropped == 5 and pairing.largest_difference_ns == 3_000_000
    assert "2 left images without a right one" in str(pairing)


def test_a_stamp_that_goes_back_starts_a_segment(room, frames, tmp_path):
    """The clock is set back by 0.12 s after the third frame, one right image earlier than the left one is recorded."""
    stamps = [1_000_000_000 + 50_000_000 * i - (120_000_000 if i > 2 else 0) for i in range(6)]
    with BagWriter(tmp_path / "room", "ros1") as bag:
        write_infos(bag, room.rig)
        for i in range(6):
            bag.image("/stereo/left/image_raw", stamps[i], frames[i].left)
            bag.image("/stereo/right/image_raw", stamps[i] + 1000, frames[i].right)
    recording = quadedge.bag.open_bag(bag.path, restarts=True)
    assert recording.stamps_ns == stamps and recording.pairing.restarts == [3]
    assert "6 pairs in 2 segments" in str(recording.pairing)
    segments = []
    with quadedge.Odometry(recording.rig) as odometry:
        for frame, original in zip(recording, frames):
            numpy.testing.assert_array_equal(frame.left, original.left)
            if frame.starts_segment:
                odometry.restart()
            segments.append(odometry.track(frame.stamp_ns, frame.left, frame.right).segment)
    assert segments == [0, 0, 0, 1, 1, 1]
    done = subprocess.run([sys.executable, "-m", "quadedge.bag", bag.path, "--restarts", "-o", tmp_path / "out"],
                          capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    rows = (tmp_path / "out" / "trajectory.txt").read_text().splitlines()
    assert rows[4].startswith("# segment 1")
    assert [row.split()[0] for row in rows if row[0] != "#"] == [f"{ns / 1e9:.9f}" for ns in stamps]


def test_parts_of_both_cameras_are_paired_in_turn():
    pair = quadedge.bag.pairing.pair_parts
    # The right camera has no image of the second part but two of the first that the left one lacks.
    parts = pair([10, 20, 5, 15, 7], [10, 20, 30, 40, 15, 6], 2)
    assert parts.pairs == [(0, 0), (1, 1), (3, 4), (4, 5)] and parts.restarts == [2, 3]
    assert parts.left_dropped == 1 and parts.right_dropped == 2
    assert pair([10, 0, 20], [10, 20, 0], 0).pairs == [(0, 0), (2, 1)]


def test_rectified_images_on_image_raw_are_seen(room, frames, tmp_path):
    """camera_info states lenses that distort; the images are those of P."""
    with BagWriter(tmp_path / "room", "mcap") as bag:
        for side, camera, tx in (("left", room.rig.left, 0.0),
                                 ("right", room.rig.right, -room.rig.right.fx * room.rig.baseline)):
            k, p = camera.matrix.copy(), numpy.hstack([camera.matrix, [[tx], [0], [0]]])
            k[1, 2] += 9.0 if side == "right" else 0.0
            region = bag.store.types["sensor_msgs/msg/RegionOfInterest"](0, 0, 0, 0, False)
            bag.write(f"/{side}/camera_info", "sensor_msgs/msg/CameraInfo", header=bag.header(1), height=camera.height,
                      width=camera.width, distortion_model="plumb_bob", binning_x=0, binning_y=0, roi=region,
                      d=numpy.array([-0.3, 0.1, 0.0, 0.0, 0.0]), k=k.reshape(-1), r=numpy.eye(3).reshape(-1),
                      p=p.reshape(-1))
            for frame in frames[:3]:
                bag.image(f"/{side}/image_raw", frame.stamp_ns + 1, getattr(frame, side))
    command = [sys.executable, "-m", "quadedge.bag", bag.path, "-o"]
    done = subprocess.run([*command, tmp_path / "raw"], capture_output=True, text=True)
    assert "--rectified takes P" in done.stderr
    done = subprocess.run([*command, tmp_path / "rectified", "--rectified"], capture_output=True, text=True)
    assert done.returncode == 0 and "--rectified" not in done.stderr, done.stderr


def test_pairs_are_mutually_nearest():
    pair = quadedge.bag.pair_stamps
    assert pair([10, 20, 30], [11, 29, 21], 5).pairs == [(0, 0), (1, 2), (2, 1)]
    assert pair([10, 14], [13], 5).pairs == [(1, 0)]  # the nearer one takes it
    assert pair([10], [16], 5).pairs == [] and pair([], [1], 5).right_dropped == 1
    assert pair([10, 10], [10], 0).repeated == 1
    # Compared with all assignments of small lists: no other pairs are mutually nearest.
    generator = numpy.random.default_rng(3)
    for _ in range(200):
        left, right = (list(map(int, generator.permutation(60)[:8] + 1)) for _ in range(2))
        nearest_right = [min(right, key=lambda b: (abs(b - a), b)) for a in left]
        nearest_left = [min(left, key=lambda a: (abs(a - b), a)) for b in right]
        expected = {(i, j) for i, a in enumerate(left) for j, b in enumerate(right)
                    if nearest_right[i] == b and nearest_left[j] == a and abs(a - b) <= 4}
        assert set(pair(left, right, 4).pairs) == expected


def message(pixels, encoding, big=0, step=None):
    data = numpy.ascontiguousarray(pixels)
    row = data.strides[0] if step is None else step
    return SimpleNamespace(encoding=encoding, is_bigendian=big, height=data.shape[0], width=data.shape[1], step=row,
                           data=data.view(numpy.uint8).reshape(-1))


def test_a_cut_recording_has_a_reason(room_bag, tmp_path):
    file = next(room_bag.glob("*.mcap")) if room_bag.is_dir() else room_bag
    for size in (20, 1000, file.stat().st_size // 2):
        (tmp_path / "cut.mcap").write_bytes(file.read_bytes()[:size])
        with pytest.raises(quadedge.DataError, match=r"cut.mcap: found no readable recording \(.+\), expected"):
            quadedge.bag.open_bag(tmp_path / "cut.mcap")


def test_encodings():
    grey = quadedge.bag.grey_image
    deep = (numpy.arange(12).reshape(3, 4) * 300).astype(">u2")
    numpy.testing.assert_array_equal(grey(message(deep, "mono16", big=1)), deep)
    assert grey(message(deep.astype("<u2"), "mono16")).dtype == numpy.uint16
    colour = numpy.array([[[255, 0, 0], [0, 255, 0], [0, 0, 255], [255, 255, 255]]], numpy.uint8)
    numpy.testing.assert_array_equal(grey(message(colour, "rgb8")), [[76, 150, 29, 255]])  # 0.299, 0.587, 0.114
    numpy.testing.assert_array_equal(grey(message(colour, "bgr8")), [[29, 150, 76, 255]])
    padded = message(numpy.arange(20, dtype=numpy.uint8).reshape(2, 10), "mono8")
    padded.width = 7
    numpy.testing.assert_array_equal(grey(padded), [range(7), range(10, 17)])
    with pytest.raises(quadedge.DataError, match="left: found the encoding 'jxl8', expected one of mono8"):
        grey(message(colour, "jxl8"), "left")
    short = message(colour, "rgb8")
    short.height = 2
    with pytest.raises(quadedge.DataError, match="found 12 bytes in rows of 12, expected 4 x 2 pixels of rgb8"):
        grey(short)


@pytest.mark.parametrize("topics, words", [
    ((), "found no stereo topics among nothing"),
    (("/camera/image_raw",), "found no stereo topics among /camera/image_raw"),
    (("/front/left/image", "/front/right/image", "/back/left/image", "/back/right/image"),
     "found several pairs of cameras"),
])  # fmt: skip
def test_recordings_without_one_stereo_camera(tmp_path, topics, words):
    with BagWriter(tmp_path / "other", "ros2") as bag:
        for topic in topics:
            bag.image(topic, 5, numpy.zeros((8, 8), numpy.uint8))
    with pytest.raises(quadedge.DataError, match=words):
        quadedge.bag.open_bag(bag.path)


def test_invalid_recordings_are_refused(room, frames, tmp_path):
    open_bag = quadedge.bag.open_bag
    (tmp_path / "text.bag").write_text("no bag")
    for path in (tmp_path / "absent.bag", tmp_path / "text.bag", tmp_path):
        with pytest.raises(quadedge.DataError, match="expected a .bag file"):
            open_bag(path)
    with BagWriter(tmp_path / "cut", "ros1") as bag:
        for stamp in range(1, 30):
            bag.image("/a/left/image_raw", stamp, frames[0].left)
            bag.image("/a/right/image_raw", stamp, frames[0].right)
    bag.path.write_bytes(bag.path.read_bytes()[:1_000_000])
    with pytest.raises(quadedge.DataError, match="cut.bag: found no readable recording"):
        open_bag(bag.path)
    with BagWriter(tmp_path / "room", "ros2") as bag:
        bag.image("/a/left/image_raw", 1, frames[0].left)
        bag.image("/a/right/image_raw", 1, frames[0].right)
    with pytest.raises(quadedge.DataError, match="found no camera_info of /a/left/image_raw and /a/right/image_raw"):
        open_bag(bag.path).rig
    with pytest.raises(quadedge.DataError, match="found no topic /b, expected an image topic"):
        open_bag(bag.path, left="/a/left/image_raw", right="/b")
    with pytest.raises(quadedge.DataError, match="expected both, left and right"):
        open_bag(bag.path, left="/a/left/image_raw")


def made_up_result(stamp: int, **values):
    nothing = SimpleNamespace(base_frame=0, covariance_in_reference=None)
    return SimpleNamespace(stamp_ns=stamp, is_tracked=True, segment=0, reference_frame=0, ambiguous_motion=False,
                           new_key_rig=False, diagnostics=nothing, **values)


def messages_of(folder) -> list:
    from rosbags.highlevel import AnyReader

    with AnyReader([folder]) as reader:
        return [reader.deserialize(data, connection.msgtype) for connection, _, data in reader.messages()]


@pytest.mark.parametrize("size", [(100, 320), (200, 318)])
def test_images_of_another_size_are_named(room, frames, size, tmp_path):
    with BagWriter(tmp_path / "room", "mcap") as bag:
        write_infos(bag, room.rig)
        for stamp, frame in enumerate(frames[:3], 1):
            right = frame.right if stamp < 3 else frame.right[:size[0], :size[1]]
            bag.image("/stereo/left/image_raw", stamp, frame.left)
            bag.image("/stereo/right/image_raw", stamp, right)
    words = (f"/stereo/right/image_raw at 3 ns: found {size[1]} x {size[0]} pixels of uint8, expected 320 x 200 pixels "
             "of uint8, as in the first frame")
    with pytest.raises(quadedge.DataError, match=words):
        list(quadedge.bag.open_bag(bag.path))


def test_stamps_of_zero_are_told(room, frames, tmp_path):
    with BagWriter(tmp_path / "room", "mcap") as bag:
        write_infos(bag, room.rig)
        for frame in frames:
            bag.image("/stereo/left/image_raw", 0, frame.left)
            bag.image("/stereo/right/image_raw", 0, frame.right)
    assert quadedge.bag.open_bag(bag.path).has_recorded_stamps
    call = [sys.executable, "-m", "quadedge.bag", bag.path]
    done = subprocess.run(call, capture_output=True, text=True)
    assert done.returncode == 0 and "warning: the stamps of all images are 0: the times of recording" in done.stderr
    done = subprocess.run([*call, "--tolerance", "nan"], capture_output=True, text=True)
    assert done.returncode == 2 and "found nan, expected a finite number" in done.stderr


def test_odometry_of_ambiguous_frames_is_unknown_or_withheld(boarded, command, tmp_path):
    room, pairs = boarded
    with quadedge.Odometry(room, preset="fast") as odometry:
        files = quadedge.ResultFiles(tmp_path / "run", odometry, "room")
        results = [odometry.track(100 * number, *pair) for number, pair in enumerate(pairs)]
        for result in results:
            files.add(result)
        files.finish()
    flagged = [number for number, result in enumerate(results) if result.ambiguous_motion]
    assert len(flagged) >= 2
    for name, tracked in (("results", results), ("files", read_frames(tmp_path / "run"))):
        quadedge.bag.write_mcap(tmp_path / name, tracked)
        for number, message_ in enumerate(messages_of(tmp_path / name)):
            unknown = [part.covariance[0] == 1e6 for part in (message_.pose, message_.twist)]
            assert unknown == [True, True] if number in flagged else number > flagged[0] or not unknown[0]
        quadedge.bag.write_mcap(tmp_path / f"{name} withheld", tracked, withhold_ambiguous=True)
        assert len(messages_of(tmp_path / f"{name} withheld")) == len(pairs) - len(flagged)
    for one, other in zip(messages_of(tmp_path / "results"), messages_of(tmp_path / "files"), strict=True):
        for part in ("pose", "twist"):
            numpy.testing.assert_allclose(getattr(one, part).covariance, getattr(other, part).covariance, rtol=1e-9)
        assert one.twist.twist.linear.x == pytest.approx(other.twist.twist.linear.x, rel=1e-6, abs=1e-9)


def test_odometry_is_written_with_covariance(room, tmp_path):
    results = poses(room, room)
    file = quadedge.bag.write_mcap(tmp_path / "odometry", results, optical_axes=True)
    assert file.suffix == ".mcap"
    read, estimates = messages_of(tmp_path / "odometry"), Estimates(numpy.eye(4))
    assert len(read) == len(results)
    assert read[0].header.frame_id == "odom" and read[0].child_frame_id == "left_camera"
    for message_, result in zip(read, results):
        assert message_.header.stamp.sec * 10**9 + message_.header.stamp.nanosec == result.stamp_ns
        position, turn = message_.pose.pose.position, message_.pose.pose.orientation
        numpy.testing.assert_array_equal([position.x, position.y, position.z], result.world_from_left[:3, 3])
        numpy.testing.assert_array_equal(message_.pose.covariance.reshape(6, 6), result.covariance)
        twist = estimates.add(result).twist
        linear = message_.twist.twist.linear
        assert [linear.x, linear.y, linear.z] == (list(twist[0][:3]) if twist else [0, 0, 0])
        assert message_.twist.covariance[0] == (twist[1][0, 0] if twist else 1e6)
        x, y, z, w = turn.x, turn.y, turn.z, turn.w
        numpy.testing.assert_allclose([1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)],
                                      result.world_from_left[:3, 0], atol=1e-12)
    with pytest.raises(quadedge.DataError, match="expected a new folder"):
        quadedge.bag.write_mcap(tmp_path / "odometry", results)


def test_odometry_has_the_axes_of_rep_103(tmp_path):
    """The camera has moved 3 m forward, 1 m to the left and 2 m up, and turned left by 90 degrees."""
    from rosbags.highlevel import AnyReader

    pose = numpy.array([[0, 0, -1, -1], [0, 1, 0, -2], [1, 0, 0, 3], [0, 0, 0, 1]], float)  # optical axes
    covariance = numpy.diag([1.0, 2, 3, 4, 5, 6])  # right, down, forward; about them
    covariance[0, 2] = covariance[2, 0] = 0.5  # to the right goes with forward
    result = made_up_result(5, world_from_left=pose, covariance=covariance)
    later = SimpleNamespace(**{**vars(result), "stamp_ns": 6, "segment": 1})
    quadedge.bag.write_mcap(tmp_path / "odometry", [result, later])
    with AnyReader([tmp_path / "odometry"]) as reader:
        message_, of_later = [reader.deserialize(data, connection.msgtype) for connection, _, data in reader.messages()]
    assert message_.header.frame_id == "odom" and message_.child_frame_id == "base_link"
    position, turn = message_.pose.pose.position, message_.pose.pose.orientation
    assert [position.x, position.y, position.z] == [3, 1, 2]
    half = numpy.sqrt(0.5)  # 90 degrees about z, which points up
    numpy.testing.assert_allclose([turn.x, turn.y, turn.z, turn.w], [0, 0, half, half], atol=1e-12)
    expected = numpy.diag([3.0, 1, 2, 6, 4, 5])
    expected[0, 1] = expected[1, 0] = -0.5
    numpy.testing.assert_allclose(message_.pose.covariance.reshape(6, 6), expected, atol=1e-12)
    assert of_later.pose.covariance[0] == 1e6 and of_later.pose.pose.position.x == 3  # unknown in another segment


@pytest.mark.parametrize("stamp", [-5, 2**31 * 10**9, 2**63 - 1])
def test_odometry_with_stamps_that_ros_cannot_hold_is_refused_and_leaves_no_folder(tmp_path, stamp):
    result = made_up_result(stamp, world_from_left=numpy.eye(4), covariance=None)
    with pytest.raises(quadedge.DataError, match=f"found the stamp {stamp} ns, expected 0 to"):
        quadedge.bag.write_mcap(tmp_path / "a" / "b" / "odometry", [result])
    assert list(tmp_path.iterdir()) == []
    latest = SimpleNamespace(**{**vars(result), "stamp_ns": 2**31 * 10**9 - 1})
    assert quadedge.bag.write_mcap(tmp_path / "odometry", [latest]).exists()


@pytest.fixture
def room_bag(room, frames, tmp_path):
    with BagWriter(tmp_path / "room", "mcap") as bag:
        write_infos(bag, room.rig)
        for frame in frames:
            bag.image("/stereo/left/image_raw", frame.stamp_ns + 1, frame.left)
            bag.image("/stereo/right/image_raw", frame.stamp_ns + 1, frame.right)
    return bag.path


@pytest.fixture
def bag_command(program):
    """Runs python -m quadedge.bag with the program on PATH."""
    place = {**os.environ, "PATH": f"{program.parent}{os.pathsep}{os.environ['PATH']}"}

    def run(*arguments, **options) -> subprocess.CompletedProcess:
        call = [sys.executable, "-m", "quadedge.bag", *map(str, arguments)]
        return subprocess.run(call, **{"capture_output": True, "text": True, "env": place, **options})

    return run


def test_from_the_shell(room_bag, bag_command, command, tmp_path):
    out = tmp_path / "out"
    done = bag_command(room_bag, "-o", out, "--preset", "fast", "--", "--points", tmp_path / "map.ply")
    assert done.returncode == 0, done.stderr
    assert "6 pairs" in done.stdout and "tracked    6 of 6" in done.stdout
    recording = quadedge.bag.open_bag(room_bag)
    with quadedge.Odometry(recording.rig, preset="fast") as odometry:
        results = [odometry.track(frame.stamp_ns, frame.left, frame.right) for frame in recording]
    quadedge.bag.write_tum(tmp_path / "ours.txt", results)
    assert (out / "trajectory.txt").read_bytes() == (tmp_path / "ours.txt").read_bytes()
    for name in ("frames.csv", "poses.csv"):
        assert len((out / name).read_text().splitlines()) == 7
    assert (tmp_path / "map.ply").read_bytes().startswith(b"ply")
    assert json.loads((out / "report.json").read_text())["input"]["name"] == str(room_bag)
    page = command("report", out)
    assert page.returncode == 0, page.stderr
    assert list((out / "odometry").glob("*.mcap"))
    again = bag_command(room_bag, "-o", out)
    assert again.returncode != 0 and not again.stdout.count("tracked") and "--force" in again.stderr
    forced = bag_command(room_bag, "-o", out, "--preset", "fast", "--", "--force")
    assert forced.returncode == 0 and len(list((out / "odometry").glob("*.mcap"))) == 1, forced.stderr
    (out / "odometry/metadata.yaml").unlink()  # as if it were somebody else's folder
    assert bag_command(room_bag, "-o", out, "--", "--force").returncode == 2
    absent = bag_command("absent.bag")
    assert absent.returncode == 3 and absent.stderr.startswith("quadedge.bag: absent.bag: found no readable recording")


def test_the_written_odometry_is_that_of_the_api(room_bag, bag_command, tmp_path):
    from rosbags.highlevel import AnyReader

    def messages(folder):
        with AnyReader([folder]) as reader:
            return [reader.deserialize(data, connection.msgtype) for connection, _, data in reader.messages()]

    assert bag_command(room_bag, "-o", tmp_path / "out").returncode == 0
    recording = quadedge.bag.open_bag(room_bag)
    quadedge.bag.write_mcap(tmp_path / "ours", poses(recording.rig, recording))
    ours, theirs = messages(tmp_path / "ours"), messages(tmp_path / "out" / "odometry")
    assert len(ours) == len(theirs) == 6
    for one, other in zip(ours, theirs):
        assert one.header.stamp == other.header.stamp and one.child_frame_id == other.child_frame_id == "base_link"
        for name in ("x", "y", "z"):
            assert getattr(one.pose.pose.position, name) == pytest.approx(getattr(other.pose.pose.position, name),
                                                                          abs=1e-12)
        numpy.testing.assert_allclose(other.pose.covariance, one.pose.covariance, rtol=1e-9, atol=1e-20)


def test_progress_is_shown_on_a_terminal(room_bag, bag_command, tmp_path):
    import pty

    controller, terminal = pty.openpty()
    done = bag_command(room_bag, "-o", tmp_path / "out", capture_output=False, stdout=subprocess.PIPE, stderr=terminal)
    os.close(terminal)
    shown = b""
    try:
        while piece := os.read(controller, 4096):
            shown += piece
    except OSError:  # how Linux reports that the other end is closed
        pass
    os.close(controller)
    assert done.returncode == 0 and b"frame" in shown and b"6" in shown


def test_an_image_in_the_middle_that_cannot_be_read(room, frames, bag_command, tmp_path):
    with BagWriter(tmp_path / "room", "mcap") as bag:
        write_infos(bag, room.rig)
        for number, frame in enumerate(frames):
            encoding = "mono8" if number < 4 else "jxl8"
            bag.image("/stereo/left/image_raw", frame.stamp_ns + 1, frame.left, encoding)
            bag.image("/stereo/right/image_raw", frame.stamp_ns + 1, frame.right, encoding)
    done = bag_command(bag.path, "-o", tmp_path / "out", timeout=120)
    assert done.returncode == 3 and "found the encoding 'jxl8'" in done.stderr
    assert not (tmp_path / "out" / "odometry").exists()


def test_mosaics_and_luminance(room):
    grey = quadedge.bag.grey_image
    flat = numpy.full((6, 8, 3), (200, 100, 50), numpy.uint8)  # red, green, blue
    expected = grey(message(flat, "rgb8"))
    for pattern in ("rggb", "bggr", "gbrg", "grbg"):
        mosaic = numpy.empty((6, 8), numpy.uint8)
        for place, letter in enumerate(pattern):
            mosaic[place // 2::2, place % 2::2] = {"r": 200, "g": 100, "b": 50}[letter]
        numpy.testing.assert_array_equal(grey(message(mosaic, f"bayer_{pattern}8")), expected)
    # Halfway between two green pixels of 10 and 30 in every direction lies 20.
    ramp = numpy.add.outer(numpy.arange(6) * 10, numpy.arange(8) * 10).astype(numpy.uint8)
    numpy.testing.assert_array_equal(grey(message(ramp, "bayer_rggb8"))[1:-1, 1:-1], ramp[1:-1, 1:-1])
    packed = numpy.zeros((4, 6, 2), numpy.uint8)
    packed[:, :, 1] = 77
    assert (grey(message(packed, "yuv422")) == 77).all() and (grey(message(packed, "yuv422_yuy2")) == 0).all()


def test_what_a_run_would_refuse_is_refused_at_once(room, frames, bag_command, tmp_path):
    with BagWriter(tmp_path / "first", "ros2") as bag:
        write_infos(bag, room.rig)
        for side in ("left", "right"):
            bag.image(f"/stereo/{side}/image_raw", 5, frames[0].left, "jxl8")
    for options in ((), ("-o", tmp_path / "out")):
        done = bag_command(bag.path, *options)
        assert done.returncode == 3 and "found the encoding 'jxl8'" in done.stderr and "Traceback" not in done.stderr
    with BagWriter(tmp_path / "infos", "ros2") as bag:
        for side in ("left", "right"):
            bag.camera_info(f"/stereo/{side}/camera_info", 5, room.rig.left, 0.0)
            bag.image(f"/stereo/{side}/image_raw", 5, frames[0].left)
    done = bag_command(bag.path, "-o", tmp_path / "out")
    assert done.returncode == 3 and "a baseline above zero" in done.stderr
    assert f"{bag.path}: /stereo/right/camera_info" in done.stderr and "/tmp/tmp" not in done.stderr


def test_the_layout_of_realsense_viewer_and_given_topics(room, frames, tmp_path):
    with BagWriter(tmp_path / "viewer", "ros1") as bag:
        for number, tx in ((1, 0.0), (2, -room.rig.left.fx * 0.1)):
            sensor = f"/device_0/sensor_0/Infrared_{number}"
            bag.camera_info(f"{sensor}/info/camera_info", 5, room.rig.left, tx)
            bag.image(f"{sensor}/image/data", 5, frames[0].left)
    recording = quadedge.bag.open_bag(bag.path)
    assert recording.rig.baseline == pytest.approx(0.1) and len(recording) == 1
    with BagWriter(tmp_path / "apart", "ros2") as bag:
        for side, tx in (("left", 0.0), ("right", -room.rig.left.fx * 0.2)):
            bag.camera_info(f"/calibration/{side}", 5, room.rig.left, tx)
            bag.image(f"/stereo/{side}/image_raw", 5, frames[0].left)
    recording = quadedge.bag.open_bag(bag.path, left_info="/calibration/left", right_info="/calibration/right")
    assert recording.rig.baseline == pytest.approx(0.2)
    with pytest.raises(quadedge.DataError, match="found no camera_info topic /no"):
        quadedge.bag.open_bag(bag.path, left_info="/no")
