// The oscillator's parameters in natural units: length a (lattice spacing), time tau = 2 pi / omega_v, mass m (tip).
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace afm {

constexpr double kTwoPi = 6.283185307179586476925286766559;

// What is wrong with one parameter: its name, the value given, and why that value cannot be used.
class ParameterError : public std::invalid_argument {
 public:
  ParameterError(std::string name, double value, std::string reason);

  std::string name;
  double value;
  std::string reason;
};

// oscillator: both springs. hammer (the paper's section IX): the horizontal spring infinitely stiff, x = xc; the holder
// takes what the surface gives along x, so an impact turns the gap rate alone, and its extension and horizontal
// velocity are not its own.
enum class ModelKind : std::uint8_t { oscillator, hammer };

// Defaults are the paper's mica values (section V). The drag velocity eta is not here: it is commanded while running.
struct Model {
  double frequency_ratio = 6.25;  // omega_h / omega_v
  double H = 0.05 / 0.52;         // surface amplitude [a]: h(x) = H cos(2 pi x), crest at x = 0
  double y0 = 0.0;                // height of the harmonic centre [a]; below H, or the tip would hover
  double gamma = 0.7;             // restitution at and above the cutoff
  double v_c = 0.05;              // cutoff of the restitution law [a/tau]; 0: gamma at every speed
  ModelKind kind = ModelKind::oscillator;
};

// "oscillator" or "hammer"; false where the name is neither.
bool parse(const std::string& name, ModelKind& kind);
const char* name(ModelKind kind);

// 1 where the tip is free along the surface, 0 where it is held.
inline double is_free_along_x(const Model& model) { return model.kind == ModelKind::hammer ? 0.0 : 1.0; }

// Of the section of impacts: a held tip has its phase and gap rate only.
inline int section_dimension(const Model& model) { return model.kind == ModelKind::hammer ? 2 : 4; }

// The envelope: what a scene can want, with a wide margin. Beyond it nothing is tested.
constexpr double kMaxEta = 1000.0;  // [a/tau], and of a start's velocities: the reference flights reach 224
constexpr double kMinFrequencyRatio = 0.01;
constexpr double kMaxFrequencyRatio = 1000.0;  // the paper's is 6.25; the hammer is the limit of stiff springs
constexpr double kMinAmplitude = 1e-6;         // [a]
constexpr double kMaxAmplitude = 1.0;          // [a]: ten times mica
constexpr double kLowestRest = -10.0;          // y0 [a]: a hundred times mica's amplitude
constexpr double kMinCutoff = 1e-9;            // [a/tau], or 0
constexpr double kLeastGapRate = 1e-16;  // [a/tau]: slower bounces are contact; the rounding of a velocity of 1 a/tau

// Every fault of the set, not only the first; empty when the model can be run.
std::vector<ParameterError> find_faults(const Model& model);

// All faults in one text, a line each: "name = value: reason".
std::string describe(const std::vector<ParameterError>& faults);

}  // namespace afm
