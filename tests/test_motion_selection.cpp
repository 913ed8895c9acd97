/// \file test_motion_selection.cpp  Which motion is chosen and what makes it ambiguous, row by row; what follows for
/// the images is held by test_disturbances, test_repetition, test_odometry_real and the attacks on the geometry.
#include "motion/motion_selection.hpp"
#include "motion/motion_step.hpp"
#include "testing.hpp"

using namespace quadedge::odometry;

namespace {

/// A motion that explains an area of the image and leaves nothing ambiguous, but for what `change` sets.
Verdict found(double area, const std::function<void(Verdict&)>& change = {}) {
  Verdict verdict;
  verdict.refusal = Refusal::none;
  verdict.support = 0.5;
  verdict.area = area;
  if (change) change(verdict);
  return verdict;
}
Verdict supported(double area, double support) {
  return found(area, [=](Verdict& v) { v.support = support; });
}
Verdict closely(double area) {
  return found(area, [](Verdict& v) { v.has_all_inliers = false; });
}
Verdict moving(double area, double ratio) {
  return found(area, [=](Verdict& v) { v.moving_ratio = ratio; });
}
Verdict at_rest(double area, double ratio) {
  return found(area, [=](Verdict& v) { v.static_ratio = ratio; });
}
Verdict beside_sides(double still_ratio, double around_ratio) {
  return found(0.5, [=](Verdict& v) { v.still_ratio = still_ratio, v.around_ratio = around_ratio; });
}
Verdict contradicted(double support) {
  return found(0.8, [=](Verdict& v) { v.support = support, v.agrees_globally = false; });
}

const Verdict kFailure;
const Expectation kPredicted{0, false, 0.35}, kDoubtful{0, true, 0.35}, kUnpredicted{std::nullopt, false, 0.35};

/// The completed verdict on the motion chosen, and its index.
struct Choice : Verdict {
  std::size_t chosen = 0;
};

/// Motions with the same number are the same; by default, all differ. \param shared fraction of a motion's explained
/// area that the others explain, too \param repeats whether they differ by periods of a scene that repeats
Choice choose(std::vector<Verdict> verdicts, const Expectation& expectation = kPredicted, std::vector<int> motion = {},
              double shared = 0, bool repeats = false) {
  if (motion.empty()) {
    motion.resize(verdicts.size());
    std::iota(motion.begin(), motion.end(), 0);
  }
  const auto chosen = select(verdicts, expectation,
                             {[&](std::size_t a, std::size_t b) { return motion[a] == motion[b]; },
                              [&](std::size_t a, std::size_t) { return (1 - shared) * verdicts[a].area; },
                              [&](std::size_t, std::size_t) { return repeats; }});
  return {verdicts[chosen], chosen};
}

}  // namespace

TEST_CASE("motion selection: how much is tried depends on what the prediction leaves open") {
  const auto needed = [](const std::vector<Verdict>& verdicts, const Expectation& expectation = kPredicted) {
    return choose(verdicts, expectation).needed;
  };
  CHECK(needed({found(0.8)}) == SearchLevel::prediction);
  for (const Verdict& verdict : {moving(0.8, 0.3), at_rest(0.8, 0.06)})
    CHECK(needed({verdict}) == SearchLevel::inexpensive);
  for (const Verdict& verdict : {moving(0.8, 0.6), supported(0.8, 0.34), kFailure})
    CHECK(needed({verdict}) == SearchLevel::everything);
  for (const Expectation& expectation : {kDoubtful, kUnpredicted})
    CHECK(needed({found(0.8)}, expectation) == SearchLevel::everything);
  // An inexpensive hypothesis that explains more than the prediction, and one that does not.
  CHECK(needed({moving(0.5, 0.3), closely(0.6)}) == SearchLevel::everything);
  CHECK(needed({moving(0.5, 0.3), closely(0.4)}) == SearchLevel::inexpensive);
}

TEST_CASE("motion selection: the motion that explains the largest area is chosen") {
  Verdict failure;
  failure.area = 0.9;  // has no meaning
  // Of two equal posters one appears in the place of the other: the jump fits nearly all that it leaves in view. A rare
  // motion does not win against the prediction and four times the evidence.
  const auto of = [](double area, int inliers, int followed) {
    return found(area, [=](Verdict& v) { v.moving_ratio = 0.55, v.inliers = inliers, v.followed = followed; });
  };
  const Verdict true_motion = of(0.4, 7360, 180), jump = of(0.7, 1631, 60);
  struct Row {
    std::vector<Verdict> verdicts;
    Expectation expectation;
    std::vector<int> motion;
    std::size_t chosen;
  };
  for (const Row& row : {
           Row{{found(0.3), found(0.5), found(0.4)}, kPredicted, {}, 1},
           {{kFailure, found(0.01)}, kPredicted, {}, 1},
           {{found(0.4), found(0.4)}, kPredicted, {}, 1},  // not the prediction
           {{found(0.4), found(0.4)}, kUnpredicted, {}, 0},
           {{kFailure, kFailure, kFailure}, kPredicted, {}, 1},
           {{found(0.2), failure}, kPredicted, {}, 0},
           // A close agreement gives way to the same motion with all of its inliers.
           {{found(0.3), closely(0.6), found(0.5)}, kPredicted, {}, 1},
           {{found(0.3), closely(0.6), found(0.5)}, kPredicted, {0, 1, 1}, 2},
           {{closely(0.3), closely(0.6)}, kUnpredicted, {0, 0}, 1},
           {{kFailure, closely(0.6)}, kPredicted, {0, 0}, 1},
           {{true_motion, jump}, kPredicted, {}, 0},
           {{true_motion, jump}, kUnpredicted, {}, 1},              // nothing is known of the motion
           {{true_motion, of(0.7, 1900, 60)}, kPredicted, {}, 1},   // nearly as much evidence
           {{true_motion, of(0.7, 1631, 200)}, kPredicted, {}, 1},  // fewer edges, over more of the image
           {{kFailure, jump}, kPredicted, {}, 1},
       })
    CHECK(choose(row.verdicts, row.expectation, row.motion).chosen == row.chosen);
  CHECK(choose({true_motion, jump}).ambiguity.exists());
  CHECK(choose({kFailure, kFailure}).refusal == Refusal::no_consensus);
}

TEST_CASE("motion selection: what was not expected has to agree with the global matches") {
  CHECK(choose({contradicted(0.8)}).refusal == Refusal::none);  // confident
  CHECK(choose({contradicted(0.34)}).refusal == Refusal::contradicted);
  CHECK(choose({kFailure, contradicted(0.5)}).refusal == Refusal::contradicted);
  CHECK(choose({contradicted(0.5)}, kUnpredicted).refusal == Refusal::contradicted);
  CHECK(choose({supported(0.8, 0.1)}, kUnpredicted).refusal == Refusal::none);
}

TEST_CASE("motion selection: every ambiguity is told with its ratio") {
  std::set<std::string> texts;
  const auto check = [&](const Ambiguity& ambiguity, AmbiguityKind kind, double ratio) {
    CHECK(ambiguity.kind == kind);
    CHECK(ambiguity.ratio == Approx(ratio));
    CHECK(texts.insert(to_string(ambiguity)).second);
    CHECK(to_string(ambiguity).find(" %") != std::string::npos);
  };
  check(choose({moving(0.5, 0.6)}).ambiguity, AmbiguityKind::moving_image, 0.6);
  check(choose({at_rest(0.5, 0.07)}).ambiguity, AmbiguityKind::static_scene, 0.07);
  check(choose({beside_sides(0.9, 0.1)}).ambiguity, AmbiguityKind::moving_sides, 0.1);
  check(choose({found(0.5), found(0.1), found(0.3), found(0.25), kFailure}).ambiguity, AmbiguityKind::competing_motion,
        0.6);
  check(ambiguity_of({0.2, 0.5, 0.4, 0.6}, false), AmbiguityKind::other_part, 0.2);
  CHECK_FALSE(to_string({AmbiguityKind::recent_other_part, 0}).empty());
  CHECK(choose({found(0), found(0)}).ambiguity.kind == AmbiguityKind::competing_motion);
  for (const std::vector<Verdict>& verdicts : {std::vector<Verdict>{found(0.5)},
                                               {kFailure},
                                               {moving(0.5, 0.49)},
                                               {beside_sides(0.9, 0.04)},
                                               {beside_sides(0.7, 0.1)},
                                               {found(0.5), found(0.19)}})
    CHECK_FALSE(choose(verdicts).ambiguity.exists());
  CHECK_FALSE(choose({found(0.5), found(0.3)}, kPredicted, {0, 0}).ambiguity.exists());
  // A competing motion counts by what the chosen one does not explain.
  CHECK(choose({found(0.5), found(0.3)}, kPredicted, {}, 0.3).ambiguity.ratio == Approx(0.42));
  CHECK_FALSE(choose({found(0.5), found(0.3)}, kPredicted, {}, 0.4).ambiguity.exists());
}

TEST_CASE("motion selection: edges of distant views that are not found again are no second motion") {
  // Confirmed by half of the global matches; by fewer if the rest of them propose nothing, in as many places as a pose
  // needs.
  struct Row {
    double global_ratio, rival_ratio;
    bool agrees, is_ambiguous;
  };
  for (const Row& row : {Row{0.5, 0, true, false},
                         {0.2, 0.4, true, false},
                         {0.2, 0.6, true, true},
                         {0.2, 0.4, false, true},
                         {0, 0, true, true}}) {
    CAPTURE(row.global_ratio, row.rival_ratio, row.agrees);
    const Verdict verdict = found(0.5, [&](Verdict& v) {
      v.moving_ratio = 0.6, v.global_ratio = row.global_ratio, v.rival_ratio = row.rival_ratio;
      v.agrees_globally = row.agrees;
    });
    CHECK((choose({verdict}).ambiguity.kind == AmbiguityKind::moving_image) == row.is_ambiguous);
  }
}

TEST_CASE("motion selection: an ambiguous motion is refused where it is no answer") {
  const auto decided = [](Verdict verdict, bool accepts_ambiguous, const Ambiguity& later = {}) {
    decide(accepts_ambiguous, later, verdict);
    return verdict.refusal;
  };
  const Ambiguity later{AmbiguityKind::other_part, 0.2};
  const Choice ambiguous = choose({found(0.5), found(0.3)});
  CHECK(decided(ambiguous, true) == Refusal::none);
  CHECK(decided(ambiguous, false) == Refusal::ambiguous);
  CHECK(decided(found(0.5), false) == Refusal::none);
  CHECK(decided(found(0.5), false, later) == Refusal::ambiguous);
  CHECK(decided(found(0.5), true, later) == Refusal::none);
  CHECK(decided(kFailure, false, later) == Refusal::no_consensus);
}

TEST_CASE("motion selection: when another part of the image may follow the camera's motion") {
  struct Row {
    const char* what;
    OtherPart part;  // area, ratio, spread, chosen area; balance, spread of matches, whether they agree, whether a rest
    bool was_ambiguous, at_start, counts;
  };
  const Row rows[] = {
      {"nothing", {}, false, false, false},
      {"its area", {0.1, 0.5, 0.1, 0.5}, false, false, true},
      {"an object", {0.05, 0.5, 0.1, 0.5}, false, false, false},
      {"a smaller area on all sides", {0.05, 0.5, 0.9, 0.8}, false, false, true},
      {"next to nothing on all sides", {0.01, 0.5, 0.9, 0.8}, false, false, false},
      {"an object after an ambiguous motion", {0.05, 0.4, 0.1, 0.5}, true, false, true},
      {"next to nothing after an ambiguous motion", {0.005, 0.5, 0.9, 0.8}, true, false, false},
      {"most of what was searched does not follow", {0.1, 0.05, 0.9, 0.5}, false, false, false},
      {"a car that passes", {0.09, 0.7, 0.3, 0.75}, false, false, false},
      {"a car that passes after a doubt", {0.04, 0.7, 0.3, 0.75}, true, false, false},
      {"two cars, one on either side", {0.08, 0.7, 0.4, 0.75}, false, false, false},
      {"the scene beside a bus that fills most of the image", {0.09, 0.7, 0.3, 0.45}, false, false, true},
      // As between keyframes 2 m apart in a street: few of the cells that do not follow, and next to no matches.
      {"near edges of distant views", {0.102, 0.175, 1, 0.42, 0.03}, false, false, false},
      {"near edges of distant views after a doubt", {0.102, 0.175, 1, 0.42, 0.03}, true, false, false},
      {"the same in the first frames", {0.102, 0.175, 1, 0.42, 0.03}, false, true, true},
      {"the same in one place", {0.102, 0.175, 0.2, 0.42, 0.03}, false, true, false},
      {"the same if matches follow it", {0.102, 0.175, 1, 0.42, 0.25}, false, false, true},
      {"more matches than the chosen motion has", {0.01, 0.05, 0.9, 0, 1.2, 0.7, true}, false, false, true},
      {"fewer matches", {0.01, 0.05, 0.9, 0, 0.9, 0.7, true}, false, false, false},
      {"matches of an object", {0.01, 0.05, 0.9, 0, 1.2, 0.5, true}, false, false, false},
      {"fewer matches after an ambiguous motion", {0.01, 0.05, 0.9, 0, 0.3, 0.5, true}, true, false, true},
      {"matches in too few places", {0.01, 0.05, 0.9, 0, 1.2, 0.7, false}, false, false, false},
      {"a small part in one place after a doubt", {0.01, 0.05, 0.2, 1, 0.5, 0.1, true}, true, false, false},
      {"a small part whose matches are spread", {0.01, 0.05, 0.2, 1, 0.5, 0.5, true}, true, false, true},
      {"an area", {0.2, 0.5, 0.9, 0.5}, false, false, true},
      {"a rest, whose area alone is no evidence", {0.2, 0.5, 0.9, 0.5, 0, 0, false, true}, false, false, false},
  };
  for (const Row& row : rows) {
    INFO(row.what);
    CHECK(ambiguity_of(row.part, row.was_ambiguous, row.at_start).exists() == row.counts);
  }
}

TEST_CASE("motion selection: after most of the image has changed, the next three frames are searched") {
  const auto searches_after = [](double before, double changed) {
    TrackRecord record{quadedge::Config()};
    MotionStep step;
    step.clear();
    step.verdict = moving(0.5, before);
    step.is_checked = true;
    for (int frame = 0; frame < 3; ++frame) record.remember(step);  // the first ones
    step.verdict = moving(0.5, changed);
    record.remember(step);
    int searches = 0;
    step.verdict = moving(0.5, 0.05);  // what has appeared is followed
    while (searches < 10 && record.is_check_due(step.verdict)) {
      record.remember(step);
      ++searches;
    }
    return searches;
  };
  CHECK(searches_after(0.2, 0.75) == 3);
  CHECK(searches_after(0.2, 0.45) == 0);
  CHECK(searches_after(0.6, 0.75) == 0);  // as in every step of distant views
}

TEST_CASE("motion selection: another part of the image is remembered for three searches, until a loss") {
  TrackRecord record{quadedge::Config()};
  MotionStep step;
  step.clear();
  step.verdict.refusal = Refusal::none;
  step.is_checked = true;
  const auto is_remembered = [&](bool shows_other_part, const Ambiguity& ambiguity) {
    step.shows_other_part = shows_other_part;
    step.verdict.ambiguity = ambiguity;
    record.remember(step);
    return record.recent_other_part().exists();
  };
  CHECK_FALSE(is_remembered(false, {}));
  CHECK(is_remembered(true, {AmbiguityKind::other_part, 0.1}));
  for (int search = 0; search < 3; ++search) {
    CHECK(record.is_check_due(Verdict()));
    CHECK(is_remembered(false, record.recent_other_part()) == (search < 2));
  }
  // What is found beside another ambiguity, with lower limits, is not remembered.
  is_remembered(false, {AmbiguityKind::moving_image, 0.7});
  CHECK_FALSE(is_remembered(true, {AmbiguityKind::moving_image, 0.7}));
  is_remembered(false, {});
  CHECK(is_remembered(true, {}));
  step.verdict.refusal = Refusal::no_consensus;
  step.is_checked = false;
  CHECK_FALSE(is_remembered(false, {}));
}

TEST_CASE("motion selection: a motion that differs by a period does not take the place of the prediction's") {
  const std::vector<Verdict> verdicts = {found(0.3), found(0.8)};
  CHECK(choose(verdicts).chosen == 1);
  CHECK_FALSE(choose(verdicts).is_predicted);
  const Choice kept = choose(verdicts, kPredicted, {}, 0, true);
  CHECK(kept.chosen == 0);
  CHECK(kept.is_predicted);
  CHECK_FALSE(choose(verdicts, kDoubtful, {}, 0, true).is_predicted);
  CHECK(choose(verdicts, kUnpredicted, {}, 0, true).chosen == 1);
}
