#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "io/device_texts.hpp"
#include "io/problem_data.hpp"
#include "zwidth/io/device_file.hpp"

namespace zwidth {
namespace {

namespace fs = std::filesystem;

class ReadDeviceFile : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "zwidth_read_XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
  }
  void TearDown() override { fs::remove_all(folder_); }

  [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }
  [[nodiscard]] std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
    return path(name);
  }
  [[nodiscard]] static InputProblem refusal(const std::string& path) {
    const auto device = read_device_file(path);
    return device ? InputProblem{{}, "is read", "", {}} : InputProblem(device.error());
  }

 private:
  fs::path folder_;
};

TEST_F(ReadDeviceFile, ReadsAFileAndItsOverrides) {
  const std::vector<std::string> overrides{"loop.delay=1e-3"};
  const auto device = read_device_file(write("rig.toml", small_device_text), overrides);
  ASSERT_TRUE(device.has_value());
  EXPECT_EQ(device->name(), "rig");
  EXPECT_EQ(device->loop().delay, 1e-3);
}

TEST_F(ReadDeviceFile, NamesThePlaceInTheFile) {
  const std::string file = write("rig.toml", "[[body]]\nname = \"a\"\nmas = 1\n");
  test::expect_refused(
      refusal(file), {{file, 3, 1, "body.a.mas"}, {.code = ProblemCode::unknown_key, .subjects = {{"meant", "mass"}}}});
}

TEST_F(ReadDeviceFile, ReadsAPipe) {
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  std::thread writer([&] { std::ofstream(path("pipe")) << small_device_text; });
  const auto device = read_device_file(path("pipe"));
  writer.join();
  EXPECT_TRUE(device.has_value());
}

TEST_F(ReadDeviceFile, ReadsStandardInput) {
  const int saved = dup(STDIN_FILENO);
  ASSERT_NE(std::freopen(write("input", "[[body]]\nname = 3\n").c_str(), "r", stdin), nullptr);
  const auto device = read_device_file("-");
  dup2(saved, STDIN_FILENO);
  close(saved);
  clearerr(stdin);
  ASSERT_FALSE(device.has_value());
  test::expect_refused(device.error(), {{"standard input", 2, 8, "body.0.name"}, {.code = ProblemCode::of_other_type}});
}

TEST_F(ReadDeviceFile, RefusesWhatIsNoFile) {
  const auto expect_no_file = [](const std::string& path, const std::string& name, const char* found) {
    test::expect_refused(
        refusal(path),
        {{name}, {.code = ProblemCode::not_a_file, .subjects = {{"found", found}, {"kind", "device file"}}}});
  };
  expect_no_file(path(""), path(""), "directory");
  expect_no_file("/dev/zero", "/dev/zero", "device");
  expect_no_file("", "\"\"", "nothing");
  test::expect_refused(refusal(path("none.toml")),
                       {{path("none.toml")},
                        {.code = ProblemCode::cannot_be_read,
                         .subjects = {{"reason", "No such file or directory"}, {"kind", "device file"}}}});
}

TEST_F(ReadDeviceFile, RefusesAnUnreadableFile) {
  const std::string file = write("secret.toml", small_device_text);
  fs::permissions(file, fs::perms::none);
  // Root may read any file: for the call be somebody else.
  constexpr uid_t nobody = 65534;
  const uid_t self = geteuid();
  if (self == 0) {
    ASSERT_EQ(seteuid(nobody), 0);
  }
  const InputProblem told = refusal(file);
  ASSERT_EQ(seteuid(self), 0);
  test::expect_refused(told,
                       {{file}, {.code = ProblemCode::cannot_be_read, .subjects = {{"reason", "Permission denied"}}}});
}

TEST_F(ReadDeviceFile, RefusesAFileThatFailsWhileItIsRead) {
  test::expect_refused(refusal("/proc/self/mem"), {{"/proc/self/mem"}, {.code = ProblemCode::cannot_be_read}});
}

TEST_F(ReadDeviceFile, RefusesALargeFileUnread) {
  const std::string file = write("large.toml", "");
  fs::resize_file(file, std::uintmax_t{100} << 20);
  test::expect_refused(
      refusal(file),
      {{file},
       {.code = ProblemCode::too_many_bytes_read, .evidence = {{"most", 1.0}}, .subjects = {{"kind", "device file"}}}});
}

TEST_F(ReadDeviceFile, ReadsUpToTheLimit) {
  std::string text = small_device_text;
  while (text.size() < device_file_size_limit) text += text.size() % 80 == 79 ? '\n' : '#';
  EXPECT_TRUE(read_device_file(write("limit.toml", text)));
  EXPECT_FALSE(read_device_file(write("above.toml", text + "\n")));
}

}  // namespace
}  // namespace zwidth
