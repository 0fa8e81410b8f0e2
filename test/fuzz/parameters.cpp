// Any tree of values on the parameter server: every fault is reported, and what has none can be run.
#include "afm/run.h"
#include "bytes.h"
#include "node/params/parameters.h"
#include "node/params/table.h"
#include "target.h"

namespace {

using afm::fuzz::Bytes;
using afm::fuzz::require;
using Value = XmlRpc::XmlRpcValue;

// All that there are, and one that there is not. The inputs that are kept mean them by their order.
const std::vector<std::string>& names() {
  static const auto all = [] {
    std::vector<std::string> found;
    afm::node::Parameters parameters;
    afm::node::for_each_parameter(parameters, [&](const char* name, auto&) { found.emplace_back(name); });
    found.emplace_back("diagnostic_period");
    return found;
  }();
  return all;
}

std::string text_of(Bytes& bytes) {
  const char* const known[] = {"oscillator", "hammer", "none", "lz4", "lockstep", "command", "deflection", "", "1e-4"};
  return bytes.below(2) == 0 ? known[bytes.below(9)] : bytes.text(40);
}

Value value_of(Bytes& bytes, int depth) {
  switch (bytes.below(10)) {
    case 0: return Value(bytes.raw<std::int32_t>());
    case 1: return Value(bytes.below(2) == 1);
    case 2: return Value(text_of(bytes));
    case 3: return Value(bytes.raw<double>());
    case 4: {
      Value list;
      list.setSize(0);
      for (std::size_t i = 0, n = depth > 3 ? 0 : bytes.below(4); i < n; ++i)
        list[static_cast<int>(i)] = value_of(bytes, depth + 1);
      return list;
    }
    case 5: {
      Value tree;
      for (std::size_t i = 0, n = depth > 3 ? 0 : bytes.below(4); i < n; ++i)
        tree[bytes.text(10)] = value_of(bytes, depth + 1);
      return tree;
    }
    case 6: return Value(bytes.within(-1.0, 1.0));
    case 7: return Value(bytes.within(0.0, 1e6));
    case 8: return Value(bytes.within(-1e-4, 1e-4));
    default: return Value(bytes.within(0.0, 1e-9));
  }
}

Value tree_of(Bytes& bytes) {
  if (bytes.below(32) == 0) return value_of(bytes, 0);
  Value tree;
  while (!bytes.empty()) {
    const std::size_t name = bytes.below(names().size() + 1);
    tree[name < names().size() ? names()[name] : bytes.text(20)] = value_of(bytes, 0);
  }
  return tree;
}

void check_runs(const afm::node::Parameters& parameters) {
  const std::uint64_t samples = afm::node::samples_per_batch(parameters);
  require(samples >= 1 && samples <= 1000000, "a batch of " + std::to_string(samples) + " samples");
  const double period = std::chrono::duration<double>(afm::node::batch_period(parameters)).count();
  require(period > 0.0 && period <= 1.001, "a batch every " + std::to_string(period) + " s");
  afm::RunSettings settings = afm::node::run_settings(parameters);
  require(afm::find_faults(settings).empty(), "the core refuses what the node took");
  settings.impact_budget = 20;
  settings.samples_per_batch = std::min<std::uint64_t>(settings.samples_per_batch, 100);
  settings.sample_period = std::min(settings.sample_period, 0.1);
  afm::Run run(settings);
  afm::Batch batch;
  run.advance(batch);
  require(afm::ModelTime{} <= batch.end && std::isfinite(batch.end.phase), "model time does not move on");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes bytes(data, size);
  afm::node::Faults faults;
  const auto parameters = afm::node::read_parameters(tree_of(bytes), faults);
  for (const auto& fault : faults) require(!fault.reason.empty(), "a fault without a reason");
  require(faults.empty() == afm::node::describe(faults).empty(), "faults that are not reported");
  if (faults.empty()) check_runs(parameters);
  return 0;
}
