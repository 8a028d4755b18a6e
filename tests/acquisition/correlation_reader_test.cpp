// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/correlation_arrays.hpp>
#include <support/temporary_folder.hpp>

#include <tofmap/acquisition/correlation/correlation_reader.hpp>
#include <tofmap/acquisition/png_image.hpp>

namespace tofmap {
namespace {

using test::bytes_of;
using test::npy;
using test::write_bytes;
using testing::HasSubstr;

constexpr int frames = 4;
constexpr int frequencies = 2;
const std::vector<double> angles_deg = {0, 90, 180, 270};

/// The value of a pixel of the made-up scene.
using Value = std::function<double(int frame, int frequency, int step, int row, int col)>;

class CorrelationReading : public testing::Test {
 protected:
  std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }

  double value(int frame, int frequency, int step, int row, int col) const {
    return scene_.value(frame, frequency, angles_deg[static_cast<std::size_t>(step)], row, col);
  }

  /// The values of all pixels in the order frame, frequency, step, row, column.
  template <class Number>
  std::vector<Number> values(const Value& of) const {
    std::vector<Number> all;
    for (int i = 0; i < frames; ++i) {
      for (int f = 0; f < frequencies; ++f) {
        for (std::size_t k = 0; k < angles_deg.size(); ++k) {
          for (int v = 0; v < scene_.rows; ++v) {
            for (int u = 0; u < scene_.cols; ++u) {
              all.push_back(static_cast<Number>(of(i, f, static_cast<int>(k), v, u)));
            }
          }
        }
      }
    }
    return all;
  }
  template <class Number = std::uint16_t>
  std::vector<Number> values() const {
    return values<Number>(
        [this](int i, int f, int k, int v, int u) { return value(i, f, k, v, u); });
  }

  ImageU16 image(int frame, int frequency, int step) const {
    ImageU16 result(scene_.rows, scene_.cols);
    for (int v = 0; v < scene_.rows; ++v) {
      for (int u = 0; u < scene_.cols; ++u) {
        result(v, u) = static_cast<std::uint16_t>(value(frame, frequency, step, v, u));
      }
    }
    return result;
  }

  /// Writes a description with these lines for the data; `more` follows.
  std::filesystem::path describe(const std::string& data, const std::string& more = "",
                                 const std::string& angles = "[0, 90, 180, 270]") const {
    std::ofstream(path("camera.yaml"))
        << "format: tofmap-correlation\nversion: 1\n"
        << "camera: {width: 5, height: 3, fx: 4, fy: 4, cx: 2, cy: 1}\n"
        << "frequencies_hz: [80.0e6, 100.0e6]\nstep_angles_deg: " << angles
        << "\nphase_sign: " << phase_sign_ << "\nsteps: " << steps_ << "\ndata: {" << data << "}\n"
        << more;
    return path("camera.yaml");
  }

  CorrelationReader open(const std::string& data, const std::string& more = "") const {
    return CorrelationReader(read_correlation_description(describe(data, more)));
  }
  std::string complaint(const std::string& data, const std::string& more = "") const {
    return test::input_error([&] { open(data, more); });
  }

  void expect_frame(const CorrelationFrame& frame) const {
    ASSERT_EQ(frame.damage, "");
    ASSERT_EQ(frame.frequencies.size(), 2U);
    for (int f = 0; f < frequencies; ++f) {
      const FrequencyMeasurement& measured = frame.frequencies[static_cast<std::size_t>(f)];
      ASSERT_EQ(measured.phase.rows(), scene_.rows);
      ASSERT_EQ(measured.phase.cols(), scene_.cols);
      for (int v = 0; v < scene_.rows; ++v) {
        for (int u = 0; u < scene_.cols; ++u) {
          // Values are rounded to whole numbers, 1 / 1000 of the amplitude.
          EXPECT_LT(
              test::phase_difference(measured.phase(v, u), scene_.phase(frame.index, f, v, u)),
              5e-4);
          EXPECT_NEAR(measured.amplitude(v, u), scene_.amplitude(f, v, u), 1);
          EXPECT_LT(measured.residual(v, u), 1.5);
        }
      }
      EXPECT_EQ(measured.saturated.cast<int>().sum(), 0);
    }
  }

  void expect_scene(const std::string& data, const std::string& more = "") const {
    CorrelationReader reader = open(data, more);
    ASSERT_EQ(reader.frame_count(), frames);
    for (const int i : {0, 3, 1, 2}) expect_frame(reader.read(i));
  }

  test::TemporaryFolder folder_;
  test::MadeUpScene scene_;
  int phase_sign_ = 1;
  std::string steps_ = "single_ended";
};

const std::string all_axes = "axes: [frame, frequency, step, row, column]";

TEST_F(CorrelationReading, OfOneArrayFindsPhasesAndAmplitudes) {
  write_bytes(path("a.npy"), npy("<u2", "(4, 2, 4, 3, 5)", bytes_of(values())));
  expect_scene("files: a.npy, " + all_axes);
  write_bytes(path("b.npy"), npy(">f4", "(4, 2, 4, 3, 5)", bytes_of(values<float>(), true)));
  expect_scene("files: b.npy, " + all_axes);
  write_bytes(path("c.npy"), npy("<u2", "(8, 4, 3, 5)", bytes_of(values())));
  expect_scene("files: c.npy, reshape: true, " + all_axes);
  EXPECT_THAT(complaint("files: c.npy, " + all_axes),
              HasSubstr("c.npy: has the shape 8 x 4 x 3 x 5"));
}

TEST_F(CorrelationReading, TakesAnyOrderOfAxes) {
  // a[column, step, frame, row, frequency]
  std::vector<std::uint16_t> reordered;
  for (int u = 0; u < 5; ++u) {
    for (int k = 0; k < 4; ++k) {
      for (int i = 0; i < frames; ++i) {
        for (int v = 0; v < 3; ++v) {
          for (int f = 0; f < 2; ++f) {
            reordered.push_back(static_cast<std::uint16_t>(value(i, f, k, v, u)));
          }
        }
      }
    }
  }
  write_bytes(path("a.npy"), npy("<u2", "(5, 4, 4, 3, 2)", bytes_of(reordered)));
  expect_scene("files: a.npy, axes: [column, step, frame, row, frequency]");
  // The same bytes in Fortran order have their indices the other way round.
  write_bytes(path("f.npy"), npy("<u2", "(2, 3, 4, 4, 5)", bytes_of(reordered), true));
  expect_scene("files: f.npy, axes: [frequency, row, frame, step, column]");
  test::write_npz(path("a.npz"), {{"x.npy", npy("<u2", "(5, 4, 4, 3, 2)", bytes_of(reordered))}},
                  true);
  expect_scene("files: a.npz, axes: [column, step, frame, row, frequency]");
}

TEST_F(CorrelationReading, OfListedImagesTakesAnyOrderAndLeavesOutTheRest) {
  // Images by step and frequency, with one at the beginning that belongs to none.
  std::vector<std::uint16_t> listed;
  for (int i = 0; i < frames; ++i) {
    for (int n = -1; n < 8; ++n) {
      for (int v = 0; v < 3; ++v) {
        for (int u = 0; u < 5; ++u) {
          listed.push_back(n < 0 ? std::uint16_t{9}
                                 : static_cast<std::uint16_t>(value(i, n % 2, n / 2, v, u)));
        }
      }
    }
  }
  write_bytes(path("a.npy"), npy("<u2", "(4, 9, 3, 5)", bytes_of(listed)));
  expect_scene(
      "files: a.npy, axes: [frame, image, row, column], images: [[], [0, 0], [1, 0], [0, 1], "
      "[1, 1], [0, 2], [1, 2], [0, 3], [1, 3]]");
}

TEST_F(CorrelationReading, OfRawNumbersCountsTheFramesOfTheFile) {
  write_bytes(path("a.bin"), std::string(7, 'x') + bytes_of(values(), true));
  expect_scene("files: a.bin, type: uint16, byte_order: big, byte_offset: 7, " + all_axes);
  std::filesystem::resize_file(path("a.bin"), 7 + 2 * 480 - 50);
  CorrelationReader reader =
      open("files: a.bin, type: uint16, byte_order: big, byte_offset: 7, " + all_axes);
  ASSERT_EQ(reader.frame_count(), 4);
  expect_frame(reader.read(2));
  EXPECT_THAT(reader.read(3).damage, HasSubstr("a.bin: is too short for frame 3"));
}

TEST_F(CorrelationReading, OfOneImageFileEachFollowsThePattern) {
  for (int i = 0; i < frames; ++i) {
    for (int f = 0; f < 2; ++f) {
      for (int k = 0; k < 4; ++k) {
        std::filesystem::create_directories(path(f == 0 ? "80MHz" : "100MHz"));
        const std::string name = (f == 0 ? "80MHz/frame_00000" : "100MHz/frame_00000") +
                                 std::to_string(5 + i) + "_" + std::to_string(k) + ".png";
        write_png(path(name), image(i, f, k));
      }
    }
  }
  const std::string data =
      "files: \"{frequency}/frame_{frame:06}_{step}.png\", frequency_names: [80MHz, 100MHz], "
      "axes: [row, column]";
  expect_scene(data);
  expect_scene(data + ", frames: 4, first_frame: 5");
  write_png(path("80MHz/frame_09_0.png"), image(0, 0, 0));
  expect_scene(data);  // since that is no name of a frame
  // One frequency's images are missing in one frame, one image of another frame is damaged.
  for (int k = 0; k < 4; ++k) {
    std::filesystem::remove(path("100MHz/frame_000006_" + std::to_string(k) + ".png"));
  }
  write_bytes(path("80MHz/frame_000008_2.png"), "no image");
  CorrelationReader reader = open(data);
  ASSERT_EQ(reader.frame_count(), 4);
  expect_frame(reader.read(0));
  EXPECT_THAT(reader.read(1).damage, HasSubstr("100MHz/frame_000006_0.png: does not exist"));
  expect_frame(reader.read(2));
  EXPECT_THAT(reader.read(3).damage, HasSubstr("frame_000008_2.png"));
  std::filesystem::remove_all(path("100MHz"));
  EXPECT_THAT(complaint(data), HasSubstr("(4 of 4 frames cannot be read)"));
  EXPECT_THAT(complaint("files: \"none_{frame}.npy\", axes: [frequency, step, row, column]"),
              HasSubstr("no file has such a name"));
}

TEST_F(CorrelationReading, OfStackedImagesTakesThemApart) {
  std::vector<ImageU16> pages;
  for (int i = 0; i < frames; ++i) {
    ImageU16 below(24, 5);
    ImageU16 beside(3, 40);
    for (int n = 0; n < 8; ++n) {
      below.middleRows(3 * n, 3) = image(i, n / 4, n % 4);
      beside.middleCols(5 * n, 5) = image(i, n / 4, n % 4);
    }
    write_png(path("below_" + std::to_string(i) + ".png"), below);
    write_png(path("beside_" + std::to_string(i) + ".png"), beside);
    for (int n = 0; n < 8; ++n) pages.push_back(image(i, n / 4, n % 4));
  }
  expect_scene("files: \"below_{frame}.png\", axes: [frequency, step, row, column]");
  expect_scene("files: \"beside_{frame}.png\", axes: [row, frequency, step, column]");
  test::write_tiff(path("all.tif"), pages);
  expect_scene("files: all.tif, " + all_axes);
  // Same number of pixels, other rows.
  EXPECT_THAT(complaint("files: all.tif, axes: [frame, frequency, row, step, column]"),
              HasSubstr("all.tif: has the shape 32 x 3 x 5"));
  write_png(path("wrong_0.png"), ImageU16(ImageU16::Zero(5, 24)));
  CorrelationReader reader =
      open("files: \"wrong_{frame}.png\", axes: [frequency, step, row, column]");
  EXPECT_THAT(reader.read(0).damage, HasSubstr("wrong_0.png: has the shape 1 x 5 x 24"));
}

TEST_F(CorrelationReading, OfAFileForEachFrequencyNamesFramesThatOneLacks) {
  for (int f = 0; f < 2; ++f) {
    std::vector<std::uint16_t> of_frequency;
    for (int i = 0; i < frames - f; ++i) {
      for (int k = 0; k < 4; ++k) {
        for (int v = 0; v < 3; ++v) {
          for (int u = 0; u < 5; ++u) {
            of_frequency.push_back(static_cast<std::uint16_t>(value(i, f, k, v, u)));
          }
        }
      }
    }
    write_bytes(
        path("f" + std::to_string(f) + ".npy"),
        npy("<u2", "(" + std::to_string(frames - f) + ", 4, 3, 5)", bytes_of(of_frequency)));
  }
  CorrelationReader reader = open("files: \"f{frequency}.npy\", axes: [frame, step, row, column]");
  ASSERT_EQ(reader.frame_count(), 4);
  expect_frame(reader.read(2));
  EXPECT_THAT(reader.read(3).damage, HasSubstr("f1.npy: is too short for frame 3"));
}

TEST_F(CorrelationReading, OfATruncatedArrayDamagesTheFramesThatAreCut) {
  const std::string bytes = npy("<u2", "(4, 2, 4, 3, 5)", bytes_of(values()));
  write_bytes(path("a.npy"), bytes.substr(0, bytes.size() - 250));
  CorrelationReader reader = open("files: a.npy, " + all_axes);
  ASSERT_EQ(reader.frame_count(), 4);
  expect_frame(reader.read(1));
  EXPECT_THAT(reader.read(2).damage, HasSubstr("a.npy: is too short for frame 2"));
  EXPECT_TRUE(reader.read(3).frequencies.empty());
  write_bytes(path("a.npy"), bytes.substr(0, bytes.size() - 500));
  EXPECT_THAT(complaint("files: a.npy, " + all_axes), HasSubstr("(3 of 4 frames cannot be read)"));
  EXPECT_THAT(complaint("files: none.npy, " + all_axes), HasSubstr("none.npy: does not exist"));
  EXPECT_THROW(reader.read(4), UsageError);
  EXPECT_THROW(reader.read(-1), UsageError);
}

TEST_F(CorrelationReading, OfPhasesThatFallWithRangeTurnsThemRound) {
  // I = b + a cos(2π φ + θ): the steps of 90° and 270° change places.
  const auto turned = values<std::uint16_t>(
      [this](int i, int f, int k, int v, int u) { return value(i, f, (4 - k) % 4, v, u); });
  write_bytes(path("a.npy"), npy("<u2", "(4, 2, 4, 3, 5)", bytes_of(turned)));
  phase_sign_ = -1;
  expect_scene("files: a.npy, " + all_axes);
  phase_sign_ = 1;
  const float wrong = open("files: a.npy, " + all_axes).read(0).frequencies[0].phase(1, 1);
  EXPECT_LT(test::phase_difference(wrong, -scene_.phase(0, 0, 1, 1)), 5e-4);
}

TEST_F(CorrelationReading, CutsAndShiftsAndExtendsTheValidBits) {
  // 12 bits in two's complement, above 4 bits that mean nothing.
  const auto packed = values<std::uint16_t>([this](int i, int f, int k, int v, int u) {
    const int number = static_cast<int>(value(i, f, k, v, u)) - 2000;
    return static_cast<double>(((number & 4095) << 4) | 5);
  });
  write_bytes(path("a.npy"), npy("<u2", "(4, 2, 4, 3, 5)", bytes_of(packed)));
  expect_scene("files: a.npy, " + all_axes, "values: {bits: 12, shift: 4, signed: true}\n");
  EXPECT_THAT(complaint("files: a.npy, " + all_axes, "values: {bits: 14, shift: 4}\n"),
              HasSubstr("together at most 16"));
}

TEST_F(CorrelationReading, ExpandsCompandedCodesOfTheKinect) {
  // The magnitude grows by 1 a code up to 255, by 2 up to 383, by 4 up to 511, …
  const auto expanded = [](int code) {
    int magnitude = 0;
    for (int i = 0; i < code; ++i) magnitude += i < 256 ? 1 : 1 << (i / 128 - 1);
    return magnitude;
  };
  EXPECT_EQ(expanded(1023), 16320);
  const std::string segments =
      "values: {bits: 11, companding: {negative_from: 1024, segments: [{code: 0, value: 0, step: "
      "1}, "
      "{code: 256, value: 256, step: 2}, {code: 384, value: 512, step: 4}, "
      "{code: 512, value: 1024, step: 8}, {code: 640, value: 2048, step: 16}, "
      "{code: 768, value: 4096, step: 32}, {code: 896, value: 8192, step: 64}]}, "
      "saturation: {codes: [1024]}}\n";
  write_bytes(path("a.npy"), npy("<u2", "(4, 2, 4, 3, 5)", bytes_of(values())));
  const StepValues read =
      read_correlation_description(describe("files: a.npy, " + all_axes, segments)).values;
  ASSERT_EQ(read.companding.size(), 2048U);
  for (int code = 0; code < 1024; ++code) {
    EXPECT_EQ(read.companding[static_cast<std::size_t>(code)], expanded(code)) << code;
    EXPECT_EQ(read.companding[static_cast<std::size_t>(1024 + code)], -expanded(code)) << code;
  }
  // The scene in codes, with one saturated pixel.
  auto codes = values<std::uint16_t>([&](int i, int f, int k, int v, int u) {
    const int number = static_cast<int>(value(i, f, k, v, u)) - 2000;
    int code = 0;
    while (expanded(code) < std::abs(number)) ++code;
    return number < 0 ? 1024 + code : code;
  });
  codes[3] = 1024;
  write_bytes(path("b.npy"), npy("<u2", "(4, 2, 4, 3, 5)", bytes_of(codes)));
  CorrelationReader reader = open("files: b.npy, " + all_axes, segments);
  const CorrelationFrame frame = reader.read(0);
  ASSERT_EQ(frame.damage, "");
  EXPECT_EQ(frame.frequencies[0].saturated.cast<int>().sum(), 1);
  EXPECT_EQ(frame.frequencies[0].saturated(0, 3), 1);
  EXPECT_LT(test::phase_difference(frame.frequencies[1].phase(2, 2), scene_.phase(0, 1, 2, 2)),
            0.005);
  EXPECT_THAT(
      open("files: a.npy, " + all_axes, "values: {bits: 12, companding: {table: [0, 1, 2]}}\n")
          .read(0)
          .damage,
      HasSubstr("table of companding ends with code 2"));
}

TEST_F(CorrelationReading, FlagsPixelsWithASaturatedStep) {
  auto numbers = values();
  numbers[15 * 2 + 4] = 4095;  // step 2
  numbers[15 * 5 + 1] = 0;     // step 1 of the second frequency
  write_bytes(path("a.npy"), npy("<u2", "(4, 2, 4, 3, 5)", bytes_of(numbers)));
  CorrelationReader reader =
      open("files: a.npy, " + all_axes, "values: {saturation: {from: 4095, up_to: 0}}\n");
  const CorrelationFrame frame = reader.read(0);
  EXPECT_EQ(frame.frequencies[0].saturated(0, 4), 1);
  EXPECT_EQ(frame.frequencies[1].saturated(0, 1), 1);
  EXPECT_EQ(frame.frequencies[0].saturated.cast<int>().sum(), 1);
  EXPECT_EQ(frame.frequencies[1].saturated.cast<int>().sum(), 1);
}

TEST_F(CorrelationReading, SubtractsDarkFrames) {
  const auto dark = [](int f, int k, int v, int u) { return 10.0 * (f + 2 * k) + v + u * u; };
  const auto raised = values<std::uint16_t>(
      [&](int i, int f, int k, int v, int u) { return value(i, f, k, v, u) + dark(f, k, v, u); });
  std::vector<float> of_steps;
  for (int f = 0; f < 2; ++f) {
    for (int k = 0; k < 4; ++k) {
      for (int n = 0; n < 15; ++n) {
        of_steps.push_back(static_cast<float>(dark(f, k, n / 5, n % 5)));
      }
    }
  }
  write_bytes(path("a.npy"), npy("<u2", "(4, 2, 4, 3, 5)", bytes_of(raised)));
  write_bytes(path("dark.npy"), npy("<f4", "(2, 4, 3, 5)", bytes_of(of_steps)));
  expect_scene("files: a.npy, " + all_axes,
               "dark: {files: dark.npy, axes: [frequency, step, row, column]}\n");
  // One image for all steps.
  write_bytes(path("b.npy"), npy("<u2", "(4, 2, 4, 3, 5)", bytes_of(values())));
  write_bytes(path("one.npy"), npy("<f4", "(3, 5)", bytes_of(std::vector<float>(15, 100))));
  expect_scene("files: b.npy, " + all_axes, "dark: {files: one.npy, axes: [row, column]}\n");
  expect_scene("files: b.npy, " + all_axes, "dark: {value: 2000}\n");
  EXPECT_THAT(
      complaint("files: b.npy, " + all_axes, "dark: {files: dark.npy, axes: [row, column]}\n"),
      HasSubstr("dark.npy: has the shape 2 x 4 x 3 x 5"));
}

TEST_F(CorrelationReading, OfFrequenciesWithDifferentStepsTakesListedImages) {
  // Four steps at the first frequency, three at the second.
  const std::string angles = "[[0, 90, 180, 270], [0, 120, 240]]";
  std::vector<std::uint16_t> numbers;
  for (int i = 0; i < frames; ++i) {
    for (int n = 0; n < 7; ++n) {
      const double angle_deg = n < 4 ? 90 * n : 120 * (n - 4);
      for (int v = 0; v < scene_.rows; ++v) {
        for (int u = 0; u < scene_.cols; ++u) {
          const double number = scene_.value(i, n < 4 ? 0 : 1, angle_deg, v, u);
          numbers.push_back(static_cast<std::uint16_t>(number));
        }
      }
    }
  }
  write_bytes(path("a.npy"), npy("<u2", "(4, 7, 3, 5)", bytes_of(numbers)));
  const std::string data =
      "files: a.npy, axes: [frame, image, row, column], images: [[0, 0], [0, 1], [0, 2], [0, 3], "
      "[1, 0], [1, 1], [1, 2]]";
  CorrelationReader reader(read_correlation_description(describe(data, "", angles)));
  const CorrelationFrame frame = reader.read(3);
  ASSERT_EQ(frame.damage, "");
  for (int f = 0; f < frequencies; ++f) {
    const FrequencyMeasurement& measured = frame.frequencies[static_cast<std::size_t>(f)];
    EXPECT_LT(test::phase_difference(measured.phase(2, 1), scene_.phase(3, f, 2, 1)), 5e-4);
  }
  EXPECT_GT(frame.frequencies[0].residual.size(), 0);
  EXPECT_EQ(frame.frequencies[1].residual.size(), 0);
  // An image for each step is not enough to tell which frequency it belongs to.
  write_bytes(path("dark.npy"), npy("<f4", "(4, 3, 5)", std::string(240, '\0')));
  const std::string dark = "dark: {files: dark.npy, axes: [step, row, column]}\n";
  const std::filesystem::path with_dark = describe(data, dark, angles);
  EXPECT_THAT(
      test::input_error([&] { CorrelationReader(read_correlation_description(with_dark)); }),
      HasSubstr("its axes must have 'frequency' or 'image'"));
  EXPECT_THAT(test::input_error([&] {
                read_correlation_description(describe("files: a.npy, " + all_axes, "", angles));
              }),
              HasSubstr("use the axis 'image'"));
}

TEST_F(CorrelationReading, SubtractsPhaseOffsets) {
  write_bytes(path("a.npy"), npy("<u2", "(4, 2, 4, 3, 5)", bytes_of(values())));
  std::vector<double> radians;
  for (int n = 0; n < 15; ++n) radians.push_back(0.1 * n);
  write_bytes(path("offsets.npy"), npy("<f8", "(3, 5)", bytes_of(radians)));
  const auto phases = [&](const std::string& more) {
    CorrelationReader reader = open("files: a.npy, " + all_axes, more);
    return reader.read(1);
  };
  const CorrelationFrame plain = phases("");
  const auto expect_off = [&](const CorrelationFrame& frame, int f, double off_cycles, int v,
                              int u) {
    const auto place = static_cast<std::size_t>(f);
    const float phase = frame.frequencies[place].phase(v, u);
    EXPECT_LT(test::phase_difference(phase + off_cycles, plain.frequencies[place].phase(v, u)),
              1e-6);
    EXPECT_GE(phase, 0);
    EXPECT_LT(phase, 1);
  };
  const CorrelationFrame in_cycles = phases("phase_offsets: {cycles: [0.1, -0.3]}\n");
  expect_off(in_cycles, 0, 0.1, 2, 2);
  expect_off(in_cycles, 1, -0.3, 2, 2);
  const CorrelationFrame in_metres = phases("phase_offsets: {metres: [0.5, 1]}\n");
  expect_off(in_metres, 1, 2 * 100e6 / 299792458.0, 1, 3);
  const CorrelationFrame by_pixel = phases(
      "phase_offsets: {cycles: [0, 0.2], per_pixel: {files: offsets.npy, axes: [row, column], "
      "unit: radians}}\n");
  expect_off(by_pixel, 0, 0.7 / (2 * std::numbers::pi), 1, 2);
  expect_off(by_pixel, 1, 0.2 + 0.7 / (2 * std::numbers::pi), 1, 2);
  const CorrelationFrame by_pixel_in_metres = phases(
      "phase_offsets: {per_pixel: {files: offsets.npy, axes: [row, column], unit: metres}}\n");
  expect_off(by_pixel_in_metres, 1, 0.7 * 2 * 100e6 / 299792458.0, 1, 2);
}

TEST_F(CorrelationReading, WithoutSignalHasNoPhase) {
  auto numbers = values<float>();
  for (std::size_t k = 0; k < 4; ++k) numbers[15 * k] = 77;  // no modulation
  numbers[15 * 3 + 1] = NAN;
  write_bytes(path("a.npy"), npy("<f4", "(4, 2, 4, 3, 5)", bytes_of(numbers)));
  const FrequencyMeasurement measured =
      open("files: a.npy, " + all_axes, "amplitude: {min: 512, max: 590}\n").read(0).frequencies[0];
  EXPECT_TRUE(std::isnan(measured.phase(0, 0)));
  EXPECT_EQ(measured.amplitude(0, 0), 0);
  EXPECT_TRUE(std::isnan(measured.phase(0, 1)));
  EXPECT_TRUE(std::isnan(measured.amplitude(0, 1)));
  EXPECT_FALSE(std::isnan(measured.phase(0, 2))) << "an amplitude of 520";
  EXPECT_EQ(measured.saturated(2, 4), 1) << "an amplitude of 600";
  EXPECT_EQ(measured.saturated(2, 2), 0);
}

TEST_F(CorrelationReading, WithoutOffsetTakesTwoSteps) {
  std::vector<std::int16_t> two;
  for (int i = 0; i < frames; ++i) {
    for (int f = 0; f < 2; ++f) {
      for (int k = 0; k < 2; ++k) {
        for (int n = 0; n < 15; ++n) {
          two.push_back(static_cast<std::int16_t>(value(i, f, k, n / 5, n % 5) - 2000));
        }
      }
    }
  }
  write_bytes(path("a.npy"), npy("<i2", "(4, 2, 2, 3, 5)", bytes_of(two)));
  const std::string text = "files: a.npy, " + all_axes;
  std::filesystem::path file = describe(text, "offset: none\n", "[0, 90]");
  EXPECT_THAT(test::input_error([&] { read_correlation_description(file); }),
              HasSubstr("offset must be 'fitted'"));
  steps_ = "differential";
  file = describe(text, "offset: none\n", "[0, 90]");
  CorrelationReader reader(read_correlation_description(file));
  const FrequencyMeasurement measured = reader.read(2).frequencies[1];
  EXPECT_LT(test::phase_difference(measured.phase(2, 3), scene_.phase(2, 1, 2, 3)), 5e-4);
  EXPECT_EQ(measured.residual.size(), 0);
}

TEST_F(CorrelationReading, TakesTimesFromARateAListOrAFile) {
  write_bytes(path("a.npy"), npy("<u2", "(4, 2, 4, 3, 5)", bytes_of(values())));
  const std::string data = "files: a.npy, " + all_axes;
  const auto time = [&](const std::string& timestamps, int frame) {
    return open(data, "timestamps: {" + timestamps + "}\n").read(frame).timestamp_s;
  };
  EXPECT_DOUBLE_EQ(open(data).read(3).timestamp_s, 3);
  EXPECT_DOUBLE_EQ(time("rate_hz: 20, start_s: 5", 3), 5.15);
  EXPECT_DOUBLE_EQ(time("times_s: [0, 0.5, 0.6, 9]", 2), 0.6);
  write_bytes(path("t.txt"), "# index time\n0 100\n1 250\n\n2 300\n3 1e3\n");
  EXPECT_DOUBLE_EQ(time("file: t.txt, column: 1, unit: ms", 1), 0.25);
  const auto bad = [&](const std::string& timestamps) {
    return complaint(data, "timestamps: {" + timestamps + "}\n");
  };
  EXPECT_THAT(bad("times_s: [0, 1, 2]"), HasSubstr("3 entries, but there are 4 frames"));
  EXPECT_THAT(bad("times_s: [0, 1, 1, 2]"), HasSubstr("is not later"));
  EXPECT_THAT(bad("file: none.txt"), HasSubstr("none.txt"));
  EXPECT_THAT(bad("file: t.txt, column: 2"), HasSubstr("t.txt:2"));
  write_bytes(path("u.txt"), "0\n1\nsoon\n3\n");
  EXPECT_THAT(bad("file: u.txt"), HasSubstr("u.txt:3: the timestamp 'soon'"));
}

TEST_F(CorrelationReading, OfRawNumbersKnowsMissingFramesFromTheTimes) {
  write_bytes(path("a.bin"), bytes_of(values()));
  const std::string data = "files: a.bin, type: uint16, " + all_axes;
  CorrelationReader reader = open(data, "timestamps: {times_s: [0, 1, 2, 3, 4, 5]}\n");
  ASSERT_EQ(reader.frame_count(), 6);
  expect_frame(reader.read(3));
  EXPECT_THAT(reader.read(4).damage, HasSubstr("is too short for frame 4"));
  EXPECT_THAT(complaint(data, "timestamps: {times_s: [0, 1]}\n"), HasSubstr("has 480 elements"));
}

TEST_F(CorrelationReading, FlagsWhatMovesBetweenTheSteps) {
  // An image of 200 x 20 pixels, from which noise can be estimated. The value of the third step of
  // 50 pixels is off.
  std::vector<float> numbers;
  for (int k = 0; k < 4; ++k) {
    for (int n = 0; n < 20 * 200; ++n) {
      const double noise = 7 * std::sin(12345.678 * (n + 1) * (k + 2));
      const bool is_off = k == 2 && n >= 10 * 200 && n < 10 * 200 + 50;
      numbers.push_back(static_cast<float>(
          1000 + 300 * std::cos(0.01 * n - k * std::numbers::pi / 2) + noise + (is_off ? 80 : 0)));
    }
  }
  write_bytes(path("a.npy"), npy("<f4", "(1, 4, 20, 200)", bytes_of(numbers)));
  for (const std::string steps : {"single_ended", "differential"}) {
    std::ofstream(path("wide.yaml"))
        << "format: tofmap-correlation\nversion: 1\n"
        << "camera: {width: 200, height: 20, fx: 200, fy: 200, cx: 100, cy: 10}\n"
        << "frequencies_hz: [20.0e6]\nstep_angles_deg: [0, 90, 180, 270]\nphase_sign: 1\n"
        << "steps: " << steps << "\ndata: {files: a.npy, axes: [frame, step, row, column]}\n";
    CorrelationReader reader(read_correlation_description(path("wide.yaml")));
    const FrequencyMeasurement measured = reader.read(0).frequencies.at(0);
    EXPECT_EQ(measured.inconsistent.row(10).leftCols(50).cast<int>().sum(), 50) << steps;
    EXPECT_EQ(measured.inconsistent.cast<int>().sum(), 50) << steps;
    EXPECT_GT(measured.residual(10, 10), 30);
    EXPECT_GT(measured.noise.pixels, 3000);
  }
}

TEST_F(CorrelationReading, EstimatesTheNoiseOfDifferencesFromTheAmplitude) {
  // No offset, and noise whose variance is the amplitude, which grows from left to right.
  std::mt19937 random(3);
  std::normal_distribution<double> unit_noise;
  std::vector<float> numbers;
  for (int k = 0; k < 4; ++k) {
    for (int n = 0; n < 20 * 200; ++n) {
      const double amplitude = 20 + 10 * (n % 200);
      numbers.push_back(
          static_cast<float>(amplitude * std::cos(0.01 * n - k * std::numbers::pi / 2) +
                             std::sqrt(amplitude) * unit_noise(random)));
    }
  }
  write_bytes(path("a.npy"), npy("<f4", "(4, 20, 200)", bytes_of(numbers)));
  std::ofstream(path("wide.yaml"))
      << "format: tofmap-correlation\nversion: 1\n"
      << "camera: {width: 200, height: 20, fx: 200, fy: 200, cx: 100, cy: 10}\n"
      << "frequencies_hz: [20.0e6]\nstep_angles_deg: [0, 90, 180, 270]\nphase_sign: 1\n"
      << "steps: differential\ndata: {files: a.npy, axes: [step, row, column]}\n";
  CorrelationReader reader(read_correlation_description(path("wide.yaml")));
  const FrequencyMeasurement measured = reader.read(0).frequencies.at(0);
  for (const double amplitude : {100.0, 500.0, 1900.0}) {
    EXPECT_NEAR(measured.noise.variance_at(amplitude) / amplitude, 1, 0.2) << amplitude;
  }
  EXPECT_LT(measured.inconsistent.cast<int>().sum(), 8);
}

}  // namespace
}  // namespace tofmap
