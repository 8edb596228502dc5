#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <string_view>

namespace zwidth::cli {

/// What a command left behind.
struct Outcome {
  int status = 0;  ///< exit status; 128 + N when signal N ended it
  std::string output;
  std::string errors;
};

/// A directory of its own with a copy of the project's devices/, in which the built program runs as a user runs it.
class Workspace : public ::testing::Test {
 protected:
  Workspace();
  ~Workspace() override;
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;

  /// Runs one bash command line in the directory, with `zwidth` on the PATH.
  [[nodiscard]] Outcome run(const std::string& command_line) const;

  /// The command must refuse: status 2, nothing on standard output, `message` among its errors, each of which is one
  /// line.
  void expect_refusal(const std::string& command_line, const std::string& message) const;

  /// Writes a file into the directory.
  void write(const std::string& name, std::string_view contents) const;

  /// The bytes of a file in the directory; empty where there is none.
  [[nodiscard]] std::string contents(const std::string& name) const;

  [[nodiscard]] const std::filesystem::path& directory() const { return directory_; }

 private:
  std::filesystem::path directory_;
};

}  // namespace zwidth::cli
