#include "study/answer_bytes.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <functional>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

namespace zwidth::study_engine {
namespace {

class Writer {
 public:
  explicit Writer(std::vector<char>& bytes) : bytes_(bytes) {}

  template <typename T>
  requires std::is_trivially_copyable_v<T>
  void put(const T& value) {
    const auto* first = reinterpret_cast<const char*>(&value);
    bytes_.insert(bytes_.end(), first, first + sizeof value);
  }
  void put(std::string_view text) {
    put(std::uint64_t{text.size()});
    bytes_.insert(bytes_.end(), text.begin(), text.end());
  }
  void put(const std::string& text) { put(std::string_view(text)); }
  template <typename T>
  void put(const std::vector<T>& values) {
    put(std::uint64_t{values.size()});
    for (const T& value : values) put(value);
  }
  void put(const Trust& trust) {
    put(trust.verdict);
    put(trust.reasons);
    put(trust.findings);
  }
  void put(const Finding& finding) {
    put(finding.code);
    put(finding.evidence);
    put(finding.subjects);
    put(finding.key);
    put(finding.effect);
    put(finding.severity);
  }
  void put(const Evidence& evidence) {
    put(evidence.name);
    put(evidence.value);
    put(evidence.unit);
  }
  void put(const Subject& subject) {
    put(subject.name);
    put(subject.text);
  }

 private:
  std::vector<char>& bytes_;
};

/// A name as findings have it: for the rest of the program, as a literal is.
std::string_view name_for_good(std::string name) {
  static std::mutex one_at_a_time;
  static std::set<std::string, std::less<>> names;
  const std::scoped_lock lock(one_at_a_time);
  return *names.insert(std::move(name)).first;
}

class Reader {
 public:
  explicit Reader(std::span<const char> bytes) : bytes_(bytes) {}

  template <typename T>
  requires std::is_trivially_copyable_v<T>
  void get(T& value) {
    if (bytes_.size() < sizeof value) {
      failed_ = true;
      return;
    }
    std::memcpy(&value, bytes_.data(), sizeof value);
    bytes_ = bytes_.subspan(sizeof value);
  }
  void get(std::string& text) {
    const std::uint64_t size = count();
    text.assign(bytes_.data(), size);
    bytes_ = bytes_.subspan(size);
  }
  void get(std::string_view& name) {
    std::string text;
    get(text);
    name = name_for_good(std::move(text));
  }
  template <typename T>
  void get(std::vector<T>& values) {
    values.resize(count());  // an element takes a byte at least
    for (T& value : values) {
      if (!failed_) get(value);
    }
  }
  void get(Trust& trust) {
    get(trust.verdict);
    get(trust.reasons);
    get(trust.findings);
  }
  void get(Finding& finding) {
    get(finding.code);
    get(finding.evidence);
    get(finding.subjects);
    get(finding.key);
    get(finding.effect);
    get(finding.severity);
  }
  void get(Evidence& evidence) {
    get(evidence.name);
    get(evidence.value);
    get(evidence.unit);
  }
  void get(Subject& subject) {
    get(subject.name);
    get(subject.text);
  }
  void get(BatchException& exception) {
    get(exception.index);
    get(exception.trust);
    get(exception.failure);
  }
  [[nodiscard]] bool is_done() const { return !failed_ && bytes_.empty(); }

 private:
  std::uint64_t count() {
    std::uint64_t size = 0;
    get(size);
    failed_ = failed_ || size > bytes_.size();
    return failed_ ? 0 : size;
  }

  std::span<const char> bytes_;
  bool failed_ = false;
};

}  // namespace

void write_bytes(const BatchStiffness& answers, std::vector<char>& bytes) {
  Writer writer(bytes);
  writer.put(answers.stiffness);
  writer.put(answers.status);
  writer.put(answers.frequency);
  writer.put(answers.mode);
  writer.put(answers.poles_leaving);
  writer.put(answers.verdict);
  writer.put(answers.any_user);
  writer.put(answers.absolute_stability_frequency);
  writer.put(answers.trust);
  writer.put(std::uint64_t{answers.exceptions.size()});
  for (const BatchException& each : answers.exceptions) {
    writer.put(each.index);
    writer.put(each.trust);
    writer.put(each.failure);
  }
  writer.put(answers.scalar_count);
}

std::optional<BatchStiffness> answers_of(std::span<const char> bytes) {
  BatchStiffness answers;
  Reader reader(bytes);
  reader.get(answers.stiffness);
  reader.get(answers.status);
  reader.get(answers.frequency);
  reader.get(answers.mode);
  reader.get(answers.poles_leaving);
  reader.get(answers.verdict);
  reader.get(answers.any_user);
  reader.get(answers.absolute_stability_frequency);
  reader.get(answers.trust);
  reader.get(answers.exceptions);
  reader.get(answers.scalar_count);
  if (!reader.is_done()) return std::nullopt;
  return answers;
}

}  // namespace zwidth::study_engine
