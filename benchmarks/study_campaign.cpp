// How often a study is right, on random two-mass devices of which five numbers vary.
//
//   study_campaign [worst|rare [FIRST_SEED [COUNT [UNITS [KIND [FAILING [FIRST]]]]]]]
//
// KIND: as in tests/property/random_devices.hpp, two_mass where none is given.
// worst: the worst unit found from 10 000 samples, beside the worst of UNITS others.
// rare:  one device and one specification, of which about one unit in 10 000 fails among UNITS; COUNT seeds of importance
//        sampling from FIRST on (1) with 5000 units each: how many intervals hold that share. FAILING: how many of the
//        UNITS fail, where an earlier run has counted them; 0: they are counted.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "study/random_studies.hpp"
#include "zwidth/study/rare_failures.hpp"

namespace {

using namespace zwidth;

constexpr std::uint64_t others = 1'000'000;  // seed of the units that are counted

StudyRun counted_run(std::uint64_t seed, std::uint64_t units, std::string_view kind) {
  StudyOptions options;
  options.samples = units;
  options.seed = others + seed;
  return test::random_study(seed, options, kind);
}

/// K_CR of all units of a run, in no order; what has none is left out.
template <typename Take>
void for_each_limit(const StudyRun& run, const Take& take) {
  std::uint64_t next = 0;
  compute_chunks(
      run, [&] { return next < run.chunk_count() ? std::optional(next++) : std::nullopt; },
      [&](std::uint64_t, const BatchStiffness& answers) {
        for (const double stiffness : answers.stiffness) {
          if (!std::isnan(stiffness)) take(stiffness);
        }
      });
}

void worst_units(std::uint64_t first, std::uint64_t count, std::uint64_t units, std::string_view kind) {
  std::uint64_t beaten = 0;
  std::uint64_t sound = 0;
  std::uint64_t sound_wrong = 0;
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    StudyOptions options;
    options.seed = seed;
    options.index_samples = options.tightening_samples = 0;
    const StudyRun run = test::random_study(seed, options, kind);
    const Study found = study(run.device(), run.distributions(), run.options());
    double least = std::numeric_limits<double>::infinity();
    for_each_limit(counted_run(seed, units, kind), [&](double stiffness) { least = std::min(least, stiffness); });
    const WorstDevice& worst = *found.worst;
    const bool is_lower = worst.critical.stiffness <= least;
    beaten += is_lower ? 1U : 0U;
    sound += worst.trust.sound() ? 1U : 0U;
    sound_wrong += worst.trust.sound() && !is_lower ? 1U : 0U;
    if (!is_lower) {
      std::printf("seed %llu: found %.9g (%zu of %zu descents), counted %.9g\n", static_cast<unsigned long long>(seed),
                  worst.critical.stiffness, worst.agreeing, worst.descents, least);
    }
  }
  std::printf(
      "the worst unit found is no better than the worst of %llu others in %llu of %llu cases; %llu sound, of these "
      "%llu beaten\n",
      static_cast<unsigned long long>(units), static_cast<unsigned long long>(beaten),
      static_cast<unsigned long long>(count), static_cast<unsigned long long>(sound),
      static_cast<unsigned long long>(sound_wrong));
}

void rare_shares(std::uint64_t device, std::uint64_t count, std::uint64_t units, std::string_view kind,
                 std::uint64_t counted, std::uint64_t first) {
  std::vector<double> limits;
  for_each_limit(counted_run(device, 200'000, kind), [&](double stiffness) { limits.push_back(stiffness); });
  std::ranges::nth_element(limits, limits.begin() + 20);
  const double specified = limits[20];
  std::uint64_t failing = counted;
  StudyOptions many;
  many.samples = units;
  many.seed = 2 * others + device;
  if (counted == 0) {
    for_each_limit(test::random_study(device, many, kind),
                   [&](double stiffness) { failing += stiffness < specified ? 1U : 0U; });
  }
  const Proportion truth = proportion(failing, units);
  std::uint64_t held = 0;
  std::uint64_t below = 0;
  std::uint64_t sound = 0;
  std::uint64_t sound_wrong = 0;
  double sum = 0.0;
  double square = 0.0;
  double error = 0.0;
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    StudyOptions options;
    options.seed = seed;
    options.specification.critical_stiffness = specified;
    const RareFailures rare = rare_failures(test::random_study(device, options, kind), {.samples = 5000});
    const bool holds = rare.lower <= truth.value && truth.value <= rare.upper;
    held += holds ? 1U : 0U;
    below += rare.upper < truth.value ? 1U : 0U;
    sound += rare.trust.sound() ? 1U : 0U;
    sound_wrong += rare.trust.sound() && !holds ? 1U : 0U;
    sum += rare.share / truth.value;
    square += std::pow((rare.share - truth.value) / truth.value, 2);
    error += std::pow(rare.error / truth.value, 2);
  }
  const auto whole = [](std::uint64_t number) { return static_cast<unsigned long long>(number); };
  const auto seeds = static_cast<double>(count);
  std::printf(
      "%.*s device %llu: %llu of %llu fail (%.4g to %.4g) below %.17g; %llu of %llu seeds hold it, %llu are below, "
      "%llu "
      "sound, of these %llu miss it; mean share %.4f of it, rms error %.4f, as stated %.4f\n",
      static_cast<int>(kind.size()), kind.data(), whole(device), whole(failing), whole(units), truth.lower, truth.upper,
      specified, whole(held), whole(count), whole(below), whole(sound), whole(sound_wrong), sum / seeds,
      std::sqrt(square / seeds), std::sqrt(error / seeds));
  (void)std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const auto number = [&](int i, std::uint64_t otherwise) {
    return argc > i ? static_cast<std::uint64_t>(std::atoll(argv[i])) : otherwise;
  };
  const std::string what = argc > 1 ? argv[1] : "worst";
  const std::string_view kind = argc > 5 ? argv[5] : "two_mass";
  if (what == "rare") {
    rare_shares(number(2, 1), number(3, 100), number(4, 10'000'000), kind, number(6, 0), number(7, 1));
  } else if (what == "worst") {
    worst_units(number(2, 1), number(3, 100), number(4, 1'000'000), kind);
  } else {
    std::fputs("usage: study_campaign [worst|rare [FIRST_SEED [COUNT [UNITS [KIND [FAILING [FIRST]]]]]]]\n", stderr);
    return 2;
  }
  return 0;
}
