#include "afm/friction.h"

#include <algorithm>
#include <cmath>

#include "core/not_numbers.h"

namespace afm {
namespace {

constexpr std::size_t kMinBins = 8;  // with fewer, the error itself is uncertain by more than 27 %: 1/sqrt(2 (n - 1))

constexpr double kFirstBinWidth = 1.0;  // [tau] a vertical period; the width doubles at every merge

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
  for (std::size_t i = 0; i < kBins / 2; ++i) amount_[i] = amount_[2 * i] + amount_[2 * i + 1];
  std::fill(amount_.begin() + kBins / 2, amount_.end(), 0.0);
  width_ *= 2.0;
}

void RateBins::add(double age, double amount) {
  while (age >= width_ * static_cast<double>(kBins)) merge();
  amount_[static_cast<std::size_t>(age / width_)] += amount;
}

void RateBins::spread(double begin, double end, double amount) {
  while (end >= width_ * static_cast<double>(kBins)) merge();
  const auto first = static_cast<std::size_t>(begin / width_), last = static_cast<std::size_t>(end / width_);
  if (first == last) {
    amount_[last] += amount;
    return;
  }
  for (std::size_t i = first; i <= last; ++i) {
    const double from = std::max(begin, width_ * static_cast<double>(i));
    const double to = std::min(end, width_ * static_cast<double>(i + 1));
    amount_[i] += amount * ((to - from) / (end - begin));
  }
}

double RateBins::std_error(double age) const {
  const double completed = std::min(age / width_, static_cast<double>(kBins));
  return standard_error(amount_.data(), static_cast<std::size_t>(completed), width_);
}

void PowerWindow::roll_to(double age) {
  const std::int64_t bin = static_cast<std::int64_t>(age / width_);
  const std::int64_t ring = static_cast<std::int64_t>(energy_.size());
  // after a long pause, clearing the ring once is enough
  current_ = std::max(current_, bin - ring);
  while (current_ < bin) energy_[static_cast<std::size_t>(++current_ % ring)] = 0.0;
}

void PowerWindow::add(double age, double energy) {
  roll_to(age);
  energy_[static_cast<std::size_t>(current_) % energy_.size()] += energy;
}

std::size_t PowerWindow::completed() const {
  return static_cast<std::size_t>(std::min<std::int64_t>(current_, static_cast<std::int64_t>(kWindowBins)));
}

double PowerWindow::mean(double age) {
  roll_to(age);
  const std::size_t n = completed();
  if (n == 0) return kNaN;
  double sum = 0.0;
  for (std::size_t i = 1; i <= n; ++i) sum += energy_[(static_cast<std::size_t>(current_) - i) % energy_.size()];
  return sum / (static_cast<double>(n) * width_);
}

double PowerWindow::std_error(double age) {
  roll_to(age);
  std::array<double, kWindowBins> bins{};
  const std::size_t n = completed();
  for (std::size_t i = 0; i < n; ++i) bins[i] = energy_[(static_cast<std::size_t>(current_) - i - 1) % energy_.size()];
  return standard_error(bins.data(), n, width_);
}

void CompensatedSum::add(double x) {
  const double term = x - rest_, sum = sum_ + term;
  rest_ = (sum - sum_) - term;
  sum_ = sum;
}

Friction::Friction(double window_tau)
    : window_tau_(window_tau), energy_bins_(kFirstBinWidth), impulse_bins_(kFirstBinWidth), window_(window_tau) {}

void Friction::restart(const ModelTime& now, double eta) {
  *this = Friction(window_tau_);
  start_ = window_start_ = now;
  eta_ = eta;
}

void Friction::set_window(const ModelTime& now, double window_tau) {
  window_tau_ = window_tau;
  window_start_ = now;
  window_ = PowerWindow(window_tau);
}

void Friction::add(const Segment& segment) {
  const double end = std::max(0.0, segment.end - start_);
  if (segment.impulse != 0.0) {
    impulse_.add(segment.impulse);
    impulse_bins_.spread(std::max(0.0, segment.begin - start_), end, segment.impulse);
  }
  if (segment.kind == SegmentKind::kick) heat_.add(segment.heat);
  if (segment.kind != SegmentKind::impact && segment.kind != SegmentKind::chatter) return;
  energy_.add(segment.loss);
  impact_count_ += segment.count;
  energy_bins_.add(end, segment.loss);
  window_.add(std::max(0.0, segment.end - window_start_), segment.loss);
}

FrictionEstimate Friction::estimate(const ModelTime& now, const Segment& open) {
  const double age = now - start_;
  FrictionEstimate e;
  e.energy_loss = energy_.value();
  e.impact_count = impact_count_;
  const double power = age > 0.0 ? energy_.value() / age : kNaN;
  const bool moving = eta_ != 0.0;
  const auto to_force = [&](double p) { return moving ? p / eta_ : 0.0; };
  const auto to_K_f = [&](double p) { return moving ? p / (eta_ * eta_) : kNaN; };
  const double error = energy_bins_.std_error(age);
  e.force = to_force(power);
  e.force_std_error = std::abs(to_force(error));
  e.K_f = to_K_f(power);
  e.K_f_std_error = to_K_f(error);
  const double window_age = now - window_start_;
  const double window_power = window_.mean(window_age);
  e.window_force = to_force(window_power);
  e.window_K_f = to_K_f(window_power);
  e.window_K_f_std_error = to_K_f(window_.std_error(window_age));
  e.mean_lateral_force = age > 0.0 ? (impulse_.value() + open.impulse) / age : kNaN;
  e.mean_lateral_force_std_error = impulse_bins_.std_error(age);
  e.K_f_work = moving ? e.mean_lateral_force / eta_ : kNaN;
  e.K_f_work_std_error = moving ? e.mean_lateral_force_std_error / std::abs(eta_) : kNaN;
  e.heat_to_bath = heat_.value();
  return e;
}

bool Friction::is_possible(const ModelTime& now, double window_tau) const {
  const auto is_phase = [](double phase) { return phase >= 0.0 && phase < 1.0; };
  const auto is_width = [](double width) { return width >= kFirstBinWidth && std::isfinite(width); };
  const bool in_time = is_phase(start_.phase) && is_phase(window_start_.phase) && ModelTime{} <= start_ &&
                       start_ <= window_start_ && window_start_ <= now;
  const double bins = (now - window_start_) / window_.width();
  return in_time && window_tau_ == window_tau && is_width(energy_bins_.width()) && is_width(impulse_bins_.width()) &&
         window_.width() == PowerWindow(window_tau).width() && window_.current() >= 0 &&
         static_cast<double>(window_.current()) <= bins;
}

}  // namespace afm
