"""The matching evaluation on scenes whose recall, precision and errors are calculated by hand."""

from types import SimpleNamespace

import numpy
import pandas
import pytest
from matching_scene import candidates, edges, floats, images_of, plane_truth, result, small_rig, stereo_edges
from quadedge import StereoFilter, TemporalFilter
from quadedge.matching.counts import Nearby, Pools, Tolerance, filter_counts, shares
from quadedge.matching.document import summary
from quadedge.matching.observer import FrameMatching, MatchingObserver, MatchingResult
from quadedge.matching.quad_pairs import check_constraints, measure_pairs


def observer_of():
    return MatchingObserver(small_rig(), 1, Tolerance())


def by_pool(counts):
    """The rows of a table, each with the shares of both pools by name."""
    pools = [row for _, row in shares(pandas.DataFrame(counts)).iterrows()]
    return [SimpleNamespace(paired=paired, everything=all_edges) for paired, all_edges in zip(pools[::2], pools[1::2])]


def test_a_scene_has_the_recall_precision_and_ambiguity_calculated_by_hand():
    left = edges((30, 10),     # 0: counterpart 0, and the near duplicate 1
                 (40, 20),     # 1: counterpart 2
                 (50, 30),     # 2: no right edge near the true position (40, 30)
                 (90, 40),     # 3: unknown disparity
                 (60, 50, 0),  # 4: lies along its epipolar line
                 (5, 50),      # 5: its true position is outside the right image
                 (70, 30))     # 6: its right edge is near its true position, but too far from the epipolar line
    right = edges((20.4, 10), (20.9, 10), (30, 20.3), (45, 30), (60, 30.8))
    observer = observer_of()
    observer.begin(0, plane_truth())
    observer.edges(left, right)
    # 0: two true candidates and a false one; 1: a true one; 2 and 5: a false one; 3 and 4: some that must not count.
    observer.stereo_filter(StereoFilter.epipolar_distance, candidates([0, 1, 3], [2], [3], [0], [0], [2], []))
    # 0 keeps one true candidate, 1 loses its only one, 2 gets a true refined position, and 5 one that would be true if
    # it were visible.
    observer.stereo_filter(StereoFilter.disparity, candidates([1], [], [3], [], [], [2], [], x=[20.1, 40.5, -5],
                                                              y=[10, 30, 50]))
    measured = observer.end(result())
    assert measured.census.tolist() == [7, 1, 1, 1, 0]
    assert measured.stereo[0].items() >= {"order": 0, "filter": "baseline"}.items()
    assert measured.stereo[2]["filter"] == "epipolar proximity"
    baseline, first, second = by_pool(measured.stereo)
    assert (baseline.paired.edges, baseline.paired.recall, baseline.paired.ambiguity) == (2, 1, 4)
    assert baseline.paired.precision == pytest.approx(3 / 10)
    assert (baseline.everything.edges, baseline.everything.recall) == (5, 3 / 5)
    assert baseline.everything.precision == pytest.approx(4 / 25)
    assert (first.paired.recall, first.paired.precision, first.paired.ambiguity, first.paired.most) == (1, 3 / 4, 1, 3)
    assert (first.everything.recall, first.everything.precision, first.everything.ambiguity) == (2 / 5, 3 / 6, 0.5)
    assert (second.paired.recall, second.paired.precision, second.paired.ambiguity) == (0.5, 1, 0)
    assert (second.everything.recall, second.everything.kept) == (2 / 5, 3)
    assert second.everything.precision == pytest.approx(2 / 3)


def test_the_error_of_a_stereo_edge_is_its_disparity_error_and_the_part_across_the_edge():
    observer = observer_of()
    observer.begin(0, plane_truth())
    observer.edges(edges((30, 10)), edges((20, 10)))
    observer.stereo(stereo_edges((30, 10, 19.5), right_direction=0.5))
    measured = observer.end(result())
    assert measured.disparity_error == pytest.approx([0.5])  # 10.5 instead of 10
    assert measured.across_error == pytest.approx([0.5 * numpy.sin(0.5)])


def test_pooled_tables_add_counts_not_percentages_and_give_the_spread_over_the_frames():
    frames = [FrameMatching(stereo=filter_counts(StereoFilter.baseline, numpy.array(kept), numpy.array(true),
                                                 Pools(*2 * [numpy.ones(len(kept), bool)])))
              for kept, true in (([1], [1]), ([2, 2, 2], [1, 0, 0]))]
    frames[0].disparity_error, frames[1].disparity_error = floats([-0.1, 0.2]), floats([0.4])
    content = summary([MatchingResult("two frames", frames)])
    (row,) = content["stereo"]
    assert (row["recall"], row["ambiguity_max"]) == (2 / 4, 1)
    assert row["precision"] == pytest.approx(2 / 7)
    assert row["precision_per_edge"] == pytest.approx((1 + 0.5) / 4)
    assert row["recall_std"] == pytest.approx((1 - 1 / 3) / 2)
    assert content["disparity_error_px"]["median"] == content["disparity_error_px"]["bias"] == pytest.approx(0.2)


def test_two_frames_have_the_temporal_recall_and_precision_calculated_by_hand():
    # The rig moves by 0.05 m: everything shifts 5 px to the left in both images.
    before = stereo_edges((30, 10, 20),  # 0: goes to 0
                          (40, 20, 30),  # 1: goes to 1
                          (50, 30, 40),  # 2: nothing within a pixel of (45, 30)
                          (60, 40, 55))  # 3: a wrong stereo edge; its left point's true position is still known
    now = stereo_edges((25, 10, 15), (35, 20, 25), (48, 30, 38), (55, 40, 45))
    observer = observer_of()
    observer.begin(0, plane_truth(0))
    observer.edges(*images_of(before))
    observer.stereo(before)
    first = observer.end(result())
    assert first.temporal is None and first.classes.tolist() == [3, 1, 0, 0]

    observer.begin(1, plane_truth(0.05))
    observer.edges(*images_of(now))
    observer.stereo(now)
    expected = images_of(before)[0]
    observer.temporal_search(SimpleNamespace(number=0, base_frame=0, left=expected, right=expected, step=1))
    observer.temporal_filter(TemporalFilter.displacement, "left", candidates([0, 2], [2], [2], [3]))
    observer.temporal_filter(TemporalFilter.displacement, "right", candidates([0], [1], [2], [3]))
    observer.quads(SimpleNamespace(
        previous=numpy.array([0, 1, 3]), current=numpy.array([0, 2, 3]), left=floats([[25.2, 10], [48, 30], [55, 40]]),
        right=floats([[15.1, 10], [38, 30], [45, 40]]), competing_clusters=numpy.array([3, 1, 5])))
    second = observer.end(result(search=0, x=0.053))

    # Pools: paired = {0, 1}, all = {0, 1, 2, 3}.
    found = second.temporal
    baseline, left, _ = by_pool(found.tables["left"])
    assert found.tables["left"][-1]["filter"] == "best"
    assert (baseline.paired.edges, baseline.paired.recall, baseline.paired.precision) == (2, 1, 2 / 8)
    assert (baseline.everything.edges, baseline.everything.recall) == (4, 3 / 4)
    assert (left.paired.recall, left.paired.precision, left.paired.ambiguity) == (0.5, 1 / 3, 0.5)
    assert (left.everything.recall, left.everything.precision) == (2 / 4, 2 / 5)
    right = by_pool(found.tables["right"])[1]
    assert (right.paired.recall, right.paired.precision, right.everything.precision) == (1, 1, 3 / 4)
    (quads,) = by_pool(found.quads)
    assert (quads.paired.edges, quads.paired.recall, quads.paired.precision) == (2, 0.5, 0.5)
    assert (quads.everything.edges, quads.everything.recall, quads.everything.precision) == (4, 0.5, 2 / 3)
    assert summary([MatchingResult("", [first, second])])["quads"]["ambiguity_mean"] == (3 + 1) / 2
    # Pairs are drawn from the quads 0, 1 and 3; one of three pairs consists of true quads.
    assert found.pairs.veridical[0] / found.pairs.pairs[0] == pytest.approx(1 / 3, abs=0.01)


def show(observer, number, x, found):
    observer.begin(number, plane_truth(x))
    observer.edges(*images_of(found))
    observer.stereo(found)


def show_search(observer, number, base_frame, base, targets, now, step=1):
    """A search that finds `targets`, one per stereo edge of the base."""
    expected, targets = images_of(base)[0], numpy.array(targets)
    observer.temporal_search(SimpleNamespace(number=number, base_frame=base_frame, left=expected, right=expected,
                                             step=step))
    for side in ("left", "right"):
        observer.temporal_filter(TemporalFilter.displacement, side, candidates(*([one] for one in targets)))
    observer.quads(SimpleNamespace(previous=numpy.arange(len(targets)), current=targets, left=now.left[targets],
                                   right=now.right[targets], competing_clusters=numpy.zeros(len(targets), int)))


def test_after_a_loss_only_the_search_that_gave_the_motion_is_evaluated():
    # Frame 0 has three stereo edges, frame 1 (lost) the same in another order and one more, frame 2 those of frame 1.
    # The rig moves by 0.05 m = 5 px per frame.
    zero = stereo_edges(*((x, 10 + x / 5, x - 10) for x in (30, 40, 50)))
    one = stereo_edges(*((x - 5, 10 + x / 5, x - 15) for x in (50, 30, 60, 40)))
    two = stereo_edges(*((x - 10, 10 + x / 5, x - 20) for x in (50, 30, 60, 40)))
    observer = observer_of()
    show(observer, 0, 0, zero)
    observer.end(result(status="first"))
    show(observer, 1, 0.05, one)
    show_search(observer, 0, 0, zero, [1, 3, 0], one)  # true, but gave no motion
    lost = observer.end(result(x=0.3, status="lost_no_consensus"))
    assert lost.temporal is None

    show(observer, 2, 0.1, two)
    show_search(observer, 0, 0, zero, [0, 0, 0], two)    # all wrong, with another base
    show_search(observer, 1, 1, one, [0, 1, 2, 3], two)  # all true: gives the motion
    show_search(observer, 2, 1, one, [3, 2, 1, 0], two)  # tried afterwards
    show_search(observer, 3, 1, one, [0, 1], two, 2)     # a subset of the edges
    found = observer.end(result(search=1, reference_frame=1, x=0.352))
    (quads,) = by_pool(found.temporal.quads)
    paired = quads.paired
    assert (paired.edges, paired.recall, paired.precision) == (4, 1, 1)
    for table in found.temporal.tables.values():
        rows = by_pool(table)
        assert len(rows) == 3 and rows[1].paired.recall == rows[1].paired.precision == 1

    # The pipeline may choose a search before the last one, even if the last one was against an older frame.
    show(observer, 3, 0.1, two)
    show_search(observer, 0, 2, two, [0, 1, 2, 3], two)
    show_search(observer, 1, 1, one, [1, 0, 3, 2], two)
    older = observer.end(result(search=1, reference_frame=1, x=0.352))
    (quads,) = by_pool(older.temporal.quads)
    assert quads.everything.edges == 4 and quads.everything.precision == 0


def random_points(random, count):
    tangents = random.uniform(-1, 1, (count, 3))
    return random.uniform(-1, 1, (count, 3)) + [0, 0, 3], tangents / numpy.linalg.norm(tangents, axis=1)[:, None]


def test_constraints_hold_for_pairs_that_moved_alike_and_each_fails_for_its_own_reason():
    along, across, up = numpy.eye(3)

    def check(now_second=(2, 0, 0), tangent=across, second=up, before_tangents=(across, up)):
        before = numpy.array([[(0, 0, 3)], [before_tangents[0]], [(1, 0, 3)], [before_tangents[1]]], float)
        now = numpy.array([[(0, 0, 3)], [tangent], [numpy.add((-1, 0, 3), now_second)], [second]], float)
        return check_constraints(before, now)[:, 0].tolist()

    assert all(check())
    assert check(now_second=(2.2, 0, 0)) == [False, True, True, True, True, True]  # 20 % longer
    assert check(tangent=numpy.cos(0.5) * across + numpy.sin(0.5) * along) == [True, False, True, True, True, True]
    assert check(second=numpy.cos(0.5) * up + numpy.sin(0.5) * along) == [True, True, False, True, True, True]
    assert check(second=numpy.cos(0.5) * up + numpy.sin(0.5) * across) == [True, True, True, False, True, True]
    assert check(second=-up) == [True, True, True, True, True, False]  # the other handedness
    assert check(tangent=along, before_tangents=(along, up))[4]  # D is along T1, but not along T2
    assert not check(tangent=along, second=along, before_tangents=(along, along))[4]


def test_pairs_of_wrong_quads_lower_the_precision_until_the_constraints_remove_them():
    random = numpy.random.default_rng(3)
    turn, motion = 0.05, numpy.eye(4)
    motion[:2, :2] = [[numpy.cos(turn), -numpy.sin(turn)], [numpy.sin(turn), numpy.cos(turn)]]
    motion[:3, 3] = 0.1, -0.02, 0.3
    before, others = random_points(random, 400), random_points(random, 400)
    now = [before[0] @ motion[:3, :3].T + motion[:3, 3], before[1] @ motion[:3, :3].T]
    wrong = numpy.arange(400) % 4 == 3
    for values, other in zip(now, others):
        values[wrong] = other[wrong]
    measured = measure_pairs(before, now, ~wrong, 1)
    precision = measured.veridical / measured.pairs
    assert precision[0] == pytest.approx(0.75**2, abs=0.01) and precision[6] > 0.95
    # A true pair fulfils 1 to 4; 5 depends on its directions.
    assert (measured.veridical[1:5] == measured.veridical[0]).all() and (numpy.diff(measured.pairs[:5]) < 0).all()
    assert measure_pairs(before, others, numpy.zeros(400, bool), 1).veridical[6] == 0


def test_every_edge_within_a_radius_is_found():
    random = numpy.random.default_rng(1)
    x, y = random.uniform(0, 90, 2000).astype(numpy.float32), random.uniform(0, 60, 2000).astype(numpy.float32)
    at_x, at_y = random.uniform(-5, 95, 300), random.uniform(-5, 65, 300)
    for radius in (0.4, 1.0, 3.7):
        found = set(zip(*map(list, Nearby(x, y).pairs(at_x, at_y, radius))))
        away = numpy.hypot(at_x[:, None] - x.astype(float), at_y[:, None] - y.astype(float))
        assert found == set(zip(*map(list, numpy.nonzero(away <= radius))))
    assert not len(Nearby(floats([]), floats([])).pairs(at_x, at_y, 1)[0])
