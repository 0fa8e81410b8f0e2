// A topic of a recording as a table.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "common/table_units.h"
#include "tools/replay/recording.h"

namespace afm {

// What can be written: impacts, deflection, friction, commands.
bool is_bag_table(const std::string& topic);

// The natural units of the recording. Throws replay::Problem where there is no configuration, or several that differ.
Units units_of(const replay::Recording& recording);

// Header and rows, message by message: a long recording takes no more memory than a short one. Precondition:
// is_bag_table(topic). Throws replay::Problem where the recording cannot be read on.
void write_bag_table(const replay::Recording& recording, const std::string& topic, bool natural, std::ostream& out);

}  // namespace afm
