// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "support/sample_frames.hpp"

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <support/temporary_folder.hpp>

#include <tofmap/acquisition/png_image.hpp>
#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

/// A whole sequence of two frames, for one thing at a time to go wrong in.
class BadSequence : public testing::Test {
 protected:
  BadSequence() : folder_(parent_.path() / "seq") {
    SequenceWriter writer(folder_, test::sample_sensor());
    for (int i = 0; i < 2; ++i) {
      writer.add(test::sample_frame(i), test::sample_pose(i), test::sample_range_truth());
    }
  }

  /// Expects that opening fails with a message that holds all of `parts`.
  void expect_refusal(const std::vector<std::string>& parts) const {
    try {
      const SequenceReader reader(folder_);
      ADD_FAILURE() << "opened; expected a complaint about " << parts.front();
    } catch (const InputError& error) {
      for (const std::string& part : parts) {
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos)
            << "'" << part << "' is not in: " << error.what();
      }
    }
  }

  /// Expects that frame 0 is damaged with a message that holds `part`, and frame 1 is whole.
  void expect_damage(const std::string& part) const {
    SequenceReader reader(folder_);
    const auto first = reader.next();
    ASSERT_TRUE(first);
    EXPECT_FALSE(first->frame);
    EXPECT_NE(first->damage.find(part), std::string::npos) << first->damage;
    const auto second = reader.next();
    ASSERT_TRUE(second);
    EXPECT_TRUE(second->frame) << second->damage;
    EXPECT_EQ(second->damage, "");
  }

  void replace(const char* file, const std::string& old_text, const std::string& new_text) const {
    std::ifstream in(folder_ / file);
    std::stringstream all;
    all << in.rdbuf();
    std::string text = all.str();
    const std::size_t at = text.find(old_text);
    ASSERT_NE(at, std::string::npos) << old_text << " is not in " << text;
    text.replace(at, old_text.size(), new_text);
    std::ofstream(folder_ / file) << text;
  }

  test::TemporaryFolder parent_;
  std::filesystem::path folder_;
};

TEST_F(BadSequence, FolderIsMissing) {
  std::filesystem::remove_all(folder_);
  expect_refusal({"seq", "no such folder"});
}

TEST_F(BadSequence, FolderIsAFile) {
  std::filesystem::remove_all(folder_);
  std::ofstream(folder_) << "x";
  expect_refusal({"seq", "is a file; give its folder"});
}

TEST_F(BadSequence, HeaderIsMissing) {
  std::filesystem::remove(folder_ / "sequence.yaml");
  expect_refusal({"sequence.yaml", "cannot be read"});
}

TEST_F(BadSequence, FrameListIsMissing) {
  std::filesystem::remove(folder_ / "frames.txt");
  expect_refusal({"frames.txt", "cannot be read"});
}

TEST_F(BadSequence, FrameListIsEmpty) {
  std::ofstream(folder_ / "frames.txt") << "# nothing came\n\n";
  expect_refusal({"frames.txt", "no frames"});
}

TEST_F(BadSequence, HeaderIsNoYaml) {
  std::ofstream(folder_ / "sequence.yaml") << "format: [tofmap\n";
  expect_refusal({"sequence.yaml", "YAML"});
}

TEST_F(BadSequence, HeaderIsNoMap) {
  std::ofstream(folder_ / "sequence.yaml") << "tofmap-sequence\n";
  expect_refusal({"sequence.yaml", "map"});
}

TEST_F(BadSequence, FormatIsAnothersOrLaterOne) {
  replace("sequence.yaml", "tofmap-sequence", "other-sequence");
  expect_refusal({"sequence.yaml", "format", "other-sequence"});
  replace("sequence.yaml", "other-sequence", "tofmap-sequence");
  replace("sequence.yaml", "version: 1", "version: 3");
  expect_refusal({"sequence.yaml", "version", "3"});
}

TEST_F(BadSequence, KeyIsMissing) {
  replace("sequence.yaml", "fx:", "# fx:");
  expect_refusal({"sequence.yaml", "camera.fx", "missing"});
}

TEST_F(BadSequence, SectionIsMissing) {
  replace("sequence.yaml", "modulation:", "# modulation:");
  expect_refusal({"sequence.yaml"});
}

TEST_F(BadSequence, KeyIsUnknown) {
  replace("sequence.yaml", "max_range_m", "max_range");
  expect_refusal({"sequence.yaml", "max_range", "unknown", "max_range_m"});
}

TEST_F(BadSequence, ValueIsOfAnotherKind) {
  replace("sequence.yaml", "width: 7", "width: wide");
  expect_refusal({"sequence.yaml", "camera.width", "wide"});
}

TEST_F(BadSequence, DistortionHasFourNumbers) {
  replace("sequence.yaml", ", 0.005]", "]");
  expect_refusal({"sequence.yaml", "camera.distortion", "k1 k2 p1 p2 k3"});
}

TEST_F(BadSequence, CameraIsImpossible) {
  replace("sequence.yaml", "width: 7", "width: -7");
  expect_refusal({"sequence.yaml", "width"});
  replace("sequence.yaml", "width: -7", "width: 2000000000");
  expect_refusal({"sequence.yaml", "width"});
}

TEST_F(BadSequence, FrequenciesAreEqual) {
  replace("sequence.yaml", "frequency_b_hz: 3.1e+07", "frequency_b_hz: 29.0e6");
  expect_refusal({"sequence.yaml", "equal"});
}

TEST_F(BadSequence, MaximumRangeIsNotAboveZero) {
  for (const char* value : {"0", "-3", ".nan", ".inf"}) {
    replace("sequence.yaml", "12.75", value);
    expect_refusal({"sequence.yaml", "max_range_m"});
    replace("sequence.yaml", std::string("max_range_m: ") + value, "max_range_m: 12.75");
  }
}

TEST_F(BadSequence, MaximumRangeNeedsTooManyWraps) {
  replace("sequence.yaml", "12.75", "1e9");
  expect_refusal({"sequence.yaml", "max_range_m", "255 wavelengths"});
}

TEST_F(BadSequence, LineNamesAFileTwice) {
  for (const char* files : {"phase_a/000000.png phase_a/000000.png",
                            "phase_a/000000.png phase_b/000000.png phase_a/000000.png"}) {
    std::ofstream(folder_ / "frames.txt") << "0 " << files << '\n';
    expect_refusal({"frames.txt:1", "'phase_a/000000.png' twice"});
  }
  std::ofstream(folder_ / "frames.txt") << "0 phase_a/000000.png phase_b/000000.png - -\n";
  EXPECT_NO_THROW(SequenceReader{folder_});
}

TEST_F(BadSequence, LineHasTooFewOrTooManyColumns) {
  std::ofstream(folder_ / "frames.txt") << "# c\n0 phase_a/000000.png\n";
  expect_refusal({"frames.txt:2", "2 column"});
  std::ofstream(folder_ / "frames.txt") << "0 a b c d e\n";
  expect_refusal({"frames.txt:1", "6 column"});
}

TEST_F(BadSequence, ALineThatIsNotUnderstoodDamagesOneFrame) {
  const std::string good = "5 phase_a/000001.png phase_b/000001.png\n";
  for (const std::string bad :
       {"0 phase_a/000000.png", "noon phase_a/000000.png phase_b/000000.png",
        "0 - phase_b/000000.png", "0 ../000000.png phase_b/000000.png", "\xff\xfe"}) {
    std::ofstream(folder_ / "frames.txt") << bad << '\n' << good;
    expect_damage("frames.txt:1");
    EXPECT_FALSE(SequenceReader(folder_).range_truth(0));
    EXPECT_EQ(SequenceReader(folder_).files()[0].timestamp_s, 5) << "of the first that is known";
  }
}

TEST_F(BadSequence, AListMostlyNotUnderstoodIsNone) {
  std::ofstream(folder_ / "frames.txt") << "no\nlist\n5 phase_a/000001.png phase_b/000001.png\n";
  expect_refusal({"frames.txt:1", "2 of 3 lines are damaged"});
}

TEST_F(BadSequence, TimestampIsNoNumber) {
  for (const char* time : {"noon", "1.5x", "nan", "inf", "-"}) {
    std::ofstream(folder_ / "frames.txt") << time << " phase_a/000000.png phase_b/000000.png\n";
    expect_refusal({"frames.txt:1", time});
  }
}

TEST_F(BadSequence, PhaseIsLeftOut) {
  std::ofstream(folder_ / "frames.txt") << "0 - phase_b/000000.png\n";
  expect_refusal({"frames.txt:1", "amplitude"});
}

TEST_F(BadSequence, PathLeadsOutOfTheFolder) {
  for (const char* path : {"../000000.png", "phase_a/../../x.png", "/etc/passwd"}) {
    std::ofstream(folder_ / "frames.txt") << "0 " << path << " phase_b/000000.png\n";
    expect_refusal({"frames.txt:1", path});
  }
}

TEST_F(BadSequence, TimestampThatStandsStillDamagesTheLaterFrame) {
  std::ofstream(folder_ / "frames.txt") << "2 phase_a/000000.png phase_b/000000.png\n"
                                        << "2 phase_a/000001.png phase_b/000001.png\n"
                                        << "1 phase_a/000001.png phase_b/000001.png\n"
                                        << "3 phase_a/000001.png phase_b/000001.png\n";
  const SequenceReader reader(folder_);
  EXPECT_TRUE(reader.read(0).frame);
  EXPECT_FALSE(reader.read(1).frame);
  EXPECT_NE(reader.read(1).damage.find("timestamp"), std::string::npos);
  EXPECT_FALSE(reader.read(2).frame);
  EXPECT_TRUE(reader.read(3).frame);
}

TEST_F(BadSequence, TimestampFarAheadDamagesThatFrameAlone) {
  std::ofstream(folder_ / "frames.txt") << "0 phase_a/000000.png phase_b/000000.png\n"
                                        << "999 phase_a/000001.png phase_b/000001.png\n"
                                        << "1 phase_a/000001.png phase_b/000001.png\n"
                                        << "2 phase_a/000001.png phase_b/000001.png\n"
                                        << "3 phase_a/000001.png phase_b/000001.png\n";
  const SequenceReader reader(folder_);
  EXPECT_NE(reader.read(1).damage.find("999"), std::string::npos);
  for (const int i : {0, 2, 3, 4}) EXPECT_TRUE(reader.read(i).frame) << i;
}

TEST_F(BadSequence, ByteOrderMarkBeforeTheListIsPassedOver) {
  std::ofstream(folder_ / "frames.txt") << "\xEF\xBB\xBF# timestamp phase_a phase_b\n"
                                        << "0 phase_a/000000.png phase_b/000000.png\n";
  EXPECT_EQ(SequenceReader(folder_).frame_count(), 1);
}

TEST_F(BadSequence, MissingImageDamagesOneFrame) {
  std::filesystem::remove(folder_ / "phase_b/000000.png");
  expect_damage("phase_b/000000.png");
}

TEST_F(BadSequence, MissingAmplitudeThatIsListedDamagesOneFrame) {
  std::filesystem::remove(folder_ / "amplitude_a/000000.png");
  expect_damage("amplitude_a/000000.png");
}

TEST_F(BadSequence, TruncatedImageDamagesOneFrame) {
  std::filesystem::resize_file(folder_ / "phase_a/000000.png", 60);
  expect_damage("phase_a/000000.png");
}

TEST_F(BadSequence, ImageOfAnotherSizeDamagesOneFrame) {
  write_png(folder_ / "amplitude_b/000000.png", ImageU16(ImageU16::Ones(7, 5)));
  expect_damage("amplitude_b/000000.png");
}

TEST_F(BadSequence, ImageOf8BitsDamagesOneFrame) {
  write_png(folder_ / "phase_a/000000.png", ImageU8(ImageU8::Ones(5, 7)));
  expect_damage("phase_a/000000.png");
}

TEST_F(BadSequence, TruthThatIsDamagedIsNamed) {
  std::filesystem::resize_file(folder_ / "range_truth/000000.png", 50);
  std::ofstream(folder_ / "groundtruth.txt") << "0 1 2 3\n";
  const SequenceReader reader(folder_);
  EXPECT_TRUE(reader.read(0).frame);
  EXPECT_THROW(reader.range_truth(0), InputError);
  EXPECT_THROW(reader.ground_truth(), InputError);
}

TEST_F(BadSequence, FrameNumberOutsideTheSequenceIsWrongUse) {
  const SequenceReader reader(folder_);
  EXPECT_THROW(reader.read(-1), UsageError);
  EXPECT_THROW(reader.read(2), UsageError);
}

}  // namespace
}  // namespace tofmap
