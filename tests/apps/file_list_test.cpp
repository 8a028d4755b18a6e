// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "output/file_list.hpp"

#include <fstream>

#include <gtest/gtest.h>
#include <support/temporary_folder.hpp>

#include <tofmap/core/error.hpp>

namespace tofmap::app {
namespace {

namespace fs = std::filesystem;

/// A result of a file, and a folder with one, that is listed.
class ListedFolder : public testing::Test {
 protected:
  ListedFolder() {
    write("map.ply", "points");
    write("range/0 1.png", "ranges");
    FileList::of(folder_).write(folder_ / FileList::file_name);
  }

  void write(const std::string& name, const std::string& text) const {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name) << text;
  }

  std::string foreign() const {
    const auto foreign = FileList::read(folder_)->first_foreign(folder_);
    return foreign ? foreign->path.string() + (foreign->is_changed ? " changed" : "") : "none";
  }

  test::TemporaryFolder parent_;
  fs::path folder_ = parent_.path() / "result";
};

TEST_F(ListedFolder, HoldsNothingForeignAsItWasWritten) {
  EXPECT_EQ(foreign(), "none");
  fs::remove(folder_ / "map.ply");
  EXPECT_EQ(foreign(), "none") << "what is gone cannot be lost";
}

TEST_F(ListedFolder, NamesWhatIsNotListed) {
  write("range/mine.txt", "x");
  EXPECT_EQ(foreign(), "range/mine.txt");
  fs::create_directory(folder_ / "empty");
  EXPECT_EQ(foreign(), "empty");
}

TEST_F(ListedFolder, NamesWhatIsNoLongerWhatItWas) {
  write("map.ply", "pointS");
  EXPECT_EQ(foreign(), "map.ply changed");
  fs::remove(folder_ / "map.ply");
  fs::create_symlink("range/0 1.png", folder_ / "map.ply");
  EXPECT_EQ(foreign(), "map.ply changed");
  fs::remove(folder_ / "map.ply");
  fs::create_directory(folder_ / "map.ply");
  EXPECT_EQ(foreign(), "map.ply changed");
}

TEST_F(ListedFolder, IsRemovedButForWhatIsForeign) {
  write("range/mine.txt", "x");
  write("map.ply", "mine, too");
  fs::create_symlink("/etc", folder_ / "range" / "link");
  EXPECT_FALSE(FileList::read(folder_)->remove_from(folder_));
  EXPECT_TRUE(fs::exists(folder_ / "range" / "mine.txt"));
  EXPECT_TRUE(fs::exists(folder_ / "map.ply"));
  EXPECT_TRUE(fs::is_symlink(folder_ / "range" / "link"));
  EXPECT_FALSE(fs::exists(folder_ / "range" / "0 1.png"));
}

TEST_F(ListedFolder, IsRemovedWholeIfNothingIsForeign) {
  EXPECT_TRUE(FileList::read(folder_)->remove_from(folder_));
  EXPECT_FALSE(fs::exists(folder_));
}

TEST_F(ListedFolder, ComesBackFromItsFile) {
  FileList list = *FileList::read(folder_);
  write("pictures/a.png", "x");
  write("page.html", "y");
  list.add(FileList::of(folder_ / "pictures", "pictures"));
  list.add(FileList::of(folder_ / "page.html", "page.html"));
  list.write(folder_ / FileList::file_name);
  EXPECT_EQ(foreign(), "none");
}

TEST_F(ListedFolder, WithoutAListThatIsUnderstoodHasNone) {
  write(FileList::file_name, "x\n");
  EXPECT_FALSE(FileList::read(folder_));
  fs::remove(folder_ / FileList::file_name);
  EXPECT_FALSE(FileList::read(folder_));
}

TEST_F(ListedFolder, DoesNotListLinks) {
  fs::create_symlink("map.ply", folder_ / "link");
  EXPECT_THROW(FileList::of(folder_), InputError);
}

}  // namespace
}  // namespace tofmap::app
