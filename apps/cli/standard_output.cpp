#include "cli/standard_output.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <new>
#include <optional>
#include <string>

#include "cli/subcommand.hpp"
#include "report/text/text_medium.hpp"

namespace zwidth::cli {
namespace {

// Characters of a line: fewer leave no room for the values beside their labels, more are hard to read.
constexpr std::size_t narrowest_lines = 40;
constexpr std::size_t widest_lines = 100;

/// 0, or the errno of the failed write.
int write_all(int descriptor, std::string_view text) noexcept {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written >= 0) {
      text.remove_prefix(static_cast<std::size_t>(written));
    } else if (errno != EINTR) {
      return errno;
    }
  }
  return 0;
}

/// Whether the locale's letters are UTF-8, by the variables that POSIX looks at, the first that is set.
bool has_utf8_letters() {
  for (const char* variable : {"LC_ALL", "LC_CTYPE", "LANG"}) {
    const char* value = std::getenv(variable);
    if (value == nullptr || *value == '\0') continue;
    std::string name;
    for (; *value != '\0'; ++value) name += static_cast<char>(std::tolower(static_cast<unsigned char>(*value)));
    return name.find("utf-8") != std::string::npos || name.find("utf8") != std::string::npos;
  }
  return false;
}

/// $COLUMNS, or the columns of the terminal; none where lines need no end: a file or a pipe.
std::optional<std::size_t> columns() {
  if (const char* variable = std::getenv("COLUMNS")) {
    const std::string_view text = variable;
    std::size_t count = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
    if (error == std::errc{} && end == text.data() + text.size() && count > 0) return count;
  }
  if (::isatty(STDOUT_FILENO) == 0) return std::nullopt;
  winsize window{};
  const bool is_known = ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &window) == 0 && window.ws_col > 0;
  return is_known ? window.ws_col : widest_lines;
}

report::TextMedium medium_of_output() {
  const auto available = columns();
  return {.line_length = available ? std::clamp(*available, narrowest_lines, widest_lines) : report::no_line_end,
          .is_ascii = !has_utf8_letters()};
}

}  // namespace

void prepare_standard_output() {
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);  // a file-size limit is then a failed write, which is reported
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    const bool closed = ::fcntl(descriptor, F_GETFD) == -1 && errno == EBADF;
    // open() takes the lowest free number, which is this one. The wrong direction on purpose: using it stays an error.
    if (closed) ::open("/dev/null", descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY);
  }
  report::set_text_medium(medium_of_output());
}

void write_standard_output(std::string_view text) {
  const int failure = write_all(STDOUT_FILENO, text);
  if (failure == EPIPE) std::_Exit(0);
  if (failure != 0) throw WorkFailed(fmt::format("standard output: cannot write: {}", std::strerror(failure)));
}

void write_text(std::string_view text) { write_standard_output(report::for_medium(text)); }

void write_standard_error(std::string_view text) noexcept {
  try {
    write_all(STDERR_FILENO, report::for_medium(text));
  } catch (const std::bad_alloc&) {
    write_all(STDERR_FILENO, text);
  }
}

}  // namespace zwidth::cli
