#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "io/problem_data.hpp"
#include "zwidth/io/recording_file.hpp"

namespace zwidth {

/// A folder of its own for the recordings of a test.
class RecordingFolder : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (std::filesystem::temp_directory_path() / "zwidth_recording_XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }
  [[nodiscard]] std::string write(const std::string& name, std::string_view bytes) const {
    std::ofstream(path(name), std::ios::binary) << bytes;
    return path(name);
  }

 private:
  std::filesystem::path folder_;
};

/// Asks for columns by name, unscaled.
inline RecordingOptions columns_named(const std::vector<std::string>& names) {
  RecordingOptions options;
  for (const std::string& name : names) options.columns.push_back({name, 1.0});
  return options;
}

class TextRecording : public RecordingFolder {
 protected:
  [[nodiscard]] tl::expected<Recording, InputError> read(std::string_view text, const RecordingOptions& options) const {
    return read_recording(write("a.csv", text), options);
  }
  /// As data_of() says it.
  [[nodiscard]] std::string refusal(std::string_view text, const RecordingOptions& options) const {
    const auto recording = read(text, options);
    return recording ? "read" : data_of(recording.error());
  }
};

inline RecordingOptions at_1_khz(const std::vector<std::string>& names) {
  RecordingOptions options = columns_named(names);
  options.rate = 1000.0;
  return options;
}

inline bool mentions(const std::vector<Remark>& remarks, std::string_view words) {
  for (const Remark& remark : remarks) {
    if (remark.what.find(words) != std::string::npos || remark.consequence.find(words) != std::string::npos)
      return true;
  }
  return false;
}

inline std::size_t warnings_in(const std::vector<Remark>& remarks) {
  std::size_t warnings = 0;
  for (const Remark& remark : remarks) {
    if (remark.severity == Remark::Severity::warning) ++warnings;
  }
  return warnings;
}

}  // namespace zwidth
