// What lost rows, jitter and several rates do to identify(): simulated recordings, as they were and as a recorder wrote
// them.
//
//   lost_rows_campaign [FIRST_SEED [COUNT [thorough]]]
//
// `thorough`: friction is looked for in time too, which takes most of the time.
//
// One line per recording and, at the end, by damage: of the recordings that are sound as they were, how many stay sound;
// and how many of the sound answers hold the truth.
#include <cstdio>
#include <cstdlib>
#include <map>
#include <optional>
#include <string>

#include "property/damaged_recordings.hpp"
#include "zwidth/error.hpp"
#include "zwidth/identification/identification.hpp"

namespace {

using namespace zwidth;

struct Answer {
  std::string verdict = "failed";
  double lower = 0.0;
  double upper = 0.0;
  std::string reason;

  [[nodiscard]] bool sound() const { return verdict == "sound"; }
  [[nodiscard]] bool holds(double stiffness) const { return lower <= stiffness && stiffness <= upper; }
};

Answer answer_of(const std::vector<Recording>& recordings, const Device& structure,
                 IdentifyOptions::Scrutiny scrutiny) {
  Answer answer;
  try {
    IdentifyOptions options;
    options.structure_values = IdentifyOptions::StructureValues::placeholders;
    options.scrutiny = scrutiny;
    const Identification found = identify(recordings, structure, options);
    answer.verdict = found.trust.sound() ? "sound" : found.trust.refused() ? "refused" : "doubtful";
    if (found.analysis.interval) {
      answer.lower = found.analysis.interval->lower;
      answer.upper = found.analysis.interval->upper;
    }
    if (!found.trust.reasons.empty()) answer.reason = found.trust.reasons.front();
  } catch (const Error& error) {
    answer.reason = error.what();
  }
  return answer;
}

struct Count {
  int all = 0;
  int whole_sound = 0;
  int whole_holds = 0;
  int sound = 0;
  int holds = 0;
  int unsafe = 0;  ///< the lower end is above the truth
  int stays = 0;   ///< sound with and without damage

  void add(const Answer& whole, const Answer& damaged, double stiffness) {
    ++all;
    whole_sound += whole.sound();
    whole_holds += whole.sound() && whole.holds(stiffness);
    sound += damaged.sound();
    holds += damaged.sound() && damaged.holds(stiffness);
    unsafe += damaged.sound() && damaged.lower > stiffness;
    stays += whole.sound() && damaged.sound();
  }
};

}  // namespace

int main(int argc, char** argv) {
  const auto first = static_cast<std::uint64_t>(argc > 1 ? std::atoll(argv[1]) : 1);
  const int count = argc > 2 ? std::atoi(argv[2]) : 300;
  const auto scrutiny = argc > 3 ? IdentifyOptions::Scrutiny::thorough : IdentifyOptions::Scrutiny::brief;
  std::map<std::string, Count> counts;
  int done = 0;
  for (std::uint64_t seed = first; done < count; ++seed) {
    const auto made = test::damaged_recording(seed);
    if (!made) continue;
    ++done;
    const Device structure(made->structure);
    const Answer whole = answer_of(made->whole, structure, scrutiny);
    const std::vector<Recording> read = test::read_back(*made);
    Answer damaged;
    if (read.size() == made->recorded.size()) damaged = answer_of(read, structure, scrutiny);
    std::printf("%5llu %-8s [%.5g, %.5g] -> %-8s [%.5g, %.5g] true %.5g%s: %s\n", static_cast<unsigned long long>(seed),
                whole.verdict.c_str(), whole.lower, whole.upper, damaged.verdict.c_str(), damaged.lower, damaged.upper,
                made->stiffness, damaged.sound() && !damaged.holds(made->stiffness) ? " MISSED" : "",
                made->what.c_str());
    if (whole.sound() && !damaged.sound()) std::printf("      %s\n", damaged.reason.c_str());
    std::fflush(stdout);
    const std::string damage = made->what.substr(made->what.find(", ", made->what.find(", ") + 2) + 2);
    for (const std::string& name : {std::string("all"), damage.substr(0, damage.find_first_of("0123456789%"))}) {
      counts[name].add(whole, damaged, made->stiffness);
    }
  }
  for (const auto& [name, each] : counts) {
    std::printf("%-18s %3d: sound as it was %3d (%d hold), as recorded %3d (%d hold, %d unsafe); stay sound %d\n",
                name.c_str(), each.all, each.whole_sound, each.whole_holds, each.sound, each.holds, each.unsafe,
                each.stays);
  }
  return 0;
}
