#include "cli/progress_line.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <utility>

#include "cli/request_context.hpp"
#include "cli/standard_output.hpp"

namespace zwidth::cli {
namespace {

using std::chrono::milliseconds;
constexpr milliseconds quiet_for{500};
constexpr milliseconds apart{100};
constexpr std::string_view back_and_wipe = "\r\x1b[K";

}  // namespace

ProgressLine::ProgressLine(const CLI::App& command, std::string work)
    : request_(request_of(command)),
      work_(std::move(work)),
      terminal_(::isatty(STDERR_FILENO) == 1),
      next_(std::chrono::steady_clock::now() + quiet_for) {}

ProgressLine::~ProgressLine() { wipe(); }

void ProgressLine::wipe() {
  if (std::exchange(shown_, false)) write_standard_error(back_and_wipe);
}

Progress ProgressLine::progress(double from, double to) {
  if (request_ != nullptr) {
    if (!request_->progress) return {};
    return [own = request_, from, to](double fraction) { own->progress(from + fraction * (to - from)); };
  }
  if (!terminal_) return {};
  return [this, from, to](double fraction) { show(from + fraction * (to - from)); };
}

void ProgressLine::show(double fraction) {
  if (fraction >= 1.0) return wipe();  // the answer may be printed before this is gone
  const auto now = std::chrono::steady_clock::now();
  if (now < next_) return;
  next_ = now + apart;
  shown_ = true;
  write_standard_error(
      fmt::format("{}{}: {:3.0f} %{}{}", back_and_wipe, work_, 100.0 * fraction, note_.empty() ? "" : ", ", note_));
}

}  // namespace zwidth::cli
