// Random signals with times of their own, as each program exports them: a pair that is read has equal times row by row,
// and is read exactly where the times allow it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "io/recording_folder.hpp"
#include "zwidth/io/recording_file.hpp"

namespace zwidth {
namespace {

/// Sampled at start, start + period, ..., in ms.
struct Signal {
  int start = 0;
  int period = 1;
  int samples = 0;

  [[nodiscard]] int time(int sample) const { return start + period * sample; }
  [[nodiscard]] int end() const { return time(samples - 1); }
};

/// Tells the signal and the time apart: 1000 of the signal, a quarter of the time.
double value_of(std::size_t signal, int time) { return 1000.0 * static_cast<double>(signal) + 0.25 * time; }

std::string in_text(double value, char mark) {
  std::string text = fmt::format("{}", value);
  std::replace(text.begin(), text.end(), '.', mark);
  return text;
}

int most_rows(const std::vector<Signal>& signals) {
  int rows = 0;
  for (const Signal& signal : signals) rows = std::max(rows, signal.samples);
  return rows;
}

using Writer = std::string (*)(const std::vector<Signal>&, std::mt19937&);

std::string as_scope(const std::vector<Signal>& signals, std::mt19937& random) {
  const char tab = random() % 2 == 0 ? '\t' : ';';
  const char mark = random() % 2 == 0 ? '.' : ',';
  const bool is_padded = random() % 2 == 0;
  std::string text = fmt::format("Name{0}Scope{0}\nFile{0}a.csv{0}\n\n\n", tab);
  for (std::size_t c = 0; c < signals.size(); ++c)
    text += fmt::format("{}Name{}s{}", c == 0 ? "" : std::string(1, tab), tab, c);
  text += "\n\n";
  for (int row = 0; row < most_rows(signals); ++row) {
    std::vector<std::string> cells;
    for (std::size_t c = 0; c < signals.size(); ++c) {
      const bool has_row = row < signals[c].samples;
      cells.push_back(has_row ? std::to_string(signals[c].time(row)) : " ");
      cells.push_back(has_row ? in_text(value_of(c, signals[c].time(row)), mark) : " ");
    }
    while (!is_padded && cells.back() == " ") cells.pop_back();
    for (std::size_t i = 0; i < cells.size(); ++i) text += (i == 0 ? "" : std::string(1, tab)) + cells[i];
    text += "\n";
  }
  return text + (random() % 2 == 0 ? "EOF\n" : "");
}

std::string as_trace(const std::vector<Signal>& signals, std::mt19937& random) {
  const bool is_in_us = random() % 2 == 0;
  std::string text = fmt::format("[key]; [value]\nVersion; 0x03050000\nFlags; {}\n", is_in_us ? 32 : 16);
  for (std::size_t c = 0; c < signals.size(); ++c) {
    text += fmt::format("{0}.Variable; s{0}\n{0}.Class; 14\n{0}.Data; \n", c);
    for (int row = 0; row < signals[c].samples; ++row) {
      const int time = signals[c].time(row);
      text += fmt::format("; {}; {}\n", is_in_us ? 1000 * time : time, value_of(c, time));
    }
  }
  return text;
}

std::string as_sections(const std::vector<Signal>& signals, std::mt19937& random) {
  const bool has_commas = random() % 2 == 0;
  const char between = has_commas ? ';' : ',';
  const char mark = has_commas ? ',' : '.';
  std::string text = "recorder" + std::string(1, between) + "R\n";
  for (std::size_t c = 0; c < signals.size(); ++c) {
    text += fmt::format("path{0}{0}Model Root/s{1}\n", between, c);
    for (int row = 0; row < signals[c].samples; ++row) {
      const int time = signals[c].time(row);
      text += fmt::format("{1}{0}{2}{0}{3}\n", between, row == 0 ? "trace_values" : "", in_text(1e-3 * time, mark),
                          in_text(value_of(c, time), mark));
    }
    text += "\n";
  }
  return text;
}

std::string as_measurement(const std::vector<Signal>& signals, std::mt19937& random) {
  const char mark = random() % 2 == 0 ? '.' : ',';
  std::string text = fmt::format(
      "LabVIEW Measurement\nSeparator\tTab\nDecimal_Separator\t{}\nX_Columns\tMulti\n"
      "***End_of_Header***\n\nChannels\t{}\n",
      mark, signals.size());
  const auto tag = [&](const std::string& name, auto&& value) {
    text += name;
    for (const Signal& signal : signals) text += "\t" + value(signal) + "\t";
    text += "\n";
  };
  tag("Samples", [](const Signal& signal) { return std::to_string(signal.samples); });
  tag("X0", [&](const Signal& signal) { return in_text(1e-3 * signal.start, mark); });
  tag("Delta_X", [&](const Signal& signal) { return in_text(1e-3 * signal.period, mark); });
  text += "***End_of_Header***\n";
  for (std::size_t c = 0; c < signals.size(); ++c) text += fmt::format("X_Value\ts{}\t", c);
  text += "Comment\n";
  for (int row = 0; row < most_rows(signals); ++row) {
    for (std::size_t c = 0; c < signals.size(); ++c) {
      if (row < signals[c].samples) {
        text += in_text(1e-3 * signals[c].time(row), mark) + "\t" + in_text(value_of(c, signals[c].time(row)), mark);
      } else {
        text += "\t";
      }
      text += c + 1 < signals.size() ? "\t" : "\n";
    }
  }
  return text;
}

/// How many rows two signals have in common; 0 where one has a row in their common span that the other lacks.
int common_rows(const Signal& a, const Signal& b) {
  const int begin = std::max(a.start, b.start);
  const int end = std::min(a.end(), b.end());
  const auto rows = [&](const Signal& signal) {
    std::vector<int> times;
    for (int i = 0; i < signal.samples; ++i) {
      if (signal.time(i) >= begin && signal.time(i) <= end) times.push_back(signal.time(i));
    }
    return times;
  };
  return rows(a) == rows(b) ? static_cast<int>(rows(a).size()) : 0;
}

struct ExportWriter {
  const char* name;
  Writer write;
};
class ExportTimes : public TextRecording, public testing::WithParamInterface<ExportWriter> {};

TEST_P(ExportTimes, PairsRowsOfEqualTimesAlone) {
  std::mt19937 random(7);
  int read_pairs = 0;
  for (int trial = 0; trial < 150; ++trial) {
    std::vector<Signal> signals(2 + random() % 3);
    for (Signal& signal : signals) {
      const int period = 1 + static_cast<int>(random() % 4) / 3;
      signal = {static_cast<int>(random() % 5), period, 3 + static_cast<int>(random() % 9)};
    }
    const std::string text = GetParam().write(signals, random);
    const std::size_t a = random() % signals.size();
    const std::size_t b = random() % signals.size();
    SCOPED_TRACE(fmt::format("trial {}: s{} and s{} of\n{}", trial, a, b, text));
    const auto recording = read(text, columns_named({fmt::format("s{}", a), fmt::format("s{}", b)}));
    const int expected = common_rows(signals[a], signals[b]);
    ASSERT_EQ(recording.has_value(), expected >= 2) << (recording ? "" : recording.error().str());
    if (!recording) continue;
    ++read_pairs;
    const auto& first = recording->channels[0].samples;
    const auto& second = recording->channels[1].samples;
    ASSERT_EQ(first.size(), static_cast<std::size_t>(expected));
    for (std::size_t i = 0; i < first.size(); ++i) {
      EXPECT_EQ(first[i] - value_of(a, 0), second[i] - value_of(b, 0));
    }
    EXPECT_EQ(first[0], value_of(a, std::max(signals[a].start, signals[b].start)));
    EXPECT_NEAR(recording->sampling_period, 1e-3 * signals[a].period, 1e-12);
  }
  EXPECT_GE(read_pairs, 40);
}

INSTANTIATE_TEST_SUITE_P(Programs, ExportTimes,
                         testing::Values(ExportWriter{"TwincatScope", as_scope}, ExportWriter{"CodesysTrace", as_trace},
                                         ExportWriter{"ControlDesk", as_sections},
                                         ExportWriter{"LabviewMeasurement", as_measurement}),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace zwidth
