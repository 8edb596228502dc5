// Reading a text recording: two columns and the time out of five, from the page cache.

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "zwidth/io/recording_file.hpp"

namespace {

/// A file of five columns that is gone at the end.
class WrittenRecording {
 public:
  explicit WrittenRecording(std::size_t rows) : path_(std::filesystem::temp_directory_path() / "zwidth_XXXXXX") {
    const int descriptor = mkstemp(path_.data());
    if (descriptor < 0) return;
    close(descriptor);
    std::string text = "t,F,x,v,status\n";
    for (std::size_t i = 0; i < rows; ++i) {
      const double t = 1e-4 * static_cast<double>(i);
      text += fmt::format("{:.4f},{:.6f},{:.9e},{:.8g},ok\n", t, std::sin(7.0 * t), 1e-3 * std::cos(5.0 * t), t * t);
    }
    std::ofstream(path_) << text;
    size_ = text.size();
  }
  ~WrittenRecording() {
    std::error_code none_needed;
    std::filesystem::remove(path_, none_needed);
  }
  WrittenRecording(const WrittenRecording&) = delete;
  WrittenRecording& operator=(const WrittenRecording&) = delete;
  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  std::string path_;
  std::size_t size_ = 0;
};

void read_text_recording(benchmark::State& state) {
  const WrittenRecording file(static_cast<std::size_t>(state.range(0)));
  zwidth::RecordingOptions options;
  options.columns = {{"F", 1.0}, {"x", 1.0}};
  for (auto _ : state) {
    const auto recording = zwidth::read_recording(file.path(), options);
    if (!recording) {
      state.SkipWithError(recording.error().str().c_str());
      return;
    }
    benchmark::DoNotOptimize(recording);
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(file.size()) * static_cast<std::int64_t>(state.iterations()));
}

BENCHMARK(read_text_recording)->Arg(20000)->Arg(1000000)->Unit(benchmark::kMillisecond);

}  // namespace
