// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/correlation_arrays.hpp>
#include <support/temporary_folder.hpp>

#include <tofmap/acquisition/correlation/correlation_description.hpp>

namespace tofmap {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

class CorrelationDescriptionFile : public testing::Test {
 protected:
  /// The complaint about the whole description with `was` replaced by `is`.
  std::string complaint(const std::string& was, const std::string& is) const {
    std::string text =
        "format: tofmap-correlation\n"
        "version: 1\n"
        "camera: {width: 5, height: 3, fx: 4, fy: 4, cx: 2, cy: 1}\n"
        "frequencies_hz: [80.0e6, 100.0e6]\n"
        "step_angles_deg: [0, 90, 180, 270]\n"
        "phase_sign: 1\n"
        "steps: single_ended\n"
        "data: {files: a.npy, axes: [frame, frequency, step, row, column]}\n"
        "values: {bits: 12}\n"
        "dark: {value: 3}\n"
        "phase_offsets: {cycles: [0, 0]}\n"
        "timestamps: {rate_hz: 30}\n";
    const std::size_t found = text.find(was);
    if (found == std::string::npos) return "the test replaces what is not there";
    text.replace(found, was.size(), is);
    const fs::path file = folder_.path() / "camera.yaml";
    std::ofstream(file) << text;
    const std::string message = test::input_error([&] { read_correlation_description(file); });
    return message.empty() || message.find("camera.yaml") != std::string::npos
               ? message
               : "the file is not named: " + message;
  }

  std::string of_data(const std::string& data) const {
    return complaint("{files: a.npy, axes: [frame, frequency, step, row, column]}", data);
  }
  std::string of_values(const std::string& values) const { return complaint("{bits: 12}", values); }

  test::TemporaryFolder folder_;
};

TEST_F(CorrelationDescriptionFile, HasMetresNotMillimetresAndRadiansNotDegrees) {
  EXPECT_THAT(complaint("phase_sign", "max_range_m: 18700\nphase_sign"),
              HasSubstr("give metres, not millimetres"));
  EXPECT_EQ(complaint("phase_sign", "max_range_m: 18.7\nphase_sign"), "");
  EXPECT_THAT(complaint("step_angles_deg", "step_angles_rad"), HasSubstr("step_angles_deg"));
  EXPECT_EQ(
      complaint("step_angles_deg: [0, 90, 180, 270]", "step_angles_rad: [0, 1.57, 3.14, 4.7]"), "");
}

TEST_F(CorrelationDescriptionFile, ThatIsWholeNeedsNoOtherFile) {
  EXPECT_EQ(complaint("version: 1", "version: 1"), "");
}

TEST_F(CorrelationDescriptionFile, WithWrongKeysNamesThemAndWhatIsAllowed) {
  EXPECT_THAT(complaint("tofmap-correlation", "tofmap-sequence"), HasSubstr("tofmap-correlation"));
  EXPECT_THAT(complaint("version: 1", "version: 2"), HasSubstr("version is 2"));
  EXPECT_THAT(complaint("phase_sign", "phase_sgn"), HasSubstr("phase_sgn is an unknown key"));
  EXPECT_THAT(complaint("{value: 3}", "{[]: 3}"), HasSubstr("dark must have words as keys"));
  EXPECT_THAT(complaint("phase_sign: 1", "phase_sign: 0"),
              HasSubstr("phase_sign must be 1 or -1, not 0"));
  EXPECT_THAT(complaint("phase_sign: 1\n", ""), HasSubstr("phase_sign is missing"));
  EXPECT_THAT(complaint("single_ended", "double"),
              HasSubstr("steps must be differential or single_ended, not 'double'"));
  EXPECT_THAT(complaint("{rate_hz: 30}", "{rate_hz: 0}"),
              HasSubstr("timestamps.rate_hz must be above 0"));
  EXPECT_THAT(complaint("{rate_hz: 30}", "{rate_hz: 30, times_s: [1]}"), HasSubstr("exactly one"));
  EXPECT_THAT(complaint("{rate_hz: 30}", "{file: t, unit: h}"),
              HasSubstr("must be s, ms, us or ns"));
  EXPECT_THAT(complaint("{value: 3}", "{value: three}"),
              HasSubstr("dark.value must be a number, not 'three'"));
  EXPECT_THAT(complaint("{value: 3}", "{}"), HasSubstr("dark.value or files"));
  EXPECT_THAT(complaint("{value: 3}", "{files: d.npy, axes: [frame, row, column]}"),
              HasSubstr("dark.axes must not have 'frame'"));
  EXPECT_THAT(complaint("{cycles: [0, 0]}", "{cycles: [0]}"),
              HasSubstr("phase_offsets.cycles has 1 entries, but there are 2 frequencies"));
  EXPECT_THAT(complaint("{cycles: [0, 0]}", "{cycles: [0, .nan]}"),
              HasSubstr("phase_offsets.cycles"));
  EXPECT_THAT(
      complaint("{cycles: [0, 0]}", "{per_pixel: {files: o.npy, axes: [row, column], unit: mm}}"),
      HasSubstr("must be cycles, radians or metres"));
  EXPECT_THAT(complaint("version: 1\n", "version: 1\nmax_range_m: -1\n"), HasSubstr("max_range_m"));
  EXPECT_THAT(complaint("version: 1\n", "version: 1\nexposure_offsets_s: [0]\n"),
              HasSubstr("exposure_offsets_s has 1 entries"));
  EXPECT_THAT(complaint("version: 1\n", "version: 1\namplitude: {min: 5, max: 4}\n"),
              HasSubstr("amplitude.max"));
}

TEST_F(CorrelationDescriptionFile, OfAnImplausibleCameraIsRefused) {
  EXPECT_THAT(complaint("fx: 4", "fx: 40000"), HasSubstr("fx and fy"));
  EXPECT_THAT(complaint("width: 5", "width: 0"), HasSubstr("width"));
  EXPECT_THAT(complaint("width: 5", "width: 500000"), HasSubstr("16384"));
  EXPECT_THAT(complaint("[80.0e6, 100.0e6]", "[80, 100]"), HasSubstr("29e6"));
  EXPECT_THAT(complaint("[80.0e6, 100.0e6]", "[80.0e6, 80.00001e6]"),
              AllOf(HasSubstr(".yaml: modulation: "), HasSubstr("are equal")));
  EXPECT_THAT(complaint("[80.0e6, 100.0e6]", "[]"), HasSubstr("one to 8"));
  EXPECT_THAT(complaint("[80.0e6, 100.0e6]", "80.0e6"), HasSubstr("list of frequencies"));
}

TEST_F(CorrelationDescriptionFile, OfAnglesThatDetermineNoPhaseIsRefused) {
  EXPECT_THAT(complaint("[0, 90, 180, 270]", "[0, 90]"), HasSubstr("at least 3 steps"));
  EXPECT_THAT(complaint("[0, 90, 180, 270]", "[0, 1, 2, 3]"),
              HasSubstr("0, 1, 2, 3 degrees do not span"));
  EXPECT_THAT(complaint("_deg: [0, 90, 180, 270]", "_rad: [0, 1.5708, 3.1416, 4.7124]"), "");
  EXPECT_THAT(complaint("[0, 90, 180, 270]", "[[0, 120, 240]]"), HasSubstr("1 entries"));
  EXPECT_THAT(complaint("[0, 90, 180, 270]", "[[0, 120, 240], [0, .inf, 3]]"),
              HasSubstr("step_angles_deg"));
  EXPECT_THAT(complaint("version: 1\n", "version: 1\nstep_angles_rad: [0, 2, 4]\n"),
              HasSubstr("not both"));
}

TEST_F(CorrelationDescriptionFile, WithContradictoryAxesIsRefused) {
  EXPECT_THAT(of_data("{files: a.npy, axes: [frame, frequency, row, column]}"),
              HasSubstr("data.axes must have 'step', of size 4"));
  EXPECT_THAT(of_data("{files: a.npy, axes: [frame, step, row, column]}"),
              HasSubstr("'frequency'"));
  EXPECT_THAT(of_data("{files: a.npy, axes: [frame, frequency, step, row]}"),
              HasSubstr("'column'"));
  EXPECT_THAT(of_data("{files: a.npy, axes: [frame, frame, row, column]}"), HasSubstr("twice"));
  EXPECT_THAT(of_data("{files: a.npy, axes: [time, row, column]}"),
              HasSubstr("unknown axis 'time'"));
  EXPECT_THAT(of_data("{files: \"a{step}.npy\", axes: [frame, frequency, step, row, column]}"),
              HasSubstr("only one of them"));
  EXPECT_THAT(of_data("{files: \"a{stop}.npy\", axes: [row, column]}"),
              HasSubstr("unknown field {stop}"));
  EXPECT_THAT(of_data("{files: \"a{step.npy\", axes: [row, column]}"), HasSubstr("{ without }"));
  EXPECT_THAT(of_data("{files: \"a{frame:x}.npy\", axes: [row, column]}"), HasSubstr("{frame:x}"));
  EXPECT_THAT(of_data("{files: a.npy, axes: [frame, image, row, column]}"),
              HasSubstr("data.images is missing"));
  EXPECT_THAT(
      of_data("{files: a.npy, axes: [frame, image, row, column], images: [[0, 0], [0, 1]]}"),
      HasSubstr("names 2 images, but there are 8 step angles"));
  EXPECT_THAT(
      of_data("{files: a.npy, axes: [frame, image, row, column], images: [[0, 0], [0, 0]]}"),
      HasSubstr("[0, 0] twice"));
  EXPECT_THAT(of_data("{files: a.npy, axes: [frame, image, row, column], images: [[0, 4]]}"),
              HasSubstr("has [0, 4]"));
  EXPECT_THAT(of_data("{files: a.npy, axes: [frame, image, step, row, column], images: [[0, 0]]}"),
              HasSubstr("stands for frequency and step"));
  EXPECT_THAT(of_data("{files: a.raw, type: uint12, axes: [frame, frequency, step, row, column]}"),
              HasSubstr("not 'uint12'"));
  EXPECT_THAT(
      of_data("{files: a.raw, byte_order: big, axes: [frame, frequency, step, row, column]}"),
      HasSubstr("need 'type'"));
  EXPECT_THAT(of_data("{files: a.raw, type: int16, byte_order: middle, axes: [row, column]}"),
              HasSubstr("must be little or big"));
  EXPECT_THAT(of_data("{files: a.npy, axes: [frame, frequency, step, row, column], frames: 0}"),
              HasSubstr("data.frames"));
  EXPECT_THAT(
      of_data(
          "{files: \"{frequency}.npy\", frequency_names: [a], axes: [frame, step, row, column]}"),
      HasSubstr("frequency_names has 1 entries"));
}

TEST_F(CorrelationDescriptionFile, WithImpossibleValuesIsRefused) {
  EXPECT_THAT(of_values("{bits: 0}"), HasSubstr("values.bits must be 1 to 64"));
  EXPECT_THAT(of_values("{shift: -1}"), HasSubstr("values.shift"));
  EXPECT_THAT(of_values("{companding: {table: [0, 1]}}"), HasSubstr("values.bits must be given"));
  EXPECT_THAT(of_values("{bits: 1, companding: {table: [0, 1, 2]}}"), HasSubstr("3 entries"));
  EXPECT_THAT(of_values("{bits: 4, companding: {segments: [{code: 1, value: 0, step: 1}]}}"),
              HasSubstr("must be 0 in the first segment"));
  EXPECT_THAT(of_values("{bits: 4, signed: true, companding: {table: [0, 1]}}"),
              HasSubstr("values.signed"));
  EXPECT_THAT(of_values("{saturation: {from: 1, up_to: 2}}"), HasSubstr("less than 'from'"));
  EXPECT_THAT(of_values("{saturation: {codes: top}}"), HasSubstr("values.saturation.codes"));
}

TEST(ShippedCorrelationDescriptions, AreAllRead) {
  int files = 0;
  for (const auto& entry :
       fs::directory_iterator(fs::path(TOFMAP_SOURCE_DIR) / "configs/cameras/correlation")) {
    ++files;
    EXPECT_NO_THROW(read_correlation_description(entry.path())) << entry.path();
    std::ifstream in(entry.path());
    const std::string text((std::istreambuf_iterator<char>(in)), {});
    EXPECT_THAT(text, HasSubstr("No recording of this camera has been tried")) << entry.path();
    EXPECT_THAT(text, HasSubstr("Source: http")) << entry.path();
    EXPECT_THAT(text, HasSubstr("Assumption")) << entry.path();
  }
  EXPECT_GE(files, 4);
}

TEST(DocumentedCorrelationDescriptions, AreAllRead) {
  std::ifstream in(fs::path(TOFMAP_SOURCE_DIR) / "docs/import-correlation.md");
  const test::TemporaryFolder folder;
  const fs::path file = folder.path() / "example.yaml";
  std::string line;
  int examples = 0;
  while (std::getline(in, line)) {
    if (line != "```yaml") continue;
    std::ofstream out(file);
    while (std::getline(in, line) && line != "```") out << line << '\n';
    out.close();
    EXPECT_EQ(test::input_error([&] { read_correlation_description(file); }), "") << examples;
    ++examples;
  }
  EXPECT_EQ(examples, 5);
}

}  // namespace
}  // namespace tofmap
