#include "study/answer_bytes.hpp"

#include <algorithm>
#include <cstring>
#include <string>
#include <type_traits>

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
  void put(const std::string& text) {
    put(std::uint64_t{text.size()});
    bytes_.insert(bytes_.end(), text.begin(), text.end());
  }
  template <typename T>
  void put(const std::vector<T>& values) {
    put(std::uint64_t{values.size()});
    for (const T& value : values) put(value);
  }
  void put(const Trust& trust) {
    put(trust.verdict);
    put(trust.reasons);
  }

 private:
  std::vector<char>& bytes_;
};

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
  writer.put(answers.any_user_frequency);
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
  reader.get(answers.any_user_frequency);
  reader.get(answers.trust);
  reader.get(answers.exceptions);
  reader.get(answers.scalar_count);
  if (!reader.is_done()) return std::nullopt;
  return answers;
}

}  // namespace zwidth::study_engine
