#include <catch2/catch.hpp>
#include <numeric>
#include <set>

#include "motion/motion_selection.hpp"
#include "motion/motion_step.hpp"

using namespace quadedge::odometry;

namespace {

/// A motion that explains an area of the image and leaves nothing ambiguous.
Verdict found(double area, double support = 0.5) {
  Verdict verdict;
  verdict.refusal = Refusal::none;
  verdict.support = support;
  verdict.area = area;
  return verdict;
}

Verdict closely(double area) {
  Verdict verdict = found(area);
  verdict.has_all_inliers = false;
  return verdict;
}

Verdict moving(Verdict verdict, double ratio) {
  verdict.moving_ratio = ratio;
  return verdict;
}

Verdict at_rest(Verdict verdict, double ratio) {
  verdict.static_ratio = ratio;
  return verdict;
}

Verdict still(Verdict verdict, double still_ratio, double around_ratio) {
  verdict.still_ratio = still_ratio;
  verdict.around_ratio = around_ratio;
  return verdict;
}

const Verdict kFailure;
const Expectation kPredicted{0, false, 0.35}, kDoubtful{0, true, 0.35}, kUnpredicted{std::nullopt, false, 0.35};

/// The completed verdict on the motion chosen, and its index.
struct Choice : Verdict {
  std::size_t chosen = 0;
};

/// Motions with the same number are the same; by default, all differ. \param shared fraction of a motion's explained
/// area that the others explain, too \param repeats whether they differ by periods of a scene that repeats
Choice choose(std::vector<Verdict> verdicts, const Expectation& expectation, std::vector<int> motion = {},
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

SearchLevel needed(const Verdict& prediction, const Expectation& expectation = kPredicted) {
  return choose({prediction}, expectation).needed;
}

}  // namespace

TEST_CASE("motion selection: how much is tried depends on what the prediction leaves open", "[odometry]") {
  CHECK(needed(found(0.8)) == SearchLevel::prediction);
  CHECK(needed(moving(found(0.8), 0.3)) == SearchLevel::inexpensive);
  CHECK(needed(at_rest(found(0.8), 0.06)) == SearchLevel::inexpensive);
  CHECK(needed(moving(found(0.8), 0.6)) == SearchLevel::everything);
  CHECK(needed(found(0.8, 0.34)) == SearchLevel::everything);
  CHECK(needed(kFailure) == SearchLevel::everything);
  CHECK(needed(found(0.8), kDoubtful) == SearchLevel::everything);
  CHECK(needed(found(0.8), kUnpredicted) == SearchLevel::everything);
  // An inexpensive hypothesis that explains more than the prediction, and one that does not.
  const Verdict prediction = moving(found(0.5), 0.3);
  CHECK(choose({prediction, closely(0.6)}, kPredicted).needed == SearchLevel::everything);
  CHECK(choose({prediction, closely(0.4)}, kPredicted).needed == SearchLevel::inexpensive);
}

TEST_CASE("motion selection: the motion that explains the largest area is chosen", "[odometry]") {
  CHECK(choose({found(0.3), found(0.5), found(0.4)}, kPredicted).chosen == 1);
  CHECK(choose({kFailure, found(0.01)}, kPredicted).chosen == 1);
  CHECK(choose({kFailure, kFailure}, kPredicted).refusal == Refusal::no_consensus);
  CHECK(choose({found(0.4), found(0.4)}, kPredicted).chosen == 1);  // not the prediction
  CHECK(choose({found(0.4), found(0.4)}, kUnpredicted).chosen == 0);
  CHECK(choose({kFailure, kFailure, kFailure}, kPredicted).chosen == 1);
  Verdict failure;
  failure.area = 0.9;  // has no meaning
  CHECK(choose({found(0.2), failure}, kPredicted).chosen == 0);
}

TEST_CASE("motion selection: a close agreement gives way to the same motion with all of its inliers", "[odometry]") {
  const std::vector<Verdict> verdicts{found(0.3), closely(0.6), found(0.5)};
  CHECK(choose(verdicts, kPredicted).chosen == 1);
  CHECK(choose(verdicts, kPredicted, {0, 1, 1}).chosen == 2);
  CHECK(choose({closely(0.3), closely(0.6)}, kUnpredicted, {0, 0}).chosen == 1);
  CHECK(choose({kFailure, closely(0.6)}, kPredicted, {0, 0}).chosen == 1);
}

TEST_CASE("motion selection: what was not expected has to agree with the global matches", "[odometry]") {
  Verdict contradicted = found(0.8);
  contradicted.agrees_globally = false;
  CHECK(choose({contradicted}, kPredicted).refusal == Refusal::none);  // confident
  contradicted.support = 0.34;
  CHECK(choose({contradicted}, kPredicted).refusal == Refusal::contradicted);
  contradicted.support = 0.5;
  CHECK(choose({kFailure, contradicted}, kPredicted).refusal == Refusal::contradicted);
  CHECK(choose({contradicted}, kUnpredicted).refusal == Refusal::contradicted);
  CHECK(choose({found(0.8, 0.1)}, kUnpredicted).refusal == Refusal::none);
}

TEST_CASE("motion selection: every ambiguity is told with its ratio", "[odometry]") {
  const auto ambiguity = [](const std::vector<Verdict>& verdicts, std::vector<int> motion = {}) {
    return choose(verdicts, kPredicted, std::move(motion)).ambiguity;
  };
  CHECK_FALSE(ambiguity({found(0.5)}).exists());
  CHECK_FALSE(ambiguity({kFailure}).exists());
  CHECK_FALSE(ambiguity({moving(found(0.5), 0.49)}).exists());
  const Ambiguity moving_image = ambiguity({moving(found(0.5), 0.6)});
  CHECK(moving_image.kind == AmbiguityKind::moving_image);
  CHECK(moving_image.ratio == 0.6);
  const Ambiguity static_scene = ambiguity({at_rest(found(0.5), 0.07)});
  CHECK(static_scene.kind == AmbiguityKind::static_scene);
  CHECK(static_scene.ratio == 0.07);
  const Ambiguity sides = ambiguity({still(found(0.5), 0.9, 0.1)});
  CHECK(sides.kind == AmbiguityKind::moving_sides);
  CHECK(sides.ratio == 0.1);
  CHECK_FALSE(ambiguity({still(found(0.5), 0.9, 0.04)}).exists());
  CHECK_FALSE(ambiguity({still(found(0.5), 0.7, 0.1)}).exists());
  const Ambiguity competing = ambiguity({found(0.5), found(0.1), found(0.3), found(0.25), kFailure});
  CHECK(competing.kind == AmbiguityKind::competing_motion);
  CHECK(competing.ratio == Approx(0.6));
  CHECK_FALSE(ambiguity({found(0.5), found(0.19)}).exists());
  CHECK_FALSE(ambiguity({found(0.5), found(0.3)}, {0, 0}).exists());
  CHECK(ambiguity({found(0), found(0)}).kind == AmbiguityKind::competing_motion);
  const Ambiguity other_part = ambiguity_of({0.2, 0.5, 0.4, 0.6}, false);
  CHECK(other_part.kind == AmbiguityKind::other_part);
  CHECK(other_part.ratio == 0.2);
  std::set<std::string> texts;
  CHECK_FALSE(to_string({AmbiguityKind::recent_other_part, 0}).empty());
  for (const Ambiguity& each : {moving_image, static_scene, sides, competing, other_part})
    texts.insert(to_string(each));
  CHECK(texts.size() == 5);
  for (const auto& text : texts) CHECK(text.find(" %") != std::string::npos);
}

TEST_CASE("motion selection: an ambiguous motion is refused where it is no answer", "[odometry]") {
  const auto decided = [](Verdict verdict, bool accepts_ambiguous, const Ambiguity& later = {}) {
    decide(accepts_ambiguous, later, verdict);
    return verdict.refusal;
  };
  const Ambiguity later{AmbiguityKind::other_part, 0.2};
  const Choice ambiguous = choose({found(0.5), found(0.3)}, kPredicted);
  CHECK(decided(ambiguous, true) == Refusal::none);
  CHECK(decided(ambiguous, false) == Refusal::ambiguous);
  CHECK(decided(found(0.5), false) == Refusal::none);
  CHECK(decided(found(0.5), false, later) == Refusal::ambiguous);
  CHECK(decided(found(0.5), true, later) == Refusal::none);
  CHECK(decided(kFailure, false, later) == Refusal::no_consensus);
}

TEST_CASE("motion selection: edges of distant views that are not found again are no second motion", "[odometry]") {
  Verdict confirmed = moving(found(0.5), 0.6);
  confirmed.global_ratio = 0.5;
  CHECK_FALSE(choose({confirmed}, kPredicted).ambiguity.exists());
  // Fewer global matches suffice if the rest of them propose nothing, in as many places as a pose needs.
  confirmed.global_ratio = 0.2;
  confirmed.rival_ratio = 0.4;
  CHECK_FALSE(choose({confirmed}, kPredicted).ambiguity.exists());
  Verdict elsewhere = confirmed, sparse = confirmed, unknown = confirmed;
  elsewhere.rival_ratio = 0.6;
  sparse.agrees_globally = false;
  unknown.global_ratio = unknown.rival_ratio = 0;
  for (const Verdict& doubtful : {elsewhere, sparse, unknown})
    CHECK(choose({doubtful}, kPredicted).ambiguity.kind == AmbiguityKind::moving_image);
  // A competing motion counts by what the chosen one does not explain.
  CHECK(choose({found(0.5), found(0.3)}, kPredicted, {}, 0.3).ambiguity.ratio == Approx(0.42));
  CHECK_FALSE(choose({found(0.5), found(0.3)}, kPredicted, {}, 0.4).ambiguity.exists());
}

TEST_CASE("motion selection: another part of the image counts by its area, a smaller one if it is on all sides",
          "[odometry]") {
  CHECK_FALSE(ambiguity_of(OtherPart(), false).exists());
  CHECK(ambiguity_of({0.1, 0.5, 0.1, 0.5}, false).exists());
  CHECK_FALSE(ambiguity_of({0.05, 0.5, 0.1, 0.5}, false).exists());  // an object
  CHECK(ambiguity_of({0.05, 0.5, 0.9, 0.8}, false).exists());
  CHECK_FALSE(ambiguity_of({0.01, 0.5, 0.9, 0.8}, false).exists());
  CHECK(ambiguity_of({0.05, 0.4, 0.1, 0.5}, true).exists());  // after an ambiguous motion
  CHECK_FALSE(ambiguity_of({0.005, 0.5, 0.9, 0.8}, true).exists());
  CHECK_FALSE(ambiguity_of({0.1, 0.05, 0.9, 0.5}, false).exists());  // most of what was searched does not follow
}

TEST_CASE("motion selection: a car that passes is no doubt, even after a doubt", "[odometry]") {
  // 9 % of the image, seven tenths of what does not follow the camera's motion, which 75 % follow.
  CHECK_FALSE(ambiguity_of({0.09, 0.7, 0.3, 0.75}, false).exists());
  CHECK_FALSE(ambiguity_of({0.04, 0.7, 0.3, 0.75}, true).exists());
  // Two cars, one on either side, at the same height of the image.
  CHECK_FALSE(ambiguity_of({0.08, 0.7, 0.4, 0.75}, false).exists());
  // The same area of the scene, beside a bus that fills most of the image.
  CHECK(ambiguity_of({0.09, 0.7, 0.3, 0.45}, false).exists());
}

TEST_CASE("motion selection: what a motion between distant views leaves at near edges is no other motion",
          "[odometry]") {
  // As between keyframes 2 m apart in a street: few of the cells that do not follow, and next to no matches.
  OtherPart part{0.102, 0.175, 1.0, 0.42};
  part.balance = 0.03;
  CHECK_FALSE(ambiguity_of(part, false).exists());
  CHECK_FALSE(ambiguity_of(part, true).exists());
  CHECK(ambiguity_of(part, false, true).exists());  // in the first frames no motion before speaks for the chosen one
  part.spread = 0.2;
  CHECK_FALSE(ambiguity_of(part, false, true).exists());
  part.spread = 1.0;
  part.balance = 0.25;  // the matches follow it
  CHECK(ambiguity_of(part, false).exists());
}

TEST_CASE("motion selection: a rare motion does not win against the prediction and four times the evidence",
          "[odometry]") {
  // Of two equal posters one appears in the place of the other: the jump fits nearly all that it leaves in view.
  const auto of = [](double area, int inliers, int followed) {
    Verdict verdict = moving(found(area), 0.55);
    verdict.inliers = inliers;
    verdict.followed = followed;
    return verdict;
  };
  const Verdict true_motion = of(0.4, 7360, 180), jump = of(0.7, 1631, 60);
  const Choice choice = choose({true_motion, jump}, kPredicted);
  CHECK(choice.chosen == 0);
  CHECK(choice.ambiguity.exists());
  CHECK(choose({true_motion, jump}, kUnpredicted).chosen == 1);              // nothing is known of the motion
  CHECK(choose({true_motion, of(0.7, 1900, 60)}, kPredicted).chosen == 1);   // nearly as much evidence
  CHECK(choose({true_motion, of(0.7, 1631, 200)}, kPredicted).chosen == 1);  // fewer edges, over more of the image
  CHECK(choose({kFailure, jump}, kPredicted).chosen == 1);
}

TEST_CASE("motion selection: another motion on all sides counts if more matches follow it than the chosen one",
          "[odometry]") {
  const auto is_doubtful = [](double balance, double spread, bool agrees, bool was_ambiguous) {
    OtherPart part{0.01, 0.05, 0.9};
    part.balance = balance;
    part.match_spread = spread;
    part.agrees_globally = agrees;
    return ambiguity_of(part, was_ambiguous).exists();
  };
  CHECK(is_doubtful(1.2, 0.7, true, false));
  CHECK_FALSE(is_doubtful(0.9, 0.7, true, false));
  CHECK_FALSE(is_doubtful(1.2, 0.5, true, false));   // an object
  CHECK(is_doubtful(0.3, 0.5, true, true));          // after an ambiguous motion
  CHECK_FALSE(is_doubtful(1.2, 0.7, false, false));  // in too few places
  OtherPart gathered{0.01, 0.05, 0.2};               // a small part in one place, after an ambiguous motion
  gathered.chosen_area = 1;
  gathered.balance = 0.5;
  gathered.match_spread = 0.1;
  gathered.agrees_globally = true;
  CHECK_FALSE(ambiguity_of(gathered, true).exists());
  gathered.match_spread = 0.5;
  CHECK(ambiguity_of(gathered, true).exists());
  OtherPart rest{0.2, 0.5, 0.9, 0.5};
  CHECK(ambiguity_of(rest, false).exists());
  rest.is_rest = true;  // has to prevail: its area alone is no evidence
  CHECK_FALSE(ambiguity_of(rest, false).exists());
}

TEST_CASE("motion selection: after most of the image has changed, the next three frames are searched", "[odometry]") {
  const auto searches_after = [](double before, double changed) {
    TrackRecord record{quadedge::Config()};
    MotionStep step;
    step.clear();
    step.verdict = moving(found(0.5), before);
    step.is_checked = true;
    for (int frame = 0; frame < 3; ++frame) record.remember(step);  // the first ones
    step.verdict = moving(found(0.5), changed);
    record.remember(step);
    int searches = 0;
    step.verdict = moving(found(0.5), 0.05);  // what has appeared is followed
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

TEST_CASE("motion selection: another part of the image is remembered for three searches", "[odometry]") {
  TrackRecord record{quadedge::Config()};
  MotionStep step;
  step.clear();
  step.verdict.refusal = Refusal::none;
  step.is_checked = true;
  record.remember(step);
  CHECK_FALSE(record.recent_other_part().exists());
  step.shows_other_part = true;
  step.verdict.ambiguity = {AmbiguityKind::other_part, 0.1};
  record.remember(step);
  step.shows_other_part = false;
  for (int search = 0; search < 3; ++search) {
    CHECK(record.recent_other_part().exists());
    CHECK(record.is_check_due(Verdict()));
    step.verdict.ambiguity = record.recent_other_part();
    record.remember(step);
  }
  CHECK_FALSE(record.recent_other_part().exists());
  // What is found beside another ambiguity, with lower limits, is not remembered.
  step.verdict.ambiguity = {AmbiguityKind::moving_image, 0.7};
  record.remember(step);
  step.shows_other_part = true;
  record.remember(step);
  CHECK_FALSE(record.recent_other_part().exists());
  // A loss ends the memory.
  step.verdict.ambiguity = {};
  step.shows_other_part = false;
  record.remember(step);
  step.shows_other_part = true;
  record.remember(step);
  REQUIRE(record.recent_other_part().exists());
  step.verdict.refusal = Refusal::no_consensus;
  step.is_checked = step.shows_other_part = false;
  record.remember(step);
  CHECK_FALSE(record.recent_other_part().exists());
}

TEST_CASE("motion selection: a motion that differs by a period does not take the place of the prediction's",
          "[odometry]") {
  const std::vector<Verdict> verdicts = {found(0.3), found(0.8)};
  CHECK(choose(verdicts, kPredicted).chosen == 1);
  CHECK_FALSE(choose(verdicts, kPredicted).is_predicted);
  const Choice kept = choose(verdicts, kPredicted, {}, 0, true);
  CHECK(kept.chosen == 0);
  CHECK(kept.is_predicted);
  CHECK_FALSE(choose(verdicts, kDoubtful, {}, 0, true).is_predicted);
  CHECK(choose(verdicts, kUnpredicted, {}, 0, true).chosen == 1);
}
