#pragma once

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

namespace zwidth::test {

/// A program that runs until it is killed, and what it prints.
class PrintingProcess {
 public:
  explicit PrintingProcess(std::vector<std::string> words) {
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0) throw std::runtime_error("no pipe");
    process_ = fork();
    if (process_ == 0) {
      dup2(ends[1], 1);
      close(ends[0]);
      close(ends[1]);
      execv(arguments.front(), arguments.data());
      _exit(127);
    }
    close(ends[1]);
    output_ = fdopen(ends[0], "r");
  }
  ~PrintingProcess() {
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
    std::fclose(output_);
  }
  PrintingProcess(const PrintingProcess&) = delete;
  PrintingProcess& operator=(const PrintingProcess&) = delete;

  [[nodiscard]] std::string line() const {
    std::array<char, 64> text{};
    return std::fgets(text.data(), text.size(), output_) != nullptr ? text.data() : "";
  }

 private:
  pid_t process_ = -1;
  FILE* output_ = nullptr;
};

}  // namespace zwidth::test
