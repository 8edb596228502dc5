#include "report/figure/gnuplot.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <optional>
#include <thread>
#include <utility>

#include "report/output_file.hpp"

extern char** environ;

namespace zwidth::report {
namespace {

using Clock = std::chrono::steady_clock;

[[noreturn]] void fail(std::string_view what, int error) {
  throw OutputFailed(fmt::format("gnuplot: {}: {}", what, std::strerror(error)));
}

[[noreturn]] void fail_late(std::chrono::milliseconds time_limit) {
  throw OutputFailed(fmt::format("gnuplot did not finish within {} s and was stopped",
                                 std::chrono::duration<double>(time_limit).count()));
}

/// Far above any picture of ours.
constexpr std::size_t size_limit = std::size_t{256} << 20;

struct Pipe {
  std::array<int, 2> ends{-1, -1};
  Pipe() {
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) fail("cannot make a pipe", errno);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  ~Pipe() {
    close_end(0);
    close_end(1);
  }
  void close_end(std::size_t end) {
    if (ends[end] >= 0) ::close(std::exchange(ends[end], -1));
  }
};

/// A running gnuplot: killed and reaped on every way out, so that none is left behind.
class Child {
 public:
  Child(Pipe& input, Pipe& output, Pipe& errors) {
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, input.ends[0], STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, output.ends[1], STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, errors.ends[1], STDERR_FILENO);
    // --default-settings: a start-up file of the user must not change our figures.
    std::array<char*, 3> arguments{const_cast<char*>("gnuplot"), const_cast<char*>("--default-settings"), nullptr};
    const int error = ::posix_spawnp(&id_, arguments[0], &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (error == ENOENT) {
      throw OutputFailed("gnuplot is not installed, and figures are drawn with it: apt-get install gnuplot-nox");
    }
    if (error != 0) fail("cannot start", error);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    if (id_ > 0) {
      ::kill(id_, SIGKILL);
      int status = 0;
      while (::waitpid(id_, &status, 0) < 0 && errno == EINTR) {
      }
    }
  }
  /// The exit status, or nothing when it still runs at the deadline.
  std::optional<int> wait_until(Clock::time_point deadline) {
    int status = 0;
    while (::waitpid(id_, &status, WNOHANG) == 0) {
      if (Clock::now() > deadline) return std::nullopt;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    id_ = -1;
    return status;
  }

 private:
  pid_t id_ = -1;
};

/// Appends what can be read without blocking; closes the end of the pipe at its end of file.
void drain(Pipe& pipe, std::string& text) {
  std::array<char, 65536> buffer;
  const ssize_t count = ::read(pipe.ends[0], buffer.data(), buffer.size());
  if (count > 0) text.append(buffer.data(), static_cast<std::size_t>(count));
  if (count == 0 || (count < 0 && errno != EINTR && errno != EAGAIN)) pipe.close_end(0);
}

/// Sends what can be sent without blocking; closes the end when all is sent or gnuplot has stopped reading.
void feed(Pipe& pipe, std::string_view& script) {
  const ssize_t count = ::write(pipe.ends[1], script.data(), script.size());
  if (count > 0) script.remove_prefix(static_cast<std::size_t>(count));
  if (script.empty() || (count < 0 && errno != EINTR && errno != EAGAIN)) pipe.close_end(1);
}

/// A gnuplot that stops reading early must not end us; its own message is the one to report.
class IgnoreBrokenPipe {
 public:
  IgnoreBrokenPipe() : previous_(::signal(SIGPIPE, SIG_IGN)) {}
  IgnoreBrokenPipe(const IgnoreBrokenPipe&) = delete;
  IgnoreBrokenPipe& operator=(const IgnoreBrokenPipe&) = delete;
  ~IgnoreBrokenPipe() { ::signal(SIGPIPE, previous_); }

 private:
  void (*previous_)(int);
};

std::string one_line(std::string text) {
  for (char& character : text) {
    if (character == '\n') character = ' ';
  }
  constexpr std::size_t enough = 300;
  return text.substr(0, enough);
}

}  // namespace

std::string run_gnuplot(std::string_view script, std::chrono::milliseconds time_limit) {
  const Clock::time_point deadline = Clock::now() + time_limit;
  const IgnoreBrokenPipe ignore_broken_pipe;
  Pipe input;
  Pipe output;
  Pipe errors;
  Child child(input, output, errors);
  input.close_end(0);
  output.close_end(1);
  errors.close_end(1);
  ::fcntl(input.ends[1], F_SETFL, O_NONBLOCK);

  std::string picture;
  std::string complaint;
  while (output.ends[0] >= 0 || errors.ends[0] >= 0) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    std::array<pollfd, 3> waiting{pollfd{input.ends[1], POLLOUT, 0}, pollfd{output.ends[0], POLLIN, 0},
                                  pollfd{errors.ends[0], POLLIN, 0}};
    const int ready = left > 0 ? ::poll(waiting.data(), waiting.size(), static_cast<int>(left)) : 0;
    if (ready == 0) fail_late(time_limit);
    if (ready < 0) {
      if (errno == EINTR) continue;
      fail("cannot wait for it", errno);
    }
    if (waiting[0].revents != 0) feed(input, script);
    if (waiting[1].revents != 0) drain(output, picture);
    if (waiting[2].revents != 0) drain(errors, complaint);
    if (picture.size() + complaint.size() > size_limit) throw OutputFailed("gnuplot wrote without end and was stopped");
  }
  const std::optional<int> status = child.wait_until(deadline);
  if (!status) fail_late(time_limit);
  if (!WIFEXITED(*status) || WEXITSTATUS(*status) != 0 || picture.empty()) {
    throw OutputFailed("gnuplot failed: " + one_line(complaint.empty() ? "no message" : complaint));
  }
  return picture;
}

std::string gnuplot_string(std::string_view text) {
  std::string quoted = "'";
  for (const char character : text) {
    if (character == '\'') quoted += '\'';
    const auto byte = static_cast<unsigned char>(character);
    quoted += byte < 0x20 || byte == 0x7f ? ' ' : character;
  }
  return quoted + "'";
}

}  // namespace zwidth::report
