#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "io/device_texts.hpp"
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
  [[nodiscard]] static std::string refusal(const std::string& path) {
    const auto device = read_device_file(path);
    return device ? "read" : device.error().str();
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
  EXPECT_EQ(refusal(file), file + ":3:1: body.a.mas: unknown key \"mas\"; did you mean \"mass\"?");
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
  EXPECT_EQ(device.error().str(), "standard input:2:8: body.0.name: is the number 3; must be text in quotes");
}

TEST_F(ReadDeviceFile, RefusesWhatIsNoFile) {
  EXPECT_EQ(refusal(path("")), path("") + ": is a directory; must be a device file");
  EXPECT_EQ(
      refusal(path("none.toml")),
      path("none.toml") +
          ": cannot be read: No such file or directory; must be a readable device file, or \"-\" for standard input");
  EXPECT_EQ(refusal("/dev/zero"),
            "/dev/zero: is neither a file nor a pipe; must be a device file, or \"-\" for standard input");
  EXPECT_EQ(refusal(""), "\"\": is no file name; must be a device file, or \"-\" for standard input");
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
  const std::string message = refusal(file);
  ASSERT_EQ(seteuid(self), 0);
  EXPECT_EQ(message, file +
                         ": cannot be read: Permission denied; must be a readable device file, or \"-\" for standard "
                         "input");
}

TEST_F(ReadDeviceFile, RefusesAFileThatFailsWhileItIsRead) {
  const std::string message = refusal("/proc/self/mem");
  EXPECT_EQ(message.find("/proc/self/mem: cannot be read: "), 0U) << message;
}

TEST_F(ReadDeviceFile, RefusesALargeFileUnread) {
  const std::string file = write("large.toml", "");
  fs::resize_file(file, std::uintmax_t{100} << 20);
  EXPECT_EQ(refusal(file), file + ": is larger than 1 MiB; must be a device file, which takes a few hundred bytes");
}

TEST_F(ReadDeviceFile, ReadsUpToTheLimit) {
  std::string text = small_device_text;
  while (text.size() < device_file_size_limit) text += text.size() % 80 == 79 ? '\n' : '#';
  EXPECT_EQ(refusal(write("limit.toml", text)), "read");
  EXPECT_NE(refusal(write("above.toml", text + "\n")), "read");
}

}  // namespace
}  // namespace zwidth
