#include "report/output_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace zwidth::report {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class OutputFile : public ::testing::Test {
 protected:
  OutputFile() {
    std::string pattern = (fs::temp_directory_path() / "zwidth_output_XXXXXX").string();
    directory_ = ::mkdtemp(pattern.data());
  }
  ~OutputFile() override {
    fs::permissions(directory_, fs::perms::owner_all);
    fs::remove_all(directory_);
  }
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  [[nodiscard]] std::string path(const std::string& name) const { return (directory_ / name).string(); }
  [[nodiscard]] std::string contents(const std::string& name) const {
    std::ifstream file(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  [[nodiscard]] std::size_t entries() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(directory_), fs::directory_iterator()));
  }
  /// What write_whole() says when it refuses.
  [[nodiscard]] static std::string refusal(const std::string& target) {
    try {
      write_whole(target, "new");
    } catch (const OutputFailed& failure) {
      return failure.what();
    }
    return "written";
  }

  fs::path directory_;
};

TEST_F(OutputFile, WritesAllBytesAndNothingBeside) {
  const std::string bytes("a\0b\nc", 5);
  write_whole(path("out"), bytes);
  EXPECT_EQ(contents("out"), bytes);
  EXPECT_EQ(entries(), 1U);
}

TEST_F(OutputFile, ReplacesAndKeepsPermissions) {
  write_whole(path("out"), "old");
  fs::permissions(path("out"), fs::perms::owner_read | fs::perms::owner_write);
  write_whole(path("out"), "new");
  EXPECT_EQ(contents("out"), "new");
  EXPECT_EQ(fs::status(path("out")).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(OutputFile, FollowsASymbolicLink) {
  write_whole(path("target"), "old");
  fs::create_symlink("target", path("link"));
  write_whole(path("link"), "new");
  EXPECT_EQ(contents("target"), "new");
  EXPECT_TRUE(fs::is_symlink(path("link")));
}

TEST_F(OutputFile, RefusesADirectoryAndAMissingOne) {
  EXPECT_THAT(refusal(directory_.string()), HasSubstr("is a directory"));
  EXPECT_THAT(refusal(path("no/such/out")), HasSubstr("cannot write"));
  EXPECT_THAT(refusal(""), HasSubstr("empty"));
  write_whole(path("file"), "x");
  EXPECT_THAT(refusal(path("file/out")), HasSubstr("cannot write"));
  EXPECT_EQ(entries(), 1U);
}

TEST_F(OutputFile, AFullDeviceIsReported) { EXPECT_THAT(refusal("/dev/full"), HasSubstr("No space left")); }

TEST_F(OutputFile, AFailedWriteLeavesWhatWasThere) {
  write_whole(path("out"), "old");
  // A limit on the size of files stands in for a full disk.
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  void (*const handler)(int) = ::signal(SIGXFSZ, SIG_IGN);
  const rlimit tight{1000, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &tight), 0);
  EXPECT_THROW(write_whole(path("out"), std::string(5000, 'x')), OutputFailed);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  ::signal(SIGXFSZ, handler);
  EXPECT_EQ(contents("out"), "old");
  EXPECT_EQ(entries(), 1U);
}

TEST_F(OutputFile, SeveralAppearTogetherOrNotAtAll) {
  write_whole(path("a"), "old");
  {
    OutputFiles files;
    files.write(path("a"), "new");
    EXPECT_THROW(files.write(path("missing/b"), "new"), OutputFailed);
  }
  EXPECT_EQ(contents("a"), "old");
  EXPECT_EQ(entries(), 1U);
  OutputFiles files;
  files.write(path("a"), "new");
  files.write(path("b"), "new");
  EXPECT_EQ(contents("a"), "old");
  files.commit();
  EXPECT_EQ(contents("a") + contents("b"), "newnew");
  EXPECT_EQ(entries(), 2U);
}

TEST_F(OutputFile, AKilledProgramLeavesNothingBehind) {
  write_whole(path("old"), "old");
  const ::pid_t child = ::fork();
  if (child == 0) {
    OutputFiles files;
    files.write(path("old"), "new");
    files.write(path("new"), [](const Sink& sink) {
      sink("half of it");
      ::raise(SIGKILL);
    });
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(contents("old"), "old");
  EXPECT_EQ(entries(), 1U);
}

TEST_F(OutputFile, MakesDirectoriesButNotOverAFile) {
  make_directory(path("a/b"));
  EXPECT_TRUE(fs::is_directory(path("a/b")));
  make_directory(path("a/b"));
  write_whole(path("file"), "x");
  EXPECT_THROW(make_directory(path("file")), OutputFailed);
  EXPECT_THROW(make_directory(path("file/below")), OutputFailed);
}

}  // namespace
}  // namespace zwidth::report
