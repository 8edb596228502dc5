// How often identify_in_time() is right: simulated rigid and two-body devices with dry friction of 1 to 20 % of the force,
// encoder, noise, disturbance, delay and lag, one recording of 20 s at 1 kHz or two of different force.
//
//   friction_campaign [FIRST_SEED [COUNT]]
//
// One line per device, then how many 95 % intervals of the critical stiffness hold the truth.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "property/friction_recordings.hpp"
#include "zwidth/error.hpp"
#include "zwidth/identification/time_domain.hpp"

namespace {

using namespace zwidth;

struct Count {
  int all = 0;
  int failed = 0;
  int refused = 0;
  int sound = 0;
  int sound_unsafe = 0;  ///< the interval's lower end above the truth
  int far_unsafe = 0;    ///< by more than 10 %
  int answered = 0;
  int held = 0;  ///< the interval holds the truth
  std::vector<double> errors;
  std::vector<double> seconds;
};

}  // namespace

int main(int argc, char** argv) {
  const auto first = static_cast<std::uint64_t>(argc > 1 ? std::atoll(argv[1]) : 1);
  const auto number = static_cast<std::uint64_t>(argc > 2 ? std::atoll(argv[2]) : 200);
  Count count;
  for (std::uint64_t seed = first; seed < first + number; ++seed) {
    const test::FrictionRecordings made = test::friction_recordings(seed);
    const auto begin = std::chrono::steady_clock::now();
    const auto seconds = [&] {
      return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    };
    ++count.all;
    TimeDomainOptions options;
    options.structure_values = IdentifyOptions::StructureValues::placeholders;
    try {
      const TimeDomainIdentification found = identify_in_time(made.recordings, Device(made.structure), options);
      count.seconds.push_back(seconds());
      const char* verdict = found.trust.sound() ? "sound" : found.trust.refused() ? "refused" : "doubtful";
      count.refused += found.trust.refused();
      const double value = found.analysis.critical.stiffness;
      double lower = value;
      double upper = value;
      if (found.analysis.interval) {
        lower = found.analysis.interval->lower;
        upper = found.analysis.interval->upper;
      }
      const bool holds = lower <= made.stiffness && made.stiffness <= upper;
      std::printf("%5llu %-8s %s true %.5g at %.3g Hz, found %.5g (%+.2f %%) [%.5g, %.5g], %.1f s: %s\n",
                  static_cast<unsigned long long>(seed), verdict, holds ? "holds " : "MISSES", made.stiffness,
                  made.limiting_hz, value, 100.0 * (value / made.stiffness - 1.0), lower, upper, seconds(),
                  made.what.c_str());
      for (const std::string& reason : found.trust.reasons) std::printf("      %s\n", reason.c_str());
      for (const FittedMotion& each : found.motions) {
        std::printf("      unexplained %.4f, feedback %.2f\n", each.unexplained, each.feedback);
      }
      if (!found.trust.refused()) {
        ++count.answered;
        count.held += holds;
        count.errors.push_back(std::abs(value / made.stiffness - 1.0));
        count.sound += found.trust.sound();
        count.sound_unsafe += found.trust.sound() && lower > made.stiffness;
        count.far_unsafe += found.trust.sound() && lower > 1.1 * made.stiffness;
      }
    } catch (const Error& error) {
      ++count.failed;
      std::printf("%5llu failed %.1f s: %s: %s\n", static_cast<unsigned long long>(seed), seconds(), made.what.c_str(),
                  error.what());
    }
    std::fflush(stdout);
  }
  std::ranges::sort(count.errors);
  std::ranges::sort(count.seconds);
  const auto within = std::ranges::count_if(count.errors, [](double error) { return error <= 0.05; });
  std::printf(
      "%d devices: %d answered (%d sound, of which %d with the lower end above the truth, %d by more than 10 %%), %d "
      "refused, %d failed\n",
      count.all, count.answered, count.sound, count.sound_unsafe, count.far_unsafe, count.refused, count.failed);
  if (count.errors.empty()) return 0;
  std::printf(
      "interval holds the truth %d/%d; within 5 %% %d/%d; median error %.2g %%, largest %.2g %%; median %.2f s, "
      "longest %.2f s\n",
      count.held, count.answered, static_cast<int>(within), count.answered,
      100.0 * count.errors[count.errors.size() / 2], 100.0 * count.errors.back(),
      count.seconds[count.seconds.size() / 2], count.seconds.back());
  return 0;
}
