// How often identify() is right: simulated recordings over structures, noises, bands, delays and frictions.
//
//   identification_campaign [FIRST_SEED [COUNT [BODIES NAMED]]]
//
// BODIES and NAMED: devices of so many bodies without friction, of which the structure names so many.
//
// COUNT recordings from FIRST_SEED on; a seed whose device no wall is stable with, or that none limits, makes none. One
// line per recording, and every 100 and at the end a table of the shares that matter: of the answers called sound, how
// many have an interval whose lower end is above the truth (the unsafe side), and by more than 10 %; and of the records
// that carry an answer, how many are called sound. A record carries an answer where the limiting crossover lies in the
// excited band at a coherence of 0.95 or more, the structure is right and there is no friction, which identify() does
// not model (identify_in_time() does: friction_campaign).
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "property/random_recordings.hpp"
#include "zwidth/error.hpp"
#include "zwidth/identification/frequency_response.hpp"
#include "zwidth/identification/identification.hpp"

namespace {

using namespace zwidth;

struct Count {
  int all = 0;
  int sound = 0;
  int refused = 0;
  int failed = 0;
  int unsafe = 0;      ///< sound, lower end above the truth
  int far_unsafe = 0;  ///< by more than 10 %
  int held = 0;        ///< the interval holds the truth
  int answered = 0;
  int carried = 0;  ///< records that carry an answer
  int carried_sound = 0;
};

/// Whether a record holds what its device's limit hangs on; without identify(), which may fail.
bool carries_answer(const test::RandomRecording& made) {
  if (made.has_friction || !made.right_structure) return false;
  if (made.limiting_hz < made.lowest_hz || made.limiting_hz > made.highest_hz) return false;
  const std::vector<double>& force = made.recording.channels[0].samples;
  const std::vector<double>& position = made.recording.channels[1].samples;
  const FrequencyResponse response = frequency_response(force, position, made.recording.sampling_period);
  const double wanted = 2.0 * std::numbers::pi * made.limiting_hz;
  const auto nearest = std::ranges::min_element(
      response.points, {}, [&](const ResponsePoint& point) { return std::abs(point.frequency - wanted); });
  constexpr double clear = 0.95;
  return nearest != response.points.end() && nearest->coherence >= clear;
}

void print(const std::string& name, const Count& count) {
  std::printf(
      "%-28s %4d  sound %4d (unsafe %d, by >10%% %d)  doubtful %4d  refused %3d  failed %3d  interval holds %d/%d"
      "  carried %d, sound of them %d\n",
      name.c_str(), count.all, count.sound, count.unsafe, count.far_unsafe, count.answered - count.sound, count.refused,
      count.failed, count.held, count.answered, count.carried, count.carried_sound);
}

}  // namespace

int main(int argc, char** argv) {
  const auto first = static_cast<std::uint64_t>(argc > 1 ? std::atoll(argv[1]) : 1);
  const auto count = static_cast<std::uint64_t>(argc > 2 ? std::atoll(argv[2]) : 200);
  test::RecordingFamily family;
  if (argc > 4) family = {0.0, 0.0, std::strtoul(argv[3], nullptr, 10), std::strtoul(argv[4], nullptr, 10)};
  std::map<std::string, Count> counts;
  std::uint64_t recordings = 0;
  for (std::uint64_t seed = first; recordings < count; ++seed) {
    const auto made = test::random_recording(seed, family);
    if (!made) continue;
    ++recordings;
    const auto begin = std::chrono::steady_clock::now();
    std::string verdict = "failed";
    std::string detail;
    double lower = 0.0;
    double upper = 0.0;
    double value = 0.0;
    const bool carried = carries_answer(*made);
    try {
      IdentifyOptions options;
      options.structure_values = IdentifyOptions::StructureValues::placeholders;
      const Identification found = identify(made->recording, Device(made->structure), options);
      verdict = found.trust.sound() ? "sound" : found.trust.refused() ? "refused" : "doubtful";
      value = found.analysis.critical.stiffness;
      lower = upper = value;
      if (found.analysis.interval) {
        lower = found.analysis.interval->lower;
        upper = found.analysis.interval->upper;
      }
      for (const std::string& reason : found.trust.reasons) detail += "\n      " + reason;
      detail += "\n      model error " + std::to_string(found.fit.model_error);
    } catch (const Error& error) {
      detail = std::string("\n      ") + error.what();
    }
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const bool unsafe = verdict == "sound" && lower > made->stiffness;
    std::printf("%5llu %-9s %s%s true %.5g at %.3g Hz of %.3g-%.3g, found %.5g [%.5g, %.5g], %.1f s: %s%s\n",
                static_cast<unsigned long long>(seed), verdict.c_str(), unsafe ? "UNSAFE " : "",
                carried ? "carried" : "", made->stiffness, made->limiting_hz, made->lowest_hz, made->highest_hz, value,
                lower, upper, seconds, made->what.c_str(), detail.c_str());
    std::fflush(stdout);
    const std::string bodies =
        made->what.substr(0, made->what.find(", ", made->what.find("handle") == std::string::npos ? 0 : 10));
    for (const std::string& name :
         {std::string("all"), bodies, std::string(made->right_structure ? "right structure" : "too few bodies"),
          std::string(made->has_friction ? "friction" : "no friction")}) {
      Count& each = counts[name];
      ++each.all;
      each.failed += verdict == "failed";
      each.refused += verdict == "refused";
      each.carried += carried;
      if (verdict == "failed" || verdict == "refused") continue;
      ++each.answered;
      each.held += lower <= made->stiffness && made->stiffness <= upper;
      if (verdict != "sound") continue;
      ++each.sound;
      each.unsafe += unsafe;
      each.far_unsafe += lower > 1.1 * made->stiffness;
      each.carried_sound += carried;
    }
    constexpr std::uint64_t often = 100;
    if (recordings % often != 0 && recordings < count) continue;
    std::printf("--- %llu recordings, seeds %llu to %llu\n", static_cast<unsigned long long>(recordings),
                static_cast<unsigned long long>(first), static_cast<unsigned long long>(seed));
    for (const auto& [name, each] : counts) print(name, each);
    std::fflush(stdout);
  }
  return 0;
}
