// Finds and loads a vendor's plugin by name, once per process.
#pragma once

#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/bus/plugin.h"

namespace eciton::bus {

/// Looks for libeciton_dds_<vendor>.so in ECITON_PLUGIN_PATH, beside the program (../lib, ../lib/eciton)
/// and where the loader looks. The Error names the vendor, the places and the plugins there are.
Result<const eciton_plugin*> load_plugin(const std::string& vendor);

/// Vendors whose plugins are found now.
std::vector<std::string> available_vendors();

/// The vendor a process uses: `configured`, unless ECITON_DDS names another.
std::string chosen_vendor(const std::string& configured);

}  // namespace eciton::bus
