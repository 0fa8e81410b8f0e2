#include "afm/friction.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "afm/model.h"
#include "afm/sample_grid.h"
#include "core/not_numbers.h"
#include "core/run/batch_means.h"

namespace afm {
namespace {

constexpr std::size_t kMinBins = 8;  // with fewer, the error itself is uncertain by more than 27 %: 1/sqrt(2 (n - 1))

// Standard error of the mean rate over n bins.
double standard_error(const double* energy, std::size_t n, double width) {
  if (n < kMinBins) return kNaN;
  double mean = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < n; ++i) mean += energy[i];
  mean /= static_cast<double>(n);
  for (std::size_t i = 0; i < n; ++i) squares += (energy[i] - mean) * (energy[i] - mean);
  return std::sqrt(squares / static_cast<double>(n * (n - 1))) / width;
}

}  // namespace

void RateBins::merge() {
  for (std::size_t i = 0; i < kBins / 2; ++i) amount[i] = amount[2 * i] + amount[2 * i + 1];
  std::fill(amount.begin() + kBins / 2, amount.end(), 0.0);
  width *= 2.0;
}

void RateBins::add(double age, double part) {
  while (age >= width * static_cast<double>(kBins)) merge();
  amount[static_cast<std::size_t>(age / width)] += part;
}

void RateBins::spread(double begin, double end, double part) {
  while (end >= width * static_cast<double>(kBins)) merge();
  const auto first = static_cast<std::size_t>(begin / width), last = static_cast<std::size_t>(end / width);
  if (first == last) {
    amount[last] += part;
    return;
  }
  for (std::size_t i = first; i <= last; ++i) {
    const double from = std::max(begin, width * static_cast<double>(i));
    const double to = std::min(end, width * static_cast<double>(i + 1));
    amount[i] += part * ((to - from) / (end - begin));
  }
}

RateBins RateBins::at(double age) const {
  RateBins now = *this;  // nothing was added for a time: that counts as well
  while (age >= now.width * static_cast<double>(kBins)) now.merge();
  return now;
}

double RateBins::std_error(double age) const {
  const RateBins now = at(age);
  return standard_error(now.amount.data(), static_cast<std::size_t>(age / now.width), now.width);
}

double RateBins::std_error(double age, double mean) const {
  const RateBins now = at(age);
  const auto n = static_cast<std::size_t>(age / now.width);
  if (n < kMinBins) return kNaN;
  const double sum = std::accumulate(now.amount.data(), now.amount.data() + n, 0.0);
  const double scatter = standard_error(now.amount.data(), n, now.width);
  const double rest = mean - sum / (static_cast<double>(n) * now.width);
  return std::sqrt(scatter * scatter + rest * rest);
}

namespace {

// The number of a bin. The shortest window overflows no number, as far as a run can reach.
std::int64_t bin_of(double age, double width) { return static_cast<std::int64_t>(std::min(age / width, 0x1p62)); }

}  // namespace

void PowerWindow::roll_to(double age) {
  const std::int64_t bin = bin_of(age, width);
  const std::int64_t ring = static_cast<std::int64_t>(energy.size());
  // after a long pause, clearing the ring once is enough
  current = std::max(current, bin - ring);
  while (current < bin) energy[static_cast<std::size_t>(++current % ring)] = 0.0;
}

void PowerWindow::add(double age, double part) {
  roll_to(age);
  energy[static_cast<std::size_t>(current) % energy.size()] += part;
}

std::size_t PowerWindow::completed() const {
  return static_cast<std::size_t>(std::min<std::int64_t>(current, static_cast<std::int64_t>(kWindowBins)));
}

double PowerWindow::mean(double age) {
  roll_to(age);
  const std::size_t n = completed();
  if (n == 0) return kNaN;
  double sum = 0.0;
  for (std::size_t i = 1; i <= n; ++i) sum += energy[(static_cast<std::size_t>(current) - i) % energy.size()];
  return sum / (static_cast<double>(n) * width);
}

double PowerWindow::std_error(double age) {
  roll_to(age);
  std::array<double, kWindowBins> bins{};
  const std::size_t n = completed();
  for (std::size_t i = 0; i < n; ++i) bins[i] = energy[(static_cast<std::size_t>(current) - i - 1) % energy.size()];
  return standard_error(bins.data(), n, width);
}

void CompensatedSum::add(double x) {
  const double term = x - rest, sum = value + term;
  rest = (sum - value) - term;
  value = sum;
}

void Friction::restart(const ModelTime& now, double eta) {
  sums_ = FrictionSums(sums_.window_tau);
  sums_.start = sums_.window_start = now;
  sums_.eta = eta;
}

void Friction::set_window(const ModelTime& now, double window_tau) {
  sums_.window_tau = window_tau;
  sums_.window_start = now;
  sums_.window = PowerWindow(window_tau);
}

void Friction::add(const Segment& segment) {
  const double end = std::max(0.0, segment.end - sums_.start);
  if (segment.impulse != 0.0) {
    sums_.impulse.add(segment.impulse);
    sums_.impulse_bins.spread(std::max(0.0, segment.begin - sums_.start), end, segment.impulse);
  }
  if (segment.kind == SegmentKind::kick) sums_.heat.add(segment.heat);
  if (segment.kind != SegmentKind::impact && segment.kind != SegmentKind::chatter) return;
  sums_.energy.add(segment.loss);
  sums_.impact_count += segment.count;
  sums_.energy_bins.add(end, segment.loss);
  sums_.window.add(std::max(0.0, segment.end - sums_.window_start), segment.loss);
}

void Friction::add_samples(const double* vertical, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) sums_.vertical.add(vertical[i]);
  sums_.samples += n;
}

FrictionEstimate Friction::estimate(const ModelTime& now, const Segment& open) {
  const double age = now - sums_.start;
  FrictionEstimate e;
  e.energy_loss = sums_.energy.value;
  e.impact_count = sums_.impact_count;
  const double power = age > 0.0 ? sums_.energy.value / age : kNaN;
  const bool moving = sums_.eta != 0.0;
  const auto to_force = [&](double p) { return moving ? p / sums_.eta : 0.0; };
  const auto to_K_f = [&](double p) { return moving ? p / (sums_.eta * sums_.eta) : kNaN; };
  const double error = sums_.energy_bins.std_error(age, power);
  e.force = to_force(power);
  e.force_std_error = std::abs(to_force(error));
  e.K_f = to_K_f(power);
  e.K_f_std_error = to_K_f(error);
  const double window_age = now - sums_.window_start;
  const double window_power = sums_.window.mean(window_age);
  e.window_force = to_force(window_power);
  e.window_K_f = to_K_f(window_power);
  e.window_K_f_std_error = to_K_f(sums_.window.std_error(window_age));
  e.mean_lateral_force = age > 0.0 ? (sums_.impulse.value + open.impulse) / age : kNaN;
  e.K_f_work = moving ? e.mean_lateral_force / sums_.eta : kNaN;
  const double impulse_error = sums_.impulse_bins.std_error(age);
  if (moving) {
    const bool has_bath = sums_.heat.value != 0.0;
    const double stored = e.K_f_work - e.K_f - to_K_f(sums_.heat.value / age);
    const double scatter = has_bath ? impulse_error / std::abs(sums_.eta) : e.K_f_std_error;
    e.mean_lateral_force_std_error = detail::work_std_error(scatter, stored) * std::abs(sums_.eta);
    e.K_f_work_std_error = e.mean_lateral_force_std_error / std::abs(sums_.eta);
  } else {
    e.K_f_work_std_error = kNaN;
    e.mean_lateral_force_std_error = impulse_error;
  }
  const double spring_constant = kTwoPi * kTwoPi;  // of the vertical spring: m omega_v^2
  e.mean_normal_force =
      sums_.samples > 0 ? spring_constant * (sums_.vertical.value / static_cast<double>(sums_.samples)) : kNaN;
  e.heat_to_bath = sums_.heat.value;
  return e;
}

bool Friction::is_possible(const ModelTime& now, double eta, double window_tau) const {
  const FrictionSums& s = sums_;
  const auto are_finite = [](const auto& numbers) {
    return std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); });
  };
  const std::array<double, 8> sums{s.energy.value, s.energy.rest, s.impulse.value,  s.impulse.rest,
                                   s.heat.value,   s.heat.rest,   s.vertical.value, s.vertical.rest};
  const auto is_width = [](double width) { return width >= RateBins{}.width && std::isfinite(width); };
  return afm::is_possible(now) && afm::is_possible(s.start) && afm::is_possible(s.window_start) &&
         s.start <= s.window_start && s.window_start <= now && s.eta == eta && s.window_tau == window_tau &&
         are_finite(sums) && are_finite(s.energy_bins.amount) && are_finite(s.impulse_bins.amount) &&
         are_finite(s.window.energy) && is_width(s.energy_bins.width) && is_width(s.impulse_bins.width) &&
         s.window.width == PowerWindow(window_tau).width && s.window.width > 0.0 && s.window.current >= 0 &&
         s.window.current <= bin_of(now - s.window_start, s.window.width);
}

}  // namespace afm
