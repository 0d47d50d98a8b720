#include "io/atomic_file.hpp"

#include <csignal>
#include <fcntl.h>
#include <string>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "io/io_test_util.hpp"

namespace rilo::test {
namespace {

namespace fs = std::filesystem;

TEST(IoErrorTest, MessageHasAllParts) {
  const IoError error({"a/b.txt", "line 3", "'x'", "a number", "Write one"});
  EXPECT_STREQ(error.what(), "a/b.txt, line 3: 'x'; expected a number. Write one.");
  EXPECT_EQ(error.problem().position, "line 3");
  EXPECT_STREQ(IoError({"f", "", "empty", "", ""}).what(), "f: empty.");
  EXPECT_STREQ(IoError({"", "", "empty", "", ""}).what(), "empty.");
}

TEST(AtomicFileTest, AppearsOnlyAtCommit) {
  const TempDir folder;
  {
    AtomicFile file(folder / "a.txt");
    file.write("hello ");
    EXPECT_FALSE(fs::exists(folder / "a.txt"));
    file.write("world");
    file.overwrite(0, "J");
    file.commit();
  }
  EXPECT_EQ(slurp(folder / "a.txt"), "Jello world");
  EXPECT_EQ(files_in(folder.path()), 1U);
}

TEST(AtomicFileTest, LeavesNothingBehindWithoutCommit) {
  const TempDir folder;
  folder.write("kept.txt", "old");
  { AtomicFile(folder / "kept.txt").write("new"); }
  EXPECT_EQ(slurp(folder / "kept.txt"), "old");
  { AtomicFile(folder / "other.txt").write(std::string(3'000'000, 'x')); }
  EXPECT_EQ(files_in(folder.path()), 1U);
}

TEST(AtomicFileTest, LargeWritesKeepTheirOrder) {
  const TempDir folder;
  std::string expected;
  AtomicFile file(folder / "big");
  for (int i = 0; i < 40; ++i) {
    const std::string part(static_cast<std::size_t>(1) << (i % 22), static_cast<char>('a' + i % 26));
    file.write(part);
    expected += part;
  }
  file.commit();
  EXPECT_TRUE(slurp(folder / "big") == expected);
}

TEST(AtomicFileTest, ReplacesAndFollowsLinks) {
  const TempDir folder;
  folder.write("real/target.txt", "old");
  fs::create_symlink(folder / "real/target.txt", folder / "link.txt");
  write_atomically(folder / "link.txt", "new");
  EXPECT_TRUE(fs::is_symlink(folder / "link.txt"));
  EXPECT_EQ(slurp(folder / "real/target.txt"), "new");
}

TEST(AtomicFileTest, ALinkToNothingYetStaysALink) {
  const TempDir folder;
  fs::create_directory(folder / "real");
  fs::create_symlink("real/new.txt", folder / "link.txt");
  write_atomically(folder / "link.txt", "new");
  EXPECT_TRUE(fs::is_symlink(folder / "link.txt"));
  EXPECT_EQ(slurp(folder / "real/new.txt"), "new");
}

TEST(AtomicFileTest, AReplacedFileKeepsItsPermissions) {
  const TempDir folder;
  const auto secret = folder.write("secret.txt", "old");
  fs::permissions(secret, static_cast<fs::perms>(0600));
  write_atomically(secret, "new");
  EXPECT_EQ(slurp(secret), "new");
  EXPECT_EQ(fs::status(secret).permissions(), static_cast<fs::perms>(0600));
}

TEST(AtomicFileTest, UsualPermissions) {
  const TempDir folder;
  const mode_t mask = ::umask(0027);
  write_atomically(folder / "a", "x");
  ::umask(mask);
  EXPECT_EQ(fs::status(folder / "a").permissions(), static_cast<fs::perms>(0640));
}

TEST(AtomicFileTest, SaysWhatIsWrong) {
  const TempDir folder;
  expect_io_error([&] { write_atomically(folder / "none/a.txt", "x"); },
                  {"none/a.txt", "does not exist", "Create the folder"});
  expect_io_error([&] { write_atomically(folder.path(), "x"); }, {"it is a folder"});
  expect_io_error([&] { write_atomically("/dev/null", "x"); }, {"/dev/null", "not a regular file"});
  expect_io_error([&] { write_atomically("/proc/rilo.txt", "x"); }, {"/proc/rilo.txt", "cannot create"});
}

TEST(AtomicFileTest, LongNamesAreReplacedAndTooLongOnesRefusedAtOnce) {
  const TempDir folder;
  const fs::path file = folder / std::string(250, 'n');
  for (const char* text : {"first", "second"}) {
    write_atomically(file, text);
    EXPECT_EQ(slurp(file), text);
  }
  expect_io_error([&] { const AtomicFile too_long(folder / std::string(300, 'n')); }, {"nnn", "cannot be written"});
  EXPECT_EQ(files_in(folder.path()), 1U);
}

TEST(AtomicFileTest, ReadOnlyFolder) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  const TempDir folder;
  fs::permissions(folder.path(), static_cast<fs::perms>(0500));
  expect_io_error([&] { write_atomically(folder / "a", "x"); }, {"Permission denied", "that you may write to"});
  fs::permissions(folder.path(), static_cast<fs::perms>(0700));
}

TEST(AtomicFileTest, AKilledWriterLeavesNothingBehind) {
  const TempDir folder;
  const int nameless = ::open(folder.path().c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0600);
  if (nameless < 0) GTEST_SKIP() << "this file system has no files without names";
  ::close(nameless);
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    AtomicFile file(folder / "a");
    file.write(std::string(3'000'000, 'x'));
    ::kill(::getpid(), SIGKILL);
  }
  int status = -1;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(files_in(folder.path()), 0U);
}

TEST(AtomicFileTest, AnUnfinishedFileTellsWhatItWasToBecome) {
  EXPECT_EQ(name_of_unfinished(".poses.txt.6732-27.tmp"), "poses.txt");
  EXPECT_EQ(name_of_unfinished(".a.1-0.tmp"), "a");
  for (const char* other : {"", ".", ".tmp", ".1-0.tmp", "..1-0.tmp", "a.1-0.tmp", ".a.1-0", ".a.1-.tmp", ".a.-0.tmp",
                            ".a1-0.tmp", ".a.x1-0.tmp", ".a.1.0.tmp", "poses.txt.tmp", "poses.txt"}) {
    EXPECT_FALSE(name_of_unfinished(other)) << other;
  }
}

// A limit on the size of files stands in for a full disk. In a child process, since the limit stays.
TEST(AtomicFileTest, FullDiskLeavesNothingBehind) {
  const TempDir folder;
  folder.write("a", "old");
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{1000, 1000};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    try {
      write_atomically(folder / "a", std::string(100'000, 'x'));
    } catch (const IoError& error) {
      ::_exit(std::string(error.what()).find("cannot write") == std::string::npos ? 2 : 0);
    }
    ::_exit(1);
  }
  int status = -1;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(WEXITSTATUS(status), 0);
  EXPECT_EQ(slurp(folder / "a"), "old");
  EXPECT_EQ(files_in(folder.path()), 1U);
}

}  // namespace
}  // namespace rilo::test
