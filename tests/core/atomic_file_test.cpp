#include "core/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <thread>

#include "core/input_error.h"
#include "tests/support/expect_error.h"
#include "tests/support/temporary_folder.h"

namespace ensemble {
namespace {

std::string contentOf(const std::filesystem::path& file) {
  const std::vector<std::byte> bytes = readFile(file);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

TEST(AtomicFile, ReplacesAndLeavesNothingBeside) {
  const testing::TemporaryFolder folder;
  writeFileAtomically(folder / "a.txt", std::string_view("one"));
  writeFileAtomically(folder / "a.txt", std::string_view("two"));
  EXPECT_EQ(contentOf(folder / "a.txt"), "two");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(AtomicFile, KeepsTheOldFileWhenItFails) {
  const testing::TemporaryFolder folder;
  std::filesystem::create_directory(folder / "taken");  // a folder can't be renamed over
  std::ofstream(folder / "taken" / "x") << "x";
  EXPECT_THROW(writeFileAtomically(folder / "taken", std::string_view("two")), SystemError);
  EXPECT_EQ(contentOf(folder / "taken" / "x"), "x");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(AtomicFile, WritesToDevicesAndThroughLinks) {
  const testing::TemporaryFolder folder;
  writeFileAtomically("/dev/null", std::string_view("x"));
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null")) << "the device was replaced";
  EXPECT_THROW(writeFileAtomically("/dev/full", std::string_view("x")), SystemError);
  writeFileAtomically(folder / "target", std::string_view("old"));
  std::filesystem::create_symlink("target", folder / "link");
  writeFileAtomically(folder / "link", std::string_view("new"));
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_EQ(contentOf(folder / "target"), "new");
}

TEST(FileAside, IsRenamedWhenItIsDoneAndGoneWhenItIsNot) {
  const testing::TemporaryFolder folder;
  const auto entries = [&] { return std::distance(std::filesystem::directory_iterator(folder.path()), {}); };
  writeFileAtomically(folder / "a", std::string_view("old"));
  {
    const FileAside aside(folder / "a");
    std::ofstream(aside.aside()) << "half";
    EXPECT_EQ(entries(), 2);
  }
  EXPECT_EQ(contentOf(folder / "a"), "old");
  EXPECT_EQ(entries(), 1);
  std::filesystem::create_symlink("a", folder / "link");
  {
    FileAside aside(folder / "link");
    std::ofstream(aside.aside()) << "new";
    EXPECT_EQ(contentOf(folder / "a"), "old");
    aside.commit();
  }
  EXPECT_EQ(contentOf(folder / "a"), "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_EQ(entries(), 2);
}

TEST(FileAside, RefusesWhatItCantReplace) {
  const auto message = [](const std::filesystem::path& file) -> std::string {
    try {
      const FileAside aside(file);
    } catch (const SystemError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_EQ(message("/dev/null"),
            "/dev/null: is not a regular file, and can't be replaced by one; choose another name");
  const testing::TemporaryFolder folder;
  const std::string missing = (folder / "none/a").string();
  EXPECT_EQ(message(missing),
            missing + ": can't be written: No such file or directory; make its folder first");
}

TEST(AtomicFile, TellsWhyItCantWrite) {
  const testing::TemporaryFolder folder;
  const std::string file = (folder / "none/a.txt").string();
  try {
    writeFileAtomically(file, std::string_view("x"));
    FAIL();
  } catch (const SystemError& error) {
    EXPECT_EQ(std::string(error.what()),
              file + ": can't be written: No such file or directory; make its folder first");
    EXPECT_EQ(error.exitCode(), ExitCode::kFailed);
  }
}

TEST(ReadFile, RefusesWhatIsNoFile) {
  const testing::TemporaryFolder folder;
  EXPECT_INPUT_ERROR(readFile(folder / "none"),
                     (folder / "none").string() + ": no such file; check the path");
  EXPECT_INPUT_ERROR(readFile(folder.path()),
                     folder.path().string() + ": is not a regular file; give a file");
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);  // must not hang
  EXPECT_INPUT_ERROR(readFile(folder / "pipe"),
                     (folder / "pipe").string() + ": is not a regular file; give a file");
  std::ofstream(folder / "big") << "12345";
  EXPECT_INPUT_ERROR(readFile(folder / "big", 4),
                     (folder / "big").string() +
                         ": has 5 bytes, more than the 4 that are read; split it or reduce its content");
}

TEST(FolderLock, LetsOneWriterInAtATime) {
  const testing::TemporaryFolder folder;
  {
    const FolderLock first(folder.path());
    try {
      const FolderLock second(folder.path(), 0.05);
      FAIL() << "two writers";
    } catch (const SystemError& error) {
      EXPECT_EQ(std::string(error.what()),
                folder.path().string() +
                    ": another process is writing this wardrobe; wait until it has finished, "
                    "then run it again");
    }
  }
  EXPECT_NO_THROW(FolderLock(folder.path(), 0.05));
}

}  // namespace
}  // namespace ensemble
