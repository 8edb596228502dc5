// How often identify() is right: records of some sixty kinds, linear and not, from a simulator that shares nothing with it.
//
//   record_campaign [--kinds A,B] [--seeds FIRST:COUNT] [--noises N] [--results FILE] [--time-limit S] [--budget S]
//                   [--method lines|frf] [--reasons] [--require] [--list]
//
// One line a record: kind, seed, noise, verdict, lower end, value, upper end, truth, processor seconds, bodies, samples.
// Then, by kind and of all, the figures that the answers are held to. The same seed is the same device and force, whatever
// else is asked; `--noises 3` records each device three times. `--results` keeps the lines in a file, goes on after those
// that stand there, and counts them all: files of several runs may be joined, and `--seeds 1:0` only counts. No record
// begins after the time limit (processor seconds of all); one that takes longer than its budget is `late`. `--require`: exit
// status 1 where a figure is missed. `--method frf`: the limit that the response shows without a structure, of devices that
// nothing holds still; `lines`: identify() from the lines of the response.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <tuple>

#include "identification/campaign/bench.hpp"
#include "identification/campaign/figures.hpp"
#include "identification/campaign/judge.hpp"
#include "identification/campaign/kinds.hpp"

namespace {

using namespace zwidth::test::campaign;

struct Options {
  std::set<std::string> kinds{};  ///< empty: all
  std::uint64_t first = 1;
  std::uint64_t count = 1;
  std::uint64_t noises = 1;
  std::string results{};
  double time_limit = 1e18;
  JudgeOptions judge{};
  bool require = false;
};

Options options_of(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    const auto value = [&]() -> std::string {
      if (i + 1 >= argc) {
        std::fprintf(stderr, "record_campaign: %s needs a value\n", name.c_str());
        std::exit(2);
      }
      return argv[++i];
    };
    if (name == "--kinds") {
      std::istringstream words(value());
      for (std::string word; std::getline(words, word, ',');) options.kinds.insert(word);
    } else if (name == "--seeds") {
      const std::string range = value();
      options.first = std::strtoull(range.c_str(), nullptr, 10);
      const auto colon = range.find(':');
      if (colon != std::string::npos) options.count = std::strtoull(range.c_str() + colon + 1, nullptr, 10);
    } else if (name == "--noises") {
      options.noises = std::strtoull(value().c_str(), nullptr, 10);
    } else if (name == "--results") {
      options.results = value();
    } else if (name == "--time-limit") {
      options.time_limit = std::strtod(value().c_str(), nullptr);
    } else if (name == "--budget") {
      options.judge.budget = std::strtod(value().c_str(), nullptr);
    } else if (name == "--method") {
      const std::string method = value();
      if (method == "lines") options.judge.method = Method::lines;
      if (method == "frf") options.judge.method = Method::response;
    } else if (name == "--reasons") {
      options.judge.reasons = true;
    } else if (name == "--require") {
      options.require = true;
    } else if (name == "--list") {
      for (const Kind& kind : kinds()) std::printf("%s\n", kind.name);
      std::exit(0);
    } else {
      std::fprintf(stderr, "record_campaign: no option %s\n", name.c_str());
      std::exit(2);
    }
  }
  return options;
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = options_of(argc, argv);
  for (const std::string& name : options.kinds) {
    if (find_kind(name) != nullptr) continue;
    std::fprintf(stderr, "record_campaign: no kind %s; --list names them\n", name.c_str());
    return 2;
  }
  Lines lines;
  std::set<std::tuple<std::string, std::uint64_t, std::uint64_t>> done;
  if (!options.results.empty()) {
    std::ifstream before(options.results);
    for (std::string text; std::getline(before, text);) {
      const auto line = line_of(text);
      if (!line || find_kind(line->kind) == nullptr || !done.insert({line->kind, line->seed, line->noise}).second)
        continue;
      lines.push_back(*line);
    }
  }
  std::ofstream kept;
  if (!options.results.empty()) kept.open(options.results, std::ios::app);
  for (std::uint64_t seed = options.first; seed < options.first + options.count; ++seed) {
    for (const Kind& kind : kinds()) {
      if (!options.kinds.empty() && !options.kinds.contains(kind.name)) continue;
      for (std::uint64_t noise = 0; noise < options.noises; ++noise) {
        if (done.contains({kind.name, seed, noise}) || detail::processor_seconds() > options.time_limit) continue;
        const Case made = drawn_case(kind, seed);
        if (options.judge.method == Method::response && !made.locked.empty()) continue;
        std::string reasons;
        lines.push_back(judged(made, noise, options.judge, reasons));
        const std::string text = text_of(lines.back());
        std::printf("%s%s\n%s", text.c_str(), lines.back().unsafe() ? " UNSAFE" : "",
                    options.judge.reasons ? reasons.c_str() : "");
        std::fflush(stdout);
        if (kept.is_open()) kept << text << '\n' << std::flush;
      }
    }
  }
  const bool holds = print_totals(lines);
  return options.require && !holds ? 1 : 0;
}
