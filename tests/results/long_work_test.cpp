// Work that tells its progress: it can be ended at any of its calls, and telling changes nothing of the answer.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "lhifam.hpp"
#include "results/analysis_json.hpp"
#include "results/bode_json.hpp"
#include "results/design_json.hpp"
#include "results/design_target_json.hpp"
#include "results/diagnosis_json.hpp"
#include "results/json.hpp"
#include "results/region_json.hpp"
#include "results/relay_json.hpp"
#include "results/simulation_json.hpp"
#include "results/wall_recommendation_json.hpp"
#include "zwidth/zwidth.hpp"

namespace zwidth::results {
namespace {

struct Ended : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// One entry point on one device: its document, all 17 digits of it.
struct Work {
  std::string name;
  std::function<Json(const Device&, const Progress&)> document;
};

std::vector<Work> works() {
  return {
      {"analyze",
       [](const Device& device, const Progress& progress) {
         return analysis_json(device, analyze(device, {.worst_user = true,
                                                       .family = UserRanges{ValueRange{0.0, 2.0}, ValueRange{0.0, 30.0},
                                                                            ValueRange{0.0, 1000.0}},
                                                       .progress = progress}));
       }},
      {"bode", [](const Device& device,
                  const Progress& progress) { return bode_json(device, bode(device, {.progress = progress})); }},
      {"region", [](const Device& device,
                    const Progress& progress) { return region_json(device, region(device, {.progress = progress})); }},
      {"design", [](const Device& device,
                    const Progress& progress) { return design_json(device, design(device, {.progress = progress})); }},
      {"recommend",
       [](const Device& device, const Progress& progress) {
         const RecommendationOptions options{.draws = 4, .progress = progress};
         return wall_recommendation_json(device, options, recommend_wall(device, options));
       }},
      {"diagnose",
       [](const Device& device, const Progress& progress) {
         return diagnosis_json(device, diagnose(device, {.frequency = 190.0, .stiffness = 5e4, .progress = progress}));
       }},
      {"target",
       [](const Device& device, const Progress& progress) {
         const DesignTargetOptions options{.stiffness = 9000.0, .factor = 3.0, .progress = progress};
         return design_target_json(device, options, design_targets(device, options));
       }},
      {"sweep",
       [](const Device& device, const Progress& progress) {
         return sweep_json(device, parameter_sweep(device, {{"loop.delay", 0.0, 2e-3, 70}}, {}, progress));
       }},
      {"comparison",
       [](const Device& device, const Progress& progress) {
         const auto variants = device_variants(device, "loop.delay=0,1e-3,2e-3");
         return comparison_json(compare_designs(variants.value(), {}, progress));
       }},
      {"notch",
       [](const Device& device, const Progress& progress) {
         const NotchOptions options{.modal_frequency_uncertainty = 0.02, .progress = progress};
         return notch_json(device, options, design_notch(device, options));
       }},
      {"simulate",
       [](const Device& device, const Progress& progress) {
         SimulationOptions options;
         options.duration = 3.0;
         return simulation_json(device, simulate(device, options, progress));
       }},
      {"relay",
       [](const Device& device, const Progress& progress) {
         RelayOptions options;
         options.relay.amplitude = 5.0;
         options.duration = 3.0;
         options.trials = 2;
         return relay_json(relay(device, options, progress));
       }},
  };
}

Device walled_lhifam() {
  DeviceParameters parameters = test::lhifam_parameters();
  parameters.wall.stiffness = 5000.0;
  parameters.wall.damping = 5.0;
  return Device(std::move(parameters));
}

class LongWork : public ::testing::TestWithParam<std::size_t> {
 protected:
  Work work_ = works()[GetParam()];
};

TEST_P(LongWork, TellsItsProgressAndAnswersTheSame) {
  const Device device = walled_lhifam();
  std::vector<double> told;
  const std::string followed = line(work_.document(device, [&](double fraction) { told.push_back(fraction); }));
  EXPECT_EQ(followed, line(work_.document(device, {})));
  ASSERT_FALSE(told.empty());
  EXPECT_GE(told.front(), 0.0);
  EXPECT_TRUE(std::ranges::is_sorted(told));
  EXPECT_EQ(told.back(), 1.0);
}

TEST_P(LongWork, CanBeEndedAtAnyCall) {
  const Device device = walled_lhifam();
  std::size_t all = 0;
  (void)work_.document(device, [&](double) { ++all; });
  for (const std::size_t at : {std::size_t{1}, (all + 1) / 2, all}) {
    std::size_t calls = 0;
    const auto end_at = [&](double) {
      if (++calls >= at) throw Ended("ended");  // threads at work beside it are told the same
    };
    EXPECT_THROW((void)work_.document(device, end_at), Ended) << at << " of " << all;
  }
}

INSTANTIATE_TEST_SUITE_P(All, LongWork, ::testing::Range(std::size_t{0}, works().size()),
                         [](const auto& each) { return works()[each.param].name; });

TEST(LongWorkOnARecording, ListingItCanBeEnded) {
  const std::string path = ::testing::TempDir() + "long_work.csv";
  {
    std::ofstream file(path);
    file << "a,b\n";
    for (int i = 0; i < 200000; ++i) file << i << ",2.5\n";
  }
  std::vector<double> told;
  const auto contents = list_recording(path, {}, [&](double fraction) { told.push_back(fraction); });
  ASSERT_TRUE(contents);
  EXPECT_EQ(contents->columns.front().size, 200000U);
  EXPECT_FALSE(told.empty());
  EXPECT_TRUE(std::ranges::is_sorted(told));
  EXPECT_THROW((void)list_recording(path, {}, [](double) { throw Ended("ended"); }), Ended);
  std::filesystem::remove(path);
}

Device chain(std::size_t bodies) {
  DeviceParameters parameters;
  parameters.name = "chain";
  for (std::size_t i = 0; i < bodies; ++i) {
    const double more = 0.03 * static_cast<double>((7 * i) % 10);
    parameters.bodies.push_back({"body " + std::to_string(i), 0.2 + more, 0.2 + more, 0.0, 0.0});
    if (i > 0) parameters.links.push_back({i - 1, i, 5e4 * (1.0 + more), 5.0 + 10.0 * more});
  }
  parameters.loop = {0, 0, bodies - 1, 1e-3, 0.4e-3};
  parameters.wall.stiffness = 500.0;
  parameters.wall.damping = 1.0;
  return Device(std::move(parameters));
}

/// Processor time of this thread, s.
double work_done() {
  timespec time{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// Who leaves frees the core soon, of a device of ten bodies too: some 0.05 s, here with room for a slower machine.
TEST(LongWorkOnTenBodies, LooksUpOften) {
  const Device device = chain(10);
  for (const Work& work : works()) {
    const bool is_followed = work.name == "analyze" || work.name == "bode" || work.name == "region" ||
                             work.name == "design" || work.name == "recommend" || work.name == "diagnose";
    if (!is_followed) continue;
    double last = work_done();
    double longest = 0.0;
    const auto look = [&](double) {
      const double now = work_done();
      longest = std::max(longest, now - last);
      last = work_done();
    };
    (void)work.document(device, look);
    look(1.0);
    RecordProperty(work.name, std::to_string(longest));
    EXPECT_LT(longest, 0.2) << work.name;
  }
}

}  // namespace
}  // namespace zwidth::results
