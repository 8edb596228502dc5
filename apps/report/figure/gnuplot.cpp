#include "report/figure/gnuplot.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <boost/process/child.hpp>
#include <boost/process/cmd.hpp>
#include <boost/process/io.hpp>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <system_error>
#include <thread>
#include <utility>

#include "report/output_file.hpp"
#include "report/text/markup.hpp"

namespace zwidth::report {
namespace {

namespace process = boost::process;

[[noreturn]] void fail(std::string_view what, std::string_view why) {
  throw OutputFailed(fmt::format("gnuplot: {}: {}", what, why));
}

/// An unnamed file that is gone when it is closed. Files instead of pipes: a gnuplot that stops reading or never stops
/// writing can neither end nor block us, and no signal of the process needs to be touched.
class TemporaryFile {
 public:
  TemporaryFile() : file_(std::tmpfile()) {
    if (!file_) fail("cannot make a temporary file", std::strerror(errno));
  }
  [[nodiscard]] FILE* get() const { return file_.get(); }
  [[nodiscard]] std::size_t size() const {
    struct stat status {};  // not by seeking: the child shares our place in the file
    return ::fstat(::fileno(get()), &status) == 0 ? static_cast<std::size_t>(status.st_size) : 0;
  }
  void write(std::string_view text) const {
    if (std::fwrite(text.data(), 1, text.size(), get()) != text.size() || std::fflush(get()) != 0) {
      fail("cannot write its script", std::strerror(errno));
    }
    std::rewind(get());
  }
  [[nodiscard]] std::string read() const {
    std::string text(size(), '\0');
    std::rewind(get());
    text.resize(std::fread(text.data(), 1, text.size(), get()));
    return text;
  }

 private:
  struct Close {
    void operator()(FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<FILE, Close> file_;
};

/// Far above any picture of ours.
constexpr std::size_t size_limit = std::size_t{256} << 20;
constexpr std::chrono::milliseconds polling_period(2);

/// Its messages in one line, or that there is none.
std::string complaint_of(const TemporaryFile& errors) {
  std::string text = errors.read();
  for (char& character : text) {
    if (character == '\n') character = ' ';
  }
  constexpr std::size_t enough = 300;
  text = text.substr(0, enough);
  return text.find_first_not_of(' ') == std::string::npos ? "no message" : text;
}

/// Stops and reaps a gnuplot on every way out, so that none is left behind.
class Child {
 public:
  Child(const TemporaryFile& script, const TemporaryFile& picture, const TemporaryFile& errors) {
    std::error_code error;
    // --default-settings: a start-up file of the user must not change our figures.
    child_ = process::child(process::cmd = "gnuplot --default-settings",
                            process::std_in<script.get(), process::std_out> picture.get(),
                            process::std_err > errors.get(), error);
    if (error == std::errc::no_such_file_or_directory) {
      throw OutputFailed("gnuplot is not installed, and figures are drawn with it: apt-get install gnuplot-nox");
    }
    if (error) fail("cannot start", error.message());
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    std::error_code ignored;
    if (child_.running(ignored)) child_.terminate(ignored);
  }
  [[nodiscard]] bool running() { return child_.running(); }
  [[nodiscard]] bool succeeded() const { return child_.exit_code() == 0; }

 private:
  process::child child_;
};

}  // namespace

std::string run_gnuplot(std::string_view script, std::chrono::milliseconds time_limit) {
  const auto deadline = std::chrono::steady_clock::now() + time_limit;
  const TemporaryFile input;
  const TemporaryFile picture;
  const TemporaryFile errors;
  input.write(script);
  Child child(input, picture, errors);
  while (child.running()) {
    if (std::chrono::steady_clock::now() > deadline) {
      throw OutputFailed(fmt::format("gnuplot did not finish within {} s and was stopped",
                                     std::chrono::duration<double>(time_limit).count()));
    }
    if (picture.size() + errors.size() > size_limit) throw OutputFailed("gnuplot wrote without end and was stopped");
    std::this_thread::sleep_for(polling_period);
  }
  std::string drawn = picture.read();
  if (!child.succeeded() || drawn.empty()) throw OutputFailed("gnuplot failed: " + complaint_of(errors));
  return drawn;
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

std::string gnuplot_text(std::string_view text) {
  constexpr std::string_view delay = "e^(-t_d s)";
  std::string enhanced;
  bool has_symbol = false;
  for (std::size_t at = 0; at < text.size();) {
    std::size_t length = 1;
    if (text.substr(at).starts_with(delay)) {
      enhanced += "e^{-t_d s}";
      length = delay.size();
    } else if (const Symbol* symbol = symbol_at(text, at)) {
      enhanced += fmt::format("{}_{{{}}}", symbol->base, symbol->subscript);
      length = symbol->text.size();
    } else {
      if (std::string_view("_^{}@&~\\").find(text[at]) != std::string_view::npos) enhanced += '\\';
      enhanced += text[at];
    }
    has_symbol = has_symbol || length > 1;
    at += length;
  }
  return has_symbol ? gnuplot_string(enhanced) + " enhanced" : gnuplot_string(text) + " noenhanced";
}

}  // namespace zwidth::report
