"""Recordings of ROS 1, ROS 2 and MCAP are read: topics, pairs, images, calibrations."""

from types import SimpleNamespace

import numpy
import pytest

import quadedge

pytest.importorskip("rosbags", reason="rosbags is not installed: quadedge.bag cannot be tested")

import quadedge.bag  # noqa: E402
from bags import KINDS, BagWriter, poses, room_recording  # noqa: E402


@pytest.mark.parametrize("kind", KINDS)
def test_the_flight_from_each_kind_of_recording(flight_folder, tmp_path, kind):
    dataset = quadedge.open_dataset(flight_folder, last_frame=12)
    with BagWriter(tmp_path / "flight", kind) as bag:
        for frame in dataset:
            bag.image("/cam0/image_raw", frame.stamp_ns, frame.left)
            bag.image("/cam1/image_raw", frame.stamp_ns, frame.right)
    files = [flight_folder / "mav0" / camera / "sensor.yaml" for camera in ("cam0", "cam1")]
    recording = quadedge.bag.open_bag(bag.path, calibration=files)
    assert len(recording) == 12 and "dropped" not in str(recording.pairing)
    assert (recording.topics.left, recording.topics.right) == ("/cam0/image_raw", "/cam1/image_raw")
    results, expected = poses(recording.rig, recording), poses(quadedge.Rig.from_file(files), dataset)
    assert all(result.is_tracked for result in results)
    numpy.testing.assert_array_equal(*([one.world_from_left for one in some] for some in (results, expected)))


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("compressed", [False, True])
def test_topics_and_calibration_are_recognised(room, room_folder, frames, tmp_path, kind, compressed):
    dataset = quadedge.open_dataset(room_folder)
    ending = "/image_raw/compressed" if compressed else "/image_raw"
    with BagWriter(tmp_path / "room", kind) as bag:
        bag.infos(room.rig)
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
    path = room_recording(tmp_path / "room", room.rig, frames[:2], topic="/stereo/{}/image_rect")
    recording = quadedge.bag.open_bag(next(path.glob("*.mcap")))  # the file alone works too
    assert recording.rectified and recording.rig.left.fx == room.rig.left.fx


def test_shuffled_missing_and_skewed_stamps(room, frames, tmp_path):
    """Of six frames one has no right image, one no timestamp, one is 80 ms off; two are recorded late."""
    stamps = [frame.stamp_ns + 1_000_000_000 for frame in frames]
    with BagWriter(tmp_path / "room", "ros1") as bag:
        bag.infos(room.rig)
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
    assert pairing.largest_difference_ns == 3_000_000
    assert "2 left images without a right one" in str(pairing)


def test_a_stamp_that_goes_back_starts_a_segment(room, frames, bag_command, tmp_path):
    """The clock is set back by 0.12 s after the third frame, one right image earlier than the left one is recorded."""
    stamps = [1_000_000_000 + 50_000_000 * i - (120_000_000 if i > 2 else 0) for i in range(6)]
    with BagWriter(tmp_path / "room", "ros1") as bag:
        bag.infos(room.rig)
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
    bag_command(bag.path, "--restarts", "-o", tmp_path / "out")
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


def test_rectified_images_on_image_raw_are_seen(room, frames, bag_command, tmp_path):
    """camera_info states lenses that distort; the images are those of P."""
    with BagWriter(tmp_path / "room", "mcap") as bag:
        bag.infos(room.rig, distortion=(-0.3, 0.1, 0, 0, 0), right_cy=9)
        for frame in frames[:3]:
            bag.pair(frame.stamp_ns + 1, frame.left, frame.right)
    assert "--rectified takes P" in bag_command(bag.path, "-o", tmp_path / "raw", code=5).stderr  # all frames are lost
    done = bag_command(bag.path, "-o", tmp_path / "rectified", "--rectified")
    assert "--rectified" not in done.stderr


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


def test_a_cut_recording_has_a_reason(room, frames, tmp_path):
    file = next(room_recording(tmp_path / "room", room.rig, frames).glob("*.mcap"))
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


def test_invalid_recordings_are_refused(frames, tmp_path):
    open_bag = quadedge.bag.open_bag
    (tmp_path / "text.bag").write_text("no bag")
    for path in (tmp_path / "absent.bag", tmp_path / "text.bag", tmp_path):
        with pytest.raises(quadedge.DataError, match="expected a .bag file"):
            open_bag(path)
    with BagWriter(tmp_path / "cut", "ros1") as bag:
        for stamp in range(1, 30):
            bag.pair(stamp, frames[0].left, frames[0].right)
    bag.path.write_bytes(bag.path.read_bytes()[:1_000_000])
    with pytest.raises(quadedge.DataError, match="cut.bag: found no readable recording"):
        open_bag(bag.path)
    with BagWriter(tmp_path / "room", "ros2") as bag:
        bag.pair(1, frames[0].left, frames[0].right)
    left, right = "/stereo/left/image_raw", "/stereo/right/image_raw"
    with pytest.raises(quadedge.DataError, match=f"found no camera_info of {left} and {right}"):
        open_bag(bag.path).rig
    with pytest.raises(quadedge.DataError, match="found no topic /b, expected an image topic"):
        open_bag(bag.path, left=left, right="/b")
    with pytest.raises(quadedge.DataError, match="expected both, left and right"):
        open_bag(bag.path, left=left)


@pytest.mark.parametrize("size", [(100, 320), (200, 318)])
def test_images_of_another_size_are_named(room, frames, size, tmp_path):
    with BagWriter(tmp_path / "room", "mcap") as bag:
        bag.infos(room.rig)
        for stamp, frame in enumerate(frames[:3], 1):
            bag.pair(stamp, frame.left, frame.right if stamp < 3 else frame.right[:size[0], :size[1]])
    words = (f"/stereo/right/image_raw at 3 ns: found {size[1]} x {size[0]} pixels of uint8, expected 320 x 200 pixels "
             "of uint8, as in the first frame")
    with pytest.raises(quadedge.DataError, match=words):
        list(quadedge.bag.open_bag(bag.path))


def test_stamps_of_zero_are_told(room, frames, bag_command, tmp_path):
    with BagWriter(tmp_path / "room", "mcap") as bag:
        bag.infos(room.rig)
        for frame in frames:
            bag.pair(0, frame.left, frame.right)
    assert quadedge.bag.open_bag(bag.path).has_recorded_stamps
    assert "warning: the stamps of all images are 0: the times of recording" in bag_command(bag.path).stderr
    done = bag_command(bag.path, "--tolerance", "nan", code=2)
    assert "found nan, expected a finite number" in done.stderr


def test_mosaics_and_luminance():
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
