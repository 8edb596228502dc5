// Every fault on every driver, many times: the program as a process of its own against emulated drives, a relay of 1 N as
// its controller, so that there is a force at any instant. When the fault comes, how long it lasts and where frames are
// cut is drawn from the seed.
//
//   build/release/tests/fault_campaign 200 1 8            runs of each, seed, hosts side by side
//   build/release/tests/fault_campaign 200 1 8 vesc late_cycles
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <random>
#include <sstream>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "rig/drive_kinds.hpp"
#include "rig/pty_emulator.hpp"
#include "rig/rig_host.hpp"
#include "rig/serial_device.hpp"
#include "rig/udp_emulator.hpp"
#include "zwidth/io/device_file.hpp"

namespace zwidth::test {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;

constexpr double period = 0.04;       // s: these machines pause for many milliseconds
constexpr int most_cycles_after = 4;  // with a force: three, and one that was under way
constexpr int most_starts = 50;       // of one run: the machine may pause for three periods before the fault comes
constexpr milliseconds held_up{20};   // from the count of forces to the fault: this harness itself was paused
constexpr milliseconds to_begin{10'000};
constexpr milliseconds to_let_go{5'000};

/// An emulated drive of any kind.
class Drive {
 public:
  Drive(std::string_view driver, const Device& device, unsigned place) : name_(driver) {
    if (driver == "udp") {
      udp_.emplace(device);
      udp_->set_place(place);
      return;
    }
    const auto* const kind = drive_kind(driver);
    has_watchdog_ = kind->has_watchdog;
    serial_.emplace(kind->firmware(), device, LineOptions{.is_paced = true});
    serial_->set_place(place);
  }
  [[nodiscard]] std::string address() const { return name_ + ":" + (udp_ ? udp_->address() : serial_->path()); }
  [[nodiscard]] bool has_watchdog() const { return has_watchdog_; }
  [[nodiscard]] int nonzero_forces() const { return udp_ ? udp_->nonzero_forces() : serial_->motor().nonzero_forces(); }
  [[nodiscard]] double force() const { return udp_ ? udp_->force() : serial_->motor().force(); }
  void set_fault(std::optional<PtyEmulator::Fault> serial, std::optional<UdpEmulator::Fault> udp) {
    if (udp_) udp_->set_fault(*udp);
    if (serial_) serial_->set_fault(*serial);
  }

 private:
  std::string name_;
  bool has_watchdog_ = true;
  std::optional<UdpEmulator> udp_;
  std::optional<PtyEmulator> serial_;
};

struct Outcome {
  bool has_begun = false;    // else the machine, or a defect, stopped it before its fault
  bool is_safe = false;      // zero within three cycles, or by the firmware's watchdog
  bool force_stays = false;  // of a drive without a watchdog that cannot be reached: why it is refused unless told
  bool is_whole = false;     // the record; or it is not there at all, or its loss is told
  int forces_after = 0;
  std::string errors;
};

struct Run {
  std::string_view driver;
  std::uint64_t seed;
  fs::path folder;
};

/// Rows of seven numbers in the order of time, the last of them without a force and with the reason.
bool is_whole_record(const fs::path& path) {
  std::ifstream file(path);
  std::string line;
  if (!std::getline(file, line) || line != "time_s,force,position,velocity,wanted_force,latency_s,stop") return false;
  double time = -1.0;
  double force = 1.0;
  double stop = 0.0;
  int rows = 0;
  for (; std::getline(file, line); ++rows) {
    std::istringstream cells(line);
    std::vector<std::string> row;
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(cell);
    if (row.size() != 7 || !(std::stod(row[0]) > time)) return false;
    time = std::stod(row[0]);
    force = std::stod(row[1]);
    stop = std::stod(row[6]);
  }
  return rows > 3 && force == 0.0 && stop > 0.0;
}

bool is_alone(const fs::path& folder) {  // no record, no half of one
  return std::ranges::all_of(fs::directory_iterator(folder), [](const fs::directory_entry& each) {
    return each.path().extension() == ".toml" || each.path().extension() == ".errors";
  });
}

std::string word_after(std::string_view words, const std::string& text) {
  const auto found = text.find(words);
  if (found == std::string::npos) return {};
  const auto begin = found + words.size();
  return text.substr(begin, text.find_first_of(" \n", begin) - begin);
}

/// What is done to a host and its drive that run.
struct FaultCase {
  std::string_view name;
  std::optional<PtyEmulator::Fault> serial;
  std::optional<UdpEmulator::Fault> udp;
};
using Serial = PtyEmulator::Fault;
using Udp = UdpEmulator::Fault;
constexpr FaultCase fault_cases[] = {{"killed_host", {}, {}},
                                     {"unplugged", Serial::unplugged, Udp::unplugged},
                                     {"no_answers", Serial::silent, Udp::silent},
                                     {"half_frames", Serial::half_frames, Udp::half_frames},
                                     {"wrong_checksums", Serial::wrong_checksum, Udp::wrong_checksum},
                                     {"stalled_reader", Serial::stalled, Udp::stalled},
                                     {"nan", Serial::not_a_number, Udp::not_a_number},
                                     {"late_answers", Serial::late, Udp::late},
                                     {"late_cycles", {}, {}},
                                     {"full_disk", {}, {}},
                                     {"second_rig", {}, {}},
                                     {"interrupt", {}, {}}};

/// Lines without a checksum, positions that are whole numbers.
bool is_possible(std::string_view driver, std::string_view fault) {
  const auto* const kind = drive_kind(driver);
  if (kind == nullptr) return true;
  return (fault != "wrong_checksums" || kind->has_checksums) && (fault != "nan" || kind->has_nan);
}

Outcome run_once(const Run& run, const FaultCase& fault) {
  std::mt19937_64 engine(run.seed);
  const auto drawn = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine); };
  const int forces_until = drawn(5, 40);
  const auto place = static_cast<unsigned>(drawn(0, 1000));
  const milliseconds held(drawn(200, 450));  // of 150 ms only two cycles may be late by a period
  const milliseconds phase(drawn(0, 40));

  Outcome outcome;
  const auto* const kind = drive_kind(run.driver);
  const Device device = kind == nullptr ? belt_device(period) : belt_device_of(*kind, period);
  std::ofstream(run.folder / "device.toml") << write_device(device.parameters());
  Drive drive(run.driver, device, place);
  const auto begun = [&](const std::string& name, const std::string& record) {
    std::vector<std::string> more{"--trials", "1"};
    if (!drive.has_watchdog()) more.emplace_back("--no-watchdog");
    return Host(run.folder, drive.address(), name, record, more, "relay");
  };
  const fs::path record = fault.name == "full_disk" ? fs::path("/dev/full") : run.folder / "host.csv";
  Host host = begun("host", record);
  outcome.has_begun = within(to_begin, [&] { return drive.nonzero_forces() > forces_until || host.has_ended(); }) &&
                      drive.nonzero_forces() > forces_until;
  std::this_thread::sleep_for(phase);
  if (!outcome.has_begun || host.has_ended()) {
    outcome.has_begun = false;
    outcome.errors = host.errors();
    return outcome;
  }
  const auto is_zero = [&] { return drive.force() == 0.0; };
  auto counted = std::chrono::steady_clock::now();
  int before = drive.nonzero_forces();
  const auto is_held_up = [&] { return std::chrono::steady_clock::now() - counted > held_up; };
  bool is_as_told = true;
  if (fault.name == "killed_host") {
    host.send(SIGKILL);
    (void)host.status();
    outcome.force_stays = !drive.has_watchdog();
    outcome.is_safe = within(outcome.force_stays ? milliseconds(300) : to_let_go, is_zero);
    outcome.is_whole = is_alone(run.folder);
    return outcome;
  }
  if (fault.serial) {
    drive.set_fault(fault.serial, fault.udp);
    outcome.has_begun = !is_held_up();
    outcome.force_stays = fault.name == "unplugged" && !drive.has_watchdog();
  } else if (fault.name == "late_cycles") {
    host.send(SIGSTOP);
    outcome.has_begun = !is_held_up();
    std::this_thread::sleep_for(held);
    host.send(SIGCONT);
  } else {
    if (fault.name == "second_rig") {
      Host other = begun("other", run.folder / "other.csv");
      is_as_told = other.status() == 1 && other.errors().find("other rig") != std::string::npos;
      if (!is_as_told && host.has_ended() && host.errors().find("came late") != std::string::npos) {
        outcome.has_begun = false;  // the machine had stopped the first before the second asked
        outcome.errors = host.errors();
        return outcome;
      }
      is_as_told = is_as_told && within(to_let_go, [&] { return drive.nonzero_forces() > before || host.has_ended(); });
      counted = std::chrono::steady_clock::now();
      before = drive.nonzero_forces();
    }
    host.send(SIGINT);
    outcome.has_begun = !is_held_up();
  }
  is_as_told = host.status() == 1 && is_as_told;
  outcome.errors = outcome.has_begun ? host.errors() : "this harness was held up";
  if (fault.udp) drive.set_fault(Serial::none, Udp::none);
  outcome.forces_after = drive.nonzero_forces() - before;
  const bool has_stopped = is_as_told && outcome.forces_after <= most_cycles_after;
  const bool is_zero_now = within(outcome.force_stays ? milliseconds(300) : to_let_go, is_zero);
  outcome.is_safe = has_stopped && is_zero_now;
  outcome.force_stays = outcome.force_stays && has_stopped;
  outcome.is_whole = is_whole_record(run.folder / "host.csv");
  if (fault.name == "full_disk") {  // told, and whole elsewhere
    const auto elsewhere = word_after("flight record: ", outcome.errors);
    outcome.is_whole =
        outcome.errors.find("/dev/full: cannot write") != std::string::npos && is_whole_record(elsewhere);
    fs::remove(elsewhere);
  }
  return outcome;
}

struct Tally {
  int runs = 0;
  int safe = 0;
  int staying = 0;
  int whole = 0;
  int restarts = 0;
  int never_begun = 0;
  int most_forces = 0;
  std::map<std::string, int> stops;  // by what the program says
};

std::string last_line(const std::string& text) {
  std::istringstream lines(text);
  std::string last;
  for (std::string line; std::getline(lines, line);) {
    if (!line.empty()) last = line;
  }
  return last;
}

/// Without what differs from run to run.
std::string stop_of(const std::string& errors) {
  std::string line = last_line(errors);
  if (const auto port = line.find(":/dev/pts/"); port != std::string::npos) {
    const auto end = line.find(':', port + 1);
    line.erase(port, end == std::string::npos ? end : end - port);
  }
  return line.substr(0, 110);
}

/// A fault on a driver.
struct Cell {
  std::string_view driver;
  const FaultCase* fault;
  Tally tally{};
};

/// One run, begun anew until its fault comes; the tally is under the mutex.
Outcome run_in(Cell& cell, int number, std::uint64_t seed, std::mutex& mutex) {
  Outcome outcome;
  for (int start = 0; start < most_starts && !outcome.has_begun; ++start) {
    std::string name = (fs::temp_directory_path() / "zwidth_campaign_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) std::abort();
    const std::uint64_t own = seed + static_cast<std::uint64_t>(1000 * number + start);
    outcome = run_once({cell.driver, own, name}, *cell.fault);
    fs::remove_all(name);
    const std::lock_guard lock(mutex);
    if (!outcome.has_begun) {
      ++cell.tally.restarts;
      ++cell.tally.stops["before its fault: " + stop_of(outcome.errors)];
    }
  }
  return outcome;
}

void count(const Outcome& outcome, int number, Cell& cell) {
  Tally& tally = cell.tally;
  if (!outcome.has_begun) {
    ++tally.never_begun;
    return;
  }
  ++tally.runs;
  tally.safe += outcome.is_safe ? 1 : 0;
  tally.staying += outcome.force_stays && !outcome.is_safe ? 1 : 0;
  tally.whole += outcome.is_whole ? 1 : 0;
  tally.most_forces = std::max(tally.most_forces, outcome.forces_after);
  ++tally.stops[stop_of(outcome.errors)];
  if ((!outcome.is_safe && !outcome.force_stays) || !outcome.is_whole) {
    fmt::print("  {} {} run {}: safe {}, whole {}, {} forces after: {}\n", cell.driver, cell.fault->name, number,
               outcome.is_safe, outcome.is_whole, outcome.forces_after, outcome.errors);
  }
}

void print(const Cell& cell) {
  const Tally& tally = cell.tally;
  const bool stays = tally.staying > 0;
  fmt::print("{:10} {:16} {:>6} {:>6} {:>6} {:>9} {:>9}  {}\n", cell.driver, cell.fault->name,
             stays ? "-" : std::to_string(tally.safe), tally.whole, tally.runs, tally.most_forces, tally.restarts,
             stays ? "no watchdog: the force stays" : "");
  for (const auto& [stop, count] : tally.stops) fmt::print("{:>62} x {}\n", count, stop);
  std::fflush(stdout);
}

int campaign(int runs, std::uint64_t seed, int together, std::string_view one_driver, std::string_view one_fault) {
  fmt::print("{} runs of each, seed {}, {} side by side, period {} s\n", runs, seed, together, period);
  fmt::print("{:10} {:16} {:>6} {:>6} {:>6} {:>9} {:>9}  {}\n", "driver", "fault", "zero", "whole", "of", "forces",
             "restarts", "what stopped it");
  std::vector<Cell> cells;
  for (const std::string_view driver :
       {"udp", "odrive", "moteus", "vesc", "simplefoc", "serial", "odrive-can", "moteus-can", "vesc-can"}) {
    for (const FaultCase& fault : fault_cases) {
      const bool is_asked =
          (one_driver.empty() || one_driver == driver) && (one_fault.empty() || one_fault == fault.name);
      if (is_asked && is_possible(driver, fault.name)) cells.push_back({driver, &fault});
    }
  }
  std::mutex mutex;
  std::atomic<int> next = 0;
  const auto work = [&] {
    for (int i = next++; i < runs * static_cast<int>(cells.size()); i = next++) {
      Cell& cell = cells[static_cast<std::size_t>(i / runs)];
      const Outcome outcome = run_in(cell, i % runs, seed, mutex);
      const std::lock_guard lock(mutex);
      count(outcome, i % runs, cell);
      if (cell.tally.runs + cell.tally.never_begun == runs) print(cell);
    }
  };
  std::vector<std::thread> workers;
  for (int i = 0; i < together; ++i) workers.emplace_back(work);
  for (std::thread& worker : workers) worker.join();
  const bool is_safe = std::ranges::all_of(cells, [&](const Cell& cell) {
    const Tally& tally = cell.tally;
    return tally.runs == runs && tally.safe + tally.staying == runs && tally.whole == runs;
  });
  fmt::print("{}\n", is_safe ? "all zero in time, every record whole" : "NOT all");
  return is_safe ? 0 : 1;
}

}  // namespace
}  // namespace zwidth::test

int main(int count, char** arguments) {
  if (count < 2 || count > 6 || std::atoi(arguments[1]) < 1) {
    fmt::print(stderr, "usage: fault_campaign RUNS [SEED [TOGETHER [DRIVER [FAULT]]]]\n");
    return 2;
  }
  const auto number = [&](int i, int otherwise) { return count > i ? std::atoi(arguments[i]) : otherwise; };
  // Where a record goes that has no place:
  setenv("XDG_STATE_HOME", std::filesystem::temp_directory_path().c_str(), 1);
  return zwidth::test::campaign(number(1, 1), static_cast<std::uint64_t>(number(2, 1)), std::max(1, number(3, 8)),
                                count > 4 ? arguments[4] : "", count > 5 ? arguments[5] : "");
}
