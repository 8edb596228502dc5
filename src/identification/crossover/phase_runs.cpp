#include "identification/crossover/phase_runs.hpp"

#include <algorithm>
#include <cmath>

namespace zwidth::internal {
namespace {

/// Standard deviations of pure noise that a swing of the evidence must reach.
constexpr double proof = 4.0;

/// The running sum of the evidence, from 0, and what pure noise makes of `lines` of it.
class PhaseEvidence {
 public:
  PhaseEvidence(const std::vector<PhaseLine>& lines, double line_correlation) : correlation_(line_correlation) {
    sum_.push_back(0.0);
    for (const PhaseLine& line : lines) sum_.push_back(sum_.back() + line.evidence);
  }

  [[nodiscard]] std::size_t end() const { return sum_.size(); }
  [[nodiscard]] double at(std::size_t i) const { return sum_[i]; }

  /// The change of the sum from i to j > i, in standard deviations.
  [[nodiscard]] double change(std::size_t i, std::size_t j) const {
    const double lines = static_cast<double>(j - i);
    return (sum_[j] - sum_[i]) / std::sqrt(std::min(lines * lines, lines * correlation_));
  }

 private:
  std::vector<double> sum_;
  double correlation_;
};

/// A place where the running sum turns: lines before it have evidence of `sign`, those after it of the other one.
struct Turn {
  std::size_t at = 0;
  int sign = 0;
};

/// Turning points followed by a swing that is proof; the first entry is the start, with the sign of what
/// came before it, which is the other one than that of the first swing.
std::vector<Turn> turns(const PhaseEvidence& evidence) {
  std::vector<Turn> found;
  std::size_t highest = 0;
  std::size_t lowest = 0;
  for (std::size_t j = 1; j < evidence.end(); ++j) {
    const int direction = found.empty() ? 0 : -found.back().sign;
    const bool falls = direction >= 0 && evidence.change(highest, j) <= -proof;
    const bool rises = direction <= 0 && evidence.change(lowest, j) >= proof;
    if (falls) {
      found.push_back({highest, +1});
      lowest = j;
    } else if (rises) {
      found.push_back({lowest, -1});
      highest = j;
    }
    if (evidence.at(j) >= evidence.at(highest)) highest = j;
    if (evidence.at(j) <= evidence.at(lowest)) lowest = j;
  }
  return found;
}

}  // namespace

std::vector<PhaseRun> phase_runs(const std::vector<PhaseLine>& lines, double line_correlation) {
  const std::vector<Turn> proven = turns(PhaseEvidence(lines, line_correlation));
  std::vector<PhaseRun> runs;
  for (std::size_t i = 0; i < proven.size(); ++i) {
    const std::size_t first = i == 0 ? 0 : proven[i].at;
    const std::size_t end = i + 1 < proven.size() ? proven[i + 1].at : lines.size();
    runs.push_back({first, end - 1, -proven[i].sign});
  }
  return runs;
}

}  // namespace zwidth::internal
