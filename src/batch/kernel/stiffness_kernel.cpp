#include "batch/kernel/stiffness_kernel.hpp"

#include <algorithm>
#include <cmath>

// AVX2, AVX-512, NEON, and one device at a time elsewhere; those of which vectors have no fixed length cannot stand in
// arrays. Each instruction set takes a compiler 5 s, and machines with SSE4 alone are older than 2013.
#define HWY_DISABLED_TARGETS \
  (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "batch/kernel/stiffness_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "batch/kernel/crossing_polynomial-inl.hpp"
#include "batch/kernel/crossover-inl.hpp"
#include "batch/kernel/kernel_terms-inl.hpp"
#include "batch/kernel/pole_guard-inl.hpp"
#include "batch/kernel/root_isolation-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace zwidth::internal::HWY_NAMESPACE {

// A device's crossover of least stiffness, and what else is close to it.
enum BestRow : std::size_t { best_stiffness, best_x, next_stiffness, best_rows };

constexpr double infinite = 1e300;
// Another crossover nearer than this, relative, is for the library to tell apart.
constexpr double apart = 1e-5;
// Of which of two mechanisms is the larger.
constexpr double distinct = 1e-8;
// Rounding of a stiffness, in units of double: what both routes may differ by stays below 1e-12.
constexpr double most_noise = 300.0;
constexpr double last_step = 1e-9;
constexpr double nearest_nyquist = 1e-3;  // of 4 - x
constexpr int polishing_steps = 3;
constexpr double unsure_sign = 1e-6;  // of K against the plant's and the damper's part of it

HWY_INLINE void load_rows(const double* rows, std::size_t stride, std::size_t at, V* out) {
  for (std::size_t i = 0; i < term_rows; ++i) out[i] = hn::LoadU(Tag(), rows + i * stride + at);
}

HWY_INLINE M mask_of(const std::uint8_t* flags) {
  const Tag tag;
  HWY_ALIGN double values[8];
  for (std::size_t i = 0; i < hn::Lanes(tag); ++i) values[i] = flags[i];
  return hn::Load(tag, values) > number(0.0);
}

HWY_INLINE void store_flags(M flags, std::uint8_t* out) {
  const Tag tag;
  HWY_ALIGN double values[8];
  hn::Store(hn::IfThenElseZero(flags, number(1.0)), tag, values);
  for (std::size_t i = 0; i < hn::Lanes(tag); ++i) out[i] = values[i] != 0.0 ? 1 : 0;
}

// Whether the sign of a crossover's stiffness is lost in the rounding of its parts.
HWY_INLINE M is_unsure(const CrossoverAt& at, const V* rows) {
  return hn::Not(hn::Abs(at.stiffness.value) > number(unsure_sign) * (at.inverse + rows[damper_rate]));
}

// Terms and polynomials of all devices; how many coefficients these have.
HWY_NOINLINE std::size_t prepare(const KernelGroup& group, const KernelDevices& devices, std::size_t length,
                                 KernelAnswers& answers, KernelScratch& scratch) {
  const Tag tag;
  const GroupPowers powers = powers_of(group);
  std::size_t count = 0;
  for (std::size_t at = 0; at < length; at += hn::Lanes(tag)) {
    V in[kernel_inputs];
    for (std::size_t i = 0; i < kernel_inputs; ++i) in[i] = hn::LoadU(tag, devices.inputs[i].data() + at);
    Terms terms;
    const M fits = terms_of(group, in, terms);
    for (std::size_t i = 0; i < term_rows; ++i) hn::StoreU(terms.row[i], tag, scratch.terms.data() + i * length + at);
    const SizedPolynomial f = crossing_polynomial(group, powers, terms);
    count = f.count;
    double* sizes = scratch.polynomial.data() + count * length;
    V sum = number(0.0);
    for (std::size_t k = 0; k < count; ++k) {
      hn::StoreU(f.value[k], tag, scratch.polynomial.data() + k * length + at);
      hn::StoreU(f.size[k] * terms.row[condition], tag, sizes + k * length + at);
      sum = sum + f.size[k];
    }
    const M good = hn::And(fits, sum < number(infinite));  // NaN is not
    store_flags(good, answers.certain.data() + at);
  }
  return count;
}

// The stiffness of every root, and of each device the least and the next.
HWY_NOINLINE void take_least(const KernelGroup& group, const Polynomials& p, const Roots& roots, std::size_t length,
                             KernelAnswers& answers, KernelScratch& scratch, double* best) {
  const Tag tag;
  const hn::RebindToSigned<Tag> index_tag;
  for (std::size_t i = 0; i < length; ++i) {
    best[best_stiffness * length + i] = best[next_stiffness * length + i] = infinite;
    best[best_x * length + i] = 1.0;
  }
  for (std::size_t first = 0; first < roots.size; first += hn::Lanes(tag)) {
    const std::size_t taken = std::min(hn::Lanes(tag), roots.size - first);
    for (std::size_t i = taken; i < hn::Lanes(tag); ++i) {  // idle lanes repeat the first
      roots.device[first + i] = roots.device[first];
      for (std::size_t c = 0; c < 3; ++c)
        roots.columns[c * roots.stride + first + i] = roots.columns[c * roots.stride + first];
    }
    const I device = hn::LoadU(index_tag, roots.device + first);
    V coefficients[most_coefficients];
    for (std::size_t k = 0; k < p.count; ++k) coefficients[k] = hn::GatherIndex(tag, p.values + k * p.stride, device);
    const V x = refine_root(coefficients, p.count, hn::LoadU(tag, roots.columns + first),
                            hn::LoadU(tag, roots.columns + roots.stride + first),
                            hn::LoadU(tag, roots.columns + 2 * roots.stride + first));
    V rows[term_rows];
    for (std::size_t i = 0; i < term_rows; ++i)
      rows[i] = hn::GatherIndex(tag, scratch.terms.data() + i * length, device);
    const CrossoverAt at = crossover_at(group, rows, x);
    const V stiffness = at.stiffness.value;
    const M unsure = is_unsure(at, rows);
    HWY_ALIGN double k[8];
    HWY_ALIGN double where[8];
    HWY_ALIGN double doubt[8];
    hn::Store(stiffness, tag, k);
    hn::Store(x, tag, where);
    hn::Store(hn::IfThenElseZero(unsure, number(1.0)), tag, doubt);
    for (std::size_t i = 0; i < taken; ++i) {
      const auto index = static_cast<std::size_t>(roots.device[first + i]);
      if (doubt[i] != 0.0) answers.certain[index] = 0;
      if (!(k[i] > 0.0)) continue;
      double& least = best[best_stiffness * length + index];
      double& next = best[next_stiffness * length + index];
      if (k[i] < least) {
        next = least;
        least = k[i];
        best[best_x * length + index] = where[i];
      } else {
        next = std::min(next, k[i]);
      }
    }
  }
}

// The same where the polynomial is of degree 1, as that of a rigid device without delay: its only root in closed form.
HWY_NOINLINE void take_only_root(const KernelGroup& group, const Polynomials& p, std::size_t length,
                                 KernelAnswers& answers, const KernelScratch& scratch, double* best) {
  const Tag tag;
  for (std::size_t at = 0; at < length; at += hn::Lanes(tag)) {
    const V begin = hn::LoadU(tag, p.values + at);
    const V slope = hn::LoadU(tag, p.values + p.stride + at);
    const V end = hn::MulAdd(number(4.0), slope, begin);
    const V size = hn::MulAdd(number(4.0), hn::LoadU(tag, p.sizes + p.stride + at), hn::LoadU(tag, p.sizes + at));
    const V error = number(coefficient_rounding) * size;
    const M sure = hn::And(hn::Abs(begin) > error, hn::Abs(end) > error);
    const M crosses = have_other_signs(begin, end);
    V rows[term_rows];
    load_rows(scratch.terms.data(), length, at, rows);
    const V x = choose(crosses, hn::Neg(begin / slope), number(1.0));
    const CrossoverAt crossover = crossover_at(group, rows, x);
    const V stiffness = crossover.stiffness.value;
    const M counts = hn::And(crosses, stiffness > number(0.0));
    hn::StoreU(choose(counts, stiffness, number(infinite)), tag, best + best_stiffness * length + at);
    hn::StoreU(number(infinite), tag, best + next_stiffness * length + at);
    hn::StoreU(x - crossover.phase.value / crossover.phase.slope, tag, best + best_x * length + at);
    const M known = hn::AndNot(hn::And(crosses, is_unsure(crossover, rows)), sure);
    store_flags(hn::And(mask_of(answers.certain.data() + at), known), answers.certain.data() + at);
  }
}

HWY_INLINE M confirmed(const KernelGroup& group, const V* in, V stiffness) {
  if (group.two_bodies) {
    return group.lag ? poles_confirm<5>(group, in, stiffness) : poles_confirm<4>(group, in, stiffness);
  }
  return group.lag ? poles_confirm<3>(group, in, stiffness) : poles_confirm<2>(group, in, stiffness);
}

// The least crossover with all its digits, its mechanism, and whether the second route confirms it.
HWY_NOINLINE void answer(const KernelGroup& group, const KernelDevices& devices, std::size_t count, std::size_t length,
                         int steps, const double* best, KernelAnswers& answers, const KernelScratch& scratch) {
  const Tag tag;
  const V one = number(1.0);
  for (std::size_t at = 0; at < count; at += hn::Lanes(tag)) {
    M certain = mask_of(answers.certain.data() + at);
    if (hn::AllFalse(tag, certain)) continue;
    V rows[term_rows];
    load_rows(scratch.terms.data(), length, at, rows);
    V x = hn::LoadU(tag, best + best_x * length + at);
    const V least = hn::LoadU(tag, best + best_stiffness * length + at);
    const V next = hn::LoadU(tag, best + next_stiffness * length + at);
    const AtNyquist nyquist = at_nyquist(group, rows);
    const M by_nyquist = hn::And(nyquist.stiffness > number(0.0), nyquist.stiffness < least);
    CrossoverAt crossover{};
    V step = number(0.0);
    for (int i = 0; i < steps; ++i) {
      x = x - step;
      crossover = crossover_at(group, rows, x);
      step = crossover.phase.value / crossover.phase.slope;
    }
    V stiffness = crossover.stiffness.value - crossover.stiffness.slope * step;
    x = x - step;
    V noise = crossover.noise;
    V angle = number(2.0) * hn::Atan(tag, hn::Sqrt(x / (number(4.0) - x)));
    V rigid = crossover.rigid;
    V mode = crossover.mode;
    const M polished = hn::And(hn::Abs(step) < number(last_step) * x,
                               hn::And(number(4.0) - x > number(nearest_nyquist), least < number(infinite)));
    certain = hn::And(certain, hn::Or(by_nyquist, polished));
    // The other candidates are farther.
    const V taken = choose(by_nyquist, nyquist.stiffness, stiffness);
    const V others = choose(by_nyquist, least, hn::Min(next, nyquist.least_stiffness));
    certain = hn::And(certain, others > taken * number(1.0 + apart));
    stiffness = taken;
    noise = choose(by_nyquist, nyquist.noise, noise);
    rigid = choose(by_nyquist, nyquist.rigid, rigid);
    mode = choose(by_nyquist, nyquist.mode, mode);
    angle = choose(by_nyquist, number(3.14159265358979323846), angle);
    certain = hn::And(certain, hn::And(noise<number(most_noise), stiffness> number(0.0)));
    certain = hn::And(certain, hn::Abs(rigid - mode) > number(distinct) * (rigid + mode));
    if (hn::AllFalse(tag, certain)) {
      for (std::size_t i = 0; i < hn::Lanes(tag); ++i) answers.certain[at + i] = 0;
      continue;
    }
    V in[kernel_inputs];
    for (std::size_t i = 0; i < kernel_inputs; ++i) in[i] = hn::LoadU(tag, devices.inputs[i].data() + at);
    certain = hn::And(certain, confirmed(group, in, stiffness));
    hn::StoreU(stiffness, tag, answers.stiffness.data() + at);
    hn::StoreU(angle / rows[sample_period], tag, answers.frequency.data() + at);
    HWY_ALIGN double vibrates[8];
    HWY_ALIGN double real[8];
    store_flags(certain, answers.certain.data() + at);
    hn::Store(hn::IfThenElseZero(mode > rigid, one), tag, vibrates);
    hn::Store(hn::IfThenElseZero(by_nyquist, one), tag, real);
    for (std::size_t i = 0; i < hn::Lanes(tag); ++i) {
      answers.mode[at + i] = vibrates[i] != 0.0 ? 1 : 0;
      answers.poles_leaving[at + i] = real[i] != 0.0 ? 1 : 2;  // a certain root is simple, and left unstable
    }
  }
}

void solve(const KernelGroup& group, const KernelDevices& devices, std::size_t count, KernelAnswers& answers,
           KernelScratch& scratch) {
  const std::size_t lanes = hn::Lanes(Tag());
  const std::size_t length = padded(count);
  const std::size_t task_stride = length + lanes * static_cast<std::size_t>(most_divisions + 4);
  const std::size_t root_stride = length * most_coefficients + lanes;
  scratch.terms.resize(std::max(scratch.terms.size(), (std::size_t{term_rows} + std::size_t{best_rows}) * length));
  scratch.polynomial.resize(std::max(scratch.polynomial.size(), 2 * most_coefficients * length));
  scratch.tasks.resize(std::max(scratch.tasks.size(), (most_coefficients + 3) * task_stride));
  scratch.task_device.resize(std::max(scratch.task_device.size(), task_stride));
  scratch.roots.resize(std::max(scratch.roots.size(), 3 * root_stride));
  scratch.root_device.resize(std::max(scratch.root_device.size(), root_stride));
  const std::size_t coefficients = prepare(group, devices, length, answers, scratch);
  const Polynomials p{scratch.polynomial.data(), scratch.polynomial.data() + coefficients * length, length,
                      coefficients};
  double* best = scratch.terms.data() + term_rows * length;
  if (coefficients == 2) {
    take_only_root(group, p, length, answers, scratch, best);
    return answer(group, devices, count, length, 1, best, answers, scratch);  // its root is polished already
  }
  Tasks tasks{scratch.tasks.data(), scratch.task_device.data(), task_stride, 0};
  Roots roots{scratch.roots.data(), scratch.root_device.data(), root_stride, 0};
  begin_tasks(p, count, tasks);
  scratch.intervals.assign(length, 0);
  isolate_roots(p, tasks, roots, scratch.intervals.data(), answers.certain.data());
  take_least(group, p, roots, length, answers, scratch, best);
  answer(group, devices, count, length, polishing_steps, best, answers, scratch);
}

}  // namespace zwidth::internal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace zwidth::internal {

HWY_EXPORT(solve);

void solve_group(const KernelGroup& group, const KernelDevices& devices, std::size_t count, KernelAnswers& answers,
                 KernelScratch& scratch) {
  if (count > 0) HWY_DYNAMIC_DISPATCH(solve)(group, devices, count, answers, scratch);
}

}  // namespace zwidth::internal
#endif
