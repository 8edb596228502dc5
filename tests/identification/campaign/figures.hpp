#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "identification/campaign/judge.hpp"
#include "identification/campaign/kinds.hpp"

/// The figures that the answers of the campaign are held to.
namespace zwidth::test::campaign {

using Lines = std::vector<Line>;

namespace detail {

inline double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
}

inline std::size_t count(const Lines& lines, const std::function<bool(const Line&)>& of) {
  return static_cast<std::size_t>(std::ranges::count_if(lines, of));
}

inline void print_row(const std::string& name, const char* marks, const Lines& lines) {
  std::vector<double> seconds;
  std::vector<double> errors;
  std::vector<double> widths;
  for (const Line& line : lines) {
    seconds.push_back(line.seconds);
    if (!line.answered()) continue;
    errors.push_back(100.0 * (line.value / line.truth - 1.0));
    widths.push_back(line.upper / line.lower);
  }
  const std::size_t answered = count(lines, &Line::answered);
  std::printf("%-24s %-4s %5zu %5zu %6zu %6zu %5zu %5zu %6zu %4zu/%-4zu %8.2f %8.3g %8.2f %8.2f\n", name.c_str(), marks,
              lines.size(), count(lines, &Line::sound), count(lines, &Line::unsafe),
              answered - count(lines, &Line::sound), count(lines, &Line::is_false_doubt),
              count(lines, [](const Line& l) { return l.verdict == "refused"; }),
              count(lines, [](const Line& l) { return l.verdict == "failed" || l.verdict == "late"; }),
              count(lines, &Line::holds), answered, quantile(errors, 0.5), quantile(widths, 0.5),
              quantile(seconds, 0.5), quantile(seconds, 1.0));
}

/// One figure beside what it is held to; whether it holds.
inline bool figure(const char* what, std::size_t part, std::size_t whole, double bound, bool at_most) {
  if (whole == 0) return true;
  const double share = 100.0 * static_cast<double>(part) / static_cast<double>(whole);
  const bool holds = at_most ? share <= bound : share >= bound;
  std::printf("%-72s %5zu of %5zu, %5.1f %%, at %s %4.1f %%%s\n", what, part, whole, share, at_most ? "most" : "least",
              bound, holds ? "" : "   MISSED");
  return holds;
}

inline bool print_figures(const Lines& lines) {
  const auto evidence = [](const Line& l) { return find_kind(l.kind)->evidence; };
  Lines judged;
  Lines as_docs;
  for (const Line& line : lines) {
    if (evidence(line) != Evidence::none) judged.push_back(line);
    if (find_kind(line.kind)->as_docs) as_docs.push_back(line);
  }
  bool holds = true;
  const std::size_t sound = count(judged, &Line::sound);
  std::printf("\nwhat is held to (without the kinds that no record shows)\n");
  holds &= figure("sound, lower end above the truth", count(judged, &Line::unsafe), sound, 2.5, true);
  const auto far = [](const Line& l) { return l.sound() && l.lower > 1.1 * l.truth; };
  holds &= figure("sound, lower end above the truth by more than 10 %", count(judged, far), sound, 0.0, true);
  holds &=
      figure("intervals that hold the truth", count(judged, &Line::holds), count(judged, &Line::answered), 95.0, false);
  holds &= figure("made as the docs say: sound", count(as_docs, &Line::sound), as_docs.size(), 90.0, false);
  holds &= figure("made as the docs say: within 10 %", count(as_docs, &Line::is_narrow), as_docs.size(), 80.0, false);
  const auto doubtful = [](const Line& l) { return l.verdict == "doubtful"; };
  const auto falsely = [&](const Line& l) { return evidence(l) == Evidence::of_limit && l.is_false_doubt(); };
  holds &= figure("doubts of answers within 5 % on the safe side", count(judged, falsely), count(judged, doubtful),
                  10.0, true);
  const auto narrowly = [&](const Line& l) { return falsely(l) && l.upper <= 1.5 * l.lower; };
  std::printf("  of these with an interval within a factor of 1.5: %zu\n", count(judged, narrowly));

  std::map<std::pair<std::string, std::uint64_t>, std::map<std::string, std::size_t>> verdicts;
  for (const Line& line : lines) ++verdicts[{line.kind, line.seed}][line.verdict];
  std::size_t again = 0;
  std::size_t flips = 0;
  for (const auto& [device, each] : verdicts) {
    std::size_t all = 0;
    std::size_t most = 0;
    for (const auto& [verdict, number] : each) {
      all += number;
      most = std::max(most, number);
    }
    if (all < 2) continue;
    again += all;
    flips += all - most;
  }
  holds &= figure("of one device: another verdict than most, by the noise alone", flips, again, 5.0, true);

  const std::map<std::size_t, double> medians{{1, 0.5}, {2, 2.0}, {3, 10.0}};
  for (const auto& [bodies, most] : medians) {
    std::vector<double> seconds;
    for (const Line& line : lines) {
      constexpr double usual = 10000.0;  // samples: 10 s at 1 kHz
      if (line.bodies == bodies && line.samples > 0) {
        seconds.push_back(line.seconds * usual / static_cast<double>(line.samples));
      }
    }
    if (seconds.empty()) continue;
    const double median = quantile(seconds, 0.5);
    const double longest = quantile(seconds, 1.0);
    const bool fast = median <= most && longest <= 5.0 * most;
    std::printf(
        "processor seconds of 10 000 samples, %zu bodies: median %.2f, at most %.1f; longest %.1f, at most %.1f%s\n",
        bodies, median, most, longest, 5.0 * most, fast ? "" : "   MISSED");
    holds &= fast;
  }
  double most = 0.0;
  for (const Line& line : judged) {
    if (line.unsafe()) most = std::max(most, line.lower / line.truth - 1.0);
  }
  std::printf("the farthest that a sound answer's lower end is above the truth: %.2f %%\n", 100.0 * most);
  return holds;
}

}  // namespace detail

/// The table by kind, then the figures; whether all hold. Every line is of a kind.
inline bool print_totals(const Lines& lines) {
  std::printf("\n%-24s %-4s %5s %5s %6s %6s %5s %5s %6s %9s %8s %8s %8s %8s\n", "kind", "", "all", "sound", "unsafe",
              "doubt", "false", "refus", "failed", "holds", "error %", "up/low", "median s", "longest");
  for (const Kind& kind : kinds()) {
    Lines of_kind;
    for (const Line& line : lines) {
      if (line.kind == kind.name) of_kind.push_back(line);
    }
    const char* marks = kind.as_docs                      ? "docs"
                        : kind.evidence == Evidence::open ? "open"
                        : kind.evidence == Evidence::none ? "none"
                                                          : "";
    if (!of_kind.empty()) detail::print_row(kind.name, marks, of_kind);
  }
  detail::print_row("all", "", lines);
  return detail::print_figures(lines);
}

}  // namespace zwidth::test::campaign
