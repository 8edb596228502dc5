// Every root of many polynomials on (0, 4], each in an interval of its own: Bernstein coefficients and Descartes' rule
// of signs by subdivision. One interval per lane, whatever its device. Included once per instruction set.
#if defined(ZWIDTH_BATCH_ROOT_ISOLATION_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef ZWIDTH_BATCH_ROOT_ISOLATION_INL_HPP
#undef ZWIDTH_BATCH_ROOT_ISOLATION_INL_HPP
#else
#define ZWIDTH_BATCH_ROOT_ISOLATION_INL_HPP
#endif

#include "batch/kernel/crossing_polynomial-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace zwidth::internal::HWY_NAMESPACE {

using Index = hn::RebindToSigned<Tag>;
using I = hn::Vec<Index>;

// Of a coefficient, relative to its size: each is a sum of some dozens of products of terms known to a few units.
inline constexpr double coefficient_rounding = 4e-14;
inline constexpr int most_divisions = 40;
inline constexpr std::uint16_t most_intervals = 300;  // of one device

// Columns of `capacity` elements each.
struct Polynomials {
  const double* values = nullptr;
  const double* sizes = nullptr;
  std::size_t stride = 0;
  std::size_t count = 0;  // of coefficients
};

struct Tasks {
  double* columns = nullptr;  // the Bernstein coefficients, begin, end, divisions
  std::int64_t* device = nullptr;
  std::size_t stride = 0;
  std::size_t size = 0;
};

struct Roots {
  double* columns = nullptr;  // begin, end, and the value at the begin, whose sign counts
  std::int64_t* device = nullptr;
  std::size_t stride = 0;
  std::size_t size = 0;
};

HWY_INLINE V binomial_weight(std::size_t n, std::size_t k, std::size_t i) {  // C(k, i) / C(n, i)
  double weight = 1.0;
  for (std::size_t j = 0; j < i; ++j) weight *= static_cast<double>(k - j) / static_cast<double>(n - j);
  return number(weight);
}

// One task for every device: (0, 4].
HWY_INLINE void begin_tasks(const Polynomials& p, std::size_t devices, Tasks& tasks) {
  const Tag tag;
  const std::size_t lanes = hn::Lanes(tag);
  const std::size_t n = p.count - 1;
  for (std::size_t k = 0; k <= n; ++k) {
    V weights[most_coefficients];
    double power = 1.0;
    for (std::size_t i = 0; i <= k; ++i, power *= 4.0) weights[i] = binomial_weight(n, k, i) * number(power);
    for (std::size_t at = 0; at < devices; at += lanes) {
      V sum = number(0.0);
      for (std::size_t i = 0; i <= k; ++i) {
        sum = hn::MulAdd(hn::LoadU(tag, p.values + i * p.stride + at), weights[i], sum);
      }
      hn::StoreU(sum, tag, tasks.columns + k * tasks.stride + at);
    }
  }
  for (std::size_t at = 0; at < devices; ++at) {
    tasks.columns[(n + 1) * tasks.stride + at] = 0.0;
    tasks.columns[(n + 2) * tasks.stride + at] = 4.0;
    tasks.columns[(n + 3) * tasks.stride + at] = 0.0;
    tasks.device[at] = static_cast<std::int64_t>(at);
  }
  tasks.size = devices;
}

HWY_INLINE void push(Tasks& tasks, std::size_t count, M which, const V* coefficients, V begin, V end, V divisions,
                     I device) {
  const Tag tag;
  for (std::size_t k = 0; k < count; ++k) {
    hn::CompressStore(coefficients[k], which, tag, tasks.columns + k * tasks.stride + tasks.size);
  }
  hn::CompressStore(begin, which, tag, tasks.columns + count * tasks.stride + tasks.size);
  hn::CompressStore(end, which, tag, tasks.columns + (count + 1) * tasks.stride + tasks.size);
  hn::CompressStore(divisions, which, tag, tasks.columns + (count + 2) * tasks.stride + tasks.size);
  hn::CompressStore(device, hn::RebindMask(Index(), which), Index(), tasks.device + tasks.size);
  tasks.size += hn::CountTrue(tag, which);
}

// Where an interval is divided: by ratio while it spans orders of magnitude, else in half.
HWY_INLINE V division_of(V begin, V end) {
  const V half = number(0.5) * (begin + end);
  const V by_ratio = choose(end > number(4.0) * begin, hn::Sqrt(begin * end), half);
  return choose(begin == number(0.0), end * number(1.0 / 32.0), by_ratio);
}

HWY_INLINE M have_other_signs(V a, V b) { return hn::Xor(a < number(0.0), b < number(0.0)); }

// Lanes whose device is certain so far: nothing more is asked of others.
HWY_INLINE M flags_of(const std::uint8_t* certain, const std::int64_t* device, std::size_t count) {
  const Tag tag;
  HWY_ALIGN double flags[8] = {};
  for (std::size_t i = 0; i < count; ++i) flags[i] = certain[device[i]];
  return hn::Load(tag, flags) > number(0.0);
}

// Divides until every interval holds one root or none. Where rounding or a double root forbids that, the device is not
// certain.
HWY_INLINE void isolate_roots(const Polynomials& p, Tasks& tasks, Roots& roots, std::uint16_t* used,
                              std::uint8_t* certain) {
  const Tag tag;
  const Index index_tag;
  const std::size_t lanes = hn::Lanes(tag);
  const std::size_t count = p.count;
  const std::size_t n = count - 1;
  while (tasks.size > 0) {
    const std::size_t taken = tasks.size < lanes ? tasks.size : lanes;
    const std::size_t first = tasks.size - taken;
    tasks.size = first;
    M active = hn::FirstN(tag, taken);
    V b[most_coefficients];
    for (std::size_t k = 0; k < count; ++k) b[k] = hn::LoadU(tag, tasks.columns + k * tasks.stride + first);
    const V begin = hn::LoadU(tag, tasks.columns + count * tasks.stride + first);
    const V end = hn::LoadU(tag, tasks.columns + (count + 1) * tasks.stride + first);
    const V divisions = hn::LoadU(tag, tasks.columns + (count + 2) * tasks.stride + first);
    const I device = hn::LoadU(index_tag, tasks.device + first);
    active = hn::And(active, flags_of(certain, tasks.device + first, taken));
    // The sizes' polynomial bounds the rounding of all coefficients where it is largest, at the end.
    V error = number(0.0);
    for (std::size_t k = count; k-- > 0;) {
      error = hn::MulAdd(error, end, hn::GatherIndex(tag, p.sizes + k * p.stride, device));
    }
    error = error * number(coefficient_rounding);
    M unsure = hn::Abs(b[0]) <= error;
    V largest = hn::Abs(b[0]);
    V changes = number(0.0);
    for (std::size_t k = 1; k < count; ++k) {
      largest = hn::Max(largest, hn::Abs(b[k]));
      unsure = hn::Or(unsure, hn::Abs(b[k]) <= error);
      changes = changes + hn::IfThenElseZero(have_other_signs(b[k], b[k - 1]), number(1.0));
    }
    const M sure = hn::And(active, hn::Not(unsure));
    const M one_root = hn::And(sure, changes == number(1.0));
    hn::CompressStore(begin, one_root, tag, roots.columns + roots.size);
    hn::CompressStore(end, one_root, tag, roots.columns + roots.stride + roots.size);
    hn::CompressStore(b[0], one_root, tag, roots.columns + 2 * roots.stride + roots.size);
    hn::CompressStore(device, hn::RebindMask(index_tag, one_root), index_tag, roots.device + roots.size);
    roots.size += hn::CountTrue(tag, one_root);

    const M open = hn::And(active, hn::Or(unsure, changes > number(1.0)));
    // Where all is rounding on an interval no division will tell more.
    const M hopeless = hn::And(largest <= error, end < number(1.5) * begin);
    const M divide = hn::AndNot(hopeless, hn::And(open, divisions < number(most_divisions)));
    const M given_up = hn::AndNot(divide, open);
    HWY_ALIGN std::int64_t devices[8];
    HWY_ALIGN double flags[8];
    hn::Store(device, index_tag, devices);
    hn::Store(hn::IfThenElseZero(given_up, number(1.0)), tag, flags);
    for (std::size_t i = 0; i < taken; ++i) {
      const auto at = static_cast<std::size_t>(devices[i]);
      if (++used[at] > most_intervals || flags[i] != 0.0) certain[at] = 0;
    }
    if (hn::AllFalse(tag, divide)) continue;
    // de Casteljau: what is left in b is the right part
    const V middle = division_of(begin, end);
    const V t = (middle - begin) / (end - begin);
    V left[most_coefficients];
    left[0] = b[0];
    for (std::size_t r = 1; r <= n; ++r) {
      for (std::size_t k = 0; k + r <= n; ++k) b[k] = hn::MulAdd(t, b[k + 1] - b[k], b[k]);
      left[r] = b[0];
    }
    const V more = divisions + number(1.0);
    push(tasks, count, divide, b, middle, end, more, device);
    push(tasks, count, divide, left, begin, middle, more, device);
  }
}

// Newton's steps, kept within the bracket: x of each root. After a step that small the next, squared, is rounding.
HWY_INLINE V refine_root(const V* c, std::size_t count, V begin, V end, V at_begin) {
  const Tag tag;
  constexpr int most_steps = 80;
  constexpr double last_refinement = 1e-6;
  const V zero = hn::Zero(tag);
  V x = division_of(begin, end);
  M done = hn::FirstN(tag, 0);
  for (int step = 0; step < most_steps; ++step) {
    V value = c[count - 1];
    V slope = zero;
    for (std::size_t k = count - 1; k-- > 0;) {
      slope = hn::MulAdd(slope, x, value);
      value = hn::MulAdd(value, x, c[k]);
    }
    const M before = hn::Not(have_other_signs(value, at_begin));
    begin = choose(before, x, begin);
    end = choose(before, end, x);
    const V newton = x - value / slope;
    const M inside = hn::And(newton > begin, newton < end);
    const V next = choose(inside, newton, division_of(begin, end));
    const M arrived = hn::Or(hn::Abs(next - x) <= number(last_refinement) * x, value == zero);
    x = choose(done, x, choose(value == zero, x, next));
    done = hn::Or(done, arrived);
    if (hn::AllTrue(tag, done)) break;
  }
  return x;
}

}  // namespace zwidth::internal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
