// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/diagnostics/map_verdict.hpp"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace tofmap {
namespace {

constexpr double voxel_m = 0.04;

/// What is known of a map of 100 frames, all of them registered, where the truth is not known and
/// there are no warnings.
MapEvidence good_evidence() {
  MapEvidence evidence;
  evidence.frames = 100;
  evidence.registered = 100;
  evidence.voxel_m = voxel_m;
  return evidence;
}

Verdict verdict_on(const MapEvidence& evidence) { return judge(evidence).verdict; }

/// The only reason to check a map.
std::string reason_to_check(const MapEvidence& evidence) {
  const Judgement judgement = judge(evidence);
  EXPECT_EQ(judgement.verdict, Verdict::check);
  EXPECT_EQ(judgement.reasons.size(), 1U);
  return judgement.reasons.empty() ? "" : judgement.reasons.front();
}

Verdict verdict_with_error(MapEvidence evidence, double accuracy_m) {
  evidence.accuracy_m = accuracy_m;
  return verdict_on(evidence);
}

TEST(Verdict, GoesByTheMapErrorInVoxels) {
  EXPECT_EQ(verdict_on_accuracy(0.04, voxel_m), Verdict::good);
  EXPECT_EQ(verdict_on_accuracy(0.041, voxel_m), Verdict::check);
  EXPECT_EQ(verdict_on_accuracy(0.2, voxel_m), Verdict::check);
  EXPECT_EQ(verdict_on_accuracy(0.201, voxel_m), Verdict::bad);
  EXPECT_EQ(verdict_on_accuracy(NAN, voxel_m), Verdict::bad) << "an empty map";
}

TEST(Verdict, GoesByTheFramesThatWereRegistered) {
  MapEvidence evidence = good_evidence();
  EXPECT_EQ(verdict_on(evidence), Verdict::good);
  evidence.registered = 95;
  EXPECT_EQ(verdict_on(evidence), Verdict::good);
  evidence.registered = 94;
  EXPECT_EQ(verdict_on(evidence), Verdict::check);
  evidence.registered = 49;
  EXPECT_EQ(verdict_on(evidence), Verdict::bad);
  EXPECT_EQ(verdict_on({}), Verdict::bad) << "no frame at all";
}

TEST(Verdict, SaysToCheckAMapThatIsNotTheOnlyOne) {
  MapEvidence evidence = good_evidence();
  evidence.registered = 60;
  evidence.separate = 38;
  evidence.separate_maps = 2;
  EXPECT_EQ(reason_to_check(evidence),
            "tracking was lost, and 2 other maps with 38 frames in total could not be joined with "
            "this one");
  evidence.registered = 45;
  evidence.separate = 53;
  EXPECT_EQ(verdict_on(evidence), Verdict::bad) << "most of the recording is elsewhere";
}

TEST(Verdict, GoesByDirectionsThatNoSurfaceConstrained) {
  MapEvidence evidence = good_evidence();
  evidence.position_sigma_m = 0.05;
  EXPECT_EQ(verdict_on(evidence), Verdict::good);
  evidence.position_sigma_m = 0.123;
  evidence.least_certain_frame = 17;
  EXPECT_EQ(
      reason_to_check(evidence),
      "the position at frame 17 is uncertain by 0.12 m (one standard deviation): the surfaces "
      "seen on the way there, or a gap in the recording, did not determine all directions of "
      "motion");
}

TEST(Verdict, OnAnExtensionOverlooksAFewUncertainFrames) {
  MapEvidence evidence = good_evidence();
  evidence.position_sigma_m = 0.123;
  evidence.uncertain = evidence.frames / 20;
  EXPECT_EQ(verdict_on_extension(evidence), Verdict::good);
  evidence.uncertain += 1;
  EXPECT_EQ(verdict_on_extension(evidence), Verdict::check) << "frames depend on an uncertain one";
  evidence.uncertain = 1;
  evidence.position_sigma_m = 0.3;
  EXPECT_EQ(verdict_on_extension(evidence), Verdict::check) << "it may be past the end of a wall";
}

TEST(Verdict, OnAnExtensionOverlooksFramesThatWereRegisteredSlowly) {
  MapEvidence evidence = good_evidence();
  evidence.registered_slowly = evidence.frames;
  EXPECT_EQ(verdict_on_extension(evidence), Verdict::good);
  EXPECT_EQ(verdict_on(evidence), Verdict::check);
}

TEST(Verdict, GoesByFramesThatWereRegisteredSlowly) {
  MapEvidence evidence = good_evidence();
  evidence.registered_slowly = 4;
  EXPECT_EQ(verdict_on(evidence), Verdict::good);
  evidence.registered_slowly = 5;
  EXPECT_EQ(reason_to_check(evidence),
            "5 % of the frames took many iterations to register: their surfaces, or noise, hardly "
            "determined some directions of motion");
}

TEST(Verdict, SaysToCheckAMapThatRecognisedPlacesContradict) {
  MapEvidence evidence = good_evidence();
  evidence.contradicted_loops = 1;
  EXPECT_EQ(verdict_on(evidence), Verdict::check);
  EXPECT_EQ(told_reasons(judge(evidence)), " Reasons: the map contradicts 1 recognised place.");
}

TEST(Verdict, SaysToCheckAMapThatWasFoundAgainByItsLookAlone) {
  MapEvidence evidence = good_evidence();
  evidence.joins = 1;
  evidence.blind_joins = 1;
  EXPECT_EQ(reason_to_check(evidence),
            "after more than two seconds without tracking, the camera was found again only by the "
            "look of the place (1 time), and another place may look the same");
}

TEST(Verdict, MentionsJoinsThatDoNotMakeItWorse) {
  MapEvidence evidence = good_evidence();
  evidence.joins = 2;
  EXPECT_EQ(verdict_on(evidence), Verdict::good);
  EXPECT_EQ(told_reasons(judge(evidence)),
            " Also: maps that began when tracking was lost were joined at recognised places "
            "(2 joins).");
}

TEST(Verdict, MentionsJoinsThatWereTakenBack) {
  MapEvidence evidence = good_evidence();
  evidence.joins_taken_back = 1;
  EXPECT_EQ(verdict_on(evidence), Verdict::good);
  EXPECT_EQ(told_reasons(judge(evidence)),
            " Also: 1 place looked like one seen before but proved to be another; the maps were "
            "separated again.");
}

TEST(Verdict, IsTheWorstOfAllThatIsKnown) {
  MapEvidence evidence = good_evidence();
  EXPECT_EQ(verdict_with_error(evidence, 0.01), Verdict::good);
  EXPECT_EQ(verdict_with_error(evidence, 1), Verdict::bad);
  MapEvidence wrapped = evidence;
  wrapped.is_unwrapped = false;
  EXPECT_EQ(verdict_with_error(wrapped, 0.05), Verdict::bad);
  MapEvidence empty = evidence;
  empty.is_empty = true;
  EXPECT_EQ(verdict_on(empty), Verdict::bad);
  evidence.is_interrupted = true;
  EXPECT_EQ(verdict_with_error(evidence, 0.01), Verdict::check);
  evidence.registered = 0;
  EXPECT_EQ(verdict_with_error(evidence, 0.05), Verdict::bad);
}

TEST(Verdict, IsNoBetterThanWhatCouldBeChecked) {
  MapEvidence evidence = good_evidence();
  evidence.is_seen_twice = false;
  EXPECT_EQ(verdict_on(evidence), Verdict::check);
  evidence.is_seen_twice = true;
  evidence.warnings = 1;
  EXPECT_EQ(verdict_on(evidence), Verdict::check);
}

TEST(Verdict, TellsItsReasons) {
  MapEvidence evidence = good_evidence();
  EXPECT_EQ(told_reasons(judge(evidence)), "");
  evidence.registered = 90;
  evidence.missing = {
      {Absence::damaged, 2}, {Absence::without_range, 7}, {Absence::unregistered, 1}};
  evidence.is_interrupted = true;
  EXPECT_EQ(told_reasons(judge(evidence)),
            " Reasons: 10 % of the frames are in no map (2 damaged, 7 without any range, 1 not "
            "registered); the run was interrupted.");
}

TEST(Verdict, OnRangesGoesByWrongWraps) {
  EXPECT_EQ(verdict_on_wraps(2), Verdict::good);
  EXPECT_EQ(verdict_on_wraps(2.1), Verdict::check);
  EXPECT_EQ(verdict_on_wraps(10), Verdict::check);
  EXPECT_EQ(verdict_on_wraps(10.1), Verdict::bad);
  EXPECT_EQ(verdict_on_wraps(NAN), Verdict::check) << "not known";
}

}  // namespace
}  // namespace tofmap
