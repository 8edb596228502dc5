#pragma once

#include <CLI/App.hpp>
#include <chrono>
#include <string>
#include <utility>

#include "zwidth/progress.hpp"

namespace zwidth::cli {

struct RequestContext;

/// One line on a terminal's standard error that shows how far long work is, and is wiped when it ends. Nothing is
/// written where standard error is no terminal, nor for work of less than half a second.
class ProgressLine {
 public:
  /// `work`: "reading run.csv". Of a request it is the request's own progress that is told.
  ProgressLine(const CLI::App& command, std::string work);
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

  const RequestContext* request_;
  std::string work_;
  std::string note_;
  bool terminal_;
  bool shown_ = false;
  std::chrono::steady_clock::time_point next_;
};

}  // namespace zwidth::cli
