// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "registration_rows.hpp"

#include "../state_json.hpp"
#include "crc_sum.hpp"
#include "insertion.hpp"
#include "rows.hpp"

#include <string>

#include <tofmap/core/bytes.hpp>

namespace tofmap {
namespace {

/// The columns of the table.
struct RegistrationColumn {
  enum { frame, place, keyframe, position, rotation = 6, information, gradient, count };
};

std::uint32_t checksum_of(const std::vector<FrameConstraint>& constraints) {
  CrcSum sum;
  for (const FrameConstraint& constraint : constraints) {
    ByteWriter bytes;
    bytes.number(constraint.keyframe);
    bytes.numbers({constraint.keyframe_from_camera.data(), 16});
    bytes.numbers({constraint.information.data(), 36});
    bytes.numbers({constraint.gradient.data(), 6});
    sum.add(bytes.take());
  }
  return sum.value();
}

}  // namespace

std::vector<std::uint32_t> constraint_checksums(const std::vector<RegisteredFrame>& frames) {
  std::vector<std::uint32_t> checksums;
  for (const RegisteredFrame& frame : frames) checksums.push_back(checksum_of(frame.constraints));
  return checksums;
}

void write_registrations(const std::vector<RegisteredFrame>& frames,
                         const std::vector<std::uint32_t>& before,
                         const std::vector<std::uint32_t>& after, SQLite::Database& database) {
  SQLite::Statement removal(database, "DELETE FROM registrations WHERE frame = ?");
  Insertion insertion(database, "registrations", RegistrationColumn::count);
  SQLite::Statement& row = insertion.statement;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (i < before.size()) {
      if (after[i] == before[i]) continue;
      removal.bind(1, static_cast<std::int64_t>(i));
      removal.exec();
      removal.reset();
    }
    int place = 0;
    for (const FrameConstraint& constraint : frames[i].constraints) {
      const Eigen::Matrix3f rotation = constraint.keyframe_from_camera.linear();
      // Parameters count from 1, columns from 0.
      row.bind(1 + RegistrationColumn::frame, static_cast<std::int64_t>(i));
      row.bind(1 + RegistrationColumn::place, place++);
      row.bind(1 + RegistrationColumn::keyframe, constraint.keyframe);
      for (int axis = 0; axis < 3; ++axis) {
        row.bind(1 + RegistrationColumn::position + axis,
                 static_cast<double>(constraint.keyframe_from_camera.translation()[axis]));
      }
      bind_numbers(row, 1 + RegistrationColumn::rotation, rotation.data(), 9);
      bind_numbers(row, 1 + RegistrationColumn::information, constraint.information.data(), 36);
      bind_numbers(row, 1 + RegistrationColumn::gradient, constraint.gradient.data(), 6);
      insertion.execute();
    }
  }
}

void read_registration(SQLite::Statement& row, int keyframes,
                       std::vector<RegisteredFrame>& frames) {
  const int frame =
      integer_in(row, RegistrationColumn::frame, 0, static_cast<int>(frames.size()) - 1);
  FrameConstraint constraint;
  constraint.keyframe = integer_in(row, RegistrationColumn::keyframe, 0, keyframes - 1);
  for (int axis = 0; axis < 3; ++axis) {
    constraint.keyframe_from_camera.translation()[axis] =
        static_cast<float>(position_in(row, RegistrationColumn::position + axis));
  }
  Eigen::Matrix3f rotation;
  read_numbers(row, RegistrationColumn::rotation, rotation.data(), 9);
  check_rotation(rotation.cast<double>());
  constraint.keyframe_from_camera.linear() = rotation;
  read_numbers(row, RegistrationColumn::information, constraint.information.data(), 36);
  read_numbers(row, RegistrationColumn::gradient, constraint.gradient.data(), 6);
  frames[static_cast<std::size_t>(frame)].constraints.push_back(constraint);
}

}  // namespace tofmap
