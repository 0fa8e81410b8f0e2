// The parameters of the model (paper, sections II and V) in natural units: length a (lattice spacing), time
// tau = 2 pi / omega_v, mass m (tip). The limits below are the preconditions of everything else in the library.
#pragma once

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace afm {

constexpr double kTwoPi = 6.283185307179586476925286766559;

// A fault of one parameter: its name, the value given, and the reason why it cannot be used.
class ParameterError : public std::invalid_argument {
 public:
  ParameterError(std::string name, double value, std::string reason);

  std::string name;
  double value;
  std::string reason;
};

// oscillator: both springs. hammer (paper, section IX): the horizontal spring is infinitely stiff, so x = xc. The
// holder takes the impulse along x, and an impact changes the gap rate alone. The hammer's extension is 0 and its
// velocity that of the holder.
enum class ModelKind : std::uint8_t { oscillator, hammer };

// Defaults are the paper's mica values (section V). The drag velocity eta is not here: it is commanded while running.
struct Model {
  double frequency_ratio = 6.25;  // omega_h / omega_v
  double H = 0.05 / 0.52;         // surface amplitude [a]: h(x) = H cos(2 pi x), crest at x = 0
  double y0 = 0.0;                // rest height: of the holder above mid-surface [a]; below H, or the tip would hover
  double gamma = 0.7;             // restitution at and above the cutoff
  double v_c = 0.05;              // cutoff of the restitution law [a/tau]; 0: gamma at every speed
  ModelKind kind = ModelKind::oscillator;
};

// "oscillator" or "hammer"; false for any other name.
bool parse(const std::string& name, ModelKind& kind);
const char* name(ModelKind kind);

// 1 for the oscillator, 0 for the hammer: a factor of every motion along x.
inline double is_free_along_x(const Model& model) { return model.kind == ModelKind::hammer ? 0.0 : 1.0; }

// Whether its load holds the tip down at rest: the holder is below the valleys.
inline bool is_held_down(const Model& model) { return model.y0 < -model.H; }

// The extension of the lateral spring at which the load can hold the tip on the steepest flank no longer [a]. The load
// k a |y0| times the slope 2 pi H over the lateral spring constant; 0 without a load, and of a hammer.
inline double longest_extension(const Model& model) {
  if (model.kind == ModelKind::hammer) return 0.0;
  return std::max(0.0, -model.y0) * kTwoPi * model.H / (model.frequency_ratio * model.frequency_ratio);
}

// The section of impacts: the hammer has only its phase and gap rate.
inline int section_dimension(const Model& model) { return model.kind == ModelKind::hammer ? 2 : 4; }

// The limits of the parameters: what scenes use, with a wide margin. The tests go up to them and not beyond.
constexpr double kMaxEta = 1000.0;  // [a/tau], and of a start's velocities: the reference flights reach 224
constexpr double kMinFrequencyRatio = 0.01;
constexpr double kMaxFrequencyRatio = 1000.0;  // the paper's is 6.25; the hammer is the limit of stiff springs
constexpr double kMinAmplitude = 1e-6;         // [a]
constexpr double kMaxAmplitude = 1.0;          // [a]: ten times mica
constexpr double kMinRestHeight = -1e5;        // y0 [a]: 98 nN on graphite at 0.004 N/m; above it a gap keeps 10 digits
constexpr double kMinCutoff = 1e-9;            // [a/tau], or 0
constexpr double kMinGapRate = 1e-16;  // [a/tau]: slower bounces are contact; the rounding of a velocity of 1 a/tau

// Every fault of the set, not only the first; empty when the model can be run.
std::vector<ParameterError> find_faults(const Model& model);

// All faults in one text, a line each: "name = value: reason".
std::string describe(const std::vector<ParameterError>& faults);

}  // namespace afm
