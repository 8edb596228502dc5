#pragma once

#include <chrono>
#include <string>
#include <utility>

#include "zwidth/progress.hpp"

namespace zwidth::cli {

/// One line on a terminal's standard error that shows how far long work is, and is wiped when it ends. Nothing is
/// written where standard error is no terminal, nor for work of less than half a second.
class ProgressLine {
 public:
  explicit ProgressLine(std::string work);  ///< "reading run.csv"
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// What follows the per cent: "12 000 units/s, 3 min left".
  void note(std::string text) { note_ = std::move(text); }

  /// To hand to the library, for the part of the work from one fraction to another; must not outlive this.
  [[nodiscard]] Progress progress(double from = 0.0, double to = 1.0);

 private:
  void show(double fraction);
  void wipe();

  std::string work_;
  std::string note_;
  bool terminal_;
  bool shown_ = false;
  std::chrono::steady_clock::time_point next_;
};

}  // namespace zwidth::cli
