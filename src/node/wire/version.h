// The version of the package, from the build.
#pragma once

namespace afm::node {

constexpr char kVersion[] = AFM_EMULATOR_VERSION;

}  // namespace afm::node
