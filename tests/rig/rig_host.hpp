#pragma once

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace zwidth::test {

/// How often each fault is tried.
inline int times(int otherwise) {
  const char* given = std::getenv("ZWIDTH_RIG_FAULTS");
  return given != nullptr ? std::max(1, std::atoi(given)) : otherwise;
}

inline bool within(std::chrono::milliseconds patience, const std::function<bool()>& happens) {
  const auto until = std::chrono::steady_clock::now() + patience;
  while (!happens()) {
    if (std::chrono::steady_clock::now() > until) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

/// `zwidth rig ACTION` on a drive, for ever: wall, unless told.
class Host {
 public:
  Host(const std::filesystem::path& folder, const std::string& driver, const std::string& name,
       const std::string& record, const std::vector<std::string>& more = {}, const std::string& action = "wall") {
    errors_ = folder / (name + ".errors");
    std::vector<std::string> words{ZWIDTH_PROGRAM,
                                   "rig",
                                   action,
                                   folder / "device.toml",
                                   "--driver",
                                   driver,
                                   "--position-limit",
                                   "1",
                                   "--duration",
                                   "100",
                                   "--amplitude",
                                   "1",
                                   "--ramp",
                                   "0",
                                   "--flight-record",
                                   record};
    words.insert(words.end(), more.begin(), more.end());
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    process_ = fork();
    if (process_ != 0) return;
    const int output = open(errors_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    dup2(output, 1);
    dup2(output, 2);
    execv(ZWIDTH_PROGRAM, arguments.data());
    _exit(127);
  }
  ~Host() {
    if (process_ > 0) kill(process_, SIGKILL), waitpid(process_, nullptr, 0);
  }
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;

  void send(int signal) const { kill(process_, signal); }
  /// Its exit status; -1 where it does not end in time, or by a signal.
  int status() {
    int status = 0;
    if (!within(std::chrono::seconds(20), [&] { return waitpid(process_, &status, WNOHANG) == process_; })) return -1;
    process_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  [[nodiscard]] bool has_ended() {
    siginfo_t info{};
    return process_ > 0 && waitid(P_PID, static_cast<id_t>(process_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
           info.si_pid != 0;
  }
  [[nodiscard]] std::string errors() const {
    std::stringstream text;
    text << std::ifstream(errors_).rdbuf();
    return text.str();
  }

 private:
  std::filesystem::path errors_;
  pid_t process_ = -1;
};

}  // namespace zwidth::test
