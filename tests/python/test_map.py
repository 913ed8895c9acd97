"""Maps of places: loops beside the odometry, saved maps, and frames located in them."""

import numpy as np
import pytest

import quadedge


CONFIG = {"odometry.key_max_frames": 1, "map.min_gap": 3}


@pytest.fixture(scope="module")
def walk():
    """A closed loop through a rendered room, with small images."""
    return quadedge.synthetic(frames=49, path="loop", width=320, height=200)


def track(source, path=None, **arguments):
    with quadedge.Odometry(source, config=CONFIG, **arguments) as odometry:
        results = [odometry.track(frame.stamp_ns, frame.left, frame.right) for frame in list(source)[::2]]
        trajectory = odometry.map_trajectory()
        if path:
            odometry.save_map(path)
    return results, trajectory


@pytest.fixture(scope="module")
def saved(walk, tmp_path_factory):
    path = tmp_path_factory.mktemp("map") / "room.map"
    return path, *track(walk, path, loops=True)


def test_the_map_corrects_the_poses_of_the_odometry(walk, saved):
    _, results, trajectory = saved
    assert len(trajectory) == len(results)
    last = results[-1]
    np.testing.assert_allclose(last.map_from_odometry @ last.world_from_left, trajectory.poses[-1], atol=1e-9)
    # The loop ends where it began.
    assert np.linalg.norm(trajectory.poses[-1][:3, 3]) < 0.01


def test_without_loops_there_is_no_map_and_the_poses_are_the_same(walk, saved):
    _, results, _ = saved
    with quadedge.Odometry(walk, config=CONFIG) as odometry:
        frame = next(iter(walk))
        alone = odometry.track(frame.stamp_ns, frame.left, frame.right)
        assert alone.map_from_odometry is None
        assert alone.world_from_left.tobytes() == results[0].world_from_left.tobytes()
        for call in (odometry.map_trajectory, lambda: odometry.save_map("never.map")):
            with pytest.raises(quadedge.UsageError, match="loops=True"):
                call()


def test_a_map_is_not_saved_without_a_name(walk):
    with quadedge.Odometry(walk, config=CONFIG, loops=True) as odometry:
        with pytest.raises(quadedge.DataError, match="empty name"):
            odometry.save_map("")


def test_frames_are_located_in_a_saved_map(walk, saved):
    path, _, _ = saved
    places = quadedge.Map.load(path)
    assert len(places) == places.key_rigs > 1
    frame = list(walk)[5]
    found = places.localise(frame.left, frame.right, frame.stamp_ns)
    assert found.status == "located" and found.message == "" and found.stamp_ns == frame.stamp_ns
    assert np.linalg.norm(found.map_from_left[:3, 3] - walk.truth.poses[5, :3, 3]) < 0.02
    assert found.covariance.shape == (6, 6) and np.all(np.linalg.eigvalsh(found.covariance) > 0)
    assert found.inliers > 100 and found.support > 0.2 and found.key_rig >= 0


def test_a_frame_of_an_unknown_place_has_no_pose_and_a_reason(saved):
    places = quadedge.Map.load(saved[0])
    frame = next(iter(quadedge.synthetic(scene="cables", frames=1, width=320, height=200)))
    found = places.localise(frame.left, frame.right)
    assert found.map_from_left is None and found.covariance is None
    assert found.status.startswith("lost_") and found.message


def test_masks_hide_what_is_not_to_be_searched(walk, saved):
    places, frame = quadedge.Map.load(saved[0]), list(walk)[5]
    white, black = np.full(frame.left.shape, 255, np.uint8), np.zeros(frame.left.shape, np.uint8)
    found = [places.localise(frame.left, frame.right, 0, *masks) for masks in ((), (white, white))]
    assert found[0].map_from_left.tobytes() == found[1].map_from_left.tobytes()
    assert places.localise(frame.left, frame.right, left_mask=black).status == "lost_too_few_edges"
    with pytest.raises(quadedge.DataError, match="the right mask has 320x199 pixels"):
        places.localise(frame.left, frame.right, right_mask=white[:199])
    with pytest.raises(TypeError, match="left_mask is an array of uint16"):
        places.localise(frame.left, frame.right, left_mask=white.astype(np.uint16))


def test_invalid_maps_and_images_are_refused(walk, saved, tmp_path):
    path, _, _ = saved
    damaged = tmp_path / "damaged.map"
    damaged.write_bytes(path.read_bytes()[:-1])
    with pytest.raises(quadedge.DataError, match="damaged.map.*expected"):
        quadedge.Map.load(damaged)
    with pytest.raises(quadedge.UsageError, match="edges.sigma = 2"):
        quadedge.Map.load(path, rig=walk, config={"edges.sigma": 3})
    places = quadedge.Map.load(path, rig=walk, device="reference")
    with pytest.raises(TypeError):
        places.localise(None, None)
    with pytest.raises(quadedge.DataError):
        places.localise(np.zeros((10, 10), np.uint8), np.zeros((10, 10), np.uint8))


def test_cameras_with_lens_distortion_have_to_be_given(command, tmp_path):
    command("synth", tmp_path / "room", "--frames", 1, "--size", "320x200", "--lens", "radtan", "--quiet")
    room = quadedge.open_dataset(tmp_path / "room")
    with quadedge.Odometry(room, loops=True) as odometry:
        frame = next(iter(room))
        odometry.track(frame.stamp_ns, frame.left, frame.right)
        odometry.save_map(tmp_path / "room.map")
    with pytest.raises(quadedge.UsageError, match="lens distortion: expected rig="):
        quadedge.Map.load(tmp_path / "room.map")
    assert quadedge.Map.load(tmp_path / "room.map", rig=room).localise(frame.left, frame.right).status == "located"
